//! Hardening Soil: shear that hardens along a hyperbola up to Mohr–Coulomb's strength, a cap that hardens in compression, and
//! stiffness that grows with stress (Schanz, Vermeer & Bonnier 1999; theory, eqs. 126 to 128c).

mod both;
mod cap;
mod hyperbola;
mod parameters;
mod returned;
mod shear;

use std::sync::Arc;

use crate::elasticity::Moduli;
use crate::error::positive;
use crate::law::{dilatancy, mobilised};
use crate::spectral::principal::{descending, largest, sorted, unsorted};
use crate::{
    ConstitutiveModel, ElasticStiffness, Elasticity, History, InternalVariable, MaterialError,
    NonlocalRates, PointContext, Principal, Regime, ReturnMap, Scaling, ShearStrength, Strength,
};
use cap::Cap;
use hyperbola::Hyperbola;
pub use parameters::HardeningSoilParameters;
use returned::{Returned, Start};
use shear::Shear;

/// The internal variables.
const VARIABLES: [InternalVariable; 3] = [
    InternalVariable {
        name: "plastic shear strain",
        unit: "-",
        scaling: Scaling::Strain,
        follows_stress: false,
    },
    InternalVariable {
        name: "preconsolidation pressure",
        unit: "Pa",
        scaling: Scaling::Stress,
        follows_stress: false,
    },
    InternalVariable {
        name: "stiffness ratio",
        unit: "-",
        scaling: Scaling::Constant,
        follows_stress: true,
    },
];

/// Least stress that stiffness and preconsolidation are those of, over that at the reference \[-\].
const FLOOR: f64 = 0.01;

/// Hardening Soil in Kirchhoff stress and Hencky strain.
///
/// Compression is positive here. With $`s = \sigma_3 + c \cot\varphi`$ of the least compression, moduli grow with
/// $`(s/s_{ref})^m`$. In drained triaxial compression the axial strain of the deviator q is
///
/// ```math
/// \varepsilon_1 = \frac{q}{E_i\,(1 - q/q_a)},\qquad E_i = \frac{2 E_{50}}{2 - R_f},\qquad
/// q_a = \frac{1}{R_f}\,\frac{2 \sin\varphi}{1 - \sin\varphi}\, s
/// ```
///
/// until $`q_f = R_f q_a`$, Mohr–Coulomb's strength, where soil flows on. Beside it yields the cap
/// $`q^2/M^2 + p^2 = p_p^2`$; M and its hardening follow from $`E_{oed}`$ and $`K_0^{nc}`$.
///
/// Elasticity is linear within a step, with $`E_{ur}`$ of the stress at its start: it stores no energy over a closed cycle. All
/// else is implicit.
///
/// ```
/// use igimp_material::{
///     ConstitutiveModel, HardeningSoil, HardeningSoilParameters, PointContext,
/// };
///
/// let law = HardeningSoil::new(HardeningSoilParameters {
///     overconsolidation: 10.0,
///     ..HardeningSoilParameters::dense_hostun_sand()
/// })?;
/// let sigma = [-100e3; 3];
/// let history = law.initial_history(&sigma);
/// let strain = law.elastic_strain(&sigma, &history)?;
/// let trial = [strain[0] - 1e-3, strain[1], strain[2]];
/// let axial = law.return_map(&trial, &history, &PointContext::STATIC)?;
/// assert!(axial.regime.is_plastic() && axial.history.internal[0] > 0.0);
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardeningSoil {
    parameters: HardeningSoilParameters,
    hyperbola: Hyperbola,
    cap: Cap,
    /// The elasticity at the reference.
    reference: Elasticity,
    /// Whether hardening is over, as in a strength reduction: the yield surface is Mohr–Coulomb's.
    is_perfect: bool,
    /// r of eq. 8c as given \[-\].
    dilatancy: f64,
}

impl HardeningSoil {
    /// From its parameters.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] of a parameter out of its range, and of an oedometer modulus that no cap gives beside
    /// the other moduli.
    pub fn new(parameters: HardeningSoilParameters) -> Result<Self, MaterialError> {
        parameters.check()?;
        let hyperbola = parameters.hyperbola(parameters.friction_angle, parameters.dilation_angle);
        Ok(Self {
            parameters,
            hyperbola,
            cap: parameters.cap(&hyperbola)?,
            reference: Elasticity::new(parameters.unloading, parameters.poisson)?,
            is_perfect: false,
            dilatancy: dilatancy(parameters.dilation_angle, parameters.friction_angle),
        })
    }

    /// Its parameters.
    pub fn parameters(&self) -> &HardeningSoilParameters {
        &self.parameters
    }

