//! `cargo xtask film`: the film of the pages, drawn anew.

use std::fs;

use crate::failure::Failure;
use crate::metadata::Metadata;
use crate::process::{cargo, root, status};

/// The case whose motion is shown.
const CASE: &str = "column_collapse";
/// The film, from the root.
const FILM: &str = "docs/src/figures/column_collapse.gif";
/// Largest film that a page should load \[bytes\].
const LARGEST: u64 = 500_000;

/// Runs the case in the target folder and writes its film into the pages; the exit code of the first command that fails.
pub(crate) fn run() -> Result<u8, Failure> {
    let folder = Metadata::of_workspace()?.target.join("film");
    let access = |error| Failure::input_output(format!("cannot use {}", folder.display()), error);
    fs::create_dir_all(&folder).map_err(access)?;
    let results = folder.join("results");
    let igimp = |words: &[&str]| {
        let mut command = cargo();
        command.args(["run", "--quiet", "--package", "igimp", "--"]);
        command.args(words);
        command
    };
    let case = folder.join(format!("{CASE}.toml"));
    let (case_name, results_name) = (case.display().to_string(), results.display().to_string());
    let source = root().join(format!("crates/igimp-input/cases/{CASE}.toml"));
    fs::copy(source, &case).map_err(access)?;
    let code = status(&mut igimp(&[
        "run",
        &case_name,
        "--quiet",
        "--overwrite",
        "--out",
        &results_name,
    ]))?;
    if code != 0 {
        return Ok(code);
    }
    let code = status(&mut igimp(&[
        "film",
        &results_name,
        "--field",
        "displacement",
        "--width",
        "640",
        "--out",
        FILM,
    ]))?;
    let size = fs::metadata(root().join(FILM)).map_err(access)?.len();
    if size > LARGEST {
        println!("{FILM} has {size} bytes, more than a page should load");
        return Ok(1);
    }
    Ok(code)
}
