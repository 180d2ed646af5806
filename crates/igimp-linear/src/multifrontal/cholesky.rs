//! Cholesky factorisation of a front with symmetric values, positive definite or quasi-definite.
//!
//! J. W. H. Liu, *The multifrontal method for sparse matrix solution: theory and practice*, SIAM
//! Review 34 (1992). With w pivots and r border unknowns the lower half of the front is
//!
//! ```text
//!         w     r
//!   w  [  A       ]    A → L₁ J L₁ᵀ
//!   r  [  L     C ]    L → L L₁⁻ᵀ J,  C = contributions − L J Lᵀ
//! ```
//!
//! J has the signs of the pivots: +1 for displacement and −1 for pore pressure, in any order of elimination (R. J. Vanderbei,
//! *Symmetric quasidefinite matrices*, SIAM Journal on Optimization 5, 1995). A column of L has the sign of its pivot on the
//! diagonal, and J is stored nowhere else.
//!
//! A keeps the room of a [`Layout`]; entries above its diagonal are never read. Of C only the lower half is worked out,
//! a few columns at a time, and never stored as a whole.

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par, Spec};

use super::super::LinearSolverError;
use super::dense::dense_lu::PivotRecord;
use super::dense::layout::{Layout, STRIDE};
use super::dense::panels::{
    solve_lower, solve_lower_transposed, subtract_product, subtract_transposed_product,
};
use super::dense::scalar::Scalar;
use super::dense::signs::{self, Signs};
use super::dense::tiles::{TILE, by_columns, tile_width};
use super::extend_add::{Target, triangle_column};
use super::kernel::{Contribution, Kernel, Room, Substitution};
use super::scratch::make_room;
use super::tree::plan::Plan;
use crate::matrix::{NodeBlock, SCALAR, TangentMatrix};
use crate::multifrontal::dense::layout::Shape;
use crate::multifrontal::tree::front::{Extent, Front};

/// Elimination of K, with its diagonal by unknown.
pub(super) struct Cholesky<'a> {
    pub(super) matrix: &'a TangentMatrix,
    pub(super) diagonal: &'a [f64],
}

