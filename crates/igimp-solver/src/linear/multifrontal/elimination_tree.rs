//! The graph of coupled nodes and its elimination tree.
//!
//! J. W. H. Liu, *The role of elimination trees in sparse factorization*, SIAM J. Matrix Anal.
//! Appl. 11 (1990); J. R. Gilbert, E. G. Ng & B. W. Peyton, *An efficient algorithm to compute row
//! and column counts for sparse Cholesky factorization*, ibid. 15 (1994). Everything is counted in
//! grid nodes, not in unknowns: the graph is then four or nine times smaller.

use igimp_assembly::Pattern;

/// Marks the absence of a node, such as the parent of a root.
pub(super) const NONE: usize = usize::MAX;

/// Which nodes are coupled, without the nodes themselves.
pub(super) struct NodeGraph {
    starts: Vec<usize>,
    neighbours: Vec<usize>,
}

impl NodeGraph {
    /// The graph of a pattern, nodes numbered as its blocks.
    pub(super) fn new(pattern: &Pattern) -> Self {
        let mut node_of = Vec::with_capacity(pattern.unknowns());
        for (node, block) in pattern.blocks.iter().enumerate() {
            node_of.resize(block.first + block.len, node);
        }
        let mut seen_by = vec![NONE; pattern.blocks.len()];
        let mut graph = Self {
            starts: vec![0],
            neighbours: Vec::new(),
        };
        for (node, block) in pattern.blocks.iter().enumerate() {
            seen_by[node] = node;
            let entries = pattern.col_ptr[block.first]..pattern.col_ptr[block.first + block.len];
            for &row in &pattern.row_idx[entries] {
                let other = node_of[row];
                if seen_by[other] != node {
                    seen_by[other] = node;
                    graph.neighbours.push(other);
                }
            }
            graph.starts.push(graph.neighbours.len());
        }
        graph
    }

    /// The same graph with node `order[k]` called k.
    pub(super) fn renumbered(&self, order: &[usize]) -> Self {
        let mut number = vec![0; order.len()];
        for (new, &old) in order.iter().enumerate() {
            number[old] = new;
        }
        let mut graph = Self {
            starts: vec![0],
            neighbours: Vec::with_capacity(self.neighbours.len()),
        };
        for &old in order {
            graph
                .neighbours
                .extend(self.neighbours(old).iter().map(|&other| number[other]));
            graph.starts.push(graph.neighbours.len());
        }
        graph
    }

    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    pub(super) fn neighbours(&self, node: usize) -> &[usize] {
        &self.neighbours[self.starts[node]..self.starts[node + 1]]
    }
}

/// Parent of each node in the elimination tree of a graph that is eliminated in its numbering, or
/// [`NONE`].
pub(super) fn parents(graph: &NodeGraph) -> Vec<usize> {
    let mut parent = vec![NONE; graph.len()];
    // The root of the subtree found so far, with shortcuts.
    let mut ancestor = vec![NONE; graph.len()];
    for node in 0..graph.len() {
        for &earlier in graph.neighbours(node).iter().filter(|&&other| other < node) {
            let mut climber = earlier;
            while ancestor[climber] != NONE && ancestor[climber] != node {
                climber = std::mem::replace(&mut ancestor[climber], node);
            }
            if ancestor[climber] == NONE {
                ancestor[climber] = node;
                parent[climber] = node;
            }
        }
    }
    parent
}

/// The nodes of a forest in postorder, children in ascending order. Needs parents that are greater
/// than their children.
pub(super) fn postorder(parent: &[usize]) -> Vec<usize> {
    let mut first_child = vec![NONE; parent.len()];
    let mut next_sibling = vec![NONE; parent.len()];
    let mut roots = Vec::new();
    for node in (0..parent.len()).rev() {
        if parent[node] == NONE {
            roots.push(node);
        } else {
            next_sibling[node] = std::mem::replace(&mut first_child[parent[node]], node);
        }
    }
    let mut order = Vec::with_capacity(parent.len());
    let mut path = Vec::new();
    for root in roots.into_iter().rev() {
        path.push(root);
        while let Some(&node) = path.last() {
            let child = std::mem::replace(&mut first_child[node], NONE);
            if child == NONE {
                path.pop();
                order.push(node);
                if let Some(&above) = path.last() {
                    first_child[above] = next_sibling[node];
                }
            } else {
                path.push(child);
            }
        }
    }
    order
}

