//! The seam between laws and everything else: a pure function from trial strain to stress.
//!
//! The problem that every law solves is eq. 19a of the theory. A law lives in principal space, knows no rotation and no grid, and
//! changes nothing: the same input gives the same output. [`PointContext`] holds the data of its step.
//! [`lift_finite`](crate::lift_finite) and [`lift_small`](crate::lift_small) carry it to tensors.

mod answer;
mod history;
mod strength;

use std::fmt::Debug;

pub use answer::{Nonlocal, NonlocalRates, PointContext, Regime, ReturnMap};
pub use history::{History, INTERNAL_VARIABLES, InternalVariable, Remembered, Scaling};
pub use strength::{Dissipation, ShearStrength, Strength};
pub(crate) use strength::{ON_SURFACE, mobilised};

use crate::spectral::principal::{Principal, Tensor};
use crate::{Elasticity, MaterialError};

/// The elastic stiffness of a law in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticStiffness {
    /// $`\partial\tau_a/\partial\varepsilon_b`$ \[stress\].
    pub tangent: [[f64; 3]; 3],
    /// Shear modulus G \[stress\].
    pub shear: f64,
}

impl ElasticStiffness {
    /// Bulk modulus K \[stress\]: growth of the mean stress with volume, shear being kept.
    pub fn bulk(&self) -> f64 {
        let sum: f64 = self.tangent.as_flattened().iter().sum();
        sum / 9.0
    }

    /// Young's modulus of K and G, 9 K G/(3 K + G) \[stress\].
    pub fn young(&self) -> f64 {
        let (bulk, shear) = (self.bulk(), self.shear);
        9.0 * bulk * shear / (3.0 * bulk + shear)
    }
}

/// A constitutive law in principal space: isotropic, elastic within a yield surface.
pub trait ConstitutiveModel: Strength + Send + Sync + Debug {
    /// Name of the law, for messages and tables.
    fn name(&self) -> &'static str;

    /// A linear Hencky elasticity that is no softer than the law in any state: its elasticity itself where that is linear.
    fn stiffness_bound(&self) -> &Elasticity;

    /// Whether [`stiffness_bound`](Self::stiffness_bound) is the elasticity of the law. Another one states its
    /// [`elastic_stress`](Self::elastic_stress), [`elastic_strain`](Self::elastic_strain) and
    /// [`elastic_stiffness`](Self::elastic_stiffness).
    fn has_linear_elasticity(&self) -> bool {
        true
    }

    /// Whether the elastic strain of a stress goes with the history, as where stiffness is that of the last step's stress: it is
    /// then found anew after every step, also where nothing yielded.
    fn elasticity_follows_history(&self) -> bool {
        false
    }

    /// The stress τ \[stress\] of an elastic strain \[-\], principal values.
    fn elastic_stress(&self, eps_e: &Principal, history: &History) -> Principal {
        let _ = history;
        self.stiffness_bound().stress(eps_e)
    }

    /// The elastic strain \[-\] of a stress τ \[stress\], principal values.
    ///
    /// # Errors
    /// [`MaterialError::NotConverged`] of a law that has to search for it.
    fn elastic_strain(
        &self,
        tau: &Principal,
        history: &History,
    ) -> Result<Principal, MaterialError> {
        let _ = history;
        Ok(self.stiffness_bound().strain(tau))
    }

    /// The elastic stiffness at an elastic strain \[-\].
    fn elastic_stiffness(&self, eps_e: &Principal, history: &History) -> ElasticStiffness {
        let _ = (eps_e, history);
        let elasticity = self.stiffness_bound();
        ElasticStiffness {
            tangent: elasticity.tangent(),
            shear: elasticity.shear(),
        }
    }

    /// Returns the trial state with principal elastic strain `eps_e_trial` to the yield surface,
    /// by one backward Euler step, at a point and in a step as `context` says.
    ///
    /// Principal values come in any order and are answered in the same order.
    ///
    /// # Errors
    /// [`MaterialError::NonFinite`] if the strain or its stress is not finite, [`MaterialError::NotConverged`] of a law
    /// whose return is found by iteration: the correction is then shortened.
    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError>;

