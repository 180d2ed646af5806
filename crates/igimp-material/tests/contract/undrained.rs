//! Undrained strength by the direction of stress and by the rate of strain: closed forms, and the contract.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use igimp_material::{
    AxesLookedAt, ConstitutiveModel, Curve, Decay, Directions, Elasticity, History, MaterialError,
    PointContext, Principal, RateEffect, Ratios, Regime, ReturnMap, ScaledLaw, Softening, Strength,
    Tensor, Tresca, VonMises, directed_history,
};

use crate::every_regime::STATES;
use crate::random::Random;
use crate::returns::{dot, size};

const CU: f64 = 2.0;
const SHARES: Directions = Directions {
    simple_shear: 0.75,
    passive: 0.5,
};
const RATE: RateEffect = RateEffect {
    per_log_cycle: 0.1,
    reference: 1e-6,
};
const CURVE: Curve = Curve {
    initial: CU,
    residual: 0.3 * CU,
    strain: 0.2,
    decay: Decay::Exponential,
};

fn elasticity() -> Elasticity {
    Elasticity::new(100.0, 0.3).unwrap()
}

/// von Mises and Tresca along a curve.
fn both(curve: Curve) -> [Softening; 2] {
    [
        Softening::von_mises(elasticity(), curve).unwrap(),
        Softening::tresca(elasticity(), curve).unwrap(),
    ]
}

/// The curve, the directions and the rate of a law.
pub(crate) type Effects = (Curve, Option<Directions>, Option<RateEffect>);

/// Every law with every set of effects.
pub(crate) fn laws() -> Vec<(Softening, Effects)> {
    let mut all = Vec::new();
    for curve in [Curve::constant(CU), CURVE] {
        for directions in [None, Some(SHARES)] {
            for rate in [None, Some(RATE)] {
                for mut law in both(curve) {
                    if let Some(directions) = directions {
                        law = law.with_directions(directions).unwrap();
                    }
                    if let Some(rate) = rate {
                        law = law.with_rate(rate).unwrap();
                    }
                    all.push((law, (curve, directions, rate)));
                }
            }
        }
    }
    all
}

/// Where κ and the angle stand among the internal variables.
fn places(law: &Softening) -> [Option<usize>; 2] {
    let of = |name: &str| (law.internal_variables().iter()).position(|v| v.name == name);
    [of("softening strain"), of("angle of compression")]
}

fn history(law: &Softening, kappa: f64, angle: f64) -> History {
    let mut history = law.initial_history(&[0.0; 3]);
    history.eps_p_eq = kappa;
    let [of_kappa, of_angle] = places(law);
    for (place, value) in [(of_kappa, kappa), (of_angle, angle)] {
        if let Some(place) = place {
            history.internal[place] = value;
        }
    }
    history
}

/// The strength of a step that began with κ and an angle, from its answer: the product of the formulas, as they are written.
fn strength(effects: &Effects, [kappa, angle]: [f64; 2], duration: f64, answer: &ReturnMap) -> f64 {
    let (curve, directions, rate) = effects;
    let mean = answer.delta_eps_p.iter().sum::<f64>() / 3.0;
    let e_p = answer.delta_eps_p.map(|e| e - mean);
    let step = (2.0 / 3.0 * dot(&e_p, &e_p)).sqrt();
    let left = (-(kappa + step) / curve.strain).exp();
    let soft = curve.residual + (curve.initial - curve.residual) * left;
    let turned = directions.map_or(1.0, |shares| on_ellipse(shares, angle));
    let fast = rate.map_or(1.0, |rate| {
        let over = step * 3.0_f64.sqrt() / duration / rate.reference;
        if duration > 0.0 && over > 1.0 {
            1.0 + rate.per_log_cycle * over.ln() / 10.0_f64.ln()
        } else {
            1.0
        }
    });
    soft * turned * fast
}

/// The share by bisection of the equation of the ellipse, which knows nothing of its solution.
fn on_ellipse(shares: Directions, angle: f64) -> f64 {
    let (centre, level) = (0.5 * (1.0 - shares.passive), 0.5 * (1.0 + shares.passive));
    // Through the strength of simple shear, at zero on the level axis.
    let upright = shares.simple_shear / (1.0 - (centre / level).powi(2)).sqrt();
    let beyond = |radius: f64| {
        let (sine, cosine) = (2.0 * angle).sin_cos();
        ((radius * cosine - centre) / level).powi(2) + (radius * sine / upright).powi(2) > 1.0
    };
    let (mut within, mut outside) = (0.0, 10.0);
    for _ in 0..200 {
        let middle = 0.5 * (within + outside);
        if beyond(middle) {
            outside = middle;
        } else {
            within = middle;
        }
    }
    within
}

