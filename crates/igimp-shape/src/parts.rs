//! The parts of a particle's domain in the cells that it overlaps (theory, eq. 5), and the tent functions of
//! a cell at a place within it.

use std::array;

use crate::{Basis, Grid, ShapeError};

/// The part of a particle's domain in one cell of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisPart {
    /// Number of the cell along the axis.
    pub cell: usize,
    /// Its share of the domain, $`w_c`$ \[-\]; the shares of a particle sum to one.
    pub share: f64,
    /// Middle of the part in the cell, $`m_c`$ \[-\]: 0 at the lower node, 1 at the upper one.
    pub middle: f64,
}

/// The part of a particle's domain in one cell of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellPart<const D: usize> {
    /// Place of the cell.
    pub cell: [usize; D],
    /// Its share of the domain \[-\]; the shares of a particle sum to one.
    pub share: f64,
    /// Middle of the part in the cell, from 0 to 1 in each direction \[-\].
    pub middle: [f64; D],
}

/// Appends the parts of one particle to `out`, one for each cell that its domain overlaps.
///
/// `x` is the particle's centre and `half_length` the half-lengths $`l_p`$ of its domain per direction
/// \[length\].
///
/// # Errors
/// As [`supports`](crate::supports); `out` is then unchanged.
///
/// # Example
///
/// ```
/// use igimp_shape::{Axis, Gimp, Grid, cell_parts};
///
/// let grid = Grid::new([Axis::uniform(0.0, 1.0, 4)?, Axis::uniform(0.0, 1.0, 4)?]);
/// let mut parts = Vec::new();
/// cell_parts(&grid, &Gimp, &[0.9, 0.5], &[0.25, 0.25], &mut parts)?;
/// assert_eq!(parts.len(), 2);
/// assert_eq!(parts[0].cell, [0, 0]);
/// assert!((parts[0].share - 0.7).abs() < 1e-15 && (parts[1].share - 0.3).abs() < 1e-15);
/// # Ok::<(), igimp_shape::ShapeError>(())
/// ```
pub fn cell_parts<const D: usize>(
    grid: &Grid<D>,
    basis: &dyn Basis,
    x: &[f64; D],
    half_length: &[f64; D],
    out: &mut Vec<CellPart<D>>,
) -> Result<(), ShapeError> {
    let mut along: [Vec<AxisPart>; D] = array::from_fn(|_| Vec::new());
    for d in 0..D {
        basis
            .axis_parts(&grid.axes[d], x[d], half_length[d], &mut along[d])
            .map_err(|error| error.on_axis(d))?;
    }
    let count: usize = along.iter().map(Vec::len).product();
    for number in 0..count {
        let mut rest = number;
        let parts: [AxisPart; D] = array::from_fn(|d| {
            let part = along[d][rest % along[d].len()];
            rest /= along[d].len();
            part
        });
        out.push(CellPart {
            cell: parts.map(|part| part.cell),
            share: parts.iter().map(|part| part.share).product(),
            middle: parts.map(|part| part.middle),
        });
    }
    Ok(())
}

impl<const D: usize> Grid<D> {
    /// The $`2^D`$ nodes of the cell at a place, with values \[-\] and gradients \[1/length\] of their tent
    /// functions at a point of the cell, from 0 to 1 in each direction.
    pub fn tents(
        &self,
        cell: [usize; D],
        point: [f64; D],
    ) -> impl Iterator<Item = (usize, f64, [f64; D])> {
        let size = self.cell_size(cell);
        (0..1_usize << D).map(move |corner| {
            let upper = |d: usize| corner >> d & 1;
            let factor = |d: usize| {
                if upper(d) == 1 {
                    point[d]
                } else {
                    1.0 - point[d]
                }
            };
            let node = self.node_index(array::from_fn(|d| cell[d] + upper(d)));
            let value = (0..D).map(factor).product();
            let gradient = array::from_fn(|d| {
                let slope = if upper(d) == 1 { 1.0 } else { -1.0 } / size[d];
                let others = (0..D).filter(|&e| e != d).map(factor);
                slope * others.product::<f64>()
            });
            (node, value, gradient)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Gimp, Linear, Scratch, supports};

    #[test]
    fn the_parts_of_a_particle_make_its_supports() {
        let x_axis = Axis::from_nodes(vec![0.0, 0.7, 1.9, 2.4, 4.0]).unwrap();
        let grid = Grid::new([x_axis, Axis::uniform(-1.0, 0.5, 6).unwrap()]);
        let bases: [&dyn Basis; 2] = [&Gimp, &Linear];
        for basis in bases {
            for (x, half_length) in [
                ([0.8, 0.3], [0.4, 0.2]),
                ([1.9, -0.5], [0.9, 0.25]),
                ([0.1, -0.9], [0.3, 0.3]),
                ([2.0, 0.1], [0.0, 0.0]),
            ] {
                let (mut scratch, mut list) = (Scratch::default(), Vec::new());
                supports(&grid, basis, &x, &half_length, &mut scratch, &mut list).unwrap();
                let mut parts = Vec::new();
                cell_parts(&grid, basis, &x, &half_length, &mut parts).unwrap();
                for support in &list {
                    let (mut value, mut grad, mut centre) = (0.0, [0.0; 2], [0.0; 2]);
                    for part in &parts {
                        let at = |point| {
                            let mut tents = grid.tents(part.cell, point);
                            tents.find(|(node, _, _)| *node == support.node)
                        };
                        if let (Some((_, s, g)), Some((_, _, c))) = (at(part.middle), at([0.5; 2]))
                        {
                            value += part.share * s;
                            for d in 0..2 {
                                grad[d] += part.share * g[d];
                                centre[d] += part.share * c[d];
                            }
                        }
                    }
                    assert!((value - support.value).abs() < 1e-14);
                    for d in 0..2 {
                        assert!((grad[d] - support.grad[d]).abs() < 1e-13);
                        assert!((centre[d] - support.grad_bar[d]).abs() < 1e-13);
                    }
                }
            }
        }
    }
}
