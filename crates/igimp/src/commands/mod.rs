//! The commands of the program.

pub(crate) mod cases;
pub(crate) mod element;
pub(crate) mod film;
pub(crate) mod fit;
pub(crate) mod pages;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod sweep;
pub(crate) mod template;
pub(crate) mod validate;
pub(crate) mod view;

use std::path::Path;

use igimp_input::CaseFile;
use igimp_model::AnyCase;
use igimp_report::patches::Pieces;

/// The bodies of the case of a results folder in pieces; none in space, and where the case cannot be read.
pub(crate) fn pieces(folder: &Path) -> Option<Pieces> {
    let file = CaseFile::read(&folder.join("case.completed.toml"), &[]).ok()?;
    match file.any_case() {
        AnyCase::Plane(case) => Pieces::of(case).ok(),
        AnyCase::Space(_) => None,
    }
}
