//! Laws of soil whose strength and stiffness vary in space, as multiples of those of one law (theory, eqs. 19b and 19c).

use std::fmt::Debug;
use std::ops::Deref;
use std::sync::Arc;

use crate::spectral::principal::{Principal, Tensor};
use crate::{
    ConstitutiveModel, Dissipation, ElasticStiffness, Elasticity, History, INTERNAL_VARIABLES,
    InternalVariable, MaterialError, Nonlocal, NonlocalRates, PointContext, Remembered, ReturnMap,
    Scaling, ShearStrength, Strength,
};

/// Strength, friction and stiffness of a piece of soil over those of its material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratios {
    /// Every strength that is a stress (undrained strength, cohesion, yield stress, tension cut-off) over that of
    /// the material \[-\]. Positive; angles stay.
    pub strength: f64,
    /// tan φ over that of the material \[-\]. Not negative; ψ stays but never exceeds φ. Laws without friction know
    /// none.
    pub friction: f64,
    /// Young's modulus over that of the material \[-\]. Positive; Poisson's ratio stays.
    pub stiffness: f64,
}

impl Ratios {
    /// Soil that is as its material.
    pub const ONE: Self = Self {
        strength: 1.0,
        friction: 1.0,
        stiffness: 1.0,
    };

    /// Whether friction is not that of the material.
    #[inline]
    pub fn has_friction_of_its_own(&self) -> bool {
        self.friction.total_cmp(&1.0).is_ne()
    }

    /// Whether the soil is as its material.
    #[inline]
    pub fn are_one(&self) -> bool {
        *self == Self::ONE
    }
}

impl Default for Ratios {
    fn default() -> Self {
        Self::ONE
    }
}

/// A law with strength and stiffness that are multiples of those of another, without making that one anew.
///
/// With s the ratio of strength and e that of stiffness, the answer to a trial strain ε is that of the other law to
/// ε e/s, with stress times s, tangent times e and plastic strain times s/e: the answer of the law with those parameters.
///
/// ```
/// use igimp_material::{
///     ConstitutiveModel, Elasticity, History, PointContext, Ratios, ScaledLaw, Tresca,
/// };
///
/// let tresca = Tresca::new(Elasticity::new(100.0, 0.3)?, 1.0)?;
/// let law: &dyn ConstitutiveModel = &tresca;
/// let scaled = ScaledLaw::new(law, Ratios { strength: 3.0, stiffness: 2.0, ..Ratios::ONE })?;
/// let answer = scaled.return_map(&[0.1, 0.0, -0.1], &History::default(), &PointContext::STATIC)?;
/// assert!((answer.tau[0] - answer.tau[2] - 6.0).abs() < 1e-12);
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ScaledLaw<L> {
    law: L,
    elasticity: Elasticity,
    ratios: Ratios,
}

impl<L: Deref<Target = dyn ConstitutiveModel>> ScaledLaw<L> {
    /// The `law` at these ratios; that of friction is not asked for, and belongs to the law
    /// ([`Strength::at_friction`]).
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless both are positive and finite.
    pub fn new(law: L, ratios: Ratios) -> Result<Self, MaterialError> {
        crate::error::positive("strength ratio", ratios.strength)?;
        Ok(Self {
            elasticity: law.stiffness_bound().scaled(ratios.stiffness)?,
            law,
            ratios,
        })
    }

    /// The stress of the other law that answers to one of this.
    fn unscaled(&self, tau: &Principal) -> Principal {
        tau.map(|component| component / self.ratios.strength)
    }

    /// Strain of the other law over that of this one, e/s.
    fn strain_ratio(&self) -> f64 {
        self.ratios.stiffness / self.ratios.strength
    }

    /// The history that the other law is given.
    fn unscaled_history(&self, history: History) -> History {
        History {
            eps_p_eq: history.eps_p_eq * self.strain_ratio(),
            internal: self.scaled_internal(history.internal, |value, scale| value / scale),
        }
    }

    /// The answer of the other law as one of this, to soil with a `history`.
    fn scaled_answer(&self, answer: &ReturnMap, history: &History) -> ReturnMap {
        let ratio = self.strain_ratio();
        let Ratios {
            strength,
            stiffness,
            ..
        } = self.ratios;
        let delta_eps_p = answer.delta_eps_p.map(|strain| strain / ratio);
        let nonlocal = answer.nonlocal;
        ReturnMap {
            tau: answer.tau.map(|component| component * strength),
            tangent: answer
                .tangent
                .map(|row| row.map(|modulus| modulus * stiffness)),
            delta_eps_p,
            history: History {
                internal: self
                    .scaled_internal(answer.history.internal, |value, scale| value * scale),
                ..history.after(&delta_eps_p)
            },
            regime: answer.regime,
            nonlocal: NonlocalRates {
                plastic_by_strain: nonlocal.plastic_by_strain.map(|rate| rate * ratio),
                stress_by_nonlocal: (nonlocal.stress_by_nonlocal).map(|rate| rate * strength),
                ..nonlocal
            },
        }
    }

    /// Internal variables with each put to its own scale.
    fn scaled_internal(
        &self,
        mut internal: [f64; INTERNAL_VARIABLES],
        put: impl Fn(f64, f64) -> f64,
    ) -> [f64; INTERNAL_VARIABLES] {
        for (value, variable) in internal.iter_mut().zip(self.law.internal_variables()) {
            match variable.scaling {
                Scaling::Constant => {}
                Scaling::Stress => *value = put(*value, self.ratios.strength),
                Scaling::Strain => *value = put(*value, 1.0 / self.strain_ratio()),
            }
        }
        internal
    }
}

