//! Pictures, the report and the viewer of a run, made from a case and its results.

mod error;
pub mod failure_mechanism;
pub mod film;
pub mod outlines;
pub mod patches;
pub mod pictures;
pub mod report;
pub mod setup;
pub mod skin;
pub mod viewer;
pub mod whereabouts;

pub use error::ReportError;
