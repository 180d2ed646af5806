//! GOAL: with walls, ties and damping of soil the tangent of a step that takes time is the derivative of the internal force.
//! BODY: 4 × 3 cells with 2 × 2 particles each, moving, in both schemes of time integration.
//! ORACLE: central differences of the internal force.

use std::sync::Arc;

use crate::common::{Random, conditions, displacements, grid, laws, particles};
use igimp_assembly::{
    AbsorbingWall, GroundMotion, Method, Rayleigh, SharedLaw, Stencils, StepConditions, System,
    TiedWalls, TimeScheme, TimeStep, WallNode, Walls,
};
use igimp_material::TangentKind;
use igimp_shape::Grid;

/// A step in time between walls, ties and moving ground, in damped soil.
fn shaken(grid: &Grid<2>, law: &SharedLaw, scheme: TimeScheme) -> StepConditions<2> {
    let wall = |normal, upper| AbsorbingWall {
        normal,
        upper,
        spring: [0.3, 0.2],
    };
    let nodes = (0..grid.node_count())
        .map(|node| WallNode {
            node,
            force: [0.1, -0.2],
            displacement: [1e-3 * node as f64, 2e-3],
        })
        .collect();
    let time = TimeStep {
        duration: 0.05,
        scheme,
        lumped: 0.0,
        is_first: false,
        must_resolve: false,
    };
    let walls = Walls {
        absorbing: vec![wall(1, false), wall(0, true)],
        tied: Some(TiedWalls::across(0)),
        nodes: Arc::new(nodes),
        beside: Arc::new(Vec::new()),
    };
    let ground = GroundMotion {
        acceleration: [0.4, 0.0],
        earlier: [0.1, 0.0],
    };
    let damping = Rayleigh {
        mass: 0.7,
        stiffness: 0.02,
    };
    conditions(grid, law)
        .with_time(Some(time))
        .and_then(|step| step.with_walls(Some(walls)))
        .and_then(|step| step.with_ground(Some(ground)))
        .and_then(|step| step.with_damping(Some(damping)))
        .unwrap()
}

#[test]
fn the_tangent_of_walls_and_damping_is_the_derivative_of_the_force() {
    let mut random = Random(11);
    let grid = grid::<2>(4);
    let (_, law) = laws().remove(0);
    let method = Method::default();
    for scheme in [TimeScheme::BackwardEuler, TimeScheme::Newmark] {
        let body = particles(&grid, 0.1, &mut random);
        let velocities = (body.x.iter()).map(|x| [0.3 * x[1], 0.1 * x[0]]).collect();
        let body = body.with_velocities(velocities).unwrap();
        let conditions = shaken(&grid, &law, scheme);
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method)
            .unwrap()
            .in_motion()
            .unwrap();
        let u = displacements(&grid, 0.01, &mut random);
        let (_, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
        let unknowns = system.unknowns();
        let (mut largest, mut error) = (0.0_f64, 0.0_f64);
        for column in 0..unknowns.len() {
            let (node, axis) = unknowns.place(column).unwrap();
            let mut unit = vec![0.0; unknowns.len()];
            let mut product = unit.clone();
            unit[column] = 1.0;
            matrix.multiply(&unit, &mut product);
            let d = 1e-6;
            let force = |by: f64| {
                let mut u = u.clone();
                u[node][axis] += by;
                let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
                system.by_unknown(&trial.f_int)
            };
            for ((plus, minus), entry) in std::iter::zip(force(d), force(-d)).zip(product) {
                let difference = (plus - minus) / (2.0 * d);
                largest = largest.max(difference.abs());
                error = error.max((difference - entry).abs());
            }
        }
        assert!(error < 1e-6 * largest, "{scheme:?}: {error} of {largest}");
    }
}
