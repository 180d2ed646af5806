//! Drucker–Prager plasticity: a cone about the hydrostatic axis that agrees with Mohr–Coulomb along one path (theory, eqs. 93
//! and 94).
//!
//! The return to cone and apex is in closed form: theory, eqs. 95 and 96; de Souza Neto, Perić & Owen (2008), section 8.3. Its
//! friction may grow with the speed of shear, which leaves it so: eqs. 129 to 129c.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::error::{positive, required};
use crate::inertial_friction::{Sheared, SlowCone};
use crate::law::{ON_SURFACE, dilatancy, mobilised, trial_stress};
use crate::spectral::principal::{deviator, deviator_norm, largest, mean};
use crate::{
    ConstitutiveModel, Dissipation, Elasticity, History, InertialFriction, MaterialError,
    NonlocalRates, PointContext, Principal, Regime, ReturnMap, ShearStrength, Strength,
};

/// Where the cone of [`DruckerPrager`] agrees with Mohr–Coulomb of the same c, φ and ψ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cone {
    /// In triaxial compression, along the outer edges of the pyramid.
    Compression,
    /// In triaxial extension, along the inner edges of the pyramid.
    Extension,
    /// In plane flow, where the strain rate out of the plane is plastic and zero.
    PlaneStrain,
}

/// Elastic and perfectly plastic with the yield function
///
/// ```math
/// f = q + M p - k,\qquad q = \sqrt{3/2}\,\lVert s\rVert
/// ```
///
/// and the plastic potential $`q + M_\psi p`$, with p the mean stress, tension positive. M, k and $`M_\psi`$ follow from c, φ and
/// ψ by the [`Cone`], and are made anew with every change of strength.
///
/// Trial states beyond the end of the cone go to its apex p = c cot φ with a tangent of zero, with ψ = 0 too.
///
/// [`with_rate`](Self::with_rate) makes friction grow with the speed of shear in steps that take time. Its strength elsewhere
/// is that of slow shear: f of a state that flows fast is positive.
///
/// ```
/// use igimp_material::{
///     Cone, ConstitutiveModel, DruckerPrager, Elasticity, History, PointContext, Regime, Strength,
/// };
///
/// let elasticity = Elasticity::new(1e5, 0.3)?;
/// let friction = 20_f64.to_radians();
/// let law = DruckerPrager::new(elasticity, 10.0, friction, 0.0, Cone::PlaneStrain)?;
/// let history = History::default();
/// let answer = law.return_map(&[2e-4, 0.0, -4e-4], &history, &PointContext::STATIC)?;
/// assert_eq!(answer.regime, Regime::Smooth);
/// assert!(law.yield_function(&answer.tau, &history).abs() < 1e-12);
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DruckerPrager {
    elasticity: Elasticity,
    strength: ShearStrength,
    dilation_angle: f64,
    cone: Cone,
    /// r of eq. 8c as given, before any change of strength \[-\].
    dilatancy: f64,
    /// M \[-\].
    slope: f64,
    /// k \[stress\].
    shear: f64,
    /// M_ψ \[-\].
    flow: f64,
    /// Friction that grows with the speed of shear, and (M_2 − M)/M \[-\].
    rate: Option<(InertialFriction, f64)>,
}

impl Cone {
    /// M/sin φ and M_ψ by sin φ and sin ψ \[-\].
    fn factors(self, sin: f64, dilation: f64) -> (f64, f64) {
        match self {
            Self::Compression => (6.0 / (3.0 - sin), 6.0 * dilation / (3.0 - dilation)),
            Self::Extension => (6.0 / (3.0 + sin), 6.0 * dilation / (3.0 + dilation)),
            Self::PlaneStrain => {
                let root = dilation.mul_add(dilation, 3.0).sqrt();
                (3.0 * root / (3.0 + sin * dilation), 3.0 * dilation / root)
            }
        }
    }
}

