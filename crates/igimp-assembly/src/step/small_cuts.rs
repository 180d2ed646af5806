//! Nodes that a body only touches at a corner, and the nodes that they are tied to (theory, eqs. 26
//! and 27), or that their motion is extrapolated from (theory, eq. 63a).

use std::collections::BTreeMap;

use igimp_shape::Grid;

use crate::conditions::StepConditions;
use crate::conditions::walls::AbsorbingWall;
use crate::method::{CutVolume, SmallCuts};
use crate::step::continuation::{REACH, carried_beyond, cells_around};
use crate::step::node_shares::NodeShare;
use crate::step::supports::Supports;
use crate::step::ties::{Carrier, Ties};

/// The share that extrapolation leaves to a node that it rests on, of the volume below which a node is a small cut \[-\].
const KEPT: f64 = 0.5;

/// Which nodes are small cuts: their volume is less than a fraction of their cells' or of that of full soil there.
/// Touched, not of positive volume: a point on a face sees the cell beyond by its gradient only.
pub(crate) fn small_cuts<const D: usize>(
    grid: &Grid<D>,
    shares: &[NodeShare],
    cuts: &SmallCuts,
) -> Vec<bool> {
    (0..shares.len())
        .map(|node| {
            let share = &shares[node];
            share.is_touched && share.volume < least_volume(grid, cuts, node)
        })
        .collect()
}

/// Ties small cuts to the nearest cell whose nodes all carry enough soil, by its linear functions beyond its faces: of equally near
/// ones to that with most soil. A constraint of a cut holds all nodes that it is tied to, and weights below zero leave these half of
/// the least volume. Cuts without such a cell find none.
pub(crate) fn extrapolations<const D: usize>(
    conditions: &StepConditions<D>,
    shares: &[NodeShare],
    (cuts, method): (&[bool], &SmallCuts),
) -> Ties {
    let (grid, constraints) = (&conditions.grid, &conditions.constraints);
    let mut ties = Ties::new();
    let mut left: Vec<f64> = shares.iter().map(|share| share.volume).collect();
    for cut in (0..cuts.len()).filter(|&node| cuts[node]) {
        let held = |axis: usize| constraints.of(cut, axis);
        if (0..D).all(|axis| held(axis).is_some()) {
            continue;
        }
        let mut nearest: Option<(f64, f64, Vec<Carrier>)> = None;
        for cell in cells_around(grid, cut, REACH) {
            let carriers = carried_beyond(grid, cell, cut);
            let is_firm = carriers.iter().all(|carrier| {
                let then = left[carrier.node] + carrier.weight * shares[cut].volume;
                !cuts[carrier.node]
                    && stays_on_walls(conditions, cut, carrier.node)
                    && then > KEPT * least_volume(grid, method, carrier.node)
                    && (0..D).all(|axis| {
                        held(axis).is_none() || held(axis) == constraints.of(carrier.node, axis)
                    })
            });
            if !is_firm {
                continue;
            }
            // The sum of the magnitudes of weights grows with the distance.
            let distance: f64 = carriers.iter().map(|carrier| carrier.weight.abs()).sum();
            let soil: f64 = carriers.iter().map(|by| shares[by.node].volume).sum();
            let is_nearer = (nearest.as_ref()).is_none_or(|&(other, most, _)| {
                distance < other || (distance <= other && soil > most)
            });
            if is_nearer {
                nearest = Some((distance, soil, carriers));
            }
        }
        if let Some((_, _, carriers)) = nearest {
            for carrier in &carriers {
                left[carrier.node] += carrier.weight * shares[cut].volume;
            }
            ties.insert(cut, carriers);
        }
    }
    ties
}

/// Whether a node lies on all walls with dashpots that another lies on: a wall holds its nodes as supports do, and a node moved off
/// it would leave it without dashpots.
fn stays_on_walls<const D: usize>(
    conditions: &StepConditions<D>,
    cut: usize,
    carrier: usize,
) -> bool {
    let Some(walls) = &conditions.walls else {
        return true;
    };
    let is_on = |node, wall: &AbsorbingWall<D>| wall.holds(&conditions.grid, node);
    { walls.absorbing.iter() }.all(|wall| !is_on(cut, wall) || is_on(carrier, wall))
}

/// The master of every node that is a small cut: the nearest node that shares a particle with it, carries enough soil and has the
/// same constraints and walls; of equally near ones that with most soil.
pub(crate) fn masters_of_cuts<const D: usize>(
    conditions: &StepConditions<D>,
    supports: &Supports<D>,
    shares: &[NodeShare],
    cuts: &[bool],
) -> BTreeMap<usize, usize> {
    let (grid, constraints) = (&conditions.grid, &conditions.constraints);
    let fixed = |node: usize| (0..D).all(|axis| constraints.of(node, axis).is_some());
    let distance = |a: usize, b: usize| {
        let (a, b) = (grid.node_position(a), grid.node_position(b));
        std::iter::zip(a, b)
            .map(|(a, b)| (a - b) * (a - b))
            .sum::<f64>()
    };
    let mut masters = BTreeMap::new();
    for particle in supports.touching(cuts) {
        let nodes = supports.of(particle).iter().map(|support| support.node);
        for cut in nodes.clone().filter(|&node| cuts[node] && !fixed(node)) {
            for candidate in nodes.clone() {
                let alike =
                    (0..D).all(|axis| constraints.of(cut, axis) == constraints.of(candidate, axis));
                if cuts[candidate] || !alike || !stays_on_walls(conditions, cut, candidate) {
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

/// The volume below which a node is a small cut \[length^D\].
pub(crate) fn least_volume<const D: usize>(grid: &Grid<D>, cuts: &SmallCuts, node: usize) -> f64 {
    cuts.below * volume_at(grid, cuts.of, node)
}

/// The mean volume of a cell around a node: the product of half the lengths to its neighbours, doubled at walls. Or that of full
/// soil there: at walls it is not doubled \[length^D\].
pub(crate) fn volume_at<const D: usize>(grid: &Grid<D>, of: CutVolume, node: usize) -> f64 {
    let place = grid.node_place(node);
    (0..D)
        .map(|axis| {
            let nodes = grid.axes[axis].nodes();
            let lower = place[axis].saturating_sub(1);
            let upper = (place[axis] + 1).min(nodes.len() - 1);
            let sides = match of {
                CutVolume::Cell => (upper - lower) as f64,
                CutVolume::FullSoil => 2.0,
            };
            (nodes[upper] - nodes[lower]) / sides
        })
        .product()
}
