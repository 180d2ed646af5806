//! What the two kinds of elimination, LU and Cholesky, have in common.

use super::super::LinearSolverError;
use super::dense_lu::PivotRecord;
use super::extend_add::{BorderMap, triangle};
use super::plan::{Front, Plan};
use super::tasks::Extent;

/// A kind of elimination, on given values.
pub(super) trait Kernel: Sync {
    /// How contributions are stored.
    const SHAPE: Shape;

    /// Entries of the factors of fronts of this extent.
    fn entries(extent: &Extent) -> usize;

    /// Sets the factors of a front to the entries of the matrix in its rows and columns. `local` gives
    /// the first row in the border of each border node, by rank.
    fn load(&self, plan: &Plan, front: &Front, factors: &mut [f64], local: &[u32]);

    /// Adds what a child contributes to the rows and columns of the pivots.
    fn add(front: &Front, factors: &mut [f64], child: &[f64], map: &BorderMap);

    /// Eliminates the pivots and sets `contribution`. The threads share the work on a `large` front.
    ///
    /// # Errors
    /// [`LinearSolverError::NotPositiveDefinite`], where that matters.
    fn eliminate(
        &self,
        plan: &Plan,
        front: &Front,
        room: Room,
        large: bool,
    ) -> Result<PivotRecord, LinearSolverError>;

    /// Adds the part of a child's contribution that the parent passes on.
    fn pass_on(front: &Front, child: &[f64], map: &BorderMap, contribution: &mut [f64]);
}

/// How the contribution of a front is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// Border × border entries, by columns.
    Square,
    /// The entries from the diagonal on, by columns.
    Triangle,
}

impl Shape {
    /// Entries for a border with so many unknowns.
    pub(super) fn entries(self, border: usize) -> usize {
        match self {
            Self::Square => border * border,
            Self::Triangle => triangle(border),
        }
    }
}

/// Where the result of an elimination goes.
pub(super) struct Room<'a> {
    /// Factors of the front.
    pub(super) factors: &'a mut [f64],
    /// Row exchanges within the pivot block.
    pub(super) exchanges: &'a mut [u32],
    /// What the border of the front takes, see [`Shape`].
    pub(super) contribution: &'a mut [f64],
    /// Memory to work in.
    pub(super) scratch: &'a mut Vec<f64>,
}

/// What the factors of a front are used for in a solve.
pub(super) trait Substitution: Sync {
    /// As [`Kernel::entries`].
    fn entries(extent: &Extent) -> usize;

    /// y ← L⁻¹ P y for the pivots, and `product` = L y for the border.
    fn forward(factors: &[f64], exchanges: &[u32], y: &mut [f64], product: &mut [f64]);

    /// y ← U⁻¹ (y − Uᵀ border).
    fn backward(factors: &[f64], y: &mut [f64], border: &[f64]);
}
