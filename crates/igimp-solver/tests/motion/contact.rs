//! GOAL: rigid bodies press, carry, push and let go of elastic soil in steps.
//! BODY: blocks of 2 particles per direction and unit cell that stand on a smooth or rough floor.
//! ORACLE: uniform stress in closed form, balance of forces, the same on any number of threads.

use std::sync::Arc;

use crate::body_support::workspace;
use igimp_assembly::{
    Constraints, Drive, Interface, Method, ParticleSeed, Particles, RigidBody, RigidMotion,
    SharedLaw, Shear, StepConditions, StepLoads, Surface, Tension,
};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, Component, NewtonSettings, NodalForces, StepFailure, StepReport, step};

/// Young's modulus \[stress\].
const YOUNG: f64 = 100.0;

fn law(poisson: f64) -> SharedLaw {
    Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, poisson).unwrap()))
}

/// 2 particles per direction in every unit cell of a box of cells.
fn soil<const D: usize>(from: [usize; D], to: [usize; D]) -> Particles<D> {
    let count: [usize; D] = std::array::from_fn(|axis| 2 * (to[axis] - from[axis]));
    let seeds: Vec<_> = (0..count.iter().product())
        .map(|mut number: usize| ParticleSeed {
            x: std::array::from_fn(|axis| {
                let place = number % count[axis];
                number /= count[axis];
                from[axis] as f64 + 0.25 + 0.5 * place as f64
            }),
            half_length: [0.25; D],
            volume: 0.5_f64.powi(D as i32),
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect();
    Particles::new(&seeds).unwrap()
}

fn unit_cells<const D: usize>(cells: [usize; D]) -> Grid<D> {
    Grid::new(cells.map(|cells| Axis::uniform(0.0, 1.0, cells).unwrap()))
}

/// The true stress of soil without lateral strain that is pressed from height 3 to that which a
/// penetration leaves of a push \[stress\].
fn uniform(push: f64, penetration: f64) -> f64 {
    let stretch = (3.0 - push + penetration) / 3.0;
    YOUNG * stretch.ln() / stretch
}

/// A block of 4 × 4 × 3 cells under a wide box of triangles that is turned about the vertical.
fn pressed_by_a_box(angle: f64, push: f64) -> (Body<3>, NodalForces<3>, StepReport) {
    let grid = unit_cells([6, 6, 5]);
    let mut body = Body::new(soil([1, 1, 0], [5, 5, 3]));
    let top = RigidBody::new(
        Surface::cuboid([4.0, 4.0, 0.5], 0.0, 1.0).unwrap(),
        vec![Interface::smooth(); 6],
        [3.0, 3.0, 3.5],
    );
    body.rigid = vec![top];
    body.rigid[0].pose = body.rigid[0].pose.moved(&[0.0; 3], &[0.0, 0.0, angle]);
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 2, false, 2).unwrap();
    // Symmetry holds the block in its place; with ν = 0 nothing moves sideways.
    for node in 0..grid.node_count() {
        let place = grid.node_place(node);
        for axis in 0..2 {
            if place[axis] == 3 {
                constraints.prescribe(node, axis, 0.0).unwrap();
            }
        }
    }
    let conditions = StepConditions::new(
        grid,
        constraints,
        StepLoads::gravity([0.0; 3]),
        vec![law(0.0)],
    )
    .and_then(|conditions| conditions.with_motions(vec![RigidMotion::displaced([0.0, 0.0, -push])]))
    .unwrap();
    let (report, forces) = step(
        &mut body,
        &Method::igimp(),
        &conditions,
        (0.0, 1.0),
        &NewtonSettings {
            tolerance: 1e-12,
            ..NewtonSettings::default()
        },
        &mut workspace(),
    )
    .unwrap();
    (body, forces, report)
}

/// A body in space presses a block evenly, however it is turned about the direction of the push.
#[test]
fn a_box_presses_a_block_evenly() {
    for angle in [0.0, 0.3, std::f64::consts::FRAC_PI_4, 1.2] {
        let (body, forces, report) = pressed_by_a_box(angle, 0.3);
        let bottom = &body.rigid[0].contact.knots;
        let closed: Vec<_> = bottom.iter().filter(|knot| knot.is_closed).collect();
        let penetration = -closed[0].gap;
        let expected = uniform(0.3, penetration);
        let (mut error, mut pressure) = (0.0_f64, 0.0_f64);
        for sigma in &body.particles.sigma {
            error = error.max((sigma[2][2] / expected - 1.0).abs());
        }
        for knot in closed {
            pressure = pressure.max((knot.pressure / -expected - 1.0).abs());
        }
        assert!(error < 1e-12, "{angle}: stress off by {error:e}");
        assert!(pressure < 1e-10, "{angle}: pressure off by {pressure:e}");
        let of_body = forces.reactions[forces.reactions.len() - 2];
        assert!((of_body[2] / (16.0 * expected) - 1.0).abs() < 1e-10);
        assert!(of_body[0].abs() < 1e-9 && of_body[1].abs() < 1e-9);
        assert!(report.iterations <= 6, "{} corrections", report.iterations);
    }
}

/// A plate on a block of 6 × 3 cells that stands on a rough floor, and how it is driven.
fn under_a_plate(interface: &Interface) -> (Body<2>, StepConditions<2>) {
    let grid = unit_cells([10, 6]);
    let mut body = Body::new(soil([2, 0], [8, 3]));
    let corners = [[-2.0, 0.0], [2.0, 0.0], [2.0, 1.0], [-2.0, 1.0]];
    let surface = Surface::polygon(&corners, 0.0, 1.0).unwrap();
    let sides = vec![interface.clone(); 4];
    body.rigid = vec![RigidBody::new(surface, sides, [5.0, 3.0])];
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 1, false, 0).unwrap();
    constraints.fix_wall(&grid, 1, false, 1).unwrap();
    let loads = StepLoads::gravity([0.0; 2]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![law(0.3)]).unwrap();
    (body, conditions)
}

