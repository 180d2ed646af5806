//! Modified Cam-clay at finite strain: a yield surface that grows and shrinks with plastic volume (theory, eqs. 88 and 89).

mod elastic;
mod flow;

use std::sync::Arc;

use crate::error::{positive, required};
use crate::law::{ON_SURFACE, mobilised};
use crate::{
    ConstitutiveModel, ElasticStiffness, Elasticity, History, InternalVariable, MaterialError,
    NonlocalRates, PointContext, Principal, Regime, ReturnMap, Scaling, Strength,
};
use elastic::{Invariants, PressureElasticity, assembled};
use flow::Flow;

/// The internal variable: the pressure $`p_c`$ at the tip of the yield surface.
const VARIABLES: [InternalVariable; 1] = [InternalVariable {
    name: "preconsolidation pressure",
    unit: "Pa",
    scaling: Scaling::Stress,
    follows_stress: false,
}];

/// How the shear modulus of [`ModifiedCamClay`] goes with pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShearStiffness {
    /// G is a share of the mean pressure p, with Poisson's ratio ν \[-\] where there is no shear stress:
    /// $`G = \tfrac{3(1-2\nu)}{2(1+\nu)}\,p/\kappa^*`$.
    Poisson(f64),
    /// G is a constant \[stress\].
    Constant(f64),
}

/// The parameters of [`ModifiedCamClay`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CamClayParameters {
    /// Slope λ* of the compression line, natural volumetric strain over ln p \[-\].
    pub compression: f64,
    /// Slope κ* of the swelling lines \[-\].
    pub swelling: f64,
    /// Stress ratio M = q/p at the critical state \[-\].
    pub critical_ratio: f64,
    /// Shear stiffness.
    pub shear: ShearStiffness,
    /// $`p_c`$ over the pressure $`p + q^2/(M^2 p)`$ of the initial stress \[-\], at least 1.
    pub overconsolidation: f64,
    /// The pressure at which the elastic strain is zero \[stress\], and whose stiffness is
    /// [`stiffness_bound`](ConstitutiveModel::stiffness_bound).
    pub reference_pressure: f64,
}

/// Modified Cam-clay (Roscoe & Burland 1968) in Kirchhoff stress and Hencky strain, with associated flow, the yield function
///
/// ```math
/// f = p + \frac{q^2}{M^2 p} - p_c,\qquad p_c = p_{c,0} \exp\frac{\varepsilon_v^p}{\lambda^* - \kappa^*}
/// ```
///
/// and an elastic energy by which p grows with the exponential of strain (Houlsby, Amorosi & Rojas 2005): a closed elastic
/// cycle does no work. Pressure p and volumetric strain are positive in compression here. There is no strength in tension: p stays positive.
///
/// The surface is round about the hydrostatic axis: M is the same in compression, in extension and in plane strain.
/// Strength is not reduced: [`reduced`](Strength::reduced) says why.
///
/// ```
/// use igimp_material::{
///     CamClayParameters, ConstitutiveModel, ModifiedCamClay, PointContext, ShearStiffness,
/// };
///
/// let law = ModifiedCamClay::new(CamClayParameters {
///     compression: 0.1,
///     swelling: 0.02,
///     critical_ratio: 1.0,
///     shear: ShearStiffness::Poisson(0.2),
///     overconsolidation: 1.0,
///     reference_pressure: 100.0,
/// })?;
/// let sigma = [-100.0; 3];
/// let history = law.initial_history(&sigma);
/// let strain = law.elastic_strain(&sigma, &history)?;
/// let trial = strain.map(|e| e - 0.1 * 2f64.ln() / 3.0);
/// let answer = law.return_map(&trial, &history, &PointContext::STATIC)?;
/// assert!((answer.tau[0] + 200.0).abs() < 1e-9); // twice the pressure along the compression line
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModifiedCamClay {
    parameters: CamClayParameters,
    elastic: PressureElasticity,
    flow: Flow,
    /// The elasticity at the reference pressure.
    reference: Elasticity,
}

impl ModifiedCamClay {
    /// From its parameters.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless 0 < κ* < λ*, M and the pressure are positive, the ratio of overconsolidation is
    /// at least 1, G is positive and 0 ≤ ν < 0.5, and Poisson's ratio at the reference pressure is above -1.
    pub fn new(parameters: CamClayParameters) -> Result<Self, MaterialError> {
        let CamClayParameters {
            compression,
            swelling,
            critical_ratio,
            shear,
            overconsolidation,
            reference_pressure,
        } = parameters;
        positive("swelling", swelling)?;
        let is_larger = compression > swelling;
        required(
            "compression",
            compression,
            is_larger,
            "larger than `swelling`",
        )?;
        positive("critical_ratio", critical_ratio)?;
        positive("reference_pressure", reference_pressure)?;
        let is_one = overconsolidation >= 1.0;
        required("overconsolidation", overconsolidation, is_one, "at least 1")?;
        let (per_pressure, constant) = match shear {
            ShearStiffness::Poisson(poisson) => {
                let in_range = (0.0..0.5).contains(&poisson);
                required("poisson", poisson, in_range, "at least 0 and less than 0.5")?;
                let ratio = 1.5 * (1.0 - 2.0 * poisson) / (1.0 + poisson);
                (ratio / swelling, 0.0)
            }
            ShearStiffness::Constant(shear) => {
                positive("shear", shear)?;
                (0.0, shear)
            }
        };
        let elastic = PressureElasticity {
            swelling,
            per_pressure,
            constant,
            reference_pressure,
            log_reference: reference_pressure.ln(),
        };
        let (bulk, shear) = (
            reference_pressure / swelling,
            per_pressure * reference_pressure + constant,
        );
        let young = 9.0 * bulk * shear / (3.0 * bulk + shear);
        Ok(Self {
            parameters,
            elastic,
            flow: Flow {
                critical_ratio,
                hardening: 1.0 / (compression - swelling),
            },
            reference: Elasticity::new(young, young / (2.0 * shear) - 1.0)?,
        })
    }

