//! Blocks that slide: down an incline, and under a plate that is pressed and pushed.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, Drive, Interface, Method, Particles, RigidMotion, SharedLaw, Shear,
    StepConditions, StepLoads, Tension,
};
use igimp_cases::CaseError;
use igimp_geometry::seed::fill_polygon;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchSettings};

use super::{force, polygon, weightless};
use crate::continuum::laboratory::{filled, grid_of, run, unobserved};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "An elastic block stands on a rigid floor while gravity turns, until it slides: at tan β = μ. A rigid plate is pressed onto elastic ground and pushed sideways: it slides at H = μ V + a B.";
const COULOMB: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Coulomb's law of friction, block on an incline",
    locator: "slides if and only if tan β > μ",
};
const PUSHED: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Coulomb's law of friction with adhesion, block pressed and pushed",
    locator: "H = μ V + a B",
};
/// Coefficient of friction \[-\].
const FRICTION: f64 = 0.4;
/// Load factor at which gravity begins to turn, and at which it turns more slowly.
const SET_DOWN: f64 = 0.1;
const NEAR: f64 = 0.4;
/// tan β over μ where gravity turns more slowly, and at the end \[-\].
const TURN: [f64; 2] = [0.9, 1.1];

/// A block of 2 × 0.5 on a floor, `shift` to the right of a line of the grid, while gravity turns; tan β
/// over μ of the last step in equilibrium and of the first that has none.
fn turned(shift: f64) -> Result<(RunRecord, [f64; 2]), CaseError> {
    let h = 0.125;
    let grid = Grid::new([Axis::uniform(-0.5, h, 24)?, Axis::uniform(-0.25, h, 10)?]);
    let (left, right) = (shift, 2.0 + shift);
    let outline = [[left, 0.0], [right, 0.0], [right, 0.5], [left, 0.5]];
    let mut body = Body::new(Particles::new(&fill_polygon(&grid, &outline, 2, 1.0, 0)?)?);
    let floor = [[-0.5, -0.2], [2.5, -0.2], [2.5, 0.0], [-0.5, 0.0]];
    body.rigid = vec![polygon(
        &floor,
        2.0 * h,
        &Interface::friction(FRICTION),
        [0.0; 2],
    )];
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(1e4, 0.3)?));
    let tangent = |factor: f64| {
        let share = |from: f64, to: f64| ((factor - from) / (to - from)).clamp(0.0, 1.0);
        let [most, end] = TURN;
        FRICTION * (most * share(SET_DOWN, NEAR) + (end - most) * share(NEAR, 1.0))
    };
    let load_path = |from: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        let (mut gravity, mut lift) = ([0.0; 2], 0.0);
        if from < 0.5 * SET_DOWN {
            // The floor comes up to a block that is held at its top.
            for column in 0..grid.axes[0].node_count() {
                for row in [6, 7] {
                    let node = grid.node_index([column, row]);
                    constraints.prescribe(node, 0, 0.0)?;
                    constraints.prescribe(node, 1, 0.0)?;
                }
            }
            lift = (to - from) * 1e-3;
        } else {
            let angle = tangent(to).atan();
            gravity = [angle.sin(), -angle.cos()];
        }
        StepConditions::new(
            grid.clone(),
            constraints,
            StepLoads::gravity(gravity),
            vec![Arc::clone(&law)],
        )?
        .with_motions(vec![RigidMotion::displaced([0.0, lift])])
    };
    let (run, report) = run(
        format!("gravity turns, block {:.3} h off the grid", shift / h),
        &mut body,
        &Method::igimp_bbar(),
        &MarchSettings::steps(40),
        &load_path,
        &mut unobserved,
    );
    let failed = report.failures.last().map_or(f64::NAN, |step| step.to);
    let reached = tangent(report.reached());
    Ok((run, [reached / FRICTION, tangent(failed) / FRICTION]))
}

/// A block of width 1 that stands fast, under a wide plate that a constant force presses while it is pushed
/// sideways; H over μ V + a B.
fn pushed(friction: f64, adhesion: f64, offset: f64) -> Result<(RunRecord, f64), CaseError> {
    let h = 0.125;
    let grid = Grid::new([Axis::uniform(-1.0, h, 16)?, Axis::uniform(-0.25, h, 5)?]);
    let block = grid_of(h, [8, 2])?;
    let mut seeds = filled(&block, 2);
    for seed in &mut seeds {
        seed.x[0] += offset * h - 0.5;
        seed.x[1] -= 0.25;
    }
    let mut body = Body::new(Particles::new(&seeds)?);
    let corners = [[-0.9, 0.0], [0.9, 0.0], [0.9, 0.2], [-0.9, 0.2]];
    let interface = Interface {
        shear: Shear::Limited {
            adhesion: vec![adhesion],
            varies: false,
            friction,
        },
        tension: Tension::None,
    };
    body.rigid = vec![polygon(&corners, h, &interface, [0.0; 2])];
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(1e4, 0.3)?));
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 1, false, 0)?;
    constraints.fix_wall(&grid, 1, false, 1)?;
    let pressed = 10.0;
    let load_path = |from: f64, to: f64| {
        let mut motion = RigidMotion::displaced([0.0, -1e-4]);
        if from > 0.0 {
            motion.displacement = [Drive::Moved((to - from) * 0.02), Drive::Loaded(-pressed)];
        }
        weightless(&grid, &constraints, &law, motion)
    };
    let mut found = f64::NAN;
    let mut observe = |accepted: &Accepted<'_, 2>| {
        found = force(accepted)[0];
        ControlFlow::Continue(())
    };
    let (run, _) = run(
        format!("plate under V = {pressed}, μ = {friction}, a = {adhesion}, {offset} h off"),
        &mut body,
        &Method::igimp_bbar(),
        &MarchSettings::steps(10),
        &load_path,
        &mut observe,
    );
    Ok((run, found / (friction * pressed + adhesion)))
}

/// Runs the study; it is short enough to be the same at every level.
pub(crate) fn study(out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-incline", ABOUT, out)?;
    for shift in [0.0, 0.04] {
        let (record, [stands, slides]) = turned(shift)?;
        let run = study.run(record);
        if shift > 0.0 {
            // Newton's method gives up before the block slides: printed, and not claimed.
            study.notes.push(format!(
                "contact-incline, {}: stands to tan β / μ = {stands:.4}, no equilibrium at {slides:.4}",
                study.runs[run].variant
            ));
            continue;
        }
        let quantity = "tan β / μ that the block still stands [-]";
        let band = Band::Between(0.999, 1.0);
        study.check(run, quantity, COULOMB.says(1.0), band, stands);
        let quantity = "tan β / μ where it has no equilibrium [-]";
        let band = Band::Between(1.0, 1.001);
        study.check(run, quantity, COULOMB.says(1.0), band, slides);
    }
    for (friction, adhesion, offset) in [
        (0.3, 0.0, 0.0),
        (0.3, 2.0, 0.0),
        (0.0, 2.0, 0.3),
        (0.5, 1.0, 0.7),
    ] {
        let (record, share) = pushed(friction, adhesion, offset)?;
        let run = study.run_to_end(record);
        let quantity = "H/(μ V + a B) [-]";
        study.check(run, quantity, PUSHED.says(1.0), Band::Relative(1e-3), share);
    }
    Ok(study)
}
