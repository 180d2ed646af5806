//! Laws with memory: internal variables at ratios of strength and stiffness, and along a path of many steps.

use std::sync::Arc;

use igimp_material::{
    ConstitutiveModel, Elasticity, PointContext, Principal, Ratios, ScaledLaw, Strength,
};

use crate::random::Random;

#[path = "../support/hardening.rs"]
mod law;

use law::Hardening;

fn hardening(strength: f64, stiffness: f64) -> Hardening {
    Hardening {
        elasticity: Elasticity::new(100.0 * stiffness, 0.3).unwrap(),
        yield_stress: 1.5 * strength,
        modulus: 20.0 * stiffness,
        srf: 1.0,
    }
}

/// GOAL: the memory of a law at ratios is that of the law with those parameters, step after step.
/// BAND: 1e-12 of stress and strain.
#[test]
fn a_scaled_law_remembers_what_the_law_with_scaled_parameters_does() {
    let mut random = Random(7);
    for (strength, stiffness) in [(3.0, 1.0), (1.0, 0.2), (0.37, 2.3)] {
        let ratios = Ratios {
            strength,
            stiffness,
            ..Ratios::ONE
        };
        let within: Arc<dyn ConstitutiveModel> = Arc::new(hardening(1.0, 1.0));
        let scaled = ScaledLaw::new(within, ratios).unwrap();
        let made = hardening(strength, stiffness);
        let laws = [&scaled as &dyn ConstitutiveModel, &made];
        assert_eq!(scaled.internal_variables(), made.internal_variables());
        let mut histories = laws.map(|law| law.initial_history(&[0.0; 3]));
        let mut elastic = laws.map(|_| [0.0; 3]);
        for _ in 0..50 {
            let step: Principal = random.values(0.06);
            for k in 0..2 {
                let trial = std::array::from_fn(|a| elastic[k][a] + step[a]);
                let answer = laws[k]
                    .return_map(&trial, &histories[k], &PointContext::STATIC)
                    .unwrap();
                elastic[k] = laws[k]
                    .elastic_strain(&answer.tau, &answer.history)
                    .unwrap();
                histories[k] = answer.history;
                let f = laws[k].yield_function(&answer.tau, &answer.history);
                assert!(f <= 1e-12 * laws[k].stress_scale(&answer.tau), "{f}");
            }
            for (one, other) in std::iter::zip(histories[0].internal, histories[1].internal) {
                assert!(
                    (one - other).abs() <= 1e-12 * (1.0 + other.abs()),
                    "{histories:?}"
                );
            }
        }
        assert!(histories[1].internal[0] > 0.1, "{histories:?}");
        let grown = histories[1].internal[1] - 1.5 * strength;
        assert!((grown - 20.0 * stiffness * histories[1].internal[0]).abs() < 1e-12 * grown);
    }
}

/// GOAL: a reduction acts on the memory from before it, and leaves the memory as it is.
#[test]
fn a_reduction_acts_on_the_memory() {
    let law = hardening(1.0, 1.0);
    let mut history = law.initial_history(&[0.0; 3]);
    history = law
        .return_map(&[0.05, 0.0, -0.05], &history, &PointContext::STATIC)
        .unwrap()
        .history;
    let reduced = law.reduced(2.0).unwrap();
    let tau = [1.0, 0.0, -1.0];
    let share = law.utilisation(&tau, &history);
    assert!((reduced.utilisation(&tau, &history) - 2.0 * share).abs() < 1e-12);
    assert_eq!(
        reduced.initial_history(&[0.0; 3]),
        law.initial_history(&[0.0; 3])
    );
}

/// GOAL: the consistent tangent of the law of these tests is the derivative of its stress.
/// BAND: 1e-6 of the stiffness, by central differences.
#[test]
fn its_tangent_is_the_derivative_of_its_stress() {
    let law = hardening(1.0, 1.0);
    let history = law.initial_history(&[0.0; 3]);
    let strain = [0.03, -0.01, -0.05];
    let answer = law
        .return_map(&strain, &history, &PointContext::STATIC)
        .unwrap();
    assert!(answer.regime.is_plastic());
    for b in 0..3 {
        let at = |sign: f64| {
            let mut moved = strain;
            moved[b] += sign * 1e-6;
            law.return_map(&moved, &history, &PointContext::STATIC)
                .unwrap()
                .tau
        };
        let (up, down) = (at(1.0), at(-1.0));
        for a in 0..3 {
            let difference = (up[a] - down[a]) / 2e-6;
            assert!((difference - answer.tangent[a][b]).abs() < 1e-6 * 150.0);
        }
    }
}
