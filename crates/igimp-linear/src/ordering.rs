//! Geometric nested dissection: the order of elimination, from the places of the nodes on the grid.
//!
//! A. George, *Nested dissection of a regular finite element mesh*, SIAM J. Numer. Anal. 10 (1973).
//! The active nodes are bisected by layers across their longer axis so that both halves hold about
//! the same number of nodes; the layers between the halves, as many as supports reach, separate
//! them and are eliminated last, with the few nodes that are coupled further. Balancing by counted nodes and not by length keeps the fill low
//! where half of the bounding box is empty, as in a slope.

use super::coupling_reach::Reach;
use crate::Pattern;

/// Nodes below which a part is not dissected further.
const LEAF_NODES: usize = 8;

/// An order of elimination of nodes and of their unknowns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NestedDissection {
    /// The blocks of the pattern in order of elimination: `nodes[k]` is eliminated k-th.
    pub nodes: Vec<usize>,
    /// Where each part begins in that order, and the end of the last: parts that were not
    /// dissected further and separators, none of them empty.
    pub parts: Vec<usize>,
}

impl NestedDissection {
    /// Dissects the nodes of a pattern; O(n log n) for n nodes, on grids of one to three
    /// dimensions of any shape.
    pub fn new(pattern: &Pattern) -> Self {
        Self::within(pattern, &Reach::of(pattern))
    }

    /// Dissects with separators as wide as the common reach; nodes coupled across a separator
    /// join it.
    pub(super) fn within(pattern: &Pattern, reach: &Reach) -> Self {
        let node = |(index, place): (usize, [usize; 3])| Node {
            place: place.map(|along| u32::try_from(along).unwrap_or(u32::MAX)),
            index: index as u32,
        };
        let places = pattern.blocks.iter().map(|block| block.place);
        let mut nodes: Vec<Node> = places.enumerate().map(node).collect();
        let mut dissector = Dissector {
            pattern,
            reach,
            width: u32::try_from(reach.common).unwrap_or(u32::MAX),
            layer_counts: Vec::new(),
            after: Vec::with_capacity(nodes.len()),
            between: Vec::new(),
            parts: vec![0],
        };
        let bounds = Bounds::of(&nodes);
        dissector.dissect(&mut nodes, &bounds);
        Self {
            nodes: nodes.iter().map(|node| node.index as usize).collect(),
            parts: dissector.parts,
        }
    }

    /// The unknowns in order of elimination, those of a node together.
    pub fn unknowns(&self, pattern: &Pattern) -> Vec<usize> {
        let blocks = self.nodes.iter().map(|&node| pattern.blocks[node]);
        blocks
            .flat_map(|block| block.first..block.first + block.len)
            .collect()
    }
}

#[derive(Clone, Copy)]
struct Node {
    place: [u32; 3],
    /// Block of the pattern.
    index: u32,
}

/// Smallest and largest place of some nodes along each axis.
#[derive(Clone, Copy)]
struct Bounds {
    low: [u32; 3],
    high: [u32; 3],
}

impl Bounds {
    const NOTHING: Self = Self {
        low: [u32::MAX; 3],
        high: [0; 3],
    };

    fn of(nodes: &[Node]) -> Self {
        let mut bounds = Self::NOTHING;
        for node in nodes {
            bounds.include(node);
        }
        bounds
    }

    fn include(&mut self, node: &Node) {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(node.place[axis]);
            self.high[axis] = self.high[axis].max(node.place[axis]);
        }
    }

    fn layers(&self, axis: usize) -> usize {
        (self.high[axis] - self.low[axis]) as usize + 1
    }

    fn longest_axis(&self) -> usize {
        (1..3).fold(0, |longest, axis| {
            if self.layers(axis) > self.layers(longest) {
                axis
            } else {
                longest
            }
        })
    }
}

struct Dissector<'a> {
    pattern: &'a Pattern,
    reach: &'a Reach,
    /// Layers of a separator.
    width: u32,
    /// Scratch: nodes per layer.
    layer_counts: Vec<usize>,
    /// Scratch: nodes behind a separator and in it, while a part is split.
    after: Vec<Node>,
    between: Vec<Node>,
    /// Starts of the parts found so far, and the end of the last.
    parts: Vec<usize>,
}

