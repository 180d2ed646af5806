//! Properties of the basis functions on random grids and random particles, in 1D, 2D and 3D.
//!
//! | module | oracle |
//! |---|---|
//! | `identities` | sums over the nodes: rigid motions and uniform gradients are exact |
//! | `quadrature` | Gauss quadrature of tent functions over the particle's domain |
//! | `closed_form` | the published three-range formulas, $`l_p \le h/2`$ |
//! | `symmetry` | change of length unit and mirror image, to the last bit; a linear search |
//! | `grid` | numbering and search: a bijection, a linear search, cells that tile the grid |

mod closed_form;
mod grid;
mod identities;
mod quadrature;
mod strategies;
mod symmetry;
