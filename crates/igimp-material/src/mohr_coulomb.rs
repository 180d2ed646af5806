//! Mohr–Coulomb plasticity with non-associated flow and an optional tension cut-off (theory, eqs. 21
//! and 31), or with associated flow on Davis's strengths in its place (eq. 21a).
//!
//! Exact return in principal space after Clausen, Damkilde & Andersen (2006), *Efficient return
//! algorithms for associated plasticity with multiple yield planes*, Int. J. Numer. Meth. Engng
//! 66, 1036–1059.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use crate::error::{positive, required};
use crate::law::dilatancy;
use crate::pyramid::{PlaneStrength, Pyramid};
use crate::{
    ConstitutiveModel, Elasticity, History, MaterialError, PointContext, Principal, ReturnMap,
    ShearStrength, Strength,
};

/// Elastic and perfectly plastic with the yield function
///
/// ```math
/// f = (1+\sin\varphi)\,\sigma_1 - (1-\sin\varphi)\,\sigma_3 - 2c\cos\varphi,\qquad
/// \sigma_1 \ge \sigma_2 \ge \sigma_3
/// ```
///
/// and the plastic potential of the same form in the dilation angle ψ ≤ φ. With a tension
/// cut-off also $`\sigma_1 \le \sigma_t`$, with associated flow.
///
/// Trial states beyond the end of an edge go to the apex σ1 = σ2 = σ3 = c cot φ with a tangent
/// of zero. With ψ = 0 plastic flow keeps volume and cannot follow a mean stress above c cot φ
/// down; such states go to the apex all the same, and the plastic volume strain this takes is
/// counted.
///
/// ```
/// use igimp_material::{
///     ConstitutiveModel, Elasticity, History, MohrCoulomb, PointContext, Regime, Strength,
/// };
///
/// let elasticity = Elasticity::new(1e5, 0.3)?;
/// let law = MohrCoulomb::new(elasticity, 10.0, 20_f64.to_radians(), 0.0)?;
/// let history = History::default();
/// let answer = law.return_map(&[2e-4, 0.0, -4e-4], &history, &PointContext::STATIC)?;
/// assert_eq!(answer.regime, Regime::Smooth);
/// assert!(law.yield_function(&answer.tau, &history).abs() < 1e-12);
/// # Ok::<(), igimp_material::MaterialError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MohrCoulomb {
    given: Parameters,
    /// r of eq. 8c as given, before any change of strength \[-\].
    dilatancy: f64,
    /// The strength at yield: as given, or Davis's.
    strength: ShearStrength,
    pyramid: Pyramid,
}

/// The parameters of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Parameters {
    cohesion: f64,
    friction_angle: f64,
    dilation_angle: f64,
    tension_cutoff: Option<f64>,
    is_davis: bool,
}

impl Parameters {
    /// Refuses angles and strengths that no soil has.
    fn check(&self) -> Result<(), MaterialError> {
        let Self {
            cohesion,
            friction_angle,
            dilation_angle,
            tension_cutoff,
            ..
        } = *self;
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
        required(
            "cohesion",
            cohesion,
            cohesion >= 0.0,
            "finite and not negative",
        )?;
        let some = cohesion > 0.0 || friction_angle > 0.0;
        required(
            "cohesion",
            cohesion,
            some,
            "positive when `friction_angle` is 0",
        )?;
        if let Some(cutoff) = tension_cutoff {
            required(
                "tension_cutoff",
                cutoff,
                cutoff >= 0.0,
                "finite and not negative",
            )?;
        }
        Ok(())
    }
}

impl MohrCoulomb {
    /// From cohesion c \[stress\], friction angle φ and dilation angle ψ \[radians\].
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless `cohesion` ≥ 0 (> 0 without friction),
    /// 0 ≤ `friction_angle` < π/2 and 0 ≤ `dilation_angle` ≤ `friction_angle`.
    pub fn new(
        elasticity: Elasticity,
        cohesion: f64,
        friction_angle: f64,
        dilation_angle: f64,
    ) -> Result<Self, MaterialError> {
        let given = Parameters {
            cohesion,
            friction_angle,
            dilation_angle,
            tension_cutoff: None,
            is_davis: false,
        };
        Self::build(elasticity, given, Pyramid::new)
    }

    /// The law with the largest principal stress bounded by $`\sigma_t`$ = `tension_cutoff`
    /// \[stress\].
    ///
    /// A cut-off at or above the apex c cot φ never acts.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] if `tension_cutoff` is negative or not finite.
    pub fn with_tension_cutoff(self, tension_cutoff: f64) -> Result<Self, MaterialError> {
        let given = Parameters {
            tension_cutoff: Some(tension_cutoff),
            ..self.given
        };
        self.at_strength(given, Pyramid::new)
    }

    /// The law with associated flow on the strengths of Davis (1968, eq. 21a), which soil of this ψ mobilises along lines of no
    /// extension. With every change of strength they are made anew from the changed φ. A tension cut-off stays as it is.
    ///
    /// # Errors
    /// None that the law did not have.
    pub fn with_davis_flow(self) -> Result<Self, MaterialError> {
        let given = Parameters {
            is_davis: true,
            ..self.given
        };
        Self::build(*self.stiffness_bound(), given, Pyramid::new)
    }

    /// Cohesion c as given \[stress\].
    pub fn cohesion(&self) -> f64 {
        self.given.cohesion
    }

    /// Friction angle φ as given \[radians\].
    pub fn friction_angle(&self) -> f64 {
        self.given.friction_angle
    }

    /// Dilation angle ψ as given \[radians\].
    pub fn dilation_angle(&self) -> f64 {
        self.given.dilation_angle
    }

