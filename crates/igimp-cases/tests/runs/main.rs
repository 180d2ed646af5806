//! GOAL: a case is run as it says: stages, laws, solvers, remarks, checkpoints, in the plane and in space.

#[path = "../common/edits.rs"]
mod edits;
#[path = "../common/resuming.rs"]
mod resuming;

mod column;
mod engine;
mod factors;
mod from_stage;
mod given_law;
mod in_space;
mod killed;
mod mechanism;
mod modes;
mod readings;
mod remarks;
mod revolution;
mod run_out;
mod swapped;
mod unmet;
mod warnings;
mod without_hold;
