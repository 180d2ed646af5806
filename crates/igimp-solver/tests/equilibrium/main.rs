//! Equilibrium of a step and of a march: one program, as every one compiles the equations anew.

mod beam;
#[path = "../body_support/mod.rs"]
mod body_support;
mod consolidation;
mod drag;
mod element;
mod faults;
mod guarded;
mod hardening_soil;
mod linear_multigrid;
mod march;
mod march_properties;
mod newton;
mod newton_failures;
mod nonlocal;
mod one_dimension;
mod push_out;
mod reinforcement;
mod softening;
mod undrained;