    /// The way to ask for many points at once, of a law with a high overhead per call.
    fn batches(&self) -> Option<&dyn Batches> {
        None
    }

    /// How strength sees plastic strain beside its own point; none of a law whose strength is that of a point.
    fn nonlocal(&self) -> Option<Nonlocal> {
        None
    }

    /// The history with the direction that a stress `tau` with principal axes `frame`, in rows, leaves for the next step, for a law
    /// whose strength goes by direction; that of other laws stays. The first of `axes` are looked at, and `vertical` is the
    /// component of an axis that points upwards.
    fn directed(
        &self,
        history: History,
        tau: &Principal,
        frame: &Tensor,
        (axes, vertical): (usize, usize),
    ) -> History {
        let _ = (tau, frame, axes, vertical);
        history
    }

    /// Its internal variables, at most [`INTERNAL_VARIABLES`] of them; none for a law without hardening.
    fn internal_variables(&self) -> &'static [InternalVariable] {
        &[]
    }

    /// The history of soil that was never sheared and is under the principal stress `sigma` \[stress\], tension positive.
    fn initial_history(&self, sigma: &Principal) -> History {
        let _ = sigma;
        History::default()
    }

    /// The history of soil that was of another law, `begun` being the [`initial_history`](Self::initial_history) of its stress:
    /// memories of the same name are as they were.
    fn remembering(&self, begun: History, before: &Remembered<'_>) -> History {
        begun.remembering(self.internal_variables(), before)
    }

    /// Whether consistent tangents are symmetric, which is so when the flow is associated.
    fn has_symmetric_tangent(&self) -> bool;

    /// How near plastic flow is to associated flow, r of the law as it is given \[-\]: 1 where flow is associated, 0
    /// where it keeps volume in spite of friction. The law at reduced strength has that of the
    /// law it was made of. Locking control goes by it (theory, eq. 8c).
    ///
    /// The symmetry of its tangent shows the flow of a law without ψ.
    fn dilatancy(&self) -> f64 {
        if self.has_symmetric_tangent() {
            1.0
        } else {
            0.0
        }
    }
}

/// Soil with less friction is taken for nearly associated, the nearer the less it has: without friction its flow is associated,
/// whatever ψ. A choice: the slopes for which β was chosen have more (docs/src/comparisons.md) \[radians\].
const LITTLE_FRICTION: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// How near flow of ψ at φ is to associated flow, $`\sqrt r = 1 - (1 - \sqrt{\psi/\varphi}) \min(1, \varphi/10°)`$: r is ψ/φ where friction is
/// not little, and continuous in φ down to none (theory, eq. 8c) \[-\].
pub(crate) fn dilatancy(dilation_angle: f64, friction_angle: f64) -> f64 {
    if friction_angle >= LITTLE_FRICTION {
        return dilation_angle / friction_angle;
    }
    if friction_angle <= 0.0 {
        return 1.0;
    }
    let short = 1.0 - (dilation_angle / friction_angle).sqrt();
    (1.0 - short * friction_angle / LITTLE_FRICTION).powi(2)
}

/// A law that answers many points at once.
pub trait Batches {
    /// Answers many trial states, each as [`return_map`](ConstitutiveModel::return_map) does in the same context; there is a
    /// history for each.
    ///
    /// # Errors
    /// As [`return_map`](ConstitutiveModel::return_map), of any of the states.
    fn return_maps(
        &self,
        eps_e_trial: &[Principal],
        histories: &[History],
        context: &PointContext,
    ) -> Result<Vec<ReturnMap>, MaterialError>;
}

/// The elastic stress of a trial strain.
pub(crate) fn trial_stress(
    elasticity: &Elasticity,
    eps_e_trial: &Principal,
) -> Result<Principal, MaterialError> {
    let tau = elasticity.stress(eps_e_trial);
    if tau.iter().all(|component| component.is_finite()) {
        Ok(tau)
    } else {
        Err(MaterialError::NonFinite {
            quantity: "trial stress",
        })
    }
}
