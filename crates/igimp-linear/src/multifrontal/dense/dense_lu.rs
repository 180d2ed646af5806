//! Dense kernel: LU of a pivot block with pivots from the block only.
//!
//! G. H. Golub & C. F. Van Loan, *Matrix Computations*, 4th ed., 2013, section 3.4, recursive by
//! columns so that the work is in matrix products (S. Toledo, SIAM J. Matrix Anal. Appl. 18, 1997).
//! A pivot that has lost all digits is replaced instead of searched for outside of the block
//! (X. S. Li & J. W. Demmel, *Making sparse Gaussian elimination scalable by static pivoting*, SC98).

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_unit_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};

use super::scalar::Scalar;
use super::tiles::by_columns;

/// Columns that are eliminated one by one.
const NARROW: usize = 8;

/// Pivots replaced and growth met in a factorisation.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PivotRecord {
    /// How many pivots were replaced.
    pub(crate) replaced: usize,
    /// Position in the order of elimination of the first of them.
    pub(crate) first_replaced: Option<usize>,
    /// Largest magnitude in the factorised pivot blocks.
    pub(crate) largest: f64,
}

impl PivotRecord {
    /// Adds the record of later pivots.
    pub(crate) fn add(&mut self, later: &Self) {
        self.replaced += later.replaced;
        self.first_replaced = self.first_replaced.or(later.first_replaced);
        self.largest = self.largest.max(later.largest);
    }
}

/// Factorises a square block, stored by columns, into P A = L U in its place; row k was exchanged
/// with row `exchanges[k]` ≥ k. `first` is the position of the first pivot, for the record; a
/// `large` block is shared by the threads.
pub(crate) fn factor_block<T: Scalar>(
    block: &mut [T],
    exchanges: &mut [u32],
    first: usize,
    large: bool,
    record: &mut PivotRecord,
) {
    let rows = exchanges.len();
    let mut panel = Panel {
        rows,
        first,
        large,
        record,
    };
    panel.factor(block, 0, exchanges);
    let sizes = block.iter().map(|value| value.wide().abs());
    record.largest = sizes.fold(record.largest, f64::max);
}

/// Data that the columns of a block share.
struct Panel<'a> {
    rows: usize,
    /// Position of the first pivot of the block.
    first: usize,
    large: bool,
    record: &'a mut PivotRecord,
}

impl Panel<'_> {
    /// Factorises some columns, whose first pivot is in row `top`.
    fn factor<T: Scalar>(&mut self, columns: &mut [T], top: usize, exchanges: &mut [u32]) {
        let (rows, count) = (self.rows, exchanges.len());
        if count <= NARROW {
            self.factor_narrow(columns, top, exchanges);
            return;
        }
        let half = (count / 2).next_multiple_of(NARROW).min(count - 1);
        let middle = top + half;
        let (left, right) = columns.split_at_mut(half * rows);
        let (left_exchanges, right_exchanges) = exchanges.split_at_mut(half);
        self.factor(left, top, left_exchanges);

        let factored = MatRef::from_column_major_slice(left, rows, half);
        let (pivots, below) = (
            factored.subrows(top, half),
            factored.subrows(middle, rows - middle),
        );
        let remaining = MatMut::from_column_major_slice_mut(right, rows, count - half);
        by_columns(self.large, remaining, &|_, mut tile: MatMut<'_, T>| {
            for column in tile.as_mut().col_iter_mut() {
                if let Some(column) = column.try_as_col_major_mut() {
                    exchange(column.as_slice_mut(), top, left_exchanges);
                }
            }
            let (mut upper, lower) = tile.subrows_mut(top, rows - top).split_at_row_mut(half);
            solve_unit_lower_triangular_in_place(pivots, upper.as_mut(), Par::Seq);
            matmul(
                lower,
                Accum::Add,
                below,
                upper.as_ref(),
                -T::near(1.0),
                Par::Seq,
            );
        });

        self.factor(right, middle, right_exchanges);
        for column in left.chunks_exact_mut(rows) {
            exchange(column, middle, right_exchanges);
        }
    }

    /// Factorises a few columns one after the other.
    fn factor_narrow<T: Scalar>(&mut self, columns: &mut [T], top: usize, exchanges: &mut [u32]) {
        let rows = self.rows;
        for k in 0..exchanges.len() {
            let pivot_row = top + k;
            let column = &mut columns[k * rows..(k + 1) * rows];
            let mut chosen = pivot_row;
            for row in pivot_row + 1..rows {
                if size(column[row]) > size(column[chosen]) {
                    chosen = row;
                }
            }
            if size(column[chosen]) <= T::LOST {
                chosen = pivot_row;
                let is_negative = column[chosen].wide().is_sign_negative();
                column[chosen] = if is_negative {
                    -T::REPLACEMENT
                } else {
                    T::REPLACEMENT
                };
                self.record.replaced += 1;
                let position = self.first + pivot_row;
                self.record.first_replaced.get_or_insert(position);
            }
            exchanges[k] = u32::try_from(chosen).expect("a front has fewer than 2^32 rows");
            for column in columns.chunks_exact_mut(rows) {
                column.swap(pivot_row, chosen);
            }

            let (eliminated, later) = columns.split_at_mut((k + 1) * rows);
            let (above, multipliers) = eliminated[k * rows..].split_at_mut(pivot_row + 1);
            let inverse = T::near(1.0) / above[pivot_row];
            for value in &mut *multipliers {
                *value *= inverse;
            }
            for column in later.chunks_exact_mut(rows) {
                let (above, below) = column.split_at_mut(pivot_row + 1);
                let factor = above[pivot_row];
                for (value, multiplier) in below.iter_mut().zip(&*multipliers) {
                    *value -= factor * *multiplier;
                }
            }
        }
    }
}

/// Its magnitude.
fn size<T: Scalar>(value: T) -> T {
    if value < T::default() { -value } else { value }
}

/// Exchanges row `top + k` with row `exchanges[k]`, in turn, in a column.
pub(crate) fn exchange<T>(column: &mut [T], top: usize, exchanges: &[u32]) {
    for (k, &other) in exchanges.iter().enumerate() {
        column.swap(top + k, other as usize);
    }
}

/// Exchanges column k with column `exchanges[k]`, in turn, of a panel with columns of `rows` entries.
pub(crate) fn exchange_columns<T>(panel: &mut [T], rows: usize, exchanges: &[u32]) {
    for (k, &other) in exchanges.iter().enumerate() {
        let other = other as usize;
        if other > k {
            let (front, back) = panel.split_at_mut(other * rows);
            front[k * rows..(k + 1) * rows].swap_with_slice(&mut back[..rows]);
        }
    }
}