/// The strength that a stress has reached: q/√3 of von Mises, half the largest difference of Tresca.
fn reached(law: &Softening, tau: &Principal) -> f64 {
    let name = law.name();
    if name.contains("Mises") {
        let differences = [tau[0] - tau[1], tau[1] - tau[2], tau[2] - tau[0]];
        (dot(&differences, &differences) / 6.0).sqrt()
    } else {
        let most = tau.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        0.5 * (most - tau.iter().copied().fold(f64::INFINITY, f64::min))
    }
}

fn trial(random: &mut Random) -> Principal {
    let size = 10_f64.powf(random.between(-3.0, 0.3));
    let values: Principal = random.values(size);
    let mean = values.iter().sum::<f64>() / 3.0;
    let middle = size * random.symmetric() * 10_f64.powf(random.between(-4.0, 0.3));
    let mut strain = values.map(|value| middle + value - mean);
    let [i, j] = [random.below(3), random.below(3)];
    match random.below(8) {
        0 => strain[i] = strain[j],
        1 => strain = [strain[i]; 3],
        2 => strain = random.values(1e-14),
        3 => strain = random.values(1e3),
        _ => {}
    }
    strain
}

/// A trial strain, κ and angle of any kind, and how long the step takes.
pub(crate) fn state(law: &Softening, random: &mut Random) -> (Principal, History, f64) {
    let kappa = [0.0, random.between(0.0, 0.5)][random.below(2)];
    let angle = FRAC_PI_2 * [0.0, 0.5, 1.0, random.between(0.0, 1.0)][random.below(4)];
    let duration = [0.0, 10_f64.powf(random.between(-3.0, 8.0))][random.below(2)];
    (trial(random), history(law, kappa, angle), duration)
}

/// GOAL: of random states, histories, angles and durations of every law every regime is met, no number is not finite, the strength is
/// that of the formulas to 1e-9, and nothing gains from plastic work. ORACLE: the formulas, the ellipse by bisection.
#[test]
fn strength_is_that_of_the_formulas_in_every_regime() {
    for (law, effects) in laws() {
        let mut random = Random(71);
        let mut met = [0_usize; 4];
        for _ in 0..STATES / 16 {
            let (strain, history, duration) = state(&law, &mut random);
            let [of_kappa, of_angle] = places(&law);
            let before = |place: Option<usize>| place.map_or(0.0, |k| history.internal[k]);
            let begin = [before(of_kappa), before(of_angle)];
            let answer = law.return_map(&strain, &history, &PointContext::over(duration));
            let about = || format!("{law:?} {strain:?} {begin:?} {duration:e}");
            let answer = answer.unwrap_or_else(|error| panic!("{} {error}", about()));
            let numbers = answer.tangent.as_flattened().iter().chain(&answer.tau);
            assert!(
                numbers
                    .chain(&answer.history.internal)
                    .all(|v| v.is_finite()),
                "{}",
                about()
            );
            let kept = strength(&effects, begin, duration, &answer);
            let round_off = 4e-12 * law.stress_scale(&answer.tau);
            let over = reached(&law, &answer.tau) - kept;
            assert!(over <= 1e-9 * kept + round_off, "{} {over:e}", about());
            if answer.regime.is_plastic() {
                assert!(over >= -1e-9 * kept - round_off, "{} {over:e}", about());
            }
            let work = dot(&answer.tau, &answer.delta_eps_p);
            let flow = size(&answer.delta_eps_p);
            assert!(work >= -1e-13 * size(&answer.tau) * flow, "{}", about());
            met[usize::from(answer.regime.code())] += 1;
        }
        let is_tresca = law.name().contains("Tresca");
        let all = if is_tresca { 4 } else { 2 };
        assert!(
            met[..all].iter().all(|&count| count > 20),
            "{} {met:?}",
            law.name()
        );
    }
}

/// GOAL: three equal strengths are the law that exists, to round-off, whatever the angle. ORACLE: that law, which returns to planes that
/// it keeps.
#[test]
fn equal_strengths_are_the_isotropic_law() {
    let equal = Directions {
        simple_shear: 1.0,
        passive: 1.0,
    };
    let plain: [Arc<dyn ConstitutiveModel>; 2] = [
        Arc::new(VonMises::from_undrained_strength(elasticity(), CU).unwrap()),
        Arc::new(Tresca::new(elasticity(), CU).unwrap()),
    ];
    for (law, plain) in both(Curve::constant(CU)).into_iter().zip(plain) {
        let law = law.with_directions(equal).unwrap();
        assert_eq!(law.has_symmetric_tangent(), plain.has_symmetric_tangent());
        let mut random = Random(72);
        for _ in 0..STATES {
            let strain = trial(&mut random);
            let start = history(&law, 0.1, random.between(0.0, FRAC_PI_2));
            let [one, other] = [
                law.return_map(&strain, &start, &PointContext::STATIC)
                    .unwrap(),
                plain
                    .return_map(&strain, &start, &PointContext::STATIC)
                    .unwrap(),
            ];
            assert_eq!(one.regime, other.regime);
            let size = strain.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let stiffness = elasticity().tangent()[0][0];
            let near = |a: &[f64], b: &[f64], scale: f64| {
                let pairs = a.iter().zip(b);
                pairs.for_each(|(a, b)| assert!((a - b).abs() <= 1e-14 * scale, "{a} {b}"));
            };
            near(&one.tau, &other.tau, stiffness * size);
            near(&one.delta_eps_p, &other.delta_eps_p, 10.0 * size);
            let [a, b] = [&one, &other].map(|map| map.tangent.as_flattened());
            near(a, b, stiffness);
        }
    }
}

