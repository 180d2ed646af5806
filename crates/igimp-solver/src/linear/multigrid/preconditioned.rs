//! Iteration with a preconditioner, from restart to restart.
//!
//! The preconditioner may be what it likes and in single precision: matrix, residual and iterates are in double precision
//! (N. J. Higham & T. Mary, *Mixed precision algorithms in numerical linear algebra*, Acta Numerica 31 (2022), section 5). The residual
//! that counts is computed from the matrix itself, in the end and after every restart.

use igimp_assembly::TangentMatrix;

use super::super::refine::max_norm;
use super::super::{LinearSolverError, SolveReport, check};
use super::krylov::{Operators, conjugate_gradients, minimal_residuals, norm};
use super::product::Product;

/// Vectors between restarts of generalised minimal residuals.
const RESTART: usize = 300;

/// A new start from the true residual must leave less than this of it.
const PROGRESS: f64 = 0.5;

/// What an iterative solution must come to.
#[derive(Clone, Copy, Debug)]
pub(in crate::linear) struct Demand {
    /// ‖b − K x‖ / ‖b‖ at which the iteration stops \[-\].
    pub(in crate::linear) target: f64,
    /// The same of a solution that is handed out where it stops before \[-\].
    pub(in crate::linear) tolerance: f64,
    /// Iterations after which that is all that is wanted.
    pub(in crate::linear) patience: usize,
    /// Largest number of iterations.
    pub(in crate::linear) most: usize,
}

/// Which iteration it is.
#[derive(Clone, Copy, Debug)]
pub(in crate::linear) struct Method {
    /// Conjugate gradients, as long as matrix and preconditioner turn out positive definite; else generalised minimal residuals.
    pub(in crate::linear) by_gradients: bool,
    /// What the two are called.
    pub(in crate::linear) names: [&'static str; 2],
}

/// Vectors and sums, kept from solution to solution.
#[derive(Default)]
pub(in crate::linear) struct Preconditioned {
    product: Product,
    residual: Vec<f64>,
    change: Vec<f64>,
}

impl Preconditioned {
    /// Solves K x = b with `precondition`, which makes z ≈ K⁻¹ r of r. The error of one that did not converge leaves open what
    /// factors would take.
    pub(in crate::linear) fn solve(
        &mut self,
        (matrix, rhs): (&TangentMatrix, &[f64]),
        solution: &mut [f64],
        demand: &Demand,
        method: Method,
        precondition: &mut dyn FnMut(&[f64], &mut [f64]),
    ) -> Result<SolveReport, LinearSolverError> {
        let unknowns = matrix.pattern.unknowns();
        check::length("the right-hand side", rhs.len(), unknowns)?;
        check::length("the solution", solution.len(), unknowns)?;
        check::finite("right-hand side", rhs)?;
        solution.fill(0.0);
        let (scale, largest) = (norm(rhs), max_norm(rhs));
        let Method {
            mut by_gradients,
            names: [gradients, residuals],
        } = method;
        let name = if by_gradients { gradients } else { residuals };
        let mut report = SolveReport::new(name, 0.0, 0);
        if largest == 0.0 {
            return Ok(report);
        }
        let Self {
            product,
            residual,
            change,
        } = self;
        residual.clear();
        residual.extend_from_slice(rhs);
        change.resize(unknowns, 0.0);
        let mut both = Both {
            matrix,
            product,
            precondition,
        };
        let (mut reached, mut patience) = (1.0, demand.patience);
        loop {
            let is_patient = report.refinements < patience;
            let (wanted, most) = if is_patient {
                (demand.target, patience.min(demand.most))
            } else {
                (demand.target.max(demand.tolerance), demand.most)
            };
            // Written so that what is not a number goes no further.
            if !(reached > wanted && report.refinements < most) {
                break;
            }
            let goal = 0.9 * wanted / reached;
            let left = most - report.refinements;
            let done = if by_gradients {
                conjugate_gradients(&mut both, residual, change, goal, left)
            } else {
                minimal_residuals(&mut both, residual, change, (goal, left), RESTART)
            };
            report.refinements += done.iterations;
            for (x, change) in solution.iter_mut().zip(&*change) {
                *x += change;
            }
            both.residual(rhs, solution, residual);
            let before = std::mem::replace(&mut reached, norm(residual) / scale);
            // Written so that what is not a number is no progress.
            let progress = reached <= PROGRESS * before;
            if !progress && reached >= before {
                // What made it worse is taken back.
                for (x, change) in solution.iter_mut().zip(&*change) {
                    *x -= change;
                }
                both.residual(rhs, solution, residual);
                reached = norm(residual) / scale;
            }
            if done.broken && by_gradients {
                by_gradients = false;
                report.method = residuals;
            } else if !progress && is_patient && patience < demand.most {
                patience = 0;
            } else if !progress {
                break;
            }
        }
        report.relative_residual = max_norm(residual) / largest;
        // Written so that what is not a number does not pass.
        if reached <= demand.target.max(demand.tolerance) {
            check::finite("solution", solution)?;
            return Ok(report);
        }
        Err(LinearSolverError::NotConverged {
            iterations: report.refinements,
            relative_residual: reached,
            tolerance: demand.target.max(demand.tolerance),
            factor_bytes: None,
        })
    }
}

/// A matrix and its preconditioner.
struct Both<'a> {
    matrix: &'a TangentMatrix,
    product: &'a mut Product,
    precondition: &'a mut dyn FnMut(&[f64], &mut [f64]),
}

impl Both<'_> {
    /// b − K x.
    fn residual(&mut self, rhs: &[f64], x: &[f64], residual: &mut [f64]) {
        self.product.multiply(self.matrix, x, residual);
        for (residual, rhs) in residual.iter_mut().zip(rhs) {
            *residual = rhs - *residual;
        }
    }
}

impl Operators for Both<'_> {
    fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        self.product.multiply(self.matrix, x, y);
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) {
        (self.precondition)(r, z);
    }
}
