//! The keys of case files: every table, key, unit, range and default, declared once.
//!
//! A file is parsed into a tree whose values know their places (`tree`), changed by overrides, checked
//! against the schema and completed with its defaults (`complete`). The same declarations (`schema`) drive
//! explanations of single keys, [`json_schema`] and [`reference_markdown`]. Nothing here knows what a case is.

pub mod complete;
pub mod diagnostic;
pub mod explain;
pub mod field;
mod json_schema;
pub mod names;
pub mod overrides;
pub mod quantity;
mod reference;
pub mod schema;
pub mod source;
mod spec;
pub mod syntax;
pub mod text;
pub mod tree;

pub use diagnostic::{Diagnostic, DiagnosticPlace};
pub use json_schema::json_schema;
pub use quantity::{Dimension, Quantity, QuantityError};
pub use reference::reference_markdown;
