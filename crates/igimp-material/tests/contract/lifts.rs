//! The spectral lift: stress and spatial tangent as tensors.

use igimp_material::{Elasticity, Tresca};
use igimp_material::{
    HenckyElastic, History, Lifted, Principal, Regime, TangentKind, Tensor, VonMises, lift_finite,
    lift_small, logarithmic_strain,
};

use crate::catalogue::{all, differentiable, soft};
use crate::random::Random;
use crate::tensors::{
    MEASURES, Measure, congruence, diagonal, largest, plane_rotation, tangent_error, transpose,
    with_dilation,
};

/// Step of the differences; principal strains are apart by at least 200 steps.
const H: f64 = 2e-5;

fn apart(strain: &Principal) -> bool {
    [(0, 1), (0, 2), (1, 2)]
        .iter()
        .all(|&(a, b)| (strain[a] - strain[b]).abs() > 200.0 * H)
}

fn check_tangent<const D: usize>(axes: impl Fn(&mut Random) -> Tensor) {
    for entry in differentiable() {
        let shear = entry.law.stiffness_bound().shear();
        for measure in MEASURES {
            let mut random = Random(10);
            let mut seen: Vec<Regime> = Vec::new();
            for _ in 0..4_000 {
                let strain = entry.general(&mut random);
                let (axes, r) = (axes(&mut random), random.symmetric());
                let mut l_prime = [0; 3].map(|_| random.values(1.0));
                if !apart(&strain) || strain.iter().any(|value| value.abs() > 0.5) {
                    continue;
                }
                let state = measure.state(&strain, &axes);
                let l = with_dilation::<D>(&mut l_prime, r);
                let Some(rate) = measure.rate::<D>(&*entry.law, &state, &l, H) else {
                    continue;
                };
                let lifted: Lifted<D> = measure.lift(&*entry.law, &state, TangentKind::Consistent);
                let error = tangent_error(&lifted, &rate, &l_prime, r) / (2.0 * shear);
                assert!(
                    error < 1e-7,
                    "{} {measure:?}: {strain:?} {error:e}",
                    entry.label
                );
                if !seen.contains(&lifted.regime) {
                    seen.push(lifted.regime);
                }
            }
            assert!(
                seen.len() + 1 >= entry.regimes.len(),
                "{} {measure:?}: {seen:?}",
                entry.label
            );
        }
    }
}

/// GOAL: A is the derivative of τ by the whole velocity gradient, in 3D and in plane strain with
/// the traces over zz, within 1e-7 of 2G.
#[test]
fn spatial_tangent_is_the_derivative_of_stress() {
    check_tangent::<3>(Random::rotation);
    check_tangent::<2>(|random| plane_rotation(random.between(-3.2, 3.2)));
}

/// GOAL: plane strain agrees with 3D, whichever of the three principal values zz is.
#[test]
fn plane_strain_is_a_part_of_three_dimensions() {
    for entry in soft() {
        let scale = entry.law.stiffness_bound().bulk();
        for measure in MEASURES {
            let mut random = Random(11);
            for _ in 0..1_000 {
                let strain = entry
                    .general(&mut random)
                    .map(|value| value.clamp(-1.0, 1.0));
                let axes = plane_rotation(random.between(-3.2, 3.2));
                let state = measure.state(&strain, &axes);
                let flat: Lifted<2> = measure.lift(&*entry.law, &state, TangentKind::Consistent);
                let full: Lifted<3> = measure.lift(&*entry.law, &state, TangentKind::Consistent);
                assert_eq!(flat.regime, full.regime);
                let mut most = 0.0_f64;
                let mut compare = |flat: f64, full: f64| most = most.max((flat - full).abs());
                for a in 0..3 {
                    for b in 0..3 {
                        compare(flat.tau[a][b], full.tau[a][b]);
                        compare(scale * flat.b_e()[a][b], scale * full.b_e()[a][b]);
                    }
                }
                for a in 0..2 {
                    for b in 0..2 {
                        compare(
                            flat.tangent().trace_left[a][b],
                            full.tangent().trace_left[a][b],
                        );
                        compare(
                            flat.tangent().trace_right[a][b],
                            full.tangent().trace_right[a][b],
                        );
                        for c in 0..2 {
                            for d in 0..2 {
                                compare(
                                    flat.tangent().modulus[a][b][c][d],
                                    full.tangent().modulus[a][b][c][d],
                                );
                            }
                        }
                    }
                }
                compare(flat.tangent().trace, full.tangent().trace);
                assert!(
                    most < 1e-9 * scale,
                    "{} {measure:?}: {strain:?} {most:e}",
                    entry.label
                );
            }
        }
    }
}

