//! Laws with random parameters: the demands of the catalogue on chosen sets must hold for any.

use std::sync::Arc;

use igimp_material::{
    Cone, ConstitutiveModel, DruckerPrager, Elasticity, History, MohrCoulomb, PointContext,
    Principal, Regime, ReturnMap, Tresca, VonMises,
};

use crate::random::Random;
use crate::returns::{dot, size};

/// Laws that are tried, and states of each.
const LAWS: usize = 3_000;
const STATES: usize = 40;

/// A law of any kind: E over six decades, ν up to 0.4999, strengths down to a millionth of E,
/// angles to 55°, with and without dilation and cut-off.
struct Sample {
    law: Arc<dyn ConstitutiveModel>,
    is_associated: bool,
    strain: f64,
}

fn sample(random: &mut Random) -> Sample {
    let young = 10_f64.powf(random.between(2.0, 8.0));
    let poisson = match random.below(3) {
        0 => random.between(0.0, 0.45),
        1 => random.between(0.45, 0.499),
        _ => 0.4999,
    };
    let elasticity = Elasticity::new(young, poisson).unwrap();
    let strain = 10_f64.powf(random.between(-6.0, -1.0));
    let strength = young * strain;
    let (law, is_associated): (Arc<dyn ConstitutiveModel>, bool) = match random.below(4) {
        0 => {
            let law = VonMises::from_undrained_strength(elasticity, strength).unwrap();
            (Arc::new(law), true)
        }
        1 => (Arc::new(Tresca::new(elasticity, strength).unwrap()), true),
        _ => {
            let friction = match random.below(5) {
                0 => 0.0,
                _ => random.between(1.0, 55.0).to_radians(),
            };
            let dilation = friction * [0.0, 1.0, random.between(0.0, 1.0)][random.below(3)];
            let cohesion = if friction > 0.0 && random.below(6) == 0 {
                0.0
            } else {
                strength
            };
            let cones = [Cone::Compression, Cone::Extension, Cone::PlaneStrain];
            if random.below(3) == 0 {
                let cone = cones[random.below(3)];
                let law = DruckerPrager::new(elasticity, cohesion, friction, dilation, cone);
                let law = Arc::new(law.unwrap());
                return Sample {
                    is_associated: law.has_symmetric_tangent(),
                    law,
                    strain,
                };
            }
            let mut law = MohrCoulomb::new(elasticity, cohesion, friction, dilation).unwrap();
            if random.below(3) == 0 {
                let apex = if friction > 0.0 {
                    cohesion / friction.tan()
                } else {
                    10.0 * cohesion
                };
                law = law
                    .with_tension_cutoff(apex * random.between(0.0, 0.95))
                    .unwrap();
            }
            if random.below(4) == 0 {
                law = law.with_davis_flow().unwrap();
            }
            let is_associated = law.has_symmetric_tangent();
            (Arc::new(law), is_associated)
        }
    };
    Sample {
        law,
        is_associated,
        strain,
    }
}

impl Sample {
    /// A trial strain of the size of yield to a hundred times that, about any mean strain.
    fn trial(&self, random: &mut Random) -> Principal {
        let size = self.strain * 10_f64.powf(random.between(-1.0, 2.0));
        let mean = size * random.symmetric() * 10_f64.powf(random.between(-3.0, 0.5));
        random.values::<3>(size).map(|value| value + mean)
    }

    fn answer(&self, strain: &Principal) -> ReturnMap {
        self.law
            .return_map(strain, &History::default(), &PointContext::STATIC)
            .unwrap()
    }
}

fn for_all(seed: u64, states: usize, check: impl Fn(&Sample, &Principal, &ReturnMap, &mut Random)) {
    let mut random = Random(seed);
    for _ in 0..LAWS {
        let sample = sample(&mut random);
        for _ in 0..states {
            let strain = sample.trial(&mut random);
            let answer = sample.answer(&strain);
            check(&sample, &strain, &answer, &mut random);
        }
    }
}

/// GOAL: admissible, and plastic work not negative.
#[test]
fn returns_are_admissible_and_dissipative() {
    for_all(21, STATES, |sample, strain, answer, _| {
        let excess = sample.law.yield_function(&answer.tau, &answer.history);
        let scale = sample.law.stress_scale(&answer.tau);
        assert!(
            excess <= 1e-12 * scale,
            "{:?} {strain:?} {excess:e}",
            sample.law
        );
        let work = dot(&answer.tau, &answer.delta_eps_p);
        let round_off = 1e-13 * size(&answer.tau) * size(&answer.delta_eps_p);
        assert!(work >= -round_off, "{:?} {strain:?} {work:e}", sample.law);
        assert!(answer.history.eps_p_eq >= 0.0);
    });
}