impl<T: Scalar> Kernel<T> for Cholesky<'_> {
    const SHAPE: Shape = Shape::Triangle;

    fn entries(extent: &Extent) -> usize {
        extent.halves + extent.panels
    }

    fn load(&self, plan: &Plan, front: &Front, factors: &mut [T], local: &[u32]) {
        let (w, r) = (front.pivots, front.border);
        factors.fill(T::default());
        let layout = Layout::lower(w);
        let (pivots, lower) = factors.split_at_mut(layout.entries());
        let (pattern, values) = (&*plan.pattern, &self.matrix.values);
        for rank in front.columns.clone() {
            let index = plan.order[rank] as usize;
            let first_column = plan.position[rank] as usize - front.first;
            let (first, height) = (pattern.first_value[index], pattern.height(index));
            let columns = pattern.blocks[index].len;
            let mut offset = 0;
            for &other in pattern.coupled_to(index) {
                let len = pattern.blocks[other as usize].len;
                let row_rank = plan.rank[other as usize] as usize;
                let start = first + offset;
                offset += len;
                if row_rank < rank {
                    continue;
                }
                for c in 0..columns {
                    let column = first_column + c;
                    let mut from = &values[start + c * height..][..len];
                    let into = if row_rank < front.columns.end {
                        let first_row = plan.position[row_rank] as usize - front.first;
                        let above = layout.first_row(column).saturating_sub(first_row);
                        from = &from[above..];
                        let row = first_row + above - layout.first_row(column);
                        &mut pivots[layout.offset(column) + row..]
                    } else {
                        &mut lower[column * r + local[row_rank] as usize..]
                    };
                    for (into, &from) in into.iter_mut().zip(from) {
                        *into = T::near(from);
                    }
                }
            }
        }
    }

    fn eliminate(
        &self,
        plan: &Plan,
        front: &Front,
        factors: &mut [T],
        _exchanges: &mut [u32],
        large: bool,
    ) -> Result<PivotRecord, LinearSolverError> {
        let (w, r) = (front.pivots, front.border);
        let layout = Layout::lower(w);
        let (pivots, lower) = factors.split_at_mut(layout.entries());
        let not_positive = |pivot: usize| LinearSolverError::NotPositiveDefinite {
            unknown: Some(plan.unknown_at(front.first + pivot)),
        };
        let mut lower = MatMut::from_column_major_slice_mut(lower, r, w);
        let blocks = front.columns.clone();
        let blocks = blocks.map(|rank| plan.pattern.blocks[plan.order[rank] as usize]);
        let of_pressure =
            |block: NodeBlock, k: usize| block.free & SCALAR != 0 && k + 1 == block.len;
        let signed = blocks.clone().any(|block| block.free & SCALAR != 0);
        if layout.is_square() {
            let block = MatMut::from_column_major_slice_mut(pivots, w, w);
            factor_block(block, signed, large).map_err(not_positive)?;
            if r > 0 {
                let factored = MatRef::from_column_major_slice(&*pivots, w, w);
                divide(factored, lower.as_mut(), large);
            }
        } else {
            factor_strides(layout, pivots, lower, signed).map_err(not_positive)?;
        }
        for (rank, block) in front.columns.clone().zip(blocks) {
            for k in 0..block.len {
                let pivot = plan.position[rank] as usize - front.first + k;
                let root = signs::pivot(layout, pivots, pivot).wide();
                let least = T::LEAST_PIVOT * self.diagonal[block.first + k].abs();
                let has_its_sign = (root < 0.0) == of_pressure(block, k);
                // Written so that what is not a number does not pass.
                let is_sound = has_its_sign && root * root > least;
                if !is_sound {
                    return Err(not_positive(pivot));
                }
            }
        }
        Ok(PivotRecord::default())
    }

    fn contribute(
        contribution: Contribution<'_, T>,
        room: Room<'_, T>,
        scratch: &mut Vec<T>,
        large: bool,
    ) -> Result<(), LinearSolverError> {
        let (w, r) = (contribution.front.pivots, contribution.front.border);
        let child = Layout::lower(w);
        let (pivots, lower) = contribution.factors.split_at(child.entries());
        let signs = Signs::of(child, pivots, w);
        let lower = MatRef::from_column_major_slice(lower, r, w);
        let layout = Layout::lower(room.parent.pivots);
        let (pivots, below) = room.factors.split_at_mut(layout.entries());
        let target = Target {
            layout,
            first_pivot: 0,
            pivots,
            lower: below,
            border: room.parent.border,
            first_waiting: 0,
            waiting: room.waiting,
        };
        let work = Work {
            contribution,
            lower,
            signs: &signs,
            all_pivots: room.parent.pivots,
        };
        if large {
            work.halve(&(0..r), target);
            return Ok(());
        }
        let mut target = target;
        let width = tile_width(r);
        make_room(scratch, r * width.min(r), "contributions")?;
        for first in (0..r).step_by(width) {
            work.tile(&(first..r.min(first + width)), &mut target, scratch);
        }
        Ok(())
    }
}

/// A contribution that is worked out.
struct Work<'a, T> {
    contribution: Contribution<'a, T>,
    /// Factors below the pivots.
    lower: MatRef<'a, T>,
    signs: &'a Signs,
    /// Pivots of the parent.
    all_pivots: usize,
}

