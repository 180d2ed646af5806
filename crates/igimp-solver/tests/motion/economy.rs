//! GOAL: what makes motion cheap changes nothing that a step resolves: equilibrium to no more digits than the time integration
//! has, ties that carry more mass than the nodes that they hang on.
//! BODY: a block of sand that is let go; a bar with a heavy tip beyond its last full cell.
//! ORACLE: the same steps in equilibrium to round-off; free fall.

use std::sync::Arc;

use crate::body_support::{POISSON, YOUNG, block, elastic, unit_grid, workspace};
use igimp_assembly::{
    Constraints, Method, ParticleSeed, Particles, Remedy, SharedLaw, StepConditions, StepLoads,
    TimeScheme, TimeStep,
};
use igimp_material::{Elasticity, MohrCoulomb};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, step};

const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-11,
    max_iterations: 60,
    divergence: 1e6,
};

/// As stages that take time have it: small cuts are continued, a share of the mass is lumped.
fn method() -> Method {
    let mut method = Method::default();
    method.small_cuts.below = 0.2;
    method.small_cuts.remedy = Remedy::Extrapolate;
    method
}

fn over(duration: f64, lumped: f64) -> TimeStep {
    TimeStep {
        duration,
        scheme: TimeScheme::GeneralisedAlpha,
        lumped,
        is_first: false,
        must_resolve: false,
        equilibrium: 0.0,
    }
}

/// Marches by equal steps; all corrections.
fn march<const D: usize>(
    body: &mut Body<D>,
    conditions: &StepConditions<D>,
    time: TimeStep,
    steps: usize,
) -> usize {
    let mut workspace = workspace();
    let mut corrections = 0;
    for number in 0..steps {
        let time = TimeStep {
            is_first: number == 0,
            ..time
        };
        let conditions = conditions.clone().with_time(Some(time)).unwrap();
        let (method, from_to) = (method(), (0.0, 1.0));
        let (report, _) =
            step(body, &method, &conditions, from_to, &TIGHT, &mut workspace).unwrap();
        assert!(!report.at_round_off || time.equilibrium == 0.0);
        let energy = report.energy.unwrap();
        let size = energy.kinetic + energy.elastic.abs() + energy.loads.abs();
        assert!(energy.imbalance().abs() < 1e-9 * size, "{energy:?}");
        corrections += report.iterations;
    }
    corrections
}

/// GOAL: a residual that adds a hundredth of the aimed error to the motion of a step (theory, eq. 68a) changes the way of sand by as
/// little, and saves corrections; the energy closes with the work of what is left.
/// ORACLE: the same steps to round-off.
#[test]
fn equilibrium_need_not_be_better_than_the_time_integration() {
    let grid = unit_grid([10, 6]);
    let gravity = 1e-3 * YOUNG;
    let release = |equilibrium: f64| {
        let mut body = block(&grid, [0, 0], [4, 4]);
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0).unwrap();
        for axis in 0..2 {
            constraints.fix_wall(&grid, 1, false, axis).unwrap();
        }
        let elasticity = Elasticity::new(YOUNG, POISSON).unwrap();
        let friction = 0.5;
        let sand = MohrCoulomb::new(elasticity, 0.05 * gravity, friction, 0.0).unwrap();
        let sand: SharedLaw = Arc::new(sand);
        let loads = StepLoads::gravity([0.0, -gravity]);
        let conditions = StepConditions::new(grid.clone(), constraints, loads, vec![sand]).unwrap();
        let time = TimeStep {
            equilibrium,
            ..over(0.03 * (4.0 / gravity).sqrt(), 0.01)
        };
        let corrections = march(&mut body, &conditions, time, 30);
        (body.particles.displacement.clone(), corrections)
    };
    let (close, dear) = release(0.0);
    let (loose, cheap) = release(0.01);
    let largest = |m: f64, own: f64| m.max(own.abs());
    let way = close.as_flattened().iter().copied().fold(0.0, largest);
    let pairs = std::iter::zip(close.as_flattened(), loose.as_flattened());
    let error = pairs.map(|(a, b)| a - b).fold(0.0, largest);
    println!("{dear} and {cheap} corrections; {error:e} of {way:e}");
    assert!(way > 0.3, "the sand spreads: {way}");
    assert!(error < 0.01 * way, "{error:e} of {way:e}");
    assert!(5 * cheap < 4 * dear, "{cheap} corrections, {dear} before");
}

/// GOAL: soil beyond the faces of the cell that its nodes are tied to may be as heavy as it likes: no node has a mass below zero.
/// CASE: a bar of two cells with a tip of a tenth of a cell and two hundred times its mass, any share of the mass lumped.
/// ORACLE: free fall, g t² / 2.
#[test]
fn a_bar_with_a_heavy_tip_falls_freely() {
    let seed = |x: f64, half: f64, density: f64| ParticleSeed {
        x: [x],
        half_length: [half],
        volume: 2.0 * half,
        density,
        law: 0,
        centroid: [0.0; _],
    };
    let mut seeds: Vec<_> = (0..4)
        .map(|k| seed(2.25 + 0.5 * f64::from(k), 0.25, 1.0))
        .collect();
    seeds.push(seed(4.05, 0.05, 4000.0));
    let grid = Grid::new([Axis::uniform(0.0, 1.0, 6).unwrap()]);
    let loads = StepLoads::gravity([-0.1]);
    let constraints = Constraints::free(&grid);
    let conditions = StepConditions::new(grid, constraints, loads, vec![elastic()]).unwrap();
    for lumped in [0.0, 0.01, 1.0] {
        let mut body = Body::new(Particles::new(&seeds).unwrap());
        march(&mut body, &conditions, over(0.05, lumped), 10);
        for own in &body.particles.displacement {
            assert!((own[0] + 0.0125).abs() < 1e-10, "{lumped}: {own:?}");
        }
    }
}