impl DruckerPrager {
    /// From cohesion c \[stress\], friction angle φ and dilation angle ψ \[radians\] of Mohr–Coulomb.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless `cohesion` ≥ 0 (> 0 without friction), 0 ≤ `friction_angle` < π/2 and
    /// 0 ≤ `dilation_angle` ≤ `friction_angle`.
    pub fn new(
        elasticity: Elasticity,
        cohesion: f64,
        friction_angle: f64,
        dilation_angle: f64,
        cone: Cone,
    ) -> Result<Self, MaterialError> {
        let in_range = (0.0..FRAC_PI_2).contains(&friction_angle) && friction_angle.sin() < 1.0;
        required(
            "friction_angle",
            friction_angle,
            in_range,
            "at least 0 and less than pi/2",
        )?;
        let in_range = (0.0..=friction_angle).contains(&dilation_angle);
        required(
            "dilation_angle",
            dilation_angle,
            in_range,
            "at least 0 and at most `friction_angle`",
        )?;
        let in_range = cohesion >= 0.0;
        required("cohesion", cohesion, in_range, "finite and not negative")?;
        let some = cohesion > 0.0 || friction_angle > 0.0;
        required(
            "cohesion",
            cohesion,
            some,
            "positive when `friction_angle` is 0",
        )?;
        let ((sin, cos), dilation) = (friction_angle.sin_cos(), dilation_angle.sin());
        // M = factor · sin φ and k = factor · c cos φ: the apex is that of Mohr–Coulomb.
        let (factor, flow) = cone.factors(sin, dilation);
        Ok(Self {
            elasticity,
            strength: ShearStrength {
                cohesive: cohesion,
                friction_angle,
            },
            dilation_angle,
            cone,
            dilatancy: dilatancy(dilation_angle, friction_angle),
            slope: factor * sin,
            shear: factor * cohesion * cos,
            flow,
            rate: None,
        })
    }

    /// The law with friction that grows with the speed of shear in steps that take time: M at the apex that stays.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] of soil that dilates or has no friction, of a fast friction angle that is not above φ
    /// and below π/2, and of numbers that are not positive.
    pub fn with_rate(self, rate: InertialFriction) -> Result<Self, MaterialError> {
        let (slow, dilation) = (self.strength.friction_angle, self.dilation_angle);
        let keeps_volume = dilation == 0.0;
        let requirement = "0 where friction grows with the speed of shear";
        required("dilation_angle", dilation, keeps_volume, requirement)?;
        positive("friction_angle", slow)?;
        rate.check(slow)?;
        let sin = rate.friction_angle.sin();
        let fast = self.cone.factors(sin, 0.0).0 * sin;
        Ok(Self {
            rate: Some((rate, fast / self.slope - 1.0)),
            ..self
        })
    }

    /// Where it agrees with Mohr–Coulomb.
    pub fn cone(&self) -> Cone {
        self.cone
    }

    /// The law at another strength: ψ stays but never exceeds φ, r of eq. 8c as given is kept, and tan φ of fast shear goes as that of slow
    /// shear.
    fn at_strength(&self, cohesion: f64, friction_angle: f64) -> Result<Self, MaterialError> {
        let dilation_angle = self.dilation_angle.min(friction_angle);
        let law = Self::new(
            self.elasticity,
            cohesion,
            friction_angle,
            dilation_angle,
            self.cone,
        )?;
        let law = match self.rate {
            Some((rate, _)) if friction_angle > 0.0 => {
                let ratio = friction_angle.tan() / self.strength.friction_angle.tan();
                law.with_rate(rate.times(ratio))?
            }
            _ => law,
        };
        Ok(Self {
            dilatancy: self.dilatancy,
            ..law
        })
    }

    /// Plastic shear of a step of a duration \[time\] whose trial state has q \[stress\] beyond the cone, at a mean stress p
    /// \[stress\].
    fn sheared(&self, excess: f64, p: f64, duration: f64) -> Sheared {
        let stiffness = 3.0 * self.elasticity.shear();
        let strength = self.shear - self.slope * p;
        match &self.rate {
            Some((rate, growth)) if duration > 0.0 && strength > 0.0 => {
                let cone = SlowCone {
                    excess,
                    strength,
                    pressure: strength / self.slope,
                    growth: *growth,
                    stiffness,
                };
                rate.sheared(&cone, duration)
            }
            _ => Sheared::slowly(
                excess / (stiffness + self.elasticity.bulk() * self.slope * self.flow),
            ),
        }
    }

    /// The trial state goes to the apex.
    fn at_apex(&self, trial: &Principal, history: &History) -> ReturnMap {
        let stress = self.shear / self.slope;
        let volume = mean(trial) - stress / (3.0 * self.elasticity.bulk());
        let delta_eps_p = deviator(trial).map(|component| component + volume);
        ReturnMap {
            tau: [stress; 3],
            tangent: [[0.0; 3]; 3],
            delta_eps_p,
            history: history.after(&delta_eps_p),
            regime: Regime::Apex,
            nonlocal: NonlocalRates::NONE,
        }
    }
}

