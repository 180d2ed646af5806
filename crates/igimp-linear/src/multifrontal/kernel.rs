//! The common interface of the two kinds of elimination, LU and Cholesky.

use super::dense::dense_lu::PivotRecord;
use super::dense::scalar::Scalar;
use crate::LinearSolverError;
use crate::multifrontal::dense::layout::Shape;
use crate::multifrontal::extend_add::{BorderMap, Waiting};
use crate::multifrontal::tree::front::{Extent, Front};
use crate::multifrontal::tree::plan::Plan;

/// A kind of elimination, on given values.
pub(super) trait Kernel<T: Scalar>: Sync {
    /// How contributions are stored.
    const SHAPE: Shape;

    /// Entries of the factors of fronts of this extent.
    fn entries(extent: &Extent) -> usize;

    /// Sets the factors of a front to the entries of the matrix in its rows and columns. `local` gives
    /// the first row in the border of each border node, by rank.
    fn load(&self, plan: &Plan, front: &Front, factors: &mut [T], local: &[u32]);

    /// Eliminates the pivots. The threads share the work on a `large` front; `exchanges` are those of rows
    /// within the pivot block.
    ///
    /// # Errors
    /// [`LinearSolverError::NotPositiveDefinite`], where that matters.
    fn eliminate(
        &self,
        plan: &Plan,
        front: &Front,
        factors: &mut [T],
        exchanges: &mut [u32],
        large: bool,
    ) -> Result<PivotRecord, LinearSolverError>;

    /// Works out the contribution of a front to its parent: adds to the factors of the parent what falls on
    /// its pivots, and leaves the rest.
    ///
    /// # Errors
    /// [`LinearSolverError::OutOfMemory`].
    fn contribute(
        contribution: Contribution<'_, T>,
        room: Room<'_, T>,
        scratch: &mut Vec<T>,
        large: bool,
    ) -> Result<(), LinearSolverError>;
}

/// The contribution of a front to its parent: the product of its factors, and the contributions of its children.
pub(super) struct Contribution<'a, T> {
    pub(super) front: &'a Front,
    pub(super) factors: &'a [T],
    pub(super) children: &'a [Waiting<'a, T>],
    /// Where its border lies in the parent.
    pub(super) map: &'a BorderMap,
}

/// Where a contribution goes.
pub(super) struct Room<'a, T> {
    pub(super) parent: &'a Front,
    /// Factors of the parent, loaded.
    pub(super) factors: &'a mut [T],
    /// The part that the parent passes on, see [`Shape`].
    pub(super) waiting: &'a mut [T],
}

/// Forward and backward substitution with the factors of a front.
pub(super) trait Substitution<T: Scalar>: Sync {
    /// As [`Kernel::entries`].
    fn entries(extent: &Extent) -> usize;

    /// y ← L⁻¹ P y for the pivots, and `product` = −L y for the border. The threads share the work on a `large` front.
    fn forward(factors: &[T], exchanges: &[u32], y: &mut [T], product: &mut [T], large: bool);

    /// y ← U⁻¹ (y − Uᵀ border).
    fn backward(factors: &[T], y: &mut [T], border: &[T], large: bool);
}