    /// Steepness M of the cap \[-\], and its hardening modulus H at the reference pressure \[stress\].
    pub fn cap(&self) -> [f64; 2] {
        [self.cap.steepness, self.cap.hardening]
    }

    /// Stiffness under s over that at the reference, no less than that of the floor \[-\].
    fn stiffness_ratio(&self, s: f64) -> f64 {
        let floor = FLOOR * self.hyperbola.reference;
        self.hyperbola.stiffness_ratio(s.max(floor))
    }

    /// The law at another strength, with its cap: ψ stays but never exceeds φ.
    fn at_strength(&self, cohesion: f64, friction_angle: f64) -> Self {
        let parameters = HardeningSoilParameters {
            cohesion,
            friction_angle,
            dilation_angle: self.parameters.dilation_angle.min(friction_angle),
            ..self.parameters
        };
        Self {
            hyperbola: parameters.hyperbola(friction_angle, parameters.dilation_angle),
            parameters,
            ..*self
        }
    }

    /// The elasticity of a step \[stress\].
    fn moduli(&self, history: &History) -> Moduli {
        let ratio = history.internal[2].max(FLOOR);
        Moduli {
            bulk: ratio * self.reference.bulk(),
            shear: ratio * self.reference.shear(),
        }
    }

    /// Plastic shear strain, beyond all numbers where hardening is over, and preconsolidation.
    fn memory(&self, history: &History) -> [f64; 2] {
        let [gamma_p, preconsolidation, ..] = history.internal;
        let least = FLOOR * self.parameters.reference_pressure;
        if self.is_perfect {
            [f64::INFINITY; 2]
        } else {
            [gamma_p, preconsolidation.max(least)]
        }
    }

    /// The history after a step.
    fn after(&self, history: &History, returned: &Returned, delta_eps_p: &Principal) -> History {
        let mut after = history.after(delta_eps_p);
        if self.is_perfect {
            return after;
        }
        let sheared = if returned.shear == Shear::Apex {
            let [a, b, c] = *delta_eps_p;
            a.max(b).max(c) - a.min(b).min(c)
        } else {
            returned.delta_gamma
        };
        after.internal[0] += sheared;
        after.internal[1] = returned.preconsolidation;
        let s = self.hyperbola.confinement(returned.stress[2]);
        after.internal[2] = self.stiffness_ratio(s);
        after
    }
}

/// Which part of the surface a stress is on.
fn regime(returned: &Returned) -> Regime {
    match (returned.shear, returned.is_capped) {
        (Shear::Inside, false) => Regime::Elastic,
        (Shear::Inside, true) => Regime::Cap,
        (Shear::Apex, _) => Regime::Apex,
        (Shear::On(_), true) => Regime::CapShear,
        (Shear::On(planes), false) => planes.regime(),
    }
}

impl ConstitutiveModel for HardeningSoil {
    fn name(&self) -> &'static str {
        "Hardening Soil"
    }

    /// The elasticity of unloading at the reference pressure.
    fn stiffness_bound(&self) -> &Elasticity {
        &self.reference
    }

    fn has_linear_elasticity(&self) -> bool {
        false
    }

    fn elasticity_follows_history(&self) -> bool {
        !self.is_perfect
    }

    fn elastic_stress(&self, eps_e: &Principal, history: &History) -> Principal {
        self.moduli(history).stress(eps_e)
    }

    fn elastic_strain(
        &self,
        tau: &Principal,
        history: &History,
    ) -> Result<Principal, MaterialError> {
        Ok(self.moduli(history).strain(tau))
    }

    fn elastic_stiffness(&self, _eps_e: &Principal, history: &History) -> ElasticStiffness {
        let moduli = self.moduli(history);
        ElasticStiffness {
            tangent: moduli.tangent(),
            shear: moduli.shear,
        }
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        _: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let moduli = self.moduli(history);
        let pressure = moduli.stress(eps_e_trial).map(|stress| -stress);
        if !pressure.iter().all(|p| p.is_finite()) {
            return Err(MaterialError::NonFinite {
                quantity: "trial stress",
            });
        }
        let order = descending(&pressure);
        let [gamma_p, preconsolidation] = self.memory(history);
        let start = Start {
            hyperbola: &self.hyperbola,
            cap: (!self.is_perfect).then_some(&self.cap),
            moduli,
            gamma_p,
            preconsolidation,
        };
        let returned = start
            .returned(&sorted(&pressure, &order))
            .filter(Returned::is_finite)
            .ok_or(MaterialError::NotConverged { law: self.name() })?;
        let regime = regime(&returned);
        let tau = unsorted(&returned.stress, &order).map(|p| -p);
        let delta_eps_p = if regime.is_plastic() {
            let elastic = moduli.strain(&tau);
            std::array::from_fn(|a| eps_e_trial[a] - elastic[a])
        } else {
            [0.0; 3]
        };
        let mut tangent = [[0.0; 3]; 3];
        for (a, row) in returned.tangent.iter().enumerate() {
            tangent[order[a]] = unsorted(row, &order);
        }
        Ok(ReturnMap {
            tau,
            tangent,
            delta_eps_p,
            history: self.after(history, &returned, &delta_eps_p),
            regime,
            nonlocal: NonlocalRates::NONE,
        })
    }

    fn internal_variables(&self) -> &'static [InternalVariable] {
        &VARIABLES
    }

    /// The plastic shear strain of which the stress is on the surface, and the preconsolidation by the ratio of overconsolidation
    /// from $`\sqrt{q^2/M^2 + p^2}`$ of the stress.
    fn initial_history(&self, sigma: &Principal) -> History {
        let pressure = sigma.map(|stress| -stress);
        let [most, _, least] = sorted(&pressure, &descending(&pressure));
        let s = self.hyperbola.confinement(least);
        let borne = self.hyperbola.asymptote * s;
        let share = if most > least && borne > 0.0 {
            ((most - least) / borne).min(self.hyperbola.failure_ratio)
        } else {
            0.0
        };
        let tip = self.cap.equivalent(&pressure);
        let floor = FLOOR * self.parameters.reference_pressure;
        let mut history = History::default();
        history.internal[0] = self.hyperbola.strain(s, share).value;
        history.internal[1] = self.parameters.overconsolidation * tip.max(floor);
        history.internal[2] = self.stiffness_ratio(s);
        history
    }

    fn has_symmetric_tangent(&self) -> bool {
        false
    }

    /// r of eq. 8c as given.
    fn dilatancy(&self) -> f64 {
        self.dilatancy
    }
}

