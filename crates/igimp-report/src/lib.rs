//! What a run looks like: pictures, the report, and the viewer, drawn from a case and its results.

mod error;
pub mod failure_mechanism;
pub mod patches;
pub mod pictures;
pub mod report;
pub mod setup;
pub mod skin;
pub mod viewer;

pub use error::ReportError;
