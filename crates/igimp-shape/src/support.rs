//! Supports of a particle: the tensor product of the weights of its directions (theory, eqs. 6 to 8).
//!
//! Yuan et al. (2021), doi:10.1631/jzus.A2100219, for the cell-averaged centre gradient.

use std::array;

use crate::{Basis, Grid, NodeWeight, ShapeError};

/// Weights of one node of the grid for one particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support<const D: usize> {
    /// Number of the node in the grid.
    pub node: usize,
    /// Basis value $`S_i = \prod_d S_d`$ \[-\].
    pub value: f64,
    /// Gradient $`\nabla S_i`$ \[1/length\]: component $`d`$ is
    /// $`S'_d \prod_{e \ne d} S_e`$.
    pub grad: [f64; D],
    /// Cell-averaged centre gradient $`\nabla\bar S_i`$ \[1/length\]: component $`d`$ is
    /// $`S'_d \prod_{e \ne d} \bar S_e`$, the mean over the particle of the gradient of the tent
    /// function at the centres of the cells it overlaps.
    pub grad_bar: [f64; D],
}

/// Room for the weights of each direction, kept from particle to particle so that
/// [`supports`] allocates nothing.
#[derive(Debug, Clone)]
pub struct Scratch<const D: usize> {
    weights: [Vec<NodeWeight>; D],
}

impl<const D: usize> Scratch<D> {
    /// Number of nodes along each axis of the particle evaluated last.
    pub fn counts(&self) -> [usize; D] {
        self.weights.each_ref().map(Vec::len)
    }
}

impl<const D: usize> Default for Scratch<D> {
    fn default() -> Self {
        Self {
            weights: array::from_fn(|_| Vec::new()),
        }
    }
}

/// Replaces `out` with the supports of one particle, in ascending node order (axis 0 fastest).
///
/// `x` is the particle's centre and `half_length` the half-lengths $`l_p`$ of its domain per
/// direction \[length\]. The supports satisfy, up to round-off,
///
/// ```math
/// \sum_i S_i = 1, \quad \sum_i \nabla S_i = \sum_i \nabla\bar S_i = 0, \quad
/// \sum_i x_i \otimes \nabla S_i = \sum_i x_i \otimes \nabla\bar S_i = I ,
/// ```
///
/// so rigid motions and uniform gradients are exact, walls and graded axes included.
///
/// # Errors
///
/// [`ShapeError::OutsideGrid`] when the centre is outside the grid (or NaN),
/// [`ShapeError::InvalidHalfLength`] when a half-length is negative or not finite; both name the
/// direction, and `out` is unchanged.
///
/// # Example
///
/// ```
/// use igimp_shape::{Axis, Grid, Linear, Scratch, supports};
///
/// let grid = Grid::new([Axis::uniform(0.0, 1.0, 2)?, Axis::uniform(0.0, 1.0, 2)?]);
/// let (mut scratch, mut list) = (Scratch::default(), Vec::new());
/// supports(&grid, &Linear, &[0.25, 1.5], &[0.0, 0.0], &mut scratch, &mut list)?;
///
/// assert_eq!(list.iter().map(|s| s.node).collect::<Vec<_>>(), [3, 4, 6, 7]);
/// assert_eq!(list[0].value, 0.375);
/// assert_eq!(list[0].grad, [-0.5, -0.75]);
/// assert_eq!(list[0].grad_bar, [-0.5, -0.5]);
/// # Ok::<(), igimp_shape::ShapeError>(())
/// ```
pub fn supports<const D: usize>(
    grid: &Grid<D>,
    basis: &dyn Basis,
    x: &[f64; D],
    half_length: &[f64; D],
    scratch: &mut Scratch<D>,
    out: &mut Vec<Support<D>>,
) -> Result<(), ShapeError> {
    for d in 0..D {
        basis
            .axis_weights(&grid.axes[d], x[d], half_length[d], &mut scratch.weights[d])
            .map_err(|error| error.on_axis(d))?;
    }
    let weights = scratch.weights.each_ref().map(Vec::as_slice);
    let count = weights.iter().map(|axis| axis.len()).product();
    out.clear();
    out.reserve(count);

    let mut place = [0; D];
    for _ in 0..count {
        out.push(product(grid, array::from_fn(|d| weights[d][place[d]])));
        advance(&mut place, &weights);
    }
    Ok(())
}

