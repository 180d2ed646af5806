//! LU of a front with unsymmetric values.
//!
//! I. S. Duff & J. K. Reid, *The multifrontal solution of unsymmetric sets of linear equations*, SIAM
//! J. Sci. Stat. Comput. 5 (1984). With w pivots and r border unknowns the front is
//!
//! ```text
//!         w     r
//!   w  [  A     Uᵀ ]    A → P A = L₁ U₁ within the block
//!   r  [  L     C  ]    U → (L₁⁻¹ P Uᵀ)ᵀ,  L → L U₁⁻¹,  C = contributions − L Uᵀ
//! ```
//!
//! All blocks are stored by columns, and U transposed, so that both border blocks are tall.

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place,
};
use faer::{Accum, MatMut, MatRef, Par};

use super::super::LinearSolverError;
use super::dense::dense_lu::{PivotRecord, exchange, exchange_columns, factor_block};
use super::dense::layout::Layout;
use super::dense::panels::{
    solve_lower, solve_upper, subtract_product, subtract_transposed_product,
};
use super::dense::scalar::Scalar;
use super::dense::tiles::{TILE, by_columns, tile_width};
use super::extend_add::Target;
use super::kernel::{Contribution, Kernel, Room, Substitution};
use super::scratch::make_room;
use super::tree::plan::Plan;
use crate::TangentMatrix;
use crate::multifrontal::dense::layout::Shape;
use crate::multifrontal::tree::front::{Extent, Front};

/// Elimination of S K S, with the diagonal of S by unknown.
pub(super) struct Lu<'a> {
    pub(super) matrix: &'a TangentMatrix,
    pub(super) scale: &'a [f64],
}

/// The blocks of a front: pivots, below them, and the transpose of the block beside them.
fn blocks<T>(pivots: usize, border: usize, factors: &mut [T]) -> [&mut [T]; 3] {
    let (square, borders) = factors.split_at_mut(pivots * pivots);
    let (lower, upper) = borders.split_at_mut(border * pivots);
    [square, lower, upper]
}

