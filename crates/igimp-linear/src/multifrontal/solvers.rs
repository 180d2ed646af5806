//! The multifrontal solvers to choose from: by LU and by Cholesky.

use std::sync::Arc;

use super::super::{Accuracy, LinearSolver, LinearSolverError, SolveReport};
use super::cholesky::Cholesky;
use super::engine::Engine;
use super::lu::Lu;
use super::tree::plan::Plan;
use crate::{Pattern, TangentMatrix};

/// Multifrontal LU for structurally symmetric patterns.
#[derive(Default)]
pub struct MultifrontalLu(Engine);

/// Multifrontal Cholesky factorisation for symmetric positive definite matrices, and for quasi-definite ones with scalars; reads one
/// entry of each symmetric pair only.
#[derive(Default)]
pub struct MultifrontalCholesky(Engine);

impl MultifrontalLu {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self(Engine::with_accuracy(accuracy))
    }

    /// Number of entries of the factors L and U of the pattern analysed last, zero before.
    pub fn factor_entries(&self) -> usize {
        self.0.entries::<Lu>()
    }

    /// Number of floating-point operations of a factorisation of the pattern analysed last.
    pub fn factor_operations(&self) -> f64 {
        self.0.plan.as_ref().map_or(0.0, Plan::operations)
    }
}

impl MultifrontalCholesky {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self(Engine::with_accuracy(accuracy))
    }

    /// Number of stored entries of the factor L of the pattern analysed last, zero before: its diagonal
    /// blocks are stored as squares.
    pub fn factor_entries(&self) -> usize {
        self.0.entries::<Cholesky>()
    }

    /// Number of floating-point operations of a factorisation of the pattern analysed last.
    pub fn factor_operations(&self) -> f64 {
        0.5 * self.0.plan.as_ref().map_or(0.0, Plan::operations)
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
        self.0.factor_lu(matrix)
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        self.0.solve(matrix, rhs, solution)
    }

    fn analyses(&self) -> usize {
        self.0.analyses
    }

    fn ask_for(&mut self, relative_residual: f64) {
        self.0.ask_for(relative_residual);
    }
}

impl LinearSolver for MultifrontalCholesky {
    fn name(&self) -> &'static str {
        "multifrontal-llt"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        self.0.analyse(pattern)
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        if matrix.symmetric {
            self.0.factor_cholesky(matrix)
        } else {
            Err(LinearSolverError::NotSymmetric)
        }
    }

    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        self.0.solve(matrix, rhs, solution)
    }

    fn analyses(&self) -> usize {
        self.0.analyses
    }

    fn ask_for(&mut self, relative_residual: f64) {
        self.0.ask_for(relative_residual);
    }
}
