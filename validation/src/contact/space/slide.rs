//! Blocks that slide in space: down an incline in any direction, and under a plate that is pressed and pushed.

use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, Drive, Interface, Method, ParticleSeed, Particles, RigidBody, RigidMotion,
    SharedLaw, Shear, StepConditions, StepLoads, Surface, Tension,
};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchSettings};

use super::super::{force, weightless};
use crate::continuum::laboratory::{filled, grid_of, run, unobserved};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};

const COULOMB: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Coulomb's law of friction, block on an incline",
    locator: "slides if and only if tan β > μ",
};
const PUSHED: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Coulomb's law of friction with adhesion, block pressed and pushed",
    locator: "H = μ V + a A",
};
/// Coefficient of friction \[-\].
const FRICTION: f64 = 0.4;
/// Load factor at which gravity begins to turn, and at which it turns more slowly.
const SET_DOWN: f64 = 0.1;
const NEAR: f64 = 0.4;
/// tan β over μ where gravity turns more slowly, and at the end \[-\].
const TURN: [f64; 2] = [0.9, 1.1];
/// Size of the cells \[length\].
const CELL: f64 = 0.25;

/// 2³ particles in every cell of a box of cells with its lower corner at `start`.
fn block(cells: [usize; 3], start: [f64; 3]) -> Result<Vec<ParticleSeed<3>>, CaseError> {
    let mut seeds = filled(&grid_of(CELL, cells)?, 2);
    for seed in &mut seeds {
        for axis in 0..3 {
            seed.x[axis] += start[axis];
        }
    }
    Ok(seeds)
}