impl<T: Scalar> Kernel<T> for Lu<'_> {
    const SHAPE: Shape = Shape::Square;

    fn entries(extent: &Extent) -> usize {
        extent.squares + 2 * extent.panels
    }

    fn load(&self, plan: &Plan, front: &Front, factors: &mut [T], local: &[u32]) {
        let (w, r) = (front.pivots, front.border);
        let [pivots, lower, upper] = blocks(w, r, factors);
        pivots.fill(T::default());
        lower.fill(T::default());
        upper.fill(T::default());
        let (pattern, values) = (&*plan.pattern, &self.matrix.values);
        for rank in front.columns.clone() {
            let index = plan.order[rank] as usize;
            let block = pattern.blocks[index];
            let first_column = plan.position[rank] as usize - front.first;
            let (first, height) = (pattern.first_value[index], pattern.height(index));
            let column_scale = &self.scale[block.first..block.first + block.len];
            let pairs = pattern.starts[index]..pattern.starts[index + 1];
            let mut offset = 0;
            for (&other, &mirror) in pattern.coupled[pairs.clone()]
                .iter()
                .zip(&plan.mirrored[pairs])
            {
                let row = pattern.blocks[other as usize];
                let row_rank = plan.rank[other as usize] as usize;
                let start = first + offset;
                offset += row.len;
                if row_rank < front.columns.start {
                    continue;
                }
                let row_scale = &self.scale[row.first..row.first + row.len];
                if row_rank < front.columns.end {
                    let first_row = plan.position[row_rank] as usize - front.first;
                    for (c, column_scale) in column_scale.iter().enumerate() {
                        let into = &mut pivots[(first_column + c) * w + first_row..][..row.len];
                        let from = &values[start + c * height..][..row.len];
                        for ((into, from), row_scale) in into.iter_mut().zip(from).zip(row_scale) {
                            *into = T::near(from * (row_scale * column_scale));
                        }
                    }
                    continue;
                }
                let first_row = local[row_rank] as usize;
                let step = pattern.height(other as usize);
                let mirror = pattern.first_value[other as usize] + mirror as usize;
                for (c, column_scale) in column_scale.iter().enumerate() {
                    let place = (first_column + c) * r + first_row;
                    let below = &mut lower[place..place + row.len];
                    let beside = &mut upper[place..place + row.len];
                    let from = &values[start + c * height..][..row.len];
                    for (a, row_scale) in row_scale.iter().enumerate() {
                        let scale = row_scale * column_scale;
                        below[a] = T::near(from[a] * scale);
                        beside[a] = T::near(values[mirror + a * step + c] * scale);
                    }
                }
            }
        }
    }

    fn eliminate(
        &self,
        _plan: &Plan,
        front: &Front,
        factors: &mut [T],
        exchanges: &mut [u32],
        large: bool,
    ) -> Result<PivotRecord, LinearSolverError> {
        let (w, r) = (front.pivots, front.border);
        let [pivots, lower, upper] = blocks(w, r, factors);
        let mut record = PivotRecord::default();
        factor_block(pivots, exchanges, front.first, large, &mut record);
        if r == 0 {
            return Ok(record);
        }
        exchange_columns(upper, r, exchanges);
        let factored = MatRef::from_column_major_slice(&*pivots, w, w);
        let mut upper = MatMut::from_column_major_slice_mut(upper, r, w);
        let mut lower = MatMut::from_column_major_slice_mut(lower, r, w);
        let beside = upper.as_mut().transpose_mut();
        by_columns(large, beside, &|_, tile: MatMut<'_, T>| {
            solve_unit_lower_triangular_in_place(factored, tile, Par::Seq);
        });
        let below = lower.as_mut().transpose_mut();
        by_columns(large, below, &|_, tile: MatMut<'_, T>| {
            solve_lower_triangular_in_place(factored.transpose(), tile, Par::Seq);
        });
        Ok(record)
    }

    fn contribute(
        contribution: Contribution<'_, T>,
        room: Room<'_, T>,
        scratch: &mut Vec<T>,
        large: bool,
    ) -> Result<(), LinearSolverError> {
        let (w, r) = (contribution.front.pivots, contribution.front.border);
        let (below, beside) = contribution.factors[w * w..].split_at(r * w);
        let of_parent = room.parent;
        let [pivots, lower, upper] = blocks(of_parent.pivots, of_parent.border, room.factors);
        let target = |pivots, lower, waiting| Target {
            layout: Layout::square(of_parent.pivots),
            first_pivot: 0,
            pivots,
            lower,
            border: of_parent.border,
            first_waiting: 0,
            waiting,
        };
        let work = Work {
            lower: MatRef::from_column_major_slice(below, r, w),
            upper: MatRef::from_column_major_slice(beside, r, w),
            all_pivots: of_parent.pivots,
            contribution,
        };
        let columns = target(pivots, lower, room.waiting);
        let rows = target(&mut [], upper, &mut []);
        let taken = work.contribution.map.taken;
        if large {
            work.halve(Part::Columns, &(0..r), columns);
            work.halve(Part::Rows, &(0..taken), rows);
            return Ok(());
        }
        let (mut columns, mut rows) = (columns, rows);
        let width = tile_width(r);
        make_room(scratch, r * width.min(r), "contributions")?;
        for (part, end, target) in [
            (Part::Columns, r, &mut columns),
            (Part::Rows, taken, &mut rows),
        ] {
            for first in (0..end).step_by(width) {
                work.tile(part, &(first..end.min(first + width)), target, scratch);
            }
        }
        Ok(())
    }
}

/// Which part of a contribution is worked out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// Columns, without the rows of the pivots of the parent where they are beside them.
    Columns,
    /// Those rows, transposed.
    Rows,
}

/// A contribution that is worked out.
struct Work<'a, T> {
    contribution: Contribution<'a, T>,
    /// Factors below the pivots, and the transpose of those beside them.
    lower: MatRef<'a, T>,
    upper: MatRef<'a, T>,
    /// Pivots of the parent.
    all_pivots: usize,
}

