//! `igimp`: writes, checks, runs and compares case files.

use std::process::ExitCode;

fn main() -> ExitCode {
    igimp::program(std::env::args_os(), None)
}