/// GOAL: the angle is that of the axis of the major compression from the vertical, in the plane and in space, and level where that goes
/// around the axis of a body of revolution; where the stress has no direction it stays. ORACLE: stresses made by turning.
#[test]
fn the_angle_is_that_of_the_major_compression() {
    let law = both(Curve::constant(CU))[1]
        .clone()
        .with_directions(SHARES)
        .unwrap();
    for angle in [0.0, 0.2, 0.7, 1.2, FRAC_PI_2] {
        let (sine, cosine) = f64::sin_cos(angle);
        // Major compression along (sin, cos) of the plane and of (x, z); the third stress greater still.
        let along = [[sine, cosine, 0.0], [sine, 0.0, cosine]];
        let stress = |axis: &[f64; 3], third: usize| -> Tensor {
            std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    let mean = if i == j { -1.0 } else { 0.0 };
                    let level = if i == third && j == third { -5.0 } else { 0.0 };
                    mean - 2.0 * axis[i] * axis[j] + level
                })
            })
        };
        let start = history(&law, 0.0, 0.3);
        let plane = AxesLookedAt::of_dimension::<2>();
        let in_plane = directed_history::<2>(&law, &stress(&along[0], 2), start, plane);
        assert!((in_plane.internal[0] - angle).abs() < 1e-12, "{angle}");
        let mut spatial = stress(&along[1], 1);
        spatial[1][1] = -1.5;
        let in_space =
            directed_history::<3>(&law, &spatial, start, AxesLookedAt::of_dimension::<3>());
        assert!((in_space.internal[0] - angle).abs() < 1e-12, "{angle}");
        let even = [[-2.0, 1e-12, 0.0], [1e-12, -2.0, 0.0], [0.0, 0.0, -1.0]];
        assert_eq!(directed_history::<2>(&law, &even, start, plane), start);
        // Around the axis of a body of revolution the same stress is level.
        let hoop = AxesLookedAt::with_hoop::<2>();
        let around = directed_history::<2>(&law, &stress(&along[0], 2), start, hoop);
        assert!((around.internal[0] - FRAC_PI_2).abs() < 1e-12, "{angle}");
        let mut pulled = stress(&along[0], 2);
        pulled[2][2] = 0.0;
        let in_section = directed_history::<2>(&law, &pulled, start, hoop);
        assert!((in_section.internal[0] - angle).abs() < 1e-12, "{angle}");
    }
}

/// GOAL: sheared at a constant rate soil has s_u (1 + μ log10(rate/reference)), to 1e-9, at five rates, in one step or many; at the
/// reference rate and below that of statics. ORACLE: the formula; with half the step the same. Soil at ratios of strength and stiffness
/// has the rates of its own strains.
#[test]
fn strength_grows_with_the_logarithm_of_the_rate() {
    let ratios = Ratios {
        strength: 3.0,
        stiffness: 2.0,
        ..Ratios::ONE
    };
    for law in both(Curve::constant(CU)) {
        let law: Arc<dyn ConstitutiveModel> = Arc::new(law.with_rate(RATE).unwrap());
        let scaled = ScaledLaw::new(&*law, ratios).unwrap();
        for rate in [1e-7, 1e-6, 1e-5, 1e-3, 1.0] {
            let expected = CU * (1.0 + RATE.per_log_cycle * (rate / 1e-6_f64).max(1.0).log10());
            for steps in [20, 40] {
                for (asked, times) in [(&*law, 1.0), (&scaled as &dyn ConstitutiveModel, 3.0)] {
                    let gamma = 4.0 / f64::from(steps);
                    let mut elastic = [0.0; 3];
                    let mut history = asked.initial_history(&[0.0; 3]);
                    let mut shear = 0.0;
                    for _ in 0..steps {
                        elastic[0] += 0.5 * gamma;
                        elastic[1] -= 0.5 * gamma;
                        let answer = asked
                            .return_map(&elastic, &history, &PointContext::over(gamma / rate))
                            .unwrap();
                        elastic = asked.stiffness_bound().strain(&answer.tau);
                        history = answer.history;
                        shear = 0.5 * (answer.tau[0] - answer.tau[1]);
                    }
                    let error = shear / (times * expected) - 1.0;
                    assert!(error.abs() < 1e-9, "{rate:e} {steps} {times}: {error:e}");
                }
            }
        }
    }
}

