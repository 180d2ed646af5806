//! One direction of the background grid: node coordinates and the search for a cell.

use crate::ShapeError;

/// Round-off of a coordinate relative to the largest one on the axis: a few units in the last
/// place, the loss of a sum like `x + half_length`.
const ROUND_OFF: f64 = 16.0 * f64::EPSILON;

/// Strictly increasing node coordinates of one direction \[length\].
///
/// Cell `c` lies between nodes `c` and `c + 1`. The coordinates are the only truth; whether the
/// nodes are evenly spaced merely decides how a cell is searched: O(1) on a uniform axis,
/// by bisection otherwise. The first and last node are the walls of the grid.
///
/// ```
/// use igimp_shape::Axis;
///
/// let axis = Axis::uniform(-1.0, 0.5, 4)?;
/// assert_eq!(axis.nodes(), [-1.0, -0.5, 0.0, 0.5, 1.0]);
/// assert_eq!(axis.cell_at(0.2), Some(2));
///
/// let graded = Axis::from_nodes(vec![0.0, 1.0, 3.0, 7.0])?;
/// assert_eq!(graded.spacing(1), 2.0);
/// # Ok::<(), igimp_shape::ShapeError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    nodes: Vec<f64>,
    /// Coordinates closer than this are the same up to round-off \[length\].
    resolution: f64,
    /// Cells per length when the nodes are evenly spaced up to `resolution`.
    cells_per_length: Option<f64>,
}

impl Axis {
    /// Evenly spaced axis: node `k` at `start + k * spacing` \[length\], `cells + 1` nodes.
    ///
    /// # Errors
    ///
    /// [`ShapeError::InvalidSpacing`] unless `spacing` is positive and finite,
    /// [`ShapeError::EmptyAxis`] without a cell, [`ShapeError::NotFinite`] when a coordinate is
    /// not a finite number, [`ShapeError::NotIncreasing`] when `spacing` drowns in the round-off
    /// of the coordinates.
    pub fn uniform(start: f64, spacing: f64, cells: usize) -> Result<Self, ShapeError> {
        if !(spacing > 0.0 && spacing.is_finite()) {
            return Err(ShapeError::InvalidSpacing { spacing });
        }
        Self::from_nodes((0..=cells).map(|k| start + k as f64 * spacing).collect())
    }

    /// Axis through the given node coordinates \[length\], at least two, strictly increasing.
    ///
    /// Evenly spaced nodes are recognised and searched in O(1).
    ///
    /// # Errors
    ///
    /// [`ShapeError::EmptyAxis`] with fewer than two nodes, [`ShapeError::NotFinite`] when a
    /// coordinate is not a finite number, [`ShapeError::NotIncreasing`] when a node does not
    /// exceed its predecessor by more than round-off.
    pub fn from_nodes(nodes: Vec<f64>) -> Result<Self, ShapeError> {
        let [start, .., end] = nodes[..] else {
            return Err(ShapeError::EmptyAxis { nodes: nodes.len() });
        };
        if let Some(index) = nodes.iter().position(|node| !node.is_finite()) {
            return Err(ShapeError::NotFinite {
                index,
                node: nodes[index],
            });
        }
        let resolution = ROUND_OFF * start.abs().max(end.abs());
        for (index, pair) in nodes.windows(2).enumerate() {
            if pair[1] - pair[0] <= resolution {
                let (previous, node) = (pair[0], pair[1]);
                return Err(ShapeError::NotIncreasing {
                    index: index + 1,
                    previous,
                    node,
                });
            }
        }
        let spacing = (end - start) / (nodes.len() - 1) as f64;
        let is_even =
            |(k, node): (usize, &f64)| (node - (start + k as f64 * spacing)).abs() <= resolution;
        let uniform = nodes.iter().enumerate().all(is_even);
        Ok(Self {
            nodes,
            resolution,
            cells_per_length: uniform.then(|| spacing.recip()),
        })
    }

