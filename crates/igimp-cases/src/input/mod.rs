//! Case files: from TOML to a [`Case`], with messages that name place, text and remedy.
//!
//! A file is parsed ([`tree`]), changed by overrides, checked against the schema and completed with
//! its defaults ([`complete`]), and built into a [`Case`] with the checks that need more than one
//! value ([`build`]). Every problem is collected on the way and shown in the order of the file.

mod build;
mod complete;
mod diagnostic;
mod explain;
mod geometry;
mod json_schema;
mod names;
mod overrides;
mod quantity;
mod read;
mod reference;
mod schema;
mod source;
mod spec;
mod suggest;
mod syntax;
mod text;
mod toml_text;
mod tree;
mod units;
mod value;

pub use json_schema::json_schema;
pub use quantity::{Dimension, Quantity, QuantityError};
pub use read::{CaseFile, InputError};
pub use reference::reference_markdown;
