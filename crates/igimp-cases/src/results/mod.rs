//! The results folder: its layout, and the files in it for people, ParaView, numpy and the next
//! run.

pub mod admission;
pub mod atomic;
pub(crate) mod cells;
pub mod checkpoint;
pub mod fields;
pub mod folder;
pub mod frames;
pub mod linear_system;
pub mod lock;
pub mod npy;
pub mod owner;
pub mod particles;
pub mod pictures;
pub mod pvd;
pub mod regime;
pub mod reinforcement;
pub mod report;
pub mod rigid;
pub mod rows;
pub mod setup;
pub mod skin;
pub mod viewer;
pub mod vtu;

#[cfg(test)]
mod scratch;
