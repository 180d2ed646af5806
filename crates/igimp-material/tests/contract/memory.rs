//! Laws with memory and with elasticity that is not linear: the demands of `returns` and `tangents` on the others.

use igimp_material::{
    CamClayParameters, ConstitutiveModel, History, MaterialError, ModifiedCamClay, PointContext,
    Principal, ShearStiffness, Strength,
};

use crate::random::Random;
use crate::returns::{dot, size};

/// λ*, κ*, M, shear stiffness, ratio of overconsolidation, reference pressure.
const CAM_CLAY: [(f64, f64, f64, ShearStiffness, f64, f64); 7] = [
    (
        0.10,
        0.02,
        1.0,
        ShearStiffness::Constant(2000.0),
        1.0,
        100.0,
    ),
    (0.10, 0.02, 1.0, ShearStiffness::Poisson(0.2), 1.5, 100.0),
    (0.08, 0.01, 1.2, ShearStiffness::Poisson(0.3), 8.0, 1.0),
    (0.25, 0.05, 0.7, ShearStiffness::Poisson(0.0), 2.0, 5e4),
    (0.02, 0.004, 1.4, ShearStiffness::Poisson(0.45), 1.0, 1e5),
    (0.15, 0.05, 0.9, ShearStiffness::Constant(3e6), 30.0, 1e5),
    (0.0248, 0.024, 1.0, ShearStiffness::Poisson(0.2), 1.0, 1e5),
];

pub(crate) fn laws() -> Vec<ModifiedCamClay> {
    let law = |(compression, swelling, critical_ratio, shear, overconsolidation, reference)| {
        ModifiedCamClay::new(CamClayParameters {
            compression,
            swelling,
            critical_ratio,
            shear,
            overconsolidation,
            reference_pressure: reference,
        })
        .unwrap()
    };
    CAM_CLAY.map(law).to_vec()
}

/// A stress that soil began with, its history and its elastic strain.
pub(crate) fn start(law: &ModifiedCamClay, random: &mut Random) -> (History, Principal) {
    let p = law.parameters().reference_pressure * 10_f64.powf(random.between(-1.0, 1.5));
    let spread: Principal = random.values(0.4 * p);
    let mean = spread.iter().sum::<f64>() / 3.0;
    let sigma = spread.map(|value| value - mean - p);
    let history = law.initial_history(&sigma);
    (history, law.elastic_strain(&sigma, &history).unwrap())
}

/// A trial strain from there, of any size up to `most` \[-\], degenerate ones included.
pub(crate) fn trial(elastic: &Principal, most: f64, random: &mut Random) -> Principal {
    let size = most * 10_f64.powf(random.between(-4.0, 0.0));
    let [i, j] = [random.below(3), random.below(3)];
    let step: Principal = random.values(size);
    let mut strain: Principal = std::array::from_fn(|a| elastic[a] + step[a]);
    match random.below(8) {
        0 => strain[i] = strain[j],
        1 => strain = [strain[i]; 3],
        2 => strain = std::array::from_fn(|a| elastic[a] - step[i].abs()),
        3 => strain = std::array::from_fn(|a| elastic[a] + step[i].abs()),
        _ => {}
    }
    strain
}

/// GOAL: f ≤ 1e-12 of its scale after every return, with the memory that it left; strain splits into an elastic part that has this
/// stress and a plastic one that dissipates; the state is not returned again.
/// PARAMETERS: 25 000 states a set, steps of strain from 1e-5 to 0.3.
#[test]
fn returns_are_admissible_and_dissipate() {
    for law in laws() {
        let mut random = Random(11);
        let mut seen = [0; 2];
        for _ in 0..25_000 {
            let (history, elastic) = start(&law, &mut random);
            let strain = trial(&elastic, 0.3, &mut random);
            let answer = law
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let scale = law.stress_scale(&answer.tau);
            let excess = law.yield_function(&answer.tau, &answer.history);
            assert!(
                excess <= 1e-12 * scale,
                "{law:?} {strain:?} {answer:?} {excess:e}"
            );
            let numbers = answer.tangent.as_flattened().iter().chain(&answer.tau);
            assert!(
                numbers
                    .chain(&answer.history.internal)
                    .all(|n| n.is_finite())
            );
            let carried = law.elastic_strain(&answer.tau, &answer.history).unwrap();
            for a in 0..3 {
                let error = strain[a] - carried[a] - answer.delta_eps_p[a];
                assert!(
                    error.abs() < 1e-13,
                    "{law:?} {strain:?} {answer:?} {error:e}"
                );
            }
            let work = dot(&answer.tau, &answer.delta_eps_p);
            assert!(work >= -1e-13 * size(&answer.tau) * size(&answer.delta_eps_p));
            let again = law
                .return_map(&carried, &answer.history, &PointContext::STATIC)
                .unwrap();
            assert!(!again.regime.is_plastic() || size(&again.delta_eps_p) < 1e-13);
            seen[usize::from(answer.regime.is_plastic())] += 1;
        }
        assert!(seen.iter().all(|count| *count > 1_500), "{law:?}: {seen:?}");
    }
}

