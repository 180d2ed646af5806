//! Checks of the input and the output of a solver, shared by all of them.

use std::sync::Arc;

use super::LinearSolverError;
use crate::{Pattern, TangentMatrix};

/// A pivot below this part of the diagonal entry that it is left from has lost all its digits to
/// cancellation: the matrix is then singular to working precision.
const LEAST_PIVOT: f64 = 1e-13;

/// Whether a pattern analysed before still describes the matrix.
pub(super) fn same_pattern(analysed: Option<&Arc<Pattern>>, pattern: &Arc<Pattern>) -> bool {
    analysed.is_some_and(|analysed| Arc::ptr_eq(analysed, pattern) || analysed == pattern)
}

/// Checks that a pattern is not empty, and that its lists are sorted, in range and of the lengths
/// that belong together.
pub(super) fn valid_pattern(pattern: &Pattern) -> Result<(), LinearSolverError> {
    let invalid = |reason, block| Err(LinearSolverError::InvalidPattern { reason, block });
    let Pattern {
        blocks,
        starts,
        coupled,
        first_value,
        ..
    } = pattern;
    if blocks.is_empty() {
        return Err(LinearSolverError::Empty);
    }
    if starts.len() != blocks.len() + 1 || first_value.len() != blocks.len() + 1 {
        return invalid("not one list for each block", 0);
    }
    if starts[0] != 0 || starts[blocks.len()] != coupled.len() || first_value[0] != 0 {
        return invalid("lists do not span the stored blocks", 0);
    }
    let mut next = 0;
    for (index, block) in blocks.iter().enumerate() {
        if block.first != next || block.len == 0 {
            return invalid("node blocks do not follow one another", index);
        }
        next += block.len;
    }
    for index in 0..blocks.len() {
        let Some(rows) = coupled.get(starts[index]..starts[index + 1]) else {
            return invalid("starts of the lists are not ascending", index);
        };
        let in_range = rows
            .last()
            .is_some_and(|&row| (row as usize) < blocks.len());
        if !in_range || !rows.is_sorted_by(|a, b| a < b) {
            return invalid("coupled blocks are not ascending or out of range", index);
        }
        let height: usize = rows.iter().map(|&row| blocks[row as usize].len).sum();
        if first_value[index + 1] != first_value[index] + height * blocks[index].len {
            return invalid("the first value is out of place", index);
        }
    }
    Ok(())
}

/// For each coupled pair of blocks (j, i), in the order of the lists of j, where the rows of j begin
/// within a column of i.
///
/// Fails where i is listed for j and j is not for i, or a block is not coupled to itself.
pub(super) fn mirrored(pattern: &Pattern) -> Result<Vec<u32>, LinearSolverError> {
    // How much of the list of each block is passed, and the rows in that part. Blocks ascend, so
    // that the entries of each list are met in their order.
    let mut passed = vec![(0_u32, 0_u32); pattern.blocks.len()];
    let mut mirrored = Vec::with_capacity(pattern.coupled.len());
    for (index, block) in pattern.blocks.iter().enumerate() {
        let mut itself = false;
        for &other in pattern.coupled_to(index) {
            let (next, rows) = &mut passed[other as usize];
            let entry = pattern.starts[other as usize] + *next as usize;
            let listed = entry < pattern.starts[other as usize + 1]
                && pattern.coupled[entry] as usize == index;
            if !listed {
                let reason = "not structurally symmetric";
                let block = index;
                return Err(LinearSolverError::InvalidPattern { reason, block });
            }
            mirrored.push(*rows);
            *next += 1;
            *rows += block.len as u32;
            itself |= other as usize == index;
        }
        if !itself {
            let (reason, block) = ("not coupled to itself", index);
            return Err(LinearSolverError::InvalidPattern { reason, block });
        }
    }
    Ok(mirrored)
}

/// Statistics of the values of a matrix, in memory that is used again.
#[derive(Debug, Default)]
pub struct Inspection {
    /// Diagonal entries, by unknown.
    pub diagonal: Vec<f64>,
    /// Whether a row has an entry that is not zero.
    filled: Vec<bool>,
}

impl Inspection {
    /// Checks that a matrix has finite values, as many as its pattern stores, and no zero row or
    /// column; takes its diagonal.
    ///
    /// # Errors
    /// [`LinearSolverError::WrongLength`], [`LinearSolverError::NonFinite`] and [`LinearSolverError::Singular`].
    pub fn inspect(&mut self, matrix: &TangentMatrix) -> Result<(), LinearSolverError> {
        let pattern = &*matrix.pattern;
        length("the matrix", matrix.values.len(), pattern.stored())?;
        self.diagonal.clear();
        self.diagonal.extend(matrix.diagonal());
        self.filled.clear();
        self.filled.resize(pattern.unknowns(), false);
        for (index, block) in pattern.blocks.iter().enumerate() {
            let columns = &matrix.values[pattern.values_of(index)];
            if !all_finite(columns) {
                return finite("matrix", &matrix.values);
            }
            for (column, entries) in columns.chunks_exact(pattern.height(index)).enumerate() {
                let mut any = false;
                let mut done = 0;
                for run in pattern.runs(index) {
                    let entries = &entries[done..done + run.len()];
                    done += run.len();
                    for (filled, &entry) in self.filled[run].iter_mut().zip(entries) {
                        *filled |= entry != 0.0;
                        any |= entry != 0.0;
                    }
                }
                if !any {
                    let unknown = Some(block.first + column);
                    return Err(LinearSolverError::Singular { unknown });
                }
            }
        }
        match self.filled.iter().position(|&filled| !filled) {
            Some(row) => Err(LinearSolverError::Singular { unknown: Some(row) }),
            None => Ok(()),
        }
    }
}

/// Whether all values are finite, without a branch for each.
fn all_finite(values: &[f64]) -> bool {
    values
        .iter()
        .fold(true, |all, value| all & value.is_finite())
}

/// Checks that all values are finite.
pub(super) fn finite(array: &'static str, values: &[f64]) -> Result<(), LinearSolverError> {
    if all_finite(values) {
        return Ok(());
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(LinearSolverError::NonFinite { array, index }),
        None => Ok(()),
    }
}

/// Checks the length of a slice.
pub(super) fn length(
    array: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), LinearSolverError> {
    if found == expected {
        Ok(())
    } else {
        Err(LinearSolverError::WrongLength {
            array,
            expected,
            found,
        })
    }
}

/// Checks the pivots of a Cholesky factorisation, given with their unknowns, against the diagonal of
/// the matrix.
pub(super) fn sound_pivots(
    diagonal: &[f64],
    pivots: impl IntoIterator<Item = (usize, f64)>,
) -> Result<(), LinearSolverError> {
    for (unknown, pivot) in pivots {
        if !is_sound(pivot, diagonal[unknown]) {
            return Err(LinearSolverError::NotPositiveDefinite {
                unknown: Some(unknown),
            });
        }
    }
    Ok(())
}

/// Whether a pivot is positive beyond round-off of the diagonal entry that it is left from; one that
/// is not a number is not.
pub(super) fn is_sound(pivot: f64, diagonal: f64) -> bool {
    pivot > LEAST_PIVOT * diagonal
}