/// Number of nodes in each column of the factor L, the diagonal included, of a graph numbered in
/// postorder of its elimination tree.
pub(super) fn column_counts(graph: &NodeGraph, parent: &[usize]) -> Vec<usize> {
    let nodes = graph.len();
    // First descendant of each node: its subtree is the range from there to itself.
    let mut first: Vec<usize> = (0..nodes).collect();
    for node in 0..nodes {
        if parent[node] != NONE {
            first[parent[node]] = first[parent[node]].min(first[node]);
        }
    }
    // Row i of L occupies a subtree of the elimination tree. Its leaves count one each; where two
    // branches meet, one is taken off, and one above its root i. Summing over subtrees then gives
    // each column its number of rows.
    let mut change = vec![0_isize; nodes];
    let mut last_leaf = vec![NONE; nodes];
    let mut joined: Vec<usize> = (0..nodes).collect();
    for node in 0..nodes {
        if first[node] == node {
            change[node] += 1;
        }
        if parent[node] != NONE {
            change[parent[node]] -= 1;
        }
        for &row in graph.neighbours(node).iter().filter(|&&row| row > node) {
            let previous = last_leaf[row];
            if previous != NONE && first[node] <= previous {
                continue;
            }
            change[node] += 1;
            if previous != NONE {
                change[meeting_point(&mut joined, previous)] -= 1;
            }
            last_leaf[row] = node;
        }
        if parent[node] != NONE {
            joined[node] = parent[node];
        }
    }
    for node in 0..nodes {
        if parent[node] != NONE {
            change[parent[node]] += change[node];
        }
    }
    change.into_iter().map(isize::unsigned_abs).collect()
}

/// The root of the joined subtree around a node: its lowest ancestor that is not yet passed.
fn meeting_point(joined: &mut [usize], node: usize) -> usize {
    let mut root = node;
    while joined[root] != root {
        root = joined[root];
    }
    let mut climber = node;
    while joined[climber] != root {
        climber = std::mem::replace(&mut joined[climber], root);
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A graph from pairs of coupled nodes.
    fn graph(nodes: usize, pairs: &[(usize, usize)]) -> NodeGraph {
        let mut starts = vec![0];
        let mut neighbours = Vec::new();
        for node in 0..nodes {
            for &(a, b) in pairs {
                if a == node {
                    neighbours.push(b);
                } else if b == node {
                    neighbours.push(a);
                }
            }
            starts.push(neighbours.len());
        }
        NodeGraph { starts, neighbours }
    }

    /// Column counts by playing the elimination on sets.
    fn counts_by_elimination(graph: &NodeGraph) -> Vec<usize> {
        let nodes = graph.len();
        let mut coupled = vec![vec![false; nodes]; nodes];
        for node in 0..nodes {
            for &other in graph.neighbours(node) {
                coupled[node][other] = true;
            }
        }
        let mut counts = Vec::new();
        for node in 0..nodes {
            let later: Vec<usize> = (node + 1..nodes).filter(|&k| coupled[node][k]).collect();
            for &a in &later {
                for &b in &later {
                    coupled[a][b] = true;
                }
            }
            counts.push(later.len() + 1);
        }
        counts
    }

    #[test]
    fn counts_match_elimination_on_random_graphs() {
        let mut state = 1_u64;
        for nodes in 1..40 {
            let mut pairs = Vec::new();
            for a in 0..nodes {
                for b in a + 1..nodes {
                    state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1);
                    if (state >> 33).is_multiple_of(9) {
                        pairs.push((a, b));
                    }
                }
            }
            let graph = graph(nodes, &pairs);
            let parent = parents(&graph);
            let order = postorder(&parent);
            let graph = graph.renumbered(&order);
            let parent = parents(&graph);
            assert_eq!(postorder(&parent), (0..nodes).collect::<Vec<_>>());
            assert_eq!(
                column_counts(&graph, &parent),
                counts_by_elimination(&graph)
            );
        }
    }
}
