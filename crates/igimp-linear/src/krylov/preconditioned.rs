//! Iteration with a preconditioner, from restart to restart.
//!
//! The preconditioner may be what it likes and in single precision: matrix, residual and iterates are in double precision
//! (N. J. Higham & T. Mary, *Mixed precision algorithms in numerical linear algebra*, Acta Numerica 31 (2022), section 5). The residual
//! that counts is computed from the matrix itself, in the end and after every restart.

use super::iterations::{Limits, Operators, conjugate_gradients, minimal_residuals, norm};
use super::product::Product;
use crate::bordered::{Elimination, add_border};
use crate::refine::max_norm;
use crate::{LinearSolverError, SolveReport, TangentMatrix, check};

/// Vectors between restarts of generalised minimal residuals.
const RESTART: usize = 300;

/// A new start from the true residual must leave less than this of it. A choice: what has met round-off leaves nearly all of it, and
/// another start costs a set of directions.
const PROGRESS: f64 = 0.5;

/// K x = b.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinearSystem<'a> {
    /// K.
    pub(crate) matrix: &'a TangentMatrix,
    /// b.
    pub(crate) rhs: &'a [f64],
}

impl LinearSystem<'_> {
    /// Whether the border is solved for too.
    fn with_border(&self) -> bool {
        self.rhs.len() > self.matrix.pattern.unknowns()
    }

    /// Refuses vectors of a wrong length, and values that are not finite; the number of unknowns.
    fn check(&self, solution: &[f64]) -> Result<usize, LinearSolverError> {
        let of_border = if self.with_border() {
            self.matrix.border.len()
        } else {
            0
        };
        let unknowns = self.matrix.pattern.unknowns() + of_border;
        check::length("the right-hand side", self.rhs.len(), unknowns)?;
        check::length("the solution", solution.len(), unknowns)?;
        check::finite("right-hand side", self.rhs)?;
        Ok(unknowns)
    }
}

/// The accuracy that an iterative solution must reach.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demand {
    /// ‖b − K x‖ / ‖b‖ at which the iteration stops \[-\].
    pub(crate) target: f64,
    /// The same of a solution that is handed out where it stops before \[-\].
    pub(crate) tolerance: f64,
    /// Iterations after which that is all that is wanted.
    pub(crate) patience: usize,
    /// Largest number of iterations.
    pub(crate) most: usize,
}

impl Demand {
    /// The largest residual of a solution that is handed out.
    fn accepted(&self) -> f64 {
        self.target.max(self.tolerance)
    }

    /// The error of an iteration that ended above it. The memory of factors stays open.
    fn missed(&self, iterations: usize, relative_residual: f64) -> LinearSolverError {
        LinearSolverError::NotConverged {
            iterations,
            relative_residual,
            tolerance: self.accepted(),
            factor_bytes: None,
        }
    }
}

/// Which iteration it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Method {
    /// Conjugate gradients, as long as matrix and preconditioner turn out positive definite; else generalised minimal residuals.
    pub(crate) by_gradients: bool,
    /// The names of the two.
    pub(crate) names: [&'static str; 2],
}

/// Vectors and sums, kept from solution to solution.
#[derive(Default)]
pub(crate) struct Preconditioned {
    product: Product,
    residual: Vec<f64>,
    change: Vec<f64>,
}

impl Preconditioned {
    /// Solves K x = b with `precondition`, which makes z ≈ K⁻¹ r of r: for the grid, or for all unknowns where b has those of the
    /// border too.
    pub(crate) fn solve(
        &mut self,
        system: LinearSystem<'_>,
        solution: &mut [f64],
        demand: &Demand,
        method: Method,
        precondition: &mut dyn FnMut(&[f64], &mut [f64]),
    ) -> Result<SolveReport, LinearSolverError> {
        let with_border = system.with_border();
        let unknowns = system.check(solution)?;
        let LinearSystem { matrix, rhs } = system;
        solution.fill(0.0);
        let (scale, largest) = (norm(rhs), max_norm(rhs));
        let Method {
            mut by_gradients,
            names: [gradients, residuals],
        } = method;
        by_gradients &= !with_border;
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
        let mut both = Both::new(matrix, product, precondition, with_border)?;
        let (mut reached, mut patience) = (1.0, demand.patience);
        loop {
            let is_patient = report.refinements < patience;
            let (wanted, most) = if is_patient {
                (demand.target, patience.min(demand.most))
            } else {
                (demand.accepted(), demand.most)
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
                let limits = Limits {
                    goal,
                    most: left,
                    restart: RESTART,
                };
                minimal_residuals(&mut both, residual, change, limits)
            };
            std::mem::replace(&mut both.failure, Ok(()))?;
            report.refinements += done.iterations;
            both.step(1.0, change, rhs, solution, residual);
            let before = std::mem::replace(&mut reached, norm(residual) / scale);
            // Written so that what is not a number is no progress.
            let progress = reached <= PROGRESS * before;
            if !progress && reached >= before {
                // What made it worse is taken back.
                both.step(-1.0, change, rhs, solution, residual);
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
        if reached <= demand.accepted() {
            check::finite("solution", solution)?;
            return Ok(report);
        }
        Err(demand.missed(report.refinements, reached))
    }
}

/// A matrix and its preconditioner.
struct Both<'a> {
    matrix: &'a TangentMatrix,
    product: &'a mut Product,
    precondition: &'a mut dyn FnMut(&[f64], &mut [f64]),
    /// The border of the matrix, eliminated by the preconditioner, where it is solved for.
    elimination: Option<Elimination>,
    /// Its failure, if it failed.
    failure: Result<(), LinearSolverError>,
}

impl<'a> Both<'a> {
    /// The operators of a matrix, with its border eliminated where that is solved for.
    fn new(
        matrix: &'a TangentMatrix,
        product: &'a mut Product,
        precondition: &'a mut dyn FnMut(&[f64], &mut [f64]),
        with_border: bool,
    ) -> Result<Self, LinearSolverError> {
        let mut both = Self {
            matrix,
            product,
            precondition,
            elimination: None,
            failure: Ok(()),
        };
        if with_border {
            both.eliminate()?;
        }
        Ok(both)
    }

