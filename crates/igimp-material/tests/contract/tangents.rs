//! The consistent tangent in principal space.

use igimp_material::{History, PointContext, Principal};

use crate::catalogue::{Entry, all};
use crate::random::Random;

/// Stress at `strain` with `step` added to component `b`, if in the same regime and order.
fn moved(entry: &Entry, strain: &Principal, b: usize, step: f64) -> Option<Principal> {
    let history = History::default();
    let order = |s: &Principal| [s[0] > s[1], s[1] > s[2], s[0] > s[2]];
    let mut other = *strain;
    other[b] += step;
    let answer = entry
        .law
        .return_map(&other, &history, &PointContext::STATIC)
        .unwrap();
    let same = answer.regime
        == entry
            .law
            .return_map(strain, &history, &PointContext::STATIC)
            .unwrap()
            .regime;
    (same && order(&other) == order(strain)).then_some(answer.tau)
}

/// GOAL: D = ∂τ/∂ε within 1e-8 of 2G, by fourth-order differences that stay in one regime.
#[test]
fn tangent_is_the_derivative_of_stress() {
    for entry in all() {
        let mut random = Random(8);
        let shear = entry.law.stiffness_bound().shear();
        let mut seen = Vec::new();
        for _ in 0..20_000 {
            let strain = entry.general(&mut random);
            let answer = entry
                .law
                .return_map(&strain, &History::default(), &PointContext::STATIC)
                .unwrap();
            let spread = strain.iter().fold(f64::MIN, |most, value| most.max(*value))
                - strain
                    .iter()
                    .fold(f64::MAX, |least, value| least.min(*value));
            // Where the mean strain dwarfs the deviator, differences have too few digits.
            if spread
                < 0.1
                    * strain
                        .iter()
                        .fold(0.0, |most: f64, value| most.max(value.abs()))
            {
                continue;
            }
            for b in 0..3 {
                let h = 2e-3 * spread;
                let taus = [-2.0, -1.0, 1.0, 2.0].map(|k| moved(&entry, &strain, b, k * h));
                let [Some(far_left), Some(left), Some(right), Some(far_right)] = taus else {
                    continue;
                };
                for a in 0..3 {
                    let slope =
                        (8.0 * (right[a] - left[a]) - (far_right[a] - far_left[a])) / (12.0 * h);
                    let error = (slope - answer.tangent[a][b]).abs() / (2.0 * shear);
                    assert!(
                        error < 1e-8,
                        "{}: {strain:?} {answer:?} {error:e}",
                        entry.label
                    );
                }
                if !seen.contains(&answer.regime) {
                    seen.push(answer.regime);
                }
            }
        }
        // Near incompressibility some regimes are too thin for a step of the differences.
        if entry.law.stiffness_bound().poisson() < 0.499 {
            assert_eq!(seen.len(), entry.regimes.len(), "{}: {seen:?}", entry.label);
        }
    }
}

/// GOAL: the tangent is symmetric where flow is associated, and only there.
#[test]
fn tangent_is_symmetric_with_associated_flow() {
    for entry in all() {
        let mut random = Random(9);
        let mut most = 0.0_f64;
        for _ in 0..5_000 {
            let strain = entry.any(&mut random);
            let tangent = entry
                .law
                .return_map(&strain, &History::default(), &PointContext::STATIC)
                .unwrap()
                .tangent;
            for (a, b) in [(0, 1), (0, 2), (1, 2)] {
                most = most.max((tangent[a][b] - tangent[b][a]).abs());
            }
        }
        let (bulk, shear) = (
            entry.law.stiffness_bound().bulk(),
            entry.law.stiffness_bound().shear(),
        );
        let relative = most / bulk;
        if entry.law.has_symmetric_tangent() {
            // Digits are lost to the ratio of the moduli near incompressibility.
            assert!(
                relative < 1e-15 * (10.0 + bulk / shear),
                "{}: {relative:e}",
                entry.label
            );
        } else {
            assert!(relative > 1e-2, "{}: {relative:e}", entry.label);
        }
    }
}
