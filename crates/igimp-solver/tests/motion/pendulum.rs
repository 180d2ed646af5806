//! GOAL: rigid bodies whose centre of mass is beside their reference point move by their weight as mechanics says.
//! BODY: two cells of soil at rest, and a body that nothing touches.
//! ORACLE: the physical pendulum, whose period is an elliptic integral; free flight, which turns about the centre of mass.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::body_support::{elastic, workspace};
use igimp_assembly::{
    Constraints, Drive, GroundMotion, Interface, Method, ParticleSeed, Particles, RigidBody,
    RigidMotion, StepConditions, StepLoads, Surface, TimeScheme, TimeStep,
};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, StepReport, step};

const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-12,
    max_iterations: 50,
    divergence: 1e6,
};

const MASS: f64 = 2.0;

/// Moment of inertia about the centre of mass.
const MOMENT: f64 = 1.5;

/// From the reference point to the centre of mass.
const LENGTH: f64 = 0.8;

const GRAVITY: f64 = 9.0;

fn over(duration: f64, scheme: TimeScheme) -> TimeStep {
    TimeStep {
        duration,
        scheme,
        lumped: 0.0,
        is_first: false,
        must_resolve: false,
    }
}

/// A body in the plane whose centre of mass lies below its reference point, turned by an angle \[rad\].
fn hanging(angle: f64) -> RigidBody<2> {
    let surface = Surface::circle(0.5, 0.1).unwrap();
    let mut body = RigidBody::new(surface, vec![Interface::smooth()], [8.0, 8.0]);
    body.motion.mass = MASS;
    body.motion.moments[2][2] = MOMENT;
    body.motion.centre = [0.0, -LENGTH];
    body.pose = body.pose.moved(&[0.0; 2], &[angle, 0.0, 0.0]);
    body
}

