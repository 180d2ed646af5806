//! `cargo xtask tidy`: invariants of the workspace that the compiler does not check.

mod deny;
mod equations;
mod imports;
mod layers;
mod licences;
mod links;
mod prose;
mod sources;
mod structure;

use crate::failure::{FOUND, Failure};
use crate::metadata::Metadata;
use crate::process::root;
use crate::{mpi, python};

/// Runs all checks; prints the problems, one line each.
pub(crate) fn run() -> Result<u8, Failure> {
    let root = root();
    let metadata = Metadata::of_workspace()?;
    let python = Metadata::of_manifest(python::MANIFEST)?;
    let mpi = Metadata::of_manifest(mpi::MANIFEST)?;
    let allowed = deny::allowed_licences(&root.join("deny.toml"))?;
    let checks = [
        ("layers", layers::check(&metadata)),
        ("sources", sources::check(&metadata, &root)?),
        ("structure", structure::check(&metadata, &root)?),
        ("licences", licences::check(&metadata, &allowed)),
        (
            "licences of the Python package",
            licences::check(&python, &allowed),
        ),
        ("licences of igimp-mpi", licences::check(&mpi, &allowed)),
        ("unsafe", sources::unsafe_blocks(&root)?),
        ("links", links::check(&root)?),
        ("prose", prose::check(&root)?),
        ("equations", equations::check(&metadata, &root)?),
    ];
    let mut count = 0;
    for (name, problems) in &checks {
        let verdict = if problems.is_empty() {
            "ok"
        } else {
            "problems"
        };
        println!("tidy: {name}: {verdict}");
        for problem in problems {
            println!("  {problem}");
        }
        count += problems.len();
    }
    if count == 0 {
        Ok(0)
    } else {
        Err(Failure::new(FOUND, format!("tidy found problems: {count}")))
    }
}
