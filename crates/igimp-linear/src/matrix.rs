//! The global tangent matrix in sparse columns: a structurally symmetric pattern of coupled nodes
//! that is built once per stencil, and values that are rewritten in every iteration.

use std::ops::Range;
use std::sync::Arc;

use nalgebra_sparse::CscMatrix;
use nalgebra_sparse::pattern::SparsityPattern;

use crate::border::Border;
use crate::{LinearSolverError, check};

/// The bit in [`NodeBlock::free`] of an unknown beside displacement, which is the last of its node: pore pressure.
pub const SCALAR: u8 = 1 << 3;

/// The unknowns that one grid node contributes: consecutive rows and columns of the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NodeBlock {
    /// First unknown of the node.
    pub first: usize,
    /// Number of unknowns of the node, 1 to D, and one more with a scalar.
    pub len: usize,
    /// The components of the displacement that they are, one bit each from the first axis on, and [`SCALAR`].
    pub free: u8,
    /// Position of the node along each axis of the grid (0 beyond the dimension), which lets a
    /// solver order the unknowns geometrically.
    pub place: [usize; 3],
}

/// Sparsity pattern of the tangent matrix by blocks: which nodes are coupled.
///
/// All unknowns of two coupled nodes are coupled. Values are stored by columns, rows ascending: the
/// columns of block j, one after the other, have one value for each unknown of the blocks that j is
/// coupled to. The pattern is structurally symmetric: node i is listed for j if and only if j is
/// listed for i, and every node is coupled to itself. Both halves are stored, also when the values
/// are symmetric.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
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

/// A pattern unknown by unknown, in compressed sparse columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompressedColumns {
    /// Start of each column in `row_idx`, length `unknowns + 1`.
    pub col_ptr: Vec<usize>,
    /// Row of each stored entry, ascending within a column; values keep their order.
    pub row_idx: Vec<usize>,
}

impl Pattern {
    /// The pattern of coupled blocks, with lists as described for the fields.
    pub fn new(
        blocks: Vec<NodeBlock>,
        starts: Vec<usize>,
        coupled: Vec<u32>,
        reach: usize,
    ) -> Self {
        let mut first_value = Vec::with_capacity(blocks.len() + 1);
        let mut stored = 0;
        first_value.push(stored);
        for (block, ends) in blocks.iter().zip(starts.windows(2)) {
            let rows = coupled[ends[0]..ends[1]].iter();
            let height: usize = rows.map(|&row| blocks[row as usize].len).sum();
            stored += height * block.len;
            first_value.push(stored);
        }
        Self {
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
    #[inline]
    pub fn coupled_to(&self, block: usize) -> &[u32] {
        &self.coupled[self.starts[block]..self.starts[block + 1]]
    }

    /// Whether nodes have an unknown beside displacement: the matrix is not positive definite then.
    pub fn has_scalars(&self) -> bool {
        self.blocks.iter().any(|block| block.free & SCALAR != 0)
    }

    /// Stored entries of each column of a block.
    #[inline]
    pub fn height(&self, block: usize) -> usize {
        let stored = self.first_value[block + 1] - self.first_value[block];
        // Division by a known number is fast.
        match self.blocks[block].len {
            1 => stored,
            2 => stored / 2,
            3 => stored / 3,
            len => stored / len,
        }
    }

    /// The values of the columns of a block, `height` for each column.
    #[inline]
    pub fn values_of(&self, block: usize) -> Range<usize> {
        self.first_value[block]..self.first_value[block + 1]
    }

    /// The stored rows of the columns of a block, as runs of consecutive unknowns.
    #[inline]
    pub fn runs(&self, block: usize) -> impl Iterator<Item = Range<usize>> + '_ {
        let mut rows = self
            .coupled_to(block)
            .iter()
            .map(|&row| self.blocks[row as usize])
            .peekable();
        std::iter::from_fn(move || {
            let first = rows.next()?;
            let mut run = first.first..first.first + first.len;
            while let Some(row) = rows.next_if(|row| row.first == run.end) {
                run.end += row.len;
            }
            Some(run)
        })
    }

    /// For each coupled pair of blocks (j, i), in the order of the lists of j, where the rows of j begin within a column of i:
    /// with it the matrix is read by rows.
    ///
    /// # Errors
    /// [`LinearSolverError::Empty`] and [`LinearSolverError::InvalidPattern`].
    pub fn rows_within_columns(&self) -> Result<Vec<u32>, LinearSolverError> {
        check::valid_pattern(self)?;
        check::mirrored(self)
    }

    /// The pattern unknown by unknown, for solvers and tools that know no blocks: eight bytes for
    /// each stored entry.
    pub fn compressed_columns(&self) -> CompressedColumns {
        let mut col_ptr = Vec::with_capacity(self.unknowns() + 1);
        let mut row_idx = Vec::with_capacity(self.stored());
        col_ptr.push(0);
        for (index, block) in self.blocks.iter().enumerate() {
            for _ in 0..block.len {
                row_idx.extend(self.runs(index).flatten());
                col_ptr.push(row_idx.len());
            }
        }
        CompressedColumns { col_ptr, row_idx }
    }
}

/// Tangent matrix K = ∂f_int/∂u over the unknowns of the grid \[force/length\], with the border of rigid
/// bodies.
#[derive(Clone, Debug)]
pub struct TangentMatrix {
    /// The pattern, shared with solvers so that they can tell whether symbolic work still holds.
    pub pattern: Arc<Pattern>,
    /// Stored values \[force/length\], in the order that [`Pattern`] describes.
    pub values: Vec<f64>,
    /// Whether K is symmetric: associated flow everywhere, no interface that slips by friction.
    pub symmetric: bool,
    /// The border: unknowns of rigid bodies.
    pub border: Border,
}

impl TangentMatrix {
    /// A matrix of zeros on a pattern.
    pub fn zeros(pattern: Arc<Pattern>, symmetric: bool) -> Self {
        let values = vec![0.0; pattern.stored()];
        Self {
            pattern,
            values,
            symmetric,
            border: Border::default(),
        }
    }

