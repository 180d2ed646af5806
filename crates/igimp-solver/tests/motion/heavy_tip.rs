//! GOAL: soil beyond the faces of the cell that its nodes are tied to may be as heavy as it likes: no node has a mass below zero.
//! BODY: a bar of two cells with a tip of a tenth of a cell and two hundred times its mass, any share of the mass lumped.
//! ORACLE: free fall, g t² / 2.

use crate::body_support::{elastic, workspace};
use igimp_assembly::{
    Constraints, Method, ParticleSeed, Particles, Remedy, StepConditions, StepLoads, TimeScheme,
    TimeStep,
};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, step};

const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-11,
    max_iterations: 60,
    divergence: 1e6,
};

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
    // As stages that take time have it: small cuts are continued.
    let mut method = Method::default();
    method.small_cuts.below = 0.2;
    method.small_cuts.remedy = Remedy::Extrapolate;
    for lumped in [0.0, 0.01, 1.0] {
        let mut body = Body::new(Particles::new(&seeds).unwrap());
        let mut workspace = workspace();
        for number in 0..10 {
            let time = TimeStep {
                duration: 0.05,
                scheme: TimeScheme::GeneralisedAlpha,
                lumped,
                is_first: number == 0,
                must_resolve: false,
            };
            let conditions = conditions.clone().with_time(Some(time)).unwrap();
            step(
                &mut body,
                &method,
                &conditions,
                (0.0, 1.0),
                &TIGHT,
                &mut workspace,
            )
            .unwrap();
        }
        for own in &body.particles.displacement {
            assert!((own[0] + 0.0125).abs() < 1e-10, "{lumped}: {own:?}");
        }
    }
}
