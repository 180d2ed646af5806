//! Multifrontal LU (being built): stands in with the general LU.
use super::{Accuracy, GeneralLu, LinearSolver, LinearSolverError, SolveReport};
use igimp_assembly::{Pattern, TangentMatrix};
use std::sync::Arc;

/// LU for structurally symmetric patterns.
#[derive(Default)]
pub struct MultifrontalLu(GeneralLu);

impl MultifrontalLu {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self(GeneralLu::with_accuracy(accuracy))
    }
}

impl LinearSolver for MultifrontalLu {
    fn name(&self) -> &'static str {
        "multifrontal-lu"
    }
    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        self.0.analyse(pattern)
    }
    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.0.factor(matrix)
    }
    fn solve(&mut self, rhs: &[f64], solution: &mut [f64]) -> Result<SolveReport, LinearSolverError> {
        self.0.solve(rhs, solution)
    }
    fn analyses(&self) -> usize {
        self.0.analyses()
    }
}
