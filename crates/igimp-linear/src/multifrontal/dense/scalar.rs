//! The numbers that factors are stored in: double precision, or single for half of the memory.

use faer::traits::RealField;

/// A number of the factors.
pub(crate) trait Scalar: RealField + Copy + Default + 'static {
    /// Pivots below this part of the largest entry of the scaled matrix carry no correct digit.
    const LOST: Self;
    /// The substitute of a lost pivot: the square root of the machine epsilon, large enough to bound the
    /// growth and small enough for refinement to undo the error.
    const REPLACEMENT: Self;
    /// A pivot below this part of the diagonal entry that it is left from has lost all its digits to
    /// cancellation: the matrix is then singular to working precision.
    const LEAST_PIVOT: f64;

    /// The nearest one.
    fn near(value: f64) -> Self;

    /// The same in double precision.
    fn wide(self) -> f64;
}

impl Scalar for f64 {
    const LOST: Self = 1e-13;
    const REPLACEMENT: Self = 1.490_116_119_384_765_6e-8;
    const LEAST_PIVOT: f64 = 1e-13;

    fn near(value: f64) -> Self {
        value
    }

    fn wide(self) -> f64 {
        self
    }
}

impl Scalar for f32 {
    const LOST: Self = 1e-6;
    const REPLACEMENT: Self = 3.452_67e-4;
    const LEAST_PIVOT: f64 = 1e-7;

    fn near(value: f64) -> Self {
        value as Self
    }

    fn wide(self) -> f64 {
        f64::from(self)
    }
}
