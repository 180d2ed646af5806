//! `cargo xtask validate`: the validation program in release mode, and the changes of `--accept`.

use crate::failure::Failure;
use crate::process::{program, status};
use crate::released::released;

/// Where the snapshots are.
const SNAPSHOTS: &str = "validation/snapshots";

/// Runs the validation program and returns its exit code.
pub(crate) fn run(arguments: &[String]) -> Result<u8, Failure> {
    let mut validation = match released("release", "igimp-validation")? {
        Ok(program) => program,
        Err(code) => return Ok(code),
    };
    let code = status(validation.args(arguments))?;
    if arguments
        .iter()
        .any(|argument| argument.starts_with("--accept"))
    {
        show_changes();
    }
    Ok(code)
}

/// Shows what changed in the snapshots, if git is there to tell: new files, changes in short, then
/// in full.
fn show_changes() {
    let git = |arguments: &[&str]| {
        let mut git = program("git");
        git.arg("--no-pager")
            .args(arguments)
            .args(["--", SNAPSHOTS]);
        status(&mut git)
    };
    println!("\nsnapshots changed since the last commit:");
    for arguments in [&["status", "--short"][..], &["diff", "--stat"], &["diff"]] {
        if !matches!(git(arguments), Ok(0)) {
            println!("(not known: this is no git repository, or git is not installed)");
            return;
        }
    }
}
