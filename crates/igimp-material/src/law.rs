//! The seam between laws and everything else: a pure function from trial strain to stress.
//!
//! The problem that every law solves is eq. 19a of the theory. A law lives in principal space, knows no rotation, no grid and no step, and changes nothing:
//! the same input gives the same output. [`lift_finite`](crate::lift_finite) and
//! [`lift_small`](crate::lift_small) carry it to tensors.

use std::fmt::Debug;
use std::sync::Arc;

use crate::spectral::principal::{Principal, Tensor, deviator, dot};
use crate::{Elasticity, MaterialError};

/// Most internal variables of a law.
pub const INTERNAL_VARIABLES: usize = 4;

/// The internal variables of a law.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct History {
    /// Accumulated plastic strain invariant $`\sum\sqrt{\tfrac23\,\Delta e_p:\Delta e_p}`$,
    /// with $`\Delta e_p`$ the deviatoric part of a step's plastic strain \[-\]. Never negative. Every law keeps it, for
    /// the record.
    pub eps_p_eq: f64,
    /// Internal variables of the law, in the order of [`ConstitutiveModel::internal_variables`]; zero beyond.
    pub internal: [f64; INTERNAL_VARIABLES],
}

impl History {
    /// The history of soil with this plastic strain \[-\], and internal variables of zero.
    pub const fn of_plastic_strain(eps_p_eq: f64) -> Self {
        Self {
            eps_p_eq,
            internal: [0.0; INTERNAL_VARIABLES],
        }
    }

    /// The history after a further plastic strain increment; internal variables stay.
    #[must_use]
    pub fn after(&self, delta_eps_p: &Principal) -> Self {
        let deviatoric = deviator(delta_eps_p);
        Self {
            eps_p_eq: self.eps_p_eq + (2.0 / 3.0 * dot(&deviatoric, &deviatoric)).sqrt(),
            internal: self.internal,
        }
    }
}

/// An internal variable of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InternalVariable {
    /// Name, as results print it.
    pub name: &'static str,
    /// Unit, as results print it.
    pub unit: &'static str,
    /// How it goes with the ratios of soil that varies in space.
    pub scaling: Scaling,
}

/// How a number of a law goes with the ratios of strength s and of stiffness e of a piece of soil ([`Ratios`](crate::Ratios)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scaling {
    /// Not at all: an angle, a void ratio.
    Constant,
    /// With s: a stress, such as a preconsolidation pressure.
    Stress,
    /// With s/e: a strain.
    Strain,
}

/// The part of the yield surface that a stress was returned to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Regime {
    /// Inside the yield surface, or on it to within round-off: nothing was returned.
    Elastic,
    /// The smooth part: the von Mises cylinder, the Drucker–Prager cone, or the main plane of Tresca and Mohr–Coulomb.
    Smooth,
    /// The edge where the two larger principal stresses are equal.
    RightEdge,
    /// The edge where the two smaller principal stresses are equal.
    LeftEdge,
    /// The apex of the Mohr–Coulomb pyramid or the Drucker–Prager cone.
    Apex,
    /// The plane of the tension cut-off, largest principal stress = $`\sigma_t`$.
    Tension,
    /// The edge between the Mohr–Coulomb plane and the plane of the tension cut-off.
    TensionShear,
    /// The edge where the two larger principal stresses are $`\sigma_t`$.
    TensionEdge,
    /// An end of the edge between Mohr–Coulomb and cut-off, where two stresses are equal.
    TensionCorner,
    /// All three principal stresses are $`\sigma_t`$.
    TensionApex,
    /// The cap of soil that hardens in compression.
    Cap,
    /// The cap and the surface of shear together.
    CapShear,
}

impl Regime {
    /// Every regime at the place of its code.
    const BY_CODE: [Self; 12] = [
        Self::Elastic,
        Self::Smooth,
        Self::RightEdge,
        Self::LeftEdge,
        Self::Apex,
        Self::Tension,
        Self::TensionShear,
        Self::TensionEdge,
        Self::TensionCorner,
        Self::TensionApex,
        Self::Cap,
        Self::CapShear,
    ];

    /// The number of the regime, the same in every file and every version: 0 elastic, 1 smooth part, 2 right edge,
    /// 3 left edge, 4 apex, 5 tension plane, 6 tension–shear edge, 7 tension edge, 8 tension corner, 9 tension apex, 10 cap,
    /// 11 cap and shear.
    pub fn code(self) -> u8 {
        self as u8
    }

