//! The returned stress and the plastic strain.

use igimp_material::{History, PointContext, Principal, Regime, ReturnMap};

use crate::catalogue::{Entry, all, families};
use crate::random::Random;

const HISTORY: History = History::of_plastic_strain(0.25);

fn answer(entry: &Entry, strain: &Principal) -> ReturnMap {
    entry
        .law
        .return_map(strain, &HISTORY, &PointContext::STATIC)
        .unwrap()
}

pub(crate) fn dot(a: &Principal, b: &Principal) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn size(a: &Principal) -> f64 {
    a[0].abs() + a[1].abs() + a[2].abs()
}

/// GOAL: f ≤ 1e-12 of the stress scale after every return, whatever the trial state.
/// PARAMETERS: a million states per law, among them equal principal values, states on the
/// surface, on its edges and at its vertices, strains of 1e3 and of 1e-14.
#[test]
fn every_returned_stress_is_admissible() {
    for family in families() {
        let states = 1_000_000 / family.len() + 1;
        for entry in family {
            let mut random = Random(1);
            let mut seen = Vec::new();
            for _ in 0..states {
                let strain = entry.any(&mut random);
                let answer = answer(&entry, &strain);
                let excess = entry.law.yield_function(&answer.tau, &HISTORY);
                let scale = entry.law.stress_scale(&answer.tau);
                assert!(
                    excess <= 1e-12 * scale,
                    "{}: {strain:?} {answer:?} {excess:e}",
                    entry.label
                );
                assert!(
                    scale.is_finite() && size(&answer.tau).is_finite(),
                    "{}",
                    entry.label
                );
                assert!(
                    answer
                        .tangent
                        .iter()
                        .flatten()
                        .all(|entry| entry.is_finite())
                );
                if !seen.contains(&answer.regime) {
                    seen.push(answer.regime);
                }
            }
            for regime in &entry.regimes {
                assert!(
                    seen.contains(regime),
                    "{}: never met {regime:?}",
                    entry.label
                );
            }
            assert_eq!(seen.len(), entry.regimes.len(), "{}: {seen:?}", entry.label);
        }
    }
}

/// GOAL: a stress on the surface is elastic, so that a converged state keeps its regime.
#[test]
fn a_returned_state_is_not_returned_again() {
    for entry in all() {
        let mut random = Random(2);
        for _ in 0..5_000 {
            let first = answer(&entry, &entry.general(&mut random));
            let strain = entry.law.stiffness_bound().strain(&first.tau);
            let again = answer(&entry, &strain);
            assert_eq!(again.regime, Regime::Elastic, "{}: {first:?}", entry.label);
            assert_eq!(again.history, HISTORY);
        }
    }
}

/// GOAL: `Δε_p = C⁻¹(τ_tr − τ)`, and `ε_p,eq` grows by `√(2/3 Δe_p:Δe_p)`.
#[test]
fn strain_splits_into_elastic_and_plastic() {
    for entry in all() {
        let mut random = Random(3);
        let elasticity = entry.law.stiffness_bound();
        let stiffness = 1.0 + elasticity.bulk() / elasticity.shear();
        for _ in 0..5_000 {
            let strain = entry.any(&mut random);
            let answer = answer(&entry, &strain);
            let elastic = elasticity.strain(&answer.tau);
            for a in 0..3 {
                let error = strain[a] - elastic[a] - answer.delta_eps_p[a];
                let tolerance = 1e-14 * stiffness * size(&strain);
                assert!(
                    error.abs() <= tolerance,
                    "{}: {strain:?} {error:e}",
                    entry.label
                );
            }
            let volume = answer.delta_eps_p.iter().sum::<f64>() / 3.0;
            let e_p = answer.delta_eps_p.map(|value| value - volume);
            let growth = (2.0 / 3.0 * dot(&e_p, &e_p)).sqrt();
            let grown = answer.history.eps_p_eq - HISTORY.eps_p_eq;
            assert!(
                (grown - growth).abs() <= 1e-14 * (1.0 + growth),
                "{}",
                entry.label
            );
            assert_eq!(answer.regime.is_plastic(), size(&answer.delta_eps_p) > 0.0);
        }
    }
}

