//! A strip footing on clay that softens over a length: past its peak, on two meshes.

use std::f64::consts::PI;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::interpolate;
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "A rough strip footing on weightless Tresca soil with E/c_u = 1500 is pushed by a tenth of its width on the given geometry, bonded: on clay that keeps its strength, and on clay that loses 70 % of it, 63 % of that over a plastic strain of 5 %, with a length of a tenth of the width (theory, eqs. 110a to 110c), on cells of a half and a third of the length. Without a length the same clay is the control: its bands are as wide as cells.";
const PRANDTL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Prandtl 1920",
    locator: "N = 2 + π",
};
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "limit loads of the same mesh with intact and with residual strength",
    locator: "limit loads grow with the strength, and that of soil on its way lies between",
};
const NO_MESH: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "a strength that goes with plastic strain spread over a length knows no cells",
    locator: "theory, eqs. 110a to 110c: the curve on cells of a third of the length",
};

/// Width of the footing, and the length of softening \[m\].
const WIDTH: f64 = 2.0;
const LENGTH: f64 = 0.2;
/// Cells over the length.
const CELLS: [u32; 2] = [2, 3];
/// The share of the strength that is left \[-\].
const RESIDUAL: f64 = 0.3;
/// Where both meshes are compared: at the peak, and at settlements over the width on the way down \[-\].
const PLACES: [(&str, Option<f64>); 3] = [
    ("the peak", None),
    ("w/B = 0.05", Some(0.05)),
    ("w/B = 0.1", Some(0.1)),
];
/// By how much they may differ \[-\].
const APART: f64 = 0.02;
/// How far above Prandtl's N the mesh may lie: the corner of the footing is a cell wide \[-\].
const MESH: f64 = 0.03;

/// Where meshes are compared without a length, and by how much the coarser has to bear more \[-\].
const CONTROL: (f64, f64) = (0.02, 1.05);

/// How clay loses strength.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Clay {
    Keeps,
    Softens,
    /// By plastic strain of each point.
    SoftensLocally,
}

impl Clay {
    fn name(self) -> &'static str {
        match self {
            Self::Keeps => "clay that keeps its strength",
            Self::Softens => "clay that softens",
            Self::SoftensLocally => "clay that softens without a length",
        }
    }

    /// The key of the material.
    fn key(self) -> String {
        let length = match self {
            Self::Keeps => return String::new(),
            Self::Softens => format!(", length = \"{LENGTH} m\""),
            Self::SoftensLocally => String::new(),
        };
        format!("softening = {{ cu = {{ residual = {RESIDUAL}, strain = 0.05 }}{length} }}\n")
    }

    /// How far the footing is pushed \[m\].
    fn way(self) -> f64 {
        if self == Self::SoftensLocally {
            0.04
        } else {
            0.2
        }
    }
}

/// The case file.
fn file(cells: u32, clay: Clay) -> String {
    let cell = LENGTH / f64::from(cells);
    let (softening, way) = (clay.key(), clay.way());
    let steps = (200.0 * way).round();
    format!(
        "igimp = 1
[case]
title = \"Footing on clay that softens\"
gravity = \"0 m/s2\"
[grid]
cell = \"{cell} m\"
domain = {{ x = [\"0 m\", \"5 m\"], y = [\"0 m\", \"3.6 m\"] }}
[materials.clay]
model = \"tresca\"
unit_weight = \"18 kN/m3\"
young = \"30 MPa\"
poisson = 0.49
cu = \"20 kPa\"
{softening}[[bodies]]
name = \"soil\"
material = \"clay\"
points_per_cell = 4
polygon = [[\"0 m\", \"0 m\"], [\"5 m\", \"0 m\"], [\"5 m\", \"3 m\"], [\"0 m\", \"3 m\"]]
[boundaries]
left = \"roller\"
right = \"roller\"
bottom = \"fixed\"
[[rigid]]
name = \"footing\"
type = \"rectangle\"
from = [\"-1 m\", \"3 m\"]
to = [\"1 m\", \"3.4 m\"]
interface = \"rough\"
tension = \"bonded\"
rounding = 0
force_factor = 2
[[stages]]
name = \"push\"
type = \"rigid\"
geometry = \"given\"
bodies = [{{ body = \"footing\", y = \"-{way} m\" }}]
steps = {steps}
[[curves]]
name = \"resistance\"
x = {{ of = \"rigid.footing.settlement\", divide_by = [\"{WIDTH} m\"] }}
y = {{ of = \"rigid.footing.resistance\", divide_by = [\"{WIDTH} m\", \"20 kPa\"] }}
"
    )
}

/// N at the peak, or at a settlement over the width.
fn at(curve: &[[f64; 2]], place: Option<f64>) -> f64 {
    match place {
        None => curve.iter().map(|[_, n]| *n).fold(0.0, f64::max),
        Some(place) => interpolate(curve, place),
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("softening-footing", ABOUT, out)?;
    if level < Level::Full {
        study
            .notes
            .push(format!("{}: computed with --full alone", study.case));
        return Ok(study);
    }
    let [coarse, fine] = CELLS;
    let clays = [
        (coarse, Clay::Keeps),
        (coarse, Clay::Softens),
        (fine, Clay::Softens),
        (coarse, Clay::SoftensLocally),
        (fine, Clay::SoftensLocally),
    ];
    let computed = (clays.par_iter())
        .map(|&(cells, clay)| {
            Computed::new(CaseFile::parse("footing", &file(cells, clay), &[])?.into_case())
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    let curves: Vec<_> = computed
        .iter()
        .map(|result| result.curve("resistance").points(0, 1))
        .collect();
    let runs: Vec<usize> = std::iter::zip(&clays, &computed)
        .map(|((cells, clay), result)| {
            let variant = format!("{}, l/h = {cells}", clay.name());
            study.run_to_end(RunRecord::new(variant, &result.report, result.elapsed))
        })
        .collect();
    let intact = at(&curves[0], None);
    let prandtl = 2.0 + PI;
    let band = Band::Between(prandtl, (1.0 + MESH) * prandtl);
    study.check(runs[0], "N [-]", PRANDTL.says(prandtl), band, intact);
    for (curve, run) in std::iter::zip(&curves, &runs).skip(1).take(2) {
        for (name, place) in PLACES {
            let bounds = [RESIDUAL * intact, intact];
            study.check(
                *run,
                format!("N at {name} [-]"),
                BOUNDS.says(bounds[1]),
                Band::Between(bounds[0], bounds[1]),
                at(curve, place),
            );
        }
    }
    for (name, place) in PLACES {
        let [on_coarse, on_fine] = [&curves[1], &curves[2]].map(|curve| at(curve, place));
        study.check(
            runs[1],
            format!("N at {name}, against the finer mesh [-]"),
            NO_MESH.says(on_fine),
            Band::Relative(APART),
            on_coarse,
        );
    }
    let (place, apart) = CONTROL;
    let [on_coarse, on_fine] = [&curves[3], &curves[4]].map(|curve| interpolate(curve, place));
    study.control(
        runs[3],
        "N at w/B = 0.02 without a length, against the finer mesh [-]",
        NO_MESH.says(on_fine),
        Band::AtLeast(apart * on_fine),
        on_coarse,
    );
    Ok(study)
}