    /// Tension cut-off $`\sigma_t`$ \[stress\], if any.
    pub fn tension_cutoff(&self) -> Option<f64> {
        self.given.tension_cutoff
    }

    fn build(
        elasticity: Elasticity,
        given: Parameters,
        pyramid: impl FnOnce(Elasticity, &PlaneStrength) -> Pyramid,
    ) -> Result<Self, MaterialError> {
        let Parameters {
            cohesion,
            friction_angle,
            dilation_angle,
            tension_cutoff,
            is_davis,
        } = given;
        given.check()?;
        let apex = if friction_angle > 0.0 {
            cohesion / friction_angle.tan()
        } else {
            f64::INFINITY
        };
        let (strength, flows_by) = if is_davis {
            // Both by the same share: the apex stays.
            let mobilised = davis(friction_angle, dilation_angle);
            let strength = ShearStrength {
                cohesive: mobilised * cohesion,
                friction_angle: if mobilised < 1.0 {
                    (mobilised * friction_angle.tan()).atan()
                } else {
                    friction_angle
                },
            };
            (strength, strength.friction_angle)
        } else {
            let strength = ShearStrength {
                cohesive: cohesion,
                friction_angle,
            };
            (strength, dilation_angle)
        };
        let surface = PlaneStrength {
            sin_friction: strength.friction_angle.sin(),
            sin_dilation: flows_by.sin(),
            shear: 2.0 * strength.cohesive * strength.friction_angle.cos(),
            apex,
            tension_cutoff: tension_cutoff.filter(|&cutoff| cutoff < apex),
        };
        let pyramid = pyramid(elasticity, &surface);
        Ok(Self {
            given,
            dilatancy: if is_davis {
                1.0
            } else {
                dilatancy(dilation_angle, friction_angle)
            },
            strength,
            pyramid,
        })
    }

    /// The law at another strength: ψ never exceeds φ, and r of eq. 8c as given is kept.
    fn at_strength(
        &self,
        given: Parameters,
        pyramid: impl FnOnce(Elasticity, &PlaneStrength) -> Pyramid,
    ) -> Result<Self, MaterialError> {
        let given = Parameters {
            dilation_angle: given.dilation_angle.min(given.friction_angle),
            ..given
        };
        let law = Self::build(*self.stiffness_bound(), given, pyramid)?;
        Ok(Self {
            dilatancy: self.dilatancy,
            ..law
        })
    }
}

/// The share of the strength that soil mobilises along lines of no extension, $`\cos\psi \cos\varphi / (1 - \sin\psi \sin\varphi)`$
/// (Davis 1968); 1 at ψ = φ \[-\].
fn davis(friction_angle: f64, dilation_angle: f64) -> f64 {
    // cos(φ − ψ) = cos ψ cos φ + sin ψ sin φ: at ψ = φ this is 1 to the last bit.
    let product = dilation_angle.sin() * friction_angle.sin();
    ((friction_angle - dilation_angle).cos() - product) / (1.0 - product)
}

impl ConstitutiveModel for MohrCoulomb {
    fn name(&self) -> &'static str {
        "Mohr-Coulomb"
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

    #[expect(
        clippy::float_cmp,
        reason = "flow is associated only where the angles are the same"
    )]
    fn has_symmetric_tangent(&self) -> bool {
        self.given.is_davis || self.given.dilation_angle == self.given.friction_angle
    }

    /// r of eq. 8c as given; 1 where flow is Davis's.
    fn dilatancy(&self) -> f64 {
        self.dilatancy
    }
}

impl Strength for MohrCoulomb {
    /// The larger of $`(1+\sin\varphi)\,\sigma_1 - (1-\sin\varphi)\,\sigma_3 - 2c\cos\varphi`$,
    /// twice a distance in shear stress, and $`\sigma_1 - \sigma_t`$.
    fn yield_function(&self, tau: &Principal, _history: &History) -> f64 {
        self.pyramid.yield_function(tau)
    }

    /// 2 c cos φ plus twice the largest principal stress in magnitude.
    fn stress_scale(&self, tau: &Principal) -> f64 {
        self.pyramid.stress_scale(tau)
    }

    /// $`(\sigma_1 - \sigma_3) / (2c\cos\varphi - (\sigma_1 + \sigma_3)\sin\varphi)`$, the ratio of
    /// the radii of two Mohr circles with one centre; 1 at the apex and beyond, where the
    /// denominator is not positive.
    fn utilisation(&self, tau: &Principal, _history: &History) -> f64 {
        self.pyramid.utilisation(tau)
    }

    fn shear_strength(&self) -> Option<ShearStrength> {
        Some(self.strength)
    }

    /// ψ stays but never exceeds the new φ; c and the cut-off stay.
    fn at_friction(&self, ratio: f64) -> Result<Option<Arc<dyn ConstitutiveModel>>, MaterialError> {
        required(
            "friction ratio",
            ratio,
            ratio >= 0.0,
            "finite and not negative",
        )?;
        let given = Parameters {
            friction_angle: (self.given.friction_angle.tan() * ratio).atan(),
            ..self.given
        };
        // A point has its own, which is asked once.
        Ok(Some(Arc::new(self.at_strength(given, Pyramid::once)?)))
    }

    /// Divides c, tan φ and the cut-off by `srf`; ψ stays but never exceeds the reduced φ.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        positive("srf", srf)?;
        let given = Parameters {
            cohesion: self.given.cohesion / srf,
            friction_angle: (self.given.friction_angle.tan() / srf).atan(),
            tension_cutoff: self.given.tension_cutoff.map(|cutoff| cutoff / srf),
            ..self.given
        };
        Ok(Arc::new(self.at_strength(given, Pyramid::new)?))
    }
}