/// GOAL: tangents of all sets of effects are derivatives, also at ratios of strength and stiffness, and symmetric where the law says so.
/// ORACLE: central differences, of states that stay in their regime and on one side of the reference rate.
#[test]
fn tangents_are_derivatives() {
    let ratios = Ratios {
        strength: 0.4,
        stiffness: 1.7,
        ..Ratios::ONE
    };
    for (law, effects) in laws() {
        let law: Arc<dyn ConstitutiveModel> = Arc::new(law);
        let scaled = ScaledLaw::new(&*law, ratios).unwrap();
        let mut random = Random(73);
        let mut tried = 0;
        for state in 0..600 {
            let asked: &dyn ConstitutiveModel = if state % 2 == 0 { &*law } else { &scaled };
            let mut history = asked.initial_history(&[0.0; 3]);
            history.internal[0] = random.between(0.0, 0.4);
            // So long that plastic strain is well above the reference rate, or well below.
            let duration = [1.0, 1e9][random.below(2)];
            let strain: Principal = random.values(0.1);
            let step = 1e-7;
            let at = |strain: &Principal| {
                asked
                    .return_map(strain, &history, &PointContext::over(duration))
                    .unwrap()
            };
            let answer = at(&strain);
            if size(&answer.delta_eps_p) < 1e-3 {
                continue;
            }
            for b in 0..3 {
                let [mut less, mut more] = [strain; 2];
                less[b] -= step;
                more[b] += step;
                let [less, more] = [at(&less), at(&more)];
                if less.regime != answer.regime || more.regime != answer.regime {
                    continue;
                }
                for a in 0..3 {
                    let slope = (more.tau[a] - less.tau[a]) / (2.0 * step);
                    let error = slope - answer.tangent[a][b];
                    assert!(
                        error.abs() < 2e-4 * 100.0,
                        "{} {effects:?} {error:e}",
                        law.name()
                    );
                    let skew = answer.tangent[a][b] - answer.tangent[b][a];
                    assert!(!law.has_symmetric_tangent() || skew.abs() < 1e-9 * 100.0);
                }
                tried += 1;
            }
        }
        assert!(tried > 600, "{}: {tried}", law.name());
    }
}

/// GOAL: strength reduction divides the strength in every direction, at every rate and all along the curve, to the bit of a law that was
/// made weaker. Frictional soil and numbers that make no law are refused by name.
#[test]
fn reduction_divides_all_and_friction_is_refused() {
    for (law, (curve, directions, rate)) in laws() {
        let weaker = Curve {
            initial: curve.initial / 1.6,
            residual: curve.residual / 1.6,
            ..curve
        };
        let place = usize::from(law.name().contains("Tresca"));
        let mut made = both(weaker)[place].clone();
        if let Some(directions) = directions {
            made = made.with_directions(directions).unwrap();
        }
        if let Some(rate) = rate {
            made = made.with_rate(rate).unwrap();
        }
        let reduced = law.reduced(1.6).unwrap();
        let mut random = Random(74);
        for _ in 0..200 {
            let strain = trial(&mut random);
            let start = history(&law, 0.1, random.between(0.0, FRAC_PI_2));
            let [one, other] = [&*reduced, &made as &dyn ConstitutiveModel].map(|law| {
                law.return_map(&strain, &start, &PointContext::over(1.0))
                    .unwrap()
            });
            for a in 0..3 {
                let error = (one.tau[a] - other.tau[a]).abs();
                assert!(error <= 1e-12 * law.stress_scale(&other.tau));
            }
            assert!(one.regime == other.regime || one.regime == Regime::Elastic);
        }
    }
    let frictional = igimp_material::FrictionalCurves {
        cohesion: CURVE,
        friction_angle: Curve::constant(0.4),
        dilation_angle: Curve::constant(0.0),
    };
    let sand = Softening::mohr_coulomb(elasticity(), frictional, None).unwrap();
    let field = |refused: Result<Softening, MaterialError>| match refused {
        Err(MaterialError::InvalidParameter { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        field(sand.clone().with_directions(SHARES)),
        "friction_angle"
    );
    assert_eq!(field(sand.with_rate(RATE)), "friction_angle");
    let clay = both(CURVE)[0].clone();
    for passive in [0.0, -1.0, f64::NAN] {
        let shares = Directions { passive, ..SHARES };
        assert_eq!(field(clay.clone().with_directions(shares)), "passive");
    }
    let backwards = RateEffect {
        reference: 0.0,
        ..RATE
    };
    assert_eq!(field(clay.with_rate(backwards)), "reference");
}
