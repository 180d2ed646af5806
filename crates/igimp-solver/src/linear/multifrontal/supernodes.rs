//! Supernodes: runs of nodes that are eliminated together as one dense front.
//!
//! C. Ashcraft & R. Grimes, *The influence of relaxed supernode partitions on the multifrontal
//! method*, ACM Trans. Math. Softw. 15 (1989). Nodes whose columns of L have the same rows form a
//! supernode; small supernodes are then merged with their parents where a few zeros more in the
//! dense blocks cost less than a front of its own.

use super::elimination_tree::{NONE, NodeGraph, column_counts};

/// A set of nodes that one front eliminates. Nodes are numbered in postorder.
pub(super) struct Supernode {
    /// The nodes that are eliminated.
    pub(super) columns: Vec<usize>,
    /// The later nodes that they are coupled to, ascending.
    pub(super) rows: Vec<usize>,
    /// The supernode of the first row, or [`NONE`].
    pub(super) parent: usize,
    /// Unknowns of `columns`.
    pub(super) pivots: usize,
    /// Unknowns of `rows`.
    pub(super) border: usize,
}

/// The supernodes of a graph numbered in postorder; `parent` is its elimination tree and `dofs`
/// the number of unknowns per node. Every supernode stands before its parent.
pub(super) fn supernodes(graph: &NodeGraph, parent: &[usize], dofs: &[usize]) -> Vec<Supernode> {
    merged(fundamental(graph, parent, dofs))
}

/// Maximal runs of nodes with nested columns of L.
fn fundamental(graph: &NodeGraph, parent: &[usize], dofs: &[usize]) -> Vec<Supernode> {
    let counts = column_counts(graph, parent);
    let unknowns = |nodes: &[usize]| nodes.iter().map(|&node| dofs[node]).sum();
    // The supernodes whose parent in the elimination tree is each node.
    let mut below: Vec<Vec<usize>> = vec![Vec::new(); graph.len()];
    let mut seen_by = vec![NONE; graph.len()];
    let mut found: Vec<Supernode> = Vec::new();
    let mut start = 0;
    while start < graph.len() {
        let mut end = start + 1;
        while end < graph.len() && parent[end - 1] == end && counts[end - 1] == counts[end] + 1 {
            end += 1;
        }
        let this = found.len();
        let mut rows = Vec::with_capacity(counts[end - 1] - 1);
        let mut add = |row: usize| {
            if row >= end && seen_by[row] != this {
                seen_by[row] = this;
                rows.push(row);
            }
        };
        for node in start..end {
            graph.neighbours(node).iter().copied().for_each(&mut add);
            for &child in &below[node] {
                found[child].rows.iter().copied().for_each(&mut add);
            }
        }
        rows.sort_unstable();
        for child in (start..end).flat_map(|node| std::mem::take(&mut below[node])) {
            found[child].parent = this;
        }
        if parent[end - 1] != NONE {
            below[parent[end - 1]].push(this);
        }
        let columns: Vec<usize> = (start..end).collect();
        let (pivots, border) = (unknowns(&columns), unknowns(&rows));
        found.push(Supernode {
            columns,
            rows,
            parent: NONE,
            pivots,
            border,
        });
        start = end;
    }
    found
}

/// Merges children into their parents where that is estimated to save time.
fn merged(mut supernodes: Vec<Supernode>) -> Vec<Supernode> {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); supernodes.len()];
    let mut into: Vec<usize> = (0..supernodes.len()).collect();
    for this in 0..supernodes.len() {
        for child in std::mem::take(&mut children[this]) {
            let (low, high) = (&supernodes[child], &supernodes[this]);
            let apart = effort(low.pivots, low.border) + effort(high.pivots, high.border);
            if effort(low.pivots + high.pivots, high.border) <= apart {
                into[child] = this;
                let mut columns = std::mem::take(&mut supernodes[child].columns);
                supernodes[this].pivots += supernodes[child].pivots;
                columns.append(&mut supernodes[this].columns);
                supernodes[this].columns = columns;
            }
        }
        if supernodes[this].parent != NONE {
            children[supernodes[this].parent].push(this);
        }
    }
    // A parent stands after its children, so that its own fate is known first from the end.
    for this in (0..supernodes.len()).rev() {
        into[this] = into[into[this]];
    }
    let is_kept = |this: &usize| into[*this] == *this;
    let mut number = vec![NONE; supernodes.len()];
    for (new, old) in (0..supernodes.len()).filter(is_kept).enumerate() {
        number[old] = new;
    }
    for supernode in &mut supernodes {
        if supernode.parent != NONE {
            supernode.parent = number[into[supernode.parent]];
        }
    }
    let kept = supernodes
        .into_iter()
        .enumerate()
        .filter(|(this, _)| is_kept(this));
    kept.map(|(_, supernode)| supernode).collect()
}

/// Estimated time of a front, in floating-point operations of the dense kernels.
fn effort(pivots: usize, border: usize) -> f64 {
    /// Of moving an entry through memory: once into the front and once on to the parent.
    const PER_ENTRY: f64 = 8.0;
    /// Of a front, however small: index work and calls of kernels.
    const PER_FRONT: f64 = 20_000.0;
    let (w, r) = (pivots as f64, border as f64);
    let operations = w * (w * w * (2.0 / 3.0) + 2.0 * r * (w + r));
    operations + PER_ENTRY * ((w + r) * (w + r) + r * r) + PER_FRONT
}
