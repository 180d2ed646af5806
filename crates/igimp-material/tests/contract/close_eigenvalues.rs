//! The lift where principal values are equal or nearly so.

use igimp_material::{
    Elasticity, History, Lifted, Principal, Regime, TangentKind, Tensor, Tresca, lift_small,
};

use crate::catalogue::{differentiable, soft};
use crate::random::Random;
use crate::tensors::{MEASURES, diagonal, plane_rotation, tangent_error, with_dilation};

const H: f64 = 2e-5;

/// From well apart to equal, through the distances where quotients lose their digits.
const GAPS: [f64; 9] = [1e-4, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12, 1e-15, 0.0];

/// Targets on which two close stresses lie only within a step of a kink: see the test of a kink.
const ASYMMETRIC: [Regime; 2] = [Regime::Smooth, Regime::TensionShear];

/// Strains of which two, or all three, are `gap` apart.
fn close(general: Principal, gap: f64, random: &mut Random) -> Principal {
    let [e, _, other] = general;
    let mut strain = match random.below(4) {
        0 => [e, e + gap, e - 0.3 * gap],
        _ => [e, e + gap, other],
    };
    strain.rotate_left(random.below(3));
    strain
}

fn check<const D: usize>(axes: impl Fn(&mut Random) -> Tensor) {
    for entry in differentiable() {
        let shear = entry.law.stiffness_bound().shear();
        for measure in MEASURES {
            let mut random = Random(20);
            let mut checked = 0;
            for gap in GAPS {
                for _ in 0..200 {
                    let general = entry.general(&mut random);
                    let strain = close(general, gap, &mut random);
                    let (axes, r) = (axes(&mut random), random.symmetric());
                    let mut l_prime = [0; 3].map(|_| random.values(1.0));
                    if strain.iter().any(|value| value.abs() > 0.5)
                        || (general[2] - general[0]).abs() < 200.0 * H
                    {
                        continue;
                    }
                    let state = measure.state(&strain, &axes);
                    let l = with_dilation::<D>(&mut l_prime, r);
                    let Some(rate) = measure.rate::<D>(&*entry.law, &state, &l, H) else {
                        continue;
                    };
                    let lifted: Lifted<D> =
                        measure.lift(&*entry.law, &state, TangentKind::Consistent);
                    if entry.planes.is_some() && ASYMMETRIC.contains(&lifted.regime) {
                        continue;
                    }
                    let error = tangent_error(&lifted, &rate, &l_prime, r) / (2.0 * shear);
                    assert!(
                        error < 1e-7,
                        "{} {measure:?}: {strain:?} {:?} {error:e}",
                        entry.label,
                        lifted.regime
                    );
                    checked += 1;
                }
            }
            assert!(checked > 500, "{} {measure:?}: only {checked}", entry.label);
        }
    }
}

/// GOAL: the spatial tangent holds 1e-7 of 2G at every distance of the principal values.
#[test]
fn spatial_tangent_is_right_for_equal_principal_values() {
    check::<3>(Random::rotation);
    check::<2>(|random| plane_rotation(random.between(-3.2, 3.2)));
}

/// GOAL: where the yield surface has a kink between two close principal values, the shear part
/// is the secant and not the limit of the tangent.
/// PARAMETERS: Tresca, trial stresses δ apart and above yield by less than δ, so that the
/// return is to the plane; exactly, the returned stresses are δ less half the excess apart.
#[test]
fn a_kink_between_close_values_is_seen() {
    let elasticity = Elasticity::new(100.0, 0.25).unwrap();
    let law = Tresca::new(elasticity, 1.0).unwrap();
    let two_g = 2.0 * elasticity.shear();
    for gap in [1e-3, 1e-5, 1e-7] {
        let excess = 0.8 * gap;
        let strain = [(2.0 + excess) / two_g, (2.0 + excess - gap) / two_g, 0.0];
        let lifted: Lifted<2> = lift_small(
            &law,
            &diagonal(strain),
            &History::default(),
            TangentKind::Consistent,
        )
        .unwrap();
        assert_eq!(lifted.regime, Regime::Smooth);
        let exact = (gap - 0.5 * excess) / (2.0 * gap / two_g);
        let error = (lifted.tangent().modulus[0][1][0][1] - exact).abs() / two_g;
        assert!(error < 1e-14 / gap, "gap {gap:e}: {error:e}");
    }
}

/// GOAL: hydrostatic and unstrained states have the isotropic elastic tangent.
#[test]
fn isotropic_states_have_the_isotropic_tangent() {
    for entry in soft() {
        let (bulk, shear) = (
            entry.law.stiffness_bound().bulk(),
            entry.law.stiffness_bound().shear(),
        );
        for compression in [0.0, 0.1 * entry.yield_strain()] {
            for measure in MEASURES {
                let state = measure.state(&[-compression; 3], &diagonal([1.0; 3]));
                let lifted: Lifted<2> = measure.lift(&*entry.law, &state, TangentKind::Consistent);
                let modulus = &lifted.tangent().modulus;
                let close = |found: f64, exact: f64| (found - exact).abs() < 1e-13 * bulk;
                assert!(close(modulus[0][1][0][1], shear), "{}", entry.label);
                assert!(close(modulus[0][1][1][0], shear), "{}", entry.label);
                assert!(
                    close(modulus[0][0][1][1], bulk - 2.0 / 3.0 * shear),
                    "{}",
                    entry.label
                );
                assert!(close(lifted.tangent().trace, 9.0 * bulk), "{}", entry.label);
            }
        }
    }
}