/// A block of 1 × 1 × 0.5 on a floor, while gravity turns in a direction against the first axis \[rad\]; tan β over
/// μ of the last step in equilibrium and of the first that has none. The floor is turned about the vertical too.
fn turned(direction: f64) -> Result<(RunRecord, [f64; 2]), CaseError> {
    let across = || Axis::uniform(-0.5, CELL, 8);
    let grid = Grid::new([across()?, across()?, Axis::uniform(-0.5, CELL, 7)?]);
    let mut body = Body::new(Particles::new(&block([4, 4, 2], [0.0; 3])?)?);
    let surface = Surface::cuboid([1.5, 1.5, 0.1], 0.0, 2.0 * CELL).expect("it has a volume");
    let sides = vec![Interface::friction(FRICTION); 6];
    let mut floor = RigidBody::new(surface, sides, [0.5, 0.5, -0.1]);
    floor.pose = floor.pose.moved(&[0.0; 3], &[0.0, 0.0, 0.6 * direction]);
    body.rigid = vec![floor];
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(1e4, 0.3)?));
    let tangent = |factor: f64| {
        let share = |from: f64, to: f64| ((factor - from) / (to - from)).clamp(0.0, 1.0);
        let [most, end] = TURN;
        FRICTION * (most * share(SET_DOWN, NEAR) + (end - most) * share(NEAR, 1.0))
    };
    let load_path = |from: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        let (mut gravity, mut lift) = ([0.0; 3], 0.0);
        if from < 0.5 * SET_DOWN {
            // The floor comes up to a block that is held at its top.
            for node in 0..grid.node_count() {
                if [4, 5].contains(&grid.node_place(node)[2]) {
                    for axis in 0..3 {
                        constraints.prescribe(node, axis, 0.0)?;
                    }
                }
            }
            lift = (to - from) * 1e-3;
        } else {
            let (sin, cos) = tangent(to).atan().sin_cos();
            gravity = [sin * direction.cos(), sin * direction.sin(), -cos];
        }
        StepConditions::new(
            grid.clone(),
            constraints,
            StepLoads::gravity(gravity),
            vec![Arc::clone(&law)],
        )?
        .with_motions(vec![RigidMotion::displaced([0.0, 0.0, lift])])
    };
    let (run, report) = run(
        format!("gravity turns in a direction of {direction} rad"),
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

/// A block of area 1 that stands fast, under a wide plate that a constant force presses while it is pushed in a
/// direction \[rad\]; the force along it and across over μ V + a A.
fn pushed(
    friction: f64,
    adhesion: f64,
    offset: f64,
    direction: f64,
) -> Result<(RunRecord, [f64; 2]), CaseError> {
    let across = || Axis::uniform(-1.0, CELL, 8);
    let grid = Grid::new([across()?, across()?, Axis::uniform(-0.5, CELL, 5)?]);
    let start = [offset * CELL - 0.5, 0.5 * offset * CELL - 0.5, -0.5];
    let mut body = Body::new(Particles::new(&block([4, 4, 2], start)?)?);
    let shear = Shear::Limited {
        adhesion: vec![adhesion],
        varies: false,
        friction,
    };
    let interface = Interface {
        shear,
        tension: Tension::None,
    };
    let surface = Surface::cuboid([0.9, 0.9, 0.1], 0.0, CELL).expect("it has a volume");
    body.rigid = vec![RigidBody::new(surface, vec![interface; 6], [0.0, 0.0, 0.1])];
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(1e4, 0.3)?));
    let mut constraints = Constraints::free(&grid);
    for axis in 0..3 {
        constraints.fix_wall(&grid, 2, false, axis)?;
    }
    let (pressed, (sin, cos)) = (10.0, direction.sin_cos());
    let load_path = |from: f64, to: f64| {
        let mut motion = RigidMotion::displaced([0.0, 0.0, -1e-4]);
        if from > 0.0 {
            let by = (to - from) * 0.02;
            motion.displacement = [
                Drive::Moved(by * cos),
                Drive::Moved(by * sin),
                Drive::Loaded(-pressed),
            ];
        }
        weightless(&grid, &constraints, &law, motion)
    };
    let mut found = [f64::NAN; 2];
    let mut observe = |accepted: &Accepted<'_, 3>| {
        let [x, y, _] = force(accepted);
        found = [cos * x + sin * y, cos * y - sin * x];
        ControlFlow::Continue(())
    };
    let (run, _) = run(
        format!(
            "plate under V = {pressed}, μ = {friction}, a = {adhesion}, {offset} h off, pushed in a direction of {direction} rad"
        ),
        &mut body,
        &Method::igimp_bbar(),
        &MarchSettings::steps(10),
        &load_path,
        &mut observe,
    );
    Ok((run, found.map(|f| f / (friction * pressed + adhesion))))
}

/// Both checks.
pub(super) fn check(study: &mut Study) -> Result<(), CaseError> {
    for direction in [0.0, 0.5, 2.3] {
        let (record, [stands, slides]) = turned(direction)?;
        let run = study.run(record);
        let quantity = "tan β / μ that the block still stands [-]";
        let band = Band::Between(0.999, 1.0);
        study.check(run, quantity, COULOMB.says(1.0), band, stands);
        let quantity = "tan β / μ where it has no equilibrium [-]";
        let band = Band::Between(1.0, 1.001);
        study.check(run, quantity, COULOMB.says(1.0), band, slides);
    }
    for (friction, adhesion, offset, direction) in [
        (0.3, 0.0, 0.0, 0.4),
        (0.3, 2.0, 0.0, 1.0),
        (0.0, 2.0, 0.3, 2.0),
        (0.5, 1.0, 0.7, -1.2),
    ] {
        let (record, [along, aside]) = pushed(friction, adhesion, offset, direction)?;
        let run = study.run_to_end(record);
        let quantity = "H/(μ V + a A) [-]";
        study.check(run, quantity, PUSHED.says(1.0), Band::Relative(1e-3), along);
        let quantity = "force across the push over the same [-]";
        study.check(
            run,
            quantity,
            PUSHED.says(0.0),
            Band::AtMost(1e-3),
            aside.abs(),
        );
    }
    Ok(())
}
