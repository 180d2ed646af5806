//! How a strength goes with plastic strain (theory, eq. 105).

use crate::MaterialError;
use crate::error::{positive, required};

/// The shape of a [`Curve`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decay {
    /// On a straight line, which ends at the strain of the curve.
    Linear,
    /// Exponentially: at the strain of the curve 63 % of the way is gone.
    Exponential,
}

/// A parameter of strength that goes from an initial to a residual value with plastic strain: it softens where that is less, and
/// hardens where it is more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Value of soil that was never sheared: a stress, or an angle \[rad\].
    pub initial: f64,
    /// Value of soil that was sheared far.
    pub residual: f64,
    /// Plastic strain κ of the way between them \[-\], positive.
    pub strain: f64,
    /// Shape of the way.
    pub decay: Decay,
}

impl Curve {
    /// A value that stays.
    pub const fn constant(value: f64) -> Self {
        Self {
            initial: value,
            residual: value,
            strain: 1.0,
            decay: Decay::Linear,
        }
    }

    /// Refuses a strain that is not positive, and values that are not finite.
    pub(super) fn check(&self, field: &'static str) -> Result<(), MaterialError> {
        positive("softening strain", self.strain)?;
        for value in [self.initial, self.residual] {
            required(field, value, value >= 0.0, "finite and not negative")?;
        }
        Ok(())
    }

    /// The curve of something that goes with the value.
    pub(super) fn map(self, put: impl Fn(f64) -> f64) -> Self {
        Self {
            initial: put(self.initial),
            residual: put(self.residual),
            ..self
        }
    }

    /// The larger of both ends.
    pub(super) fn greatest(&self) -> f64 {
        self.initial.max(self.residual)
    }

    /// The value at a plastic strain, and its derivative by that; below zero, where the over-nonlocal measure may be, the curve goes on
    /// along the line that it begins with.
    pub(super) fn at(&self, kappa: f64) -> [f64; 2] {
        let way = self.residual - self.initial;
        let share = kappa / self.strain;
        match self.decay {
            Decay::Linear if share < 1.0 => [self.initial + way * share, way / self.strain],
            Decay::Linear => [self.residual, 0.0],
            Decay::Exponential if share < 0.0 => [self.initial + way * share, way / self.strain],
            Decay::Exponential => {
                let left = (-share).exp();
                [self.residual - way * left, way * left / self.strain]
            }
        }
    }
}
