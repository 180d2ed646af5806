//! Von Mises plasticity without hardening: a cylinder around the hydrostatic axis.
//!
//! Radial return and its consistent tangent: theory, eq. 20; de Souza Neto, Perić & Owen (2008), section 7.3.

use std::sync::Arc;

use crate::error::positive;
use crate::law::{ON_SURFACE, mobilised, trial_stress};
use crate::spectral::principal::{deviator, deviator_norm, largest, mean};
use crate::{
    ConstitutiveModel, Dissipation, Elasticity, History, MaterialError, NonlocalRates,
    PointContext, Principal, Regime, ReturnMap, ShearStrength, Strength,
};

/// Elastic and perfectly plastic with associated flow and the yield function
/// $`f = q - q_y,\ q = \sqrt{3/2}\,\lVert s\rVert`$.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VonMises {
    elasticity: Elasticity,
    yield_stress: f64,
}

impl VonMises {
    /// From the uniaxial yield stress $`q_y`$ \[stress\].
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless `yield_stress` is positive and finite.
    pub fn from_yield_stress(
        elasticity: Elasticity,
        yield_stress: f64,
    ) -> Result<Self, MaterialError> {
        positive("yield_stress", yield_stress)?;
        Ok(Self {
            elasticity,
            yield_stress,
        })
    }

    /// From the undrained shear strength $`c_u`$ \[stress\] in plane strain:
    /// $`q_y = \sqrt3\,c_u`$, so that plastic plane flow has the in-plane shear stress
    /// $`c_u`$.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless `undrained_strength` is positive and finite.
    pub fn from_undrained_strength(
        elasticity: Elasticity,
        undrained_strength: f64,
    ) -> Result<Self, MaterialError> {
        positive("undrained_strength", undrained_strength)?;
        Self::from_yield_stress(elasticity, 3.0_f64.sqrt() * undrained_strength)
    }

    /// Uniaxial yield stress $`q_y`$ \[stress\].
    pub fn yield_stress(&self) -> f64 {
        self.yield_stress
    }
}

impl ConstitutiveModel for VonMises {
    fn name(&self) -> &'static str {
        "von Mises"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    /// Shrinks the deviator of the trial stress by $`\beta = q_y/q`$; the tangent is
    /// $`K\,1\otimes1 + 2G\beta\,(I_{dev} - n\otimes n)`$ with n the direction of the
    /// deviator.
    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        _: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let trial = trial_stress(&self.elasticity, eps_e_trial)?;
        // From strain, where a large mean stress costs no digits.
        let s = deviator(eps_e_trial).map(|component| 2.0 * self.elasticity.shear() * component);
        let q = deviator_norm(&s);
        if q - self.yield_stress <= ON_SURFACE * self.stress_scale(&trial) {
            return Ok(ReturnMap::elastic(&self.elasticity, trial, *history));
        }
        let beta = self.yield_stress / q;
        let mean_stress = mean(&trial);
        let n = s.map(|component| component * (1.5_f64.sqrt() / q));
        let softened = 2.0 * self.elasticity.shear() * beta;
        let mut tangent = [[self.elasticity.bulk() - softened / 3.0; 3]; 3];
        for a in 0..3 {
            tangent[a][a] += softened;
            for b in 0..3 {
                tangent[a][b] -= softened * n[a] * n[b];
            }
        }
        let delta_eps_p =
            s.map(|component| (1.0 - beta) * component / (2.0 * self.elasticity.shear()));
        Ok(ReturnMap {
            tau: s.map(|component| mean_stress + beta * component),
            tangent,
            delta_eps_p,
            history: history.after(&delta_eps_p),
            regime: Regime::Smooth,
            nonlocal: NonlocalRates::NONE,
        })
    }

    fn has_symmetric_tangent(&self) -> bool {
        true
    }
}

impl Strength for VonMises {
    /// $`f = q - q_y`$: the distance to yield in uniaxial stress.
    fn yield_function(&self, tau: &Principal, _history: &History) -> f64 {
        deviator_norm(&deviator(tau)) - self.yield_stress
    }

    /// $`q_y`$ plus the largest principal stress in magnitude.
    fn stress_scale(&self, tau: &Principal) -> f64 {
        self.yield_stress + largest(tau)
    }

    /// $`q / q_y`$.
    fn utilisation(&self, tau: &Principal, _history: &History) -> f64 {
        let q = deviator_norm(&deviator(tau));
        mobilised(q, self.yield_stress, self.stress_scale(tau))
    }

    fn shear_strength(&self) -> Option<ShearStrength> {
        Some(ShearStrength {
            cohesive: self.yield_stress / 3.0_f64.sqrt(),
            friction_angle: 0.0,
        })
    }

    /// $`\sqrt{2/3}\, q_y\, |\mathrm{dev}\, \dot\varepsilon|`$, without a change of volume.
    fn dissipation(&self, rate: &Principal) -> Option<Dissipation> {
        Some(Dissipation {
            power: self.yield_stress * deviator_norm(&deviator(rate)) / 1.5,
            dilation: 0.0,
        })
    }

    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        let yield_stress = self.yield_stress / srf;
        Ok(Arc::new(Self::from_yield_stress(
            self.elasticity,
            yield_stress,
        )?))
    }
}
