//! Hardening Soil: the demands of `returns` and `tangents` on the others, and the promises of its calibration.

use igimp_material::{
    ConstitutiveModel, HardeningSoil, HardeningSoilParameters, History, MaterialError,
    PointContext, Principal, Regime, Strength,
};

use crate::random::Random;
use crate::returns::{dot, size};

/// Hostun sand, dense, loose and overconsolidated; clay with cohesion and m = 1; moduli that do not grow; and soil in units of its pressure.
pub(crate) fn laws() -> Vec<HardeningSoil> {
    let dense = HardeningSoilParameters::dense_hostun_sand();
    let clay = HardeningSoilParameters {
        cohesion: 10e3,
        friction_angle: 25_f64.to_radians(),
        dilation_angle: 0.0,
        secant: 6e6,
        unloading: 20e6,
        oedometer: 4e6,
        power: 1.0,
        k0_normal: 0.58,
        ..dense
    };
    let all = [
        dense,
        HardeningSoilParameters::loose_hostun_sand(),
        HardeningSoilParameters {
            overconsolidation: 4.0,
            ..dense
        },
        clay,
        HardeningSoilParameters {
            power: 0.0,
            cohesion: 50e3,
            dilation_angle: 25_f64.to_radians(),
            ..dense
        },
        HardeningSoilParameters {
            secant: 300.0,
            unloading: 900.0,
            oedometer: 300.0,
            reference_pressure: 1.0,
            poisson: 0.35,
            ..dense
        },
    ];
    all.map(|p| HardeningSoil::new(p).unwrap()).to_vec()
}

/// Soil that began with a stress, with its memory sheared and pressed further, and its elastic strain.
pub(crate) fn start(law: &HardeningSoil, random: &mut Random) -> (History, Principal) {
    let p = law.parameters().reference_pressure * 10_f64.powf(random.between(-1.5, 1.0));
    let spread: Principal = random.values(0.3 * p);
    let mean = spread.iter().sum::<f64>() / 3.0;
    let sigma = spread.map(|value| value - mean - p);
    let mut history = law.initial_history(&sigma);
    if random.below(2) == 0 {
        history.internal[0] += 10_f64.powf(random.between(-5.0, -1.0));
        history.internal[1] *= 10_f64.powf(random.between(0.0, 1.0));
    }
    (history, law.elastic_strain(&sigma, &history).unwrap())
}

/// A trial strain from there, of any size up to a tenth, degenerate ones included.
pub(crate) fn trial(elastic: &Principal, random: &mut Random) -> Principal {
    let size = 10_f64.powf(random.between(-6.0, -1.0));
    let [i, j] = [random.below(3), random.below(3)];
    let middle = size * random.symmetric() * 10_f64.powf(random.between(-3.0, 0.3));
    let step: Principal = random.values(size);
    let mut strain: Principal = std::array::from_fn(|a| elastic[a] + step[a] + middle);
    match random.below(8) {
        0 => strain[i] = strain[j],
        1 => strain = [strain[i]; 3],
        2 => strain = std::array::from_fn(|a| elastic[a] - step[i].abs()),
        3 => strain = std::array::from_fn(|a| elastic[a] + step[i].abs()),
        _ => {}
    }
    strain
}

/// GOAL: strain splits into an elastic part that has this stress with the stiffness of the step and a plastic one that dissipates; the
/// state is admissible with the memory that it left and is not returned again, though its stiffness is another then; all numbers are
/// finite.
/// PARAMETERS: 5 000 states a set, steps of strain from 1e-6 to 0.1.
#[test]
fn returns_are_admissible_and_dissipate() {
    let mut seen = [0; 12];
    for law in laws() {
        let mut random = Random(51);
        for _ in 0..5_000 {
            let (history, elastic) = start(&law, &mut random);
            let strain = trial(&elastic, &mut random);
            let answer = law
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let about = || format!("{law:?} {strain:?} {history:?} {answer:?}");
            let excess = law.yield_function(&answer.tau, &answer.history);
            let scale = law.stress_scale(&answer.tau);
            assert!(excess <= 1e-12 * scale, "{} {excess:e}", about());
            let carried = law.elastic_strain(&answer.tau, &history).unwrap();
            for a in 0..3 {
                let error = strain[a] - carried[a] - answer.delta_eps_p[a];
                assert!(error.abs() < 1e-15, "{} {error:e}", about());
            }
            let work = dot(&answer.tau, &answer.delta_eps_p);
            let flow = size(&answer.delta_eps_p);
            assert!(work >= -1e-13 * size(&answer.tau) * flow, "{}", about());
            let next = law.elastic_strain(&answer.tau, &answer.history).unwrap();
            let again = law
                .return_map(&next, &answer.history, &PointContext::STATIC)
                .unwrap();
            assert!(size(&again.delta_eps_p) < 1e-13, "{} {again:?}", about());
            seen[usize::from(answer.regime.code())] += 1;
        }
    }
    println!("{seen:?}");
    for regime in [
        Regime::Smooth,
        Regime::RightEdge,
        Regime::LeftEdge,
        Regime::Apex,
        Regime::Cap,
        Regime::CapShear,
    ] {
        assert!(seen[usize::from(regime.code())] > 100, "{seen:?}");
    }
}

