//! Iterative refinement: solves with an approximate inverse until the equations hold.
//!
//! N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., SIAM 2002, ch. 12.
//! The residual is measured in the maximum norm, relative to the right-hand side: that is the part
//! of the out-of-balance force which a Newton iteration would find again after the correction.

use super::{LinearSolverError, SolveReport, check};
use crate::TangentMatrix;

/// How well the equations must hold.
///
/// The default refines to 1e-12, which a sound matrix reaches without, and accepts 1e-6: close to
/// collapse the condition of the tangent forbids more, and such a correction still serves a Newton
/// iteration, which judges it by its own out-of-balance force. A multifrontal solver that was asked for less,
/// by [`LinearSolver::ask_for`](super::LinearSolver::ask_for), stops there, at 1e-9 at the latest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Relative residual at which refinement stops \[-\].
    pub target: f64,
    /// Largest relative residual of a solution that is handed out \[-\].
    pub tolerance: f64,
    /// Largest number of refinements.
    pub max_refinements: usize,
}

impl Default for Accuracy {
    fn default() -> Self {
        Self {
            target: 1e-12,
            tolerance: 1e-6,
            max_refinements: 10,
        }
    }
}

/// Vectors for refinement, kept from solve to solve.
#[derive(Debug, Default)]
pub struct Refinement {
    correction: Vec<f64>,
    residual: Vec<f64>,
    candidate: Vec<f64>,
}

/// Outcome of [`Refinement::solve`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// $`\max_i |b - K x|_i / \max_i |b|_i`$ \[-\], zero for a zero right-hand side.
    pub relative_residual: f64,
    /// Steps of refinement.
    pub refinements: usize,
}

impl Refinement {
    /// Solves K x = b with `apply_inverse`, which replaces a vector by the approximate K⁻¹ times it,
    /// and refines x while that at least halves the residual.
    ///
    /// # Errors
    /// [`LinearSolverError::WrongLength`], [`LinearSolverError::NonFinite`] and [`LinearSolverError::Inaccurate`].
    pub fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
        accuracy: &Accuracy,
        mut apply_inverse: impl FnMut(&mut [f64]),
    ) -> Result<Refined, LinearSolverError> {
        let unknowns = matrix.pattern.unknowns();
        check::length("the right-hand side", rhs.len(), unknowns)?;
        check::length("the solution", solution.len(), unknowns)?;
        check::finite("right-hand side", rhs)?;
        let scale = max_norm(rhs);
        if scale == 0.0 {
            solution.fill(0.0);
            return Ok(Refined {
                relative_residual: 0.0,
                refinements: 0,
            });
        }

        let Self {
            correction,
            residual,
            candidate,
        } = self;
        solution.copy_from_slice(rhs);
        apply_inverse(solution);
        check::finite("solution", solution)?;
        residual.resize(unknowns, 0.0);
        let mut relative_residual = relative_residual_of(matrix, rhs, solution, residual, scale);

        let mut refinements = 0;
        while relative_residual > accuracy.target && refinements < accuracy.max_refinements {
            correction.clone_from(residual);
            apply_inverse(correction);
            candidate.clear();
            candidate.extend(solution.iter().zip(&*correction).map(|(x, dx)| x + dx));
            let refined = relative_residual_of(matrix, rhs, candidate, residual, scale);
            refinements += 1;
            let halved = refined <= 0.5 * relative_residual;
            if refined < relative_residual {
                solution.copy_from_slice(candidate);
                relative_residual = refined;
            }
            if !halved {
                break;
            }
        }
        if relative_residual <= accuracy.tolerance {
            Ok(Refined {
                relative_residual,
                refinements,
            })
        } else {
            let tolerance = accuracy.tolerance;
            Err(LinearSolverError::Inaccurate {
                relative_residual,
                tolerance,
            })
        }
    }
}

/// Relative residual of `x`, infinite where it is not a number; leaves b − K x in `residual`.
pub(super) fn relative_residual_of(
    matrix: &TangentMatrix,
    rhs: &[f64],
    x: &[f64],
    residual: &mut [f64],
    scale: f64,
) -> f64 {
    matrix.multiply(x, residual);
    for (residual, &rhs) in residual.iter_mut().zip(rhs) {
        *residual = rhs - *residual;
    }
    if residual.iter().all(|value| value.is_finite()) {
        max_norm(residual) / scale
    } else {
        f64::INFINITY
    }
}

/// Largest magnitude of the entries; NaN entries are ignored.
pub(super) fn max_norm(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest, value| value.abs().max(largest))
}

/// Tells a singular matrix from a regular one after a suspicious factorisation: solves with a
/// right-hand side that has a part along every left null vector that one can expect.
///
/// A singular matrix cannot reproduce that part, so that the residual stays large.
pub(super) fn probe(
    unknowns: usize,
    suspect: Option<usize>,
    solve: impl FnOnce(&[f64], &mut [f64]) -> Result<SolveReport, LinearSolverError>,
) -> Result<(), LinearSolverError> {
    let rhs: Vec<f64> = (0..unknowns as u64).map(scatter).collect();
    match solve(&rhs, &mut vec![0.0; unknowns]) {
        Err(LinearSolverError::Inaccurate { .. } | LinearSolverError::NonFinite { .. }) => {
            Err(LinearSolverError::Singular { unknown: suspect })
        }
        other => other.map(|_| ()),
    }
}

/// A value in \[0.5, 1.5) without pattern, the same for the same index (Steele, Lea & Flood,
/// *Fast splittable pseudorandom number generators*, OOPSLA 2014).
fn scatter(index: u64) -> f64 {
    let mut bits = index.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^= bits >> 31;
    0.5 + (bits >> 11) as f64 / (1_u64 << 53) as f64
}
