//! Asks `pkg-config` where PETSc and Open MPI are.

use std::process::Command;

const HELP: &str = "on Debian: apt-get install petsc-dev libopenmpi-dev openmpi-bin";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    for library in ["PETSc", "ompi-c"] {
        let asked = Command::new("pkg-config")
            .args(["--libs-only-L", "--libs-only-l", library])
            .output();
        match asked {
            Ok(output) if output.status.success() => link(&String::from_utf8_lossy(&output.stdout)),
            _ => println!("cargo::error=pkg-config does not find {library}; {HELP}"),
        }
    }
}

/// Hands the words of `pkg-config` on.
fn link(words: &str) {
    for word in words.split_whitespace() {
        if let Some(folder) = word.strip_prefix("-L") {
            println!("cargo::rustc-link-search=native={folder}");
        } else if let Some(name) = word.strip_prefix("-l") {
            println!("cargo::rustc-link-lib={name}");
        }
    }
}
