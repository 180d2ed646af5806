//! Geometric nested dissection: the order of elimination, from the places of the nodes on the grid.
//!
//! A. George, *Nested dissection of a regular finite element mesh*, SIAM J. Numer. Anal. 10 (1973).
//! The active nodes are bisected by layers across their longer axis so that both halves hold about
//! the same number of nodes; the layers between the halves, as many as the supports reach, separate
//! them and are eliminated last. Balancing by counted nodes and not by length keeps the fill low
//! where half of the bounding box is empty, as in a slope.

use igimp_assembly::{NodeBlock, Pattern};

/// Nodes below which a part is not dissected further.
const LEAF_NODES: usize = 4;

/// An order of elimination of nodes and of their unknowns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NestedDissection {
    /// The blocks of the pattern in order of elimination: `nodes[k]` is eliminated k-th.
    pub nodes: Vec<usize>,
}

impl NestedDissection {
    /// Dissects the nodes of a pattern; O(n log n) for n nodes, on grids of one to three
    /// dimensions of any shape.
    pub fn new(pattern: &Pattern) -> Self {
        let mut nodes: Vec<usize> = (0..pattern.blocks.len()).collect();
        let mut dissector = Dissector {
            blocks: &pattern.blocks,
            reach: pattern.reach.max(1),
            layer_counts: Vec::new(),
            buffer: Vec::with_capacity(nodes.len()),
        };
        dissector.dissect(&mut nodes);
        Self { nodes }
    }

    /// The unknowns in order of elimination, those of a node together.
    pub fn unknowns(&self, pattern: &Pattern) -> Vec<usize> {
        let blocks = self.nodes.iter().map(|&node| pattern.blocks[node]);
        blocks
            .flat_map(|block| block.first..block.first + block.len)
            .collect()
    }
}

/// Layers `start..end` across an axis that separate a part into two.
struct Separator {
    axis: usize,
    start: usize,
    end: usize,
}

struct Dissector<'a> {
    blocks: &'a [NodeBlock],
    reach: usize,
    /// Scratch: nodes per layer.
    layer_counts: Vec<usize>,
    /// Scratch: nodes set aside while a part is split.
    buffer: Vec<usize>,
}

impl Dissector<'_> {
    /// Sorts a part into order of elimination: first half, second half, separator.
    ///
    /// Each half holds at most half of the nodes, or a single layer where that alone holds more, so
    /// the recursion is little deeper than log2 n.
    fn dissect(&mut self, part: &mut [usize]) {
        let separator = match part.len() {
            0..=LEAF_NODES => None,
            _ => self.separator(part),
        };
        let Some(separator) = separator else {
            return;
        };
        let (before, after) = self.split(part, &separator);
        let (first, rest) = part.split_at_mut(before);
        let (second, between) = rest.split_at_mut(after);
        self.dissect(first);
        self.dissect(second);
        self.sort_along(between, separator.axis);
    }

    /// The separator across the longest axis that balances the counts of nodes, if the part is
    /// long enough to be separated.
    fn separator(&mut self, part: &[usize]) -> Option<Separator> {
        let (low, high) = self.bounds(part);
        let axis = (0..3).max_by_key(|&axis| (high[axis] - low[axis], 3 - axis))?;
        let layers = high[axis] - low[axis] + 1;
        if layers < self.reach + 2 {
            return None;
        }
        self.layer_counts.clear();
        self.layer_counts.resize(layers, 0);
        for &node in part {
            self.layer_counts[self.blocks[node].place[axis] - low[axis]] += 1;
        }

        let mut before = 0;
        let mut between: usize = self.layer_counts[..self.reach].iter().sum();
        let mut best = (usize::MAX, 0);
        for start in 1..layers - self.reach {
            before += self.layer_counts[start - 1];
            between += self.layer_counts[start + self.reach - 1];
            between -= self.layer_counts[start - 1];
            let after = part.len() - before - between;
            best = best.min((before.max(after), start));
        }
        let start = low[axis] + best.1;
        Some(Separator {
            axis,
            start,
            end: start + self.reach,
        })
    }

    /// Smallest and largest place of the nodes along each axis.
    fn bounds(&self, part: &[usize]) -> ([usize; 3], [usize; 3]) {
        let mut low = [usize::MAX; 3];
        let mut high = [0; 3];
        for &node in part {
            for axis in 0..3 {
                low[axis] = low[axis].min(self.blocks[node].place[axis]);
                high[axis] = high[axis].max(self.blocks[node].place[axis]);
            }
        }
        (low, high)
    }

    /// Moves the nodes before the separator to the front, then those after it, then the separator,
    /// each in their former order; returns the first two counts.
    fn split(&mut self, part: &mut [usize], separator: &Separator) -> (usize, usize) {
        let place = |node: usize| self.blocks[node].place[separator.axis];
        self.buffer.clear();
        let mut before = 0;
        for position in 0..part.len() {
            let node = part[position];
            if place(node) < separator.start {
                part[before] = node;
                before += 1;
            } else {
                self.buffer.push(node);
            }
        }
        let is_after = |node: &&usize| place(**node) >= separator.end;
        let is_between = |node: &&usize| place(**node) < separator.end;
        let last = self
            .buffer
            .iter()
            .filter(is_after)
            .chain(self.buffer.iter().filter(is_between));
        let mut after = 0;
        for (slot, &node) in part[before..].iter_mut().zip(last) {
            *slot = node;
            after += usize::from(place(node) >= separator.end);
        }
        (before, after)
    }

    /// Sorts a separator along its length, so that the boundary of a smaller part is a run of
    /// consecutive nodes in it.
    fn sort_along(&self, separator: &mut [usize], across: usize) {
        separator.sort_by_key(|&node| {
            let mut place = self.blocks[node].place;
            let layer = std::mem::take(&mut place[across]);
            (place, layer)
        });
    }
}
