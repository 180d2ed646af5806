//! The cone whose friction grows with the speed of shear: closed forms, limits, the contract.

use igimp_material::{
    Cone, ConstitutiveModel, DruckerPrager, Elasticity, History, InertialFriction, MaterialError,
    PointContext, Principal, Ratios, Regime, ReturnMap, ScaledLaw, Strength,
};

use crate::random::Random;
use crate::returns::{dot, size};

/// Glass beads of Jop et al. (2006) by tangents, in other units.
const BEADS: InertialFriction = InertialFriction {
    friction_angle: 0.57,
    inertial_number: 0.279,
    grain_diameter: 0.5e-3,
    grain_density: 2450.0,
};
const SLOW: f64 = 0.36;
const COHESION: f64 = 20.0;
const CONES: [Cone; 3] = [Cone::Compression, Cone::Extension, Cone::PlaneStrain];

fn elasticity() -> Elasticity {
    Elasticity::new(1e6, 0.3).unwrap()
}

fn slow(cohesion: f64, cone: Cone) -> DruckerPrager {
    DruckerPrager::new(elasticity(), cohesion, SLOW, 0.0, cone).unwrap()
}

fn law(cohesion: f64, cone: Cone) -> DruckerPrager {
    slow(cohesion, cone).with_rate(BEADS).unwrap()
}

/// M of a cone by an angle, as books have it.
fn slope(cone: Cone, angle: f64) -> f64 {
    let sine = angle.sin();
    match cone {
        Cone::Compression => 6.0 * sine / (3.0 - sine),
        Cone::Extension => 6.0 * sine / (3.0 + sine),
        Cone::PlaneStrain => 3.0_f64.sqrt() * sine,
    }
}

/// M at a rate of shear strain and a pressure, as the literature writes it.
fn friction(cone: Cone, rate: f64, pressure: f64) -> f64 {
    let number = rate * BEADS.grain_diameter / (pressure / BEADS.grain_density).sqrt();
    let [slow, fast] = [SLOW, BEADS.friction_angle].map(|angle| slope(cone, angle));
    slow + (fast - slow) / (1.0 + BEADS.inertial_number / number)
}

/// q, and the mean stress.
fn invariants(tau: &Principal) -> [f64; 2] {
    let mean = tau.iter().sum::<f64>() / 3.0;
    let s = tau.map(|t| t - mean);
    [(1.5 * dot(&s, &s)).sqrt(), mean]
}

/// The strain of a pure shear γ and of a mean stress.
fn strain(gamma: f64, mean: f64) -> Principal {
    let volume = mean / (3.0 * elasticity().bulk());
    [volume + 0.5 * gamma, volume, volume - 0.5 * gamma]
}

fn answer(law: &DruckerPrager, trial: &Principal, duration: f64) -> ReturnMap {
    let context = PointContext::over(duration);
    law.return_map(trial, &History::default(), &context)
        .unwrap()
}

/// Steps of shear at a rate under a constant mean stress from rest; q after each.
fn sheared(law: &DruckerPrager, rate: f64, mean: f64, (step, steps): (f64, usize)) -> Vec<f64> {
    let mut elastic = strain(0.0, mean);
    (0..steps)
        .map(|_| {
            elastic[0] += 0.5 * rate * step;
            elastic[2] -= 0.5 * rate * step;
            let tau = answer(law, &elastic, step).tau;
            elastic = elasticity().strain(&tau);
            invariants(&tau)[0]
        })
        .collect()
}

/// GOAL: steady shear under a constant pressure has the friction μ(I), over eight decades of the rate, in every cone, whatever the step.
/// ORACLE: the formula of Jop et al. with the whole rate of shear, as nothing elastic is left of it. BAND: 1e-10.
#[test]
fn steady_shear_has_the_friction_of_its_inertial_number() {
    for cone in CONES {
        for pressure in [200.0, 5e3] {
            for power in -3..=5 {
                let rate = 10_f64.powi(power);
                for strain in [1e-3, 0.1] {
                    let steps = (2.0 / strain) as usize;
                    let times = (strain / rate, steps);
                    let q = *sheared(&law(0.0, cone), rate, -pressure, times)
                        .last()
                        .unwrap();
                    let expected = pressure * friction(cone, rate, pressure);
                    assert!(
                        (q / expected - 1.0).abs() < 1e-10,
                        "{cone:?} {rate}: {q} {expected}"
                    );
                }
            }
        }
    }
}