/// GOAL: D = ∂τ/∂ε by fourth-order differences on each part of the surface.
/// BAND: 1e-6 of the largest modulus, where two differences agree: at failure, and where dilation begins, there is a kink.
#[test]
fn tangents_are_derivatives() {
    let mut seen = [0; 12];
    let mut kinks = 0;
    for law in laws() {
        let mut random = Random(52);
        for _ in 0..2_000 {
            let (history, elastic) = start(&law, &mut random);
            let strain = trial(&elastic, &mut random);
            let answer = law
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let stiffness = law.elastic_stiffness(&strain, &history);
            let largest = stiffness.tangent[0][0];
            let step: f64 = (0..3).map(|a| (strain[a] - elastic[a]).abs()).sum();
            let h = 1e-4 * step.max(1e-2 * size(&elastic));
            for b in 0..3 {
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
                let slope = |a: usize| {
                    let near = (right[a] - left[a]) / (2.0 * h);
                    let wide = (far_right[a] - far_left[a]) / (4.0 * h);
                    ((4.0 * near - wide) / 3.0, (near - wide).abs())
                };
                if (0..3).any(|a| slope(a).1 > 1e-5 * largest) {
                    kinks += 1;
                    continue;
                }
                for a in 0..3 {
                    let error = (slope(a).0 - answer.tangent[a][b]).abs() / largest;
                    assert!(
                        error < 1e-6,
                        "{law:?} {strain:?} {history:?} {answer:?} {error:e}"
                    );
                }
                seen[usize::from(answer.regime.code())] += 1;
            }
        }
    }
    println!("{seen:?}, {kinks} left out");
    let regimes = [1, 2, 3, 4, 10, 11];
    assert!(regimes.iter().all(|code| seen[*code] > 50), "{seen:?}");
    assert!(10 * kinks < seen.iter().sum::<usize>(), "{kinks}");
}

/// GOAL: the answer goes with the order of the principal values.
#[test]
fn answers_are_isotropic() {
    for law in laws() {
        let mut random = Random(53);
        for _ in 0..500 {
            let (history, elastic) = start(&law, &mut random);
            let strain = trial(&elastic, &mut random);
            let answer = law
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let turned = [strain[2], strain[0], strain[1]];
            let other = law
                .return_map(&turned, &history, &PointContext::STATIC)
                .unwrap();
            for a in 0..3 {
                let error = (other.tau[(a + 1) % 3] - answer.tau[a]).abs();
                let scale = law.stress_scale(&answer.tau)
                    + law.elastic_stiffness(&strain, &history).shear * size(&strain);
                assert!(error <= 1e-12 * scale, "{law:?} {error:e}");
            }
        }
    }
}

/// GOAL: strain far beyond all soil is answered with finite numbers or refused in words.
#[test]
fn far_trial_states_are_answered_or_refused() {
    for law in laws() {
        let mut random = Random(54);
        for _ in 0..2_000 {
            let (history, elastic) = start(&law, &mut random);
            let reach = 10_f64.powf(random.between(-1.0, 4.0));
            let far: Principal = random.values(reach);
            let strain = std::array::from_fn(|a| elastic[a] + far[a]);
            match law.return_map(&strain, &history, &PointContext::STATIC) {
                Ok(answer) => {
                    let tangent = answer.tangent.as_flattened().iter();
                    assert!(tangent.chain(&answer.tau).all(|v| v.is_finite()));
                    let excess = law.yield_function(&answer.tau, &answer.history);
                    let far = law.elastic_stiffness(&strain, &history).shear * size(&strain);
                    // A stress that a far larger one was returned to has the digits that this leaves.
                    let admitted = 1e-12 * law.stress_scale(&answer.tau) + 1e-15 * far;
                    assert!(excess <= admitted, "{law:?} {strain:?} {excess:e}");
                }
                Err(MaterialError::NonFinite { .. } | MaterialError::NotConverged { .. }) => {
                    assert!(size(&far) > 0.5, "{law:?} {strain:?} {history:?}");
                }
                Err(other) => panic!("{other}"),
            }
        }
        let answer = law.return_map(
            &[f64::NAN; 3],
            &law.initial_history(&[-1.0; 3]),
            &PointContext::STATIC,
        );
        assert!(matches!(answer, Err(MaterialError::NonFinite { .. })));
    }
}

