//! Laws whose strength goes with plastic strain: the contract, and curves in closed form.

use std::sync::Arc;

use igimp_material::{
    ConstitutiveModel, Curve, Decay, Elasticity, FrictionalCurves, History, MaterialError,
    Nonlocal, PointContext, Principal, Ratios, Regime, ScaledLaw, Softening, Strength,
};

use crate::random::Random;
use crate::returns::{dot, size};

const G: f64 = 100.0 / 2.6;

fn elasticity() -> Elasticity {
    Elasticity::new(100.0, 0.3).unwrap()
}

fn curve(initial: f64, residual: f64, strain: f64, decay: Decay) -> Curve {
    Curve {
        initial,
        residual,
        strain,
        decay,
    }
}

/// Cohesion, friction and dilation in degrees, initial and residual, and a cut-off.
type Row = ([f64; 2], [f64; 2], [f64; 2], Option<f64>);

/// Those that are tried.
const FRICTIONAL: [Row; 6] = [
    ([1.0, 0.2], [30.0, 20.0], [10.0, 0.0], None),
    ([1.0, 0.0], [25.0, 25.0], [0.0, 0.0], None),
    ([1.0, 1.0], [20.0, 35.0], [5.0, 0.0], None),
    ([0.0, 0.0], [35.0, 28.0], [12.0, 0.0], None),
    ([1.0, 0.3], [25.0, 20.0], [25.0, 0.0], Some(0.5)),
    ([2.0, 0.5], [0.0, 0.0], [0.0, 0.0], Some(1.0)),
];

fn frictional(row: usize, decay: Decay) -> Softening {
    let (c, friction, dilation, cutoff) = FRICTIONAL[row];
    let angles =
        |[from, to]: [f64; 2], strain| curve(from.to_radians(), to.to_radians(), strain, decay);
    let curves = FrictionalCurves {
        cohesion: curve(c[0], c[1], 0.08, decay),
        friction_angle: angles(friction, 0.12),
        dilation_angle: angles(dilation, 0.05),
    };
    Softening::mohr_coulomb(elasticity(), curves, cutoff).unwrap()
}

/// Softening and hardening laws of every kind.
pub(crate) fn families() -> Vec<Vec<Arc<dyn ConstitutiveModel>>> {
    let decays = [Decay::Linear, Decay::Exponential];
    let undrained = |[initial, residual, strain]: [f64; 3]| {
        decays.map(|decay| curve(initial, residual, strain, decay))
    };
    let all = [[1.0, 0.3, 0.05], [1.0, 1.8, 0.1], [2.0, 1e-3, 0.08]].map(undrained);
    let von_mises = |cu| Arc::new(Softening::von_mises(elasticity(), cu).unwrap()) as Arc<_>;
    let tresca = |cu| Arc::new(Softening::tresca(elasticity(), cu).unwrap()) as Arc<_>;
    let rows = 0..FRICTIONAL.len();
    let mohr = |row| decays.map(|decay| Arc::new(frictional(row, decay)) as Arc<_>);
    vec![
        all.iter().flatten().copied().map(von_mises).collect(),
        all.iter().flatten().copied().map(tresca).collect(),
        rows.flat_map(mohr).collect(),
    ]
}

/// A trial strain of general position, of two equal values, or hydrostatic in the main, from 1e-5 to a few hundred percent.
pub(crate) fn trial(random: &mut Random) -> Principal {
    let size = 10_f64.powf(random.between(-3.0, 0.3));
    let middle = size * random.symmetric() * 10_f64.powf(random.between(-4.0, 0.3));
    let values: Principal = random.values(size);
    let mean = values.iter().sum::<f64>() / 3.0;
    let mut strain = values.map(|value| middle + value - mean);
    let [i, j] = [random.below(3), random.below(3)];
    match random.below(8) {
        0 => strain[i] = strain[j],
        1 => strain = [strain[i]; 3],
        _ => {}
    }
    strain
}

pub(crate) fn sheared(kappa: f64) -> History {
    let mut history = History::of_plastic_strain(kappa);
    history.internal[0] = kappa;
    history
}