/// GOAL: in the cone of plane strain the shear stress over the pressure is the sine of the angles: μ of Jop et al. (eq. 129a). ORACLE: the cone
/// of that sine. BAND: 1e-12.
#[test]
fn friction_in_the_plane_is_the_sine_of_the_angle() {
    let [slow, fast] = [0.38, 0.64_f64];
    let beads = InertialFriction {
        friction_angle: fast.asin(),
        ..BEADS
    };
    let law = DruckerPrager::new(elasticity(), 0.0, slow.asin(), 0.0, Cone::PlaneStrain).unwrap();
    let law = law.with_rate(beads).unwrap();
    let (rate, pressure) = (30.0, 1e3);
    let q = sheared(&law, rate, -pressure, (1e-3, 200))[199];
    let number = rate * 0.5e-3 / (pressure / 2450.0_f64).sqrt();
    let expected = slow + (fast - slow) / (1.0 + 0.279 / number);
    let found = q / 3.0_f64.sqrt() / pressure;
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
}

/// GOAL: shear from rest follows its equation in time, with an error that halves with the step.
/// ORACLE: q' = √3 G (γ' − γ_p'), γ_p' the rate at which friction is q/p, by the midpoint rule in 200 000 steps.
#[test]
fn shear_from_rest_follows_its_equation() {
    let (rate, pressure, span) = (40.0, 500.0, 1.4e-5);
    let [slow, fast] = [SLOW, BEADS.friction_angle].map(|angle| slope(Cone::PlaneStrain, angle));
    let stiffness = 3.0_f64.sqrt() * elasticity().shear();
    let growth = |q: f64| {
        let over = (q / pressure - slow).max(0.0);
        let number = BEADS.inertial_number * over / (fast - q / pressure);
        let plastic = number * (pressure / BEADS.grain_density).sqrt() / BEADS.grain_diameter;
        stiffness * (rate - plastic)
    };
    let (steps, mut q) = (200_000, 0.0);
    let step = span / f64::from(steps);
    for _ in 0..steps {
        q += step * growth(q + 0.5 * step * growth(q));
    }
    let law = law(0.0, Cone::PlaneStrain);
    let off = [40_usize, 80, 160].map(|steps| {
        let times = (span / steps as f64, steps);
        sheared(&law, rate, -pressure, times)[steps - 1] / q - 1.0
    });
    println!("q = {q}, off by {off:?}");
    assert!(off[2].abs() < 1e-2 && off[0].abs() > 1e-4);
    for pair in off.windows(2) {
        assert!((1.7..2.3).contains(&(pair[0] / pair[1])), "{off:?}");
    }
}

/// GOAL: without time the law is the cone to the bit, slow shear comes to it, and shear without end fast to the cone of the fast angle
/// with the same apex. ORACLE: the cones. BAND: 1e-9 of the stress.
#[test]
fn slow_and_fast_shear_have_cones() {
    let mut random = Random(5);
    for cone in CONES {
        let (law, slow) = (law(COHESION, cone), slow(COHESION, cone));
        let fast = BEADS.friction_angle;
        let c = COHESION / SLOW.tan() * fast.tan();
        let fast = DruckerPrager::new(elasticity(), c, fast, 0.0, cone).unwrap();
        for _ in 0..500 {
            let trial = random_trial(&mut random);
            let scale = size(&elasticity().stress(&trial));
            let close = |duration: f64, other: &DruckerPrager| {
                let (found, expected) =
                    (answer(&law, &trial, duration), answer(other, &trial, 0.0));
                let off: Vec<f64> = (0..3).map(|a| found.tau[a] - expected.tau[a]).collect();
                off.iter().all(|x| x.abs() < 1e-9 * scale)
            };
            assert_eq!(answer(&law, &trial, 0.0), answer(&slow, &trial, 0.0));
            assert!(close(1e12, &slow));
            // The elastic range is that of slow shear; beyond it stress is that of the fast cone or the trial.
            let [q, mean] = invariants(&elasticity().stress(&trial));
            let most = slope(cone, BEADS.friction_angle) * (COHESION / SLOW.tan() - mean);
            if q > most {
                assert!(close(1e-30, &fast), "{cone:?} {trial:?}");
            }
        }
    }
}

