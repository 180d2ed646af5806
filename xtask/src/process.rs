//! Running other programs in the workspace's root.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::Failure;

/// The root of the workspace: the folder above this crate's.
pub(crate) fn root() -> PathBuf {
    let folder = env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    folder.parent().map_or(folder.clone(), Path::to_path_buf)
}

/// A program to be run in the root.
pub(crate) fn program(name: impl Into<OsString>) -> Command {
    let mut command = Command::new(name.into());
    command.current_dir(root());
    command
}

/// The cargo that runs this program.
pub(crate) fn cargo() -> Command {
    program(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// A command of cargo for a crate with a workspace of its own; what it builds goes with all other builds.
pub(crate) fn with_manifest(manifest: &str, words: &[&str], target: &Path) -> Command {
    let (command, rest) = words.split_first().unwrap_or((&"check", &[]));
    let mut cargo = cargo();
    cargo.args([command, "--manifest-path", manifest]);
    cargo.args(rest).env("CARGO_TARGET_DIR", target);
    cargo
}

/// Runs a program with the terminal as its own, and returns its exit code.
pub(crate) fn status(command: &mut Command) -> Result<u8, Failure> {
    let status = command
        .status()
        .map_err(|error| Failure::input_output(format!("cannot run {}", name(command)), error))?;
    match status.code() {
        Some(code) => Ok(u8::try_from(code).unwrap_or(u8::MAX)),
        None => Err(Failure::input_output(name(command), status)),
    }
}

/// Runs a program and returns its output; a failure unless it ends well.
pub(crate) fn output(command: &mut Command) -> Result<String, Failure> {
    let output = command
        .output()
        .map_err(|error| Failure::input_output(format!("cannot run {}", name(command)), error))?;
    if !output.status.success() {
        let printed = String::from_utf8_lossy(&output.stderr);
        return Err(Failure::input_output(name(command), printed.trim()));
    }
    String::from_utf8(output.stdout).map_err(|error| Failure::input_output(name(command), error))
}

/// The program's name without its folder.
fn name(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(command.get_program());
    name.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failure::INPUT_OUTPUT;
    use std::process::Stdio;

    #[test]
    fn the_root_holds_the_workspace() {
        assert!(root().join("Cargo.lock").is_file());
    }

    #[test]
    fn exit_codes_are_passed_through() {
        let code = |argument: &str| {
            status(
                cargo()
                    .arg(argument)
                    .stdout(Stdio::null())
                    .stderr(Stdio::null()),
            )
        };
        assert_eq!(code("--version"), Ok(0));
        assert_ne!(code("no-such-command"), Ok(0));
    }

    #[test]
    fn a_missing_program_is_named() {
        let failure = output(&mut program("no-such-program")).unwrap_err();
        assert_eq!(failure.code, INPUT_OUTPUT);
        assert!(failure.to_string().contains("no-such-program"), "{failure}");
    }
}