/// GOAL: of 20 000 random states and histories per family of laws every answer is finite, on the surface of the strength that is left, and
/// dissipates; strain splits; κ grows by the plastic strain of the step; a returned state is not returned again.
#[test]
fn returns_are_admissible_and_dissipate() {
    for family in families() {
        let states = STATES / family.len() + 1;
        for law in family {
            let mut random = Random(41);
            let mut plastic = 0;
            for _ in 0..states {
                let history = sheared([0.0, random.between(0.0, 0.3)][random.below(2)]);
                let strain = trial(&mut random);
                let answer = law
                    .return_map(&strain, &history, &PointContext::STATIC)
                    .unwrap_or_else(|error| panic!("{law:?} {strain:?} {history:?} {error}"));
                let about = || format!("{law:?} {strain:?} {history:?} {answer:?}");
                let scale = law.stress_scale(&answer.tau);
                let excess = law.yield_function(&answer.tau, &answer.history);
                assert!(excess <= 1e-12 * scale, "{} {excess:e}", about());
                let numbers = answer.tangent.as_flattened().iter().chain(&answer.tau);
                assert!(
                    numbers
                        .chain(&answer.history.internal)
                        .all(|n| n.is_finite())
                );
                let work = dot(&answer.tau, &answer.delta_eps_p);
                let flow = size(&answer.delta_eps_p);
                assert!(work >= -1e-13 * size(&answer.tau) * flow, "{}", about());
                let elastic = law.stiffness_bound().strain(&answer.tau);
                for a in 0..3 {
                    let error = strain[a] - elastic[a] - answer.delta_eps_p[a];
                    assert!(error.abs() <= 1e-13 * (1.0 + size(&strain)), "{}", about());
                }
                let grown = answer.history.eps_p_eq - history.eps_p_eq;
                let softened = answer.history.internal[0] - history.internal[0];
                assert!(
                    (grown - softened).abs() <= 1e-13 * (1.0 + grown),
                    "{}",
                    about()
                );
                let again = law
                    .return_map(&elastic, &answer.history, &PointContext::STATIC)
                    .unwrap();
                assert_eq!(again.regime, Regime::Elastic, "{}", about());
                plastic += usize::from(answer.regime.is_plastic());
            }
            assert!(plastic > states / 3, "{law:?}: {plastic} of {states}");
        }
    }
}

/// States per law.
const STATES: usize = 20_000;

/// GOAL: D = ∂τ/∂ε by fourth-order differences within a regime, in every regime. BAND: 1e-6 of 2G.
#[test]
fn tangents_are_derivatives() {
    for law in families().into_iter().flatten() {
        let mut random = Random(42);
        let mut seen = Vec::new();
        for _ in 0..6_000 {
            let history = sheared([0.0, random.between(0.0, 0.2)][random.below(2)]);
            let size = 10_f64.powf(random.between(-2.5, -0.5));
            let middle = size * random.symmetric() * random.between(0.0, 2.0);
            let strain = random.values::<3>(size).map(|value| value + middle);
            let answer = law
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let h = 2e-5 * size;
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
                // A straight line ends, and flow that is capped at φ begins, at a kink.
                let slope = |a: usize| {
                    let near = (right[a] - left[a]) / (2.0 * h);
                    let wide = (far_right[a] - far_left[a]) / (4.0 * h);
                    ((4.0 * near - wide) / 3.0, (near - wide).abs())
                };
                if (0..3).any(|a| slope(a).1 > 1e-4 * G) {
                    continue;
                }
                for a in 0..3 {
                    let error = (slope(a).0 - answer.tangent[a][b]).abs() / (2.0 * G);
                    assert!(
                        error < 1e-6,
                        "{law:?} {strain:?} {history:?} {answer:?} {error:e}"
                    );
                }
                if !seen.contains(&answer.regime) {
                    seen.push(answer.regime);
                }
            }
        }
        assert!(seen.len() >= 2, "{law:?}: {seen:?}");
    }
}