    /// Its parameters.
    pub fn parameters(&self) -> &CamClayParameters {
        &self.parameters
    }

    /// The pressure on the hydrostatic axis of the surface through a stress with p > 0 \[stress\].
    fn equivalent(&self, p: f64, q: f64) -> f64 {
        p * (1.0 + (q / (self.flow.critical_ratio * p)).powi(2))
    }
}

impl ConstitutiveModel for ModifiedCamClay {
    fn name(&self) -> &'static str {
        "modified Cam-clay"
    }

    /// The elasticity at the reference pressure: at p times as much pressure the law is p times as stiff.
    fn stiffness_bound(&self) -> &Elasticity {
        &self.reference
    }

    fn has_linear_elasticity(&self) -> bool {
        false
    }

    fn elastic_stress(&self, eps_e: &Principal, _history: &History) -> Principal {
        let strain = Invariants::of_strain(eps_e);
        self.elastic
            .stress(strain.volume, strain.shear)
            .principal(&strain)
    }

    fn elastic_strain(
        &self,
        tau: &Principal,
        _history: &History,
    ) -> Result<Principal, MaterialError> {
        self.elastic.strain(tau)
    }

    fn elastic_stiffness(&self, eps_e: &Principal, _history: &History) -> ElasticStiffness {
        let strain = Invariants::of_strain(eps_e);
        let stress = self.elastic.stress(strain.volume, strain.shear);
        let shear = self.elastic.shear(stress.p);
        ElasticStiffness {
            tangent: assembled(&stress.stiffness, 2.0 * shear, &strain),
            shear,
        }
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        _: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let trial = Invariants::of_strain(eps_e_trial);
        let [p_c, ..] = history.internal;
        let relative = self.elastic.relative(trial.volume, trial.shear);
        let log_equivalent = self.flow.log_equivalent(&relative);
        if !log_equivalent.is_finite() {
            return Err(MaterialError::NonFinite {
                quantity: "trial stress",
            });
        }
        if log_equivalent - p_c.ln() <= ON_SURFACE {
            let stress = self.elastic.stress(trial.volume, trial.shear);
            if stress.p < f64::MIN_POSITIVE {
                return Err(MaterialError::NotConverged { law: self.name() });
            }
            let turning = 2.0 * self.elastic.shear(stress.p);
            return Ok(ReturnMap {
                tau: stress.principal(&trial),
                tangent: assembled(&stress.stiffness, turning, &trial),
                delta_eps_p: [0.0; 3],
                history: *history,
                regime: Regime::Elastic,
                nonlocal: NonlocalRates::NONE,
            });
        }
        let returned = self.flow.return_to(&self.elastic, &trial, p_c)?;
        let delta_eps_p = returned.delta_eps_p(&trial);
        let mut after = history.after(&delta_eps_p);
        after.internal[0] = returned.preconsolidation;
        Ok(ReturnMap {
            tau: returned.stress.principal(&trial),
            tangent: assembled(&returned.tangent, returned.turning, &trial),
            delta_eps_p,
            history: after,
            regime: Regime::Smooth,
            nonlocal: NonlocalRates::NONE,
        })
    }

    fn internal_variables(&self) -> &'static [InternalVariable] {
        &VARIABLES
    }

    /// $`p_c`$ by the ratio of overconsolidation from the pressure $`p + q^2/(M^2 p)`$ of the stress; that of the reference pressure
    /// where there is no pressure.
    fn initial_history(&self, sigma: &Principal) -> History {
        let stress = Invariants::of_stress(sigma);
        let equivalent = if stress.volume > 0.0 {
            self.equivalent(stress.volume, stress.shear)
        } else {
            self.parameters.reference_pressure
        };
        let mut history = History::default();
        history.internal[0] = self.parameters.overconsolidation * equivalent;
        history
    }

    /// Flow is associated, but $`p_c`$ grows by plastic volume and no energy of its own.
    fn has_symmetric_tangent(&self) -> bool {
        false
    }
}

impl Strength for ModifiedCamClay {
    /// $`f = p + q^2/(M^2 p) - p_c`$; the distance from the tip of the surface where p is not positive.
    fn yield_function(&self, tau: &Principal, history: &History) -> f64 {
        let stress = Invariants::of_stress(tau);
        let [p_c, ..] = history.internal;
        if stress.volume > 0.0 {
            self.equivalent(stress.volume, stress.shear) - p_c
        } else {
            p_c + stress.shear - stress.volume
        }
    }

    /// $`p + q^2/(M^2 p)`$; the sum of p and q in magnitude where p is not positive.
    fn stress_scale(&self, tau: &Principal) -> f64 {
        let stress = Invariants::of_stress(tau);
        if stress.volume > 0.0 {
            self.equivalent(stress.volume, stress.shear)
        } else {
            stress.shear - stress.volume
        }
    }

    /// q/(M p): 1 at the critical state, less on the surface beyond it, more where soil dilates.
    fn utilisation(&self, tau: &Principal, _history: &History) -> f64 {
        let stress = Invariants::of_stress(tau);
        let strength = self.flow.critical_ratio * stress.volume;
        mobilised(stress.shear, strength, stress.shear + stress.volume.abs())
    }

    /// Refused: with M/F the stresses that are there lie outside of the surface of the same $`p_c`$, which hardens at once, and
    /// no factor has the meaning of a strength over the one that is needed.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        Err(MaterialError::NoReduction {
            law: self.name(),
            reason: "its strength is a result of the path, and not a parameter",
        })
    }
}
