//! Symmetric scaling S K S, so that "small" means the same for every pivot.
//!
//! Nodes at the rim of the body carry a stiffness many orders below that of the others; without a
//! scaling their sound pivots would look like lost ones. The scale starts from the diagonal, which
//! makes every entry of a positive definite matrix at most 1, and one sweep of D. Ruiz's
//! equilibration (report RAL-TR-2001-034) does the same for the others. Scales are powers of two:
//! no digit is lost.

use crate::TangentMatrix;

/// The diagonal of S, in memory that is used again.
#[derive(Default)]
pub(super) struct Scaling {
    pub(super) scale: Vec<f64>,
    /// Largest magnitude in each row and column together.
    largest: Vec<f64>,
}

impl Scaling {
    /// Finds the scale. The matrix must have finite values and no zero row or column; its diagonal
    /// is given.
    pub(super) fn fit(&mut self, matrix: &TangentMatrix, diagonal: &[f64]) {
        self.scale.clear();
        self.scale.resize(diagonal.len(), 1.0);
        if diagonal.contains(&0.0) {
            self.find_largest(matrix);
            self.scale.copy_from_slice(&self.largest);
        }
        for (scale, diagonal) in self.scale.iter_mut().zip(diagonal) {
            let size = if *diagonal == 0.0 {
                *scale
            } else {
                diagonal.abs()
            };
            *scale = 1.0 / size.sqrt();
        }
        self.find_largest(matrix);
        for (scale, largest) in self.scale.iter_mut().zip(&self.largest) {
            *scale = power_of_two_near(*scale / largest.sqrt());
        }
    }

    /// Largest magnitude in each row and column together of S K S.
    fn find_largest(&mut self, matrix: &TangentMatrix) {
        let Self { scale, largest } = self;
        let pattern = &*matrix.pattern;
        largest.clear();
        largest.resize(scale.len(), 0.0);
        for (index, block) in pattern.blocks.iter().enumerate() {
            let columns = &matrix.values[pattern.values_of(index)];
            for (column, entries) in columns.chunks_exact(pattern.height(index)).enumerate() {
                let column = block.first + column;
                let (column_scale, mut of_column) = (scale[column], 0.0_f64);
                let mut done = 0;
                for run in pattern.runs(index) {
                    let entries = &entries[done..done + run.len()];
                    done += run.len();
                    let rows = largest[run.clone()].iter_mut().zip(&scale[run]);
                    for ((largest, row_scale), entry) in rows.zip(entries) {
                        let size = (entry * row_scale * column_scale).abs();
                        *largest = if size > *largest { size } else { *largest };
                        of_column = if size > of_column { size } else { of_column };
                    }
                }
                largest[column] = largest[column].max(of_column);
            }
        }
    }
}

/// The power of two nearest to a positive normal number, on a logarithmic scale.
fn power_of_two_near(value: f64) -> f64 {
    // Without its mantissa a number is the power of two below it.
    const EXPONENT: u64 = 0x7FF0_0000_0000_0000;
    f64::from_bits((value * std::f64::consts::SQRT_2).to_bits() & EXPONENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_near_on_a_logarithmic_scale() {
        for exponent in -900..900 {
            let power = f64::from(exponent).exp2();
            for part in [0.72, 0.9, 1.0, 1.2, 1.4] {
                assert!((power_of_two_near(power * part) / power - 1.0).abs() < 1e-15);
            }
        }
    }
}
