//! The linear functions of a cell, continued beyond its faces (theory, eqs. 63a and 63b).

use std::collections::BTreeMap;

use igimp_shape::Grid;

use crate::step::ties::{Carrier, Ties};

/// How many cells away from a small cut the cell may be from which its displacement is extrapolated: from further on, the motion of
/// a spray would be that of its neighbours many times over.
pub(crate) const REACH: usize = 1;

/// A weight that counts as none \[-\].
const ROUND_OFF: f64 = 1e-12;

/// The cells around a node, and those that are up to `reach` cells away from them.
pub(crate) fn cells_around<const D: usize>(
    grid: &Grid<D>,
    node: usize,
    reach: usize,
) -> impl Iterator<Item = [usize; D]> + '_ {
    let place = grid.node_place(node);
    let lower: [usize; D] = place.map(|k| k.saturating_sub(reach + 1));
    let count: [usize; D] = std::array::from_fn(|axis| {
        (place[axis] + reach + 1).min(grid.axes[axis].cell_count()) - lower[axis]
    });
    (0..count.iter().product()).map(move |mut index: usize| {
        std::array::from_fn(|axis| {
            let at = lower[axis] + index % count[axis];
            index /= count[axis];
            at
        })
    })
}

/// The nodes of a cell with the values of their linear functions at a node, which may lie beyond the cell.
pub(crate) fn carried_beyond<const D: usize>(
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
        .filter(|carrier| carrier.weight.abs() > ROUND_OFF)
        .collect()
}

/// Cells of which every node is one of another cell or is extrapolated from it, each with that cell: their motion is its
/// linear functions continued.
pub(crate) fn followers<const D: usize>(
    grid: &Grid<D>,
    ties: &Ties,
) -> BTreeMap<[usize; D], [usize; D]> {
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
