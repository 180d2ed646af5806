//! Nodes that a body only touches at a corner, and the nodes that they are tied to (theory, eqs. 26
//! and 27).

use std::collections::BTreeMap;

use igimp_shape::Grid;

use crate::conditions::constraints::Constraints;
use crate::step::node_shares::NodeShare;
use crate::step::supports::Supports;

/// The master of every node that is a small cut, its volume being less than `below` of its cell's:
/// the nearest node that shares a particle with it, carries enough soil and has the same
/// constraints; of equally near ones that with most soil.
pub(crate) fn masters_of_cuts<const D: usize>(
    grid: &Grid<D>,
    supports: &Supports<D>,
    shares: &[NodeShare],
    constraints: &Constraints<D>,
    below: f64,
) -> BTreeMap<usize, usize> {
    let fixed = |node: usize| (0..D).all(|axis| constraints.of(node, axis).is_some());
    // Touched, not of positive volume: a point on a face sees the cell beyond by its gradient only.
    let cuts: Vec<bool> = (0..shares.len())
        .map(|node| {
            let share = &shares[node];
            share.is_touched && share.volume < below * cell_volume(grid, node)
        })
        .collect();
    if !cuts.contains(&true) {
        return BTreeMap::new();
    }
    let distance = |a: usize, b: usize| {
        let (a, b) = (grid.node_position(a), grid.node_position(b));
        std::iter::zip(a, b)
            .map(|(a, b)| (a - b) * (a - b))
            .sum::<f64>()
    };
    let mut masters = BTreeMap::new();
    for particle in supports.touching(&cuts) {
        let own = supports.of(particle);
        let nodes = own.iter().map(|support| support.node);
        for cut in nodes.clone().filter(|&node| cuts[node] && !fixed(node)) {
            for candidate in nodes.clone() {
                let alike =
                    (0..D).all(|axis| constraints.of(cut, axis) == constraints.of(candidate, axis));
                if cuts[candidate] || !alike {
                    continue;
                }
                let key = |master: usize| (distance(cut, master), -shares[master].volume);
                let master = masters.entry(cut).or_insert(candidate);
                if key(candidate) < key(*master) {
                    *master = candidate;
                }
            }
        }
    }
    masters
}

/// The mean volume of a cell around a node: the product of half the lengths to its neighbours,
/// doubled at walls \[length^D\].
pub(crate) fn cell_volume<const D: usize>(grid: &Grid<D>, node: usize) -> f64 {
    let place = grid.node_place(node);
    (0..D)
        .map(|axis| {
            let nodes = grid.axes[axis].nodes();
            let lower = place[axis].saturating_sub(1);
            let upper = (place[axis] + 1).min(nodes.len() - 1);
            (nodes[upper] - nodes[lower]) / (upper - lower) as f64
        })
        .product()
}
