//! Pipes that are pushed deep into soil from its surface, on a geometry that moves.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "Pipes on Tresca soil with E/s_u = 500 and γD/s_u = 0.1 are pushed three quarters of a diameter in and pulled out again, on ten cells and a geometry that moves. Their middles stand at two places of the grid within a cell. Every march has to reach both ends. Loads are means over 0.025 D; those of smooth pipes are claimed, all are told. Below the full level there is one smooth pipe.";
const MERIFIELD: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Merifield, White and Randolph 2009",
    locator: "pushed from the surface: V/(D s_u) = 5.3 (w/D)^0.25 smooth, 7.1 (w/D)^0.33 rough",
};

/// By how much a load that is claimed may differ \[-\].
const BAND: f64 = 0.04;
/// Depths over diameter at which loads are printed.
const DEPTHS: [f64; 7] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];
/// Loads are means over depths as far as this to either side, in diameters.
const ASIDE: f64 = 0.0126;
/// Where the middles stand within a cell \[m\].
const PLACES: [f64; 2] = [0.0, 0.035];

/// A pipe by its interface.
struct Pipe {
    name: &'static str,
    interface: &'static str,
    /// Factor and exponent of the load over diameter and strength.
    fit: [f64; 2],
    is_claimed: bool,
}

const PIPES: [Pipe; 2] = [
    Pipe {
        name: "smooth pipe",
        interface: "\"smooth\"",
        fit: [5.3, 0.25],
        is_claimed: true,
    },
    Pipe {
        name: "adhesive pipe",
        interface: "{ adhesion_share = 1 }",
        fit: [7.1, 0.33],
        is_claimed: false,
    },
];

/// The case file of a pipe whose middle stands at a place.
fn file(interface: &str, place: f64) -> String {
    format!(
        "igimp = 1
[case]
title = \"a pipe that is pushed deep\"
[grid]
cell = \"0.1 m\"
domain = {{ x = [\"-4 m\", \"4 m\"], y = [\"0 m\", \"5 m\"] }}
[materials.clay]
model = \"tresca\"
unit_weight = \"1 kN/m3\"
young = \"5 MPa\"
poisson = 0.49
cu = \"10 kPa\"
[[bodies]]
name = \"ground\"
material = \"clay\"
polygon = [[\"-4 m\", \"0 m\"], [\"4 m\", \"0 m\"], [\"4 m\", \"3.5 m\"], [\"-4 m\", \"3.5 m\"]]
[boundaries]
left = \"roller\"
right = \"roller\"
bottom = \"fixed\"
[[rigid]]
name = \"pipe\"
type = \"circle\"
centre = [\"{place} m\", \"4 m\"]
radius = \"0.5 m\"
interface = {interface}
[[stages]]
name = \"weight\"
type = \"gravity\"
steps = 1
geometry = \"moving\"
[[stages]]
name = \"push\"
type = \"rigid\"
bodies = [{{ body = \"pipe\", y = \"-0.75 m\" }}]
steps = 150
[[stages]]
name = \"pull\"
type = \"rigid\"
bodies = [{{ body = \"pipe\", y = \"0.75 m\" }}]
steps = 40
[[curves]]
name = \"load\"
x = {{ of = \"rigid.pipe.settlement\", divide_by = [\"1 m\"] }}
y = {{ of = \"rigid.pipe.resistance\", divide_by = [\"1 m\", \"10 kPa\"] }}
"
    )
}

/// The mean load about a depth.
fn load_at(points: &[[f64; 2]], depth: f64) -> f64 {
    let near = points.iter().filter(|[w, _]| (w - depth).abs() <= ASIDE);
    let loads: Vec<f64> = near.map(|[_, load]| *load).collect();
    loads.iter().sum::<f64>() / loads.len() as f64
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-deep", ABOUT, out)?;
    let all: Vec<(&Pipe, f64)> = PIPES
        .iter()
        .flat_map(|pipe| PLACES.map(|place| (pipe, place)))
        .filter(|(pipe, place)| level == Level::Full || (pipe.is_claimed && *place > 0.0))
        .collect();
    let computed = all
        .par_iter()
        .map(|(pipe, place)| {
            let text = file(pipe.interface, *place);
            Computed::new(CaseFile::parse(pipe.name, &text, &[])?.into_case())
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    for ((pipe, place), run) in std::iter::zip(all, &computed) {
        let variant = format!("{}, middle at {place} m", pipe.name);
        let last = study.run_to_end(RunRecord::new(variant.clone(), &run.report, run.elapsed));
        let points = run.curve("load").points(0, 1);
        let deepest = points.iter().map(|[w, _]| *w).fold(0.0, f64::max);
        let push = points.iter().take_while(|[w, _]| *w < deepest);
        let push: Vec<[f64; 2]> = push.copied().collect();
        let mut loads = Vec::new();
        for depth in DEPTHS {
            let load = load_at(&push, depth);
            let fit = pipe.fit[0] * depth.powf(pipe.fit[1]);
            loads.push(format!("{load:.2} ({:+.1} %)", 100.0 * (load / fit - 1.0)));
            if pipe.is_claimed {
                let quantity = format!("V/(D s_u) at w/D = {depth} [-]");
                let band = Band::Between((1.0 - BAND) * fit, (1.0 + BAND) * fit);
                study.check(last, quantity, MERIFIELD.says(fit), band, load);
            }
        }
        study.notes.push(format!(
            "{}: {variant}, at w/D = 0.1 to 0.7: {}",
            study.case,
            loads.join(", ")
        ));
    }
    Ok(study)
}
