//! Krylov methods preconditioned by geometric multigrid on the background grid.
//!
//! The grids are made by leaving out every second line; the places of the nodes tell where they are
//! ([`transfer`]). Coarse matrices are Galerkin's ([`galerkin`]), the smoother is an incomplete elimination without fill by the blocks of nodes
//! ([`smoother`]), in an order that threads can share ([`slabs`]), and the coarsest grid is solved directly
//! ([`dense`]). All of this is kept in single precision ([`rows`]). Nodes that carry little soil, at surfaces that cut cells,
//! are solved for directly before and after each cycle ([`skin`]). Both together are the preconditioner of conjugate
//! gradients, for symmetric matrices, or of generalised minimal residuals ([`krylov`]), which use the matrix itself
//! ([`product`]). The solution is checked against it, from restart to restart ([`preconditioned`]).
//!
//! Where pore pressures are among the unknowns, soil and water have a multigrid each ([`coupled`]).

mod boundary_nodes;
mod coupled;
mod cycle;
mod dense;
mod galerkin;
mod hierarchy;
mod rows;
mod slabs;
mod smoother;
mod solver;
mod transfer;

pub(super) use crate::krylov::preconditioned::Demand;
pub(super) use solver::Iteration;
