//! Sparse systems of blocks with a border, and their solvers: the tangent system K du = r.
//!
//! A [`Pattern`] says which blocks of unknowns are coupled; a [`TangentMatrix`] has values for it and a [`Border`]. Nothing here
//! knows of soil. The solvers stand behind one trait, [`LinearSolver`]:
//!
//! | kind | matrix | method | role |
//! |---|---|---|---|
//! | [`SolverKind::Auto`] | any | chooses among the next three by dimension, size and symmetry of K | default |
//! | [`SolverKind::Multigrid`] | any, of a grid | conjugate gradients or generalised minimal residuals with geometric multigrid, own | large systems in space |
//! | [`SolverKind::Single`] | any | multifrontal factors in single precision, and conjugate gradients or generalised minimal residuals with them, own | half the memory |
//! | [`SolverKind::MultifrontalCholesky`] | symmetric positive definite, or quasi-definite with scalars | multifrontal Cholesky with signs of pivots, own | fast |
//! | [`SolverKind::Multifrontal`] | structurally symmetric | multifrontal LU, own | fast |
//! | [`SolverKind::FaerCholesky`] | symmetric positive definite | supernodal Cholesky of `faer` | independent second, fast |
//! | [`SolverKind::NalgebraCholesky`] | symmetric positive definite | `nalgebra-sparse` | independent second |
//! | [`SolverKind::SprsBiCgStab`] | any | `sprs`' stabilised bi-conjugate gradients | independent second |
//!
//! The direct solvers eliminate the unknowns in the order of a geometric nested dissection
//! ([`NestedDissection`]); every solution is checked against the matrix that was factorised, and
//! refined where that helps. The multifrontal solvers use the threads of the current `rayon` pool, the
//! others one; the same input gives the same bits on any number of threads.

mod auto;
mod border;
mod bordered;
mod check;
mod choice;
mod coupling_reach;
mod error;
mod krylov;
mod libraries;
mod matrix;
mod multifrontal;
mod multigrid;
mod ordering;
mod record;
mod refine;

use std::sync::Arc;

pub use auto::AutoSolver;
use auto::FACTOR_BYTES;
pub use border::Border;
pub use bordered::Bordered;
pub use check::Inspection;
pub use choice::{Forecast, LinearEffort, Reason};
pub use error::LinearSolverError;
pub use libraries::faer_cholesky::FaerCholesky;
pub use libraries::general_lu::GeneralLu;
pub use libraries::nalgebra_cholesky::NalgebraCholesky;
pub use libraries::sprs_bicgstab::SprsBiCgStab;
pub use matrix::{CompressedColumns, NodeBlock, Pattern, SCALAR, TangentMatrix};
pub use multifrontal::{MultifrontalCholesky, MultifrontalLu};
pub use ordering::NestedDissection;
pub use record::{Record, SolvedSystem};
pub use refine::{Accuracy, Refined, Refinement};

/// A solver for K x = b that reuses its symbolic work while the pattern of K stays the same.
pub trait LinearSolver: Send {
    /// Name for reports, stable over versions.
    fn name(&self) -> &'static str;

    /// Prepares everything that depends on the pattern only; does nothing when the pattern is the
    /// one analysed before (the same allocation, or equal), and little when the former analysis
    /// serves it too.
    ///
    /// # Errors
    /// [`LinearSolverError::Empty`], [`LinearSolverError::InvalidPattern`] or
    /// [`LinearSolverError::OutOfMemory`].
    fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<(), LinearSolverError>;

    /// Factorises the matrix, after analysing its pattern if needed. After an error there is no
    /// matrix to solve with.
    ///
    /// # Errors
    /// Those of [`LinearSolver::analyse`], and [`LinearSolverError::WrongLength`],
    /// [`LinearSolverError::NonFinite`], [`LinearSolverError::Singular`],
    /// [`LinearSolverError::NotSymmetric`] or [`LinearSolverError::NotPositiveDefinite`].
    fn factor(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError>;

    /// Solves K x = `rhs` \[force\] for the matrix factorised last; both slices have one entry per
    /// unknown, `solution` \[length\].
    /// The solution is checked against `matrix` and refined with it: it must be the one that was
    /// factorised. The content of `solution` is meaningful only on success.
    ///
    /// # Errors
    /// [`LinearSolverError::NotFactored`], [`LinearSolverError::WrongLength`],
    /// [`LinearSolverError::NonFinite`], [`LinearSolverError::Singular`] or
    /// [`LinearSolverError::Inaccurate`].
    fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
    ) -> Result<SolveReport, LinearSolverError>;