    /// The product y = K x, one entry per unknown: forces \[force\] from displacements \[length\].
    ///
    /// # Panics
    /// If `x` or `y` is not as long as the number of unknowns.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        assert!(x.len() == self.pattern.unknowns() && y.len() == x.len());
        y.fill(0.0);
        for (index, block) in self.pattern.blocks.iter().enumerate() {
            let height = self.pattern.height(index);
            let columns = &self.values[self.pattern.values_of(index)];
            for (column, entries) in columns.chunks_exact(height).enumerate() {
                let value = x[block.first + column];
                let mut done = 0;
                for run in self.pattern.runs(index) {
                    let (start, len) = (done, run.len());
                    done += len;
                    for (row, entry) in y[run].iter_mut().zip(&entries[start..start + len]) {
                        *row += entry * value;
                    }
                }
            }
        }
    }

    /// The diagonal entry of each unknown \[force/length\].
    pub fn diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        let of_block = move |index: usize| {
            let block = self.pattern.blocks[index];
            let height = self.pattern.height(index);
            let before = self.pattern.coupled_to(index).iter();
            let offset: usize = before
                .take_while(|&&row| (row as usize) < index)
                .map(|&row| self.pattern.blocks[row as usize].len)
                .sum();
            let first = self.pattern.first_value[index] + offset;
            (0..block.len).map(move |column| self.values[first + column * (height + 1)])
        };
        (0..self.pattern.blocks.len()).flat_map(of_block)
    }

    /// A copy as a `nalgebra-sparse` matrix \[force/length\], for independent solvers and for inspection.
    ///
    /// # Panics
    /// Never for a pattern built by this crate: its offsets and rows are valid by construction.
    pub fn to_csc(&self) -> CscMatrix<f64> {
        let n = self.pattern.unknowns();
        let CompressedColumns { col_ptr, row_idx } = self.pattern.compressed_columns();
        let pattern = SparsityPattern::try_from_offsets_and_indices(n, n, col_ptr, row_idx)
            .expect("columns are sorted and unique");
        CscMatrix::try_from_pattern_and_values(pattern, self.values.clone())
            .expect("one value per stored entry")
    }
}
