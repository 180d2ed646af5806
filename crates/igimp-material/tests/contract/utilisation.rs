//! The share of the shear strength that a stress mobilises.

use igimp_material::{ConstitutiveModel, History, PointContext, Principal, Regime};

use crate::catalogue::{Entry, all};
use crate::random::Random;

const HISTORY: History = History::of_plastic_strain(0.25);

/// A law of the catalogue, by the beginning of its label.
fn named(label: &str) -> Entry {
    let mut entries = all().into_iter();
    entries
        .find(|entry| entry.label.starts_with(label))
        .unwrap()
}

fn utilisation(law: &dyn ConstitutiveModel, tau: &Principal) -> f64 {
    law.utilisation(tau, &HISTORY)
}

fn assert_share(law: &dyn ConstitutiveModel, tau: &Principal, expected: f64) {
    let share = utilisation(law, tau);
    assert!(
        (share - expected).abs() < 1e-14,
        "{tau:?}: {share} for {expected}"
    );
}

/// GOAL: between 0 and 1 after every return, 1 wherever the return was to a surface of shear, and
/// the same for every order of the principal values.
#[test]
fn a_returned_stress_mobilises_no_more_than_the_strength() {
    for entry in all() {
        let mut random = Random(40);
        for _ in 0..20_000 {
            let strain = entry.any(&mut random);
            let answer = entry
                .law
                .return_map(&strain, &HISTORY, &PointContext::STATIC)
                .unwrap();
            let share = utilisation(&*entry.law, &answer.tau);
            assert!(
                (0.0..=1.0 + 1e-9).contains(&share),
                "{}: {answer:?} {share}",
                entry.label
            );
            let sheared = matches!(
                answer.regime,
                Regime::Smooth
                    | Regime::RightEdge
                    | Regime::LeftEdge
                    | Regime::Apex
                    | Regime::TensionShear
                    | Regime::TensionCorner
            );
            assert!(
                !sheared || (share - 1.0).abs() < 1e-9,
                "{}: {answer:?} {share}",
                entry.label
            );
            let [a, b, c] = answer.tau;
            let turned = utilisation(&*entry.law, &[c, a, b]);
            assert!((turned - share).abs() <= 1e-9, "{}", entry.label);
        }
    }
}

/// GOAL: the ratios of the laws, by hand.
#[test]
fn shares_are_the_stated_ratios() {
    let elastic = named("Hencky elastic");
    assert_share(&*elastic.law, &[3.0, 0.0, -40.0], 0.0);
    // q = 0.5 under uniaxial stress, q_y = √3 · 1.
    let von_mises = named("von Mises #0");
    assert_share(&*von_mises.law, &[0.5, 0.0, 0.0], 0.5 / 3.0_f64.sqrt());
    // (3 − 2) / (2 · 1), whatever lies between.
    let tresca = named("Tresca #0");
    assert_share(&*tresca.law, &[2.0, 2.7, 3.0], 0.5);
    // c = 10, φ = 20°: circle of radius 10 about −50 in a strength of c cos φ + 50 sin φ.
    let mohr_coulomb = named("Mohr-Coulomb (10.0, 20.0");
    let share = utilisation(&*mohr_coulomb.law, &[-60.0, -50.0, -40.0]);
    let friction = 20_f64.to_radians();
    let strength = 10.0 * friction.cos() + 50.0 * friction.sin();
    assert!((share - 10.0 / strength).abs() < 1e-14);
    // Without friction and in plane strain q over √3 · 2.
    let drucker_prager = named("Drucker-Prager (2.0, 0.0");
    assert_share(
        &*drucker_prager.law,
        &[0.5, 0.0, 0.0],
        0.25 / 3.0_f64.sqrt(),
    );
}

/// GOAL: one at the apex and beyond it, and more than one for a shear stress beyond the surface.
#[test]
fn shares_are_defined_beyond_the_surface() {
    let law = named("Mohr-Coulomb (10.0, 20.0").law;
    let apex = 10.0 / 20_f64.to_radians().tan();
    assert_share(&*law, &[apex; 3], 1.0);
    assert_share(&*law, &[2.0 * apex, apex, apex], 1.0);
    assert!(utilisation(&*law, &[-100.0, -50.0, 0.0]) > 1.0);
    let cohesionless = named("Mohr-Coulomb (0.0, 35.0").law;
    assert_share(&*cohesionless, &[0.0; 3], 1.0);
    assert_share(&*cohesionless, &[-5.0; 3], 0.0);
}

/// GOAL: dividing the strength by a factor multiplies the share, for laws without friction.
#[test]
fn reduction_raises_the_share() {
    for label in ["von Mises #0", "Tresca #0"] {
        let law = named(label).law;
        let reduced = law.reduced(1.25).unwrap();
        let tau = [0.3, 0.1, -0.2];
        let (before, after) = (utilisation(&*law, &tau), utilisation(&*reduced, &tau));
        assert!((after - 1.25 * before).abs() < 1e-14, "{label}");
    }
}
