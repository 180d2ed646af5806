//! General systems: the stabilised bi-conjugate gradients of `sprs`, scaled by the diagonal.
//!
//! H. A. van der Vorst, *Bi-CGSTAB*, SIAM J. Sci. Stat. Comput. 13 (1992). An independent second
//! to [`crate::MultifrontalLu`] that shares no idea with it; slow on ill-conditioned matrices, as
//! its only preconditioner is the scaling.

use std::sync::Arc;

use sprs::linalg::bicgstab::BiCGSTAB;
use sprs::{CsMat, CsVec};

use crate::check::{self, Inspection};
use crate::refine::{max_norm, relative_residual_of};
use crate::{
    Accuracy, CompressedColumns, LinearSolver, LinearSolverError, Pattern, SolveReport,
    TangentMatrix,
};

/// Iterations without a smaller residual after which the method is stopped.
const PATIENCE: usize = 500;

/// Stabilised bi-conjugate gradients for any matrix; `solve` does all the work.
pub struct SprsBiCgStab {
    accuracy: Accuracy,
    max_iterations: usize,
    analyses: usize,
    pattern: Option<Arc<Pattern>>,
    inspection: Inspection,
    system: Option<Scaled>,
}

/// The matrix S K S with unit diagonal magnitudes where K has a diagonal.
struct Scaled {
    matrix: CsMat<f64>,
    scale: Vec<f64>,
}

impl Default for SprsBiCgStab {
    fn default() -> Self {
        Self::with_accuracy(Accuracy::default())
    }
}

impl SprsBiCgStab {
    /// A solver with other demands on the residual than the default; at most 20 000 iterations.
    pub fn with_accuracy(accuracy: Accuracy) -> Self {
        Self {
            accuracy,
            max_iterations: 20_000,
            analyses: 0,
            pattern: None,
            inspection: Inspection::default(),
            system: None,
        }
    }
}

impl LinearSolver for SprsBiCgStab {
    fn name(&self) -> &'static str {
        "sprs-bicgstab"
    }

    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError> {
        if !check::same_pattern(self.pattern.as_ref(), pattern) {
            self.system = None;
            check::valid_pattern(pattern)?;
            self.pattern = Some(Arc::clone(pattern));
            self.analyses += 1;
        }
        Ok(())
    }

    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        self.analyse(&matrix.pattern)?;
        self.system = None;
        self.inspection.inspect(matrix)?;
        self.system = Some(Scaled::new(matrix, &self.inspection.diagonal));
        Ok(())
    }

    /// As for every solver; a matrix that is singular shows as [`LinearSolverError::Inaccurate`].
    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError> {
        let Some(Scaled {
            matrix: scaled,
            scale,
        }) = &self.system
        else {
            return Err(LinearSolverError::NotFactored);
        };
        check::length("the matrix", matrix.pattern.unknowns(), scale.len())?;
        check::length("the right-hand side", rhs.len(), scale.len())?;
        check::length("the solution", solution.len(), scale.len())?;
        check::finite("right-hand side", rhs)?;
        solution.fill(0.0);
        let size = max_norm(rhs);
        let mut report = SolveReport::new(self.name(), 0.0, 0);
        if size == 0.0 {
            return Ok(report);
        }

        // Restarted from the best solution while the true residual falls: the recurrences of the
        // method drift, and its own restarts stop at the tolerance on the scaled residual.
        let mut residual = rhs.to_vec();
        let mut candidate = vec![0.0; rhs.len()];
        report.relative_residual = 1.0;
        while report.relative_residual > self.accuracy.target
            && report.refinements < self.max_iterations
        {
            let right: Vec<f64> = residual.iter().zip(scale).map(|(r, s)| r * s).collect();
            let goal = 0.1 * self.accuracy.target * size / max_norm(&residual) * norm(&right);
            let (step, iterations) = iterate(
                scaled,
                &right,
                goal,
                self.max_iterations - report.refinements,
            );
            report.refinements += iterations;
            for (index, candidate) in candidate.iter_mut().enumerate() {
                *candidate = solution[index] + step[index] * scale[index];
            }
            let reached = relative_residual_of(matrix, rhs, &candidate, &mut residual, size);
            let halved = reached <= 0.5 * report.relative_residual;
            if reached < report.relative_residual {
                solution.copy_from_slice(&candidate);
                report.relative_residual = reached;
            }
            if !halved {
                break;
            }
        }
        let (relative_residual, tolerance) = (report.relative_residual, self.accuracy.tolerance);
        if relative_residual <= tolerance {
            Ok(report)
        } else {
            Err(LinearSolverError::Inaccurate {
                relative_residual,
                tolerance,
            })
        }
    }

    fn analyses(&self) -> usize {
        self.analyses
    }
}

impl Scaled {
    fn new(matrix: &TangentMatrix, diagonal: &[f64]) -> Self {
        let CompressedColumns { col_ptr, row_idx } = matrix.pattern.compressed_columns();
        let unknowns = diagonal.len();
        let unit = |&diagonal: &f64| {
            if diagonal == 0.0 {
                1.0
            } else {
                1.0 / diagonal.abs().sqrt()
            }
        };
        let scale: Vec<f64> = diagonal.iter().map(unit).collect();
        let mut values = matrix.values.clone();
        for column in 0..unknowns {
            for entry in col_ptr[column]..col_ptr[column + 1] {
                values[entry] *= scale[row_idx[entry]] * scale[column];
            }
        }
        let shape = (unknowns, unknowns);
        let matrix = CsMat::new_csc(shape, col_ptr, row_idx, values);
        Self {
            matrix: matrix.to_csr(),
            scale,
        }
    }
}

/// Iterates from zero until the residual norm is below `goal` or nothing moves any more; returns
/// the solution and the number of iterations.
fn iterate(
    matrix: &CsMat<f64>,
    rhs: &[f64],
    goal: f64,
    max_iterations: usize,
) -> (Vec<f64>, usize) {
    let dense =
        |values: &[f64]| CsVec::new(values.len(), (0..values.len()).collect(), values.to_vec());
    let right = dense(rhs);
    let start = dense(&vec![0.0; rhs.len()]);
    let mut solver = BiCGSTAB::<f64, usize, usize>::new(matrix.view(), start.view(), right.view());
    let mut best = start.clone();
    let (mut best_error, mut best_at) = (norm(rhs), 0);
    while solver.iteration_count() < max_iterations.min(best_at + PATIENCE) && best_error > goal {
        let (x, p, rho) = (solver.x().to_owned(), solver.p().to_owned(), solver.rho());
        let error = solver.step();
        if !solver.x().data().iter().all(|x| x.is_finite()) {
            // The first half of the step hit the solution and the second divided zero by zero.
            let alpha = rho / solver.rhat().dot(&(matrix * &p));
            if alpha.is_finite() {
                best = &x + &p.map(|p| p * alpha);
            }
            break;
        }
        if error < best_error {
            (best_error, best_at) = (error, solver.iteration_count());
            best = solver.x().to_owned();
        }
    }
    let mut solution = vec![0.0; rhs.len()];
    best.scatter(&mut solution);
    (solution, solver.iteration_count())
}

/// Euclidean norm.
fn norm(values: &[f64]) -> f64 {
    let largest = max_norm(values);
    if largest == 0.0 {
        return 0.0;
    }
    values
        .iter()
        .map(|value| (value / largest).powi(2))
        .sum::<f64>()
        .sqrt()
        * largest
}