    /// Solves K x = `rhs` for all unknowns at once, those of the border of the matrix behind those of the grid, where the solver
    /// iterates; nothing where it solves for the grid alone, and the border is to be eliminated.
    ///
    /// # Errors
    /// As [`LinearSolver::solve`].
    fn iterate(
        &mut self,
        _matrix: &TangentMatrix,
        _rhs: &[f64],
        _solution: &mut [f64],
    ) -> Result<Option<SolveReport>, LinearSolverError> {
        Ok(None)
    }

    /// How many patterns were analysed since construction: shows that symbolic work is reused.
    fn analyses(&self) -> usize;

    /// Resets adaptive state at the start of a load step, so that steps are independent.
    fn start_step(&mut self) {}

    /// How small ‖b − K x‖ / ‖b‖ has to become in the next solutions \[-\]. Multifrontal solvers
    /// refine to that, and to 1e-9 at least; other direct solvers to the target of their [`Accuracy`].
    fn ask_for(&mut self, _relative_residual: f64) {}

    /// How the systems since the start of the step were solved, where the solver chooses among methods.
    fn effort(&self) -> LinearEffort {
        LinearEffort {
            method: self.name(),
            ..LinearEffort::default()
        }
    }
}

/// The report of one solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveReport {
    /// The method that produced the solution, after any fallback.
    pub method: &'static str,
    /// $`\max_i |b - K x|_i / \max_i |b|_i`$ \[-\], zero for a zero right-hand side.
    pub relative_residual: f64,
    /// Steps of iterative refinement, or iterations of an iterative solver.
    pub refinements: usize,
    /// Pivots that were too small to divide by and were replaced (zero for most methods).
    pub perturbed_pivots: usize,
    /// Largest entry met among the pivots of the elimination, the matrix being scaled to entries
    /// of about 1 \[-\]; 1 for methods that do not record it.
    pub pivot_growth: f64,
}

impl SolveReport {
    fn new(method: &'static str, relative_residual: f64, refinements: usize) -> Self {
        Self {
            method,
            relative_residual,
            refinements,
            perturbed_pivots: 0,
            pivot_growth: 1.0,
        }
    }
}

/// The solvers to choose from, see the table of the [module](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SolverKind {
    /// Cholesky for symmetric matrices, LU for the others and when Cholesky fails; for large systems in space
    /// iteration with multigrid.
    #[default]
    Auto,
    /// Iteration with geometric multigrid; a factorisation where it fails.
    Multigrid,
    /// Factors in single precision, and an iteration with them; in double precision where it fails.
    Single,
    /// Supernodal Cholesky factorisation of `faer`.
    FaerCholesky,
    /// Multifrontal Cholesky factorisation for symmetric positive definite matrices, and for quasi-definite ones with a scalar in
    /// their nodes.
    MultifrontalCholesky,
    /// Multifrontal LU for structurally symmetric matrices.
    Multifrontal,
    /// Cholesky factorisation of `nalgebra-sparse`.
    NalgebraCholesky,
    /// Stabilised bi-conjugate gradients of `sprs`.
    SprsBiCgStab,
}

impl SolverKind {
    /// All kinds, for tests and for listings.
    pub const ALL: [Self; 8] = [
        Self::Auto,
        Self::Single,
        Self::Multigrid,
        Self::FaerCholesky,
        Self::MultifrontalCholesky,
        Self::Multifrontal,
        Self::NalgebraCholesky,
        Self::SprsBiCgStab,
    ];

    /// A fresh solver of this kind with its default accuracy.
    pub fn build(self) -> Box<dyn LinearSolver> {
        self.build_within(FACTOR_BYTES)
    }

    /// The same where no more memory is allowed for factors \[bytes\]; kinds that know one method only know no limit.
    pub fn build_within(self, factor_bytes: usize) -> Box<dyn LinearSolver> {
        let within = |solver: AutoSolver| Box::new(solver.with_factor_bytes(factor_bytes));
        match self {
            Self::Auto => within(AutoSolver::default()),
            Self::Multigrid => within(AutoSolver::by_iteration()),
            Self::Single => within(AutoSolver::in_single()),
            Self::FaerCholesky => Box::new(FaerCholesky::default()),
            Self::MultifrontalCholesky => Box::new(MultifrontalCholesky::default()),
            Self::Multifrontal => Box::new(MultifrontalLu::default()),
            Self::NalgebraCholesky => Box::new(NalgebraCholesky::default()),
            Self::SprsBiCgStab => Box::new(SprsBiCgStab::default()),
        }
    }
}
