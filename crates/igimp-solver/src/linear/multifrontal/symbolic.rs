//! The plan of a factorisation: which front eliminates what, in which order, and where its factors
//! and its contribution to the parent are stored.
//!
//! J. W. H. Liu, *The multifrontal method for sparse matrix solution: theory and practice*, SIAM
//! Review 34 (1992). Depends on the pattern only.

use std::ops::Range;
use std::sync::Arc;

use igimp_assembly::Pattern;

use super::super::{LinearSolverError, NestedDissection, check};
use super::elimination_tree::{NONE, NodeGraph, parents, postorder};
use super::supernodes::{Supernode, supernodes};

/// One dense elimination: `pivots` unknowns, coupled to `border` later ones.
pub(super) struct Front {
    /// Position of the first pivot in the order of elimination.
    pub(super) first: usize,
    /// Number of unknowns eliminated.
    pub(super) pivots: usize,
    /// Positions of the later unknowns: a range of [`Symbolic::borders`].
    pub(super) border: Range<usize>,
    /// The fronts that contribute to this one.
    pub(super) children: Vec<usize>,
    /// Which of the two stacks holds its contribution to the parent: a front and its parent use
    /// different ones, so that each stays last in, first out.
    pub(super) stack: usize,
    /// Where in that stack the contribution lies, stored by columns.
    pub(super) contribution: Range<usize>,
}

impl Front {
    /// Entries of the stored factors: the pivot block and the two blocks beside it.
    pub(super) fn factor_len(&self) -> usize {
        self.pivots * (self.pivots + 2 * self.border.len())
    }
}

/// Everything that a factorisation needs to know besides the values.
pub(super) struct Symbolic {
    pub(super) pattern: Arc<Pattern>,
    /// Unknown at each position of the order of elimination.
    pub(super) order: Vec<usize>,
    /// Position of each unknown.
    pub(super) position: Vec<usize>,
    /// The fronts in postorder: children before parents, subtrees contiguous.
    pub(super) fronts: Vec<Front>,
    /// Positions of the border unknowns of all fronts, ascending within a front.
    pub(super) borders: Vec<usize>,
    /// Where the value of (j, i) is stored, for each stored (i, j).
    pub(super) transposed: Vec<u32>,
    /// Entries of all factors.
    pub(super) factor_len: usize,
    /// Largest fill of the stack of contributions of even and of odd depth.
    pub(super) stack_len: [usize; 2],
}

impl Symbolic {
    /// Analyses a structurally symmetric pattern.
    pub(super) fn new(pattern: &Arc<Pattern>) -> Result<Self, LinearSolverError> {
        check::valid_pattern(pattern)?;
        let transposed = transposed(pattern)?;
        let graph = NodeGraph::new(pattern);
        let mut nodes = NestedDissection::new(pattern).nodes;
        let post = postorder(&parents(&graph.renumbered(&nodes)));
        nodes = post.into_iter().map(|node| nodes[node]).collect();
        let graph = graph.renumbered(&nodes);
        let dofs: Vec<usize> = nodes.iter().map(|&node| pattern.blocks[node].len).collect();
        let supernodes = supernodes(&graph, &parents(&graph), &dofs);

        let sequence = depth_first(&supernodes);
        let mut plan = Self {
            pattern: Arc::clone(pattern),
            order: Vec::with_capacity(pattern.unknowns()),
            position: vec![0; pattern.unknowns()],
            fronts: Vec::with_capacity(supernodes.len()),
            borders: Vec::new(),
            transposed,
            factor_len: 0,
            stack_len: [0; 2],
        };
        for &supernode in &sequence {
            for &column in &supernodes[supernode].columns {
                let block = pattern.blocks[nodes[column]];
                plan.order.extend(block.first..block.first + block.len);
            }
        }
        for (position, &unknown) in plan.order.iter().enumerate() {
            plan.position[unknown] = position;
        }
        plan.place_fronts(&supernodes, &sequence, &nodes);
        plan.place_contributions();
        Ok(plan)
    }

    /// Floating-point operations of a factorisation.
    pub(super) fn operations(&self) -> f64 {
        let of_front = |front: &Front| {
            let (w, r) = (front.pivots as f64, front.border.len() as f64);
            w * (w * w * (2.0 / 3.0) + 2.0 * r * (w + r))
        };
        self.fronts.iter().map(of_front).sum()
    }

