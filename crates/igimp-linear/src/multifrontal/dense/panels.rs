//! Products with tall panels and triangles for solves: they read every factor once, and are bound by
//! memory. The order of the sums is fixed. The loops are structures and not closures, which may be compiled apart from
//! the function that has the wide instructions.

use faer::traits::pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::layout::Layout;
use super::scalar::Scalar;

/// Columns that are worked on together.
const WIDTH: usize = 4;

/// Rows and columns of a large panel that a thread works on at a time.
const ROWS: usize = 512;
const COLUMNS: usize = 64;

/// Partial sums of a scalar product.
const LANES: usize = 16;

/// y ← y − A x for a panel A stored by columns; the threads share the rows of a `large` one.
pub(crate) fn subtract_product<T: Scalar>(panel: &[T], x: &[T], y: &mut [T], large: bool) {
    let height = y.len();
    let subtract = |first: usize, y: &mut [T]| {
        Arch::new().dispatch(RowsOfPanel {
            panel,
            height,
            first,
            x,
            y,
        });
    };
    if large && height > ROWS {
        let parts = y.par_chunks_mut(ROWS).enumerate();
        parts.for_each(|(part, y)| subtract(part * ROWS, y));
    } else if height > 0 {
        subtract(0, y);
    }
}

/// The same for some rows of a panel of `height`, from the row `first` on.
struct RowsOfPanel<'a, T> {
    panel: &'a [T],
    height: usize,
    first: usize,
    x: &'a [T],
    y: &'a mut [T],
}

impl<T: Scalar> WithSimd for RowsOfPanel<'_, T> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            panel,
            height,
            first,
            x,
            y,
        } = self;
        let rows = first..first + y.len();
        let mut groups = x.chunks_exact(WIDTH);
        let mut columns = panel.chunks_exact(WIDTH * height);
        for (x, columns) in groups.by_ref().zip(columns.by_ref()) {
            let (a, columns) = columns.split_at(height);
            let (b, columns) = columns.split_at(height);
            let (c, d) = columns.split_at(height);
            let (a, b) = (&a[rows.clone()], &b[rows.clone()]);
            let (c, d) = (&c[rows.clone()], &d[rows.clone()]);
            for ((((y, a), b), c), d) in y.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                *y -= (*a * x[0] + *b * x[1]) + (*c * x[2] + *d * x[3]);
            }
        }
        let rest = columns.remainder().chunks_exact(height);
        for (x, column) in groups.remainder().iter().zip(rest) {
            for (y, a) in y.iter_mut().zip(&column[rows.clone()]) {
                *y -= *a * *x;
            }
        }
    }
}

/// y ← y − Aᵀ x for a panel A stored by columns; the threads share the columns of a `large` one.
pub(crate) fn subtract_transposed_product<T: Scalar>(
    panel: &[T],
    x: &[T],
    y: &mut [T],
    large: bool,
) {
    let rows = x.len();
    let subtract = |panel: &[T], y: &mut [T]| {
        Arch::new().dispatch(ColumnsOfPanel { panel, x, y });
    };
    if large && rows > ROWS {
        let parts = y
            .par_chunks_mut(COLUMNS)
            .zip(panel.par_chunks(COLUMNS * rows));
        parts.for_each(|(y, panel)| subtract(panel, y));
    } else if rows > 0 {
        subtract(panel, y);
    }
}

/// The same for some columns.
struct ColumnsOfPanel<'a, T> {
    panel: &'a [T],
    x: &'a [T],
    y: &'a mut [T],
}

impl<T: Scalar> WithSimd for ColumnsOfPanel<'_, T> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { panel, x, y } = self;
        for (y, column) in y.iter_mut().zip(panel.chunks_exact(x.len())) {
            *y -= dot(column, x);
        }
    }
}

/// y ← L⁻¹ y for the lower triangle of a block, with a diagonal of ones instead of its own where
/// it is `unit`.
pub(crate) fn solve_lower<T: Scalar>(layout: Layout, block: &[T], unit: bool, y: &mut [T]) {
    Arch::new().dispatch(Lower {
        layout,
        block,
        unit,
        y,
    });
}

/// The work of [`solve_lower`].
struct Lower<'a, T> {
    layout: Layout,
    block: &'a [T],
    unit: bool,
    y: &'a mut [T],
}

impl<T: Scalar> WithSimd for Lower<'_, T> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            layout,
            block,
            unit,
            y,
        } = self;
        let rows = y.len();
        let mut rest = block;
        for (first, columns) in layout.strides() {
            let (stride, later) = rest.split_at(columns * (rows - first));
            rest = later;
            for (k, column) in stride.chunks_exact(rows - first).enumerate() {
                let (known, below) = y[first..].split_at_mut(k + 1);
                if !unit {
                    known[k] /= column[k];
                }
                for (value, multiplier) in below.iter_mut().zip(&column[k + 1..]) {
                    *value -= known[k] * *multiplier;
                }
            }
        }
    }
}

/// y ← L⁻ᵀ y for the lower triangle of a block.
pub(crate) fn solve_lower_transposed<T: Scalar>(layout: Layout, block: &[T], y: &mut [T]) {
    Arch::new().dispatch(LowerTransposed { layout, block, y });
}

/// The work of [`solve_lower_transposed`].
struct LowerTransposed<'a, T> {
    layout: Layout,
    block: &'a [T],
    y: &'a mut [T],
}

impl<T: Scalar> WithSimd for LowerTransposed<'_, T> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { layout, block, y } = self;
        let rows = y.len();
        let mut rest = block;
        for (first, columns) in layout.strides().rev() {
            let (earlier, stride) = rest.split_at(rest.len() - columns * (rows - first));
            rest = earlier;
            for (k, column) in stride.chunks_exact(rows - first).enumerate().rev() {
                let (unknown, known) = y[first..].split_at_mut(k + 1);
                unknown[k] = (unknown[k] - dot(&column[k + 1..], known)) / column[k];
            }
        }
    }
}

/// y ← U⁻¹ y for the upper triangle of a square block.
pub(crate) fn solve_upper<T: Scalar>(block: &[T], y: &mut [T]) {
    Arch::new().dispatch(Upper { block, y });
}

/// The work of [`solve_upper`].
struct Upper<'a, T> {
    block: &'a [T],
    y: &'a mut [T],
}

impl<T: Scalar> WithSimd for Upper<'_, T> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { block, y } = self;
        let rows = y.len();
        for (k, column) in block.chunks_exact(rows).enumerate().rev() {
            let (above, known) = y.split_at_mut(k);
            known[0] /= column[k];
            for (value, factor) in above.iter_mut().zip(column) {
                *value -= known[0] * *factor;
            }
        }
    }
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
