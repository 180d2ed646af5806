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

/// Sparsity pattern of the tangent matrix by blocks: which nodes are coupled.
///
/// All unknowns of two coupled nodes are coupled. Values are stored by columns, rows ascending:
/// what follows from the blocks is a matrix in compressed sparse columns. The pattern is
/// structurally symmetric: node i is listed for j if and only if j is listed for i, and every node
/// is coupled to itself. Both halves are stored, also when the values are symmetric.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// Start of each column in `row_idx`, length `unknowns + 1`.
    pub col_ptr: Vec<usize>,
    /// Row of each stored entry.
    pub row_idx: Vec<usize>,
    /// The nodes that carry unknowns, by ascending unknown; together they cover all of them.
    pub blocks: Vec<NodeBlock>,
    /// Start of the list of each block in `coupled`, length `blocks + 1`.
    pub starts: Vec<usize>,
    /// For each block the blocks that it is coupled to, ascending, itself among them.
    pub coupled: Vec<u32>,
    /// First value of the columns of each block, length `blocks + 1`.
    pub first_value: Vec<usize>,
    /// Largest distance, in nodes along one axis, between two coupled nodes.
    pub reach: usize,
}

impl Pattern {
    /// The pattern of coupled blocks, with lists as described for the fields.
    pub fn new(
        blocks: Vec<NodeBlock>,
        starts: Vec<usize>,
        coupled: Vec<u32>,
        reach: usize,
    ) -> Self {
        let mut first_value = vec![0];
        let mut stored = 0;
        let (mut col_ptr, mut row_idx) = (vec![0], Vec::new());
        for (block, ends) in blocks.iter().zip(starts.windows(2)) {
            let rows = coupled[ends[0]..ends[1]]
                .iter()
                .map(|&row| blocks[row as usize]);
            let height: usize = rows.clone().map(|row| row.len).sum();
            for _ in 0..block.len {
                row_idx.extend(rows.clone().flat_map(|row| row.first..row.first + row.len));
                col_ptr.push(row_idx.len());
            }
            stored += height * block.len;
            first_value.push(stored);
        }
        Self {
            col_ptr,
            row_idx,
            blocks,
            starts,
            coupled,
            first_value,
            reach,
        }
    }

    /// Number of unknowns (rows and columns).
    pub fn unknowns(&self) -> usize {
        self.blocks
            .last()
            .map_or(0, |block| block.first + block.len)
    }

    /// Number of stored entries.
    pub fn stored(&self) -> usize {
        self.first_value.last().copied().unwrap_or(0)
    }

    /// The blocks coupled to a block, ascending.
    pub fn coupled_to(&self, block: usize) -> &[u32] {
        &self.coupled[self.starts[block]..self.starts[block + 1]]
    }

    /// Stored entries of each column of a block.
    pub fn height(&self, block: usize) -> usize {
        (self.first_value[block + 1] - self.first_value[block]) / self.blocks[block].len
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
