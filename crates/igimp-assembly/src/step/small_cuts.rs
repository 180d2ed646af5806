//! Nodes that a body only touches at a corner, and the nodes that they are tied to (theory, eqs. 26
//! and 27), or that their motion is extrapolated from (theory, eq. 63a).

use std::collections::{BTreeMap, BTreeSet};

use igimp_shape::Grid;
use igimp_shape::continuation::{
    ALIKE, Carrier, REACH, Ties, Way, carried_beyond, cells_around, nearest,
};

use crate::conditions::StepConditions;
use crate::conditions::walls::AbsorbingWall;
use crate::method::{CutVolume, SmallCuts};
use crate::step::node_shares::NodeShare;
use crate::step::supports::Supports;

/// What extrapolation leaves to a node that it rests on, of the volume below which a node is a small cut \[-\].
const KEPT: f64 = 0.5;

/// Which nodes are small cuts, their volume being less than a fraction of their cells' or of what full soil leaves there. Touched, not of positive volume: a point on a
/// face sees the cell beyond by its gradient only.
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

/// Ties small cuts to the nearest cells whose nodes all carry enough soil, by their linear functions beyond their faces. What a cut
/// is held by holds all nodes that it is tied to. Weights below zero leave these half of what makes a cut at least: of the cuts that
/// take from a node too much together, those that take most go on from elsewhere. Cuts without such a cell find none.
pub(crate) fn extrapolations<const D: usize>(
    conditions: &StepConditions<D>,
    shares: &[NodeShare],
    (cuts, method): (&[bool], &SmallCuts),
) -> Ties {
    let kept = |node: usize| KEPT * least_volume(&conditions.grid, method, node);
    let is_held = |cut, axis| conditions.constraints.of(cut, axis).is_some();
    let own = (0..cuts.len())
        .filter(|&node| cuts[node] && !(0..D).all(|axis| is_held(node, axis)))
        .map(|cut| {
            let mut ways = ways_on(conditions, shares, (cuts, cut));
            let leaves_enough = |own: &Carrier| {
                shares[own.node].volume + own.weight * shares[cut].volume > kept(own.node)
            };
            ways.retain(|way| way.carriers.iter().all(leaves_enough));
            (cut, ways)
        });
    let mut ways: BTreeMap<usize, Vec<Way>> = own.collect();
    loop {
        let nearest = |(&cut, ways): (&usize, &Vec<Way>)| Some((cut, nearest(ways)?));
        let ties: Ties = ways.iter().filter_map(nearest).collect();
        let mut left: Vec<f64> = shares.iter().map(|share| share.volume).collect();
        // What the cut that takes most from a node takes.
        let mut most = BTreeMap::new();
        for (&cut, own) in carriers_of(&ties) {
            let gain = own.weight * shares[cut].volume;
            left[own.node] += gain;
            let most = most.entry(own.node).or_insert(0.0_f64);
            *most = most.max(-gain);
        }
        let mut is_done = true;
        for (cut, own) in carriers_of(&ties) {
            let taken = -own.weight * shares[*cut].volume;
            let takes_most = taken > 0.0 && taken >= (1.0 - ALIKE) * most[&own.node];
            if takes_most && left[own.node] <= kept(own.node) {
                let takes = |other: &Carrier| other.node == own.node && other.weight < 0.0;
                if let Some(ways) = ways.get_mut(cut) {
                    ways.retain(|way| !way.carriers.iter().any(takes));
                    is_done = false;
                }
            }
        }
        if is_done {
            return ties;
        }
    }
}

/// Tied nodes with each of the nodes that they move with.
fn carriers_of(ties: &Ties) -> impl Iterator<Item = (&usize, &Carrier)> {
    let own = |(cut, carriers)| std::iter::repeat(cut).zip(carriers);
    ties.iter().flat_map(own)
}

/// Cells near a small cut whose nodes all carry enough soil, and are held by what holds it.
fn ways_on<const D: usize>(
    conditions: &StepConditions<D>,
    shares: &[NodeShare],
    (cuts, cut): (&[bool], usize),
) -> Vec<Way> {
    let (grid, constraints) = (&conditions.grid, &conditions.constraints);
    let is_held_alike = |node: usize, axis: usize| {
        let held = constraints.of(cut, axis);
        held.is_none() || held == constraints.of(node, axis)
    };
    let is_firm = |own: &Carrier| {
        !cuts[own.node]
            && stays_on_walls(conditions, cut, own.node)
            && (0..D).all(|axis| is_held_alike(own.node, axis))
    };
    cells_around(grid, cut, REACH)
        .map(|cell| carried_beyond(grid, cell, cut))
        .filter(|carriers| carriers.iter().all(is_firm))
        .map(|carriers| Way {
            // The sum of the magnitudes of weights grows with the distance.
            distance: carriers.iter().map(|own| own.weight.abs()).sum(),
            soil: carriers.iter().map(|own| shares[own.node].volume).sum(),
            carriers,
        })
        .collect()
}

/// Whether a node lies on all walls with dashpots that another lies on: a wall holds its nodes as supports do, and what moved off
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
/// same constraints and walls; of equally near ones that with most soil, or the mean.
pub(crate) fn masters_of_cuts<const D: usize>(
    conditions: &StepConditions<D>,
    supports: &Supports<D>,
    shares: &[NodeShare],
    cuts: &[bool],
) -> Ties {
    let (grid, constraints) = (&conditions.grid, &conditions.constraints);
    let fixed = |node: usize| (0..D).all(|axis| constraints.of(node, axis).is_some());
    let mut candidates: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for particle in supports.touching(cuts) {
        let nodes = supports.of(particle).iter().map(|support| support.node);
        for cut in nodes.clone().filter(|&node| cuts[node] && !fixed(node)) {
            let is_alike = |&node: &usize| {
                let is_held_alike = |axis| constraints.of(cut, axis) == constraints.of(node, axis);
                !cuts[node] && (0..D).all(is_held_alike) && stays_on_walls(conditions, cut, node)
            };
            let own = candidates.entry(cut).or_default();
            own.extend(nodes.clone().filter(is_alike));
        }
    }
    let way = |cut: usize, node: usize| {
        let apart = std::iter::zip(grid.node_position(cut), grid.node_position(node));
        Way {
            distance: apart.map(|(a, b)| (a - b) * (a - b)).sum(),
            soil: shares[node].volume,
            carriers: vec![Carrier { node, weight: 1.0 }],
        }
    };
    { candidates.into_iter() }
        .filter_map(|(cut, nodes)| {
            let ways: Vec<Way> = nodes.into_iter().map(|node| way(cut, node)).collect();
            Some((cut, nearest(&ways)?))
        })
        .collect()
}

/// The volume below which a node is a small cut \[length^D\].
pub(crate) fn least_volume<const D: usize>(grid: &Grid<D>, cuts: &SmallCuts, node: usize) -> f64 {
    cuts.below * volume_at(grid, cuts.of, node)
}

/// The mean volume of a cell around a node: the product of half the lengths to its neighbours, doubled at walls. Or what full
/// soil leaves there: at walls it is not doubled \[length^D\].
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
