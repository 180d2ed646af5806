//! The domain of one particle on the grid, and lists of its supports.

use igimp_shape::{Grid, ShapeError, Support};

use crate::error::{AssemblyError, padded};

/// The lowest place of supports, and how far they extend along each axis.
pub(crate) fn bounds<const D: usize>(
    grid: &Grid<D>,
    supports: &[Support<D>],
) -> ([usize; D], [usize; D]) {
    let mut lower = [usize::MAX; D];
    let mut upper = [0; D];
    for support in supports {
        let place = grid.node_place(support.node);
        for axis in 0..D {
            lower[axis] = lower[axis].min(place[axis]);
            upper[axis] = upper[axis].max(place[axis]);
        }
    }
    (lower, std::array::from_fn(|axis| upper[axis] - lower[axis]))
}

/// Adds up neighbouring supports of the same node; returns how many are left at the front.
pub(crate) fn merge_equal_nodes<const D: usize>(supports: &mut [Support<D>]) -> usize {
    let mut kept = 0;
    for k in 1..supports.len() {
        let support = supports[k];
        if supports[kept].node == support.node {
            let sum = &mut supports[kept];
            sum.value += support.value;
            for axis in 0..D {
                sum.grad[axis] += support.grad[axis];
                sum.grad_bar[axis] += support.grad_bar[axis];
            }
        } else {
            kept += 1;
            supports[kept] = support;
        }
    }
    kept + 1
}

/// Half-lengths limited to the size of the cell that holds the centre.
pub(crate) fn capped_half_length<const D: usize>(
    grid: &Grid<D>,
    x: &[f64; D],
    mut half_length: [f64; D],
) -> [f64; D] {
    if let Some(cell) = grid.cell_at(x) {
        let size = grid.cell_size(cell);
        for axis in 0..D {
            half_length[axis] = half_length[axis].min(size[axis]);
        }
    }
    half_length
}

/// The error of a particle whose centre or domain has no place on the grid.
pub(crate) fn off_grid<const D: usize>(
    particle: usize,
    x: &[f64; D],
    source: ShapeError,
) -> AssemblyError {
    AssemblyError::Shape {
        particle,
        position: padded(x),
        source,
    }
}
