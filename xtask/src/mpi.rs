//! `cargo xtask mpi`: the program for several ranks, built and tested where PETSc and MPI are.

use crate::failure::Failure;
use crate::metadata::Metadata;
use crate::process::{output, program, status, with_manifest};

/// The crate of the program, in a workspace of its own.
pub(crate) const MANIFEST: &str = "mpi/Cargo.toml";

/// Checks the crate, builds it and runs its tests on 1, 2, 3 and 4 ranks; the exit code of the first that fails. Without PETSc or
/// MPI it says so and is done.
pub(crate) fn run() -> Result<u8, Failure> {
    let target = Metadata::of_workspace()?.target;
    let code = status(&mut with_manifest(MANIFEST, &["fmt", "--check"], &target))?;
    if code != 0 {
        return Ok(code);
    }
    if let Some(missing) = missing() {
        println!(
            "skipped: igimp-mpi is not built: there is no {missing}; on Debian: apt-get install petsc-dev libopenmpi-dev openmpi-bin"
        );
        return Ok(0);
    }
    let lints = [
        "clippy",
        "--locked",
        "--all-targets",
        "--",
        "-D",
        "warnings",
    ];
    let tests = ["test", "--locked"];
    for command in [&lints[..], &tests[..]] {
        let code = status(&mut with_manifest(MANIFEST, command, &target))?;
        if code != 0 {
            return Ok(code);
        }
    }
    Ok(0)
}

/// The first need of the program that this computer lacks.
fn missing() -> Option<&'static str> {
    let needed: [(&str, &str, &[&str]); 3] = [
        ("PETSc", "pkg-config", &["--exists", "PETSc"]),
        ("Open MPI", "pkg-config", &["--exists", "ompi-c"]),
        ("mpirun", "mpirun", &["--version"]),
    ];
    let mut lacks = needed.into_iter();
    let lacks = lacks.find(|(_, name, words)| output(program(*name).args(*words)).is_err());
    lacks.map(|(need, ..)| need)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::process::root;

    /// GOAL: the program has the version of igimp.
    #[test]
    fn it_has_the_version_of_the_workspace() {
        let version = |path: &str| {
            let text = fs::read_to_string(root().join(path)).unwrap();
            let line = text.lines().find(|line| line.starts_with("version = "));
            line.unwrap().to_owned()
        };
        assert_eq!(version(MANIFEST), version("Cargo.toml"));
    }
}
