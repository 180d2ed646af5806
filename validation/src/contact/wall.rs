//! A smooth wall that holds soil, moved away from it and into it.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_cases::check::Band;
use rayon::prelude::*;

use crate::oracle::{Oracle, OracleKind};
use crate::runs::{Computed, shipped_case};
use crate::study::{Level, RunRecord, Study};

/// What the book says of the study.
const ABOUT: &str = "A smooth wall beside level ground, moved away from it and into it: sand of the template (φ = ψ = 30°, with its cohesion of 0.1 kPa) without tension, and clay (s_u = γH/8) bonded to the wall. The field of stress is uniform but for weight, and exact.";
const RANKINE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Rankine",
    locator: "K = tan²(45° ∓ φ/2) ∓ 4 c tan(45° ∓ φ/2)/(γ H); φ = 0: 1 ∓ 4 s_u/(γ H)",
};
/// Weight of the soil beside the wall, γ H \[kPa\].
const WEIGHT: f64 = 40.0;

/// Passive (`sign` 1) or active (−1) force over γ H²/2.
fn rankine(degrees: f64, cohesion: f64, sign: f64) -> f64 {
    let root = (45.0 + 0.5 * sign * degrees).to_radians().tan();
    root * root + sign * 4.0 * cohesion * root / WEIGHT
}

/// Runs the template with a soil and two motions \[m\]; its forces over γ H²/2, active and passive.
fn push(cell: f64, clay: bool) -> Result<(Computed, [f64; 2]), CaseError> {
    let mut overrides = vec![format!("grid.cell=\"{cell} m\""), "checks=[]".to_owned()];
    if clay {
        overrides.extend([
            "materials={ sand = { model = \"tresca\", unit_weight = \"20 kN/m3\", young = \"5 MPa\", poisson = 0.49, cu = \"5 kPa\" } }".to_owned(),
            "rigid.wall.tension=bonded".to_owned(),
            "stages.1.bodies=[{ body = \"wall\", x = \"-60 mm\" }]".to_owned(),
        ]);
    }
    let computed = Computed::new(shipped_case("wall", overrides)?)?;
    let forces = ["active", "passive"].map(|name| {
        let rows = &computed.curve(name).rows;
        rows.last().map_or(f64::NAN, |row| row[1])
    });
    Ok((computed, forces))
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-wall", ABOUT, out)?;
    let jobs: &[(f64, bool)] = match level {
        Level::Quick | Level::Default => &[(0.25, false)],
        Level::Full => &[(0.25, false), (0.25, true)],
    };
    let done = jobs
        .par_iter()
        .map(|&(cell, clay)| push(cell, clay))
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (&(cell, clay), (computed, forces)) in jobs.iter().zip(done) {
        let soil = if clay { "clay" } else { "sand" };
        let label = format!("{soil}, H/h = {}", 2.0 / cell);
        let run = study.run_to_end(RunRecord::new(label, &computed.report, computed.elapsed));
        let [degrees, cohesion] = if clay { [0.0, 5.0] } else { [30.0, 0.1] };
        for (name, sign, force) in [("active", -1.0, forces[0]), ("passive", 1.0, forces[1])] {
            study.check(
                run,
                format!("{name}: E/(γ H²/2) [-]"),
                RANKINE.says(rankine(degrees, cohesion, sign)),
                Band::Relative(0.04),
                force,
            );
        }
    }
    Ok(study)
}
