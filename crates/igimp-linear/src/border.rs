//! The rows and columns of the tangent that belong to rigid bodies, and to a load factor that is unknown: few and
//! long, so they stay out of the sparse matrix.

/// The border of a tangent matrix: the coupling of the unknowns of rigid bodies, and a load factor that is unknown, to
/// those of the grid and to one another.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Border {
    /// By unknown of a body its column, one entry per unknown of the grid \[force/length\].
    pub columns: Vec<Vec<f64>>,
    /// By unknown of a body its row, likewise.
    pub rows: Vec<Vec<f64>>,
    /// The rows of the block of the bodies alone.
    pub corner: Vec<Vec<f64>>,
}

impl Border {
    /// A border of zeros for so many unknowns of bodies and of the grid.
    pub fn zeros(bodies: usize, grid: usize) -> Self {
        Self {
            columns: vec![vec![0.0; grid]; bodies],
            rows: vec![vec![0.0; grid]; bodies],
            corner: vec![vec![0.0; bodies]; bodies],
        }
    }

    /// Adds an unknown behind all others: its column and its row, both by unknown of the grid and then of the border,
    /// and its entry on the diagonal.
    ///
    /// # Panics
    /// If column or row are shorter than the unknowns before.
    pub fn append(&mut self, column: &[f64], row: &[f64], corner: f64) {
        let of_border = self.corner.len();
        let of_grid = column.len() - of_border;
        self.columns.push(column[..of_grid].to_vec());
        self.rows.push(row[..of_grid].to_vec());
        for (entries, entry) in self.corner.iter_mut().zip(&column[of_grid..]) {
            entries.push(*entry);
        }
        let mut last = row[of_grid..].to_vec();
        last.push(corner);
        self.corner.push(last);
    }

    /// Number of unknowns of the border.
    pub fn len(&self) -> usize {
        self.corner.len()
    }

    /// Whether no body has an unknown.
    pub fn is_empty(&self) -> bool {
        self.corner.is_empty()
    }

    /// Adds to the entry of a row and a column, counted through grid and bodies; at least one belongs to
    /// a body.
    pub fn add(&mut self, grid: usize, row: usize, column: usize, value: f64) {
        if row < grid {
            self.columns[column - grid][row] += value;
        } else if column < grid {
            self.rows[row - grid][column] += value;
        } else {
            self.corner[row - grid][column - grid] += value;
        }
    }
}
