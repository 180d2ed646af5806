//! Parameters of Hardening Soil, and values that follow from them.

use super::cap::{Cap, Oedometer};
use super::hyperbola::Hyperbola;
use crate::MaterialError;
use crate::error::{positive, required};

/// The parameters of [`HardeningSoil`](super::HardeningSoil).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardeningSoilParameters {
    /// Cohesion c \[stress\].
    pub cohesion: f64,
    /// Friction angle φ \[rad\].
    pub friction_angle: f64,
    /// Dilation angle ψ at failure \[rad\].
    pub dilation_angle: f64,
    /// $`E_{50}^{ref}`$: secant modulus at half the strength of drained triaxial compression under $`p_{ref}`$ \[stress\].
    pub secant: f64,
    /// $`E_{ur}^{ref}`$: Young's modulus of unloading under $`p_{ref}`$ \[stress\].
    pub unloading: f64,
    /// $`E_{oed}^{ref}`$: tangent modulus of first one-dimensional compression at an axial stress of $`p_{ref}`$ \[stress\].
    pub oedometer: f64,
    /// Poisson's ratio of unloading $`\nu_{ur}`$ \[-\].
    pub poisson: f64,
    /// Power m by which stiffness grows with stress \[-\].
    pub power: f64,
    /// $`p_{ref}`$ \[stress\].
    pub reference_pressure: f64,
    /// $`R_f`$: strength over the asymptote of the hyperbola \[-\].
    pub failure_ratio: f64,
    /// $`K_0^{nc}`$: ratio of stresses in first one-dimensional compression \[-\].
    pub k0_normal: f64,
    /// $`p_p`$ over $`\sqrt{q^2/M^2 + p^2}`$ of the initial stress \[-\], at least 1.
    pub overconsolidation: f64,
}

impl HardeningSoilParameters {
    /// Dense Hostun sand, normally consolidated, in Pa, by values commonly quoted from Schanz, Vermeer and Bonnier (1999); the paper was
    /// not at hand.
    pub fn dense_hostun_sand() -> Self {
        Self {
            cohesion: 0.0,
            friction_angle: 42_f64.to_radians(),
            dilation_angle: 16_f64.to_radians(),
            secant: 30e6,
            unloading: 90e6,
            oedometer: 30e6,
            poisson: 0.2,
            power: 0.55,
            reference_pressure: 100e3,
            failure_ratio: 0.9,
            k0_normal: 0.4,
            overconsolidation: 1.0,
        }
    }

    /// Loose Hostun sand, likewise, in Pa.
    pub fn loose_hostun_sand() -> Self {
        Self {
            friction_angle: 34_f64.to_radians(),
            dilation_angle: 0.0,
            secant: 20e6,
            unloading: 60e6,
            oedometer: 16e6,
            power: 0.65,
            k0_normal: 0.44,
            ..Self::dense_hostun_sand()
        }
    }

    /// Refuses values that no soil has.
    pub(super) fn check(&self) -> Result<(), MaterialError> {
        let within = |field, value: f64, low: f64, high: f64, words| {
            required(field, value, (low..high).contains(&value), words)
        };
        let Self {
            cohesion,
            friction_angle,
            dilation_angle,
            ..
        } = *self;
        required(
            "cohesion",
            cohesion,
            cohesion >= 0.0,
            "finite and not negative",
        )?;
        let degree = 1_f64.to_radians();
        let words = "at least 1 degree and less than 80 degrees";
        within(
            "friction_angle",
            friction_angle,
            degree,
            80.0 * degree,
            words,
        )?;
        let some = (0.0..=friction_angle.min(30.0 * degree)).contains(&dilation_angle);
        let words = "at least 0, at most `friction_angle` and at most 30 degrees";
        required("dilation_angle", dilation_angle, some, words)?;
        positive("secant", self.secant)?;
        positive("oedometer", self.oedometer)?;
        positive("reference_pressure", self.reference_pressure)?;
        let words = "positive and less than 1";
        within(
            "failure_ratio",
            self.failure_ratio,
            f64::MIN_POSITIVE,
            1.0,
            words,
        )?;
        within("k0_normal", self.k0_normal, f64::MIN_POSITIVE, 1.0, words)?;
        within(
            "poisson",
            self.poisson,
            0.0,
            0.5,
            "at least 0 and less than 0.5",
        )?;
        let in_range = (0.0..=1.0).contains(&self.power);
        required("power", self.power, in_range, "at least 0 and at most 1")?;
        let is_stiffer = self.unloading > self.initial();
        let words = "larger than 2 `secant` / (2 - `failure_ratio`), the initial stiffness of the hyperbola";
        required("unloading", self.unloading, is_stiffer, words)?;
        let ratio = self.overconsolidation;
        required("overconsolidation", ratio, ratio >= 1.0, "at least 1")
    }

    /// $`E_i`$ at the reference \[stress\].
    fn initial(&self) -> f64 {
        2.0 * self.secant / (2.0 - self.failure_ratio)
    }

    /// The hyperbola with another φ and ψ; its cohesion is that of the parameters.
    pub(super) fn hyperbola(&self, friction_angle: f64, dilation_angle: f64) -> Hyperbola {
        let (friction, dilation) = (friction_angle.sin(), dilation_angle.sin());
        let attraction = self.cohesion / friction_angle.tan();
        let reference = self.reference_pressure + attraction;
        let asymptote = 2.0 * friction / (1.0 - friction) / self.failure_ratio;
        Hyperbola {
            attraction,
            reference,
            power: self.power,
            asymptote,
            failure_ratio: self.failure_ratio,
            initial: 2.0 * asymptote * reference / self.initial(),
            unloading: 2.0 * asymptote * reference / self.unloading,
            sin_critical: (friction - dilation) / (1.0 - friction * dilation),
        }
    }

    /// The cap that belongs to a hyperbola.
    pub(super) fn cap(&self, hyperbola: &Hyperbola) -> Result<Cap, MaterialError> {
        let side = hyperbola.confinement(self.k0_normal * self.reference_pressure);
        let oedometer = Oedometer {
            stiffness: self.oedometer,
            k0: self.k0_normal,
            pressure: self.reference_pressure,
            elastic: [
                self.unloading * hyperbola.stiffness_ratio(side),
                self.poisson,
            ],
        };
        let words = "a modulus that a cap can give beside the others: less, or a `k0_normal` nearer to 1 - sin(friction)";
        Cap::of(hyperbola, &oedometer).ok_or(MaterialError::InvalidParameter {
            field: "oedometer",
            value: self.oedometer,
            requirement: words,
        })
    }
}