/// GOAL: a rotated state has the rotated stress, elastic strain and tangent.
#[test]
fn lift_is_isotropic() {
    for entry in soft() {
        let scale = entry.law.stiffness_bound().bulk();
        for measure in MEASURES {
            let mut random = Random(12);
            for _ in 0..200 {
                let strain = entry
                    .general(&mut random)
                    .map(|value| value.clamp(-1.0, 1.0));
                let q = random.rotation();
                let state = measure.state(&strain, &random.rotation());
                let turned = congruence(&q, &state);
                let plain: Lifted<3> = measure.lift(&*entry.law, &state, TangentKind::Consistent);
                let other: Lifted<3> = measure.lift(&*entry.law, &turned, TangentKind::Consistent);
                let mut most = difference(&other.tau, &congruence(&q, &plain.tau));
                most = most.max(scale * difference(&other.b_e(), &congruence(&q, &plain.b_e())));
                // Answers to the same velocity gradient seen from both frames.
                let l: Tensor = [0; 3].map(|_| random.values(1.0));
                let answer = respond(&other, &congruence(&q, &l));
                most = most.max(difference(&answer, &congruence(&q, &respond(&plain, &l))));
                assert!(
                    most < 1e-9 * scale,
                    "{} {measure:?}: {strain:?} {most:e}",
                    entry.label
                );
            }
        }
    }
}

fn difference(a: &Tensor, b: &Tensor) -> f64 {
    largest(&std::array::from_fn(|i| {
        std::array::from_fn(|j| a[i][j] - b[i][j])
    }))
}

fn respond(lifted: &Lifted<3>, l: &Tensor) -> Tensor {
    let mut out = [[0.0; 3]; 3];
    for a in 0..3 {
        for b in 0..3 {
            for c in 0..3 {
                for d in 0..3 {
                    out[a][b] += lifted.tangent().modulus[a][b][c][d] * l[c][d];
                }
            }
        }
    }
    out
}

/// GOAL: the carried `b_e = exp(2 ε_e)` has the elastic strain C⁻¹τ, and its axes are orthonormal.
#[test]
fn carried_state_belongs_to_the_stress() {
    for entry in soft() {
        let mut random = Random(13);
        for _ in 0..500 {
            let strain = entry
                .general(&mut random)
                .map(|value| value.clamp(-1.0, 1.0));
            let state = Measure::Finite.state(&strain, &random.rotation());
            let lifted: Lifted<3> = Measure::Finite.lift(&*entry.law, &state, TangentKind::Elastic);
            let elasticity = entry.law.stiffness_bound();
            let ratio = elasticity.bulk() / elasticity.shear();
            let logarithm = logarithmic_strain(&lifted.b_e()).unwrap();
            let eps_e = congruence(&transpose(&lifted.frame), &diagonal(lifted.eps_e));
            assert!(difference(&logarithm, &eps_e) < 1e-14);
            let tau = congruence(
                &transpose(&lifted.frame),
                &diagonal(elasticity.stress(&lifted.eps_e)),
            );
            assert!(
                difference(&tau, &lifted.tau) < 1e-14 * (1.0 + ratio) * elasticity.bulk(),
                "{}",
                entry.label
            );
            let identity = congruence(&lifted.frame, &diagonal([1.0; 3]));
            assert!(difference(&identity, &diagonal([1.0; 3])) < 1e-14);
        }
    }
}

