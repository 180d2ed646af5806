//! A rigid smooth punch with an eccentric load on an elastic half-plane: it lifts off.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{Drive, Interface, Method, Particles, Penalty, RigidMotion, SharedLaw};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_solver::{Accepted, Body, MarchSettings};

use super::{Ground, force, graded, polygon, weightless};
use crate::continuum::laboratory::run;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A rigid smooth punch of width B on an elastic half-plane is pushed down at an eccentricity, free to tilt. Beyond B/4 it lifts off; contact width and rotation are exact.";
const LIFTED: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "rigid smooth punch on a half-plane that lifts off, e > B/4",
    locator: "contact width 4 (B/2 − e); θ = 2 P/(π E* c), c = 2 (B/2 − e)",
};
const FULL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "rigid smooth punch on a half-plane, e ≤ B/4",
    locator: "θ = 4 P e/(π E* b²), b = B/2",
};
/// Plane-strain modulus E/(1 − ν²) \[stress\].
const MODULUS: f64 = 1.0;
const POISSON: f64 = 0.3;

/// The results at the end.
struct Found {
    run: RunRecord,
    load: f64,
    angle: f64,
    width: f64,
    profile: Vec<[f64; 2]>,
}

/// Pushes a punch of unit width at `eccentricity` to the right of its middle.
fn push(eccentricity: f64, cells: usize) -> Result<Found, CaseError> {
    let h = 1.0 / cells as f64;
    let (fine, far) = (0.75, 12.0);
    let fine = (fine / h).ceil() * h;
    // The ends of the punch stand in the middle of cells.
    let lines: Vec<f64> = graded(h, [-fine, fine], [-far, far], 1.2)
        .iter()
        .map(|line| line + 0.5 * h)
        .collect();
    let ground = Ground::new(lines, graded(h, [-0.75, 0.0], [-far, 0.0], 1.2), 3, 2)?;
    let mut body = Body::new(Particles::new(&ground.seeds)?);
    let (left, right) = (-0.5 - eccentricity, 0.5 - eccentricity);
    let corners = [[left, 0.0], [right, 0.0], [right, 0.2], [left, 0.2]];
    let mut punch = polygon(&corners, h, &Interface::smooth(), [eccentricity, 0.0]);
    punch.penalty = Penalty {
        stiffness: 100.0,
        smoothing: 1e-4,
        ..Penalty::default()
    };
    body.rigid = vec![punch];
    let elasticity = Elasticity::new(MODULUS * (1.0 - POISSON * POISSON), POISSON)?;
    let law: SharedLaw = Arc::new(HenckyElastic::new(elasticity));
    let constraints = ground.held()?;
    let depth = 0.01;
    let load_path = |from: f64, to: f64| {
        // Pressed on level at first, by so little that letting it tilt is no jump.
        let mut motion = RigidMotion::displaced([0.0, -depth * (to * to - from * from)]);
        if from > 0.0 {
            motion.rotation[0] = Drive::Loaded(0.0);
        }
        weightless(&ground.grid, &constraints, &law, motion)
    };
    let mut load = 0.0;
    let mut observe = |accepted: &Accepted<'_, 2>| {
        load = -force(accepted)[1];
        ControlFlow::Continue(())
    };
    let (run, _) = run(
        format!("e = {eccentricity} B, B/h = {cells}"),
        &mut body,
        &Method::igimp_bbar(),
        &MarchSettings::steps(10),
        &load_path,
        &mut observe,
    );
    let punch = &body.rigid[0];
    let base = || {
        let knots = punch.surface.knots().into_iter().zip(&punch.contact.knots);
        knots.filter(|((place, _), _)| place[1] == 0.0)
    };
    let width = base()
        .filter(|(_, knot)| knot.is_closed)
        .map(|(_, knot)| knot.area)
        .sum();
    Ok(Found {
        run,
        load,
        angle: -punch.pose.angle[0],
        width,
        profile: base()
            .map(|((place, _), knot)| [place[0] + eccentricity, knot.pressure])
            .collect(),
    })
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-punch", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick => &[16],
        Level::Default => &[16, 32],
        Level::Full => &[16, 32, 64],
    };
    for eccentricity in [0.1, 0.3, 0.4] {
        for &cells in meshes {
            let found = push(eccentricity, cells)?;
            let run = study.run_to_end(found.run);
            let half = if eccentricity > 0.25 {
                2.0 * (0.5 - eccentricity)
            } else {
                0.5
            };
            let exact = if eccentricity > 0.25 {
                2.0 * found.load / (PI * MODULUS * half)
            } else {
                4.0 * found.load * eccentricity / (PI * MODULUS * half * half)
            };
            let oracle = if eccentricity > 0.25 { LIFTED } else { FULL };
            let h = 1.0 / cells as f64;
            let band = Band::Between(2.0 * half - h, 2.0 * half + h);
            study.check(
                run,
                "contact width / B [-]",
                oracle.says(2.0 * half),
                band,
                found.width,
            );
            let band = Band::Relative(0.03);
            study.check(run, "rotation [rad]", oracle.says(exact), band, found.angle);
            let mut profile = Table::new(
                format!("pressure_{eccentricity}_{cells}"),
                &["x_over_B_[-]", "p_over_E_[-]"],
            );
            for row in &found.profile {
                profile.push(row.to_vec());
            }
            study.table(profile)?;
        }
    }
    Ok(study)
}