/// A trial strain around the cone and beyond it.
fn random_trial(random: &mut Random) -> Principal {
    let size = 10_f64.powf(random.between(-6.0, -1.0));
    let values: Principal = random.values(size);
    let mean = values.iter().sum::<f64>() / 3.0;
    let middle = size * random.symmetric();
    values.map(|value| middle + value - mean)
}

/// GOAL: at random trial states, cones, cohesions and durations every regime is met, stress is that of the implicit equation to 1e-10,
/// strain is split exactly and plastic work is no gain. ORACLE: bisection of $`q^{tr} - 3GΔλ = M(I) P`$ as it is written.
#[test]
fn stress_is_that_of_the_implicit_equation() {
    let mut random = Random(11);
    let mut met = [0_usize; 3];
    for _ in 0..6_000 {
        let cone = CONES[random.below(3)];
        let cohesion = [0.0, COHESION][random.below(2)];
        let duration = 10_f64.powf(random.between(-9.0, 3.0));
        let (law, trial) = (law(cohesion, cone), random_trial(&mut random));
        let found = answer(&law, &trial, duration);
        let stress = elasticity().stress(&trial);
        let [q, mean] = invariants(&stress);
        let pressure = cohesion / SLOW.tan() - mean;
        let plastic = elasticity().strain(&found.tau);
        for a in 0..3 {
            let off = trial[a] - plastic[a] - found.delta_eps_p[a];
            assert!(off.abs() < 1e-12 * size(&trial), "{trial:?}");
        }
        let work = dot(&found.tau, &found.delta_eps_p);
        assert!(work >= -1e-12 * size(&stress) * size(&trial), "{work}");
        let expected = match found.regime {
            Regime::Elastic => {
                met[0] += 1;
                q
            }
            Regime::Smooth => {
                met[1] += 1;
                let left = |strain: f64| {
                    let rate = 3.0_f64.sqrt() * strain / duration;
                    q - 3.0 * elasticity().shear() * strain
                        - friction(cone, rate, pressure) * pressure
                };
                let (mut low, mut high) = (0.0, q / (3.0 * elasticity().shear()));
                for _ in 0..200 {
                    let middle = 0.5 * (low + high);
                    if left(middle) > 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                let [_, kept] = invariants(&found.tau);
                assert!((kept - mean).abs() < 1e-12 * size(&stress));
                q - 3.0 * elasticity().shear() * low
            }
            Regime::Apex => {
                met[2] += 1;
                assert!(pressure <= 1e-12 * size(&stress));
                0.0
            }
            other => panic!("{other:?}"),
        };
        let reached = invariants(&found.tau)[0];
        assert!(
            (reached - expected).abs() < 1e-10 * size(&stress),
            "{cone:?} {duration}: {reached} {expected}"
        );
        assert!(
            law.yield_function(&stress, &found.history) > 0.0 || found.regime == Regime::Elastic
        );
    }
    assert!(met.iter().all(|count| *count > 200), "{met:?}");
}

/// GOAL: tangents are derivatives, at rates from far below to far above I₀. ORACLE: central differences. BAND: 1e-5 of G.
#[test]
fn tangents_are_derivatives() {
    let mut random = Random(3);
    let mut tried = 0;
    for _ in 0..3_000 {
        let cone = CONES[random.below(3)];
        let duration = 10_f64.powf(random.between(-8.0, 2.0));
        let (law, trial) = (law(COHESION, cone), random_trial(&mut random));
        let found = answer(&law, &trial, duration);
        let step = 1e-5 * size(&trial);
        for b in 0..3 {
            let [below, above] = [-step, step].map(|step| {
                let mut moved = trial;
                moved[b] += step;
                answer(&law, &moved, duration)
            });
            if below.regime != found.regime || above.regime != found.regime {
                continue;
            }
            tried += 1;
            for a in 0..3 {
                let by = (above.tau[a] - below.tau[a]) / (2.0 * step);
                let off = by - found.tangent[a][b];
                assert!(
                    off.abs() < 1e-5 * elasticity().shear(),
                    "{trial:?} {duration}: {by} {found:?}"
                );
            }
        }
    }
    assert!(tried > 6_000, "{tried}");
}

/// GOAL: reduction and ratios of friction divide both tangents, friction of nothing is none at any speed, and soil at a ratio of
/// stiffness has the rates of its strains. ORACLE: laws made of those parameters. BAND: 1e-12.
#[test]
fn other_strengths_are_laws_of_their_parameters() {
    let same = |a: &dyn ConstitutiveModel, b: &dyn ConstitutiveModel| {
        let mut random = Random(9);
        for _ in 0..300 {
            let trial = random_trial(&mut random);
            let context = PointContext::over(10_f64.powf(random.between(-6.0, 0.0)));
            let [a, b] = [a, b].map(|law| {
                let answer = law.return_map(&trial, &History::default(), &context);
                answer.unwrap().tau
            });
            let scale = size(&a).max(size(&b));
            assert!((0..3).all(|k| (a[k] - b[k]).abs() <= 1e-12 * scale));
        }
    };
    let over = |angle: f64, factor: f64| (angle.tan() / factor).atan();
    let cone = Cone::PlaneStrain;
    let made = |c: f64, factor: f64, young: f64| {
        let elasticity = Elasticity::new(young, 0.3).unwrap();
        let rate = InertialFriction {
            friction_angle: over(BEADS.friction_angle, factor),
            ..BEADS
        };
        let law = DruckerPrager::new(elasticity, c, over(SLOW, factor), 0.0, cone);
        law.unwrap().with_rate(rate).unwrap()
    };
    let base = law(COHESION, cone);
    same(
        &*base.reduced(1.3).unwrap(),
        &made(COHESION / 1.3, 1.3, 1e6),
    );
    let with_more = base.at_friction(1.2).unwrap().unwrap();
    same(&*with_more, &made(COHESION, 1.0 / 1.2, 1e6));
    let none = base.at_friction(0.0).unwrap().unwrap();
    let cylinder = DruckerPrager::new(elasticity(), COHESION, 0.0, 0.0, cone).unwrap();
    same(&*none, &cylinder);
    let ratios = Ratios {
        stiffness: 0.4,
        ..Ratios::ONE
    };
    let whole: &dyn ConstitutiveModel = &base;
    let softer = ScaledLaw::new(whole, ratios).unwrap();
    same(&softer, &made(COHESION, 1.0, 0.4e6));
}

/// GOAL: impossible values are refused by the name of their parameter.
#[test]
fn parameters_out_of_range_are_named() {
    let field = |law: Result<DruckerPrager, MaterialError>| match law {
        Err(MaterialError::InvalidParameter { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    let cone = |friction: f64, dilation: f64| {
        DruckerPrager::new(elasticity(), 1.0, friction, dilation, Cone::PlaneStrain).unwrap()
    };
    assert_eq!(field(cone(SLOW, 0.1).with_rate(BEADS)), "dilation_angle");
    assert_eq!(field(cone(0.0, 0.0).with_rate(BEADS)), "friction_angle");
    assert_eq!(
        field(cone(0.6, 0.0).with_rate(BEADS)),
        "fast friction_angle"
    );
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let with = |rate: InertialFriction| field(cone(SLOW, 0.0).with_rate(rate));
        assert_eq!(
            with(InertialFriction {
                friction_angle: bad,
                ..BEADS
            }),
            "fast friction_angle"
        );
        assert_eq!(
            with(InertialFriction {
                inertial_number: bad,
                ..BEADS
            }),
            "inertial_number"
        );
        assert_eq!(
            with(InertialFriction {
                grain_diameter: bad,
                ..BEADS
            }),
            "grain_diameter"
        );
        assert_eq!(
            with(InertialFriction {
                grain_density: bad,
                ..BEADS
            }),
            "grain_density"
        );
    }
}
