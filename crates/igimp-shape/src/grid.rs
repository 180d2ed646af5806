//! The background grid: a tensor product of axes, and the numbering of its nodes and cells.

use std::array;

use crate::Axis;

/// Rectilinear background grid in `D` directions.
///
/// Nodes and cells are numbered with axis 0 fastest. A *place* is a multi-index, one entry per
/// direction; a cell has the place of its lowest node.
///
/// ```
/// use igimp_shape::{Axis, Grid};
///
/// let grid = Grid::new([Axis::uniform(0.0, 1.0, 4)?, Axis::uniform(0.0, 0.5, 2)?]);
/// assert_eq!((grid.node_count(), grid.cell_count()), (15, 8));
/// assert_eq!(grid.node_index([3, 1]), 8);
/// assert_eq!(grid.node_position(8), [3.0, 0.5]);
/// assert_eq!(grid.cell_at(&[3.2, 0.1]), Some([3, 0]));
/// # Ok::<(), igimp_shape::ShapeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Grid<const D: usize> {
    /// One axis per direction.
    pub axes: [Axis; D],
}

impl<const D: usize> Grid<D> {
    /// Grid spanned by the given axes.
    pub fn new(axes: [Axis; D]) -> Self {
        Self { axes }
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.axes.iter().map(Axis::node_count).product()
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.axes.iter().map(Axis::cell_count).product()
    }

    /// Number of the node at a place; each entry below the node count of its axis.
    #[inline]
    pub fn node_index(&self, place: [usize; D]) -> usize {
        flatten(place, array::from_fn(|d| self.axes[d].node_count()))
    }

    /// Place of node `node`; inverse of [`node_index`](Self::node_index).
    #[inline]
    pub fn node_place(&self, node: usize) -> [usize; D] {
        unflatten(node, array::from_fn(|d| self.axes[d].node_count()))
    }

    /// Coordinates of node `node` \[length\].
    ///
    /// # Panics
    ///
    /// When the axes are shorter than the node's place says, i.e. there is no such node.
    #[inline]
    pub fn node_position(&self, node: usize) -> [f64; D] {
        let place = self.node_place(node);
        array::from_fn(|d| self.axes[d].nodes()[place[d]])
    }

    /// Number of the cell at a place; each entry below the cell count of its axis.
    #[inline]
    pub fn cell_index(&self, place: [usize; D]) -> usize {
        flatten(place, array::from_fn(|d| self.axes[d].cell_count()))
    }

    /// Place of cell `cell`; inverse of [`cell_index`](Self::cell_index).
    #[inline]
    pub fn cell_place(&self, cell: usize) -> [usize; D] {
        unflatten(cell, array::from_fn(|d| self.axes[d].cell_count()))
    }

    /// Place of the cell that contains `x` \[length\]; `None` outside the grid and for NaN.
    ///
    /// Faces belong to the cell above, the last face to the last cell: see [`Axis::cell_at`].
    #[inline]
    pub fn cell_at(&self, x: &[f64; D]) -> Option<[usize; D]> {
        let mut place = [0; D];
        for d in 0..D {
            place[d] = self.axes[d].cell_at(x[d])?;
        }
        Some(place)
    }

    /// The cells that a point lies in, or on whose sides it does: on a line those before and behind it.
    pub fn cells_around(&self, x: &[f64; D]) -> impl Iterator<Item = usize> {
        let sides: [[Option<usize>; 2]; D] = std::array::from_fn(|axis| {
            let along = &self.axes[axis];
            let at = along.cell_at(x[axis]);
            let before = at.filter(|&cell| cell > 0 && x[axis] <= along.nodes()[cell]);
            [at, before.map(|cell| cell - 1)]
        });
        (0..1_usize << D).filter_map(move |corner| {
            let place: [Option<usize>; D] =
                std::array::from_fn(|axis| sides[axis][corner >> axis & 1]);
            let is_there = place.iter().all(Option::is_some);
            is_there.then(|| self.cell_index(place.map(Option::unwrap_or_default)))
        })
    }

