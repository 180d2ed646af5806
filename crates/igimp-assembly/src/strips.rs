//! Sums over particles into node rows, in parallel and with the same bits for any thread count.
//!
//! Particles are grouped by the first node row of their support along the slowest axis. A strip is
//! a run of such rows; strips of one parity touch disjoint rows, so they are summed in parallel
//! into disjoint slices, particles ascending within a strip; then the other parity follows. The
//! order of every sum is fixed by the grid alone.

use std::ops::Range;

use igimp_shape::Grid;
use rayon::prelude::*;

/// Particles by strips of node rows.
#[derive(Clone, Debug)]
pub(crate) struct Strips {
    members: Vec<Vec<u32>>,
    /// Nodes that a strip's particles may touch.
    nodes: Vec<Range<usize>>,
}

impl Strips {
    /// Groups particles; `ends` names the first and last node of a particle's support.
    pub(crate) fn build<const D: usize>(
        grid: &Grid<D>,
        particles: usize,
        ends: impl Fn(usize) -> (usize, usize),
    ) -> Self {
        let rows = grid.axes[D - 1].node_count();
        let row_nodes = grid.node_count() / rows;
        let extent = (0..particles)
            .map(|particle| {
                let (first, last) = ends(particle);
                last / row_nodes - first / row_nodes + 1
            })
            .max()
            .unwrap_or(1);
        let height = extent.max(2);
        let count = rows.div_ceil(height);
        let mut members = vec![Vec::new(); count];
        for particle in 0..particles {
            let strip = ends(particle).0 / row_nodes / height;
            members[strip].push(u32::try_from(particle).expect("fewer than 2^32 particles"));
        }
        let nodes = (0..count)
            .map(|strip| {
                let last_row = rows.min((strip + 1) * height + extent - 1);
                strip * height * row_nodes..last_row * row_nodes
            })
            .collect();
        Self { members, nodes }
    }

    /// Adds the contributions of all particles to `data`.
    ///
    /// `range` maps a range of nodes to the range of `data` that belongs to them; `add` adds one
    /// strip's particles to such a slice, which begins at the given range.
    pub(crate) fn sum<T, R, F>(&self, data: &mut [T], range: R, add: F)
    where
        T: Send,
        R: Fn(&Range<usize>) -> Range<usize>,
        F: Fn(&[u32], Range<usize>, &mut [T]) + Sync,
    {
        for parity in 0..2 {
            let mut rest = &mut *data;
            let mut taken = 0;
            let mut tasks = Vec::new();
            for strip in (parity..self.members.len()).step_by(2) {
                let own = range(&self.nodes[strip]);
                let (_, tail) = rest.split_at_mut(own.start - taken);
                let (slice, tail) = tail.split_at_mut(own.len());
                rest = tail;
                taken = own.end;
                tasks.push((strip, own, slice));
            }
            tasks.into_par_iter().for_each(|(strip, own, slice)| {
                add(&self.members[strip], own, slice);
            });
        }
    }
}