/// GOAL: no trial state, however far, gives a NaN: an answer is finite, and admissible where its stress is not
/// absurd, or it is refused in words.
#[test]
fn far_trial_states_are_answered_or_refused() {
    for law in laws() {
        let mut random = Random(12);
        let mut refused = 0;
        for _ in 0..10_000 {
            let (history, elastic) = start(&law, &mut random);
            let strain = trial(&elastic, 1e3, &mut random);
            match law.return_map(&strain, &history, &PointContext::STATIC) {
                Ok(answer) => {
                    let excess = law.yield_function(&answer.tau, &answer.history);
                    let scale = law.stress_scale(&answer.tau);
                    // The mean of a stress that is nearly all shear has the digits that shear leaves to it.
                    let steep = law.utilisation(&answer.tau, &answer.history);
                    let reach = size(&answer.tau) / law.stiffness_bound().young();
                    let is_absurd = size(&strain) > 3.0 || !(1e-12..1e12).contains(&reach);
                    assert!(
                        is_absurd || excess <= 1e-12 * (1.0 + steep) * scale,
                        "{answer:?}"
                    );
                    assert!(answer.tangent.as_flattened().iter().all(|n| n.is_finite()));
                }
                Err(MaterialError::NonFinite { .. } | MaterialError::NotConverged { .. }) => {
                    assert!(size(&strain) > 0.5, "{law:?} {strain:?} {elastic:?}");
                    refused += 1;
                }
                Err(other) => panic!("{other}"),
            }
        }
        assert!(refused < 5_000, "{refused}");
    }
}

/// GOAL: D = ∂τ/∂ε by fourth-order differences, elastic and plastic, wet and dry of the critical state.
/// BAND: 1e-7 of the largest modulus.
#[test]
fn tangents_are_derivatives() {
    for law in laws() {
        let mut random = Random(13);
        let mut seen = 0;
        for _ in 0..4_000 {
            let (history, elastic) = start(&law, &mut random);
            let strain = trial(&elastic, 0.1, &mut random);
            let answer = law
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            // Beyond, a step of the differences is no small share of the strain over which the answer changes.
            if dot(&answer.tau, &[1.0; 3]) > -0.3 * law.parameters().reference_pressure {
                continue;
            }
            let largest = answer
                .tangent
                .as_flattened()
                .iter()
                .fold(0.0, |m: f64, d| m.max(d.abs()));
            for b in 0..3 {
                let h = 5e-6 * law.parameters().swelling / 0.02;
                let at = |k: f64| {
                    let mut moved = strain;
                    moved[b] += k * h;
                    let other = law
                        .return_map(&moved, &history, &PointContext::STATIC)
                        .unwrap();
                    (other.regime == answer.regime).then_some(other.tau)
                };
                let taus = [-2.0, -1.0, 1.0, 2.0].map(at);
                let [Some(far_left), Some(left), Some(right), Some(far_right)] = taus else {
                    continue;
                };
                seen += usize::from(answer.regime.is_plastic());
                for a in 0..3 {
                    let slope =
                        (8.0 * (right[a] - left[a]) - (far_right[a] - far_left[a])) / (12.0 * h);
                    let error = (slope - answer.tangent[a][b]).abs() / largest;
                    assert!(error < 1e-7, "{law:?} {strain:?} {answer:?} {error:e}");
                }
            }
        }
        assert!(seen > 400, "{seen}");
    }
}

