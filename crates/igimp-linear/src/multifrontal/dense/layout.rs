//! How the pivots of a front are stored: as a square, or, where they are many and only the lower half
//! counts, as columns that begin at the first row of their stride.

/// Pivots that are factorised at once in a front that the threads share.
pub(crate) const STRIDE: usize = 128;

/// Symmetric pivot blocks with at least so many rows do without most entries above their diagonal. In the
/// plane there are hardly any.
const WIDE: usize = 1536;

/// Where the columns of a pivot block lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    rows: usize,
    /// Columns that begin at the same row.
    stride: usize,
}

impl Layout {
    /// All rows of all columns.
    pub(crate) fn square(rows: usize) -> Self {
        let stride = rows.max(1);
        Self { rows, stride }
    }

    /// The layout of the lower half of a symmetric block.
    pub(crate) fn lower(rows: usize) -> Self {
        if rows < WIDE {
            Self::square(rows)
        } else {
            let stride = STRIDE;
            Self { rows, stride }
        }
    }

    /// Whether it is one square.
    pub(crate) fn is_square(self) -> bool {
        self.stride >= self.rows
    }

    /// Number of entries.
    pub(crate) fn entries(self) -> usize {
        self.offset(self.rows)
    }

    /// The first row that a column has.
    pub(crate) fn first_row(self, column: usize) -> usize {
        column / self.stride * self.stride
    }

    /// Where a column begins.
    pub(crate) fn offset(self, column: usize) -> usize {
        let strides = column / self.stride;
        let before = strides * self.stride;
        // Strides of full width, each shorter by its width than the one before.
        let triangle = self.stride * self.stride * (strides * strides.saturating_sub(1) / 2);
        self.stride * self.rows * strides - triangle
            + (column - before) * (self.rows - before.min(self.rows))
    }

    /// The strides: first row and column, and number of columns.
    pub(crate) fn strides(self) -> impl DoubleEndedIterator<Item = (usize, usize)> {
        (0..self.rows.div_ceil(self.stride)).map(move |number| {
            let first = number * self.stride;
            (first, self.stride.min(self.rows - first))
        })
    }
}

/// How the contribution of a front is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Border × border entries, by columns.
    Square,
    /// The entries from the diagonal on, by columns.
    Triangle,
}

impl Shape {
    /// Entries for a border with so many unknowns.
    pub(crate) fn entries(self, border: usize) -> usize {
        match self {
            Self::Square => border * border,
            Self::Triangle => triangle(border),
        }
    }
}

/// Entries of the lower triangle of a symmetric block with so many rows, stored by columns from the diagonal on.
pub(crate) fn triangle(rows: usize) -> usize {
    rows * (rows + 1) / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_follow_one_another() {
        for layout in [Layout::square(7), Layout::lower(5), Layout::lower(2000)] {
            let mut next = 0;
            for column in 0..layout.rows {
                assert_eq!(layout.offset(column), next);
                assert!(layout.first_row(column) <= column);
                next += layout.rows - layout.first_row(column);
            }
            assert_eq!(layout.entries(), next);
        }
        assert_eq!(Layout::square(7).entries(), 49);
        let wide = Layout::lower(2000);
        assert!(!wide.is_square() && wide.entries() < 2_200_000);
        assert_eq!(wide.strides().last(), Some((1920, 80)));
    }
}
