//! The results folder: its layout, and the files in it for people, ParaView, numpy and the next
//! run.

pub mod atomic;
pub mod checkpoint;
pub mod ending;
mod error;
pub mod fields;
pub mod folder;
pub mod linear_system;
pub mod measure;
pub mod mesh_study;
pub mod model_size;
pub mod npy;
pub mod paraview;
pub mod reinforcement;
pub mod rigid;
pub mod summary;
pub mod tables;
pub mod vtu;

#[cfg(test)]
mod scratch;

pub use error::{NpyError, ResultsError};
