//! A strip on Tresca soil at small strain: eccentric load that lets the base lift off, and vertical with
//! horizontal load.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{Drive, Interface, Method, Particles, RigidMotion, SharedLaw};
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::table::Table;
use igimp_material::{Elasticity, Tresca};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use super::{Ground, force, graded, polygon, weightless};
use crate::laboratory::run;
use crate::oracle::{Expected, Oracle, OracleKind};
use crate::study::{Level, RunRecord, Study};

/// What the book says of the study.
const ABOUT: &str = "A rigid strip on weightless Tresca soil with E/s_u = 10⁴, free to tilt under an eccentric load and free to lift off, and pushed at an angle. Limit loads are held against bounds of limit analysis; those of the pushes are told beside Green's envelope.";
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis of a strip with eccentric load, no tension on its base",
    locator: "lower and upper bound of V/(B s_u)",
};
const PRANDTL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Prandtl 1920",
    locator: "V/(B s_u) = 2 + π",
};
/// Young's modulus over undrained strength \[-\].
const YOUNG: f64 = 1e4;
/// Settlement of the load point at the end over the width \[-\].
const SETTLEMENT: f64 = 0.01;

/// Settlement of the first step, which brings strip and soil together before the strip may tilt \[-\].
const TOUCH: f64 = 1e-5;

/// Lower and upper bound of V/(B s_u) by eccentricity over width, rough and smooth.
const TABLE: [(f64, [f64; 2], [f64; 2]); 4] = [
    (0.0, [5.1056, 5.1674], [5.0808, 5.1491]),
    (0.1, [4.1771, 4.2443], [4.0542, 4.1311]),
    (0.2, [3.1353, 3.1975], [3.0242, 3.1026]),
    (0.4, [1.0382, 1.1019], [0.9749, 1.0447]),
];

/// One push of a strip of unit width.
#[derive(Clone, Debug)]
struct Push {
    eccentricity: f64,
    rough: bool,
    /// Sideways motion over settlement \[-\]; the strip is then held upright.
    sideways: Option<f64>,
    cells: usize,
}

