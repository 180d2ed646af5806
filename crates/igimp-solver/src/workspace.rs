//! Memory that is kept from step to step.

use std::sync::Arc;

use igimp_assembly::Trial;
use igimp_linear::{LinearSolver, Pattern, TangentMatrix};

/// Data that last from step to step besides the body: the solver with its symbolic work, and the memory
/// of the matrix and of the trial. It holds nothing that a result depends on.
pub struct Workspace<const D: usize> {
    pub(crate) solver: Box<dyn LinearSolver>,
    pub(crate) matrix: Option<TangentMatrix>,
    pub(crate) trial: Trial<D>,
    pub(crate) du: Vec<f64>,
}

impl<const D: usize> std::fmt::Debug for Workspace<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Workspace")
            .field("solver", &self.solver.name())
            .finish_non_exhaustive()
    }
}

impl<const D: usize> Workspace<D> {
    /// A workspace around a linear solver.
    pub fn new(solver: Box<dyn LinearSolver>) -> Self {
        Self {
            solver,
            matrix: None,
            trial: Trial::default(),
            du: Vec::new(),
        }
    }

    pub(crate) fn pattern(&self) -> Option<&Arc<Pattern>> {
        self.matrix.as_ref().map(|matrix| &matrix.pattern)
    }
}
