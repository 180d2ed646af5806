//! Symmetric scaling S K S, so that "small" means the same for every pivot.
//!
//! Nodes at the rim of the body carry a stiffness many orders below that of the others; without a
//! scaling their sound pivots would look like lost ones. The scale starts from the diagonal, which
//! makes every entry of a positive definite matrix at most 1, and one sweep of D. Ruiz's
//! equilibration (report RAL-TR-2001-034) does the same for the others. Scales are powers of two:
//! no digit is lost.

use igimp_assembly::{Pattern, TangentMatrix};

use super::super::check::diagonal;

/// The diagonal of S. The matrix must have finite values and no zero row or column.
pub(super) fn symmetric_scale(matrix: &TangentMatrix) -> Vec<f64> {
    let unknowns = matrix.pattern.unknowns();
    let diagonal: Vec<f64> = (0..unknowns)
        .map(|unknown| diagonal(matrix, unknown).abs())
        .collect();
    let mut scale = vec![1.0; unknowns];
    if diagonal.contains(&0.0) {
        scale = largest_scaled(matrix, &scale);
    }
    for (scale, &diagonal) in scale.iter_mut().zip(&diagonal) {
        *scale = 1.0 / if diagonal > 0.0 { diagonal } else { *scale }.sqrt();
    }
    let largest = largest_scaled(matrix, &scale);
    for (scale, largest) in scale.iter_mut().zip(largest) {
        *scale = power_of_two_near(*scale / largest.sqrt());
    }
    scale
}

/// Largest magnitude in each row and column together of S K S.
fn largest_scaled(matrix: &TangentMatrix, scale: &[f64]) -> Vec<f64> {
    let Pattern {
        col_ptr, row_idx, ..
    } = &*matrix.pattern;
    let mut largest = vec![0.0_f64; scale.len()];
    for column in 0..scale.len() {
        for entry in col_ptr[column]..col_ptr[column + 1] {
            let row = row_idx[entry];
            let size = (matrix.values[entry] * scale[row] * scale[column]).abs();
            largest[row] = largest[row].max(size);
            largest[column] = largest[column].max(size);
        }
    }
    largest
}

/// The power of two nearest to a positive number, on a logarithmic scale.
fn power_of_two_near(value: f64) -> f64 {
    value.log2().round().exp2()
}
