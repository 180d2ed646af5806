//! Background grid and basis functions of the implicit material point method.
//!
//! A particle sees the grid only through a short list of [`Support`]s: for every node it touches
//! the basis value $`S_i`$, the gradient $`\nabla S_i`$ and the cell-averaged centre gradient
//! $`\nabla\bar S_i`$ that B-bar uses against volumetric locking. This crate makes those lists
//! and knows nothing of stress, history, files or threads.
//!
//! | module story | types |
//! |---|---|
//! | one direction of the grid | [`Axis`] |
//! | tensor product of axes, node and cell numbering | [`Grid`] |
//! | weights of one direction: linear (iMPM) and GIMP | [`Basis`], [`Linear`], [`Gimp`], [`NodeWeight`] |
//! | small dense matrices as plain arrays | [`matrices`] |
//! | tensor product of weights | [`supports`], [`Support`], [`Scratch`] |
//! | errors | [`ShapeError`] |
//!
//! Whatever is per direction lives on an [`Axis`]; everything else is a product over `D`
//! directions, so plane strain (`D = 2`) and 3D are the same code.
//!
//! # Example
//!
//! The displacement gradient of a particle from nodal displacements that stretch the ground by
//! 1 % along $`x`$ is exact, both from $`\nabla S_i`$ and from $`\nabla\bar S_i`$:
//!
//! ```
//! use igimp_shape::{Axis, Gimp, Grid, Scratch, supports};
//!
//! let grid = Grid::new([Axis::uniform(0.0, 1.0, 8)?, Axis::uniform(0.0, 0.5, 8)?]);
//! let (mut scratch, mut list) = (Scratch::default(), Vec::new());
//! supports(&grid, &Gimp, &[2.9, 1.75], &[0.25, 0.125], &mut scratch, &mut list)?;
//! assert_eq!(list.len(), 6); // three nodes along x, two along y
//!
//! let (mut stretch, mut stretch_bar) = (0.0, 0.0);
//! for support in &list {
//!     let u_x = 0.01 * grid.node_position(support.node)[0];
//!     stretch += u_x * support.grad[0];
//!     stretch_bar += u_x * support.grad_bar[0];
//! }
//! assert!((stretch - 0.01).abs() < 1e-15);
//! assert!((stretch_bar - 0.01).abs() < 1e-15);
//! # Ok::<(), igimp_shape::ShapeError>(())
//! ```
//!
//! # Sources
//!
//! - S. G. Bardenhagen, E. M. Kober (2004), *The generalized interpolation material point
//!   method*, CMES 5(6), 477–495: the GIMP basis.
//! - Yuan et al. (2021), [doi:10.1631/jzus.A2100219](https://doi.org/10.1631/jzus.A2100219):
//!   implicit GIMP with B-bar, the cell-averaged centre gradient.

mod axis;
mod basis;
mod error;
mod grid;
mod loose;
pub mod matrices;
mod parts;
mod support;

pub use axis::Axis;
pub use basis::{Basis, Gimp, Linear, NodeWeight};
pub use error::ShapeError;
pub use grid::Grid;
pub use loose::loose_cells;
pub use parts::{AxisPart, CellPart, cell_parts};
pub use support::{Scratch, Support, supports};
