//! Trial states for the return maps: random, all elastic or all plastic.

use std::sync::Arc;

use igimp_assembly::SharedLaw;
use igimp_material::{
    Elasticity, HenckyElastic, History, MaterialError, MohrCoulomb, Principal, Tensor, Tresca,
    VonMises,
};

use crate::random::Random;

/// Trial states per bench: enough to defeat the branch predictor, few enough to stay in cache.
pub const COUNT: usize = 1024;

/// Young's modulus \[stress\].
const YOUNG: f64 = 1e5;
/// Cohesion and undrained strength \[stress\].
const STRENGTH: f64 = 100.0;

/// On which side of the yield surface a trial state lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Within: the trial stress is the answer.
    Elastic,
    /// Beyond: the law has to return it.
    Plastic,
}

impl Side {
    /// Name in the bench's identifier.
    pub fn name(self) -> &'static str {
        match self {
            Self::Elastic => "elastic",
            Self::Plastic => "plastic",
        }
    }
}

/// A law to bench.
#[derive(Clone, Debug)]
pub struct BenchLaw {
    /// Name in the bench's identifier.
    pub name: &'static str,
    /// The law.
    pub law: SharedLaw,
    /// The sides of its yield surface that there are.
    pub sides: &'static [Side],
}

/// Every law.
///
/// # Errors
/// Never for these parameters.
pub fn laws() -> Result<Vec<BenchLaw>, MaterialError> {
    let elasticity = Elasticity::new(YOUNG, 0.3)?;
    let (friction, dilation) = (25_f64.to_radians(), 5_f64.to_radians());
    let mohr_coulomb = MohrCoulomb::new(elasticity, STRENGTH, friction, dilation)?;
    let cut_off = mohr_coulomb.clone().with_tension_cutoff(0.5 * STRENGTH)?;
    let plastic = |name, law| BenchLaw {
        name,
        law,
        sides: &[Side::Elastic, Side::Plastic],
    };
    Ok(vec![
        BenchLaw {
            name: "hencky-elastic",
            law: Arc::new(HenckyElastic::new(elasticity)),
            sides: &[Side::Elastic],
        },
        plastic(
            "von-mises",
            Arc::new(VonMises::from_undrained_strength(elasticity, STRENGTH)?),
        ),
        plastic("tresca", Arc::new(Tresca::new(elasticity, STRENGTH)?)),
        plastic("mohr-coulomb", Arc::new(mohr_coulomb)),
        plastic("mohr-coulomb-cut-off", Arc::new(cut_off)),
    ])
}

/// Principal trial strains on one side of a law's yield surface, of random size and direction
/// around a moderate compression, so that planes, edges and the apex are all met.
///
/// Does not return for [`Side::Plastic`] of a law without a yield surface.
pub fn trial_strains(law: &SharedLaw, side: Side) -> Vec<Principal> {
    let mut random = Random::new(7);
    let yield_strain = STRENGTH / YOUNG;
    let mut strains = Vec::with_capacity(COUNT);
    while strains.len() < COUNT {
        let size = random.between(0.0, 4.0) * yield_strain;
        let strain = random
            .values::<3>(size)
            .map(|component| component - yield_strain);
        let tau = law.stiffness_bound().stress(&strain);
        let beyond = law.yield_function(&tau, &History::default()) > 0.0;
        if beyond == (side == Side::Plastic) {
            strains.push(strain);
        }
    }
    strains
}

/// The tensors in plane strain whose principal values are `values`, the first two turned by random
/// angles about z.
pub fn turned(values: &[Principal]) -> Vec<Tensor> {
    let mut random = Random::new(11);
    values
        .iter()
        .map(|&[first, second, third]| {
            let angle = random.between(0.0, std::f64::consts::PI);
            let (middle, radius) = (0.5 * (first + second), 0.5 * (first - second));
            let (sin, cos) = (2.0 * angle).sin_cos();
            [
                [middle + radius * cos, radius * sin, 0.0],
                [radius * sin, middle - radius * cos, 0.0],
                [0.0, 0.0, third],
            ]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_material::{PointContext, TangentKind, lift_finite, lift_small};

    #[test]
    fn states_are_on_their_side() {
        for BenchLaw { name, law, sides } in laws().unwrap() {
            for &side in sides {
                for strain in trial_strains(&law, side) {
                    let answer = law
                        .return_map(&strain, &History::default(), &PointContext::STATIC)
                        .unwrap();
                    let plastic = answer.regime.is_plastic();
                    assert_eq!(plastic, side == Side::Plastic, "{name}: {strain:?}");
                }
            }
        }
    }

    #[test]
    fn turned_states_keep_their_principal_values() {
        let (history, kind) = (History::default(), TangentKind::Consistent);
        for BenchLaw { name, law, sides } in laws().unwrap() {
            let strains = trial_strains(&law, sides[sides.len() - 1]);
            let stretches: Vec<Principal> = strains
                .iter()
                .map(|strain| strain.map(|value| (2.0 * value).exp()))
                .collect();
            let tensors = turned(&strains).into_iter().zip(turned(&stretches));
            for (strain, (small, finite)) in strains.iter().zip(tensors) {
                let expected = law
                    .return_map(strain, &history, &PointContext::STATIC)
                    .unwrap();
                let trace: f64 = expected.tau.iter().sum();
                let small = lift_small::<2>(&*law, &small, &history, kind).unwrap();
                let finite = lift_finite::<2>(&*law, &finite, &history, kind).unwrap();
                for tau in [small.tau, finite.tau] {
                    let found = tau[0][0] + tau[1][1] + tau[2][2];
                    assert!((found - trace).abs() < 1e-7 * STRENGTH, "{name}");
                }
            }
        }
    }
}
