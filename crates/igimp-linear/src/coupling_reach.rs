//! How far couplings reach: one distance for nearly all nodes, and a list of the few that go beyond.
//!
//! A node tied to another couples that one with nodes one layer further away than supports reach.
//! There are few of these, at the rim of the body; separators as wide as they ask for would
//! multiply the work of all others.

use crate::Pattern;

/// One node in so many may have couplings that count as exceptions.
const NODES_PER_EXCEPTION: usize = 20;

/// The reach of a pattern.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Reach {
    /// Distance in layers along any axis that nearly all couplings keep to.
    pub(super) common: usize,
    /// The coupled blocks that are further apart, both ways, ascending.
    far: Vec<(u32, u32)>,
}

impl Reach {
    /// The reach of a pattern: the announced one, less if that is due to few nodes only.
    pub(super) fn of(pattern: &Pattern) -> Self {
        let blocks = pattern.blocks.len();
        let furthest: Vec<usize> = (0..blocks)
            .map(|block| {
                let others = pattern.coupled_to(block).iter();
                let distances = others.map(|&other| distance(pattern, block, other as usize));
                distances.max().unwrap_or(0)
            })
            .collect();
        let mut common = pattern.reach.max(1);
        while common > 1 {
            let beyond = furthest.iter().filter(|&&reach| reach >= common).count();
            if beyond == 0 || beyond * NODES_PER_EXCEPTION > blocks {
                break;
            }
            common -= 1;
        }
        let mut reach = Self {
            common,
            far: Vec::new(),
        };
        if common < pattern.reach {
            for block in (0..blocks).filter(|&block| furthest[block] > common) {
                let others = pattern.coupled_to(block).iter();
                let far =
                    others.filter(|&&other| distance(pattern, block, other as usize) > common);
                reach.far.extend(far.map(|&other| (block as u32, other)));
            }
        }
        reach
    }

    /// The blocks that a block is coupled to beyond the common reach.
    pub(super) fn far_of(&self, block: usize) -> impl Iterator<Item = usize> + '_ {
        let first = self
            .far
            .partition_point(|&(from, _)| (from as usize) < block);
        let far = self.far[first..].iter();
        far.take_while(move |&&(from, _)| from as usize == block)
            .map(|&(_, to)| to as usize)
    }

    /// Whether all couplings of a pattern with the same nodes are within this reach.
    pub(super) fn covers(&self, pattern: &Pattern) -> bool {
        (0..pattern.blocks.len()).all(|block| {
            pattern.coupled_to(block).iter().all(|&other| {
                distance(pattern, block, other as usize) <= self.common
                    || self.far.binary_search(&(block as u32, other)).is_ok()
            })
        })
    }
}

/// Layers between two blocks, along the axis where that is most.
fn distance(pattern: &Pattern, a: usize, b: usize) -> usize {
    let places = std::iter::zip(pattern.blocks[a].place, pattern.blocks[b].place);
    places.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}
