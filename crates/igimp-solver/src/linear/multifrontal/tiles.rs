//! Dense work in tiles, so that several threads can share a large front.
//!
//! The size of the tiles is fixed: what is computed for one does not depend on who computes it, nor
//! on how many threads there are.

use faer::MatMut;

/// Columns of a tile.
pub(super) const TILE: usize = 192;

/// Calls `work` with the first column and the columns of each tile of a matrix, on several threads;
/// with the whole matrix at once where it is not `large`.
pub(super) fn by_columns(
    large: bool,
    matrix: MatMut<'_, f64>,
    work: &(impl Fn(usize, MatMut<'_, f64>) + Sync),
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

fn halve(first: usize, matrix: MatMut<'_, f64>, work: &(impl Fn(usize, MatMut<'_, f64>) + Sync)) {
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