/// GOAL: a regularised tangent has the stress of the return map, and lies by its share between the consistent tangent and
/// that of Hencky elasticity where something was returned; elsewhere it is the consistent one to the bit.
#[test]
fn a_regularised_tangent_is_stiffer_where_soil_yields() {
    for entry in all() {
        let mut random = Random(17);
        for _ in 0..200 {
            let strain = entry.general(&mut random);
            let state = Measure::Small.state(&strain, &random.rotation());
            let lift = |kind| -> Lifted<3> { Measure::Small.lift(&*entry.law, &state, kind) };
            let full = lift(TangentKind::Consistent);
            let elastic = 0.3;
            let between = lift(TangentKind::Regularised { elastic });
            assert_eq!(between.tau, full.tau);
            if !full.regime.is_plastic() {
                assert_eq!(between, full);
                continue;
            }
            let elasticity = entry.law.stiffness_bound();
            let stiffest = elasticity.bulk() + elasticity.shear();
            let moduli = [full, lift(TangentKind::Elastic), between].map(|lifted| {
                lifted
                    .tangent()
                    .modulus
                    .into_iter()
                    .flatten()
                    .flatten()
                    .flatten()
            });
            let [full, stiff, between] = moduli.map(Iterator::collect::<Vec<f64>>);
            for (component, between) in between.into_iter().enumerate() {
                let expected = 0.7 * full[component] + 0.3 * stiff[component];
                assert!((between - expected).abs() < 1e-12 * stiffest);
            }
        }
    }
}

/// GOAL: the elastic kind has the stress of the return map and the tangent of Hencky elasticity, to
/// the bit where nothing was returned. Where something was, stretches are answered alike, and
/// turns so that the tangent is symmetric together with the geometric part of the returned stress:
/// `A_abcd − τ_ad δ_bc = A_cdab − τ_cb δ_da`.
#[test]
fn elastic_kind_changes_the_tangent_only() {
    for entry in all() {
        let elastic = HenckyElastic::new(*entry.law.stiffness_bound());
        for measure in MEASURES {
            let mut random = Random(14);
            for _ in 0..100 {
                let strain = entry
                    .general(&mut random)
                    .map(|value| value.clamp(-1.0, 1.0));
                let state = measure.state(&strain, &plane_rotation(random.symmetric()));
                let lifted: Lifted<2> = measure.lift(&*entry.law, &state, TangentKind::Elastic);
                let full: Lifted<2> = measure.lift(&*entry.law, &state, TangentKind::Consistent);
                let hencky: Lifted<2> = measure.lift(&elastic, &state, TangentKind::Elastic);
                assert_eq!(lifted.tau, full.tau);
                let (of_law, of_hencky) = (lifted.tangent(), hencky.tangent());
                if !lifted.regime.is_plastic() || measure == Measure::Small {
                    assert_eq!(of_law, of_hencky);
                }
                let geometric = f64::from(u8::from(measure == Measure::Finite));
                let [law_a, hencky_a] = [of_law.modulus, of_hencky.modulus];
                let round_off = 1e-13 * (1.0 + largest(&lifted.tau) + elastic_scale(&entry.law));
                for [a, b, c, d] in indices() {
                    let stretch = law_a[a][b][c][d] + law_a[a][b][d][c];
                    let expected = hencky_a[a][b][c][d] + hencky_a[a][b][d][c];
                    assert!((stretch - expected).abs() < round_off, "{}", entry.label);
                    let delta = |i: usize, j: usize| geometric * f64::from(u8::from(i == j));
                    let one = law_a[a][b][c][d] - lifted.tau[a][d] * delta(b, c);
                    let other = law_a[c][d][a][b] - lifted.tau[c][b] * delta(d, a);
                    assert!((one - other).abs() < round_off, "{}", entry.label);
                }
                let exact: Lifted<2> = measure.lift(&elastic, &state, TangentKind::Consistent);
                let error = exact.tangent().modulus[0][1][0][1] - hencky_a[0][1][0][1];
                assert!(
                    error.abs() < 1e-9 * elastic_scale(&entry.law),
                    "{}",
                    entry.label
                );
            }
        }
    }
}

/// All a, b, c, d in the plane.
fn indices() -> impl Iterator<Item = [usize; 4]> {
    (0..16).map(|k| [k / 8, k / 4 % 2, k / 2 % 2, k % 2])
}