impl Strength for HardeningSoil {
    /// The larger excess: of $`\sigma_1 - \sigma_3`$ over its hyperbola, or of $`\sqrt{q^2/M^2 + p^2}`$ over $`p_p`$.
    fn yield_function(&self, tau: &Principal, history: &History) -> f64 {
        let pressure = tau.map(|stress| -stress);
        let [most, _, least] = sorted(&pressure, &descending(&pressure));
        let [gamma_p, preconsolidation] = self.memory(history);
        let shear = self.hyperbola.excess(most, least, gamma_p);
        shear.max(self.cap.equivalent(&pressure) - preconsolidation)
    }

    /// Twice the largest principal stress in magnitude, c cot φ and $`\sqrt{q^2/M^2 + p^2}`$ together.
    fn stress_scale(&self, tau: &Principal) -> f64 {
        let pressure = tau.map(|stress| -stress);
        2.0 * largest(tau) + self.hyperbola.attraction + self.cap.equivalent(&pressure)
    }

    /// That of Mohr–Coulomb's law with c and φ: $`(\sigma_1 - \sigma_3) / (2c\cos\varphi + (\sigma_1 + \sigma_3)\sin\varphi)`$ of
    /// pressures.
    fn utilisation(&self, tau: &Principal, _history: &History) -> f64 {
        let pressure = tau.map(|stress| -stress);
        let [most, _, least] = sorted(&pressure, &descending(&pressure));
        let ratio = self.hyperbola.asymptote * self.hyperbola.failure_ratio;
        let sin = ratio / (ratio + 2.0);
        let strength = sin * (most + least + 2.0 * self.hyperbola.attraction);
        mobilised(most - least, strength, self.stress_scale(tau))
    }

    fn shear_strength(&self) -> Option<ShearStrength> {
        Some(ShearStrength {
            cohesive: self.parameters.cohesion,
            friction_angle: self.parameters.friction_angle,
        })
    }

    /// ψ stays but never exceeds the new φ, and the cap is made for it.
    fn at_friction(&self, ratio: f64) -> Result<Option<Arc<dyn ConstitutiveModel>>, MaterialError> {
        positive("friction ratio", ratio)?;
        let friction_angle = (self.parameters.friction_angle.tan() * ratio).atan();
        let law = self.at_strength(self.parameters.cohesion, friction_angle);
        if self.is_perfect {
            return Ok(Some(Arc::new(law)));
        }
        let cap = law.parameters.cap(&law.hyperbola)?;
        Ok(Some(Arc::new(Self { cap, ..law })))
    }

    /// Mohr–Coulomb's surface of c and tan φ over `srf` without hardening, the stiffness held at that of the history; ψ stays but
    /// never exceeds the reduced φ.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        let parameters = &self.parameters;
        let friction_angle = (parameters.friction_angle.tan() / srf).atan();
        Ok(Arc::new(Self {
            is_perfect: true,
            ..self.at_strength(parameters.cohesion / srf, friction_angle)
        }))
    }
}