impl<T: Scalar> Work<'_, T> {
    /// Works on some columns in tiles that threads share.
    fn halve(&self, part: Part, columns: &Range<usize>, mut target: Target<'_, T>) {
        let map = self.contribution.map;
        if columns.len() > TILE {
            let middle = columns.start + (columns.len() / 2).next_multiple_of(TILE);
            let later = |column: usize| column.max(map.taken) - map.taken;
            let before = match part {
                Part::Columns => (later(middle) - later(columns.start)) * (map.rows - map.taken),
                Part::Rows => 0,
            };
            let (left, right) = target.cut(map, middle, self.all_pivots, before);
            rayon::join(
                || self.halve(part, &(columns.start..middle), left),
                || self.halve(part, &(middle..columns.end), right),
            );
            return;
        }
        let mut tile = vec![T::default(); map.rows * columns.len()];
        self.tile(part, columns, &mut target, &mut tile);
    }

    /// Works out some columns, those among the pivots of the parent with all rows and the others without them.
    fn tile(&self, part: Part, columns: &Range<usize>, target: &mut Target<'_, T>, tile: &mut [T]) {
        let taken = self.contribution.map.taken;
        let cut = taken.clamp(columns.start, columns.end);
        match part {
            Part::Columns => {
                self.among_pivots(&(columns.start..cut), target, tile);
                self.beyond(&(cut..columns.end), target, tile);
            }
            Part::Rows => self.beside(columns, target, tile),
        }
    }

    /// Columns among the pivots of the parent.
    fn among_pivots(&self, columns: &Range<usize>, target: &mut Target<'_, T>, tile: &mut [T]) {
        let map = self.contribution.map;
        let tile = &mut tile[..map.rows * columns.len()];
        product(tile, map.rows, self.lower, &self.upper, columns);
        for child in self.contribution.children {
            child.add_square(tile, map.rows, columns, 0);
        }
        target.add_columns(map, tile, columns, 0, false);
    }

    /// Columns that wait.
    fn beyond(&self, columns: &Range<usize>, target: &mut Target<'_, T>, tile: &mut [T]) {
        let map = self.contribution.map;
        let height = map.rows - map.taken;
        let tile = &mut tile[..height * columns.len()];
        let lower = self.lower.subrows(map.taken, height);
        product(tile, height, lower, &self.upper, columns);
        for child in self.contribution.children {
            child.add_square(tile, height, columns, map.taken);
        }
        let first = (columns.start.max(map.taken) - map.taken - target.first_waiting) * height;
        target.waiting[first..][..tile.len()].copy_from_slice(tile);
    }

    /// Rows of the pivots of the parent beside them, transposed.
    fn beside(&self, rows: &Range<usize>, target: &mut Target<'_, T>, tile: &mut [T]) {
        let map = self.contribution.map;
        let height = map.rows - map.taken;
        let tile = &mut tile[..height * rows.len()];
        let upper = self.upper.subrows(map.taken, height);
        product(tile, height, upper, &self.lower, rows);
        for child in self.contribution.children {
            child.add_transposed(tile, height, rows, map.taken);
        }
        target.add_below(map, tile, rows, map.taken);
    }
}

/// A tile becomes −A Bᵀ for some rows of B.
fn product<T: Scalar>(
    tile: &mut [T],
    height: usize,
    left: MatRef<'_, T>,
    right: &MatRef<'_, T>,
    rows: &Range<usize>,
) {
    if height == 0 || rows.is_empty() {
        return;
    }
    let across = right.subrows(rows.start, rows.len()).transpose();
    let tile = MatMut::from_column_major_slice_mut(tile, height, rows.len());
    matmul(tile, Accum::Replace, left, across, -T::near(1.0), Par::Seq);
}

/// Solves with the factors of [`Lu`].
pub(super) struct LuFactors;

impl<T: Scalar> Substitution<T> for LuFactors {
    fn entries(extent: &Extent) -> usize {
        <Lu as Kernel<T>>::entries(extent)
    }

    fn forward(factors: &[T], exchanges: &[u32], y: &mut [T], product: &mut [T], large: bool) {
        let (w, r) = (y.len(), product.len());
        exchange(y, 0, exchanges);
        solve_lower(Layout::square(w), &factors[..w * w], true, y);
        product.fill(T::default());
        subtract_product(&factors[w * w..][..r * w], y, product, large);
    }

    fn backward(factors: &[T], y: &mut [T], border: &[T], large: bool) {
        let (w, r) = (y.len(), border.len());
        subtract_transposed_product(&factors[w * (w + r)..], border, y, large);
        solve_upper(&factors[..w * w], y);
    }
}
