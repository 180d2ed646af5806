//! Case files: from TOML to a [`Case`](igimp_model::Case), with messages that name place, text and remedy.
//!
//! A file is parsed, checked against the schema and completed with its defaults in `igimp-schema`, given what it takes from
//! other files (`igimp-files`), and built into a [`Case`](igimp_model::Case) with the checks that need more than one value
//! (`build`). Every problem is collected on the way and shown in the order of the file.
//!
//! ```
//! use igimp_input::CaseFile;
//!
//! let text = include_str!("../cases/slope.toml");
//! let overrides = ["materials.clay.cohesoin=12 kPa".to_owned()];
//! let error = CaseFile::parse("slope.toml", text, &overrides).unwrap_err();
//! assert!(error.to_string().contains("did you mean `cohesion`?"));
//! ```

mod build;
mod in_time;
mod materials_file;
mod read;
pub mod shipped;

pub use materials_file::MaterialsFile;
pub use read::{CaseFile, InputError};
