//! Cholesky factorisation of a front with symmetric positive definite values.
//!
//! J. W. H. Liu, *The multifrontal method for sparse matrix solution: theory and practice*, SIAM
//! Review 34 (1992). With w pivots and r border unknowns the lower half of the front is
//!
//! ```text
//!         w     r
//!   w  [  A       ]    A → L₁ L₁ᵀ
//!   r  [  L     C ]    L → L L₁⁻ᵀ,  C = contributions − L Lᵀ
//! ```
//!
//! A keeps the room of a full square; what is above its diagonal is never read. Of C only the lower triangle is kept.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par, Spec};
use igimp_assembly::TangentMatrix;

use super::super::{LinearSolverError, check};
use super::dense_lu::PivotRecord;
use super::extend_add::{Block, BorderMap};
use super::kernel::{Kernel, Room, Shape, Substitution};
use super::panels::{
    solve_lower, solve_lower_transposed, subtract_product, subtract_transposed_product,
};
use super::plan::{Front, Plan};
use super::tasks::Extent;
use super::tiles::{TILE, by_columns};
use super::workshop::make_room;

/// Pivots that are factorised at once in a front that the threads share.
const STRIDE: usize = 128;

/// Elimination of K, with its diagonal by unknown.
pub(super) struct Cholesky<'a> {
    pub(super) matrix: &'a TangentMatrix,
    pub(super) diagonal: &'a [f64],
}

impl Kernel for Cholesky<'_> {
    const SHAPE: Shape = Shape::Triangle;

    fn entries(extent: &Extent) -> usize {
        extent.squares + extent.panels
    }

    fn load(&self, plan: &Plan, front: &Front, factors: &mut [f64], local: &[u32]) {
        let (w, r) = (front.pivots, front.border);
        factors.fill(0.0);
        let (pivots, lower) = factors.split_at_mut(w * w);
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
                    let from = &values[start + c * height..][..len];
                    let into = if row_rank < front.columns.end {
                        let first_row = plan.position[row_rank] as usize - front.first;
                        &mut pivots[column * w + first_row..]
                    } else {
                        &mut lower[column * r + local[row_rank] as usize..]
                    };
                    into[..len].copy_from_slice(from);
                }
            }
        }
    }

    fn add(front: &Front, factors: &mut [f64], child: &[f64], map: &BorderMap) {
        let (w, r) = (front.pivots, front.border);
        let (pivots, lower) = factors.split_at_mut(w * w);
        let block = |entries, rows| Block { entries, rows };
        map.add_lower_to_pivots(child, &mut block(pivots, w), &mut block(lower, r));
    }

    fn eliminate(
        &self,
        plan: &Plan,
        front: &Front,
        room: Room,
        large: bool,
    ) -> Result<PivotRecord, LinearSolverError> {
        let (w, r) = (front.pivots, front.border);
        let (pivots, lower) = room.factors.split_at_mut(w * w);
        let not_positive = |pivot: usize| LinearSolverError::NotPositiveDefinite {
            unknown: Some(plan.unknown_at(front.first + pivot)),
        };
        let block = MatMut::from_column_major_slice_mut(pivots, w, w);
        factor_block(block, large).map_err(not_positive)?;
        for rank in front.columns.clone() {
            let unknowns = plan.pattern.blocks[plan.order[rank] as usize];
            for k in 0..unknowns.len {
                let pivot = plan.position[rank] as usize - front.first + k;
                let root = pivots[pivot * (w + 1)];
                if !check::is_sound(root * root, self.diagonal[unknowns.first + k]) {
                    return Err(not_positive(pivot));
                }
            }
        }
        if r > 0 {
            let factored = MatRef::from_column_major_slice(&*pivots, w, w);
            let mut lower = MatMut::from_column_major_slice_mut(lower, r, w);
            divide(factored, lower.as_mut(), large);
            contribute(room.contribution, lower.as_ref(), room.scratch, large)?;
        }
        Ok(PivotRecord::default())
    }

    fn pass_on(front: &Front, child: &[f64], map: &BorderMap, contribution: &mut [f64]) {
        map.pass_on_lower(child, contribution, front.border);
    }
}

