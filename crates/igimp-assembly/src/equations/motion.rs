//! Where mass is in the matrix.

use crate::equations::system::System;

impl<const D: usize> System<'_, D> {
    /// The place in the matrix that couples a component of the column node with the same of the row node; both of
    /// the grid. None where one of them is held.
    pub(crate) fn place_of(&self, row: usize, column: usize, axis: usize) -> Option<usize> {
        let rank = self.unknowns.index(row, axis)? - self.unknowns.before(row);
        let component = self.unknowns.index(column, axis)? - self.unknowns.before(column);
        Some(self.table.value(&self.pattern, column, component, row) + rank)
    }
}
