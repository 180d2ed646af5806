//! The results folder: its layout, and the files in it for people, ParaView, numpy and the next
//! run.

pub mod admission;
pub mod atomic;
pub mod cells;
pub mod checkpoint;
mod error;
pub mod fields;
pub mod folder;
pub mod frames;
pub mod linear_system;
pub mod lock;
pub mod measure;
pub mod mesh_study;
pub mod npy;
pub mod owner;
pub mod particles;
pub mod pvd;
pub mod regime;
pub mod reinforcement;
pub mod rigid;
pub mod rows;
pub mod summary;
pub mod table;
pub mod vtu;

#[cfg(test)]
mod scratch;

pub use error::ResultsError;
