//! The equations of soil: one program, as every one compiles them anew.

#[path = "../common/mod.rs"]
mod common;
mod consolidation;
mod energy;
mod errors;
mod given_geometry;
mod invariants;
mod nonlocal;
mod patch;
mod pore_water;
mod residual;
mod revolution;
mod small_cuts;
mod stencils;
mod tangent;
mod threads;
