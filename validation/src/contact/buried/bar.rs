//! A bar that is pushed through deep clay, which loses strength as it is sheared: the measurement of a T-bar.

use std::f64::consts::PI;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, corners};

/// The book's description of the study.
const ABOUT: &str = "A smooth bar, bonded, is pushed by its diameter through deep, weightless Tresca soil with E/s_u = 300, on ten cells, the geometry moving with it, from a case file: once in clay that keeps its strength, and in clay that loses it by Einav and Randolph (2005). The mean resistance from 0.6 diameters on, in clay that keeps its strength, is held against the exact one. The others are printed beside that times the factor of Zhou and Randolph (2009), and not claimed: from grid to grid they differ by up to 8 %.";
const DEEP: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Randolph and Houlsby 1984",
    locator: "N = π + 2 + 4 for a smooth bar",
};
/// The source of the factor: δ + (1 − δ) exp(−1.5 ξ_T/ξ_95), the expression quoted from memory.
const REMOULDED: &str = "Zhou and Randolph 2009, doi 10.1680/geot.2007.00164, with ξ_T = 3.7";

/// Shear strain that soil takes as a bar passes, in the mean ξ_T \[-\].
const OF_A_PASS: f64 = 3.7;
/// Band about the exact resistance \[-\].
const BAND: f64 = 0.05;
/// Where the resistance is averaged: from here on \[D\].
const FROM: f64 = 0.6;
/// Parts of the half circle in the outline of soil, and its radius, just outside of the bar \[m\].
const ARC: usize = 48;
const ARC_RADIUS: f64 = 0.5003;
/// Level of the middle of the bar, half the width and the height of the ground \[m\].
const MIDDLE: f64 = 4.5;
const GROUND: [f64; 2] = [2.5, 6.5];

/// How clay loses strength: the share that is left δ, and the shear strain of 95 % of the loss ξ_95 \[-\].
#[derive(Clone, Copy)]
struct Loss {
    left: f64,
    strain: f64,
}

const LOSSES: [Loss; 3] = [
    Loss {
        left: 0.2,
        strain: 10.0,
    },
    Loss {
        left: 0.2,
        strain: 20.0,
    },
    Loss {
        left: 0.5,
        strain: 10.0,
    },
];

impl Loss {
    /// The factor by which a resistance is less than that of clay that keeps its strength.
    fn factor(self) -> f64 {
        self.left + (1.0 - self.left) * (-1.5 * OF_A_PASS / self.strain).exp()
    }

    /// The key of a material: strength falls by exp(−3 ξ/ξ_95), with the shear strain ξ = √3 κ.
    fn key(self) -> String {
        let strain = self.strain / (3.0 * 3.0_f64.sqrt());
        format!(
            "softening = {{ cu = {{ residual = {}, strain = {strain} }} }}\n",
            self.left
        )
    }
}

/// The soil on one side of the bar, as a case file has it; `side` is 1 on the right and −1 on the left.
fn soil(side: f64) -> String {
    let [width, height] = GROUND;
    let mut outline = vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    outline.extend((0..=ARC).map(|k| {
        let angle = PI * k as f64 / ARC as f64;
        let across = if k == 0 || k == ARC { 0.0 } else { angle.sin() };
        [ARC_RADIUS * across, MIDDLE + ARC_RADIUS * angle.cos()]
    }));
    for corner in &mut outline {
        corner[0] *= side;
    }
    format!(
        "[[bodies]]\nname = \"side {side}\"\nmaterial = \"clay\"\npoints_per_cell = 9\npolygon = {}\n",
        corners(&outline)
    )
}

/// The case file of a bar; without a loss the clay keeps its strength.
fn file(loss: Option<Loss>) -> String {
    let [width, height] = GROUND;
    let softening = loss.map_or_else(String::new, Loss::key);
    let soil = [1.0, -1.0].map(soil).concat();
    format!(
        "igimp = 1
[case]
title = \"T-bar\"
gravity = \"0 m/s2\"
[grid]
cell = \"0.1 m\"
domain = {{ x = [\"-{width} m\", \"{width} m\"], y = [\"0 m\", \"{height} m\"] }}
[materials.clay]
model = \"tresca\"
unit_weight = \"0 kN/m3\"
young = \"300 kPa\"
poisson = 0.49
cu = \"1 kPa\"
{softening}{soil}[boundaries]
left = \"roller\"
right = \"roller\"
bottom = \"roller\"
top = \"roller\"
[[rigid]]
name = \"bar\"
type = \"circle\"
centre = [\"0 m\", \"{MIDDLE} m\"]
radius = \"0.5 m\"
interface = \"smooth\"
tension = \"bonded\"
from_start = true
[[stages]]
name = \"push\"
type = \"rigid\"
bodies = [{{ body = \"bar\", y = \"-1 m\" }}]
steps = 100
[[curves]]
name = \"resistance\"
x = {{ of = \"rigid.bar.settlement\", divide_by = [\"1 m\"] }}
y = {{ of = \"rigid.bar.resistance\", divide_by = [\"1 m\", \"1 kPa\"] }}
"
    )
}

/// The mean of a resistance from [`FROM`] on, by the trapezoidal rule.
fn mean(curve: &[[f64; 2]]) -> f64 {
    let (mut way, mut work) = (0.0, 0.0);
    for pair in curve.windows(2).filter(|pair| pair[0][0] >= FROM) {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
        way += x1 - x0;
        work += 0.5 * (y0 + y1) * (x1 - x0);
    }
    work / way
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-bar", ABOUT, out)?;
    if level < Level::Full {
        study
            .notes
            .push(format!("{}: computed with --full alone", study.case));
        return Ok(study);
    }
    let clays: Vec<Option<Loss>> = std::iter::once(None).chain(LOSSES.map(Some)).collect();
    let computed = (clays.par_iter())
        .map(|&loss| Computed::new(CaseFile::parse("T-bar", &file(loss), &[])?.into_case()))
        .collect::<Result<Vec<_>, CaseError>>()?;
    let means: Vec<f64> = computed
        .iter()
        .map(|result| mean(&result.curve("resistance").points(0, 1)))
        .collect();
    for ((loss, result), found) in clays.iter().zip(&computed).zip(&means) {
        let variant = match loss {
            None => "strength that stays".to_owned(),
            Some(Loss { left, strain }) => format!("δ = {left}, ξ_95 = {strain}"),
        };
        let run = study.run_to_end(RunRecord::new(
            variant.clone(),
            &result.report,
            result.elapsed,
        ));
        match loss {
            None => {
                let band = Band::Relative(BAND);
                study.check(run, "V/(D s_u) [-]", DEEP.says(PI + 6.0), band, *found);
            }
            Some(loss) => {
                let expected = (PI + 6.0) * loss.factor();
                study.notes.push(format!(
                    "{}, {variant}: V/(D s_u) is {found:.3}, {:+.1} % from {expected:.3}, the exact one of intact clay times {:.3} ({REMOULDED})",
                    study.case,
                    100.0 * (found / expected - 1.0),
                    loss.factor()
                ));
            }
        }
    }
    Ok(study)
}
