//! The global tangent matrix in compressed sparse columns: a structurally symmetric pattern of
//! unknowns that is built once per stencil, and values that are rewritten in every iteration.

use std::sync::Arc;

use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;

/// The unknowns that one grid node contributes: consecutive rows and columns of the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeBlock {
    /// First unknown of the node.
    pub first: usize,
    /// Number of unknowns of the node, 1 to D.
    pub len: usize,
    /// Position of the node along each axis of the grid (0 beyond the dimension), which lets a
    /// solver order the unknowns geometrically.
    pub place: [usize; 3],
}

/// Sparsity pattern of the tangent matrix, compressed by columns, rows ascending within a column.
///
/// The pattern is structurally symmetric: (i, j) is stored if and only if (j, i) is. Both halves
/// are stored, also when the values are symmetric.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// Start of each column in `row_idx`, length `unknowns + 1`.
    pub col_ptr: Vec<usize>,
    /// Row of each stored entry.
    pub row_idx: Vec<usize>,
    /// The nodes that carry unknowns, by ascending unknown; together they cover all of them.
    pub blocks: Vec<NodeBlock>,
    /// Largest distance, in nodes along one axis, between two coupled nodes.
    pub reach: usize,
}

impl Pattern {
    /// Number of unknowns (rows and columns).
    pub fn unknowns(&self) -> usize {
        self.col_ptr.len() - 1
    }

    /// Number of stored entries.
    pub fn stored(&self) -> usize {
        self.row_idx.len()
    }
}

/// Tangent matrix K = ∂f_int/∂u over the unknowns \[force/length\].
#[derive(Clone, Debug)]
pub struct TangentMatrix {
    /// The pattern, shared with solvers so that they can tell whether symbolic work still holds.
    pub pattern: Arc<Pattern>,
    /// Stored values, aligned with `pattern.row_idx`.
    pub values: Vec<f64>,
    /// Whether the laws present make K symmetric (associated flow everywhere).
    pub symmetric: bool,
}

impl TangentMatrix {
    /// A matrix of zeros on a pattern.
    pub fn zeros(pattern: Arc<Pattern>, symmetric: bool) -> Self {
        let values = vec![0.0; pattern.stored()];
        Self {
            pattern,
            values,
            symmetric,
        }
    }

    /// The product y = K x.
    ///
    /// # Panics
    /// If `x` or `y` is not as long as the number of unknowns.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        assert!(x.len() == self.pattern.unknowns() && y.len() == x.len());
        y.fill(0.0);
        for (column, &value) in x.iter().enumerate() {
            let range = self.pattern.col_ptr[column]..self.pattern.col_ptr[column + 1];
            for (&row, &entry) in self.pattern.row_idx[range.clone()]
                .iter()
                .zip(&self.values[range])
            {
                y[row] += entry * value;
            }
        }
    }

    /// A copy as a `nalgebra-sparse` matrix, for independent solvers and for inspection.
    ///
    /// # Panics
    /// Never for a pattern built by this crate: its offsets and rows are valid by construction.
    pub fn to_csc(&self) -> CscMatrix<f64> {
        let n = self.pattern.unknowns();
        let pattern = SparsityPattern::try_from_offsets_and_indices(
            n,
            n,
            self.pattern.col_ptr.clone(),
            self.pattern.row_idx.clone(),
        )
        .expect("columns are sorted and unique");
        CscMatrix::try_from_pattern_and_values(pattern, self.values.clone())
            .expect("one value per stored entry")
    }
}
