//! GOAL: in space, without associated flow, no correction raises the residual, the last ones converge as those of Newton's method do
//! though their tangents are regularised, and a step without equilibrium ends early and does not swing.
//! BODY: a block of 10 m with a step in its surface, on its base, two sides rolling and two free, near failure.
//! ORACLE: the residuals themselves: Newton's quadratic convergence.

use std::sync::Arc;

use igimp_assembly::{
    Constraints, Method, ParticleSeed, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_linear::SolverKind;
use igimp_material::{Elasticity, MohrCoulomb};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, StepError, StepFailure, StepReport, Workspace, step};

/// A step of `g` \[m/s²\] on the block, from no load, to a relative residual of 1e-12.
fn loaded(g: f64) -> Result<StepReport, StepError> {
    let (cells, h) = (6, 10.0 / 6.0);
    let axis = Axis::uniform(0.0, h, cells + 1).unwrap();
    let grid = Grid::new(std::array::from_fn(|_| axis.clone()));
    let mut constraints = Constraints::free(&grid);
    for side in 0..2 {
        constraints.fix_wall(&grid, side, false, side).unwrap();
    }
    for direction in 0..3 {
        constraints.fix_wall(&grid, 2, false, direction).unwrap();
    }
    let mut seeds = Vec::new();
    for part in 0..8 * cells * cells * cells {
        let along = 2 * cells;
        let place = [part % along, part / along % along, part / (along * along)];
        if place[0] >= cells && place[2] >= cells {
            continue;
        }
        seeds.push(ParticleSeed {
            x: place.map(|k| 0.5 * h * (k as f64 + 0.5)),
            half_length: [0.25 * h; 3],
            volume: (0.5 * h).powi(3),
            density: 2000.0,
            law: 0,
            centroid: [0.0; _],
        });
    }
    let elasticity = Elasticity::new(1e7, 0.3).unwrap();
    let law: SharedLaw = Arc::new(MohrCoulomb::new(elasticity, 1e4, 0.35, 0.0).unwrap());
    let loads = StepLoads::gravity([0.0, 0.0, -g]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![law]).unwrap();
    let mut body = Body::new(Particles::new(&seeds).unwrap());
    let settings = NewtonSettings {
        tolerance: 1e-12,
        ..NewtonSettings::default()
    };
    let mut workspace = Workspace::new(SolverKind::Auto.build());
    let method = Method::igimp_bbar();
    let whole = (0.0, 1.0);
    step(
        &mut body,
        &method,
        &conditions,
        whole,
        &settings,
        &mut workspace,
    )
    .map(|(report, _)| report)
}

#[test]
fn near_failure_the_residual_falls_and_its_tail_is_superlinear() {
    for g in [2.2, 2.4, 2.6] {
        let report = loaded(g).unwrap();
        assert!(report.plastic_share > 0.005, "{}", report.plastic_share);
        let residuals = &report.residuals;
        assert!(residuals.is_sorted_by(|a, b| a > b), "{residuals:?}");
        let tail: Vec<f64> = residuals.iter().copied().filter(|&r| r > 1e-11).collect();
        let [.., before, last_but_one, last] = tail[..] else {
            panic!("{residuals:?}");
        };
        let order = (last / last_but_one).ln() / (last_but_one / before).ln();
        assert!(order > 1.4, "{g}: order {order}, {residuals:?}");
    }
}

/// CONTROL: the load that fails is half as much again as one that stands.
#[test]
fn beyond_failure_the_step_is_given_up_and_has_not_swung() {
    let error = loaded(4.0).unwrap_err();
    assert_eq!(*error.failure, StepFailure::Stagnated);
    let [_, first, rest @ ..] = &error.residuals[..] else {
        panic!("{error:?}");
    };
    let made = error.residuals.len() - 1;
    assert!(
        made < NewtonSettings::default().max_iterations - 5,
        "{made}"
    );
    assert!(rest.iter().all(|r| r < first), "{:?}", error.residuals);
}
