//! Structures that touch and hold soil: one program, as every one compiles the equations anew.

mod clearance;
#[path = "../common/mod.rs"]
mod common;
mod contact;
mod ground;
mod reinforcement;
mod surfaces;
