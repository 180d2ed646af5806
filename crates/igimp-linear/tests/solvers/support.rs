//! Matrices that look like a tangent: particles spread over the cells of a grid, each adding a
//! small symmetric positive semi-definite block to the 3^D nodes of its support.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use igimp_linear::{CompressedColumns, NodeBlock, Pattern, SCALAR, TangentMatrix};

/// Random numbers (Vigna's splitmix64), the same in every run.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^ (bits >> 31)
    }

    /// Uniform in [-1, 1).
    pub(crate) fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A body on a grid of nodes.
#[derive(Clone)]
pub(crate) struct Body {
    /// Nodes along each axis, 1 where there is no such axis.
    pub(crate) nodes: [usize; 3],
    /// Unknowns of a node before supports are taken away.
    pub(crate) dofs: usize,
    /// Particles per 3^D patch of nodes.
    pub(crate) particles: usize,
    /// Fraction of a particle's stiffness that is not symmetric.
    pub(crate) unsymmetric: f64,
    /// Whether only the part below the diagonal x + y of the box is filled.
    pub(crate) slope: bool,
    /// Whether a node has a pore pressure too: the matrix is quasi-definite then.
    pub(crate) pressure: bool,
    pub(crate) seed: u64,
}

impl Body {
    pub(crate) fn plane(nodes_x: usize, nodes_y: usize) -> Self {
        Self {
            nodes: [nodes_x, nodes_y, 1],
            dofs: 2,
            particles: 3,
            unsymmetric: 0.0,
            slope: false,
            pressure: false,
            seed: 7,
        }
    }

    pub(crate) fn line(nodes: usize) -> Self {
        Self {
            nodes: [nodes, 1, 1],
            dofs: 1,
            ..Self::plane(1, 1)
        }
    }

    pub(crate) fn solid(nodes: [usize; 3]) -> Self {
        Self {
            nodes,
            dofs: 3,
            ..Self::plane(1, 1)
        }
    }

    pub(crate) fn unsymmetric(self, fraction: f64) -> Self {
        Self {
            unsymmetric: fraction,
            ..self
        }
    }

    pub(crate) fn slope(self) -> Self {
        Self {
            slope: true,
            ..self
        }
    }

    pub(crate) fn pressure(self) -> Self {
        Self {
            pressure: true,
            ..self
        }
    }

    pub(crate) fn seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Assembles the tangent. The nodes of the first layer along x keep one unknown only, as on a
    /// roller; weak springs hold the body.
    pub(crate) fn tangent(&self) -> TangentMatrix {
        let patches = self.patches();
        let mut random = Random(self.seed);
        let mut couplings: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        let mut first = BTreeMap::new();
        let mut blocks = Vec::new();
        for patch in &patches {
            for &node in patch {
                first.insert(node, (0, 0));
            }
        }
        let mut unknowns = 0;
        for (&node, slot) in &mut first {
            let place = self.place(node);
            let moves = if place[0] == 0 { 1 } else { self.dofs };
            let scalar = if self.pressure { SCALAR } else { 0 };
            let len = moves + usize::from(self.pressure);
            blocks.push(NodeBlock {
                first: unknowns,
                len,
                free: ((1 << moves) - 1) | scalar,
                place,
            });
            *slot = (unknowns, len);
            unknowns += len;
        }

        for patch in &patches {
            let touched: Vec<usize> = patch
                .iter()
                .flat_map(|node| first[node].0..first[node].0 + first[node].1)
                .collect();
            // Three strain modes per particle, and a second set of them for the unsymmetric part.
            let mut stiffness = vec![0.0; touched.len() * touched.len()];
            for _ in 0..3 * self.particles {
                let mode: Vec<f64> = touched.iter().map(|_| random.signed()).collect();
                let skew: Vec<f64> = touched.iter().map(|_| random.signed()).collect();
                for (column, values) in stiffness.chunks_exact_mut(touched.len()).enumerate() {
                    for (row, value) in values.iter_mut().enumerate() {
                        *value += (mode[row] + self.unsymmetric * skew[row]) * mode[column];
                    }
                }
            }
            for (&column, values) in touched.iter().zip(stiffness.chunks_exact(touched.len())) {
                for (&row, value) in touched.iter().zip(values) {
                    *couplings.entry((column, row)).or_default() += value;
                }
            }
            for &unknown in &touched {
                *couplings.entry((unknown, unknown)).or_default() += 0.05;
            }
        }
        if self.pressure {
            let pressures: BTreeSet<usize> = blocks
                .iter()
                .map(|block| block.first + block.len - 1)
                .collect();
            for ((column, row), value) in &mut couplings {
                if pressures.contains(column) && pressures.contains(row) {
                    *value = -*value;
                }
            }
        }
        assemble(&couplings, unknowns, blocks, self.unsymmetric == 0.0)
    }