impl Dissector<'_> {
    /// Sorts a part into order of elimination: first half, second half, separator.
    ///
    /// Each half holds at most half of the nodes, or a single layer where that alone holds more, so
    /// the recursion is little deeper than log2 n.
    fn dissect(&mut self, part: &mut [Node], bounds: &Bounds) {
        if part.len() <= LEAF_NODES {
            self.end_part(part.len());
            return;
        }
        let axis = bounds.longest_axis();
        if bounds.layers(axis) < self.width as usize + 2 {
            self.end_part(part.len());
            return;
        }
        let start = self.separator(part, bounds, axis);
        let (before, after, halves) = self.split(part, axis, start);
        let (first, rest) = part.split_at_mut(before);
        let (second, between) = rest.split_at_mut(after);
        self.dissect(first, &halves[0]);
        self.dissect(second, &halves[1]);
        sort_along(between, axis);
        self.end_part(between.len());
    }

    fn end_part(&mut self, len: usize) {
        if len > 0 {
            let start = self.parts.last().copied().unwrap_or(0);
            self.parts.push(start + len);
        }
    }

    /// The first layer of the separator across an axis that balances the counts of nodes. The part
    /// has at least two layers more than a separator.
    fn separator(&mut self, part: &[Node], bounds: &Bounds, axis: usize) -> u32 {
        let (layers, reach) = (bounds.layers(axis), self.width as usize);
        let low = bounds.low[axis];
        let size: usize = (0..3)
            .map(|axis| bounds.layers(axis))
            .fold(1, usize::saturating_mul);
        if part.len() == size {
            // A full box.
            return low + ((layers - reach) / 2) as u32;
        }
        self.layer_counts.clear();
        self.layer_counts.resize(layers, 0);
        for node in part {
            self.layer_counts[(node.place[axis] - low) as usize] += 1;
        }
        let mut before = 0;
        let mut between: usize = self.layer_counts[..reach].iter().sum();
        let mut best = (usize::MAX, 0);
        for start in 1..layers - reach {
            before += self.layer_counts[start - 1];
            between += self.layer_counts[start + reach - 1];
            between -= self.layer_counts[start - 1];
            let after = part.len() - before - between;
            best = best.min((before.max(after), start));
        }
        low + best.1 as u32
    }

    /// Moves the nodes before the separator to the front, then those after it, then the separator,
    /// each in their former order; returns the first two counts and their bounds.
    fn split(&mut self, part: &mut [Node], axis: usize, start: u32) -> (usize, usize, [Bounds; 2]) {
        let end = start + self.width;
        self.after.clear();
        self.between.clear();
        let mut halves = [Bounds::NOTHING; 2];
        let mut before = 0;
        for position in 0..part.len() {
            let node = part[position];
            let along = node.place[axis];
            if along < start && !self.reaches(&node, axis, end) {
                halves[0].include(&node);
                part[before] = node;
                before += 1;
            } else if along >= end {
                halves[1].include(&node);
                self.after.push(node);
            } else {
                self.between.push(node);
            }
        }
        let after = self.after.len();
        part[before..before + after].copy_from_slice(&self.after);
        part[before + after..].copy_from_slice(&self.between);
        (before, after, halves)
    }

    /// Whether a node before a separator is coupled to one behind it.
    fn reaches(&self, node: &Node, axis: usize, end: u32) -> bool {
        let mut far = self.reach.far_of(node.index as usize);
        far.any(|other| self.pattern.blocks[other].place[axis] >= end as usize)
    }
}

/// Sorts a separator along its length, so that the boundary of a smaller part is a run of
/// consecutive nodes in it.
fn sort_along(separator: &mut [Node], across: usize) {
    let key = |node: &Node| {
        let mut place = node.place;
        let layer = std::mem::take(&mut place[across]);
        (place, layer)
    };
    if !separator.is_sorted_by_key(key) {
        separator.sort_by_key(key);
    }
}
