//! Sums over particles into node rows, in parallel and with the same bits for any thread count.
//!
//! Particles are sorted by the first node of their supports, and so by cells; their places in this
//! order are *slots*. A strip is a run of node rows along the slowest axis, with the particles
//! whose supports begin there: a range of slots. Strips of one parity touch disjoint rows, so they
//! are summed in parallel into disjoint slices, slots ascending within a strip; then the other
//! parity follows. The order of every sum is fixed by the grid alone.

use std::ops::Range;

use igimp_shape::Grid;

use crate::step::supports::Supports;

/// Particles by strips of node rows.
#[derive(Clone, Debug)]
pub(crate) struct Strips {
    /// The particle in each slot.
    order: Vec<u32>,
    /// Slots of each strip.
    slots: Vec<Range<usize>>,
    /// Nodes that a strip's particles may touch.
    nodes: Vec<Range<usize>>,
}

impl Strips {
    /// Sorts and groups the particles.
    pub(crate) fn build<const D: usize>(grid: &Grid<D>, supports: &Supports<D>) -> Self {
        let rows = grid.axes[D - 1].node_count();
        let row_nodes = grid.node_count() / rows;
        let mut tallest = 2;
        // How many particles begin before each node; the sort keeps the order of equal ones.
        let mut start = vec![0_u32; grid.node_count() + 1];
        for particle in 0..supports.len() {
            let stencil = supports.of(particle);
            let (first, last) = (stencil[0].node, stencil[stencil.len() - 1].node);
            start[first + 1] += 1;
            if last - first >= (tallest - 1) * row_nodes {
                tallest = tallest.max(last / row_nodes - first / row_nodes + 1);
            }
        }
        for node in 0..grid.node_count() {
            start[node + 1] += start[node];
        }
        let strips = (0..rows).step_by(tallest);
        let slots = strips
            .clone()
            .map(|row| {
                let end = rows.min(row + tallest);
                start[row * row_nodes] as usize..start[end * row_nodes] as usize
            })
            .collect();
        let nodes = strips
            .map(|row| row * row_nodes..rows.min(row + 2 * tallest - 1) * row_nodes)
            .collect();
        let mut order = vec![0; supports.len()];
        for particle in 0..supports.len() {
            let slot = &mut start[supports.of(particle)[0].node];
            order[*slot as usize] = u32::try_from(particle).expect("fewer than 2^32 particles");
            *slot += 1;
        }
        Self {
            order,
            slots,
            nodes,
        }
    }

    /// The particle in each slot.
    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    /// The strips of one parity: their nodes and their slots, ascending.
    pub(crate) fn of_parity(
        &self,
        parity: usize,
    ) -> impl Iterator<Item = (&Range<usize>, &Range<usize>)> + Clone {
        let pairs = self.nodes.iter().zip(&self.slots);
        pairs.skip(parity).step_by(2)
    }
}

/// Splits data into the slices of disjoint ascending ranges.
pub(crate) fn split<T>(
    mut data: &mut [T],
    ranges: impl Iterator<Item = Range<usize>>,
) -> Vec<&mut [T]> {
    let mut taken = 0;
    let mut slices = Vec::with_capacity(ranges.size_hint().0);
    for range in ranges {
        let (_, tail) = data.split_at_mut(range.start - taken);
        let (slice, tail) = tail.split_at_mut(range.len());
        data = tail;
        taken = range.end;
        slices.push(slice);
    }
    slices
}