    fn place(&self, node: usize) -> [usize; 3] {
        let [x, y, _] = self.nodes;
        [node % x, node / x % y, node / (x * y)]
    }

    /// The nodes of each particle position: up to three along each axis.
    fn patches(&self) -> Vec<Vec<usize>> {
        let corners = self.nodes.map(|count| count.saturating_sub(2).max(1));
        let mut patches = Vec::new();
        for z in 0..corners[2] {
            for y in 0..corners[1] {
                for x in 0..corners[0] {
                    if self.slope && x * corners[1] + y * corners[0] > corners[0] * corners[1] {
                        continue;
                    }
                    let mut patch = Vec::new();
                    for dz in 0..3.min(self.nodes[2]) {
                        for dy in 0..3.min(self.nodes[1]) {
                            for dx in 0..3.min(self.nodes[0]) {
                                let rows = (z + dz) * self.nodes[1] + y + dy;
                                patch.push(rows * self.nodes[0] + x + dx);
                            }
                        }
                    }
                    patches.push(patch);
                }
            }
        }
        patches
    }
}

/// A matrix from its entries by (column, row); the pattern is made structurally symmetric, by
/// blocks.
pub(crate) fn assemble(
    entries: &BTreeMap<(usize, usize), f64>,
    unknowns: usize,
    blocks: Vec<NodeBlock>,
    symmetric: bool,
) -> TangentMatrix {
    let mut block_of = Vec::with_capacity(unknowns);
    for (index, block) in blocks.iter().enumerate() {
        block_of.extend(std::iter::repeat_n(index, block.len));
    }
    let mut pairs: BTreeSet<(usize, usize)> = (0..blocks.len()).map(|k| (k, k)).collect();
    for &(column, row) in entries.keys() {
        pairs.insert((block_of[column], block_of[row]));
        pairs.insert((block_of[row], block_of[column]));
    }
    let mut starts = vec![0; blocks.len() + 1];
    for &(column, _) in &pairs {
        starts[column + 1] += 1;
    }
    for column in 0..blocks.len() {
        starts[column + 1] += starts[column];
    }
    let coupled = pairs.iter().map(|&(_, row)| row as u32).collect();
    let pattern = Arc::new(Pattern::new(blocks, starts, coupled, 2));
    let mut matrix = TangentMatrix::zeros(pattern, symmetric);
    let entry_of = |(column, row, _): (usize, usize, usize)| entries.get(&(column, row));
    let values = stored(&matrix.pattern).into_iter().map(entry_of);
    matrix.values = values.map(|value| value.copied().unwrap_or(0.0)).collect();
    matrix
}

/// Column, row and place among the values of every stored entry.
pub(crate) fn stored(pattern: &Pattern) -> Vec<(usize, usize, usize)> {
    let CompressedColumns { col_ptr, row_idx } = pattern.compressed_columns();
    let columns = (0..pattern.unknowns())
        .flat_map(|column| std::iter::repeat_n(column, col_ptr[column + 1] - col_ptr[column]));
    let rows = row_idx.iter().enumerate();
    std::iter::zip(columns, rows)
        .map(|(column, (entry, &row))| (column, row, entry))
        .collect()
}

/// A matrix from dense rows, each unknown a node of its own on a line.
pub(crate) fn from_dense(rows: &[&[f64]], symmetric: bool) -> TangentMatrix {
    let unknowns = rows.len();
    let mut entries = BTreeMap::new();
    for (row, values) in rows.iter().enumerate() {
        for (column, &value) in values.iter().enumerate() {
            if value != 0.0 || row == column {
                entries.insert((column, row), value);
            }
        }
    }
    chain(&entries, unknowns, symmetric)
}

/// A matrix from its entries by (column, row), each unknown a node of its own on a line.
pub(crate) fn chain(
    entries: &BTreeMap<(usize, usize), f64>,
    unknowns: usize,
    symmetric: bool,
) -> TangentMatrix {
    let blocks = (0..unknowns).map(|first| NodeBlock {
        first,
        len: 1,
        free: 1,
        place: [first, 0, 0],
    });
    assemble(entries, unknowns, blocks.collect(), symmetric)
}

/// A solution to recover and the right-hand side that belongs to it.
pub(crate) fn manufactured(matrix: &TangentMatrix, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Random(seed);
    let exact: Vec<f64> = (0..matrix.pattern.unknowns())
        .map(|_| random.signed())
        .collect();
    let mut rhs = vec![0.0; exact.len()];
    matrix.multiply(&exact, &mut rhs);
    (exact, rhs)
}

/// Largest difference of the entries.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |largest, (a, b)| (a - b).abs().max(largest))
}