/// GOAL: a returned state that is returned again changes nothing: elastic, the same stress, no
/// plastic strain, the same history.
#[test]
fn returns_are_idempotent() {
    for_all(22, STATES, |sample, strain, answer, _| {
        let elasticity = sample.law.stiffness_bound();
        let kept = elasticity.strain(&answer.tau);
        let again = sample
            .law
            .return_map(&kept, &answer.history, &PointContext::STATIC)
            .unwrap();
        assert_eq!(again.regime, Regime::Elastic, "{:?} {strain:?}", sample.law);
        assert_eq!(again.history, answer.history);
        assert!(size(&again.delta_eps_p) <= 0.0);
        // The deviator of a stress sums to zero but for round-off, over 2 G and times K again.
        let ratio = elasticity.bulk() / elasticity.shear();
        let round_off = 1e-15 * (10.0 + ratio) * size(&answer.tau);
        for a in 0..3 {
            let moved = (again.tau[a] - answer.tau[a]).abs();
            assert!(moved <= round_off, "{:?} {strain:?} {moved:e}", sample.law);
        }
    });
}

/// GOAL: the order of the principal strains plays no part.
#[test]
fn returns_are_isotropic() {
    for_all(23, STATES / 4, |sample, strain, answer, random| {
        let orders = [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        let order = orders[random.below(5)];
        let permuted = sample.answer(&order.map(|a| strain[a]));
        assert_eq!(permuted.regime, answer.regime);
        let elasticity = sample.law.stiffness_bound();
        let stiffness = elasticity.bulk() + elasticity.shear();
        let admitted = 1e-12 * sample.law.stress_scale(&answer.tau);
        let round_off = 1e-14 * stiffness * size(strain) + admitted;
        for a in 0..3 {
            let moved = (permuted.tau[a] - answer.tau[order[a]]).abs();
            assert!(moved <= round_off, "{:?} {strain:?} {moved:e}", sample.law);
        }
    });
}

/// GOAL: the tangent is the central difference of the stress wherever all six neighbours lie in
/// the same regime, and symmetric where flow is associated.
///
/// Stress is linear in strain within a regime of planes, so that differences are exact but for
/// round-off; the cylinder of von Mises curves, by an error of order h².
#[test]
fn tangents_are_differences() {
    let mut random = Random(24);
    let mut compared = 0;
    for _ in 0..LAWS {
        let sample = sample(&mut random);
        let elasticity = sample.law.stiffness_bound();
        for _ in 0..STATES / 8 {
            let strain = sample.trial(&mut random);
            let answer = sample.answer(&strain);
            let spread = (strain[0] - strain[1])
                .abs()
                .min((strain[1] - strain[2]).abs());
            let spread = spread.min((strain[0] - strain[2]).abs());
            let h = 1e-3 * spread;
            let round_off = 1e-15 * elasticity.bulk() * size(&strain) / h;
            for b in 0..3 {
                let beside = [-h, h].map(|step| {
                    let mut strain = strain;
                    strain[b] += step;
                    sample.answer(&strain)
                });
                if beside.iter().any(|beside| beside.regime != answer.regime) {
                    continue;
                }
                compared += 1;
                for a in 0..3 {
                    let slope = (beside[1].tau[a] - beside[0].tau[a]) / (2.0 * h);
                    let error = (slope - answer.tangent[a][b]).abs();
                    let admitted = 1e-5 * elasticity.shear() + 10.0 * round_off;
                    assert!(error <= admitted, "{:?} {strain:?} {error:e}", sample.law);
                }
            }
            if sample.is_associated {
                let ratio = elasticity.bulk() / elasticity.shear();
                for (a, b) in [(0, 1), (0, 2), (1, 2)] {
                    let skew = (answer.tangent[a][b] - answer.tangent[b][a]).abs();
                    let admitted = 1e-15 * (10.0 + ratio) * elasticity.bulk();
                    assert!(skew <= admitted, "{:?} {strain:?} {skew:e}", sample.law);
                }
            }
        }
    }
    assert!(compared > 20 * LAWS / 10, "only {compared} comparisons");
}
