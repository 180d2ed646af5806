//! Dense work in tiles, so that several threads can share a large front.
//!
//! The size of the tiles is fixed: what is computed for one does not depend on who computes it, nor
//! on how many threads there are.

use faer::MatMut;

use super::scalar::Scalar;

/// Columns of a tile.
pub(crate) const TILE: usize = 192;

/// Columns of a tile of so many rows on one thread: the whole of a small front.
pub(crate) fn tile_width(rows: usize) -> usize {
    if rows <= 3 * TILE { rows.max(1) } else { TILE }
}

/// Calls `work` with the first column and the columns of each tile of a matrix, on several threads;
/// with the whole matrix at once where it is not `large`.
pub(crate) fn by_columns<T: Scalar>(
    large: bool,
    matrix: MatMut<'_, T>,
    work: &(impl Fn(usize, MatMut<'_, T>) + Sync),
) {
    if matrix.ncols() == 0 {
        return;
    }
    if large {
        halve(0, matrix, work);
    } else {
        work(0, matrix);
    }
}

fn halve<T: Scalar>(
    first: usize,
    matrix: MatMut<'_, T>,
    work: &(impl Fn(usize, MatMut<'_, T>) + Sync),
) {
    let columns = matrix.ncols();
    if columns <= TILE {
        work(first, matrix);
        return;
    }
    let half = (columns / 2).next_multiple_of(TILE);
    let (left, right) = matrix.split_at_col_mut(half);
    rayon::join(
        || halve(first, left, work),
        || halve(first + half, right, work),
    );
}
