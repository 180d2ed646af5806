//! Strength of a law, and its reduction.

use std::sync::Arc;

use super::ConstitutiveModel;
use super::history::History;
use crate::MaterialError;
use crate::spectral::principal::Principal;

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

/// The strength of a law: its yield surface, its part in limit analysis, and its reduction.
pub trait Strength {
    /// Whether the law has a yield surface: locking of plastic flow concerns no other.
    fn yields(&self) -> bool {
        true
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

    /// The shear strength; none for a law without a limit. Of one that softens or hardens it is the greatest.
    fn shear_strength(&self) -> Option<ShearStrength> {
        None
    }

    /// The shear strength that acts on soil with a `history`, at rest; none for a law without a limit.
    fn shear_strength_at(&self, history: &History) -> Option<ShearStrength> {
        let _ = history;
        self.shear_strength()
    }

    /// Dissipation of plastic flow by the normality rule at the principal strain `rate` \[-\], whose own volume does
    /// not matter; none for a law without a limit. With a limit on tension it is no less than that of the
    /// law.
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
    /// law whose internal variables are stresses divides the values that it reads by `srf` itself.
    ///
    /// # Errors
    /// [`MaterialError::InvalidParameter`] unless `srf` is positive and finite.
    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError>;
}

/// Share of [`Strength::stress_scale`] by which f may exceed zero on the surface.
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