fn advance(
    body: &mut Body<2>,
    conditions: &StepConditions<2>,
    motion: RigidMotion<2>,
) -> (StepReport, NodalForces<2>) {
    let conditions = conditions.clone().with_motions(vec![motion]).unwrap();
    step(
        body,
        &Method::igimp_bbar(),
        &conditions,
        (0.0, 1.0),
        &NewtonSettings::default(),
        &mut workspace(),
    )
    .unwrap()
}

/// A plate that is pushed by a force off its middle, free to sink, slide and tilt: what the floor
/// carries is that force, and its moment.
#[test]
fn a_free_plate_hands_its_load_to_the_floor() {
    let (mut body, conditions) = under_a_plate(&Interface::rough());
    advance(&mut body, &conditions, RigidMotion::displaced([0.0, -0.05]));
    let (force, moment) = ([1.0, -20.0], -8.0);
    let motion = RigidMotion {
        displacement: force.map(Drive::Loaded),
        rotation: [Drive::Loaded(moment), Drive::Moved(0.0), Drive::Moved(0.0)],
        ..RigidMotion::held()
    };
    let before = body.rigid[0].pose.origin;
    let (report, forces) = advance(&mut body, &conditions, motion);
    assert!(report.iterations <= 9, "{} corrections", report.iterations);
    let after = body.rigid[0].pose.origin;
    let (mut sum, mut about) = ([0.0; 2], 0.0);
    for node in 0..conditions.grid.node_count() {
        let x = conditions.grid.node_position(node);
        let reaction = forces.reactions[node];
        for axis in 0..2 {
            sum[axis] += reaction[axis];
        }
        about += (x[0] - after[0]) * reaction[1] - (x[1] - after[1]) * reaction[0];
    }
    for axis in 0..2 {
        assert!((sum[axis] + force[axis]).abs() < 1e-7, "{sum:?}");
    }
    // Normals are those of the step's start, arms those of its end: the moment is right to what slips in a step.
    assert!((about + moment).abs() < 5e-3 * moment.abs(), "{about}");
    assert!(body.rigid[0].pose.angle[0] < -1e-3);
    assert!(after[0] > before[0]);
}

/// Soil lets go of a plate that is lifted, stands without force, and carries again when the plate comes
/// back: as much as before.
#[test]
fn soil_lets_go_and_carries_again() {
    let (mut body, conditions) = under_a_plate(&Interface::smooth());
    let down = RigidMotion::displaced([0.0, -0.1]);
    let up = RigidMotion::displaced([0.0, 0.2]);
    let back = RigidMotion::displaced([0.0, -0.2]);
    let of_body = |forces: &NodalForces<2>| forces.reactions[forces.reactions.len() - 2][1];
    let (_, pressed) = advance(&mut body, &conditions, down);
    let first = of_body(&pressed);
    assert!(first < -1.0);
    let (_, lifted) = advance(&mut body, &conditions, up);
    assert!(of_body(&lifted).abs() < 1e-9, "{}", of_body(&lifted));
    assert!(
        !body.rigid[0]
            .contact
            .knots
            .iter()
            .any(|knot| knot.is_closed)
    );
    let (_, again) = advance(&mut body, &conditions, back);
    let second = of_body(&again);
    assert!((second / first - 1.0).abs() < 0.01, "{first} {second}");
}

/// A plate that carries no shear takes the way of a smooth one, step by step and correction by correction.
#[test]
fn friction_of_nothing_is_smooth() {
    let without = Interface {
        shear: Shear::Limited {
            adhesion: Vec::new(),
            varies: false,
            friction: 0.0,
        },
        tension: Tension::None,
    };
    let pushed = |interface: &Interface| {
        let (mut body, conditions) = under_a_plate(interface);
        let down = [0.0, -0.1];
        let along = [0.1, -0.02];
        [down, along].map(|motion| {
            let motion = RigidMotion::displaced(motion);
            let (report, forces) = advance(&mut body, &conditions, motion);
            (report.residuals, forces.reactions)
        })
    };
    assert_eq!(pushed(&without), pushed(&Interface::smooth()));
}

