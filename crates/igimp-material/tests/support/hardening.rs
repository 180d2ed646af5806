//! A law with memory and two parameters, for tests of the seam: von Mises with linear isotropic hardening.
//!
//! ORACLE: the return is closed: Δκ = (q_tr − σ_y)/(3G + H), with q = √(3/2)‖s‖ and σ_y = σ_0 + H κ.

use std::sync::Arc;

use igimp_material::{
    ConstitutiveModel, Elasticity, History, InternalVariable, MaterialError, NonlocalRates,
    PointContext, Principal, Regime, ReturnMap, Scaling, Strength,
};

/// von Mises with a yield stress that grows from `yield_stress` by `modulus` times the plastic strain.
#[derive(Clone, Debug)]
pub(crate) struct Hardening {
    pub(crate) elasticity: Elasticity,
    /// σ_0 \[stress\].
    pub(crate) yield_stress: f64,
    /// H \[stress\].
    pub(crate) modulus: f64,
    /// Divisor of both, and of the yield stress that is remembered \[-\].
    pub(crate) srf: f64,
}

/// The variables: plastic strain κ, and the yield stress that it led to.
pub(crate) const VARIABLES: [InternalVariable; 2] = [
    InternalVariable {
        name: "hardening strain",
        unit: "-",
        scaling: Scaling::Strain,
        follows_stress: false,
    },
    InternalVariable {
        name: "yield stress",
        unit: "Pa",
        scaling: Scaling::Stress,
        follows_stress: false,
    },
];

fn deviator(tau: &Principal) -> (Principal, f64) {
    let mean = (tau[0] + tau[1] + tau[2]) / 3.0;
    let s = tau.map(|stress| stress - mean);
    let q = (1.5 * s.iter().map(|s| s * s).sum::<f64>()).sqrt();
    (s, q)
}

impl ConstitutiveModel for Hardening {
    fn name(&self) -> &'static str {
        "hardening"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    fn internal_variables(&self) -> &'static [InternalVariable] {
        &VARIABLES
    }

    fn initial_history(&self, _: &Principal) -> History {
        let mut history = History::default();
        history.internal[1] = self.yield_stress;
        history
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        _: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let tau = self.elasticity.stress(eps_e_trial);
        let (s, q) = deviator(&tau);
        let over = q - history.internal[1] / self.srf;
        let tangent = self.elasticity.tangent();
        if over <= 0.0 {
            return Ok(ReturnMap {
                tau,
                tangent,
                delta_eps_p: [0.0; 3],
                history: *history,
                regime: Regime::Elastic,
                nonlocal: NonlocalRates::NONE,
            });
        }
        let shear = self.elasticity.shear();
        let hardened = 3.0 * shear + self.modulus / self.srf;
        let kappa = over / hardened;
        let n = s.map(|s| s / q);
        let delta_eps_p = n.map(|n| 1.5 * kappa * n);
        let mut after = history.after(&delta_eps_p);
        after.internal[0] += kappa;
        after.internal[1] = self.yield_stress + self.modulus * after.internal[0];
        let (turn, along) = (6.0 * shear * shear * kappa / q, 9.0 * shear * shear);
        let radial = along * (kappa / q - 1.0 / hardened);
        let returned = std::array::from_fn(|a| tau[a] - 3.0 * shear * kappa * n[a]);
        Ok(ReturnMap {
            tau: returned,
            tangent: std::array::from_fn(|a| {
                std::array::from_fn(|b| {
                    let projector = f64::from(u8::from(a == b)) - 1.0 / 3.0;
                    tangent[a][b] - turn * projector + radial * n[a] * n[b]
                })
            }),
            delta_eps_p,
            history: after,
            regime: Regime::Smooth,
            nonlocal: NonlocalRates::NONE,
        })
    }

    fn has_symmetric_tangent(&self) -> bool {
        true
    }
}

impl Strength for Hardening {
    fn yield_function(&self, tau: &Principal, history: &History) -> f64 {
        deviator(tau).1 - history.internal[1] / self.srf
    }

    fn stress_scale(&self, tau: &Principal) -> f64 {
        deviator(tau).1.max(self.yield_stress / self.srf)
    }

    fn utilisation(&self, tau: &Principal, history: &History) -> f64 {
        deviator(tau).1 * self.srf / history.internal[1]
    }

    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        Ok(Arc::new(Self {
            srf: self.srf * srf,
            ..self.clone()
        }))
    }
}