/// GOAL: at reduced strength the law is Mohr–Coulomb's with c/F and tan φ/F and the stiffness of the history, whatever hardened before.
/// ORACLE: `MohrCoulomb` with the elasticity of that stress. BAND: 1e-12 of the stress.
#[test]
fn a_reduction_is_that_of_mohr_coulomb() {
    use igimp_material::{Elasticity, MohrCoulomb};
    for law in laws() {
        let soil = *law.parameters();
        let (srf, mut random) = (1.3, Random(55));
        let reduced = law.reduced(srf).unwrap();
        let friction = (soil.friction_angle.tan() / srf).atan();
        for _ in 0..2_000 {
            let (history, elastic) = start(&law, &mut random);
            let strain = trial(&elastic, &mut random);
            let shear = law.elastic_stiffness(&elastic, &history).shear;
            let young = 2.0 * (1.0 + soil.poisson) * shear;
            let elasticity = Elasticity::new(young, soil.poisson).unwrap();
            let dilation = soil.dilation_angle.min(friction);
            let oracle =
                MohrCoulomb::new(elasticity, soil.cohesion / srf, friction, dilation).unwrap();
            let (expected, answer) = (
                oracle
                    .return_map(&strain, &history, &PointContext::STATIC)
                    .unwrap(),
                reduced
                    .return_map(&strain, &history, &PointContext::STATIC)
                    .unwrap(),
            );
            let scale = law.stress_scale(&answer.tau) + shear * size(&strain);
            for a in 0..3 {
                let error = (answer.tau[a] - expected.tau[a]).abs();
                assert!(error < 1e-12 * scale, "{law:?} {strain:?} {error:e}");
                for b in 0..3 {
                    let error = (answer.tangent[a][b] - expected.tangent[a][b]).abs();
                    assert!(error < 1e-9 * shear || answer.regime != expected.regime);
                }
            }
            let bits = |history: &History| history.internal.map(f64::to_bits);
            assert_eq!(bits(&answer.history), bits(&history));
        }
        let (steeper, slope) = (reduced.at_friction(1.1).unwrap().unwrap(), friction.tan());
        let strength = steeper.shear_strength().unwrap();
        assert!((strength.friction_angle.tan() / slope - 1.1).abs() < 1e-12);
        assert!((strength.cohesive - soil.cohesion / srf).abs() <= 1e-12 * soil.cohesion);
        assert!(law.reduced(-1.0).is_err());
    }
}

/// GOAL: parameters that no soil has are refused by name, and moduli that no cap reconciles.
#[test]
fn refusals_have_words() {
    let dense = HardeningSoilParameters::dense_hostun_sand();
    let with = |change: &dyn Fn(&mut HardeningSoilParameters)| {
        let mut parameters = dense;
        change(&mut parameters);
        HardeningSoil::new(parameters).unwrap_err().to_string()
    };
    assert!(with(&|p| p.cohesion = -1.0).contains("`cohesion`"));
    assert!(with(&|p| p.friction_angle = 0.0).contains("`friction_angle`"));
    assert!(with(&|p| p.dilation_angle = 0.8).contains("`dilation_angle`"));
    assert!(with(&|p| p.secant = 0.0).contains("`secant`"));
    assert!(with(&|p| p.unloading = 40e6).contains("initial stiffness of the hyperbola"));
    assert!(with(&|p| p.oedometer = 200e6).contains("that a cap can give"));
    assert!(with(&|p| p.poisson = 0.5).contains("`poisson`"));
    assert!(with(&|p| p.power = 1.1).contains("`power`"));
    assert!(with(&|p| p.failure_ratio = 1.0).contains("`failure_ratio`"));
    assert!(with(&|p| p.k0_normal = 1.0).contains("`k0_normal`"));
    assert!(with(&|p| p.overconsolidation = 0.5).contains("at least 1"));
    assert!(with(&|p| p.reference_pressure = f64::NAN).contains("`reference_pressure`"));
}
