//! igimp-assembly.

mod matrix;

pub use matrix::{NodeBlock, Pattern, TangentMatrix};