    /// Node coordinates, ascending \[length\].
    #[inline]
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Number of nodes, at least two.
    #[inline]
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Number of cells, at least one.
    #[inline]
    pub fn cell_count(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Coordinate of the first node \[length\].
    #[inline]
    pub fn start(&self) -> f64 {
        self.nodes[0]
    }

    /// Coordinate of the last node \[length\].
    #[inline]
    pub fn end(&self) -> f64 {
        self.nodes[self.nodes.len() - 1]
    }

    /// Size $`h`$ of a cell \[length\]: the distance of its two nodes.
    ///
    /// # Panics
    ///
    /// When there is no such cell.
    #[inline]
    pub fn spacing(&self, cell: usize) -> f64 {
        self.nodes[cell + 1] - self.nodes[cell]
    }

    /// The cell that contains `x` \[length\]; `None` outside the axis and for NaN.
    ///
    /// The axis is closed at both ends. A point on an inner node belongs to the cell that starts
    /// there, a point on the last node to the last cell.
    ///
    /// ```
    /// let axis = igimp_shape::Axis::uniform(0.0, 1.0, 3)?;
    /// assert_eq!(axis.cell_at(1.0), Some(1));
    /// assert_eq!(axis.cell_at(3.0), Some(2));
    /// assert_eq!(axis.cell_at(3.1), None);
    /// # Ok::<(), igimp_shape::ShapeError>(())
    /// ```
    #[inline]
    pub fn cell_at(&self, x: f64) -> Option<usize> {
        (self.start() <= x && x <= self.end()).then(|| self.nearest_cell(x))
    }

    /// The cell that contains `x`, or the first or last cell when `x` is beyond the walls.
    #[inline]
    pub(crate) fn nearest_cell(&self, x: f64) -> usize {
        let last = self.cell_count() - 1;
        let Some(cells_per_length) = self.cells_per_length else {
            return self
                .nodes
                .partition_point(|&node| node <= x)
                .saturating_sub(1)
                .min(last);
        };
        // The guess is off by one at most; the node coordinates have the last word.
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast rounds down, and saturates beyond the walls"
        )]
        let guess = ((x - self.start()) * cells_per_length) as usize;
        let mut cell = guess.min(last);
        while cell > 0 && x < self.nodes[cell] {
            cell -= 1;
        }
        while cell < last && x >= self.nodes[cell + 1] {
            cell += 1;
        }
        cell
    }

    /// Length below which two coordinates of this axis are the same up to round-off.
    #[inline]
    pub(crate) fn resolution(&self) -> f64 {
        self.resolution
    }
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::float_cmp,
        reason = "coordinates are handed out as they came in"
    )]

    use super::*;

    #[test]
    fn even_nodes_are_recognised() {
        let uniform = Axis::uniform(-3.0, 0.1, 77).unwrap();
        assert!(uniform.cells_per_length.is_some());
        assert_eq!(Axis::from_nodes(uniform.nodes().to_vec()).unwrap(), uniform);
        assert!(
            Axis::from_nodes(vec![0.0, 1.0, 2.0 + 1e-12])
                .unwrap()
                .cells_per_length
                .is_none()
        );
    }

    #[test]
    fn sizes_and_ends() {
        let axis = Axis::from_nodes(vec![-1.0, 0.0, 2.0, 2.5]).unwrap();
        assert_eq!((axis.node_count(), axis.cell_count()), (4, 3));
        assert_eq!((axis.start(), axis.end()), (-1.0, 2.5));
        assert_eq!([0, 1, 2].map(|cell| axis.spacing(cell)), [1.0, 2.0, 0.5]);
    }

    #[test]
    fn faces_belong_to_the_cell_above() {
        let uniform = Axis::uniform(1.7, 0.1, 1000).unwrap();
        let graded = Axis::from_nodes((0..100).map(|k| 1.05_f64.powi(k)).collect()).unwrap();
        for axis in [uniform, graded] {
            let last = axis.cell_count() - 1;
            for cell in 0..=last {
                let face = axis.nodes()[cell];
                assert_eq!(axis.cell_at(face), Some(cell));
                assert_eq!(axis.cell_at(face.next_down()), cell.checked_sub(1));
            }
            assert_eq!(axis.cell_at(axis.end()), Some(last));
            assert_eq!(axis.cell_at(axis.end().next_up()), None);
            assert_eq!(axis.cell_at(f64::NAN), None);
            assert_eq!(axis.nearest_cell(f64::NEG_INFINITY), 0);
            assert_eq!(axis.nearest_cell(f64::INFINITY), last);
        }
    }

    #[test]
    fn a_far_origin_is_searched_exactly() {
        let axis = Axis::uniform(1e9, 0.1, 1000).unwrap();
        for (cell, &face) in axis.nodes()[..1000].iter().enumerate() {
            assert_eq!(axis.cell_at(face), Some(cell));
        }
    }

    #[test]
    fn bad_axes_are_refused() {
        use ShapeError::{EmptyAxis, InvalidSpacing, NotFinite, NotIncreasing};
        for spacing in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            let error = Axis::uniform(0.0, spacing, 3).unwrap_err();
            assert!(matches!(error, InvalidSpacing { .. }), "{error}");
        }
        assert_eq!(Axis::uniform(0.0, 1.0, 0), Err(EmptyAxis { nodes: 1 }));
        assert_eq!(Axis::from_nodes(vec![]), Err(EmptyAxis { nodes: 0 }));
        assert_eq!(
            Axis::uniform(0.0, f64::MAX, 2),
            Err(NotFinite {
                index: 2,
                node: f64::INFINITY
            })
        );
        let error = Axis::from_nodes(vec![0.0, f64::NAN, 2.0]).unwrap_err();
        assert!(matches!(error, NotFinite { index: 1, .. }), "{error}");
        assert_eq!(
            Axis::from_nodes(vec![0.0, 1.0, 1.0, 2.0]),
            Err(NotIncreasing {
                index: 2,
                previous: 1.0,
                node: 1.0
            })
        );
        let drowned = Axis::uniform(1e16, 1.0, 1).unwrap_err();
        assert!(
            matches!(drowned, NotIncreasing { index: 1, .. }),
            "{drowned}"
        );
    }
}
