//! Laws at ratios of strength and stiffness against laws made with those parameters.

use std::sync::Arc;

use igimp_material::{
    ConstitutiveModel, Curve, Decay, Elasticity, FrictionalCurves, HenckyElastic, History,
    MohrCoulomb, PointContext, Principal, Ratios, ScaledLaw, Softening, Strength, TangentKind,
    Tresca, VonMises, lift_finite, lift_small,
};

use crate::random::Random;

type Law = Arc<dyn ConstitutiveModel>;

const RATIOS: [(f64, f64); 5] = [
    (3.0, 1.0),
    (1.0, 0.2),
    (0.37, 2.3),
    (12.0, 7.0),
    (1e-3, 0.6),
];

/// Every law as it is with strengths times `s` and Young's modulus times `e`.
fn laws(s: f64, e: f64) -> Vec<Law> {
    let soft = Elasticity::new(100.0 * e, 0.3).unwrap();
    let stiff = Elasticity::new(1e4 * e, 0.49).unwrap();
    let sand = MohrCoulomb::new(soft, 1.3 * s, 0.6, 0.1).unwrap();
    let associated = MohrCoulomb::new(stiff, 4.0 * s, 0.5, 0.5).unwrap();
    let cut_off = sand.clone().with_tension_cutoff(0.7 * s).unwrap();
    vec![
        Arc::new(HenckyElastic::new(soft)),
        Arc::new(VonMises::from_undrained_strength(soft, 1.7 * s).unwrap()),
        Arc::new(VonMises::from_undrained_strength(stiff, 20.0 * s).unwrap()),
        Arc::new(Tresca::new(soft, 1.7 * s).unwrap()),
        Arc::new(Tresca::new(stiff, 20.0 * s).unwrap()),
        Arc::new(sand),
        Arc::new(associated),
        Arc::new(cut_off),
    ]
}

/// Pairs of a law at ratios and the same law made with its parameters.
fn pairs() -> impl Iterator<Item = (Ratios, ScaledLaw<Law>, Law)> {
    RATIOS.into_iter().flat_map(|(strength, stiffness)| {
        let ratios = Ratios {
            strength,
            stiffness,
            ..Ratios::ONE
        };
        std::iter::zip(laws(1.0, 1.0), laws(strength, stiffness))
            .map(move |(law, made)| (ratios, ScaledLaw::new(law, ratios).unwrap(), made))
    })
}

fn close(found: f64, expected: f64, scale: f64) -> bool {
    (found - expected).abs() <= 1e-12 * scale
}

/// GOAL: a law at ratios is the law with those parameters: stress, tangent, plastic strain, yield function.
/// BAND: 1e-12 of the trial stress and of the stiffness; round-off may put a state on a seam into the other region.
#[test]
fn a_scaled_law_is_the_law_with_scaled_parameters() {
    let mut random = Random(41);
    for (ratios, scaled, made) in pairs() {
        let stiffness = made.stiffness_bound().bulk() + 2.0 * made.stiffness_bound().shear();
        let mut plastic = 0;
        for k in 0..400 {
            let size = [1e-3, 1e-2, 0.1, 0.5][k % 4];
            let strain: Principal = random.values(size);
            let history = History::of_plastic_strain(0.02);
            let one = scaled
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let other = made
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let stress = stiffness * size;
            assert_eq!(one.regime, other.regime, "{} {ratios:?}", made.name());
            plastic += usize::from(one.regime.is_plastic());
            for a in 0..3 {
                assert!(
                    close(one.tau[a], other.tau[a], stress),
                    "{made:?} {ratios:?}"
                );
                assert!(close(one.delta_eps_p[a], other.delta_eps_p[a], size * 10.0));
                for b in 0..3 {
                    assert!(close(one.tangent[a][b], other.tangent[a][b], stiffness));
                }
            }
            assert!(close(one.history.eps_p_eq, other.history.eps_p_eq, 1.0));
            let tau = made.stiffness_bound().stress(&strain);
            let scale = made.stress_scale(&tau);
            let f = [&scaled as &dyn ConstitutiveModel, &*made]
                .map(|law| law.yield_function(&tau, &history));
            assert!(f[0].to_bits() == f[1].to_bits() || close(f[0], f[1], scale.max(stress)));
            let found = scaled.stress_scale(&tau);
            assert!(!made.yields() || close(found, scale, scale.max(stress)));
            // The strength is the rest of two stresses: its digits go with the square of the ratio.
            let shares = [&scaled as &dyn ConstitutiveModel, &*made]
                .map(|law| law.utilisation(&tau, &history));
            assert!(
                close(shares[0], shares[1], shares[1].powi(2).max(1.0)),
                "{shares:?}"
            );
        }
        assert!(plastic > 40 || !made.yields(), "{} {ratios:?}", made.name());
    }
}

