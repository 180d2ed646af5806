//! Signs of pivots of a quasi-definite block: A = L J Lᵀ with J = ±1, and the sign of each pivot on the diagonal of L.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::{
    LdltError, LdltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::prelude::IntoConst;
use faer::{MatMut, MatRef, Par, Spec};

use super::layout::Layout;
use super::scalar::Scalar;

/// The pivots that are negative, ascending; none in a positive definite block.
#[derive(Debug, Default)]
pub(crate) struct Signs {
    negative: Vec<usize>,
}

/// A pivot of L.
pub(crate) fn pivot<T: Scalar>(layout: Layout, pivots: &[T], pivot: usize) -> T {
    pivots[layout.offset(pivot) + pivot - layout.first_row(pivot)]
}

impl Signs {
    /// Those of L in a layout of so many rows.
    pub(crate) fn of<T: Scalar>(layout: Layout, pivots: &[T], rows: usize) -> Self {
        Self::find(rows, |k| pivot(layout, pivots, k))
    }

    /// Those of L in a square.
    pub(crate) fn of_block<T: Scalar>(factored: MatRef<'_, T>) -> Self {
        Self::find(factored.nrows(), |k| factored[(k, k)])
    }

    fn find<T: Scalar>(rows: usize, pivot: impl Fn(usize) -> T) -> Self {
        let negative = (0..rows).filter(|&k| pivot(k) < T::default());
        Self {
            negative: negative.collect(),
        }
    }

    /// X → J X.
    pub(crate) fn apply<T: Scalar>(&self, mut tile: MatMut<'_, T>) {
        for &k in &self.negative {
            for value in tile.as_mut().row_mut(k).iter_mut() {
                *value = -*value;
            }
        }
    }

    /// L J for some rows of L; a copy where a pivot is negative.
    pub(crate) fn times<'a, T: Scalar>(
        &self,
        rows: MatRef<'a, T>,
        copy: &'a mut Vec<T>,
    ) -> MatRef<'a, T> {
        if self.negative.is_empty() {
            return rows;
        }
        for column in rows.col_iter() {
            copy.extend(column.iter());
        }
        let mut signed = MatMut::from_column_major_slice_mut(copy, rows.nrows(), rows.ncols());
        self.apply(signed.as_mut().transpose_mut());
        signed.into_const()
    }
}

/// A → L in the lower half of a square block; the number of a pivot that is zero otherwise.
pub(crate) fn factor_block<T: Scalar>(mut block: MatMut<'_, T>) -> Result<(), usize> {
    let rows = block.nrows();
    let scratch = cholesky_in_place_scratch::<T>(rows, Par::Seq, Spec::default());
    cholesky_in_place(
        block.as_mut(),
        LdltRegularization::default(),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Spec::default(),
    )
    .map_err(|LdltError::ZeroPivot { index }| index)?;
    // From a unit diagonal and D = J |D| to L |D|^½ with the signs of D.
    for k in 0..rows {
        let size = block[(k, k)].wide();
        let root = T::near(size.abs().sqrt().copysign(size));
        block[(k, k)] = root;
        for value in block
            .as_mut()
            .col_mut(k)
            .subrows_mut(k + 1, rows - k - 1)
            .iter_mut()
        {
            *value *= root;
        }
    }
    Ok(())
}
