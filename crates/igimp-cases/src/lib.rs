//! The benchmark cases of the implicit generalised interpolation material point method, the exact
//! solutions and measures that they are held against, and their tables and pictures.

pub mod case;
pub mod check;
pub mod column;
pub mod estimate;
pub mod exact;
pub mod figures;
pub mod footing;
pub mod input;
pub mod measure;
pub mod mohr_coulomb_slope;
pub mod polygon;
pub mod results;
pub mod run;
pub mod safety;
pub mod seed;
pub mod shipped;
pub mod slope;
pub mod summary;
pub mod sweep;
pub mod table;
pub mod von_mises_slope;

mod error;
mod parameter;

pub use error::{CaseError, chain};

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
