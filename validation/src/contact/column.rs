//! A plate presses a column that cannot widen.

use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{Constraints, Interface, Method, Particles, RigidMotion, SharedLaw};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_solver::{Body, MarchSettings};

use super::{Ground, closed, penetration, polygon, weightless};
use crate::continuum::laboratory::{run, unobserved};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A rigid plate presses an elastic column that cannot widen from 0.8 m to 0.6 m. The stress is the exact one of the height that the penetration leaves, whatever the stiffness of contact.";
const HENCKY: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "uniform compression without lateral strain, Hencky elasticity, ν = 0",
    locator: "σ = E ln λ/λ",
};
/// Young's modulus \[Pa\].
const YOUNG: f64 = 1e6;
/// Height at the start and at the end \[m\].
const HEIGHT: [f64; 2] = [0.8, 0.6];
/// Size of the cells \[m\]: the surface is never so close above a line of the grid that nodes are tied.
const CELL: f64 = 0.8 / 7.0;

/// The result of a push.
struct Pressed {
    run: RunRecord,
    /// Mean vertical stress, and the largest deviation from it over itself.
    stress: f64,
    uneven: f64,
    pressure: f64,
    penetration: f64,
}

/// Presses the column with so stiff a contact.
fn press(stiffness: f64) -> Result<Pressed, CaseError> {
    let x = (0..=2).map(|k| CELL * f64::from(k)).collect();
    let y = (0..=7).map(|k| CELL * f64::from(k)).collect();
    let ground = Ground::new(x, y, 2, 2)?;
    let mut body = Body::new(Particles::new(&ground.seeds)?);
    let corners = [[-0.3, 0.0], [0.3, 0.0], [0.3, 0.1], [-0.3, 0.1]];
    let mut plate = polygon(&corners, CELL, &Interface::smooth(), [CELL, HEIGHT[0]]);
    plate.penalty.stiffness = stiffness;
    body.rigid = vec![plate];
    let mut constraints = Constraints::free(&ground.grid);
    constraints.fix_wall(&ground.grid, 1, false, 1)?;
    for node in 0..ground.grid.node_count() {
        constraints.prescribe(node, 0, 0.0)?;
    }
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, 0.0)?));
    let load_path = |from: f64, to: f64| {
        let push = (to - from) * (HEIGHT[1] - HEIGHT[0]);
        let motion = RigidMotion::displaced([0.0, push]);
        weightless(&ground.grid, &constraints, &law, motion)
    };
    let (run, _) = run(
        format!("contact stiffness {stiffness} E/h"),
        &mut body,
        &Method::igimp(),
        &MarchSettings::steps(20),
        &load_path,
        &mut unobserved,
    );
    let stresses = body.particles.sigma.iter().map(|sigma| sigma[1][1]);
    let stress = stresses.clone().sum::<f64>() / body.particles.len() as f64;
    let uneven = stresses
        .map(|sigma| (sigma / stress - 1.0).abs())
        .fold(0.0, f64::max);
    let touching = closed(&body.rigid);
    Ok(Pressed {
        run,
        stress,
        uneven,
        pressure: touching[0].1.pressure,
        penetration: penetration(&body.rigid),
    })
}

/// Runs the study; it is short enough to be the same at every level.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-column", ABOUT, out)?;
    let stress_at = |height: f64| {
        let stretch = height / HEIGHT[0];
        YOUNG * stretch.ln() / stretch
    };
    for stiffness in [30.0, 300.0, 3000.0] {
        let pressed = press(stiffness)?;
        let run = study.run_to_end(pressed.run);
        let height = HEIGHT[1] + pressed.penetration;
        let exact = HENCKY.says(stress_at(height));
        let quantity = "σ at the height that the penetration leaves [Pa]";
        study.check(run, quantity, exact, Band::Relative(1e-9), pressed.stress);
        let quantity = "contact pressure, likewise [Pa]";
        let exact = HENCKY.says(-stress_at(height));
        study.check(run, quantity, exact, Band::Relative(1e-9), pressed.pressure);
        let quantity = "largest deviation of σ from its mean [-]";
        let none = HENCKY.says(0.0);
        study.check(run, quantity, none, Band::AtMost(1e-9), pressed.uneven);
        // σ changes by 1.71 times the strain that is missing: d(ln λ/λ)/dλ = (1 − ln λ)/λ².
        let missing = pressed.penetration / HEIGHT[1];
        let (exact, ratio): (f64, f64) = (stress_at(HEIGHT[1]), HEIGHT[1] / HEIGHT[0]);
        let slope = (1.0 - ratio.ln()) / -ratio.ln();
        let quantity = format!(
            "σ at 0.6 m [Pa], penetration {:.3} % of the height",
            100.0 * missing
        );
        let band = Band::Relative(slope * missing * 1.01);
        study.check(run, quantity, HENCKY.says(exact), band, pressed.stress);
    }
    Ok(study)
}