impl ConstitutiveModel for DruckerPrager {
    fn name(&self) -> &'static str {
        "Drucker-Prager"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let trial = trial_stress(&self.elasticity, eps_e_trial)?;
        let (bulk, shear) = (self.elasticity.bulk(), self.elasticity.shear());
        // From strain, where a large mean stress costs no digits.
        let s = deviator(eps_e_trial).map(|component| 2.0 * shear * component);
        let (q, p) = (deviator_norm(&s), 3.0 * bulk * mean(eps_e_trial));
        let excess = q + self.slope * p - self.shear;
        if excess <= ON_SURFACE * self.stress_scale(&trial) {
            return Ok(ReturnMap::elastic(&self.elasticity, trial, *history));
        }
        let sheared = self.sheared(excess, p, context.duration);
        let stiffness = 3.0 * shear + bulk * self.slope * self.flow + sheared.by_strain;
        let delta_lambda = sheared.strain;
        let pressed = p - bulk * self.flow * delta_lambda;
        // On the cone by its equation, and not by the difference of two large stresses.
        let left = sheared.factor * (self.shear - self.slope * pressed);
        if left <= 0.0 {
            return Ok(self.at_apex(eps_e_trial, history));
        }
        let share = left / q;
        let direction = s.map(|component| 1.5 * component / q);
        let flow = direction.map(|n| n + self.flow / 3.0);
        let mut tangent = [[bulk - 2.0 / 3.0 * shear * share; 3]; 3];
        for a in 0..3 {
            tangent[a][a] += 2.0 * shear * share;
            let along = bulk * self.flow + 2.0 * shear * direction[a];
            for b in 0..3 {
                let rise = 2.0 * shear * direction[b] + bulk * self.slope * sheared.by_pressure;
                tangent[a][b] += 4.0 / 3.0 * shear * (1.0 - share) * direction[a] * direction[b]
                    - along * rise / stiffness;
            }
        }
        let delta_eps_p = flow.map(|component| delta_lambda * component);
        Ok(ReturnMap {
            tau: s.map(|component| pressed + share * component),
            tangent,
            delta_eps_p,
            history: history.after(&delta_eps_p),
            regime: Regime::Smooth,
            nonlocal: NonlocalRates::NONE,
        })
    }

    #[expect(
        clippy::float_cmp,
        reason = "flow is associated only where the angles are the same"
    )]
    fn has_symmetric_tangent(&self) -> bool {
        self.dilation_angle == self.strength.friction_angle
    }

    /// r of eq. 8c as given.
    fn dilatancy(&self) -> f64 {
        self.dilatancy
    }
}

impl Strength for DruckerPrager {
    /// $`q + M p - k`$.
    fn yield_function(&self, tau: &Principal, _history: &History) -> f64 {
        deviator_norm(&deviator(tau)) + self.slope * mean(tau) - self.shear
    }

    /// k plus twice the largest principal stress in magnitude.
    fn stress_scale(&self, tau: &Principal) -> f64 {
        self.shear + 2.0 * largest(tau)
    }

    /// $`q/(k - M p)`$; 1 at the apex and beyond, where the denominator is not positive.
    fn utilisation(&self, tau: &Principal, _history: &History) -> f64 {
        mobilised(
            deviator_norm(&deviator(tau)),
            self.shear - self.slope * mean(tau),
            self.stress_scale(tau),
        )
    }

    /// c and φ, which the cone is made of.
    fn shear_strength(&self) -> Option<ShearStrength> {
        Some(self.strength)
    }

    /// $`k\,\dot\varepsilon_q`$ with $`\dot\varepsilon_q = \sqrt{2/3}\,\lVert\dot e\rVert`$, at the volume
    /// $`M\,\dot\varepsilon_q`$.
    fn dissipation(&self, rate: &Principal) -> Option<Dissipation> {
        let shearing = deviator_norm(&deviator(rate)) / 1.5;
        Some(Dissipation {
            power: self.shear * shearing,
            dilation: self.slope * shearing,
        })
    }

    /// ψ stays but never exceeds the new φ; c stays, and the cone is matched anew.
    fn at_friction(&self, ratio: f64) -> Result<Option<Arc<dyn ConstitutiveModel>>, MaterialError> {
        let is_ratio = ratio >= 0.0;
        required("friction ratio", ratio, is_ratio, "finite and not negative")?;
        let friction_angle = (self.strength.friction_angle.tan() * ratio).atan();
        let law = self.at_strength(self.strength.cohesive, friction_angle)?;
        Ok(Some(Arc::new(law)))
    }

    /// Divides c and tan φ by `srf` and matches the cone anew; ψ stays but never exceeds the reduced φ.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        let friction_angle = (self.strength.friction_angle.tan() / srf).atan();
        let law = self.at_strength(self.strength.cohesive / srf, friction_angle)?;
        Ok(Arc::new(law))
    }
}