    /// Lists the fronts with their borders, in the sequence of elimination.
    fn place_fronts(&mut self, supernodes: &[Supernode], sequence: &[usize], nodes: &[usize]) {
        let mut depth = vec![0; supernodes.len()];
        for (this, supernode) in supernodes.iter().enumerate().rev() {
            if supernode.parent != NONE {
                depth[this] = depth[supernode.parent] + 1;
            }
        }
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); supernodes.len()];
        let mut first = 0;
        for (front, &this) in sequence.iter().enumerate() {
            let start = self.borders.len();
            for &row in &supernodes[this].rows {
                let block = self.pattern.blocks[nodes[row]];
                let unknowns = block.first..block.first + block.len;
                self.borders
                    .extend(unknowns.map(|unknown| self.position[unknown]));
            }
            self.borders[start..].sort_unstable();
            self.fronts.push(Front {
                first,
                pivots: supernodes[this].pivots,
                border: start..self.borders.len(),
                children: std::mem::take(&mut children[this]),
                stack: depth[this] % 2,
                contribution: 0..0,
            });
            if supernodes[this].parent != NONE {
                children[supernodes[this].parent].push(front);
            }
            first += supernodes[this].pivots;
        }
    }

    /// Adds up the factors and places the contributions in their stacks.
    fn place_contributions(&mut self) {
        let mut fill = [0, 0];
        for this in 0..self.fronts.len() {
            let front = &self.fronts[this];
            self.factor_len += front.factor_len();
            let own = front.stack;
            let start = fill[own];
            fill[own] += front.border.len() * front.border.len();
            self.stack_len[own] = self.stack_len[own].max(fill[own]);
            if let Some(&eldest) = front.children.first() {
                fill[1 - own] = self.fronts[eldest].contribution.start;
            }
            self.fronts[this].contribution = start..fill[own];
        }
    }
}

/// The supernodes in a postorder that keeps the stack of contributions low: among siblings, first
/// those that need the most room beyond what they leave behind (Liu 1992, section 6).
fn depth_first(supernodes: &[Supernode]) -> Vec<usize> {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); supernodes.len()];
    let mut roots = Vec::new();
    let mut peak = vec![0; supernodes.len()];
    for (this, supernode) in supernodes.iter().enumerate() {
        let left = |child: usize| supernodes[child].border * supernodes[child].border;
        children[this].sort_by_key(|&child| std::cmp::Reverse(peak[child] - left(child)));
        let mut held = 0;
        for &child in &children[this] {
            peak[this] = peak[this].max(held + peak[child]);
            held += left(child);
        }
        peak[this] = peak[this].max(held + left(this));
        match supernode.parent {
            NONE => roots.push(this),
            parent => children[parent].push(this),
        }
    }
    // Reversed, a postorder is a preorder with the last child first.
    let mut sequence = Vec::with_capacity(supernodes.len());
    let mut path = roots;
    while let Some(this) = path.pop() {
        sequence.push(this);
        path.append(&mut children[this]);
    }
    sequence.reverse();
    sequence
}

/// For each stored entry (i, j) the place of (j, i).
fn transposed(pattern: &Pattern) -> Result<Vec<u32>, LinearSolverError> {
    let too_large = LinearSolverError::OutOfMemory {
        what: "more than 2^32 stored entries",
    };
    let mut next = pattern.col_ptr.clone();
    let mut transposed = Vec::with_capacity(pattern.stored());
    for column in 0..pattern.unknowns() {
        for &row in &pattern.row_idx[pattern.col_ptr[column]..pattern.col_ptr[column + 1]] {
            // Columns ascend, so the entries of each row are met in the order in which the column
            // of the same number stores them.
            let mirror = next[row];
            if mirror == pattern.col_ptr[row + 1] || pattern.row_idx[mirror] != column {
                let reason = "not structurally symmetric";
                return Err(LinearSolverError::InvalidPattern { reason, column });
            }
            transposed.push(u32::try_from(mirror).map_err(|_| too_large.clone())?);
            next[row] += 1;
        }
    }
    Ok(transposed)
}