impl<T: Scalar> Work<'_, T> {
    /// Works on some columns in tiles that threads share.
    fn halve(&self, columns: &Range<usize>, mut target: Target<'_, T>) {
        let map = self.contribution.map;
        if columns.len() > TILE {
            let middle = columns.start + (columns.len() / 2).next_multiple_of(TILE);
            let rows = map.rows - map.taken;
            let waiting = |column: usize| {
                triangle_column(rows, column.max(map.taken) - map.taken).start
                    + column.max(map.taken)
                    - map.taken
            };
            let before = waiting(middle) - waiting(columns.start);
            let (left, right) = target.cut(map, middle, self.all_pivots, before);
            rayon::join(
                || self.halve(&(columns.start..middle), left),
                || self.halve(&(middle..columns.end), right),
            );
            return;
        }
        let height = map.rows - columns.start;
        let mut tile = vec![T::default(); height * columns.len()];
        self.tile(columns, &mut target, &mut tile);
    }

    /// Works out some columns from the diagonal on, adds them to the parent, and keeps the waiting entries.
    fn tile(&self, columns: &Range<usize>, target: &mut Target<'_, T>, tile: &mut [T]) {
        let map = self.contribution.map;
        let height = map.rows - columns.start;
        let tile = &mut tile[..height * columns.len()];
        let product = MatMut::from_column_major_slice_mut(tile, height, columns.len());
        multiply_tile(
            product,
            Accum::Replace,
            (self.lower, self.signs),
            columns.start,
        );
        for child in self.contribution.children {
            child.add_lower(tile, height, columns);
        }
        target.add_columns(map, tile, columns, columns.start, true);
        let rows = map.rows - map.taken;
        for column in columns.start.max(map.taken)..columns.end {
            let waiting = column - map.taken;
            let start = triangle_column(rows, waiting).start + waiting;
            let first = triangle_column(rows, target.first_waiting).start + target.first_waiting;
            let from = &tile[(column - columns.start) * height..][column - columns.start..height];
            target.waiting[start - first..][..from.len()].copy_from_slice(from);
        }
    }
}

/// A → L in the lower half of a square block, with pivots of both signs if `signed`; the number of a pivot that is zero, or not
/// positive, otherwise.
fn factor_block<T: Scalar>(block: MatMut<'_, T>, signed: bool, large: bool) -> Result<(), usize> {
    let pivots = block.nrows();
    if signed && (!large || pivots <= STRIDE) {
        return signs::factor_block(block);
    }
    if !large || pivots <= STRIDE {
        let scratch = cholesky_in_place_scratch::<T>(pivots, Par::Seq, Spec::default());
        let result = cholesky_in_place(
            block,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Spec::default(),
        );
        return result
            .map(|_| ())
            .map_err(|LltError::NonPositivePivot { index }| index);
    }
    let (left, right) = block.split_at_col_mut(STRIDE);
    let (mut first, mut below) = left.split_at_row_mut(STRIDE);
    factor_block(first.as_mut(), signed, false)?;
    divide(first.as_ref(), below.as_mut(), large);
    let (_, mut rest) = right.split_at_row_mut(STRIDE);
    let signs = Signs::of_block(first.as_ref());
    multiply(rest.as_mut(), Accum::Add, (below.as_ref(), &signs), large);
    factor_block(rest, signed, large).map_err(|pivot| pivot + STRIDE)
}

/// A → L and L → L L₁⁻ᵀ J, stride by stride.
fn factor_strides<T: Scalar>(
    layout: Layout,
    pivots: &mut [T],
    mut lower: MatMut<'_, T>,
    signed: bool,
) -> Result<(), usize> {
    let mut rest = pivots;
    let rows = lower.ncols();
    for (first, columns) in layout.strides() {
        let height = rows - first;
        let (stride, later) = std::mem::take(&mut rest).split_at_mut(height * columns);
        let stride = MatMut::from_column_major_slice_mut(stride, height, columns);
        let (mut block, mut below) = stride.split_at_row_mut(columns);
        factor_block(block.as_mut(), signed, false).map_err(|pivot| pivot + first)?;
        divide(block.as_ref(), below.as_mut(), true);
        let (_, right) = lower.as_mut().split_at_col_mut(first);
        let (mut panel, mut right) = right.split_at_col_mut(columns);
        divide(block.as_ref(), panel.as_mut(), true);
        let signs = Signs::of_block(block.as_ref());
        let below = below.as_ref();
        // The strides that follow, and the panels below them.
        let next = first + columns;
        subtract(layout, next..rows, later, (below, &signs), next);
        by_columns(true, right.as_mut(), &|column, tile: MatMut<'_, T>| {
            let mut copy = Vec::new();
            let across = signs.times(below.subrows(column, tile.ncols()), &mut copy);
            matmul(
                tile,
                Accum::Add,
                panel.as_ref(),
                across.transpose(),
                -T::near(1.0),
                Par::Seq,
            );
        });
        rest = later;
    }
    Ok(())
}