impl<L> ConstitutiveModel for ScaledLaw<L>
where
    L: Deref<Target = dyn ConstitutiveModel> + Send + Sync + Debug,
{
    fn name(&self) -> &'static str {
        self.law.name()
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    fn has_linear_elasticity(&self) -> bool {
        self.law.has_linear_elasticity()
    }

    fn elasticity_follows_history(&self) -> bool {
        self.law.elasticity_follows_history()
    }

    fn elastic_stress(&self, eps_e: &Principal, history: &History) -> Principal {
        if self.has_linear_elasticity() {
            return self.elasticity.stress(eps_e);
        }
        let strain = eps_e.map(|strain| strain * self.strain_ratio());
        let history = self.unscaled_history(*history);
        let tau = self.law.elastic_stress(&strain, &history);
        tau.map(|component| component * self.ratios.strength)
    }

    fn elastic_strain(
        &self,
        tau: &Principal,
        history: &History,
    ) -> Result<Principal, MaterialError> {
        if self.has_linear_elasticity() {
            return Ok(self.elasticity.strain(tau));
        }
        let history = self.unscaled_history(*history);
        let strain = self.law.elastic_strain(&self.unscaled(tau), &history)?;
        Ok(strain.map(|strain| strain / self.strain_ratio()))
    }

    fn elastic_stiffness(&self, eps_e: &Principal, history: &History) -> ElasticStiffness {
        if self.has_linear_elasticity() {
            return ElasticStiffness {
                tangent: self.elasticity.tangent(),
                shear: self.elasticity.shear(),
            };
        }
        let strain = eps_e.map(|strain| strain * self.strain_ratio());
        let history = self.unscaled_history(*history);
        let of_law = self.law.elastic_stiffness(&strain, &history);
        let scaled = |modulus| modulus * self.ratios.stiffness;
        ElasticStiffness {
            tangent: of_law.tangent.map(|row| row.map(scaled)),
            shear: scaled(of_law.shear),
        }
    }

    /// The other law has its strains over a time that is as many times longer, so that rates are those of the soil. The
    /// context holds the multiple.
    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let ratio = self.strain_ratio();
        let trial = eps_e_trial.map(|strain| strain * ratio);
        let unscaled = self.unscaled_history(*history);
        let context = PointContext {
            duration: context.duration * ratio,
            strain_ratio: context.strain_ratio * ratio,
            ..*context
        };
        let answer = self.law.return_map(&trial, &unscaled, &context)?;
        Ok(self.scaled_answer(&answer, history))
    }

    /// That of the other law: lengths do not go with the ratios.
    fn nonlocal(&self) -> Option<Nonlocal> {
        self.law.nonlocal()
    }

    fn internal_variables(&self) -> &'static [InternalVariable] {
        self.law.internal_variables()
    }

    /// That of the other law: no angle goes with the ratios.
    fn directed(
        &self,
        history: History,
        tau: &Principal,
        frame: &Tensor,
        looked_at: (usize, usize),
    ) -> History {
        self.law
            .directed(history, &self.unscaled(tau), frame, looked_at)
    }

    fn initial_history(&self, sigma: &Principal) -> History {
        let history = self.law.initial_history(&self.unscaled(sigma));
        History {
            eps_p_eq: history.eps_p_eq / self.strain_ratio(),
            internal: self.scaled_internal(history.internal, |value, scale| value * scale),
        }
    }

    /// That of the other law: a memory is that of the piece of soil, whatever the ratios.
    fn remembering(&self, begun: History, before: &Remembered<'_>) -> History {
        self.law.remembering(begun, before)
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.law.has_symmetric_tangent()
    }

    fn dilatancy(&self) -> f64 {
        self.law.dilatancy()
    }
}

impl<L> Strength for ScaledLaw<L>
where
    L: Deref<Target = dyn ConstitutiveModel> + Send + Sync + Debug,
{
    fn yield_function(&self, tau: &Principal, history: &History) -> f64 {
        let history = self.unscaled_history(*history);
        self.ratios.strength * self.law.yield_function(&self.unscaled(tau), &history)
    }

    fn stress_scale(&self, tau: &Principal) -> f64 {
        self.ratios.strength * self.law.stress_scale(&self.unscaled(tau))
    }

    fn utilisation(&self, tau: &Principal, history: &History) -> f64 {
        let history = self.unscaled_history(*history);
        self.law.utilisation(&self.unscaled(tau), &history)
    }

    fn shear_strength(&self) -> Option<ShearStrength> {
        let strength = self.law.shear_strength()?;
        Some(ShearStrength {
            cohesive: self.ratios.strength * strength.cohesive,
            ..strength
        })
    }

    fn shear_strength_at(&self, history: &History) -> Option<ShearStrength> {
        let strength = (self.law).shear_strength_at(&self.unscaled_history(*history))?;
        Some(ShearStrength {
            cohesive: self.ratios.strength * strength.cohesive,
            ..strength
        })
    }

    fn dissipation(&self, rate: &Principal) -> Option<Dissipation> {
        let dissipation = self.law.dissipation(rate)?;
        Some(Dissipation {
            power: self.ratios.strength * dissipation.power,
            ..dissipation
        })
    }

    fn yields(&self) -> bool {
        self.law.yields()
    }

    fn at_friction(&self, ratio: f64) -> Result<Option<Arc<dyn ConstitutiveModel>>, MaterialError> {
        let Some(law) = self.law.at_friction(ratio)? else {
            return Ok(None);
        };
        Ok(Some(Arc::new(ScaledLaw {
            law,
            elasticity: self.elasticity,
            ratios: self.ratios,
        })))
    }

    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        Ok(Arc::new(ScaledLaw {
            law: self.law.reduced(srf)?,
            elasticity: self.elasticity,
            ratios: self.ratios,
        }))
    }
}
