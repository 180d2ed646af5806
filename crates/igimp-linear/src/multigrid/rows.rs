//! Matrices by rows of nodes, in single precision, as a preconditioner reads them.
//!
//! Every node has B components, those without an unknown among them: their rows and columns are zero. The
//! entries of a node are B rows, one after the other, each with B entries for every node that it is coupled
//! to.

use std::ops::Range;

use faer::traits::pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::{Pattern, TangentMatrix};

/// Nodes that one task works on.
const CHUNK: usize = 256;

/// Which nodes are coupled.
#[derive(Clone, Debug, Default)]
pub(super) struct Couplings {
    /// Start of the list of each node in `nodes`, length nodes + 1.
    pub(super) starts: Vec<usize>,
    /// For each node those that it is coupled to, ascending, itself among them.
    pub(super) nodes: Vec<u32>,
    /// Where each node itself stands in its list.
    pub(super) diagonal: Vec<u32>,
}

impl Couplings {
    /// From lists, each with the node itself.
    pub(super) fn new(starts: Vec<usize>, nodes: Vec<u32>) -> Self {
        let diagonal = (0..starts.len() - 1).map(|node| {
            let list = &nodes[starts[node]..starts[node + 1]];
            list.partition_point(|&other| (other as usize) < node) as u32
        });
        Self {
            diagonal: diagonal.collect(),
            starts,
            nodes,
        }
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// The nodes that a node is coupled to.
    pub(super) fn of(&self, node: usize) -> &[u32] {
        &self.nodes[self.starts[node]..self.starts[node + 1]]
    }

    /// Where the entries of a node begin.
    pub(super) fn first<const B: usize>(&self, node: usize) -> usize {
        B * B * self.starts[node]
    }

    /// Number of entries of all nodes.
    pub(super) fn entries<const B: usize>(&self) -> usize {
        B * B * self.nodes.len()
    }
}

/// Calls `work` with runs of nodes and the values stored for them, on several threads; `first` says where the part of
/// a node begins.
pub(super) fn each_chunk<T: Send>(
    nodes: usize,
    values: &mut [T],
    first: impl Fn(usize) -> usize + Sync,
    work: impl Fn(Range<usize>, &mut [T]) + Sync,
) {
    let mut parts = Vec::with_capacity(nodes.div_ceil(CHUNK));
    let mut rest = values;
    for start in (0..nodes).step_by(CHUNK) {
        let end = (start + CHUNK).min(nodes);
        let (part, later) = rest.split_at_mut(first(end) - first(start));
        rest = later;
        parts.push((start..end, part));
    }
    parts
        .into_par_iter()
        .for_each(|(nodes, part)| work(nodes, part));
}

/// Where the unknowns of a pattern stand among the components of its nodes.
pub(super) fn slots<const B: usize>(pattern: &Pattern) -> Vec<u32> {
    let mut slots = Vec::with_capacity(pattern.unknowns());
    for (node, block) in pattern.blocks.iter().enumerate() {
        let listed = block.free.count_ones() as usize == block.len && block.free >> B == 0;
        let free = if listed {
            block.free
        } else {
            (1 << block.len) - 1
        };
        let axes = (0..B).filter(|axis| free >> axis & 1 == 1);
        slots.extend(axes.map(|axis| (node * B + axis) as u32));
    }
    slots
}

/// The entries of a matrix by rows, times `scale`. `mirrored` gives for each coupled pair (j, i) where the rows of j
/// begin within a column of i.
pub(super) fn convert<const B: usize>(
    matrix: &TangentMatrix,
    couplings: &Couplings,
    slots: &[u32],
    mirrored: &[u32],
    scale: f64,
    values: &mut Vec<f32>,
) {
    let pattern = &*matrix.pattern;
    values.clear();
    values.resize(couplings.entries::<B>(), 0.0);
    let first = |node| couplings.first::<B>(node);
    each_chunk(couplings.len(), values, first, |nodes, mut part| {
        for node in nodes {
            let (entries, later) =
                std::mem::take(&mut part).split_at_mut(first(node + 1) - first(node));
            part = later;
            let block = pattern.blocks[node];
            let list = pattern.starts[node]..pattern.starts[node + 1];
            let width = B * list.len();
            let (start, height) = (pattern.first_value[node], pattern.height(node));
            let mut offset = 0;
            for (place, pair) in list.enumerate() {
                let other = pattern.coupled[pair] as usize;
                let across = pattern.blocks[other];
                let step = pattern.height(other);
                let mirror = pattern.first_value[other] + mirrored[pair] as usize;
                for r in 0..block.len {
                    let row = slots[block.first + r] as usize % B;
                    for c in 0..across.len {
                        let column = slots[across.first + c] as usize % B;
                        let value = if matrix.symmetric {
                            matrix.values[start + r * height + offset + c]
                        } else {
                            matrix.values[mirror + c * step + r]
                        };
                        entries[row * width + B * place + column] = (value * scale) as f32;
                    }
                }
                offset += across.len;
            }
        }
    });
}

/// r ← b − A x.
pub(super) fn residual<const B: usize>(
    couplings: &Couplings,
    values: &[f32],
    rhs: &[f32],
    x: &[f32],
    residual: &mut [f32],
) {
    each_chunk(
        couplings.len(),
        residual,
        |node| B * node,
        |nodes, part| {
            Arch::new().dispatch(Residual::<B> {
                couplings,
                values,
                rhs,
                x,
                nodes,
                part,
            });
        },
    );
}

/// The work of [`residual`] for some nodes.
struct Residual<'a, const B: usize> {
    couplings: &'a Couplings,
    values: &'a [f32],
    rhs: &'a [f32],
    x: &'a [f32],
    nodes: Range<usize>,
    part: &'a mut [f32],
}

