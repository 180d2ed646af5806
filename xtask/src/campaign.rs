//! `cargo xtask campaign`: random slopes and footings under watch, in release mode.

use crate::failure::Failure;
use crate::process::{cargo, status};

/// Runs the campaign program and returns its exit code.
pub(crate) fn run(arguments: &[String]) -> Result<u8, Failure> {
    status(
        cargo()
            .args(["run", "--release", "--package", "igimp-validation"])
            .args(["--bin", "campaign", "--"])
            .args(arguments),
    )
}
