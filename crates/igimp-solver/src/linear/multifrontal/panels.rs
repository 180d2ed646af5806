//! Products of tall panels with vectors, for solves: they read every factor once, and are bound by
//! memory. The order of the sums is fixed.

use faer::traits::pulp::Arch;

/// Columns, or lanes of a sum, that are worked on together.
const WIDTH: usize = 4;

/// y ← y − A x for a panel A stored by columns.
pub(super) fn subtract_product(panel: &[f64], x: &[f64], y: &mut [f64]) {
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
                *y -= (a * x[0] + b * x[1]) + (c * x[2] + d * x[3]);
            }
        }
        let rest = columns.remainder().chunks_exact(rows);
        for (x, column) in groups.remainder().iter().zip(rest) {
            for (y, a) in y.iter_mut().zip(column) {
                *y -= a * x;
            }
        }
    });
}

/// y ← y − Aᵀ x for a panel A stored by columns.
pub(super) fn subtract_transposed_product(panel: &[f64], x: &[f64], y: &mut [f64]) {
    if x.is_empty() {
        return;
    }
    Arch::new().dispatch(|| {
        for (y, column) in y.iter_mut().zip(panel.chunks_exact(x.len())) {
            let mut lanes = [[0.0; WIDTH]; WIDTH];
            let mut x_groups = x.chunks_exact(WIDTH * WIDTH);
            let mut groups = column.chunks_exact(WIDTH * WIDTH);
            for (x, group) in x_groups.by_ref().zip(groups.by_ref()) {
                for (lane, sums) in lanes.iter_mut().enumerate() {
                    for k in 0..WIDTH {
                        sums[k] += x[lane * WIDTH + k] * group[lane * WIDTH + k];
                    }
                }
            }
            let mut sum = 0.0;
            for (x, a) in x_groups.remainder().iter().zip(groups.remainder()) {
                sum += x * a;
            }
            for sums in lanes {
                sum += (sums[0] + sums[1]) + (sums[2] + sums[3]);
            }
            *y -= sum;
        }
    });
}
