//! Checks of what goes into a solver and what comes out of it, shared by all of them.

use std::sync::Arc;

use igimp_assembly::{Pattern, TangentMatrix};

use super::LinearSolverError;

/// A pivot below this part of the diagonal entry that it is left from has lost all its digits to
/// cancellation: the matrix is then singular to working precision.
const LEAST_PIVOT: f64 = 1e-13;

/// Whether a pattern analysed before still describes the matrix.
pub(super) fn same_pattern(analysed: Option<&Arc<Pattern>>, pattern: &Arc<Pattern>) -> bool {
    analysed.is_some_and(|analysed| Arc::ptr_eq(analysed, pattern) || analysed == pattern)
}

/// Checks that a pattern is not empty, sorted, in range and covered by its node blocks.
pub(super) fn valid_pattern(pattern: &Pattern) -> Result<(), LinearSolverError> {
    let invalid = |reason, column| Err(LinearSolverError::InvalidPattern { reason, column });
    let Some(unknowns) = pattern
        .col_ptr
        .len()
        .checked_sub(1)
        .filter(|&unknowns| unknowns > 0)
    else {
        return Err(LinearSolverError::Empty);
    };
    if pattern.col_ptr[0] != 0 || pattern.col_ptr[unknowns] != pattern.row_idx.len() {
        return invalid("column starts do not span the stored rows", 0);
    }
    for column in 0..unknowns {
        let (start, end) = (pattern.col_ptr[column], pattern.col_ptr[column + 1]);
        let Some(rows) = pattern.row_idx.get(start..end) else {
            return invalid("column starts are not ascending", column);
        };
        if !rows.is_sorted_by(|a, b| a < b) || rows.last().is_some_and(|&row| row >= unknowns) {
            return invalid("rows are not ascending or out of range", column);
        }
    }
    let mut next = 0;
    for block in &pattern.blocks {
        if block.first != next || block.len == 0 {
            return invalid("node blocks do not follow one another", next);
        }
        next += block.len;
    }
    if next != unknowns {
        return invalid("node blocks do not cover the unknowns", next.min(unknowns));
    }
    Ok(())
}

/// Checks that a matrix has finite values, as many as its pattern stores, and no zero row or
/// column.
pub(super) fn valid_values(matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
    let Pattern {
        col_ptr, row_idx, ..
    } = &*matrix.pattern;
    let unknowns = matrix.pattern.unknowns();
    length("the matrix", matrix.values.len(), row_idx.len())?;
    finite("matrix", &matrix.values)?;
    let mut row_filled = vec![false; unknowns];
    for column in 0..unknowns {
        let mut column_filled = false;
        for entry in col_ptr[column]..col_ptr[column + 1] {
            let filled = matrix.values[entry] != 0.0;
            row_filled[row_idx[entry]] |= filled;
            column_filled |= filled;
        }
        if !column_filled {
            return Err(LinearSolverError::Singular {
                unknown: Some(column),
            });
        }
    }
    match row_filled.iter().position(|&filled| !filled) {
        Some(row) => Err(LinearSolverError::Singular { unknown: Some(row) }),
        None => Ok(()),
    }
}

/// Checks that all values are finite.
pub(super) fn finite(what: &'static str, values: &[f64]) -> Result<(), LinearSolverError> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(LinearSolverError::NonFinite { what, index }),
        None => Ok(()),
    }
}

/// Checks the length of a slice.
pub(super) fn length(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), LinearSolverError> {
    if found == expected {
        Ok(())
    } else {
        Err(LinearSolverError::WrongLength {
            what,
            expected,
            found,
        })
    }
}

/// Keeps a copy of the matrix, in the memory of the copy kept before where that fits.
pub(super) fn keep(kept: &mut Option<TangentMatrix>, matrix: &TangentMatrix) {
    match kept {
        Some(kept) => {
            kept.pattern = Arc::clone(&matrix.pattern);
            kept.values.clone_from(&matrix.values);
            kept.symmetric = matrix.symmetric;
        }
        None => *kept = Some(matrix.clone()),
    }
}

/// The diagonal entry of an unknown, zero where none is stored.
pub(super) fn diagonal(matrix: &TangentMatrix, unknown: usize) -> f64 {
    let entries = matrix.pattern.col_ptr[unknown]..matrix.pattern.col_ptr[unknown + 1];
    let rows = &matrix.pattern.row_idx[entries.clone()];
    rows.binary_search(&unknown)
        .map_or(0.0, |offset| matrix.values[entries.start + offset])
}

/// Checks the pivots of a Cholesky factorisation, given with their unknowns.
pub(super) fn sound_pivots(
    matrix: &TangentMatrix,
    pivots: impl IntoIterator<Item = (usize, f64)>,
) -> Result<(), LinearSolverError> {
    for (unknown, pivot) in pivots {
        let sound = pivot > LEAST_PIVOT * diagonal(matrix, unknown);
        if !sound {
            return Err(LinearSolverError::NotPositiveDefinite {
                unknown: Some(unknown),
            });
        }
    }
    Ok(())
}