    /// The regime of a number, if there is one.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::BY_CODE.get(usize::from(code)).copied()
    }

    /// Whether there was plastic flow.
    pub fn is_plastic(self) -> bool {
        self != Self::Elastic
    }
}

/// Shear strength at zero pressure, and its growth with pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShearStrength {
    /// Undrained strength c_u in plane strain, or cohesion c \[stress\].
    pub cohesive: f64,
    /// Angle of friction φ \[rad\].
    pub friction_angle: f64,
}

/// Dissipation of plastic flow by the normality rule at a rate of strain, per volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dissipation {
    /// Power of the cohesive strength \[stress\].
    pub power: f64,
    /// Rate of volume that such flow has \[-\]: 0 without friction, else sin φ times the sum of the magnitudes of the
    /// principal rates.
    pub dilation: f64,
}

/// The elastic stiffness of a law in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticStiffness {
    /// $`\partial\tau_a/\partial\varepsilon_b`$ \[stress\].
    pub tangent: [[f64; 3]; 3],
    /// Shear modulus G \[stress\].
    pub shear: f64,
}

/// The answer of a law to a trial strain, in the order of its principal values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReturnMap {
    /// Principal Kirchhoff stress τ \[stress\], tension positive, admissible.
    pub tau: Principal,
    /// Consistent tangent $`D_{ab} = \partial\tau_a/\partial\varepsilon_b^{tr}`$ \[stress\],
    /// taken within the regime.
    pub tangent: [[f64; 3]; 3],
    /// Plastic strain increment $`\Delta\varepsilon_p = C^{-1}(\tau^{tr} - \tau)`$ \[-\], extension positive.
    pub delta_eps_p: Principal,
    /// History at the end of the increment.
    pub history: History,
    /// Where on the yield surface the stress is.
    pub regime: Regime,
}

/// How the strength of a law sees plastic strain beside its own point: by the over-nonlocal measure
/// $`m \bar\kappa + (1 - m) \kappa`$ of an implicit gradient (theory, eqs. 110a and 110b).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nonlocal {
    /// Length l over which plastic strain is spread \[length\]. Positive.
    pub length: f64,
    /// Share m of the nonlocal strain \[-\]. Above 1 bands of shear have a width; with 1 they have none.
    pub over_nonlocal: f64,
}

/// What plastic strain and nonlocal strain are to each other at a point, at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct NonlocalRates {
    /// Plastic strain of the step Δκ \[-\].
    pub plastic: f64,
    /// Its derivative by the principal trial strains \[-\].
    pub plastic_by_strain: Principal,
    /// Its derivative by the nonlocal strain \[-\].
    pub plastic_by_nonlocal: f64,
    /// The derivative of the principal stresses τ by the nonlocal strain \[stress\].
    pub stress_by_nonlocal: Principal,
}

impl ReturnMap {
    /// A stress that needed no return.
    pub(crate) fn elastic(elasticity: &Elasticity, tau: Principal, history: History) -> Self {
        Self {
            tau,
            tangent: elasticity.tangent(),
            delta_eps_p: [0.0; 3],
            history,
            regime: Regime::Elastic,
        }
    }
}

