//! Problems of geotechnics, from a case file to results that can be relied on.
//!
//! A [`case file`](input) states a problem in plane strain: grid, materials, bodies, supports, loads,
//! stages, and what it is held against. It is read into a [`Case`](case::Case), and a
//! [`run`](mod@run) takes that case through its stages. The program `igimp` is a shell around these
//! three; what it can do, a Rust program can.
//!
//! | module | what to find |
//! |---|---|
//! | [`input`], [`case`], [`shipped`] | case files, the problem as data, the files that come with the program |
//! | [`run`](mod@run), [`summary`] | the engine: stages, strength reduction, run-out, events as they happen; what a run says of itself |
//! | [`results`], [`table`] | the results folder: ParaView, checkpoints, pictures, report; CSV |
//! | [`check`], [`exact`], [`measure`] | bands, exact solutions, what is read off particles |
//! | [`seed`], [`polygon`], [`estimate`] | particles from polygons; the size of a case before it runs |
//! | [`sweep`] | many cases that differ in a few values |
//! | [`telling`] | what is said of a case and of its run, as text |
//! | [`mesh_study`] | the mesh error: a case on several meshes, and what their values say together |
//!
//! # The factor of safety of a slope
//!
//! A shipped case is changed by overrides and run; tables, pictures and `report.html` are written as
//! they are computed. `cargo run --release --example slope` runs this program.
//!
//! ```
#![doc = include_str!("../examples/slope.rs")]
//! ```

pub mod case;
pub mod check;
pub mod estimate;
pub mod exact;
pub mod input;
pub mod measure;
pub mod mesh_study;
pub mod pieces;
mod plane;
pub mod polygon;
pub mod printable;
pub mod region;
pub mod results;
pub mod run;
pub mod seed;
pub mod shipped;
pub mod slip;
pub mod solid;
pub mod summary;
pub mod sweep;
pub mod table;
pub mod telling;

mod error;

pub use error::{CaseError, chain, is_of_the_system};

/// The examples of the book, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/tour.md")]
struct Tour;

/// The examples of the developer notes, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/developer.md")]
struct DeveloperNotes;

/// The example of the user guide, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/src/guide/library.md")]
struct UserGuide;
