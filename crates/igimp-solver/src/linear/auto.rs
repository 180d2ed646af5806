//! The default: Cholesky for symmetric matrices, multifrontal LU for the others.
//!
//! Near collapse a symmetric tangent can lose positive definiteness; the matrix then goes to LU.

use std::sync::Arc;

use igimp_assembly::{Pattern, TangentMatrix};

use super::{
    Accuracy, FaerCholesky, LinearSolver, LinearSolverError, MultifrontalLu, SolveReport, check,
};

/// Chooses the solver by the symmetry and the definiteness of the matrix.
#[derive(Default)]
pub struct AutoSolver {
    cholesky: FaerCholesky,
    lu: MultifrontalLu,
    pattern: Option<Arc<Pattern>>,
    analyses: usize,
    chosen: Option<Method>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Method {
    Cholesky,
    Lu,
}

impl AutoSolver {
    /// A solver with other demands on the residual than the default.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self {
            cholesky: FaerCholesky::with_accuracy(accuracy),
            lu: MultifrontalLu::with_accuracy(accuracy),
            ..Self::default()
        }
    }
}

impl LinearSolver for AutoSolver {
    fn name(&self) -> &'static str {
        "auto"
    }

    /// Checks the pattern; which symbolic work it needs shows only with the matrix.
    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        if !check::same_pattern(self.pattern.as_ref(), pattern) {
            check::valid_pattern(pattern)?;
            self.pattern = Some(Arc::clone(pattern));
            self.analyses += 1;
            self.chosen = None;
        }
        Ok(())
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.analyse(&matrix.pattern)?;
        self.chosen = None;
        let method = if matrix.symmetric {
            match self.cholesky.factor(matrix) {
                Ok(()) => Method::Cholesky,
                Err(LinearSolverError::NotPositiveDefinite { .. }) => Method::Lu,
                Err(error) => return Err(error),
            }
        } else {
            Method::Lu
        };
        if method == Method::Lu {
            self.lu.factor(matrix)?;
        }
        self.chosen = Some(method);
        Ok(())
    }

    fn solve(
        &mut self,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        match self.chosen {
            Some(Method::Cholesky) => self.cholesky.solve(rhs, solution),
            Some(Method::Lu) => self.lu.solve(rhs, solution),
            None => Err(LinearSolverError::NotFactored),
        }
    }

    fn analyses(&self) -> usize {
        self.analyses
    }
}
