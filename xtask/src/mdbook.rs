//! The program that builds the book: the installed one, or one installed into the build folder.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::process::{cargo, output, program, status};

/// The version that the book is written for.
const VERSION: &str = "0.5.4";

/// An mdBook that builds the book. If none is installed whose version agrees with [`VERSION`] up to the
/// last number, that version is built from the package registry into `target/tools`.
///
/// # Errors
///
/// The installation fails.
pub(crate) fn find_or_install(target: &Path) -> Result<PathBuf, Failure> {
    let installed = target
        .join("tools/bin")
        .join(format!("mdbook{}", std::env::consts::EXE_SUFFIX));
    for candidate in [PathBuf::from("mdbook"), installed.clone()] {
        let version = output(program(&candidate).arg("--version"));
        if version.is_ok_and(|printed| serves(&printed)) {
            return Ok(candidate);
        }
    }
    let root = target.join("tools");
    println!(
        "mdBook {VERSION} is not installed: building it into {} (minutes)",
        root.display()
    );
    let mut install = cargo();
    install
        .args(["install", "mdbook", "--version", VERSION, "--locked"])
        .args(["--no-default-features", "--features", "search", "--root"])
        .arg(&root)
        .arg("--target-dir")
        .arg(root.join("build"));
    if status(&mut install)? != 0 {
        return Err(Failure::input_output(
            "cannot install mdBook",
            "the package registry has to be reachable, or `mdbook` installed; \
             the pages in docs/src are readable as they are",
        ));
    }
    let built = root.join("build");
    std::fs::remove_dir_all(&built).map_err(|error| {
        Failure::input_output(format!("cannot remove {}", built.display()), error)
    })?;
    Ok(installed)
}

/// Whether a program that says this of its version serves.
fn serves(printed: &str) -> bool {
    let minor = VERSION.rsplit_once('.').map_or(VERSION, |(minor, _)| minor);
    let printed = printed
        .trim()
        .trim_start_matches("mdbook")
        .trim()
        .trim_start_matches('v');
    printed
        .strip_prefix(minor)
        .is_some_and(|rest| rest.starts_with('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_with_the_same_minor_number_serve() {
        assert!(serves("mdbook v0.5.1\n") && serves(&format!("mdbook v{VERSION}")));
        assert!(!serves("mdbook v0.4.40") && !serves("mdbook v0.50.1") && !serves(""));
    }
}
