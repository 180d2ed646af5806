//! Systems with a border: the unknowns of rigid bodies and the load factor, eliminated last (theory, eq. 49).

use super::refine::max_norm;
use super::{Accuracy, LinearSolver, LinearSolverError};
use crate::{Border, TangentMatrix};

/// Relative residual of the systems of the grid by which a border is eliminated: its equations are made of their
/// solutions \[-\].
const OF_ELIMINATION: f64 = 1e-10;

/// A pivot of a border that is no larger than this share of its largest entry is none: no digit is left of it \[-\].
const NO_PIVOT: f64 = 1e-14;

/// The same where the solution came out wrong: the residual is the error of the systems by which the border is eliminated \[-\].
const HARDLY_A_PIVOT: f64 = 10.0 * OF_ELIMINATION;

/// An exact or approximate solver for the unknowns of the grid: the second vector from the first.
pub(super) type Inverse<'a> = dyn FnMut(&[f64], &mut [f64]) -> Result<(), LinearSolverError> + 'a;

/// The Schur complement of the unknowns of a border, S = K_bb − K_bg K_gg⁻¹ K_gb, with its parts. With a
/// preconditioner for K_gg⁻¹ it makes one for all unknowns, which meets the equations of the border.
#[derive(Debug)]
pub(super) struct Elimination {
    /// K_gg⁻¹ K_gb by unknown of the border.
    carried: Vec<Vec<f64>>,
    /// S by rows.
    schur: Vec<Vec<f64>>,
}

impl Elimination {
    /// Eliminates the grid from a border.
    pub(super) fn new(
        border: &Border,
        inverse: &mut Inverse<'_>,
    ) -> Result<Self, LinearSolverError> {
        let Border {
            columns,
            rows,
            corner,
        } = border;
        let mut carried = Vec::with_capacity(columns.len());
        for column in columns {
            let mut moved = vec![0.0; column.len()];
            inverse(column, &mut moved)?;
            carried.push(moved);
        }
        let mut schur = corner.clone();
        for (entries, row) in schur.iter_mut().zip(rows) {
            for (entry, column) in entries.iter_mut().zip(&carried) {
                *entry -= product(row, column);
            }
        }
        Ok(Self { carried, schur })
    }

    /// Solves for all unknowns: those of the grid first, those of the border behind them.
    pub(super) fn solve(
        &self,
        border: &Border,
        inverse: &mut Inverse<'_>,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<(), LinearSolverError> {
        let of_grid = rhs.len() - self.schur.len();
        let (grid, behind) = solution.split_at_mut(of_grid);
        inverse(&rhs[..of_grid], grid)?;
        let left: Vec<f64> = rhs[of_grid..]
            .iter()
            .zip(&border.rows)
            .map(|(force, row)| force - product(row, grid))
            .collect();
        let of_border = eliminate(self.schur.clone(), left, NO_PIVOT).map_err(|direction| {
            LinearSolverError::Singular {
                unknown: Some(of_grid + largest(&direction)),
            }
        })?;
        for (carried, by) in self.carried.iter().zip(&of_border) {
            for (value, share) in grid.iter_mut().zip(carried) {
                *value -= by * share;
            }
        }
        behind.copy_from_slice(&of_border);
        Ok(())
    }

    /// The motion of the border that meets hardly any resistance, where there is one.
    fn free_direction(&self) -> Option<Vec<f64>> {
        let still = vec![0.0; self.schur.len()];
        eliminate(self.schur.clone(), still, HARDLY_A_PIVOT).err()
    }
}

/// Solutions of systems with a border, for the matrix that a solver factorised last.
#[derive(Debug, Default)]
pub struct Bordered {
    /// The border eliminated by the factors at hand, from the first solution on.
    elimination: Option<Elimination>,
}

impl Bordered {
    /// By unknown of the border, the motion that meets hardly any resistance, where the last solution failed for that.
    pub fn free_direction(&self) -> Option<Vec<f64>> {
        self.elimination.as_ref()?.free_direction()
    }

