//! GOAL: free fields beside the sides of a body feed its dashpots: level ground does not see that it ends, a slope sends waves out, and
//! what is at rest stays there.
//! BODY: layers and steps of 2 × 2 particles per unit cell, elastic, on a rigid base that a pulse moves.
//! ORACLE: a laminar box; a model five times as wide, before anything comes back from its ends; equilibrium.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::body_support::{POISSON, YOUNG, block, elastic, unit_grid, workspace};
use crate::ground::{Motion, TIGHT, linear};
use igimp_assembly::{
    AbsorbingWall, Constraints, Geometry, Kinematics, Method, Particles, Rayleigh, StepConditions,
    StepLoads, TiedWalls, TimeScheme, WallNode,
};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_solver::{Body, FreeField, step};

/// Speed of shear waves \[length/time\]: unit density.
fn shear_speed() -> f64 {
    (YOUNG / (2.0 * (1.0 + POISSON))).sqrt()
}

/// Dashpots and soft springs at both sides.
fn sides(spring: f64) -> Vec<AbsorbingWall<2>> {
    [false, true]
        .map(|upper| AbsorbingWall {
            normal: 0,
            upper,
            spring: [spring; 2],
        })
        .to_vec()
}

/// Soil of unit density on a rigid base: `cells` along, as high as `height` says of the middle of each, three times as stiff in
/// the lowest two cells.
fn ground(cells: usize, height: impl Fn(f64) -> f64) -> (Body<2>, StepConditions<2>) {
    let grid = unit_grid([cells, 9]);
    let all = block(&grid, [0, 0], [cells, 8]).particles;
    let is_below = |p: usize| all.x[p][1] < height(all.x[p][0].floor() + 0.5);
    let mut fields = all.keeping(is_below).unwrap().into_fields();
    for (law, x) in fields.law.iter_mut().zip(&fields.x) {
        *law = usize::from(x[1] < 2.0);
    }
    for (k, number) in fields.number.iter_mut().enumerate() {
        *number = k;
    }
    let mut constraints = Constraints::free(&grid);
    for axis in 0..2 {
        constraints.fix_wall(&grid, 1, false, axis).unwrap();
    }
    let stiff = HenckyElastic::new(Elasticity::new(3.0 * YOUNG, POISSON).unwrap());
    let laws = vec![elastic(), Arc::new(stiff)];
    let loads = StepLoads::gravity([0.0; 2]);
    let conditions = StepConditions::new(grid, constraints, loads, laws).unwrap();
    (
        Body::new(Particles::from_fields(fields).unwrap()),
        conditions,
    )
}

/// Lets columns of soil move beside both sides.
fn with_free_fields(motion: &mut Motion<2>) {
    let Motion {
        body,
        conditions,
        method,
        ..
    } = motion;
    body.free_fields = [false, true]
        .map(|upper| FreeField::beside(&body.particles, method, conditions, (0, upper)).unwrap())
        .to_vec();
}

/// Acceleration of the base: a smooth pulse as long as a shear wave takes through `way` \[length/time²\].
fn pulse(way: f64) -> impl Fn(f64) -> f64 {
    let duration = way / shear_speed();
    move |t: f64| {
        if t < duration {
            1e-3 * (2.0 * PI * t / duration).sin()
        } else {
            0.0
        }
    }
}

/// The largest difference of the displacements of two bodies, and the largest displacement \[length\].
fn difference(a: &Body<2>, b: &Body<2>) -> (f64, f64) {
    let (a, b) = (&a.particles.displacement, &b.particles.displacement);
    let largest = |m: f64, x: f64| m.max(x.abs());
    let size = a.as_flattened().iter().copied().fold(0.0, largest);
    let pairs = std::iter::zip(a.as_flattened(), b.as_flattened());
    (pairs.map(|(a, b)| a - b).fold(0.0, largest), size)
}

