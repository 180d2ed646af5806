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

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_unit_lower_triangular_in_place,
};
use faer::{Accum, MatMut, MatRef, Par};
use igimp_assembly::TangentMatrix;

use super::super::LinearSolverError;
use super::dense_lu::{PivotRecord, exchange, exchange_columns, factor_block};
use super::extend_add::{Block, BorderMap};
use super::kernel::{Kernel, Room, Shape, Substitution};
use super::panels::{solve_lower, solve_upper, subtract_product, subtract_transposed_product};
use super::plan::{Front, Plan};
use super::tasks::Extent;
use super::tiles::by_columns;

/// Elimination of S K S, with the diagonal of S by unknown.
pub(super) struct Lu<'a> {
    pub(super) matrix: &'a TangentMatrix,
    pub(super) scale: &'a [f64],
}

/// The blocks of a front: pivots, below them, and the transpose of what is beside them.
fn blocks(pivots: usize, border: usize, factors: &mut [f64]) -> [&mut [f64]; 3] {
    let (square, borders) = factors.split_at_mut(pivots * pivots);
    let (lower, upper) = borders.split_at_mut(border * pivots);
    [square, lower, upper]
}

impl Kernel for Lu<'_> {
    const SHAPE: Shape = Shape::Square;

    fn entries(extent: &Extent) -> usize {
        extent.squares + 2 * extent.panels
    }

    fn load(&self, plan: &Plan, front: &Front, factors: &mut [f64], local: &[u32]) {
        let (w, r) = (front.pivots, front.border);
        let [pivots, lower, upper] = blocks(w, r, factors);
        pivots.fill(0.0);
        lower.fill(0.0);
        upper.fill(0.0);
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
                            *into = from * (row_scale * column_scale);
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
                        below[a] = from[a] * scale;
                        beside[a] = values[mirror + a * step + c] * scale;
                    }
                }
            }
        }
    }

    fn add(front: &Front, factors: &mut [f64], child: &[f64], map: &BorderMap) {
        let (w, r) = (front.pivots, front.border);
        let [pivots, lower, upper] = blocks(w, r, factors);
        let block = |entries, rows| Block { entries, rows };
        map.add_to_pivots(child, &mut block(pivots, w), &mut block(lower, r));
        map.add_transposed(child, &mut block(upper, r));
    }

    fn eliminate(
        &self,
        _plan: &Plan,
        front: &Front,
        room: Room,
        large: bool,
    ) -> Result<PivotRecord, LinearSolverError> {
        let (w, r) = (front.pivots, front.border);
        let [pivots, lower, upper] = blocks(w, r, room.factors);
        let mut record = PivotRecord::default();
        factor_block(pivots, room.exchanges, front.first, large, &mut record);
        if r == 0 {
            return Ok(record);
        }
        exchange_columns(upper, r, room.exchanges);
        let factored = MatRef::from_column_major_slice(&*pivots, w, w);
        let mut upper = MatMut::from_column_major_slice_mut(upper, r, w);
        let mut lower = MatMut::from_column_major_slice_mut(lower, r, w);
        by_columns(large, upper.as_mut().transpose_mut(), &|_,
                                                            tile: MatMut<
            '_,
            f64,
        >| {
            solve_unit_lower_triangular_in_place(factored, tile, Par::Seq);
        });
        by_columns(large, lower.as_mut().transpose_mut(), &|_,
                                                            tile: MatMut<
            '_,
            f64,
        >| {
            solve_lower_triangular_in_place(factored.transpose(), tile, Par::Seq);
        });
        let (lower, upper) = (lower.as_ref(), upper.as_ref().transpose());
        let contribution = MatMut::from_column_major_slice_mut(room.contribution, r, r);
        by_columns(large, contribution, &|first, tile: MatMut<'_, f64>| {
            let upper = upper.subcols(first, tile.ncols());
            matmul(tile, Accum::Replace, lower, upper, -1.0, Par::Seq);
        });
        Ok(record)
    }

    fn pass_on(front: &Front, child: &[f64], map: &BorderMap, contribution: &mut [f64]) {
        let mut contribution = Block {
            entries: contribution,
            rows: front.border,
        };
        map.pass_on(child, &mut contribution);
    }
}

/// Solves with the factors of [`Lu`].
pub(super) struct LuFactors;

impl Substitution for LuFactors {
    fn entries(extent: &Extent) -> usize {
        Lu::entries(extent)
    }

    fn forward(factors: &[f64], exchanges: &[u32], y: &mut [f64], product: &mut [f64]) {
        let (w, r) = (y.len(), product.len());
        exchange(y, 0, exchanges);
        solve_lower(&factors[..w * w], true, y);
        product.fill(0.0);
        subtract_product(&factors[w * w..][..r * w], y, product);
    }

    fn backward(factors: &[f64], y: &mut [f64], border: &[f64]) {
        let (w, r) = (y.len(), border.len());
        subtract_transposed_product(&factors[w * (w + r)..], border, y);
        solve_upper(&factors[..w * w], y);
    }
}