/// GOAL: the answer goes with the order of the principal values.
#[test]
fn answers_are_isotropic() {
    for law in families().into_iter().flatten() {
        let mut random = Random(43);
        for _ in 0..500 {
            let (history, strain) = (sheared(random.between(0.0, 0.1)), trial(&mut random));
            let answer = law
                .return_map(&strain, &history, &PointContext::STATIC)
                .unwrap();
            let turned = [strain[2], strain[0], strain[1]];
            let other = law
                .return_map(&turned, &history, &PointContext::STATIC)
                .unwrap();
            for a in 0..3 {
                let error = (other.tau[(a + 1) % 3] - answer.tau[a]).abs();
                let admitted = 1e-12 * (law.stress_scale(&answer.tau) + 300.0 * size(&strain));
                assert!(error <= admitted, "{law:?} {strain:?} {error:e}");
            }
        }
    }
}

/// GOAL: shear in the plane follows the curve, in one step as in many. ORACLE: τ = c(κ), κ = (γ − τ/G)/√3, in closed form for the line
/// (eq. 109) and by its residual for the exponential. BAND: 1e-12 of the strength.
#[test]
fn shear_follows_the_curve() {
    let (peak, residual, strain) = (1.0, 0.3, 0.05);
    for decay in [Decay::Linear, Decay::Exponential] {
        let cu = curve(peak, residual, strain, decay);
        let laws = [
            Softening::tresca(elasticity(), cu).unwrap(),
            Softening::von_mises(elasticity(), cu).unwrap(),
        ];
        for law in laws {
            for steps in [1, 7, 60] {
                let (mut elastic, mut history) = ([0.0; 3], History::default());
                let step = 0.09 / f64::from(steps);
                for k in 1..=steps {
                    let trial = [elastic[0] + 0.5 * step, 0.0, elastic[2] - 0.5 * step];
                    let answer = law
                        .return_map(&trial, &history, &PointContext::STATIC)
                        .unwrap();
                    elastic = law.stiffness_bound().strain(&answer.tau);
                    history = answer.history;
                    let (gamma, tau) = (step * f64::from(k), answer.tau[0]);
                    let kappa = (gamma - tau / G) / 3.0_f64.sqrt();
                    let expected = match decay {
                        _ if gamma * G <= peak => gamma * G,
                        Decay::Linear => {
                            let fall = (peak - residual) / (3.0_f64.sqrt() * strain);
                            ((peak - fall * gamma) / (1.0 - fall / G)).max(residual)
                        }
                        Decay::Exponential => {
                            residual + (peak - residual) * (-kappa / strain).exp()
                        }
                    };
                    assert!(
                        (tau - expected).abs() < 1e-12 * peak,
                        "{law:?} {gamma} {tau} {expected}"
                    );
                }
                assert!(history.internal[0] > 0.04, "{history:?}");
            }
        }
    }
}

/// GOAL: triaxial compression of frictional soil has q of eq. 21 with c, φ of its plastic strain, and soil sheared far dilates no more.
/// BAND: 1e-11.
#[test]
fn friction_and_dilation_follow_their_curves() {
    let law = frictional(0, Decay::Exponential);
    let (mut elastic, mut history) = (law.stiffness_bound().strain(&[-3.0; 3]), History::default());
    let mut volume = [0.0; 2];
    for step in 0..400 {
        let trial = [elastic[0] + 1e-3, elastic[1] + 1e-3, elastic[2] - 2e-3];
        let answer = law
            .return_map(&trial, &history, &PointContext::STATIC)
            .unwrap();
        elastic = law.stiffness_bound().strain(&answer.tau);
        history = answer.history;
        volume = [volume[1], answer.delta_eps_p.iter().sum()];
        if step > 50 {
            let kappa = history.internal[0];
            let way = |from: f64, to: f64, strain: f64| to + (from - to) * (-kappa / strain).exp();
            let tangent = way(
                f64::to_radians(30.0).tan(),
                f64::to_radians(20.0).tan(),
                0.12,
            );
            let (sin, cos) = tangent.atan().sin_cos();
            let c = way(1.0, 0.2, 0.08);
            let [major, _, minor] = answer.tau;
            let expected = 2.0 * c * cos - (major + minor) * sin;
            assert!((major - minor - expected).abs() < 1e-11, "{step} {kappa}");
        }
    }
    // ψ is 10° at first and ends with κ: its share exp(−κ/0.05) of the tangent is left.
    assert!(
        history.internal[0] > 0.7 && volume[1] >= 0.0 && volume[1] < 1e-9,
        "{volume:?}"
    );
}

