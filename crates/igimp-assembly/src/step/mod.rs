//! What holds during a step: shape functions, supports, loads and the cells that hold soil.

pub(crate) mod cell_soil;
pub(crate) mod constraints;
pub(crate) mod dropped;
pub(crate) mod loads;
pub(crate) mod small_cuts;
pub(crate) mod stencils;
pub(crate) mod step_conditions;
pub(crate) mod strips;
pub(crate) mod supports;
