//! Supernodes: nodes that are eliminated together as one dense front, and their tree.
//!
//! Every part of the dissection is eliminated at once: by the time that a separator is, both halves
//! have coupled all of it. J. W. H. Liu, *The role of elimination trees in sparse factorization*, SIAM
//! J. Matrix Anal. Appl. 11 (1990), for the tree: the parent eliminates the first of the later nodes
//! that a supernode is coupled to. C. Ashcraft & R. Grimes, *The influence of relaxed supernode
//! partitions on the multifrontal method*, ACM Trans. Math. Softw. 15 (1989): small supernodes are
//! merged with their parents where a few zeros more in the dense blocks cost less than a front of
//! its own. Everything is counted in grid nodes, not in unknowns: lists are then two or three times
//! shorter.

use std::ops::Range;

use super::neighbours::{NONE, Neighbours};

/// The supernodes; nodes are called by their rank in the dissection.
pub(crate) struct Supernodes<'a> {
    /// Start of each part of the dissection, and the end of the last.
    parts: &'a [usize],
    /// Unknowns of the nodes before each rank.
    unknowns_before: &'a [u32],
    /// Supernode by supernode, named after the part that is eliminated last in it.
    nodes: Vec<Supernode>,
    /// Next part of the same supernode, by part.
    next_part: Vec<u32>,
    /// Rows of all supernodes.
    rows: Vec<u32>,
}

#[derive(Clone)]
struct Supernode {
    /// The supernode of the first row, or [`NONE`].
    parent: u32,
    /// The supernode that it was merged into, or itself.
    into: u32,
    /// The part that is eliminated first.
    first_part: u32,
    /// Last found of the supernodes below, and the next of those that share the parent.
    child: u32,
    sibling: u32,
    /// Unknowns eliminated.
    pivots: usize,
    /// Unknowns of the rows.
    border: usize,
    /// The later nodes that it is coupled to: a range of [`Supernodes::rows`].
    rows: Range<usize>,
}

impl<'a> Supernodes<'a> {
    /// Finds the supernodes of dissected nodes.
    pub(crate) fn new(
        parts: &'a [usize],
        unknowns_before: &'a [u32],
        neighbours: &Neighbours,
    ) -> Self {
        let count = parts.len() - 1;
        let mut this = Self {
            parts,
            unknowns_before,
            nodes: Vec::with_capacity(count),
            next_part: vec![NONE; count],
            rows: Vec::new(),
        };
        this.find_rows(neighbours);
        this.merge();
        this
    }

    /// Which later nodes each part is coupled to, itself or by way of the parts below it.
    fn find_rows(&mut self, neighbours: &Neighbours) {
        let ranks = self.unknowns_before.len() - 1;
        let mut part_of = vec![0_u32; ranks];
        for (part, ends) in self.parts.windows(2).enumerate() {
            part_of[ends[0]..ends[1]].fill(part as u32);
        }
        let mut first_child = vec![NONE; self.next_part.len()];
        let mut seen_by = vec![NONE; ranks];
        for (part, ends) in self.parts.windows(2).enumerate() {
            let (this, end) = (part as u32, ends[1] as u32);
            let start = self.rows.len();
            let (mut border, mut first_row) = (0, NONE);
            let mut add = |row: u32, rows: &mut Vec<u32>| {
                if row >= end && seen_by[row as usize] != this {
                    seen_by[row as usize] = this;
                    rows.push(row);
                    first_row = first_row.min(row);
                    border += unknowns(self.unknowns_before, row as usize..row as usize + 1);
                }
            };
            neighbours.visit(ends[0]..ends[1], |row| add(row, &mut self.rows));
            let mut child = first_child[part];
            while child != NONE {
                for entry in self.nodes[child as usize].rows.clone() {
                    add(self.rows[entry], &mut self.rows);
                }
                child = self.nodes[child as usize].sibling;
            }
            let parent = part_of.get(first_row as usize).copied().unwrap_or(NONE);
            let sibling = match first_child.get_mut(parent as usize) {
                Some(first) => std::mem::replace(first, this),
                None => NONE,
            };
            self.nodes.push(Supernode {
                parent,
                into: this,
                first_part: this,
                child: first_child[part],
                sibling,
                pivots: unknowns(self.unknowns_before, ends[0]..ends[1]),
                border,
                rows: start..self.rows.len(),
            });
        }
    }