/// GOAL: a reduction divides c, c_u and tan φ all along the curve, and leaves plastic strains as they are.
#[test]
fn a_reduction_divides_the_curve() {
    let srf = 1.4;
    let law = frictional(0, Decay::Exponential);
    let reduced = law.reduced(srf).unwrap();
    let weaker = |angle: f64| (angle.to_radians().tan() / srf).atan();
    let decay = Decay::Exponential;
    let curves = FrictionalCurves {
        cohesion: curve(1.0 / srf, 0.2 / srf, 0.08, decay),
        friction_angle: curve(weaker(30.0), weaker(20.0), 0.12, decay),
        dilation_angle: curve(10_f64.to_radians(), 0.0, 0.05, decay),
    };
    let made = Softening::mohr_coulomb(elasticity(), curves, None).unwrap();
    let mut random = Random(44);
    for _ in 0..2_000 {
        let (history, strain) = (sheared(random.between(0.0, 0.2)), trial(&mut random));
        let [one, other] = [&*reduced, &made].map(|law| {
            law.return_map(&strain, &history, &PointContext::STATIC)
                .unwrap()
        });
        for a in 0..3 {
            let error = (one.tau[a] - other.tau[a]).abs();
            assert!(
                error < 1e-11 * (1.0 + size(&one.tau)),
                "{strain:?} {error:e}"
            );
        }
    }
    assert!(matches!(
        law.reduced(0.0),
        Err(MaterialError::InvalidParameter { .. })
    ));
}

/// GOAL: a law at ratios answers as the law with those parameters along the same curve over κ, tangents and nonlocal rates included: a
/// stated strain is that of the soil, whatever its strength and stiffness. ORACLE: the law made with them.
#[test]
fn a_scaled_law_is_the_law_with_scaled_curves() {
    let (strength, stiffness) = (2.5, 0.8);
    let ratios = Ratios {
        strength,
        stiffness,
        ..Ratios::ONE
    };
    let law = |c: f64, e: f64| {
        let cu = curve(c, 0.3 * c, 0.05, Decay::Linear);
        Softening::tresca(elasticity().scaled(e).unwrap(), cu).unwrap()
    };
    let nonlocal = Nonlocal {
        length: 0.1,
        over_nonlocal: 2.0,
    };
    for sees_around in [false, true] {
        let law = |c: f64, e: f64| -> Arc<dyn ConstitutiveModel> {
            let base = law(c, e);
            let around = || base.clone().with_nonlocal(nonlocal).unwrap();
            Arc::new(if sees_around { around() } else { base.clone() })
        };
        let scaled = ScaledLaw::new(law(1.0, 1.0), ratios).unwrap();
        let made = law(strength, stiffness);
        let mut random = Random(45);
        for _ in 0..2_000 {
            let (mut history, strain) = (sheared(random.between(0.0, 0.2)), trial(&mut random));
            if sees_around {
                history.internal[1] = random.between(0.0, 0.2);
            }
            let context = PointContext {
                nonlocal_rise: random.between(0.0, 0.01),
                ..PointContext::STATIC
            };
            let one = scaled.return_map(&strain, &history, &context).unwrap();
            let other = made.return_map(&strain, &history, &context).unwrap();
            let stress = 1.0 + size(&one.tau);
            let near = |a: &[f64], b: &[f64], band: f64| {
                let pairs = std::iter::zip(a, b);
                pairs.for_each(|(a, b)| assert!((a - b).abs() <= band, "{a} {b}"));
            };
            near(&one.tau, &other.tau, 1e-11 * stress);
            near(&one.history.internal, &other.history.internal, 1e-12);
            let [a, b] = [&one, &other].map(|map| map.tangent.as_flattened());
            near(a, b, 1e-8 * stress * G);
            let (a, b) = (&one.nonlocal, &other.nonlocal);
            near(&[a.plastic], &[b.plastic], 1e-12);
            near(&[a.plastic_by_nonlocal], &[b.plastic_by_nonlocal], 1e-8);
            near(&a.plastic_by_strain, &b.plastic_by_strain, 1e-8);
            near(&a.stress_by_nonlocal, &b.stress_by_nonlocal, 1e-8 * stress);
            let [a, b] = [&scaled as &dyn ConstitutiveModel, &*made]
                .map(|law| law.shear_strength_at(&history).unwrap().cohesive);
            near(&[a], &[b], 1e-12);
            let left = |kappa: f64| strength * (1.0 - 0.7 * (kappa / 0.05).min(1.0));
            if !sees_around {
                near(&[a], &[left(history.internal[0])], 1e-12);
            }
        }
    }
}

