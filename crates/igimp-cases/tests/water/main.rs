//! GOAL: water and the stages that go with it: pore pressure, seepage, construction under water, in the plane and in space.

#[path = "../common/edits.rs"]
mod edits;
#[path = "../common/messages.rs"]
mod messages;
#[path = "../common/resuming.rs"]
mod resuming;

mod column;
mod construction;
mod in_space;
mod of_its_stage;
mod pore_water;
mod seepage;
mod state_stiffness;