/// GOAL: the same for tensors, with both tangents and either kinematics.
#[test]
fn its_lift_is_that_of_the_law_with_scaled_parameters() {
    let mut random = Random(42);
    for (ratios, scaled, made) in pairs() {
        let stiffness = made.stiffness_bound().bulk() + 2.0 * made.stiffness_bound().shear();
        for k in 0..60 {
            let size = [1e-3, 1e-2, 0.1][k % 3];
            let [xx, yy, zz, xy] = random.values(size);
            let strain = [[xx, xy, 0.0], [xy, yy, 0.0], [0.0, 0.0, zz]];
            let mut b_e = strain;
            for (a, row) in b_e.iter_mut().enumerate() {
                row[a] += 1.0;
            }
            for kind in [TangentKind::Elastic, TangentKind::Consistent] {
                let history = History::default();
                let finite = [&scaled as &dyn ConstitutiveModel, &*made]
                    .map(|law| lift_finite::<2>(law, &b_e, &history, kind).unwrap());
                let small = [&scaled as &dyn ConstitutiveModel, &*made]
                    .map(|law| lift_small::<2>(law, &strain, &history, kind).unwrap());
                for [one, other] in [finite, small] {
                    for a in 0..3 {
                        assert!(close(one.eps_e[a], other.eps_e[a], size * 10.0));
                        for b in 0..3 {
                            assert!(close(one.tau[a][b], other.tau[a][b], stiffness * size));
                        }
                    }
                    let (one, other) = (one.tangent().modulus, other.tangent().modulus);
                    let pairs = std::iter::zip(
                        one.as_flattened().as_flattened().as_flattened(),
                        other.as_flattened().as_flattened().as_flattened(),
                    );
                    for (one, other) in pairs {
                        // Secants divide the stresses by a difference of strains.
                        assert!(
                            (one - other).abs() <= 1e-10 * stiffness,
                            "{ratios:?} {made:?}"
                        );
                    }
                }
            }
        }
    }
}

/// GOAL: a reduced strength is that of the material and of its multiples alike.
#[test]
fn strength_reduction_divides_what_is_scaled() {
    let mut random = Random(43);
    for (_, scaled, made) in pairs() {
        let (one, other) = (scaled.reduced(1.4).unwrap(), made.reduced(1.4).unwrap());
        let stiffness = made.stiffness_bound().bulk() + 2.0 * made.stiffness_bound().shear();
        for _ in 0..50 {
            let strain: Principal = random.values(0.02);
            let answers = [&one, &other].map(|law| {
                law.return_map(&strain, &History::default(), &PointContext::STATIC)
                    .unwrap()
            });
            for a in 0..3 {
                assert!(close(
                    answers[0].tau[a],
                    answers[1].tau[a],
                    stiffness * 0.02
                ));
            }
        }
    }
}

#[test]
fn ratios_that_are_no_ratios_are_refused() {
    let law: Law = Arc::new(HenckyElastic::new(Elasticity::new(1.0, 0.3).unwrap()));
    for (strength, stiffness) in [
        (0.0, 1.0),
        (-1.0, 1.0),
        (f64::NAN, 1.0),
        (1.0, 0.0),
        (1.0, f64::INFINITY),
    ] {
        let ratios = Ratios {
            strength,
            stiffness,
            ..Ratios::ONE
        };
        assert!(
            ScaledLaw::new(Arc::clone(&law), ratios).is_err(),
            "{ratios:?}"
        );
    }
}

