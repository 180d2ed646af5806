//! Problems of geotechnics and their runs: stages, searches, events as they happen.
//!
//! A case file is read into a [`Case`](igimp_model::Case) by [`igimp_input`], and a [`run`](mod@run) takes that case through
//! its stages. The program `igimp` is a shell around these; a Rust program can do the same.
//!
//! | module | contents |
//! |---|---|
//! | [`run`](mod@run) | the engine: stages, strength reduction, run-out, resuming |
//! | [`mesh_study`] | results of a case on several meshes together |
//! | [`exact`] | exact solutions |
//!
//! # The factor of safety of a slope
//!
//! A shipped case is changed by overrides and run; tables, pictures and `report.html` are written as
//! they are computed. `cargo run --release --example slope` runs this program.
//!
//! ```
#![doc = include_str!("../examples/slope.rs")]
//! ```

pub mod exact;
pub(crate) mod fallen;
pub(crate) mod limit;
pub mod mesh_study;
pub mod run;

mod error;
#[cfg(test)]
mod fixture;

pub use error::{CaseError, chain, is_of_the_system, on_one_line};