/// Level ground in layers, damped, after 40 steps of a pulse between walls, with free fields beside its sides or as a laminar box that is
/// tied as firmly as the columns are.
fn level_ground(
    time: (f64, TimeScheme),
    walls: Vec<AbsorbingWall<2>>,
    (is_box, has_free_fields): (bool, bool),
) -> Body<2> {
    let (body, mut conditions) = ground(5, |_| 8.0);
    if walls.iter().any(|wall| wall.normal == 1) {
        // Dashpots hold the base along the motion.
        let mut constraints = Constraints::free(&conditions.grid);
        (constraints.fix_wall(&conditions.grid, 1, false, 1)).unwrap();
        conditions.constraints = constraints;
    }
    let damping = Rayleigh {
        mass: 0.02,
        stiffness: 0.02,
    };
    let conditions = conditions.with_damping(Some(damping)).unwrap();
    let mut motion = Motion::new(body, conditions, walls, time);
    if is_box {
        motion.walls.tied = Some(TiedWalls {
            axis: 0,
            stiffness: 1e6,
        });
    }
    if has_free_fields {
        with_free_fields(&mut motion);
    }
    for _ in 0..40 {
        let energy = motion.step(pulse(10.0)).energy.unwrap();
        let size = energy.kinetic + energy.elastic.abs() + energy.loads.abs();
        assert!(energy.imbalance().abs() < 1e-9 * size, "{energy:?}");
    }
    motion.body
}

/// GOAL: level ground in layers, damped, with free fields moves as a laminar box does, by every scheme, on a rigid and on a compliant
/// base; with dashpots against the base alone it does not.
/// ORACLE: the laminar box. At the corners two walls meet: the dashpots of the base move against the ground below, those of the side
/// against the free field.
#[test]
fn level_ground_with_free_fields_is_a_laminar_box() {
    for scheme in [
        TimeScheme::Newmark,
        TimeScheme::GeneralisedAlpha,
        TimeScheme::BackwardEuler,
    ] {
        let time = (0.5 / shear_speed(), scheme);
        let base = AbsorbingWall {
            normal: 1,
            upper: false,
            spring: [0.0; 2],
        };
        for base in [Vec::new(), vec![base]] {
            let beside_base = [sides(0.1), base.clone()].concat();
            let laminar = level_ground(time, base, (true, false));
            let free = level_ground(time, beside_base.clone(), (false, true));
            let (error, size) = difference(&laminar, &free);
            assert!(error < 1e-6 * size, "{scheme:?}: {error:e} of {size:e}");
            let still = level_ground(time, beside_base, (false, false));
            let (error, size) = difference(&laminar, &still);
            assert!(error > 0.1 * size, "{scheme:?}: {error:e} of {size:e}");
        }
    }
}

/// GOAL: a slope whose sides are of different height moves as the same slope far from any side does, the closer the farther its sides
/// are; against still ground it is further off at any distance.
/// CASE: a step from 8 to 5 cells of height, 5, 10 and 20 cells from either side, shaken by its base, damped by 5 %.
/// ORACLE: the same 40 cells from either side. The error near the sides is waves along the layer, that are slow near its own
/// frequency and do not meet the dashpots head on.
#[test]
fn a_slope_between_free_fields_moves_as_one_far_from_its_sides() {
    let wide = crest(40, true);
    let largest = |m: f64, x: f64| m.max(x.abs());
    let size = wide.as_flattened().iter().copied().fold(0.0, largest);
    let error_of = |way: &[[f64; 2]]| {
        let pairs = std::iter::zip(way.as_flattened(), wide.as_flattened());
        pairs.map(|(a, b)| a - b).fold(0.0, largest) / size
    };
    let mut before = f64::INFINITY;
    for margin in [5, 10, 20] {
        let [free, still] = [true, false].map(|is_free| error_of(&crest(margin, is_free)));
        println!("{margin} cells: free fields {free:.4}, dashpots {still:.4}");
        assert!(free < 0.5 * still, "{margin}: {free} {still}");
        assert!(free < before, "{margin}: {free} {before}");
        before = free;
    }
    assert!(before < 0.05, "{before}");
}

/// The way of the crest of a step, by step of time, that stands so many cells from the sides.
fn crest(margin: usize, has_free_fields: bool) -> Vec<[f64; 2]> {
    let foot = margin as f64;
    let height = move |x: f64| {
        if x < foot {
            8.0
        } else {
            (8.0 - (x - foot)).max(5.0)
        }
    };
    let (body, conditions) = ground(2 * margin + 4, height);
    let frequency = shear_speed() / 32.0;
    let damping = Rayleigh::at([0.05; 2], [frequency, 5.0 * frequency]);
    let conditions = conditions.with_damping(Some(damping)).unwrap();
    let at = [foot - 0.25, 7.75];
    let near = |x: &[f64; 2]| (x[0] - at[0]).abs() + (x[1] - at[1]).abs() < 0.1;
    let particle = body.particles.x.iter().position(near).unwrap();
    let time = (0.6 / shear_speed(), TimeScheme::Newmark);
    let mut motion = Motion::new(body, conditions, sides(0.05), time);
    if has_free_fields {
        with_free_fields(&mut motion);
    }
    (0..60)
        .map(|_| {
            motion.step(pulse(8.0));
            motion.body.particles.displacement[particle]
        })
        .collect()
}

