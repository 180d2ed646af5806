//! The input of a march: conditions of its steps by the load factor, and when Newton's method stops.

use igimp_assembly::{AssemblyError, OutOfBalance, StepConditions};

/// The conditions between two load factors. Closures are load paths.
pub trait LoadPath<const D: usize> {
    /// Grid, constraints, loads and laws of the step from load factor `from` to `to`.
    ///
    /// # Errors
    /// [`AssemblyError`] when the conditions cannot be stated.
    fn conditions(&self, from: f64, to: f64) -> Result<StepConditions<D>, AssemblyError>;

    /// The longest step that may begin at load factor `at`, where the durations of steps are chosen, in load factor \[-\].
    fn longest_step(&self, _at: f64) -> f64 {
        f64::INFINITY
    }
}

/// When a step counts as converged, and when it is given up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// Accepted ‖f_ext − f_int‖ / (‖f_ext‖ + ‖f_react‖) \[-\].
    pub tolerance: f64,
    /// Largest number of corrections.
    pub max_iterations: usize,
    /// A residual this many times the smallest one so far counts as divergence \[-\].
    pub divergence: f64,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            max_iterations: 25,
            divergence: 1e4,
        }
    }
}

/// Whether a residual meets the tolerance, or is nothing but round-off; one that is not a number
/// does neither.
pub(crate) fn converged(residual: &OutOfBalance, tolerance: f64) -> bool {
    residual.relative_norm <= tolerance || residual.is_round_off
}