/// A plate that is loaded while no soil touches it, or free to slide on a smooth base: the failure names what
/// nothing holds.
#[test]
fn a_plate_that_nothing_holds_is_named() {
    let attempt = |lifted: f64, motion: &RigidMotion<2>| {
        let (mut body, conditions) = under_a_plate(&Interface::smooth());
        "plate".clone_into(&mut body.rigid[0].name);
        body.rigid[0].pose.origin[1] += lifted;
        advance(&mut body, &conditions, RigidMotion::displaced([0.0, -0.05]));
        let conditions = conditions.with_motions(vec![motion.clone()]).unwrap();
        let failed = step(
            &mut body,
            &Method::igimp_bbar(),
            &conditions,
            (0.0, 1.0),
            &NewtonSettings::default(),
            &mut workspace(),
        );
        *failed.unwrap_err().failure
    };
    let held = RigidMotion::held();
    let mut loaded = held.clone();
    loaded.displacement[1] = Drive::Loaded(-20.0);
    let mut free = held;
    free.displacement[0] = Drive::Loaded(0.0);
    for (lifted, motion, component, touches) in [
        (2.0, loaded, Component::Displacement(1), false),
        (0.0, free, Component::Displacement(0), true),
    ] {
        let failure = attempt(lifted, &motion);
        let body = "plate".to_owned();
        let expected = StepFailure::NotHeld {
            body,
            component,
            touches,
        };
        assert_eq!(failure, expected);
    }
}

/// A step in statics turns a free body by no more than 0.1, and says so of one that would.
/// ORACLE: soil is elastic: rotations of 0.05 and 0.2 rad by the moment of a small one.
#[test]
fn a_plate_that_a_step_turns_far_is_refused() {
    let turned = |moment: f64| {
        let (mut body, conditions) = under_a_plate(&Interface::smooth().bonded());
        "plate".clone_into(&mut body.rigid[0].name);
        advance(&mut body, &conditions, RigidMotion::displaced([0.0, -1e-6]));
        let mut motion = RigidMotion::held();
        motion.rotation[0] = Drive::Loaded(moment);
        let conditions = conditions.with_motions(vec![motion]).unwrap();
        let done = step(
            &mut body,
            &Method::igimp_bbar(),
            &conditions,
            (0.0, 1.0),
            &NewtonSettings::default(),
            &mut workspace(),
        );
        done.map(|_| body.rigid[0].pose.angle[0])
            .map_err(|error| *error.failure)
    };
    let stiffness = 1.0 / turned(1.0).unwrap();
    let small = turned(0.05 * stiffness).unwrap();
    assert!((small / 0.05 - 1.0).abs() < 0.2, "{small}");
    match turned(0.2 * stiffness) {
        Err(StepFailure::Thrown { body, rotation, .. }) => {
            assert!(
                body == "plate" && (rotation / 0.2 - 1.0).abs() < 0.4,
                "{rotation}"
            );
        }
        other => panic!("{other:?}"),
    }
}

/// A bonded plate pulls as it pushes.
#[test]
fn a_bonded_plate_pulls() {
    let force = |travel: f64| {
        let (mut body, conditions) = under_a_plate(&Interface::smooth().bonded());
        advance(&mut body, &conditions, RigidMotion::displaced([0.0, -1e-6]));
        let (_, forces) = advance(
            &mut body,
            &conditions,
            RigidMotion::displaced([0.0, travel]),
        );
        forces.reactions[forces.reactions.len() - 2][1]
    };
    let (pull, push) = (force(1e-4), force(-1e-4));
    assert!(pull > 0.0 && push < 0.0);
    assert!((pull / -push - 1.0).abs() < 0.03, "{pull} {push}");
}

#[test]
fn steps_have_the_same_bits_on_one_two_and_seven_threads() {
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let (mut body, conditions) = under_a_plate(&Interface::friction(0.3));
            advance(&mut body, &conditions, RigidMotion::displaced([0.0, -0.05]));
            let motion = RigidMotion {
                displacement: [Drive::Moved(0.1), Drive::Loaded(-15.0)],
                rotation: [Drive::Loaded(-4.0), Drive::Moved(0.0), Drive::Moved(0.0)],
                ..RigidMotion::held()
            };
            let (_, forces) = advance(&mut body, &conditions, motion);
            let slips = body.rigid[0].contact.knots.iter().any(|knot| knot.slips);
            assert!(slips, "the plate slides");
            format!("{body:?} {forces:?}")
        })
    };
    let one = bits(1);
    assert_eq!(one, bits(2));
    assert_eq!(one, bits(7));
}