/// GOAL: a pulse from within leaves through the sides as through dashpots alone: less than a hundredth of it comes back.
/// CASE: a strip of 40 × 2 cells that cannot rise, a pulse of compression in its middle that goes both ways.
/// ORACLE: a strip without ends reflects nothing; the root of the energy that is left is what came back.
#[test]
fn a_pulse_from_within_leaves_beside_free_fields() {
    let grid = unit_grid([40, 2]);
    let body = block(&grid, [0, 0], [40, 2]);
    let speed = |x: f64| 1e-3 * (-((x - 20.0) / 3.0).powi(2)).exp();
    let velocities = (body.particles.x.iter())
        .map(|x| [speed(x[0]), 0.0])
        .collect();
    let body = Body::new(body.particles.with_velocities(velocities).unwrap());
    let kinetic = |body: &Body<2>| -> f64 {
        std::iter::zip(&body.particles.mass, &body.particles.velocity)
            .map(|(m, v)| 0.5 * m * (v[0] * v[0] + v[1] * v[1]))
            .sum()
    };
    let start = kinetic(&body);
    let mut constraints = Constraints::free(&grid);
    for upper in [false, true] {
        constraints.fix_wall(&grid, 1, upper, 1).unwrap();
    }
    let loads = StepLoads::gravity([0.0; 2]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![elastic()]).unwrap();
    let compression = (YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))).sqrt();
    let time = (0.5 / compression, TimeScheme::Newmark);
    let mut motion = Motion::new(body, conditions, sides(0.0), time);
    with_free_fields(&mut motion);
    let mut left = 0.0;
    for _ in 0..110 {
        let energy = motion.step(|_| 0.0).energy.unwrap();
        left = energy.kinetic + energy.elastic;
    }
    let back = (left / start).sqrt();
    println!("reflected {back:.5}");
    assert!(back < 0.01, "{back}");
    for column in &motion.body.free_fields {
        let fastest = column.particles.velocity.as_flattened();
        assert!(fastest.iter().all(|v| v.abs() < 1e-15), "the column rests");
    }
}

/// GOAL: a slope at rest stays at rest when free fields and dashpots take the place of its rollers, to round-off.
/// ORACLE: equilibrium, on cells that stay and on cells that move with nothing.
#[test]
fn a_slope_at_rest_stays_at_rest_beside_free_fields() {
    let (mut body, mut conditions) = ground(10, |x| (8.0 - 0.4 * x).round());
    conditions.loads = StepLoads::gravity([0.0, -0.05]);
    let mut held = conditions.clone();
    for upper in [false, true] {
        held.constraints.fix_wall(&held.grid, 0, upper, 0).unwrap();
    }
    let method = Method {
        geometry: Geometry::Given,
        kinematics: Kinematics::FiniteStrain,
        ..linear()
    };
    let (_, forces) = step(
        &mut body,
        &method,
        &held,
        (0.0, 1.0),
        &TIGHT,
        &mut workspace(),
    )
    .unwrap();
    let before = body.clone();
    for scheme in [TimeScheme::BackwardEuler, TimeScheme::GeneralisedAlpha] {
        let time = (0.5 / shear_speed(), scheme);
        let mut motion = Motion::new(before.clone(), conditions.clone(), sides(0.1), time);
        motion.method = method.clone();
        let nodes = forces.reactions.iter().enumerate();
        let at_side = |node: usize| [0, 10].contains(&conditions.grid.node_place(node)[0]);
        motion.walls.nodes = Arc::new(
            nodes
                .map(|(node, force)| WallNode {
                    node,
                    force: if at_side(node) {
                        [force[0], 0.0]
                    } else {
                        [0.0; 2]
                    },
                    displacement: [0.0; 2],
                })
                .collect(),
        );
        with_free_fields(&mut motion);
        for _ in 0..20 {
            motion.step(|_| 0.0);
        }
        let (moved, size) = difference(&before, &motion.body);
        assert!(moved < 1e-9 * size, "{scheme:?}: {moved:e} of {size:e}");
    }
}