/// A constitutive law in principal space: isotropic, elastic within a yield surface.
pub trait ConstitutiveModel: Send + Sync + Debug {
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
    /// by one backward Euler step.
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
    ) -> Result<ReturnMap, MaterialError>;

    /// The same in a step of a duration \[time\], zero in statics, for a law whose strength goes with the rate of strain; of other
    /// laws it is [`return_map`](Self::return_map).
    ///
    /// # Errors
    /// As [`return_map`](Self::return_map).
    fn return_map_over(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        duration: f64,
    ) -> Result<ReturnMap, MaterialError> {
        let _ = duration;
        self.return_map(eps_e_trial, history)
    }

    /// How strength sees plastic strain beside its own point; none of a law whose strength is that of a point.
    fn nonlocal(&self) -> Option<Nonlocal> {
        None
    }

    /// The same as [`return_map`](Self::return_map) in a step over which the nonlocal strain rises by `rise` \[-\], with what both
    /// strains are to each other; of a law whose strength is that of a point, nothing.
    ///
    /// # Errors
    /// As [`return_map`](Self::return_map).
    fn return_map_nonlocal(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        rise: f64,
    ) -> Result<(ReturnMap, NonlocalRates), MaterialError> {
        let _ = rise;
        Ok((
            self.return_map(eps_e_trial, history)?,
            NonlocalRates::default(),
        ))
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

    /// Whether [`return_maps`](Self::return_maps) serves better than many single calls: for laws with a high overhead
    /// per call.
    fn prefers_batches(&self) -> bool {
        false
    }

    /// Answers many trial states, each as [`return_map`](Self::return_map) does; there is a history for each.
    ///
    /// # Errors
    /// As [`return_map`](Self::return_map), of any of the states.
    fn return_maps(
        &self,
        eps_e_trial: &[Principal],
        histories: &[History],
    ) -> Result<Vec<ReturnMap>, MaterialError> {
        std::iter::zip(eps_e_trial, histories)
            .map(|(strain, history)| self.return_map(strain, history))
            .collect()
    }

    /// The yield function f(τ) \[stress\]: at most zero where τ is admissible; `-∞` for a law
    /// without a yield surface. Each law states how f is scaled.
    fn yield_function(&self, tau: &Principal, history: &History) -> f64;

    /// The stress that a relative tolerance on f refers to: the magnitudes that f is the
    /// difference of. A state with f ≤ 1e-12 `stress_scale` counts as on the surface.
    fn stress_scale(&self, tau: &Principal) -> f64;

    /// The share of the shear strength that τ mobilises \[-\]: 0 without shear stress and for a law
    /// without a yield surface, 1 on the surface of shear and at an apex, above 1 beyond it. A
    /// limit on tension plays no part. Each law states the ratio.
    fn utilisation(&self, tau: &Principal, history: &History) -> f64;

    /// The shear strength, for those who look at it; none for a law without a limit.
    fn shear_strength(&self) -> Option<ShearStrength> {
        None
    }

    /// Dissipation of plastic flow by the normality rule at the principal strain `rate` \[-\], whose own volume does
    /// not matter; none for a law without a limit. With a limit on tension it is no less than what the law
    /// dissipates.
    ///
    /// Of Coulomb's law, $`c \cos\varphi \sum_a |\dot\varepsilon_a|`$; a law with another surface has its own.
    fn dissipation(&self, rate: &Principal) -> Option<Dissipation> {
        let ShearStrength {
            cohesive,
            friction_angle,
        } = self.shear_strength()?;
        let size: f64 = rate.iter().map(|rate| rate.abs()).sum();
        Some(Dissipation {
            power: cohesive * friction_angle.cos() * size,
            dilation: friction_angle.sin() * size,
        })
    }

    /// Whether the law has a yield surface: locking of plastic flow concerns no other.
    fn yields(&self) -> bool {
        true
    }

    /// Whether consistent tangents are symmetric, which is so when the flow is associated.
    fn has_symmetric_tangent(&self) -> bool;

    /// How much plastic flow dilates, ψ/φ of the law as it is given \[-\]: 1 where flow is associated, 0
    /// where it keeps volume in spite of friction. The law at reduced strength has that of the law it was made
    /// of. Locking control goes by it (theory, eq. 8c).
    ///
    /// A law without ψ says by the symmetry of its tangent what its flow is.
    fn dilatancy(&self) -> f64 {
        if self.has_symmetric_tangent() {
            1.0
        } else {
            0.0
        }
    }

    /// The law with tan φ times a ratio \[-\]; none for a law without friction, which knows no other.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] for a negative ratio, one that is not finite, and one that leaves no strength.
    fn at_friction(&self, ratio: f64) -> Result<Option<Arc<dyn ConstitutiveModel>>, MaterialError> {
        let _ = ratio;
        Ok(None)
    }

    /// The law with its strength divided by the reduction factor `srf`: cohesion, undrained
    /// strength, yield stress, tension cut-off and tan φ. Elasticity stays; the dilation angle
    /// stays too but never exceeds the reduced friction angle. The history of a particle is not changed by a reduction: a
    /// law whose internal variables are stresses divides what it reads of them by `srf` itself.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless `srf` is positive and finite.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError>;
}

/// Share of [`ConstitutiveModel::stress_scale`] by which f may exceed zero on the surface.
pub(crate) const ON_SURFACE: f64 = 1e-12;

/// The ratio of an acting shear stress to its strength, 1 where they differ by no more than a state
/// on the surface may, and where there is no strength left.
pub(crate) fn mobilised(acting: f64, strength: f64, stress_scale: f64) -> f64 {
    let round_off = 2.0 * ON_SURFACE * stress_scale;
    if (acting - strength).abs() <= round_off || strength <= 0.0 {
        1.0
    } else {
        acting / strength
    }
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