    /// Edge lengths $`h_d`$ of the cell at a place \[length\].
    ///
    /// # Panics
    ///
    /// When there is no such cell.
    #[inline]
    pub fn cell_size(&self, place: [usize; D]) -> [f64; D] {
        array::from_fn(|d| self.axes[d].spacing(place[d]))
    }

    /// Whether `x` \[length\] lies in the grid, its boundary included; false for NaN.
    #[inline]
    pub fn contains(&self, x: &[f64; D]) -> bool {
        self.axes
            .iter()
            .zip(x)
            .all(|(axis, &x)| axis.start() <= x && x <= axis.end())
    }

    /// Lower and upper corner of the grid \[length\].
    pub fn bounds(&self) -> ([f64; D], [f64; D]) {
        (
            array::from_fn(|d| self.axes[d].start()),
            array::from_fn(|d| self.axes[d].end()),
        )
    }
}

/// Running number of a place in a box of `counts` entries, axis 0 fastest.
#[inline]
fn flatten<const D: usize>(place: [usize; D], counts: [usize; D]) -> usize {
    (0..D).rev().fold(0, |index, d| {
        debug_assert!(place[d] < counts[d], "place {place:?} outside {counts:?}");
        index * counts[d] + place[d]
    })
}

/// Place of a running number in a box of `counts` entries, axis 0 fastest.
#[inline]
fn unflatten<const D: usize>(index: usize, counts: [usize; D]) -> [usize; D] {
    debug_assert!(
        index < counts.iter().product(),
        "index {index} outside {counts:?}"
    );
    let mut rest = index;
    array::from_fn(|d| {
        let entry = rest % counts[d];
        rest /= counts[d];
        entry
    })
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::float_cmp,
        reason = "coordinates are handed out as they came in"
    )]

    use super::*;

    fn grid() -> Grid<3> {
        Grid::new([
            Axis::uniform(0.0, 1.0, 4).unwrap(),
            Axis::uniform(-1.0, 0.5, 2).unwrap(),
            Axis::from_nodes(vec![0.0, 1.0, 3.0, 7.0]).unwrap(),
        ])
    }

    #[test]
    fn numbering_is_a_bijection_with_axis_0_fastest() {
        let grid = grid();
        assert_eq!(
            (grid.node_count(), grid.cell_count()),
            (5 * 3 * 4, 4 * 2 * 3)
        );
        for node in 0..grid.node_count() {
            assert_eq!(grid.node_index(grid.node_place(node)), node);
        }
        for cell in 0..grid.cell_count() {
            assert_eq!(grid.cell_index(grid.cell_place(cell)), cell);
        }
        assert_eq!(grid.node_index([1, 0, 0]), 1);
        assert_eq!(grid.node_index([0, 1, 0]), 5);
        assert_eq!(grid.node_index([0, 0, 1]), 15);
        assert_eq!(grid.cell_index([0, 1, 1]), 12);
    }

    #[test]
    fn places_know_their_geometry() {
        let grid = grid();
        assert_eq!(
            grid.node_position(grid.node_index([3, 1, 2])),
            [3.0, -0.5, 3.0]
        );
        assert_eq!(grid.cell_at(&[4.0, -0.5, 2.9]), Some([3, 1, 1]));
        assert_eq!(grid.cell_size([3, 1, 1]), [1.0, 0.5, 2.0]);
        assert_eq!(grid.bounds(), ([0.0, -1.0, 0.0], [4.0, 0.0, 7.0]));
    }

    #[test]
    fn the_boundary_is_inside() {
        let grid = grid();
        assert!(grid.contains(&[4.0, -1.0, 7.0]));
        for x in [[4.1, -0.5, 1.0], [1.0, -1.1, 1.0], [1.0, -0.5, f64::NAN]] {
            assert!(!grid.contains(&x));
            assert_eq!(grid.cell_at(&x), None);
        }
    }
}
