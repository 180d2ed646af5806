//! Iteration with a geometric multigrid as preconditioner, for one matrix after the other.

use std::sync::Arc;

use igimp_assembly::{Pattern, TangentMatrix};

use super::super::refine::max_norm;
use super::super::{LinearSolverError, SolveReport, check};
use super::hierarchy::{self, Preconditioner};
use super::krylov::{Iterated, Operators, conjugate_gradients, minimal_residuals, norm};
use super::product::Product;
use super::skin::Skin;

/// Vectors between restarts of generalised minimal residuals.
const RESTART: usize = 100;

/// A new start from the true residual must leave less than this of it.
const PROGRESS: f64 = 0.5;

/// Grids and values of the matrix at hand.
#[derive(Default)]
pub(in crate::linear) struct Iteration {
    pattern: Option<Arc<Pattern>>,
    grids: Option<Box<dyn Preconditioner>>,
    skin: Skin,
    product: Product,
    residual: Vec<f64>,
    change: Vec<f64>,
}

/// What an iterative solution must come to.
#[derive(Clone, Copy, Debug)]
pub(in crate::linear) struct Demand {
    /// ‖b − K x‖ / ‖b‖ at which the iteration stops \[-\].
    pub(in crate::linear) target: f64,
    /// The same of a solution that is handed out where it stops before \[-\].
    pub(in crate::linear) tolerance: f64,
    /// Largest number of iterations.
    pub(in crate::linear) most: usize,
}

impl Iteration {
    /// Makes the grids of a pattern, unless they are there. Whether there is more than one.
    pub(in crate::linear) fn analyse(
        &mut self,
        pattern: &Arc<Pattern>,
    ) -> Result<bool, LinearSolverError> {
        if !check::same_pattern(self.pattern.as_ref(), pattern) {
            self.grids = None;
            self.grids = Some(hierarchy::new(pattern)?);
            self.pattern = Some(Arc::clone(pattern));
        }
        Ok(self.grids.as_ref().is_some_and(|grids| grids.levels() > 1))
    }

    /// Takes over the values of a matrix whose pattern was analysed.
    pub(in crate::linear) fn set(&mut self, matrix: &TangentMatrix, diagonal: &[f64]) {
        if let Some(grids) = &mut self.grids {
            grids.set(matrix, diagonal);
        }
        self.skin.set(matrix, diagonal);
    }

    /// Solves K x = b. The residual that counts is computed from the matrix itself, in the end and after every
    /// restart.
    pub(in crate::linear) fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
        demand: &Demand,
    ) -> Result<SolveReport, LinearSolverError> {
        let unknowns = matrix.pattern.unknowns();
        let Some(grids) = self.grids.as_deref_mut() else {
            return Err(LinearSolverError::NotFactored);
        };
        check::length("the matrix", unknowns, grids.unknowns())?;
        check::length("the right-hand side", rhs.len(), unknowns)?;
        check::length("the solution", solution.len(), unknowns)?;
        check::finite("right-hand side", rhs)?;
        solution.fill(0.0);
        let (scale, largest) = (norm(rhs), max_norm(rhs));
        let mut by_gradients = matrix.symmetric && !self.skin.is_indefinite;
        let mut report = SolveReport::new(method(by_gradients), 0.0, 0);
        if largest == 0.0 {
            return Ok(report);
        }
        let Self {
            product,
            residual,
            change,
            skin,
            ..
        } = self;
        residual.clear();
        residual.extend_from_slice(rhs);
        change.resize(unknowns, 0.0);
        let mut operators = Both {
            matrix,
            product,
            grids,
            skin,
            rest: Vec::new(),
        };
        let mut reached = 1.0;
        while reached > demand.target && report.refinements < demand.most {
            let goal = 0.9 * demand.target / reached;
            let left = demand.most - report.refinements;
            let Iterated {
                iterations, broken, ..
            } = if by_gradients {
                conjugate_gradients(&mut operators, residual, change, goal, left)
            } else {
                minimal_residuals(&mut operators, residual, change, (goal, left), RESTART)
            };
            report.refinements += iterations;
            for (x, change) in solution.iter_mut().zip(&*change) {
                *x += change;
            }
            operators.multiply(solution, residual);
            for (residual, rhs) in residual.iter_mut().zip(rhs) {
                *residual = rhs - *residual;
            }
            let before = std::mem::replace(&mut reached, norm(residual) / scale);
            // Written so that what is not a number is no progress.
            let progress = reached <= PROGRESS * before;
            if !progress && reached >= before {
                // What made it worse is taken back.
                for (x, change) in solution.iter_mut().zip(&*change) {
                    *x -= change;
                }
                operators.multiply(solution, residual);
                for (residual, rhs) in residual.iter_mut().zip(rhs) {
                    *residual = rhs - *residual;
                }
                reached = norm(residual) / scale;
            }
            if broken && by_gradients {
                by_gradients = false;
                report.method = method(by_gradients);
            } else if !progress {
                break;
            }
        }
        report.relative_residual = max_norm(residual) / largest;
        // Written so that what is not a number does not pass.
        if reached <= demand.target.max(demand.tolerance) {
            check::finite("solution", solution)?;
            Ok(report)
        } else {
            Err(LinearSolverError::NotConverged {
                iterations: report.refinements,
                relative_residual: reached,
                tolerance: demand.target.max(demand.tolerance),
                factor_bytes: 0,
            })
        }
    }
}

/// Name of the method.
fn method(by_gradients: bool) -> &'static str {
    if by_gradients {
        "multigrid-cg"
    } else {
        "multigrid-gmres"
    }
}

struct Both<'a> {
    matrix: &'a TangentMatrix,
    product: &'a mut Product,
    grids: &'a mut dyn Preconditioner,
    skin: &'a mut Skin,
    /// What the skin leaves of a residual.
    rest: Vec<f64>,
}

impl Operators for Both<'_> {
    fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        self.product.multiply(self.matrix, x, y);
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) {
        if !self.skin.is_there() {
            self.grids.apply(r, z);
            return;
        }
        self.rest.clear();
        self.rest.extend_from_slice(r);
        self.skin.before(self.matrix, &mut self.rest);
        self.grids.apply(&self.rest, z);
        self.skin.add(self.matrix, z);
        if self.matrix.symmetric {
            self.skin.after(self.matrix, r, z);
        }
    }
}
