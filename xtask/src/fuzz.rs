//! `cargo xtask fuzz`: the fuzzing program in release mode.

use crate::failure::Failure;
use crate::process::{cargo, status};

/// Runs the fuzzing program and returns its exit code.
pub(crate) fn run(arguments: &[String]) -> Result<u8, Failure> {
    status(
        cargo()
            .args(["run", "--release", "--package", "igimp-fuzz", "--"])
            .args(arguments),
    )
}