/// Takes L J Lᵀ off the strides of some columns; L begins with row `first`.
fn subtract<T: Scalar>(
    layout: Layout,
    columns: Range<usize>,
    strides: &mut [T],
    (lower, signs): (MatRef<'_, T>, &Signs),
    first: usize,
) {
    let height = first + lower.nrows() - columns.start;
    if columns.len() > STRIDE {
        let middle = columns.start + columns.len().div_ceil(STRIDE) / 2 * STRIDE;
        let at = layout.offset(middle) - layout.offset(columns.start);
        let (left, right) = strides.split_at_mut(at);
        let lower = (lower, signs);
        rayon::join(
            || subtract(layout, columns.start..middle, left, lower, first),
            || subtract(layout, middle..columns.end, right, lower, first),
        );
    } else if !columns.is_empty() {
        let tile = MatMut::from_column_major_slice_mut(strides, height, columns.len());
        multiply_tile(tile, Accum::Add, (lower, signs), columns.start - first);
    }
}

/// L → L L₁⁻ᵀ J.
fn divide<T: Scalar>(factored: MatRef<'_, T>, lower: MatMut<'_, T>, large: bool) {
    let signs = Signs::of_block(factored);
    by_columns(
        large,
        lower.transpose_mut(),
        &|_, mut tile: MatMut<'_, T>| {
            solve_lower_triangular_in_place(factored, tile.as_mut(), Par::Seq);
            signs.apply(tile);
        },
    );
}

/// The lower half of C, to which L J Lᵀ is taken off or with whose negative it is replaced.
fn multiply<T: Scalar>(
    target: MatMut<'_, T>,
    accum: Accum,
    lower: (MatRef<'_, T>, &Signs),
    large: bool,
) {
    let rows = target.nrows();
    by_columns(large, target, &|first, tile: MatMut<'_, T>| {
        multiply_tile(tile.subrows_mut(first, rows - first), accum, lower, first);
    });
}

/// The same for some columns of C, given from the diagonal on.
fn multiply_tile<T: Scalar>(
    tile: MatMut<'_, T>,
    accum: Accum,
    (lower, signs): (MatRef<'_, T>, &Signs),
    first: usize,
) {
    let (rows, columns) = (lower.nrows(), tile.ncols());
    let band = lower.subrows(first, columns);
    let mut copy = Vec::new();
    let across = signs.times(band, &mut copy).transpose();
    let (square, below) = tile.split_at_row_mut(columns);
    triangular::matmul(
        square,
        BlockStructure::TriangularLower,
        accum,
        band,
        BlockStructure::Rectangular,
        across,
        BlockStructure::Rectangular,
        -T::near(1.0),
        Par::Seq,
    );
    let end = first + columns;
    if end < rows {
        let lower = lower.subrows(end, rows - end);
        matmul(below, accum, lower, across, -T::near(1.0), Par::Seq);
    }
}

/// Solves with the factors of [`Cholesky`].
pub(super) struct CholeskyFactors;

impl<T: Scalar> Substitution<T> for CholeskyFactors {
    fn entries(extent: &Extent) -> usize {
        <Cholesky as Kernel<T>>::entries(extent)
    }

    fn forward(factors: &[T], _exchanges: &[u32], y: &mut [T], product: &mut [T], large: bool) {
        let layout = Layout::lower(y.len());
        let (pivots, lower) = factors.split_at(layout.entries());
        solve_lower(layout, pivots, false, y);
        product.fill(T::default());
        subtract_product(lower, y, product, large);
        for (pivot, value) in y.iter_mut().enumerate() {
            if signs::pivot(layout, pivots, pivot) < T::default() {
                *value = -*value;
            }
        }
    }

    fn backward(factors: &[T], y: &mut [T], border: &[T], large: bool) {
        let layout = Layout::lower(y.len());
        let (pivots, lower) = factors.split_at(layout.entries());
        subtract_transposed_product(lower, border, y, large);
        solve_lower_transposed(layout, pivots, y);
    }
}
