//! How an undrained strength goes with the direction of stress and with the rate of strain (theory, eqs. 120 to 125).

use crate::MaterialError;
use crate::error::positive;
use crate::spectral::principal::{Principal, Tensor};

/// Angle of soil whose stress has no direction: that of simple shear \[rad\].
pub(super) const NO_DIRECTION: f64 = std::f64::consts::FRAC_PI_4;

/// Share of the stresses of a point below which a difference of principal stresses has no direction \[-\].
const LEAST_DIFFERENCE: f64 = 1e-9;

/// Undrained strengths by the direction of the major principal compression, as shares of the active one.
///
/// In the plane of $`(\sigma_h - \sigma_v)/2`$ and $`\tau_{vh}`$ the strengths of all directions lie on an ellipse (Davis and
/// Christian 1971) through those of active loading, simple shear and passive loading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directions {
    /// Strength where the major compression is at 45° to the vertical, over the active one \[-\]. Positive.
    pub simple_shear: f64,
    /// Strength where the major compression is level, over the active one, where it is upright \[-\]. Positive.
    pub passive: f64,
}

/// How an undrained strength grows with the rate of shear strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateEffect {
    /// Growth of the strength for a rate ten times as great \[-\], such as 0.1. Positive.
    pub per_log_cycle: f64,
    /// Rate of plastic shear strain at and below which the strength is that stated \[1/time\]. Positive.
    pub reference: f64,
}

impl Directions {
    pub(super) fn check(&self) -> Result<(), MaterialError> {
        positive("simple_shear", self.simple_shear)?;
        positive("passive", self.passive)
    }

    /// Half the difference of active and passive strength: the centre of the ellipse \[-\].
    fn centre(&self) -> f64 {
        0.5 * (1.0 - self.passive)
    }

    /// The strength where the major compression is at an angle to the vertical \[rad\], over the active one \[-\].
    pub fn share(&self, angle: f64) -> f64 {
        let cosine = (2.0 * angle).cos();
        let flatness = self.passive / (self.simple_shear * self.simple_shear);
        let along = self.centre() * cosine;
        // 1 to the bit where all three are 1.
        let square = 1.0 + (flatness - 1.0) * (1.0 - cosine * cosine);
        (along + (along * along + square * self.passive).sqrt()) / square
    }

    /// A share that none is above \[-\].
    pub(super) fn greatest(&self) -> f64 {
        let level = 0.5 * (1.0 + self.passive);
        let shear = self.simple_shear * level / self.passive.sqrt();
        self.centre().abs() + level.max(shear)
    }
}

/// The angle between the vertical and the axis of the major principal compression \[rad\], from 0 to π/2; none of a stress `tau`
/// whose principal values differ by nothing beside `scale`.
///
/// `axes` are those that are looked at, rows of the frame: in plane strain the two in the plane.
pub(super) fn angle_of_compression(
    tau: &Principal,
    frame: &Tensor,
    (axes, vertical): (usize, usize),
    scale: f64,
) -> Option<f64> {
    let least = (0..axes).min_by(|&a, &b| tau[a].total_cmp(&tau[b]))?;
    let most = tau[..axes]
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    if most - tau[least] <= LEAST_DIFFERENCE * scale {
        return None;
    }
    let axis = frame[least];
    let level = (0..3).filter(|&i| i != vertical);
    let level = level
        .map(|i| axis[i] * axis[i])
        .fold(0.0, |sum, square| sum + square);
    Some(level.sqrt().atan2(axis[vertical].abs()))
}

impl RateEffect {
    pub(super) fn check(&self) -> Result<(), MaterialError> {
        positive("per_log_cycle", self.per_log_cycle)?;
        positive("reference", self.reference)
    }

    /// The plastic strain of a step of a duration \[time\] just beyond which strength begins to grow \[-\]; infinite without time.
    pub(super) fn threshold(&self, duration: f64) -> f64 {
        if duration > 0.0 {
            duration * self.reference / 3.0_f64.sqrt() * (1.0 + 1e-9)
        } else {
            f64::INFINITY
        }
    }

    /// The strength over that at the reference rate, where a step of a duration \[time\] adds the plastic strain κ \[-\], and its
    /// derivative by κ. Shear in the plane by γ has κ = γ/√3.
    pub(super) fn at(&self, kappa: f64, duration: f64) -> [f64; 2] {
        let over = 3.0_f64.sqrt() * kappa / (duration * self.reference);
        if duration > 0.0 && over > 1.0 {
            let slope = self.per_log_cycle / std::f64::consts::LN_10;
            [1.0 + self.per_log_cycle * over.log10(), slope / kappa]
        } else {
            [1.0, 0.0]
        }
    }
}

/// The direction and rate that strength goes with, in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// Share of the direction of stress \[-\].
    pub(super) share: f64,
    /// Rate effect with the duration of the step, if time passes.
    pub(super) rate: Option<(RateEffect, f64)>,
    /// Plastic strain of the step \[-\].
    pub(super) step: f64,
    /// Strains that the law is asked at over those of the soil \[-\].
    pub(super) strain_ratio: f64,
}

impl Moment {
    /// Strength as its curve says.
    pub(super) const AT_REST: Self = Self {
        share: 1.0,
        rate: None,
        step: 0.0,
        strain_ratio: 1.0,
    };

    /// A strength and its derivative by plastic strain, from those of its curve.
    pub(super) fn of(&self, [strength, slope]: [f64; 2]) -> [f64; 2] {
        let [factor, growth] = match self.rate {
            Some((rate, duration)) => rate.at(self.step, duration),
            None => [1.0, 0.0],
        };
        [
            self.share * strength * factor,
            self.share * (slope * factor + strength * growth),
        ]
    }
}
