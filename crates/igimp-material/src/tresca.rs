//! Tresca plasticity: the largest shear stress is bounded by the undrained strength (theory, eq. 21
//! without friction).

use std::sync::Arc;

use crate::error::positive;
use crate::pyramid::{PlaneStrength, Pyramid};
use crate::{
    ConstitutiveModel, Elasticity, History, MaterialError, PointContext, Principal, ReturnMap,
    ShearStrength, Strength,
};

/// Elastic and perfectly plastic with associated flow and the yield function
/// $`f = \sigma_1 - \sigma_3 - 2 c_u`$, $`\sigma_1 \ge \sigma_2 \ge \sigma_3`$.
///
/// The same code as [`MohrCoulomb`](crate::MohrCoulomb) without friction: equal to the last bit.
#[derive(Debug, Clone, PartialEq)]
pub struct Tresca {
    undrained_strength: f64,
    pyramid: Pyramid,
}

impl Tresca {
    /// From the undrained shear strength $`c_u`$ \[stress\].
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless `undrained_strength` is positive and finite.
    pub fn new(elasticity: Elasticity, undrained_strength: f64) -> Result<Self, MaterialError> {
        positive("undrained_strength", undrained_strength)?;
        let strength = PlaneStrength {
            sin_friction: 0.0,
            sin_dilation: 0.0,
            shear: 2.0 * undrained_strength,
            apex: f64::INFINITY,
            tension_cutoff: None,
        };
        Ok(Self {
            undrained_strength,
            pyramid: Pyramid::new(elasticity, &strength),
        })
    }

    /// Undrained shear strength $`c_u`$ \[stress\].
    pub fn undrained_strength(&self) -> f64 {
        self.undrained_strength
    }
}

impl ConstitutiveModel for Tresca {
    fn name(&self) -> &'static str {
        "Tresca"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        self.pyramid.stiffness_bound()
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        _: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        self.pyramid.return_map(eps_e_trial, *history)
    }

    fn has_symmetric_tangent(&self) -> bool {
        true
    }
}

impl Strength for Tresca {
    /// $`f = \sigma_1 - \sigma_3 - 2 c_u`$: twice the distance in shear stress.
    fn yield_function(&self, tau: &Principal, _history: &History) -> f64 {
        self.pyramid.yield_function(tau)
    }

    /// $`2 c_u`$ plus twice the largest principal stress in magnitude.
    fn stress_scale(&self, tau: &Principal) -> f64 {
        self.pyramid.stress_scale(tau)
    }

    /// $`(\sigma_1 - \sigma_3) / (2 c_u)`$.
    fn utilisation(&self, tau: &Principal, _history: &History) -> f64 {
        self.pyramid.utilisation(tau)
    }

    fn shear_strength(&self) -> Option<ShearStrength> {
        Some(ShearStrength {
            cohesive: self.undrained_strength,
            friction_angle: 0.0,
        })
    }

    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        let undrained_strength = self.undrained_strength / srf;
        Ok(Arc::new(Self::new(
            *self.stiffness_bound(),
            undrained_strength,
        )?))
    }
}
