//! Products with tall panels and triangles for solves: they read every factor once, and are bound by
//! memory. The order of the sums is fixed.

use faer::traits::pulp::Arch;

use super::layout::Layout;
use super::scalar::Scalar;

/// Columns that are worked on together.
const WIDTH: usize = 4;

/// Partial sums of a scalar product.
const LANES: usize = 16;

/// y ← y − A x for a panel A stored by columns.
pub(super) fn subtract_product<T: Scalar>(panel: &[T], x: &[T], y: &mut [T]) {
    let rows = y.len();
    if rows == 0 {
        return;
    }
    Arch::new().dispatch(|| {
        let mut groups = x.chunks_exact(WIDTH);
        let mut columns = panel.chunks_exact(WIDTH * rows);
        for (x, columns) in groups.by_ref().zip(columns.by_ref()) {
            let (a, columns) = columns.split_at(rows);
            let (b, columns) = columns.split_at(rows);
            let (c, d) = columns.split_at(rows);
            for ((((y, a), b), c), d) in y.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                *y -= (*a * x[0] + *b * x[1]) + (*c * x[2] + *d * x[3]);
            }
        }
        let rest = columns.remainder().chunks_exact(rows);
        for (x, column) in groups.remainder().iter().zip(rest) {
            for (y, a) in y.iter_mut().zip(column) {
                *y -= *a * *x;
            }
        }
    });
}

/// y ← y − Aᵀ x for a panel A stored by columns.
pub(super) fn subtract_transposed_product<T: Scalar>(panel: &[T], x: &[T], y: &mut [T]) {
    if x.is_empty() {
        return;
    }
    Arch::new().dispatch(|| {
        for (y, column) in y.iter_mut().zip(panel.chunks_exact(x.len())) {
            *y -= dot(column, x);
        }
    });
}

/// y ← L⁻¹ y for the lower triangle of a block, with a diagonal of ones instead of its own where
/// it is `unit`.
pub(super) fn solve_lower<T: Scalar>(layout: Layout, block: &[T], unit: bool, y: &mut [T]) {
    Arch::new().dispatch(|| {
        let rows = y.len();
        let mut rest = block;
        for (first, columns) in layout.strides() {
            let (own, later) = rest.split_at(columns * (rows - first));
            rest = later;
            for (k, column) in own.chunks_exact(rows - first).enumerate() {
                let (known, below) = y[first..].split_at_mut(k + 1);
                if !unit {
                    known[k] /= column[k];
                }
                for (value, multiplier) in below.iter_mut().zip(&column[k + 1..]) {
                    *value -= known[k] * *multiplier;
                }
            }
        }
    });
}

/// y ← L⁻ᵀ y for the lower triangle of a block.
pub(super) fn solve_lower_transposed<T: Scalar>(layout: Layout, block: &[T], y: &mut [T]) {
    Arch::new().dispatch(|| {
        let rows = y.len();
        let mut rest = block;
        for (first, columns) in layout.strides().rev() {
            let (earlier, own) = rest.split_at(rest.len() - columns * (rows - first));
            rest = earlier;
            for (k, column) in own.chunks_exact(rows - first).enumerate().rev() {
                let (unknown, known) = y[first..].split_at_mut(k + 1);
                unknown[k] = (unknown[k] - dot(&column[k + 1..], known)) / column[k];
            }
        }
    });
}

/// y ← U⁻¹ y for the upper triangle of a square block.
pub(super) fn solve_upper<T: Scalar>(block: &[T], y: &mut [T]) {
    Arch::new().dispatch(|| {
        let rows = y.len();
        for (k, column) in block.chunks_exact(rows).enumerate().rev() {
            let (above, known) = y.split_at_mut(k);
            known[0] /= column[k];
            for (value, factor) in above.iter_mut().zip(column) {
                *value -= known[0] * *factor;
            }
        }
    });
}

/// The scalar product of two vectors, in lanes that are added up in the end.
#[expect(
    clippy::inline_always,
    reason = "it takes the vector instructions of its caller"
)]
#[inline(always)]
fn dot<T: Scalar>(a: &[T], b: &[T]) -> T {
    let mut lanes = [T::default(); LANES];
    let (mut a, mut b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    for (a, b) in a.by_ref().zip(b.by_ref()) {
        for (lane, (a, b)) in lanes.iter_mut().zip(a.iter().zip(b)) {
            *lane += *a * *b;
        }
    }
    let mut sum = T::default();
    for (a, b) in a.remainder().iter().zip(b.remainder()) {
        sum += *a * *b;
    }
    for four in lanes.chunks_exact(WIDTH) {
        sum += (four[0] + four[1]) + (four[2] + four[3]);
    }
    sum
}
