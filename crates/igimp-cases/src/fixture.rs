//! A case for the tests of this crate.

use igimp_input::CaseFile;
use igimp_model::Case;

/// A block of 4 × 4 cells of clay under its own weight.
pub(crate) fn case() -> Case<2> {
    let text = include_str!("../../igimp-estimate/tests/data/block.toml");
    CaseFile::parse("block.toml", text, &[])
        .unwrap()
        .case()
        .clone()
}