impl<const B: usize> WithSimd for Residual<'_, B> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            couplings,
            values,
            rhs,
            x,
            nodes,
            part,
        } = self;
        for (node, residual) in nodes.zip(part.chunks_exact_mut(B)) {
            let list = couplings.of(node);
            let first = couplings.first::<B>(node);
            let entries = &values[first..first + B * B * list.len()];
            let sums = row_products::<B>(entries, B * list.len(), 0, list, x, 0);
            for ((r, rhs), sum) in residual.iter_mut().zip(&rhs[B * node..]).zip(sums) {
                *r = rhs - sum;
            }
        }
    }
}

/// Partial sums of a product.
const LANES: usize = 16;
/// Partial sums of its rest.
const FEW: usize = 4;
/// Nodes whose part of a vector is gathered at once.
const GATHERED: usize = 64;

/// The products of the rows of a node, each `width` long, with the part of `x` that belongs to `list`; the
/// entries of the first of them begin `skip` into each row. `x` begins with the component `before`.
#[expect(
    clippy::inline_always,
    reason = "it takes the vector instructions of its caller"
)]
#[inline(always)]
pub(super) fn row_products<const B: usize>(
    entries: &[f32],
    width: usize,
    skip: usize,
    list: &[u32],
    x: &[f32],
    before: usize,
) -> [f32; B] {
    let mut gathered = [0.0_f32; 3 * GATHERED];
    let mut sums = [0.0_f32; B];
    let mut begin = skip;
    for nodes in list.chunks(GATHERED) {
        let len = B * nodes.len();
        for (slot, &node) in gathered[..len].chunks_exact_mut(B).zip(nodes) {
            slot.copy_from_slice(&x[B * node as usize - before..][..B]);
        }
        let rows: [&[f32]; B] = std::array::from_fn(|r| &entries[r * width + begin..][..len]);
        let found = products(&rows, &gathered[..len]);
        for (sum, found) in sums.iter_mut().zip(found) {
            *sum += found;
        }
        begin += len;
    }
    sums
}

/// The products of some rows with a vector, in lanes that are added up in the end.
#[expect(
    clippy::inline_always,
    reason = "it takes the vector instructions of its caller"
)]
#[inline(always)]
fn products<const B: usize>(rows: &[&[f32]; B], x: &[f32]) -> [f32; B] {
    let mut lanes = [[0.0_f32; LANES]; B];
    let mut few = [[0.0_f32; FEW]; B];
    let mut sums = [0.0_f32; B];
    let whole = x.len() / LANES * LANES;
    for (chunk, x) in x[..whole].chunks_exact(LANES).enumerate() {
        for (lanes, row) in lanes.iter_mut().zip(rows) {
            let row = &row[chunk * LANES..][..LANES];
            for ((lane, a), x) in lanes.iter_mut().zip(row).zip(x) {
                *lane += a * x;
            }
        }
    }
    let fours = x.len() / FEW * FEW;
    for at in (whole..fours).step_by(FEW) {
        let x = &x[at..][..FEW];
        for (lanes, row) in few.iter_mut().zip(rows) {
            let row = &row[at..][..FEW];
            for ((lane, a), x) in lanes.iter_mut().zip(row).zip(x) {
                *lane += a * x;
            }
        }
    }
    for (sum, row) in sums.iter_mut().zip(rows) {
        for (a, x) in row[fours..].iter().zip(&x[fours..]) {
            *sum += a * x;
        }
    }
    for ((sum, lanes), few) in sums.iter_mut().zip(&lanes).zip(&few) {
        for four in lanes.chunks_exact(4).chain(few.chunks_exact(4)) {
            *sum += (four[0] + four[1]) + (four[2] + four[3]);
        }
    }
    sums
}