/// A → L in the lower half of a square block; the number of a pivot that is not positive otherwise.
fn factor_block(block: MatMut<'_, f64>, large: bool) -> Result<(), usize> {
    let pivots = block.nrows();
    if !large || pivots <= STRIDE {
        let scratch = cholesky_in_place_scratch::<f64>(pivots, Par::Seq, Spec::default());
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
    factor_block(first.as_mut(), false)?;
    divide(first.as_ref(), below.as_mut(), large);
    let (_, mut rest) = right.split_at_row_mut(STRIDE);
    multiply(rest.as_mut(), Accum::Add, below.as_ref(), large);
    factor_block(rest, large).map_err(|pivot| pivot + STRIDE)
}

/// L → L L₁⁻ᵀ.
fn divide(factored: MatRef<'_, f64>, lower: MatMut<'_, f64>, large: bool) {
    by_columns(large, lower.transpose_mut(), &|_, tile: MatMut<'_, f64>| {
        solve_lower_triangular_in_place(factored, tile, Par::Seq);
    });
}

/// Replaces a triangle by −L Lᵀ, which is worked out in squares: in one, or in tiles where the threads share it.
fn contribute(
    contribution: &mut [f64],
    lower: MatRef<'_, f64>,
    scratch: &mut Vec<f64>,
    large: bool,
) -> Result<(), LinearSolverError> {
    let rows = lower.nrows();
    if large {
        halve(0, rows, contribution, lower);
        return Ok(());
    }
    make_room(scratch, rows * rows, "contributions")?;
    let square = &mut scratch[..rows * rows];
    let target = MatMut::from_column_major_slice_mut(square, rows, rows);
    multiply(target, Accum::Replace, lower, large);
    keep_lower(square, rows, contribution);
    Ok(())
}

/// Columns from `first` on of a triangle, by the tiles of [`by_columns`].
fn halve(first: usize, columns: usize, triangle: &mut [f64], lower: MatRef<'_, f64>) {
    let rows = lower.nrows();
    if columns > TILE {
        let half = (columns / 2).next_multiple_of(TILE);
        let height = rows - first;
        let entries = half * height - half * (half - 1) / 2;
        let (left, right) = triangle.split_at_mut(entries);
        rayon::join(
            || halve(first, half, left, lower),
            || halve(first + half, columns - half, right, lower),
        );
        return;
    }
    let height = rows - first;
    let mut tile = vec![0.0; height * columns];
    let target = MatMut::from_column_major_slice_mut(&mut tile, height, columns);
    multiply_tile(target, Accum::Replace, lower, first);
    keep_lower(&tile, height, triangle);
}

/// Copies the columns of a block from the diagonal on.
fn keep_lower(block: &[f64], rows: usize, mut triangle: &mut [f64]) {
    for (column, entries) in block.chunks_exact(rows).enumerate() {
        let (own, later) = triangle.split_at_mut(rows - column);
        own.copy_from_slice(&entries[column..]);
        triangle = later;
    }
}

/// The lower half of C, to which L Lᵀ is taken off or with whose negative it is replaced.
fn multiply(target: MatMut<'_, f64>, accum: Accum, lower: MatRef<'_, f64>, large: bool) {
    let rows = target.nrows();
    by_columns(large, target, &|first, tile: MatMut<'_, f64>| {
        multiply_tile(tile.subrows_mut(first, rows - first), accum, lower, first);
    });
}

/// The same for some columns of C, given from the diagonal on.
fn multiply_tile(tile: MatMut<'_, f64>, accum: Accum, lower: MatRef<'_, f64>, first: usize) {
    let (rows, columns) = (lower.nrows(), tile.ncols());
    let across = lower.subrows(first, columns).transpose();
    let (square, below) = tile.split_at_row_mut(columns);
    triangular::matmul(
        square,
        BlockStructure::TriangularLower,
        accum,
        across.transpose(),
        BlockStructure::Rectangular,
        across,
        BlockStructure::Rectangular,
        -1.0,
        Par::Seq,
    );
    let end = first + columns;
    if end < rows {
        let lower = lower.subrows(end, rows - end);
        matmul(below, accum, lower, across, -1.0, Par::Seq);
    }
}

/// Solves with the factors of [`Cholesky`].
pub(super) struct CholeskyFactors;

impl Substitution for CholeskyFactors {
    fn entries(extent: &Extent) -> usize {
        Cholesky::entries(extent)
    }

    fn forward(factors: &[f64], _exchanges: &[u32], y: &mut [f64], product: &mut [f64]) {
        let w = y.len();
        let (pivots, lower) = factors.split_at(w * w);
        solve_lower(pivots, false, y);
        product.fill(0.0);
        subtract_product(lower, y, product);
    }

    fn backward(factors: &[f64], y: &mut [f64], border: &[f64]) {
        let w = y.len();
        let (pivots, lower) = factors.split_at(w * w);
        subtract_transposed_product(lower, border, y);
        solve_lower_transposed(pivots, y);
    }
}
