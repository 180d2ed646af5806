//! The linear functions of a cell, continued beyond its faces (theory, eqs. 63a and 63b), and of several ways to go on the nearest.

use std::collections::BTreeMap;

use crate::Grid;

/// A node that another one moves with, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// The node.
    pub node: usize,
    /// What its displacement counts; the weights of a tie sum to one \[-\].
    pub weight: f64,
}

/// Tied nodes with the nodes that they move with.
pub type Ties = BTreeMap<usize, Vec<Carrier>>;

/// A way on which the motion of a node may go on from others.
#[derive(Clone, Debug)]
pub struct Way {
    /// How far these are: any measure that grows with the distance.
    pub distance: f64,
    /// The soil that they carry \[length^D\].
    pub soil: f64,
    /// The nodes that it goes on from.
    pub carriers: Vec<Carrier>,
}

/// How many cells away from a small cut the cell may be from which its displacement is extrapolated: from further on, the motion of
/// a spray would be that of its neighbours many times over.
pub const REACH: usize = 1;

/// What is none of a weight \[-\].
const ROUND_OFF: f64 = 1e-12;

/// Ways are as near as others, and carry as much soil, up to this share \[-\]: mirror images differ by round-off.
pub const ALIKE: f64 = 1e-6;

/// The carriers of the nearest way, of equally near ones of that with most soil; the mean of those that are equal in both, so that
/// no side is taken. None without a way.
pub fn nearest(ways: &[Way]) -> Option<Vec<Carrier>> {
    let least = (ways.iter()).fold(f64::INFINITY, |least, way| least.min(way.distance));
    let near: Vec<&Way> = { ways.iter() }
        .filter(|way| way.distance <= (1.0 + ALIKE) * least)
        .collect();
    let most = near.iter().fold(0.0, |most: f64, way| most.max(way.soil));
    let mut alike: Vec<&Way> = Vec::new();
    for way in near {
        // Cells side by side go on from the nodes between them in one way.
        let nodes = |way: &Way| -> Vec<usize> { way.carriers.iter().map(|own| own.node).collect() };
        let is_other = |other: &&Way| nodes(other) != nodes(way);
        if way.soil >= (1.0 - ALIKE) * most && alike.iter().all(is_other) {
            alike.push(way);
        }
    }
    let share = 1.0 / alike.len() as f64;
    let mut weights = BTreeMap::new();
    for own in alike.iter().flat_map(|way| &way.carriers) {
        *weights.entry(own.node).or_insert(0.0) += share * own.weight;
    }
    let carriers = weights.into_iter();
    let carriers: Vec<Carrier> = carriers
        .map(|(node, weight)| Carrier { node, weight })
        .collect();
    (!carriers.is_empty()).then_some(carriers)
}

/// The cells around a node, and those that are up to `reach` cells away from them.
pub fn cells_around<const D: usize>(
    grid: &Grid<D>,
    node: usize,
    reach: usize,
) -> impl Iterator<Item = [usize; D]> + '_ {
    let place = grid.node_place(node);
    let lower: [usize; D] = place.map(|own| own.saturating_sub(reach + 1));
    let count: [usize; D] = std::array::from_fn(|axis| {
        (place[axis] + reach + 1).min(grid.axes[axis].cell_count()) - lower[axis]
    });
    (0..count.iter().product()).map(move |mut index: usize| {
        std::array::from_fn(|axis| {
            let own = lower[axis] + index % count[axis];
            index /= count[axis];
            own
        })
    })
}

/// The nodes of a cell with the values of their linear functions at a node, which may lie beyond the cell.
pub fn carried_beyond<const D: usize>(
    grid: &Grid<D>,
    cell: [usize; D],
    node: usize,
) -> Vec<Carrier> {
    let x = grid.node_position(node);
    let first = grid.node_position(grid.node_index(cell));
    let size = grid.cell_size(cell);
    let within = std::array::from_fn(|axis| (x[axis] - first[axis]) / size[axis]);
    (grid.tents(cell, within))
        .map(|(node, weight, _)| Carrier { node, weight })
        .filter(|own| own.weight.abs() > ROUND_OFF)
        .collect()
}

/// Cells of which every node is one of another cell or is extrapolated from it, each with that cell: their motion is its
/// linear functions continued.
pub fn followers<const D: usize>(grid: &Grid<D>, ties: &Ties) -> BTreeMap<[usize; D], [usize; D]> {
    let mut followers = BTreeMap::new();
    for &tied in ties.keys() {
        for cell in cells_around(grid, tied, 0) {
            if followers.contains_key(&cell) {
                continue;
            }
            let moves_with = |leader: &[usize; D]| {
                let of_leader: Vec<usize> = corners(grid, *leader).collect();
                let goes_on = |node: usize| match ties.get(&node) {
                    Some(carriers) => *carriers == carried_beyond(grid, *leader, node),
                    None => of_leader.contains(&node),
                };
                of_leader.iter().all(|node| !ties.contains_key(node))
                    && corners(grid, cell).all(goes_on)
            };
            if let Some(leader) = cells_around(grid, tied, REACH).find(moves_with) {
                followers.insert(cell, leader);
            }
        }
    }
    followers
}

/// The nodes of a cell.
fn corners<const D: usize>(grid: &Grid<D>, cell: [usize; D]) -> impl Iterator<Item = usize> + '_ {
    (0..1_usize << D).map(move |corner| {
        grid.node_index(std::array::from_fn(|axis| {
            cell[axis] + (corner >> axis & 1)
        }))
    })
}
