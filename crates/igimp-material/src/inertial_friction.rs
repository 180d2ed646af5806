//! Friction of dry grains that grows with the speed of shear, μ(I) (theory, eqs. 129 to 129c; Jop, Forterre & Pouliquen 2006).

use std::f64::consts::FRAC_PI_2;

use crate::MaterialError;
use crate::error::{positive, required};

/// √3, shear strain of the plane over the plastic strain Δλ of the cone \[-\].
const SHEAR: f64 = 1.732_050_807_568_877_2;

/// How friction grows with the inertial number $`I = \dot\gamma\, d/\sqrt{P/\rho_s}`$, where P is the pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialFriction {
    /// Friction angle $`\varphi_2`$ of shear without end fast \[rad\], above φ of slow shear and below π/2.
    pub friction_angle: f64,
    /// $`I_0`$, at which half of the growth is reached \[-\]. Positive.
    pub inertial_number: f64,
    /// Diameter d of the grains \[length\]. Positive.
    pub grain_diameter: f64,
    /// Density $`\rho_s`$ of the grains, without pores \[mass/length³\]. Positive.
    pub grain_density: f64,
}

/// The cone where shear begins to grow it, at the pressure of its step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlowCone {
    /// $`q^{tr}`$ beyond the strength of slow shear \[stress\]. Positive.
    pub(crate) excess: f64,
    /// Strength q of slow shear, M P \[stress\]. Positive.
    pub(crate) strength: f64,
    /// Pressure P \[stress\]. Positive.
    pub(crate) pressure: f64,
    /// $`(M_2 - M)/M`$ \[-\].
    pub(crate) growth: f64,
    /// Fall of q with a plastic strain of one, 3 G \[stress\].
    pub(crate) stiffness: f64,
}

/// Plastic shear of a step, and strength at the end of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheared {
    /// Δλ \[-\].
    pub(crate) strain: f64,
    /// Strength over that of slow shear \[-\].
    pub(crate) factor: f64,
    /// Growth of the strength with Δλ \[stress\].
    pub(crate) by_strain: f64,
    /// Growth of the strength with the pressure, over M \[-\].
    pub(crate) by_pressure: f64,
}

impl Sheared {
    /// By a plastic strain \[-\] at the strength of slow shear.
    pub(crate) fn slowly(strain: f64) -> Self {
        Self {
            strain,
            factor: 1.0,
            by_strain: 0.0,
            by_pressure: 1.0,
        }
    }
}

impl InertialFriction {
    /// Refuses angles that are none above φ \[rad\] of slow shear, and numbers that are not positive.
    pub(crate) fn check(&self, slow: f64) -> Result<(), MaterialError> {
        let angle = self.friction_angle;
        let in_range = angle > slow && angle < FRAC_PI_2;
        let requirement = "above the friction angle of slow shear and less than pi/2";
        required("fast friction_angle", angle, in_range, requirement)?;
        positive("inertial_number", self.inertial_number)?;
        positive("grain_diameter", self.grain_diameter)?;
        positive("grain_density", self.grain_density)
    }

    /// That of grains whose tan φ is multiplied by a ratio \[-\].
    pub(crate) fn times(self, ratio: f64) -> Self {
        Self {
            friction_angle: (self.friction_angle.tan() * ratio).atan(),
            ..self
        }
    }

    /// The plastic strain $`x_0`$ of a step of a duration \[time\] at which half of the growth is reached, under a pressure
    /// \[stress\].
    fn half_way(&self, pressure: f64, duration: f64) -> f64 {
        let speed = (pressure / self.grain_density).sqrt();
        self.inertial_number * duration * speed / (SHEAR * self.grain_diameter)
    }

    /// The end of a step of a duration \[time\], positive: the positive root of eq. 129b.
    pub(crate) fn sheared(&self, cone: &SlowCone, duration: f64) -> Sheared {
        let SlowCone {
            excess,
            strength,
            growth,
            stiffness,
            ..
        } = *cone;
        let half_way = self.half_way(cone.pressure, duration);
        let linear = stiffness * half_way + growth * strength - excess;
        let root = linear.hypot(2.0 * (stiffness * excess * half_way).sqrt());
        // Of the two forms of the root that which loses no digits.
        let strain = if linear > 0.0 {
            2.0 * excess * half_way / (linear + root)
        } else {
            (root - linear) / (2.0 * stiffness)
        };
        let share = strain / (half_way + strain);
        let bend = growth * share * (1.0 - share);
        let factor = 1.0 + growth * share;
        Sheared {
            strain,
            factor,
            by_strain: strength * bend / strain,
            by_pressure: factor - 0.5 * bend,
        }
    }
}
