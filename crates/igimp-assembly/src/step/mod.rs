//! Constants of a step: shape functions, supports, loads and the cells that hold soil.

pub(crate) mod cell_soil;
pub(crate) mod continuation;
pub(crate) mod domain;
pub(crate) mod hoops;
pub(crate) mod node_shares;
pub(crate) mod small_cuts;
pub(crate) mod stencils;
pub(crate) mod strips;
pub(crate) mod supports;
pub(crate) mod ties;
pub(crate) mod unknowns;
