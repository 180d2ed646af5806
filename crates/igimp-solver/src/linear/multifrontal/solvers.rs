//! The multifrontal solvers to choose from: by LU, by Cholesky, and by what fits the matrix.

use std::sync::Arc;

use igimp_assembly::{Pattern, TangentMatrix};

use super::super::{Accuracy, LinearSolver, LinearSolverError, SolveReport};
use super::engine::Engine;
use super::kernel::Kernel;
use super::plan::Plan;
use super::{cholesky::Cholesky, lu::Lu};

/// Multifrontal LU for structurally symmetric patterns.
#[derive(Default)]
pub struct MultifrontalLu(Engine);

/// Multifrontal Cholesky factorisation for symmetric positive definite matrices; reads one entry of
/// each symmetric pair only.
#[derive(Default)]
pub struct MultifrontalCholesky(Engine);

/// The default: Cholesky for symmetric matrices, LU for the others.
///
/// Near collapse a symmetric tangent can lose positive definiteness; the matrix then goes to LU. Both
/// share plan and memory.
#[derive(Default)]
pub struct AutoSolver(Engine);

impl MultifrontalLu {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self(Engine::with_accuracy(accuracy))
    }

    /// Number of entries of the factors L and U of the pattern analysed last, zero before.
    pub fn factor_entries(&self) -> usize {
        entries::<Lu>(&self.0)
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
        entries::<Cholesky>(&self.0)
    }

    /// Number of floating-point operations of a factorisation of the pattern analysed last.
    pub fn factor_operations(&self) -> f64 {
        0.5 * self.0.plan.as_ref().map_or(0.0, Plan::operations)
    }
}

impl AutoSolver {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self(Engine::with_accuracy(accuracy))
    }
}

fn entries<K: Kernel>(engine: &Engine) -> usize {
    let tasks = engine.plan.iter().flat_map(|plan| &plan.tasks);
    tasks.map(|task| K::entries(&task.total)).sum()
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
}

impl LinearSolver for AutoSolver {
    fn name(&self) -> &'static str {
        "auto"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        self.0.analyse(pattern)
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        if !matrix.symmetric {
            return self.0.factor_lu(matrix);
        }
        match self.0.factor_cholesky(matrix) {
            Err(LinearSolverError::NotPositiveDefinite { .. }) => self.0.factor_lu(matrix),
            other => other,
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
}