    /// Merges children into their parents where that is estimated to save time.
    fn merge(&mut self) {
        for this in 0..self.nodes.len() {
            let mut child = self.nodes[this].child;
            while child != NONE {
                let low = self.nodes[child as usize].clone();
                let high = &mut self.nodes[this];
                let apart = effort(low.pivots, low.border) + effort(high.pivots, high.border);
                if effort(low.pivots + high.pivots, high.border) <= apart {
                    high.pivots += low.pivots;
                    // The parts of the child come first; its last part is the one it is named after.
                    self.next_part[child as usize] = high.first_part;
                    high.first_part = low.first_part;
                    self.nodes[child as usize].into = this as u32;
                }
                child = low.sibling;
            }
        }
        // A parent stands after its children, so that its own fate is known first from the end.
        for this in (0..self.nodes.len()).rev() {
            let into = self.nodes[self.nodes[this].into as usize].into;
            self.nodes[this].into = into;
            if let Some(parent) = self.nodes.get(self.nodes[this].parent as usize) {
                self.nodes[this].parent = parent.into;
            }
        }
    }

    /// The supernodes in a postorder that keeps the stack of contributions low: among siblings,
    /// first those that need the most room beyond the part that they leave behind (J. W. H. Liu, *The
    /// multifrontal method for sparse matrix solution*, SIAM Review 34, 1992, section 6).
    pub(crate) fn sequence(&mut self) -> Vec<u32> {
        let mut roots = Vec::new();
        let mut peak = vec![0_usize; self.nodes.len()];
        let mut siblings: Vec<u32> = Vec::new();
        for node in &mut self.nodes {
            node.child = NONE;
        }
        for this in 0..self.nodes.len() {
            if self.nodes[this].into as usize != this {
                continue;
            }
            let left = |child: u32| self.nodes[child as usize].border.pow(2);
            siblings.clear();
            let mut child = self.nodes[this].child;
            while child != NONE {
                siblings.push(child);
                child = self.nodes[child as usize].sibling;
            }
            siblings.sort_by_key(|&child| {
                (std::cmp::Reverse(peak[child as usize] - left(child)), child)
            });
            let mut held = 0;
            for &child in &siblings {
                peak[this] = peak[this].max(held + peak[child as usize]);
                held += left(child);
            }
            peak[this] = peak[this].max(held + left(this as u32));
            for pair in siblings.windows(2) {
                self.nodes[pair[0] as usize].sibling = pair[1];
            }
            if let (Some(&first), Some(&last)) = (siblings.first(), siblings.last()) {
                self.nodes[this].child = first;
                self.nodes[last as usize].sibling = NONE;
            }
            match self.nodes[this].parent {
                NONE => roots.push(this as u32),
                parent => {
                    let first =
                        std::mem::replace(&mut self.nodes[parent as usize].child, this as u32);
                    self.nodes[this].sibling = first;
                }
            }
        }
        // Reversed, a postorder is a preorder with the last child first.
        let mut sequence = Vec::with_capacity(self.nodes.len());
        let mut path = roots;
        while let Some(this) = path.pop() {
            sequence.push(this);
            let mut child = self.nodes[this as usize].child;
            while child != NONE {
                path.push(child);
                child = self.nodes[child as usize].sibling;
            }
        }
        sequence.reverse();
        sequence
    }

    /// The ranks that a supernode eliminates, in runs.
    pub(crate) fn columns(&self, supernode: u32) -> impl Iterator<Item = Range<usize>> + '_ {
        let first = self.nodes[supernode as usize].first_part;
        let parts = std::iter::successors(Some(first), move |&part| {
            (part != supernode).then(|| self.next_part[part as usize])
        });
        parts.map(|part| self.parts[part as usize]..self.parts[part as usize + 1])
    }

    /// The later ranks that a supernode is coupled to, in no order.
    pub(crate) fn rows(&self, supernode: u32) -> &[u32] {
        &self.rows[self.nodes[supernode as usize].rows.clone()]
    }

    /// The supernode above, or [`NONE`].
    pub(crate) fn parent(&self, supernode: u32) -> u32 {
        self.nodes[supernode as usize].parent
    }

    /// Unknowns that a supernode eliminates, and unknowns of its rows.
    pub(crate) fn size(&self, supernode: u32) -> (usize, usize) {
        let node = &self.nodes[supernode as usize];
        (node.pivots, node.border)
    }

    /// Number of parts, which bounds the numbers of the supernodes.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }
}

/// Unknowns of some consecutive ranks.
fn unknowns(before: &[u32], ranks: Range<usize>) -> usize {
    (before[ranks.end] - before[ranks.start]) as usize
}

/// Estimated time of a front, in floating-point operations of the dense kernels.
fn effort(pivots: usize, border: usize) -> f64 {
    /// Of moving an entry through memory: once into the front and once on to the parent.
    const PER_ENTRY: f64 = 8.0;
    /// Of a front, however small: index work and calls of kernels.
    const PER_FRONT: f64 = 50_000.0;
    let (w, r) = (pivots as f64, border as f64);
    let operations = w * (w * w * (2.0 / 3.0) + 2.0 * r * (w + r));
    operations + PER_ENTRY * ((w + r) * (w + r) + r * r) + PER_FRONT
}