/// GOAL: the answer goes with the order of the principal values.
#[test]
fn answers_are_isotropic() {
    for law in laws() {
        let mut random = Random(14);
        for _ in 0..500 {
            let (history, elastic) = start(&law, &mut random);
            let strain = trial(&elastic, 0.1, &mut random);
            let answer = law
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let turned = [strain[2], strain[0], strain[1]];
            let other = law
                .return_map(&turned, &history, &PointContext::STATIC)
                .unwrap();
            for a in 0..3 {
                let error = (other.tau[(a + 1) % 3] - answer.tau[a]).abs();
                assert!(error <= 1e-11 * size(&answer.tau), "{law:?} {error:e}");
            }
        }
    }
}

/// GOAL: a closed cycle of elastic strain does no work: 1e-12 of the work on one side of it.
/// ORACLE: the energy of eq. 88, by Gauss's rule of high order along straight sides of a triangle.
#[test]
fn a_closed_elastic_cycle_does_no_work() {
    // Gauss-Legendre with three points in each of many parts.
    let points = [-(0.6_f64.sqrt()), 0.0, 0.6_f64.sqrt()];
    let weights = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];
    for law in laws() {
        let mut random = Random(15);
        for _ in 0..10 {
            let (history, _) = start(&law, &mut random);
            let scale = law.parameters().swelling;
            let corners: [Principal; 3] = [0; 3].map(|_| random.values(scale));
            let (mut work, mut most) = (0.0, 0.0_f64);
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                let way: Principal = std::array::from_fn(|a| to[a] - from[a]);
                let mut along = 0.0;
                let parts = 200;
                for part in 0..parts {
                    for k in 0..3 {
                        let t = (f64::from(part) + 0.5 + 0.5 * points[k]) / f64::from(parts);
                        let strain = std::array::from_fn(|a| from[a] + t * way[a]);
                        let tau = law.elastic_stress(&strain, &history);
                        along += weights[k] / f64::from(parts) * dot(&tau, &way);
                    }
                }
                work += along;
                most = most.max(along.abs());
            }
            assert!(work.abs() < 1e-12 * most, "{law:?} {work:e} of {most:e}");
        }
    }
}

/// GOAL: a strength that is a result of the path is not reduced, and the words say so; parameters that no clay has are refused.
#[test]
fn refusals_have_words() {
    let law = laws()[0];
    let refused = law.reduced(1.2).unwrap_err().to_string();
    assert_eq!(
        refused,
        "the strength of modified Cam-clay is not reduced: its strength is a result of the path, and not a parameter"
    );
    assert!(law.reduced(-1.0).is_err());
    let with = |change: &dyn Fn(&mut CamClayParameters)| {
        let mut parameters = *law.parameters();
        change(&mut parameters);
        ModifiedCamClay::new(parameters).unwrap_err().to_string()
    };
    let stiff = with(&|p| p.swelling = 0.2);
    assert_eq!(stiff, "`compression` = 0.1 must be larger than `swelling`");
    assert!(with(&|p| p.swelling = 0.0).contains("`swelling`"));
    assert!(with(&|p| p.critical_ratio = f64::NAN).contains("`critical_ratio`"));
    assert!(with(&|p| p.overconsolidation = 0.9).contains("at least 1"));
    assert!(with(&|p| p.shear = ShearStiffness::Poisson(0.5)).contains("`poisson`"));
    assert!(with(&|p| p.shear = ShearStiffness::Constant(0.0)).contains("`shear`"));
    let tension = law.elastic_strain(&[1.0, 0.0, 0.0], &History::default());
    assert!(tension.unwrap_err().to_string().contains("mean pressure"));
    let answer = law.return_map(
        &[f64::NAN; 3],
        &law.initial_history(&[-1.0; 3]),
        &PointContext::STATIC,
    );
    assert!(matches!(answer, Err(MaterialError::NonFinite { .. })));
    assert_eq!(law.name(), "modified Cam-clay");
}