/// Marches soil at rest and a body that nothing touches; the place of the centre of mass, and what every step reports.
fn march<const D: usize>(
    body: RigidBody<D>,
    motion: RigidMotion<D>,
    ground: Option<GroundMotion<D>>,
    (time, steps): (TimeStep, usize),
    mut seen: impl FnMut(&RigidBody<D>, &StepReport),
) {
    let grid = Grid::new(std::array::from_fn(|_| {
        Axis::uniform(0.0, 1.0, 12).unwrap()
    }));
    let seeds: Vec<_> = (0..4_usize.pow(D as u32))
        .map(|k| ParticleSeed {
            x: std::array::from_fn(|axis| 0.25 + 0.5 * (k / 4_usize.pow(axis as u32) % 4) as f64),
            half_length: [0.25; D],
            volume: 0.5_f64.powi(D as i32),
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect();
    let mut soil = Body::new(Particles::new(&seeds).unwrap());
    soil.rigid = vec![body];
    let mut constraints = Constraints::free(&grid);
    for axis in 0..D {
        constraints.fix_wall(&grid, axis, false, axis).unwrap();
    }
    let conditions = StepConditions::new(
        grid,
        constraints,
        StepLoads::gravity([0.0; D]),
        vec![elastic()],
    )
    .and_then(|conditions| conditions.with_motions(vec![motion]))
    .and_then(|conditions| conditions.with_ground(ground))
    .unwrap();
    let (method, mut workspace) = (Method::default(), workspace());
    for k in 0..steps {
        let time = TimeStep {
            is_first: k == 0,
            ..time
        };
        let conditions = conditions.clone().with_time(Some(time)).unwrap();
        let (report, _) = step(
            &mut soil,
            &method,
            &conditions,
            (0.0, 1.0),
            &TIGHT,
            &mut workspace,
        )
        .unwrap();
        assert!(report.energy.unwrap().imbalance().abs() < 1e-9);
        seen(&soil.rigid[0], &report);
    }
}

/// A pendulum that is let go at an angle \[rad\], after a quarter of its period: the angle, which should be none, the energy that it
/// gained over what it had, and corrections per step.
fn quarter(angle: f64, scheme: TimeScheme, steps: usize) -> [f64; 3] {
    let about_pin = MOMENT + MASS * LENGTH * LENGTH;
    // The arithmetic-geometric mean of 1 and cos ½θ.
    let (mut a, mut b) = (1.0_f64, (0.5 * angle).cos());
    for _ in 0..6 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let period = 2.0 * PI * (about_pin / (MASS * GRAVITY * LENGTH)).sqrt() / a;
    let pinned = RigidMotion {
        rotation: [Drive::Loaded(0.0), Drive::Moved(0.0), Drive::Moved(0.0)],
        weight: [0.0, -MASS * GRAVITY],
        ..RigidMotion::held()
    };
    let time = over(0.25 * period / steps as f64, scheme);
    let fallen = MASS * GRAVITY * LENGTH * (1.0 - angle.cos());
    let (mut left, mut gained, mut corrections) = (0.0, 0.0, 0);
    march(
        hanging(angle),
        pinned,
        None,
        (time, steps),
        |body, report| {
            left = body.pose.angle[0];
            gained = report.energy.unwrap().kinetic / fallen - 1.0;
            corrections += report.iterations;
        },
    );
    [left, gained, corrections as f64 / steps as f64]
}

/// GOAL: a body that is pinned at its reference point swings by its weight, by large angles too.
/// ORACLE: the period of the physical pendulum, 2π √(I / mgL) over the arithmetic-geometric mean of 1 and cos ½θ; its kinetic energy as it
/// passes its lowest place.
#[test]
fn a_pendulum_swings() {
    for angle in [0.1, FRAC_PI_2, 2.8] {
        for (scheme, order) in [
            (TimeScheme::GeneralisedAlpha, 1.8),
            (TimeScheme::Newmark, 1.8),
            (TimeScheme::BackwardEuler, 0.85),
        ] {
            let [coarse, fine] = [40, 80].map(|steps| quarter(angle, scheme, steps));
            println!("{scheme:?} {angle}: {coarse:?} {fine:?}");
            let found = (coarse[0] / fine[0]).abs().log2();
            assert!(
                found > order && fine[2] < 5.0,
                "{scheme:?} {angle}: {coarse:?} {fine:?}"
            );
            if order > 1.0 {
                assert!(
                    (fine[0] / angle).abs() < 2e-3 && fine[1].abs() < 2e-3,
                    "{scheme:?} {angle}: {fine:?}"
                );
            }
        }
    }
}

/// GOAL: a body that is thrown goes by its centre of mass, and turns about it, wherever its reference point is.
/// ORACLE: the parabola, which Newmark's method integrates exactly, and an even spin.
#[test]
fn a_thrown_body_turns_about_its_centre_of_mass() {
    let mut body = hanging(0.4);
    body.motion.velocity = [0.5, 1.0];
    body.motion.spin[0] = 1.2;
    let free = RigidMotion {
        displacement: [Drive::Loaded(0.0); 2],
        rotation: [Drive::Loaded(0.0), Drive::Moved(0.0), Drive::Moved(0.0)],
        weight: [0.0, -MASS * GRAVITY],
    };
    let start = body.pose.into_space(&body.motion.centre);
    let (duration, steps) = (0.05, 20);
    let mut time = 0.0;
    march(
        body,
        free,
        None,
        (over(duration, TimeScheme::Newmark), steps),
        |body, report| {
            time += duration;
            let place = body.pose.into_space(&body.motion.centre);
            let exact = [
                start[0] + 0.5 * time,
                start[1] + time - 0.5 * GRAVITY * time * time,
            ];
            for (x, exact) in place.iter().zip(exact) {
                assert!((x - exact).abs() < 1e-9, "{place:?} {exact}");
            }
            assert!((body.pose.angle[0] - 0.4 - 1.2 * time).abs() < 1e-9);
            let energy = report.energy.unwrap();
            let integrated = energy.integration + energy.scheme + energy.map;
            assert!(integrated.abs() < 1e-2 * energy.loads.abs(), "{energy:?}");
        },
    );
}

/// GOAL: the same in space.
/// ORACLE: as above, about an axis aslant, with equal moments of inertia.
#[test]
fn a_thrown_body_in_space() {
    let surface = Surface::sphere(0.5, 0.25).unwrap();
    let mut body = RigidBody::new(surface, vec![Interface::smooth()], [8.0; 3]);
    body.motion.mass = MASS;
    body.motion.centre = [0.5, -0.3, 0.2];
    for axis in 0..3 {
        body.motion.moments[axis][axis] = MOMENT;
    }
    body.motion.velocity = [0.5, 0.0, 1.0];
    body.motion.spin = [0.6, -0.8, 1.0];
    let free = RigidMotion {
        displacement: [Drive::Loaded(0.0); 3],
        rotation: [Drive::Loaded(0.0); 3],
        weight: [0.0, 0.0, -MASS * GRAVITY],
    };
    let start = body.pose.into_space(&body.motion.centre);
    let duration = 0.05;
    let mut time = 0.0;
    march(
        body,
        free,
        None,
        (over(duration, TimeScheme::Newmark), 10),
        |body, _| {
            time += duration;
            let place = body.pose.into_space(&body.motion.centre);
            let exact = [
                start[0] + 0.5 * time,
                start[1],
                start[2] + time - 0.5 * GRAVITY * time * time,
            ];
            for (x, exact) in place.iter().zip(exact) {
                assert!((x - exact).abs() < 1e-9, "{place:?} {exact}");
            }
            for (rate, spin) in body.motion.spin.iter().zip([0.6, -0.8, 1.0]) {
                assert!((rate - spin).abs() < 1e-9);
            }
        },
    );
}

/// GOAL: ground that is accelerated leaves a free body behind without turning it.
/// ORACLE: its centre stays in space: −½ a t² against the ground, by any scheme of second order.
#[test]
fn ground_that_moves_does_not_turn_a_free_body() {
    let free = RigidMotion {
        displacement: [Drive::Loaded(0.0); 2],
        rotation: [Drive::Loaded(0.0), Drive::Moved(0.0), Drive::Moved(0.0)],
        weight: [0.0; 2],
    };
    let ground = GroundMotion {
        acceleration: [2.0, 0.0],
        earlier: [2.0, 0.0],
    };
    for scheme in [TimeScheme::Newmark, TimeScheme::GeneralisedAlpha] {
        let mut time = 0.0;
        march(
            hanging(0.3),
            free.clone(),
            Some(ground),
            (over(0.1, scheme), 5),
            |body, _| {
                time += 0.1;
                let [x, y] = body.pose.origin;
                assert!((x - 8.0 + time * time).abs() < 1e-10 && (y - 8.0).abs() < 1e-10);
                assert!((body.pose.angle[0] - 0.3).abs() < 1e-10);
            },
        );
    }
}

/// A free body in space that spins, marched by a scheme over 2 s in so many steps, and corrections per step.
fn tumbled(
    moments: [f64; 3],
    spin: [f64; 3],
    scheme: TimeScheme,
    steps: usize,
) -> (RigidBody<3>, f64) {
    let surface = Surface::sphere(0.5, 0.25).unwrap();
    let mut body = RigidBody::new(surface, vec![Interface::smooth()], [8.0; 3]);
    body.motion.mass = MASS;
    for axis in 0..3 {
        body.motion.moments[axis][axis] = moments[axis];
    }
    body.motion.spin = spin;
    let free = RigidMotion {
        displacement: [Drive::Loaded(0.0); 3],
        rotation: [Drive::Loaded(0.0); 3],
        weight: [0.0; 3],
    };
    let (mut end, mut corrections) = (body.clone(), 0);
    let time = over(2.0 / steps as f64, scheme);
    march(body, free, None, (time, steps), |body, report| {
        end = body.clone();
        corrections += report.iterations;
        let energy = report.energy.unwrap().kinetic;
        assert!((energy / body.kinetic_energy() - 1.0).abs() < 1e-12);
    });
    (end, corrections as f64 / steps as f64)
}

/// The angular momentum of a body in space.
fn angular_momentum(body: &RigidBody<3>) -> [f64; 3] {
    let turn = &body.pose.turn;
    let momentum: [f64; 3] = std::array::from_fn(|a| {
        let spin: f64 = (0..3).map(|b| turn[b][a] * body.motion.spin[b]).sum();
        body.motion.moments[a][a] * spin
    });
    body.pose.direction(&momentum)
}

/// The length of the difference of two vectors.
fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = std::iter::zip(a, b).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}

/// GOAL: a body with three moments of inertia that nothing turns tumbles at second order in the step, and its corrections are few.
/// ORACLE: angular momentum and kinetic energy stay, exactly.
#[test]
fn a_tumbling_body_keeps_energy_and_angular_momentum() {
    let (moments, spin) = ([1.3, 1.0, 0.4], [0.3, 4.0, 0.5]);
    let momentum: [f64; 3] = std::array::from_fn(|a| moments[a] * spin[a]);
    let energy: f64 = (0..3).map(|a| 0.5 * momentum[a] * spin[a]).sum();
    for (scheme, order, band) in [
        (TimeScheme::Newmark, 1.8, 2e-3),
        (TimeScheme::GeneralisedAlpha, 1.8, 2e-3),
        (TimeScheme::BackwardEuler, 0.8, 0.2),
    ] {
        let [coarse, fine] = [100, 200].map(|steps| {
            let (body, corrections) = tumbled(moments, spin, scheme, steps);
            let of_momentum = apart(angular_momentum(&body), momentum) / 4.1;
            [
                of_momentum,
                body.kinetic_energy() / energy - 1.0,
                corrections,
            ]
        });
        println!("{scheme:?}: {coarse:?} {fine:?}");
        for k in 0..2 {
            let found = (coarse[k] / fine[k]).abs().log2();
            assert!(
                found > order && fine[k].abs() < band,
                "{scheme:?}: {coarse:?} {fine:?}"
            );
        }
        assert!(fine[2] < 5.0, "{scheme:?}: {fine:?}");
    }
}

/// GOAL: a spinning top that nothing turns goes round as mechanics says. ORACLE: its axis and its spin go evenly round its angular
/// momentum L, at |L| over the moment of inertia across the axis.
#[test]
fn a_free_top_precesses() {
    let (moments, spin) = ([1.0, 1.0, 0.4], [1.5, 0.0, 5.0]);
    let momentum: [f64; 3] = std::array::from_fn(|a| moments[a] * spin[a]);
    let size = apart(momentum, [0.0; 3]);
    let unit = momentum.map(|x| x / size);
    // By Rodrigues, after 2 s.
    let turned = |v: [f64; 3]| {
        let (sin, cos) = (2.0 * size / moments[0]).sin_cos();
        let along: f64 = std::iter::zip(unit, v).map(|(a, b)| a * b).sum();
        std::array::from_fn(|a| {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            let across = unit[b] * v[c] - unit[c] * v[b];
            cos * v[a] + sin * across + (1.0 - cos) * along * unit[a]
        })
    };
    for scheme in [TimeScheme::Newmark, TimeScheme::GeneralisedAlpha] {
        let [coarse, fine] = [100, 200].map(|steps| {
            let (body, _) = tumbled(moments, spin, scheme, steps);
            let axis = body.pose.direction(&[0.0, 0.0, 1.0]);
            [
                apart(axis, turned([0.0, 0.0, 1.0])),
                apart(body.motion.spin, turned(spin)) / 5.0,
            ]
        });
        println!("{scheme:?}: {coarse:?} {fine:?}");
        for k in 0..2 {
            let found = (coarse[k] / fine[k]).log2();
            assert!(
                found > 1.8 && fine[k] < 1e-2,
                "{scheme:?}: {coarse:?} {fine:?}"
            );
        }
    }
}
