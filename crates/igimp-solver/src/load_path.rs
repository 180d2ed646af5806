//! From a load factor to the conditions of a step.

use igimp_assembly::{AssemblyError, StepConditions};

/// What holds between two load factors. Closures are load paths.
pub trait LoadPath<const D: usize> {
    /// Grid, constraints, loads and laws of the step from load factor `from` to `to`.
    ///
    /// # Errors
    /// [`AssemblyError`] when the conditions cannot be stated.
    fn conditions(&self, from: f64, to: f64) -> Result<StepConditions<D>, AssemblyError>;
}