/// GOAL: plastic work is not negative, also where flow is not associated. Every surface of the
/// crate holds the unstressed state, and at a vertex without cohesion the stress is zero.
#[test]
fn plastic_work_is_not_negative() {
    for entry in all() {
        let mut random = Random(4);
        for _ in 0..20_000 {
            let strain = entry.any(&mut random);
            let answer = answer(&entry, &strain);
            let work = dot(&answer.tau, &answer.delta_eps_p);
            let round_off = 1e-13 * size(&answer.tau) * size(&answer.delta_eps_p);
            assert!(
                work >= -round_off,
                "{}: {strain:?} {answer:?} {work:e}",
                entry.label
            );
        }
    }
}

/// GOAL: with associated flow the returned stress is the point of the admissible set closest to
/// the trial stress in the norm of C⁻¹: `(τ_tr − τ) · C⁻¹(σ − τ) ≤ 0` for every admissible σ.
/// This characterises the return completely.
#[test]
fn associated_returns_are_closest_points() {
    for entry in all()
        .into_iter()
        .filter(|entry| entry.law.has_symmetric_tangent())
    {
        let mut random = Random(5);
        for _ in 0..20_000 {
            let answer = answer(&entry, &entry.general(&mut random));
            let other = entry
                .law
                .return_map(&entry.any(&mut random), &HISTORY, &PointContext::STATIC)
                .unwrap()
                .tau;
            let way: Principal = std::array::from_fn(|a| other[a] - answer.tau[a]);
            let product = dot(&answer.delta_eps_p, &way);
            // Admissible states may lie 1e-12 of the stress scale outside the surface.
            let scale = entry.law.stress_scale(&other) + entry.law.stress_scale(&answer.tau);
            let round_off = 2e-12 * size(&answer.delta_eps_p) * scale;
            assert!(
                product <= round_off,
                "{}: {answer:?} {other:?} {product:e}",
                entry.label
            );
        }
    }
}

/// GOAL: the order of principal values plays no part, in stress for states of all kinds, in the
/// tangent for states of general position of which two values may be equal.
#[test]
fn permuted_strain_gives_permuted_answer() {
    for entry in all() {
        let mut random = Random(7);
        let elasticity = entry.law.stiffness_bound();
        let stiffness = elasticity.bulk() + elasticity.shear();
        for _ in 0..2_000 {
            let strain = entry.any(&mut random);
            let scale = stiffness * size(&strain);
            let admitted = 1e-12 * entry.law.stress_scale(&answer(&entry, &strain).tau);
            assert!(
                permutation_error(&entry, &strain).0 <= 1e-14 * scale + admitted,
                "{}: {strain:?}",
                entry.label
            );

            let mut strain = entry.general(&mut random);
            let [i, j] = [random.below(3), random.below(3)];
            strain[i] = strain[j];
            assert!(
                permutation_error(&entry, &strain).1 <= 1e-11 * stiffness,
                "{}: {strain:?}",
                entry.label
            );
        }
    }
}

/// Largest difference of stress and of tangent under all permutations of the strain.
fn permutation_error(entry: &Entry, strain: &Principal) -> (f64, f64) {
    let plain = answer(entry, strain);
    let mut most = (0.0_f64, 0.0_f64);
    for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let permuted = answer(entry, &order.map(|a| strain[a]));
        assert_eq!(permuted.regime, plain.regime, "{}: {strain:?}", entry.label);
        for a in 0..3 {
            most.0 = most.0.max((permuted.tau[a] - plain.tau[order[a]]).abs());
            for b in 0..3 {
                let error = permuted.tangent[a][b] - plain.tangent[order[a]][order[b]];
                most.1 = most.1.max(error.abs());
            }
        }
    }
    most
}

/// GOAL: a law yields if and only if it has a yield surface. Where it says so, some trial stress lies
/// beyond the surface and is returned; where not, f is −∞ everywhere and nothing is ever returned.
#[test]
fn a_law_that_yields_has_a_yield_surface() {
    for entry in all() {
        let mut random = Random(3);
        let (mut is_beyond, mut is_returned) = (false, false);
        for _ in 0..2_000 {
            let strain = entry.any(&mut random);
            let trial = entry.law.stiffness_bound().stress(&strain);
            let excess = entry.law.yield_function(&trial, &HISTORY);
            is_beyond |= excess > 0.0;
            is_returned |= answer(&entry, &strain).regime.is_plastic();
            let has_surface = excess > f64::NEG_INFINITY;
            assert_eq!(has_surface, entry.law.yields(), "{}", entry.label);
        }
        let yields = (entry.law.yields(), entry.law.yields());
        assert_eq!((is_beyond, is_returned), yields, "{}", entry.label);
    }
}