fn elastic_scale(law: &std::sync::Arc<dyn igimp_material::ConstitutiveModel>) -> f64 {
    law.stiffness_bound().bulk()
}

/// GOAL: no digits are lost in ln b beyond those that b itself has not.
#[test]
fn logarithm_keeps_its_digits() {
    let elastic = HenckyElastic::new(Elasticity::new(1.0, 0.0).unwrap());
    for size in [1e-3_f64, 1e-6, 1e-8] {
        let strain = [size, -0.3 * size, 0.7 * size];
        let b = Measure::Finite.state(&strain, &plane_rotation(0.4));
        let lifted: Lifted<2> = Measure::Finite.lift(&elastic, &b, TangentKind::Elastic);
        for (found, exact) in lifted.eps_e.iter().zip(strain) {
            assert!(
                (found - exact).abs() < 4.0 * f64::EPSILON,
                "{found} for {exact}"
            );
        }
    }
    // A stretch of 1e4 along one axis and 1e-4 along another, both to the last digits.
    let b = diagonal([1e8, 1e-8, 1.0]);
    let lifted: Lifted<3> = Measure::Finite.lift(&elastic, &b, TangentKind::Elastic);
    assert!((lifted.eps_e[0] - 1e4_f64.ln()).abs() < 1e-14);
    assert!((lifted.eps_e[1] + 1e4_f64.ln()).abs() < 1e-14);
}

/// GOAL: strains whose squares vanish in floating point keep their axes.
#[test]
fn vanishing_strains_keep_their_axes() {
    let elastic = HenckyElastic::new(Elasticity::new(1.0, 0.0).unwrap());
    for size in [1e-160, 1e-200, 1e-300] {
        let mut strain = diagonal([0.0; 3]);
        strain[0][1] = size;
        strain[1][0] = size;
        let flat: Lifted<2> = Measure::Small.lift(&elastic, &strain, TangentKind::Consistent);
        let full: Lifted<3> = Measure::Small.lift(&elastic, &strain, TangentKind::Consistent);
        assert_eq!(flat.frame, full.frame);
        assert!((flat.eps_e[0] / size - 1.0).abs() < 1e-15);
        assert!((flat.frame[0][0] - 0.5_f64.sqrt()).abs() < 1e-15);
        assert!((flat.tau[0][1] / size - 1.0).abs() < 1e-14);
    }
}

/// GOAL: the undrained strength is the shear stress at failure in plane strain, for both laws.
/// PARAMETERS: pure shear in the plane, 100 times the yield strain.
#[test]
fn undrained_strength_is_the_shear_stress_at_failure() {
    let elasticity = Elasticity::new(100.0, 0.3).unwrap();
    let laws: [&dyn igimp_material::ConstitutiveModel; 2] = [
        &VonMises::from_undrained_strength(elasticity, 2.0).unwrap(),
        &Tresca::new(elasticity, 2.0).unwrap(),
    ];
    for law in laws {
        let mut strain = diagonal([0.0; 3]);
        strain[0][1] = 2.0;
        strain[1][0] = 2.0;
        let lifted: Lifted<2> =
            lift_small(law, &strain, &History::default(), TangentKind::Consistent).unwrap();
        assert!((lifted.tau[0][1] - 2.0).abs() < 1e-12, "{}", law.name());
        assert!(lifted.tau[0][0].abs() < 1e-12 && lifted.tau[2][2].abs() < 1e-12);
    }
}

/// GOAL: plastic strain and history come through the lift unchanged.
#[test]
fn history_passes_through() {
    let elasticity = Elasticity::new(100.0, 0.3).unwrap();
    let law = VonMises::from_yield_stress(elasticity, 1.0).unwrap();
    let history = History::of_plastic_strain(0.5);
    let b = diagonal([1.4, 0.8, 1.0]);
    let lifted: Lifted<2> = lift_finite(&law, &b, &history, TangentKind::Consistent).unwrap();
    assert_eq!(lifted.history, history.after(&lifted.delta_eps_p));
    assert!(lifted.history.eps_p_eq > 0.5 && lifted.regime == Regime::Smooth);
}
