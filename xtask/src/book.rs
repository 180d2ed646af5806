//! `cargo xtask book` and `cargo xtask doc`: the pages for readers, with mathematics that is set when they
//! are built.

use std::fs;
use std::path::Path;

use crate::failure::Failure;
use crate::metadata::Metadata;
use crate::process::{cargo, program, root, status};
use crate::{mdbook, pages};

/// Where mdBook writes, from the root.
const BOOK: &str = "docs/book";

/// Builds the book, and opens it on request.
pub(crate) fn book(open: bool) -> Result<u8, Failure> {
    let mdbook = mdbook::find_or_install(&Metadata::of_workspace()?.target)?;
    let folder = root().join(BOOK);
    clear(&folder)?;
    let code = status(program(&mdbook).args(["build", "docs"]))?;
    if code != 0 {
        return Ok(code);
    }
    let (pages, formulas) = pages::typeset(&folder)?;
    pages::check_links(&folder, &pages)?;
    println!(
        "book: {} pages, {formulas} formulas, all links lead somewhere",
        pages.len()
    );
    show(&folder.join("index.html"), open)
}

/// Builds the pages of the crates, and opens them on request.
pub(crate) fn crates(open: bool) -> Result<u8, Failure> {
    let folder = Metadata::of_workspace()?.target.join("doc");
    clear(&folder)?;
    let code = status(cargo().args(["doc", "--workspace", "--no-deps"]))?;
    if code != 0 {
        return Ok(code);
    }
    let (pages, formulas) = pages::typeset(&folder)?;
    println!("doc: {} pages, {formulas} formulas", pages.len());
    show(&folder.join("igimp_cases/index.html"), open)
}

/// Removes pages of an earlier build: they are finished already, and may be of pages that are no more.
fn clear(folder: &Path) -> Result<(), Failure> {
    if !folder.exists() {
        return Ok(());
    }
    fs::remove_dir_all(folder)
        .map_err(|error| Failure::input_output(format!("cannot clear {}", folder.display()), error))
}

/// Says where the pages begin, and shows them on request.
fn show(first: &Path, open: bool) -> Result<u8, Failure> {
    println!("{}", first.display());
    if open {
        let opener = if cfg!(target_os = "macos") {
            "open"
        } else if cfg!(windows) {
            "explorer"
        } else {
            "xdg-open"
        };
        return status(program(opener).arg(first));
    }
    Ok(0)
}
