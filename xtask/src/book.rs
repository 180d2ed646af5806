//! `cargo xtask book`: the book in `docs/`.

use crate::failure::{Failure, INPUT_OUTPUT};
use crate::process::{output, program, status};

/// Builds the book, and opens it on request.
pub(crate) fn run(open: bool) -> Result<u8, Failure> {
    if output(program("mdbook").arg("--version")).is_err() {
        return Err(Failure::new(
            INPUT_OUTPUT,
            "mdbook is not installed: the book is not built.\n\
             Install it with `cargo install mdbook`, or read the Markdown files in docs/src.",
        ));
    }
    let mut build = program("mdbook");
    build.args(["build", "docs"]);
    if open {
        build.arg("--open");
    }
    status(&mut build)
}