/// GOAL: friction at a ratio is the law made with that friction, whatever else varies, and reduced like it; strength
/// reduction and ratios change places.
/// BAND: 1e-12 of stiffness and stress, as above.
#[test]
fn friction_at_a_ratio_is_the_law_with_that_friction() {
    let elasticity = Elasticity::new(100.0, 0.3).unwrap();
    let make = |cohesion: f64, friction: f64, dilation: f64| {
        MohrCoulomb::new(elasticity, cohesion, friction.atan(), dilation).unwrap()
    };
    let mut random = Random(43);
    for (ratio, s) in [(0.5, 1.0), (1.3, 0.4), (0.0, 2.0)] {
        let steepest = make(1.3, 0.8, 0.4);
        let phi = (0.8_f64 * ratio).atan();
        let made = make(1.3 * s, 0.8 * ratio, phi.min(0.4));
        let ratios = Ratios {
            strength: s,
            ..Ratios::ONE
        };
        let at: Law = steepest.at_friction(ratio).unwrap().unwrap();
        let scaled = ScaledLaw::new(at, ratios).unwrap();
        let strength = scaled.shear_strength().unwrap();
        assert!(close(strength.friction_angle, phi, 1.0) && close(strength.cohesive, 1.3 * s, 1.0));
        let weaker: Law = steepest.reduced(1.7).unwrap();
        let weaker = ScaledLaw::new(weaker.at_friction(ratio).unwrap().unwrap(), ratios).unwrap();
        let both = [
            (
                &scaled as &dyn ConstitutiveModel,
                made.reduced(1.0).unwrap(),
            ),
            (&weaker, made.reduced(1.7).unwrap()),
        ];
        for (law, expected) in both {
            for k in 0..400 {
                let size = [1e-3, 1e-2, 0.1, 0.5][k % 4];
                let strain: Principal = random.values(size);
                let history = History::default();
                let one = law
                    .return_map(&strain, &history, &PointContext::STATIC)
                    .unwrap();
                let other = expected
                    .return_map(&strain, &history, &PointContext::STATIC)
                    .unwrap();
                for a in 0..3 {
                    assert!(close(one.tau[a], other.tau[a], 300.0 * size), "{ratio} {s}");
                }
            }
        }
    }
    assert!(make(1.0, 0.5, 0.0).at_friction(-0.1).is_err());
    assert!(make(0.0, 0.5, 0.0).at_friction(0.0).is_err());
    let tresca = Tresca::new(elasticity, 1.0).unwrap();
    assert!(tresca.at_friction(0.5).unwrap().is_none());
}

/// A softening law by the tangents of φ and by ψ, initial and residual.
fn softening(residual_cohesion: f64, tangents: [f64; 2], dilation: [f64; 2]) -> Softening {
    let curve = |[initial, residual]: [f64; 2]| Curve {
        initial,
        residual,
        strain: 0.1,
        decay: Decay::Exponential,
    };
    let curves = FrictionalCurves {
        cohesion: curve([1.3, residual_cohesion]),
        friction_angle: curve(tangents.map(f64::atan)),
        dilation_angle: curve(dilation),
    };
    Softening::mohr_coulomb(Elasticity::new(100.0, 0.3).unwrap(), curves, None).unwrap()
}

/// GOAL: friction of a softening law at a ratio is the law made with those angles, initial and residual, with the dilation that it has
/// or that of φ where that is less; at one it is the law itself.
/// ORACLE: the law made with them. BAND: 1e-12 of stiffness and stress, at one to the bit.
#[test]
fn friction_that_softens_at_a_ratio_is_the_law_with_those_angles() {
    let tangents = [0.8, 0.4];
    // Dilation that is nowhere above φ, and one that is above it all along.
    let rows = [
        ([0.1, 0.0], 0.6, [0.1, 0.0]),
        ([0.1, 0.0], 1.3, [0.1, 0.0]),
        ([0.1, 0.0], 1.0, [0.1, 0.0]),
        ([0.6, 0.3], 0.3, tangents.map(|tan| (0.3_f64 * tan).atan())),
        ([0.1, 0.05], 0.0, [0.0, 0.0]),
    ];
    let mut random = Random(47);
    for (dilation, ratio, acting) in rows {
        let law = softening(0.4, tangents, dilation);
        let at: Law = law.at_friction(ratio).unwrap().unwrap();
        let made = softening(0.4, tangents.map(|tan| ratio * tan), acting);
        for k in 0..600 {
            let size = [1e-3, 1e-2, 0.1, 0.5][k % 4];
            let strain: Principal = random.values(size);
            let mut history = History::default();
            history.internal[0] = [0.0, random.between(0.0, 0.3)][k % 2];
            let answer = |law: &dyn ConstitutiveModel| {
                law.return_map(&strain, &history, &PointContext::STATIC)
                    .unwrap()
            };
            let (one, other) = (answer(&*at), answer(&made));
            for a in 0..3 {
                assert!(close(one.tau[a], other.tau[a], 300.0 * size), "{ratio}");
            }
            let [one_kappa, kappa] = [one, other].map(|map| map.history.internal[0]);
            assert!(close(one_kappa, kappa, 3.0 * size), "{ratio}");
            if ratio.total_cmp(&1.0).is_eq() {
                let expected = answer(&law);
                assert_eq!((expected.tau, expected.tangent), (one.tau, one.tangent));
                assert_eq!(expected.history, one.history);
            }
        }
    }
    assert!(
        softening(0.4, tangents, [0.0; 2])
            .at_friction(-0.1)
            .is_err()
    );
    let bare = softening(0.0, tangents, [0.0; 2]);
    assert!(bare.at_friction(0.0).is_err(), "nothing is left of it");
}
