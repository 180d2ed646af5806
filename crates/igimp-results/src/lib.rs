//! The results folder: its layout, and the files in it for people, ParaView, numpy and the next
//! run.

pub mod checkpoint;
mod error;
pub mod fields;
pub mod folder;
pub mod linear_system;
pub mod measure;
pub mod mesh_study;
pub mod npy;
pub mod paraview;
pub mod reinforcement;
pub mod rigid;
pub mod summary;
pub mod tables;

#[cfg(test)]
mod scratch;

pub use error::ResultsError;