impl Push {
    /// V/(B s_u) and H/(B s_u) by step.
    fn run(&self) -> Result<(RunRecord, Table), CaseError> {
        let h = 1.0 / self.cells as f64;
        // With an odd number of cells the edges stand in the middle of cells.
        let reach = 14.0_f64.max(1.5 * self.cells as f64).ceil() * h;
        let ground = Ground::new(
            graded(h, [-reach, reach], [-3.5, 3.5], 1.15),
            graded(h, [-0.9, 0.0], [-2.5, 0.0], 1.15),
            3,
            2,
        )?;
        let mut body = Body::new(Particles::new(&ground.seeds)?);
        let e = self.eccentricity;
        // A surface strip: its back rises so flat that only the base touches.
        let corners = [[-0.5 - e, 0.0], [0.5 - e, 0.0], [-e, 0.2]];
        let interface = if self.rough {
            Interface::rough()
        } else {
            Interface::smooth()
        };
        body.rigid = vec![polygon(&corners, h, &interface, [e, 0.0])];
        let law: SharedLaw = Arc::new(Tresca::new(Elasticity::new(YOUNG, 0.49)?, 1.0)?);
        let constraints = ground.held()?;
        let load_path = |from: f64, to: f64| {
            let down = SETTLEMENT * (to - from);
            let mut motion = RigidMotion::displaced([0.0, -TOUCH]);
            if from > 0.0 {
                motion = RigidMotion::displaced([0.0, -down]);
                match self.sideways {
                    Some(ratio) => motion.displacement[0] = Drive::Moved(ratio * down),
                    None => motion.rotation[0] = Drive::Loaded(0.0),
                }
            }
            weightless(&ground.grid, &constraints, &law, motion)
        };
        let kind = if self.rough { "rough" } else { "smooth" };
        let name = match self.sideways {
            Some(ratio) => format!("probe_{ratio}_{}", self.cells),
            None => format!("eccentric_{e}_{kind}_{}", self.cells),
        };
        let mut curve = Table::new(name, &["settlement_over_B_[-]", "V_[B s_u]", "H_[B s_u]"]);
        let mut observe = |accepted: &Accepted<'_, 2>| {
            let [horizontal, vertical] = force(accepted);
            curve.push(vec![
                SETTLEMENT * accepted.report.to,
                -vertical,
                horizontal.abs(),
            ]);
            ControlFlow::Continue(())
        };
        let variant = match self.sideways {
            Some(ratio) => format!("rough, pushed {ratio}:1 sideways, B/h = {}", self.cells),
            None => format!("{kind}, e = {e} B, B/h = {}", self.cells),
        };
        let (run, _) = run(
            variant,
            &mut body,
            &Method::shared_strain(),
            &MarchSettings::steps(20),
            &load_path,
            &mut observe,
        );
        Ok((run, curve))
    }

    /// Whether its limit load is held against the bounds. With an eccentric load one mesh lies within them
    /// and the other beyond; a rough strip that is probed sideways slides at about (B + h) s_u.
    fn is_claimed(&self) -> bool {
        self.sideways.is_none() && self.eccentricity == 0.0
    }

    /// What is known of V/(B s_u), and the band: 2 % beyond the bounds.
    fn bounds(&self) -> (Expected, Band) {
        let row = TABLE
            .iter()
            .find(|row| row.0.total_cmp(&self.eccentricity).is_eq())
            .expect("the eccentricity is in the table");
        let [lower, upper] = if self.rough { row.1 } else { row.2 };
        let band = Band::Between(0.98 * lower, 1.02 * upper);
        if self.eccentricity == 0.0 {
            (PRANDTL.says(2.0 + PI), band)
        } else {
            (BOUNDS.says(0.5 * (lower + upper)), band)
        }
    }
}

/// V/(B s_u) of a rough strip under inclined load at H/(B s_u) (Green 1954).
fn green(eta: f64) -> f64 {
    let eta = eta.clamp(0.0, 1.0);
    1.0 + 0.5 * PI + eta.acos() + (1.0 - eta * eta).sqrt()
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-strip", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick | Level::Default => &[9],
        Level::Full => &[9, 17],
    };
    let mut jobs = Vec::new();
    for &cells in meshes {
        for (eccentricity, ..) in TABLE {
            for rough in [false, true] {
                jobs.push(Push {
                    eccentricity,
                    rough,
                    sideways: None,
                    cells,
                });
            }
        }
        for ratio in [1.5, 2.0, 3.0] {
            jobs.push(Push {
                eccentricity: 0.0,
                rough: true,
                sideways: Some(ratio),
                cells,
            });
        }
    }
    let done = jobs
        .par_iter()
        .map(Push::run)
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (job, (record, curve)) in jobs.iter().zip(done) {
        let run = if job.is_claimed() {
            study.run_to_end(record)
        } else {
            study.run(record)
        };
        let [vertical, horizontal] = curve
            .rows
            .last()
            .map_or([f64::NAN; 2], |row| [row[1], row[2]]);
        let (expected, band) = job.bounds();
        if job.is_claimed() {
            study.check(run, "V/(B s_u) at the end [-]", expected, band, vertical);
        } else {
            // Told, and not claimed.
            let RunRecord {
                variant, outcome, ..
            } = &study.runs[run];
            let known = match job.sideways {
                Some(_) => format!("Green {:.3}", green(horizontal)),
                None => format!("bounds' mean {:.3}", expected.value),
            };
            study.notes.push(format!(
                "contact-strip, {variant}: V/(B s_u) = {vertical:.3} at H/(B s_u) = {horizontal:.3}, {known}; {outcome}"
            ));
        }
        curve.write_csv(&study.folder)?;
    }
    Ok(study)
}