    /// Eliminates the border by the preconditioner.
    fn eliminate(&mut self) -> Result<(), LinearSolverError> {
        let mut inverse = |r: &[f64], z: &mut [f64]| {
            (self.precondition)(r, z);
            Ok(())
        };
        self.elimination = Some(Elimination::new(&self.matrix.border, &mut inverse)?);
        Ok(())
    }

    /// x ← x + sign · change, and the residual b − K x there.
    fn step(
        &mut self,
        sign: f64,
        change: &[f64],
        rhs: &[f64],
        x: &mut [f64],
        residual: &mut [f64],
    ) {
        for (x, change) in x.iter_mut().zip(change) {
            *x += sign * change;
        }
        self.residual(rhs, x, residual);
    }

    /// b − K x.
    fn residual(&mut self, rhs: &[f64], x: &[f64], residual: &mut [f64]) {
        self.multiply(x, residual);
        for (residual, rhs) in residual.iter_mut().zip(rhs) {
            *residual = rhs - *residual;
        }
    }
}

impl Operators for Both<'_> {
    fn multiply(&mut self, x: &[f64], y: &mut [f64]) {
        let of_grid = self.matrix.pattern.unknowns();
        (self.product).multiply(self.matrix, &x[..of_grid], &mut y[..of_grid]);
        if self.elimination.is_some() {
            add_border(&self.matrix.border, x, y);
        }
    }

    fn precondition(&mut self, r: &[f64], z: &mut [f64]) {
        let Some(elimination) = &self.elimination else {
            return (self.precondition)(r, z);
        };
        let mut inverse = |r: &[f64], z: &mut [f64]| {
            (self.precondition)(r, z);
            Ok(())
        };
        let solved = elimination.solve(&self.matrix.border, &mut inverse, r, z);
        if solved.is_err() {
            z.fill(0.0);
            self.failure = solved;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{NodeBlock, Pattern};

    /// Q diag(1 … 1e-13) Qᵀ with a reflection Q, full: no digit of a residual below some 1e-4 of b is right.
    fn nearly_singular() -> (TangentMatrix, Vec<Vec<f64>>) {
        let n = 9;
        let mut v: Vec<f64> = (0..n).map(|k| f64::from(k as u8 * 5 % 7) + 1.0).collect();
        let size = norm(&v);
        for v in &mut v {
            *v /= size;
        }
        let q = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * v[i] * v[j];
        let rows: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let entry = |j| {
                    let terms =
                        (0..n).map(|k| q(i, k) * 10.0_f64.powf(-13.0 * k as f64 / 8.0) * q(j, k));
                    terms.sum::<f64>()
                };
                (0..n).map(entry).collect()
            })
            .collect();
        let block = |first| NodeBlock {
            first,
            len: 1,
            free: 1,
            place: [first, 0, 0],
        };
        let starts = (0..=n).map(|k| k * n).collect();
        let coupled = (0..n * n).map(|k| (k % n) as u32).collect();
        let pattern = Pattern::new((0..n).map(block).collect(), starts, coupled, n);
        let mut matrix = TangentMatrix::zeros(Arc::new(pattern), true);
        matrix.values = rows.iter().flatten().copied().collect();
        (matrix, rows)
    }

    // GOAL: a solution is handed out for what it leaves of K x = b, and not for what the recurrence of the iteration says.
    // CASE: a matrix of condition 1e13, whose recurrences go on to shrink where b − K x is round-off.
    // ORACLE: the residual with K as rows, apart from the solver.
    #[test]
    fn a_recurrence_that_left_the_residual_behind_is_not_believed() {
        let (matrix, rows) = nearly_singular();
        let rhs: Vec<f64> = (0..rows.len())
            .map(|k| if k % 2 == 0 { 1.0 } else { -0.4 })
            .collect();
        let demand = Demand {
            target: 1e-9,
            tolerance: 1e-9,
            patience: 400,
            most: 400,
        };
        for by_gradients in [true, false] {
            let mut x = vec![0.0; rhs.len()];
            let method = Method {
                by_gradients,
                names: ["gradients", "residuals"],
            };
            let mut same = |r: &[f64], z: &mut [f64]| z.copy_from_slice(r);
            let mut solver = Preconditioned::default();
            let system = LinearSystem {
                matrix: &matrix,
                rhs: &rhs,
            };
            let found = solver.solve(system, &mut x, &demand, method, &mut same);
            let left: Vec<f64> = rows
                .iter()
                .zip(&rhs)
                .map(|(row, b)| b - row.iter().zip(&x).map(|(k, x)| k * x).sum::<f64>())
                .collect();
            let reached = norm(&left) / norm(&rhs);
            match found {
                Ok(_) => assert!(reached < 1e-8, "handed out with {reached:e}"),
                Err(LinearSolverError::NotConverged {
                    relative_residual, ..
                }) => {
                    assert!(relative_residual > 1e-9);
                }
                Err(other) => panic!("{other}"),
            }
            assert!(reached > 1e-8, "the case tells nothing: {reached:e}");
        }
    }
}