/// Product of one weight per direction.
#[inline]
fn product<const D: usize>(grid: &Grid<D>, weights: [NodeWeight; D]) -> Support<D> {
    let others = |d: usize, factor: fn(&NodeWeight) -> f64| -> f64 {
        (0..D)
            .filter(|&e| e != d)
            .map(|e| factor(&weights[e]))
            .product()
    };
    Support {
        node: grid.node_index(array::from_fn(|d| weights[d].node)),
        value: weights.iter().map(|weight| weight.value).product(),
        grad: array::from_fn(|d| weights[d].slope * others(d, |weight| weight.value)),
        grad_bar: array::from_fn(|d| weights[d].slope * others(d, |weight| weight.centre)),
    }
}

/// Next place in the product of the weights, axis 0 fastest.
#[inline]
fn advance<const D: usize>(place: &mut [usize; D], weights: &[&[NodeWeight]; D]) {
    for d in 0..D {
        place[d] += 1;
        if place[d] < weights[d].len() {
            return;
        }
        place[d] = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Gimp};

    #[test]
    fn nodes_ascend_with_axis_0_fastest() {
        let axis = Axis::uniform(0.0, 1.0, 4).unwrap();
        let grid = Grid::new([axis.clone(), axis.clone(), axis]);
        let (mut scratch, mut list) = (Scratch::default(), Vec::new());
        let (x, half_length) = ([1.9, 2.5, 2.1], [0.25; 3]);
        supports(&grid, &Gimp, &x, &half_length, &mut scratch, &mut list).unwrap();
        assert_eq!(list.len(), 3 * 2 * 3);
        assert_eq!(list[0].node, grid.node_index([1, 2, 1]));
        assert_eq!(list[17].node, grid.node_index([3, 3, 3]));
        assert!(list.windows(2).all(|pair| pair[0].node < pair[1].node));
    }

    #[test]
    fn nothing_is_allocated_for_the_next_particle() {
        let axis = Axis::uniform(0.0, 1.0, 4).unwrap();
        let grid = Grid::new([axis.clone(), axis]);
        let (mut scratch, mut list) = (Scratch::default(), Vec::new());
        supports(&grid, &Gimp, &[2.0; 2], &[0.5; 2], &mut scratch, &mut list).unwrap();
        let before = (list.as_ptr(), scratch.weights.each_ref().map(Vec::capacity));
        supports(&grid, &Gimp, &[1.1; 2], &[0.5; 2], &mut scratch, &mut list).unwrap();
        assert_eq!(
            (list.as_ptr(), scratch.weights.each_ref().map(Vec::capacity)),
            before
        );
    }

    #[test]
    fn errors_name_the_direction_and_keep_the_list() {
        let axis = Axis::uniform(0.0, 1.0, 4).unwrap();
        let grid = Grid::new([axis.clone(), axis]);
        let (mut scratch, mut list) = (Scratch::default(), Vec::new());
        supports(&grid, &Gimp, &[2.0; 2], &[0.5; 2], &mut scratch, &mut list).unwrap();
        let before = list.clone();
        assert_eq!(
            supports(
                &grid,
                &Gimp,
                &[2.0, 4.5],
                &[0.5; 2],
                &mut scratch,
                &mut list
            ),
            Err(ShapeError::OutsideGrid {
                axis: 1,
                x: 4.5,
                start: 0.0,
                end: 4.0
            })
        );
        assert_eq!(
            supports(
                &grid,
                &Gimp,
                &[2.0; 2],
                &[0.5, -0.5],
                &mut scratch,
                &mut list
            ),
            Err(ShapeError::InvalidHalfLength {
                axis: 1,
                half_length: -0.5
            })
        );
        assert_eq!(list, before);
    }
}