/// GOAL: sheared in the plane soil at ratios has the strength that its curve states at its plastic strain, and tells it. ORACLE: the line
/// through initial and residual strength over κ; ratios as far apart as a crust and deep clay have them.
#[test]
fn stated_strains_hold_at_every_ratio() {
    let line = |c: f64, kappa: f64| c * (1.0 - 0.5 * (kappa / 0.1).min(1.0));
    let cu = curve(1.0, 0.5, 0.1, Decay::Linear);
    let laws: [Arc<dyn ConstitutiveModel>; 2] = [
        Arc::new(Softening::tresca(elasticity(), cu).unwrap()),
        Arc::new(Softening::von_mises(elasticity(), cu).unwrap()),
    ];
    for law in laws {
        for (strength, stiffness) in [(0.1, 1.0), (1.0, 0.3), (9.0, 1.0), (0.01, 0.3)] {
            let ratios = Ratios {
                strength,
                stiffness,
                ..Ratios::ONE
            };
            let scaled = ScaledLaw::new(&*law, ratios).unwrap();
            let (mut strain, mut history) = ([0.0; 3], scaled.initial_history(&[0.0; 3]));
            for _ in 0..20 {
                strain[0] += 0.004;
                strain[1] -= 0.004;
                let answer = scaled
                    .return_map(&strain, &history, &PointContext::STATIC)
                    .unwrap();
                (strain, history) = (scaled.stiffness_bound().strain(&answer.tau), answer.history);
                let shear = 0.5 * (answer.tau[0] - answer.tau[1]);
                let kappa = history.internal[0];
                if kappa > 0.0 {
                    let expected = line(strength, kappa);
                    assert!((shear / expected - 1.0).abs() < 1e-9, "{shear} {expected}");
                    let found = scaled.shear_strength_at(&history).unwrap();
                    assert!((found.cohesive / expected - 1.0).abs() < 1e-12);
                }
                assert!((kappa - history.eps_p_eq).abs() < 1e-12);
            }
        }
    }
}

/// GOAL: snap-back within the point is refused where the slope of c_u reaches √3 G in shear of von Mises, and 3/2 G along the edges of
/// Tresca (eq. 109), and strengths that no soil has by their names.
#[test]
fn steep_curves_are_refused() {
    let at = |share: f64, least: f64| {
        let strain = 0.7 / (share * least * G);
        curve(1.0, 0.3, strain, Decay::Linear)
    };
    for (share, is_taken) in [(0.98, true), (1.01, false)] {
        let von_mises = Softening::von_mises(elasticity(), at(share, 3.0_f64.sqrt()));
        let tresca = Softening::tresca(elasticity(), at(share, 1.5));
        for law in [von_mises, tresca] {
            match law {
                Ok(_) => assert!(is_taken),
                Err(error) => {
                    assert!(
                        !is_taken && error.to_string().contains("snaps back"),
                        "{error}"
                    );
                }
            }
        }
    }
    let refused = |curve| {
        Softening::tresca(elasticity(), curve)
            .unwrap_err()
            .to_string()
    };
    let none = refused(curve(1.0, 0.0, 0.1, Decay::Linear));
    assert_eq!(none, "`undrained_strength` = 0 must be positive and finite");
    let never = refused(curve(1.0, 0.5, 0.0, Decay::Linear));
    assert_eq!(never, "`softening strain` = 0 must be positive and finite");
    let nothing = FrictionalCurves {
        cohesion: curve(1.0, 0.0, 0.1, Decay::Linear),
        friction_angle: curve(0.5, 0.0, 0.1, Decay::Linear),
        dilation_angle: Curve::constant(0.0),
    };
    let nothing = Softening::mohr_coulomb(elasticity(), nothing, None);
    assert!(nothing.unwrap_err().to_string().contains("`cohesion` = 0"));
}
