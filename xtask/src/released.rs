//! Programs and benches in release mode.

use std::env;
use std::process::Command;

use crate::failure::Failure;
use crate::metadata::Metadata;
use crate::process::{cargo, program, status};

/// The packages with programs and benches in release mode. Cargo chooses features of a crate for all packages that it is asked
/// for at once: they are asked for together, and a crate that several need is compiled once.
const RELEASED: [&str; 3] = ["igimp", "igimp-validation", "igimp-benchmarks"];

/// A command of cargo for all packages with programs and benches in release mode.
pub(crate) fn cargo_for_released(command: &str) -> Command {
    let mut cargo = cargo();
    cargo.arg(command);
    for package in RELEASED {
        cargo.args(["--package", package]);
    }
    cargo
}

/// Builds a program in release mode by a profile of its kind; the program, or the exit code of a build that failed.
pub(crate) fn released(profile: &str, name: &str) -> Result<Result<Command, u8>, Failure> {
    let mut build = cargo_for_released("build");
    let code = status(build.args(["--profile", profile, "--bin", name]))?;
    if code != 0 {
        return Ok(Err(code));
    }
    // Both profiles put their programs there.
    let path = Metadata::of_workspace()?.target.join("release").join(name);
    Ok(Ok(program(path.with_extension(env::consts::EXE_EXTENSION))))
}
