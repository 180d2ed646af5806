//! Slabs of nodes across the last axis, in two colours: those of one colour are not coupled, so that threads can
//! work on them at the same time. The order of elimination is that of the colours, and within a slab that of the
//! nodes; it depends on the grid alone.

use std::ops::Range;

use rayon::prelude::*;

use super::rows::Couplings;

/// Slabs that there are at most.
const MOST: usize = 16;
/// Fewer nodes than this are one slab.
const FEWEST_NODES: usize = 1000;

/// The slabs: even ones are eliminated first.
#[derive(Clone, Debug, Default)]
pub(super) struct Slabs {
    /// First node of each slab, and the number of nodes.
    bounds: Vec<usize>,
    /// For each node where its slab begins and ends in its list.
    spans: Vec<(u32, u32)>,
}

/// The nodes that a node's own elimination needs and those that it does not, as ranges of its list.
#[derive(Clone, Debug)]
pub(super) struct Split {
    /// Those before it, in the order of elimination; the last range is that of its own slab.
    pub(super) lower: [Range<usize>; 3],
    /// Those after it.
    pub(super) upper: [Range<usize>; 3],
}

impl Slabs {
    /// Cuts the nodes at `places`.
    pub(super) fn new(places: &[[usize; 3]], couplings: &Couplings) -> Self {
        let bounds = cut(places, couplings).unwrap_or_else(|| vec![0, places.len()]);
        let mut spans = Vec::with_capacity(places.len());
        for slab in 0..bounds.len() - 1 {
            for node in bounds[slab]..bounds[slab + 1] {
                let list = couplings.of(node);
                let before =
                    |end: usize| list.partition_point(|&other| (other as usize) < end) as u32;
                spans.push((before(bounds[slab]), before(bounds[slab + 1])));
            }
        }
        Self { bounds, spans }
    }

    /// Number of slabs.
    pub(super) fn len(&self) -> usize {
        self.bounds.len() - 1
    }

    /// The nodes of a slab.
    pub(super) fn nodes(&self, slab: usize) -> Range<usize> {
        self.bounds[slab]..self.bounds[slab + 1]
    }

    /// The couplings before and after a node of a slab.
    #[inline]
    pub(super) fn split(&self, slab: usize, node: usize, couplings: &Couplings) -> Split {
        let (begin, end) = self.spans[node];
        let (begin, end) = (begin as usize, end as usize);
        let diagonal = couplings.diagonal[node] as usize;
        let len = couplings.of(node).len();
        if slab.is_multiple_of(2) {
            Split {
                lower: [0..0, len..len, begin..diagonal],
                upper: [0..begin, diagonal + 1..end, end..len],
            }
        } else {
            Split {
                lower: [0..begin, end..len, begin..diagonal],
                upper: [0..0, diagonal + 1..end, len..len],
            }
        }
    }

    /// Calls `work` for the slabs of one colour with their own parts of the values stored for all nodes, and with
    /// the parts of the two neighbours. `first` says where the part of a node begins.
    pub(super) fn each<T: Send + Sync>(
        &self,
        odd: bool,
        values: &mut [T],
        first: impl Fn(usize) -> usize + Sync,
        work: impl Fn(usize, &mut Parts<'_, T>) + Sync,
    ) {
        let (mut same, mut others) = (Vec::new(), Vec::new());
        let mut rest = values;
        for slab in 0..self.len() {
            let nodes = self.nodes(slab);
            let (part, later) = rest.split_at_mut(first(nodes.end) - first(nodes.start));
            rest = later;
            if (slab % 2 == 1) == odd {
                same.push((slab, first(nodes.start), part));
            } else {
                others.push((first(nodes.start), &*part));
            }
        }
        // Slab k of one colour lies between k − 1 and k of the other, or k and k + 1.
        same.into_par_iter()
            .enumerate()
            .for_each(|(k, (slab, before, part))| {
                let nothing = (0, &[][..]);
                let at = |index: Option<usize>| {
                    index
                        .and_then(|index| others.get(index))
                        .copied()
                        .unwrap_or(nothing)
                };
                let neighbours = if odd {
                    [at(Some(k)), at(Some(k + 1))]
                } else {
                    [at(k.checked_sub(1)), at(Some(k))]
                };
                let mut parts = Parts {
                    before,
                    slab: part,
                    neighbours,
                };
                work(slab, &mut parts);
            });
    }
}

/// The storage of a slab, and of its neighbours.
pub(super) struct Parts<'a, T> {
    /// How much is stored for the nodes before the slab.
    pub(super) before: usize,
    pub(super) slab: &'a mut [T],
    /// The same of the slabs before and after it.
    pub(super) neighbours: [(usize, &'a [T]); 2],
}

/// First nodes of slabs so thick that those of one colour are not coupled, if that is possible.
fn cut(places: &[[usize; 3]], couplings: &Couplings) -> Option<Vec<usize>> {
    if places.len() < FEWEST_NODES {
        return None;
    }
    let axis = (0..3)
        .rev()
        .find(|&axis| places.iter().any(|place| place[axis] != places[0][axis]))?;
    if !places.is_sorted_by_key(|place| place[axis]) {
        return None;
    }
    let layer = |node: usize| places[node][axis];
    let reach = (0..places.len())
        .flat_map(|node| {
            couplings
                .of(node)
                .iter()
                .map(move |&other| (node, other as usize))
        })
        .map(|(node, other)| layer(node).abs_diff(layer(other)))
        .max()?;
    let (lowest, highest) = (layer(0), layer(places.len() - 1));
    let layers = highest - lowest + 1;
    let count = (layers / (reach + 2)).min(MOST);
    if count < 2 {
        return None;
    }
    let mut bounds: Vec<usize> = (0..count)
        .map(|slab| {
            let first = lowest + slab * layers / count;
            places.partition_point(|place| place[axis] < first)
        })
        .collect();
    bounds.push(places.len());
    Some(bounds)
}
