//! Hencky elasticity without a yield surface.

use std::sync::Arc;

use crate::error::positive;
use crate::law::trial_stress;
use crate::{
    ConstitutiveModel, Elasticity, History, MaterialError, PointContext, Principal, ReturnMap,
    Strength,
};

/// The elastic law: every stress is admissible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HenckyElastic {
    elasticity: Elasticity,
}

impl HenckyElastic {
    /// From the elastic constants.
    pub fn new(elasticity: Elasticity) -> Self {
        Self { elasticity }
    }
}

impl ConstitutiveModel for HenckyElastic {
    fn name(&self) -> &'static str {
        "Hencky elastic"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        _: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let tau = trial_stress(&self.elasticity, eps_e_trial)?;
        Ok(ReturnMap::elastic(&self.elasticity, tau, *history))
    }

    fn has_symmetric_tangent(&self) -> bool {
        true
    }
}

impl Strength for HenckyElastic {
    /// Always `-∞`.
    fn yield_function(&self, _tau: &Principal, _history: &History) -> f64 {
        f64::NEG_INFINITY
    }

    /// Young's modulus.
    fn stress_scale(&self, _tau: &Principal) -> f64 {
        self.elasticity.young()
    }

    /// Always 0.
    fn utilisation(&self, _tau: &Principal, _history: &History) -> f64 {
        0.0
    }

    fn yields(&self) -> bool {
        false
    }

    /// The law itself: there is no strength to reduce.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        Ok(Arc::new(*self))
    }
}
