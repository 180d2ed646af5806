//! Iteration with a preconditioner that is given from outside, such as factors in single precision.
//!
//! N. J. Higham & T. Mary, *Mixed precision algorithms in numerical linear algebra*, Acta Numerica 31 (2022), section 5: the
//! matrix, the residual and the iterates are in double precision.

use igimp_assembly::TangentMatrix;

use super::super::refine::max_norm;
use super::super::{LinearSolverError, SolveReport, check};
use super::krylov::{Operators, conjugate_gradients, minimal_residuals, norm};
use super::product::Product;
use super::solver::Demand;

/// Vectors between restarts of generalised minimal residuals.
const RESTART: usize = 30;

/// A new start from the true residual must leave less than this of it.
const PROGRESS: f64 = 0.5;

/// Vectors and sums, kept from solution to solution.
#[derive(Default)]
pub(in crate::linear) struct Preconditioned {
    product: Product,
    residual: Vec<f64>,
    change: Vec<f64>,
}

impl Preconditioned {
    /// Solves K x = b with `precondition`, which makes z ≈ K⁻¹ r of r: by conjugate gradients where K is symmetric, by generalised
    /// minimal residuals otherwise. `names` are those of the two.
    pub(in crate::linear) fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
        demand: &Demand,
        names: [&'static str; 2],
        precondition: &mut dyn FnMut(&[f64], &mut [f64]),
    ) -> Result<SolveReport, LinearSolverError> {
        let unknowns = matrix.pattern.unknowns();
        check::length("the right-hand side", rhs.len(), unknowns)?;
        check::length("the solution", solution.len(), unknowns)?;
        check::finite("right-hand side", rhs)?;
        solution.fill(0.0);
        let (scale, largest) = (norm(rhs), max_norm(rhs));
        let mut by_gradients = matrix.symmetric;
        let mut report = SolveReport::new(names[usize::from(!by_gradients)], 0.0, 0);
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
        let mut operators = Both {
            matrix,
            product,
            precondition,
        };
        let (mut reached, mut before) = (1.0, f64::INFINITY);
        // Written so that what is not a number is no progress.
        while reached > demand.target
            && report.refinements < demand.most
            && reached <= PROGRESS * before
        {
            let goal = 0.9 * demand.target / reached;
            let left = demand.most - report.refinements;
            let done = if by_gradients {
                conjugate_gradients(&mut operators, residual, change, goal, left)
            } else {
                minimal_residuals(&mut operators, residual, change, (goal, left), RESTART)
            };
            report.refinements += done.iterations;
            for (x, change) in solution.iter_mut().zip(&*change) {
                *x += change;
            }
            operators.multiply(solution, residual);
            for (residual, rhs) in residual.iter_mut().zip(rhs) {
                *residual = rhs - *residual;
            }
            before = std::mem::replace(&mut reached, norm(residual) / scale);
            if done.broken && by_gradients {
                by_gradients = false;
                report.method = names[1];
                before = f64::INFINITY;
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
            factor_bytes: 0,
        })
    }
}

struct Both<'a> {
    matrix: &'a TangentMatrix,
    product: &'a mut Product,
    precondition: &'a mut dyn FnMut(&[f64], &mut [f64]),
}

impl Operators for Both<'_> {
    fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        self.product.multiply(self.matrix, x, y);
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) {
        (self.precondition)(r, z);
    }
}
