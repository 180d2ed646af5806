//! Which nodes may be coupled: all pairs within the common reach, and the few known beyond.
//!
//! A plan for all of them holds while the nodes stay, whichever of the pairs the particles couple.
//! Nodes are called by their rank in the order of elimination.

use std::ops::Range;

use crate::Pattern;
use crate::coupling_reach::Reach;

/// Marks the absence of a node, such as the parent of a root.
pub(crate) const NONE: u32 = u32::MAX;

/// Places on the grid per node beyond which a map of them is not worth its memory.
const SPARSEST_MAP: usize = 16;

/// The couplings that a plan is made for.
pub(crate) struct Neighbours<'a> {
    pattern: &'a Pattern,
    /// Block of each rank.
    order: &'a [usize],
    /// Rank of each block.
    rank: &'a [u32],
    reach: &'a Reach,
    map: Option<Map>,
}

/// Ranks of the nodes by place, [`NONE`] where there is no node.
struct Map {
    low: [usize; 3],
    size: [usize; 3],
    ranks: Vec<u32>,
}

impl<'a> Neighbours<'a> {
    pub(crate) fn new(
        pattern: &'a Pattern,
        order: &'a [usize],
        rank: &'a [u32],
        reach: &'a Reach,
    ) -> Self {
        let map = Map::new(pattern, rank).filter(|_| reach.covers(pattern));
        Self {
            pattern,
            order,
            rank,
            reach,
            map,
        }
    }

    /// Whether all pairs within reach are listed, and not only those of the pattern.
    pub(crate) fn cover_reach(&self) -> bool {
        self.map.is_some()
    }

    /// Visits the ranks of all nodes that the nodes of a part may be coupled to, some more than
    /// once, those of the part among them.
    pub(crate) fn visit(&self, part: Range<usize>, mut visit: impl FnMut(u32)) {
        let nodes = &self.order[part];
        let Some(map) = &self.map else {
            let coupled = nodes.iter().flat_map(|&node| self.pattern.coupled_to(node));
            coupled.for_each(|&other| visit(self.rank[other as usize]));
            return;
        };
        let place = |node: usize| self.pattern.blocks[node].place;
        let (mut low, mut high) = ([usize::MAX; 3], [0; 3]);
        for &node in nodes {
            for (axis, along) in place(node).into_iter().enumerate() {
                low[axis] = low[axis].min(along);
                high[axis] = high[axis].max(along);
            }
        }
        let size: usize = (0..3).map(|axis| high[axis] - low[axis] + 1).product();
        let reach = self.reach.common;
        if size == nodes.len() {
            map.visit_box(low, high, reach, &mut visit);
        } else {
            for &node in nodes {
                map.visit_box(place(node), place(node), reach, &mut visit);
            }
        }
        let far = nodes.iter().flat_map(|&node| self.reach.far_of(node));
        far.for_each(|other| visit(self.rank[other]));
    }
}

impl Map {
    /// The map, unless the nodes are scattered too widely or share a place.
    fn new(pattern: &Pattern, rank: &[u32]) -> Option<Self> {
        let (mut low, mut high) = ([usize::MAX; 3], [0; 3]);
        for block in &pattern.blocks {
            for axis in 0..3 {
                low[axis] = low[axis].min(block.place[axis]);
                high[axis] = high[axis].max(block.place[axis]);
            }
        }
        let size: [usize; 3] = std::array::from_fn(|axis| high[axis] - low[axis] + 1);
        let places = size
            .iter()
            .try_fold(1, |places: usize, &n| places.checked_mul(n))?;
        if places / SPARSEST_MAP > pattern.blocks.len() {
            return None;
        }
        let mut map = Self {
            low,
            size,
            ranks: vec![NONE; places],
        };
        for (block, &rank) in pattern.blocks.iter().zip(rank) {
            let index = map.index(block.place);
            if map.ranks[index] != NONE {
                return None;
            }
            map.ranks[index] = rank;
        }
        Some(map)
    }

    fn index(&self, place: [usize; 3]) -> usize {
        let at = |axis: usize| place[axis] - self.low[axis];
        (at(2) * self.size[1] + at(1)) * self.size[0] + at(0)
    }

    /// Visits the nodes in a box that is widened by `reach` to all sides.
    fn visit_box(
        &self,
        low: [usize; 3],
        high: [usize; 3],
        reach: usize,
        visit: &mut impl FnMut(u32),
    ) {
        let from: [usize; 3] =
            std::array::from_fn(|axis| low[axis].saturating_sub(reach).max(self.low[axis]));
        let to: [usize; 3] = std::array::from_fn(|axis| {
            (high[axis] + reach).min(self.low[axis] + self.size[axis] - 1)
        });
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                let first = self.index([from[0], y, z]);
                let row = &self.ranks[first..=first + to[0] - from[0]];
                row.iter()
                    .filter(|&&rank| rank != NONE)
                    .for_each(|&rank| visit(rank));
            }
        }
    }
}
