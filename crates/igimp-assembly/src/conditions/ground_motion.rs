//! Motion given beside loads: the acceleration of the ground that a body stands on, and viscous damping of soil.

/// Acceleration of the ground in whose frame displacement and velocity are given (theory, eqs. 72 and 72a) \[length/time²\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundMotion<const D: usize> {
    /// The mean over the step: the change of velocity of the ground over the duration.
    pub acceleration: [f64; D],
    /// The mean over the step before, which the accelerations that are carried on belong to; none where it stood still.
    pub earlier: [f64; D],
}

impl<const D: usize> GroundMotion<D> {
    /// By how much the acceleration of the ground is another than in the step before.
    pub(crate) fn change(&self) -> [f64; D] {
        std::array::from_fn(|axis| self.acceleration[axis] - self.earlier[axis])
    }

    /// Whether all numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let mut all = self.acceleration.iter().chain(&self.earlier);
        all.all(|value| value.is_finite())
    }
}

/// Rayleigh damping of soil: a force (α M + β K_e) v (theory, eq. 75).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh {
    /// α \[1/time\].
    pub mass: f64,
    /// β, with the elastic stiffness as the step begins \[time\].
    pub stiffness: f64,
}

impl Rayleigh {
    /// The damping of these ratios of critical damping \[-\] at two frequencies \[1/time\]: α + β ω² = 2 ξ ω at both.
    pub fn at(ratios: [f64; 2], frequencies: [f64; 2]) -> Self {
        let [a, b] = frequencies.map(|f| 2.0 * std::f64::consts::PI * f);
        let stiffness = 2.0 * (ratios[1] * b - ratios[0] * a) / (b * b - a * a);
        Self {
            mass: 2.0 * ratios[0] * a - stiffness * a * a,
            stiffness,
        }
    }

    /// Whether both are finite and none drives.
    pub(crate) fn is_sound(&self) -> bool {
        let sound = |value: f64| value.is_finite() && value >= 0.0;
        sound(self.mass) && sound(self.stiffness)
    }
}