    /// Solves for all unknowns: those of the grid first, those of the border behind them. A border that a solver does not iterate
    /// for at once is eliminated. As for the grid alone, such a solution is checked against the whole matrix, and
    /// refined once where that helps.
    ///
    /// # Errors
    /// As [`LinearSolver::solve`].
    pub fn solve(
        &mut self,
        solver: &mut dyn LinearSolver,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<(), LinearSolverError> {
        let border = &matrix.border;
        if border.is_empty() {
            solver.solve(matrix, rhs, solution)?;
            return Ok(());
        }
        if solver.iterate(matrix, rhs, solution)?.is_some() {
            return Ok(());
        }
        solver.ask_for(OF_ELIMINATION);
        let mut inverse = |force: &[f64], moved: &mut [f64]| {
            solver.solve(matrix, force, moved)?;
            Ok(())
        };
        let elimination = match self.elimination.take() {
            Some(earlier) => earlier,
            None => Elimination::new(border, &mut inverse)?,
        };
        let elimination = self.elimination.insert(elimination);
        elimination.solve(border, &mut inverse, rhs, solution)?;
        let Accuracy {
            target, tolerance, ..
        } = Accuracy::default();
        let scale = max_norm(rhs);
        let mut residual = vec![0.0; rhs.len()];
        let mut error = residual_of(matrix, rhs, solution, &mut residual) / scale;
        if scale == 0.0 || error <= target {
            return Ok(());
        }
        let mut refined = vec![0.0; rhs.len()];
        elimination.solve(border, &mut inverse, &residual, &mut refined)?;
        for (value, first) in refined.iter_mut().zip(&*solution) {
            *value += first;
        }
        let reduced = residual_of(matrix, rhs, &refined, &mut residual) / scale;
        if reduced < error {
            solution.copy_from_slice(&refined);
            error = reduced;
        }
        // Written so that what is not a number does not pass.
        if error <= tolerance {
            Ok(())
        } else {
            Err(LinearSolverError::Inaccurate {
                relative_residual: error,
                tolerance,
            })
        }
    }
}

/// The product of a matrix and its border with all unknowns, that with the matrix of the grid being in the rows of the grid
/// of `y`.
pub(super) fn add_border(border: &Border, x: &[f64], y: &mut [f64]) {
    let of_grid = x.len() - border.len();
    let (grid, behind) = x.split_at(of_grid);
    let (of_grid, of_border) = y.split_at_mut(of_grid);
    for (column, by) in border.columns.iter().zip(behind) {
        for (sum, entry) in of_grid.iter_mut().zip(column) {
            *sum += by * entry;
        }
    }
    for (sum, (row, entries)) in (of_border.iter_mut()).zip(border.rows.iter().zip(&border.corner))
    {
        *sum = product(row, grid) + product(entries, behind);
    }
}

/// The largest entry of b − K x over all unknowns, which is left in `residual`; infinite where it is not a
/// number.
fn residual_of(matrix: &TangentMatrix, rhs: &[f64], x: &[f64], residual: &mut [f64]) -> f64 {
    let of_grid = x.len() - matrix.border.len();
    matrix.multiply(&x[..of_grid], &mut residual[..of_grid]);
    add_border(&matrix.border, x, residual);
    for (entry, rhs) in residual.iter_mut().zip(rhs) {
        *entry = rhs - *entry;
    }
    if residual.iter().all(|entry| entry.is_finite()) {
        max_norm(residual)
    } else {
        f64::INFINITY
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The place of the largest entry.
fn largest(direction: &[f64]) -> usize {
    (0..direction.len())
        .max_by(|&a, &b| direction[a].abs().total_cmp(&direction[b].abs()))
        .unwrap_or(0)
}

/// Of rows that are eliminated up to `k`, where there is no pivot: the direction which they make nothing of.
fn free_direction(rows: &[Vec<f64>], k: usize) -> Vec<f64> {
    let mut direction = vec![0.0; rows.len()];
    direction[k] = 1.0;
    for i in (0..k).rev() {
        let known = product(&rows[i][i + 1..=k], &direction[i + 1..=k]);
        direction[i] = -known / rows[i][i];
    }
    direction
}

/// Solves a small dense system by elimination with row pivots; the direction that it makes nothing of if there is
/// one, as a pivot is below a share of the largest entry.
fn eliminate(mut rows: Vec<Vec<f64>>, mut rhs: Vec<f64>, least: f64) -> Result<Vec<f64>, Vec<f64>> {
    let n = rhs.len();
    let sizes: Vec<f64> = rows
        .iter()
        .map(|row| {
            row.iter()
                .fold(0.0, |size: f64, entry| size.max(entry.abs()))
        })
        .collect();
    for k in 0..n {
        let pivot = (k..n)
            .max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()))
            .unwrap_or(k);
        rows.swap(k, pivot);
        rhs.swap(k, pivot);
        let size = rows[k][k].abs();
        if size.is_nan() || size <= least * sizes.iter().copied().fold(0.0, f64::max) {
            return Err(free_direction(&rows, k));
        }
        for i in k + 1..n {
            let factor = rows[i][k] / rows[k][k];
            let (above, below) = rows.split_at_mut(i);
            for (entry, upper) in below[0][k..].iter_mut().zip(&above[k][k..]) {
                *entry -= factor * upper;
            }
            rhs[i] -= factor * rhs[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * rhs[j]).sum();
        rhs[k] = (rhs[k] - known) / rows[k][k];
    }
    Ok(rhs)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::{NodeBlock, Pattern};

    use super::*;
    use crate::SolveReport;

    /// Divides by the diagonal, wrong by a share of it.
    struct Sloppy {
        error: f64,
    }

    impl LinearSolver for Sloppy {
        fn name(&self) -> &'static str {
            "sloppy"
        }

        fn analyse(&mut self, _: &Arc<Pattern>) -> Result<(), LinearSolverError> {
            Ok(())
        }

        fn factor(&mut self, _: &TangentMatrix) -> Result<(), LinearSolverError> {
            Ok(())
        }

        fn solve(
            &mut self,
            matrix: &TangentMatrix,
            rhs: &[f64],
            solution: &mut [f64],
        ) -> Result<SolveReport, LinearSolverError> {
            for ((x, rhs), entry) in solution.iter_mut().zip(rhs).zip(&matrix.values) {
                *x = (1.0 + self.error) * rhs / entry;
            }
            Ok(SolveReport::new("sloppy", 0.0, 0))
        }

        fn analyses(&self) -> usize {
            0
        }
    }

    /// Two unknowns of the grid and one of a body: 2 x + z = 1, 4 y + 3 z = 2, x + y + 5 z = 3.
    fn solved(error: f64) -> Result<Vec<f64>, LinearSolverError> {
        let block = |first| NodeBlock {
            first,
            len: 1,
            free: 1,
            place: [first, 0, 0],
        };
        let pattern = Pattern::new(vec![block(0), block(1)], vec![0, 1, 2], vec![0, 1], 1);
        let matrix = TangentMatrix {
            pattern: Arc::new(pattern),
            values: vec![2.0, 4.0],
            symmetric: false,
            border: Border {
                columns: vec![vec![1.0, 3.0]],
                rows: vec![vec![1.0, 1.0]],
                corner: vec![vec![5.0]],
            },
        };
        let mut solver = Sloppy { error };
        let mut solution = vec![0.0; 3];
        Bordered::default().solve(&mut solver, &matrix, &[1.0, 2.0, 3.0], &mut solution)?;
        Ok(solution)
    }

    /// GOAL: a solution with a body is refined once where it is a little wrong, and refused where it is far
    /// from the whole matrix.
    /// ORACLE: by hand, z = 8/15, x = 7/30, y = 1/10.
    #[test]
    fn solutions_are_checked_against_the_whole_matrix() {
        let expected = [7.0 / 30.0, 0.1, 8.0 / 15.0];
        for (error, within) in [(0.0, 1e-15), (1e-6, 1e-11)] {
            let found = solved(error).unwrap();
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < within, "{error}: {found}");
            }
        }
        let refused = solved(0.1);
        assert!(
            matches!(refused, Err(LinearSolverError::Inaccurate { .. })),
            "{refused:?}"
        );
    }

    #[test]
    fn a_small_system_is_solved_and_a_singular_one_named() {
        let rows = vec![vec![0.0, 2.0], vec![4.0, 1.0]];
        assert_eq!(eliminate(rows, vec![4.0, 6.0], 1e-14), Ok(vec![1.0, 2.0]));
        let rows = vec![vec![1.0, 2.0], vec![2.0, 4.0]];
        let direction = eliminate(rows, vec![1.0, 1.0], 1e-14).unwrap_err();
        assert_eq!((largest(&direction), direction), (0, vec![-2.0, 1.0]));
    }
}
