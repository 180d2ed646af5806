//! `cargo xtask python`: the Python package as a wheel, installed into a virtual environment and tested there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::Failure;
use crate::metadata::Metadata;
use crate::process::{output, program, root, status, with_manifest};

/// The crate of the package, in a workspace of its own.
pub(crate) const MANIFEST: &str = "python/Cargo.toml";
/// The oldest Python that the package runs on.
const OLDEST: (u32, u32) = (3, 10);
/// Packages that build the wheel, and those of its tests and notebooks.
const TOOLS: [&str; 8] = [
    "maturin>=1.9,<2",
    "pytest>=8",
    "pandas>=2",
    "scipy>=1.10",
    "joblib>=1.3",
    "matplotlib>=3.7",
    "nbclient>=0.10",
    "ipykernel>=6",
];

/// What to do.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Optimise the wheel for those who use it; else it is quick to build.
    #[arg(long)]
    release: bool,
    /// Build the wheel, and stop there.
    #[arg(long)]
    wheel: bool,
    /// Begin with a new virtual environment.
    #[arg(long)]
    fresh: bool,
    /// Arguments for pytest.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    pytest: Vec<String>,
}

/// Checks the crate, builds the wheel, installs it and runs its tests; the exit code of the first that fails.
/// Without Python, and without its package registry, it says so and is done.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let target = Metadata::of_workspace()?.target;
    for command in [vec!["fmt", "--check"], clippy()] {
        let code = status(&mut with_manifest(MANIFEST, &command, &target))?;
        if code != 0 {
            return Ok(code);
        }
    }
    let folder = target.join("python");
    let venv = folder.join("venv");
    let environment = match environment(&venv, arguments.fresh) {
        Ok(environment) => environment,
        Err(reason) => {
            println!("skipped: the Python package is not built: {reason}");
            return Ok(0);
        }
    };
    let wheels = folder.join("wheels");
    if wheels.exists() {
        fs::remove_dir_all(&wheels)
            .map_err(|error| Failure::input_output(wheels.display(), error))?;
    }
    let profile = if arguments.release { "release" } else { "dev" };
    let mut build = program(environment.join("maturin"));
    build
        .args([
            "build",
            "--locked",
            "--profile",
            profile,
            "--manifest-path",
            MANIFEST,
        ])
        .arg("--target-dir")
        .arg(&target)
        .arg("--out")
        .arg(&wheels);
    let code = status(&mut build)?;
    if code != 0 {
        return Ok(code);
    }
    let wheel = only_file(&wheels)?;
    println!("wheel: {}", wheel.display());
    if arguments.wheel {
        return Ok(0);
    }
    let python = environment.join("python");
    let code = status(&mut install(&python, &wheel))?;
    if code != 0 {
        return Ok(code);
    }
    // From another folder, so that the package is the installed one.
    let tests = root().join("python/tests");
    let words = "-m pytest -q -p no:cacheprovider --durations=5";
    status(
        program(&python)
            .current_dir(&folder)
            .args(words.split(' '))
            .arg(tests)
            .args(&arguments.pytest),
    )
}

/// The command that installs a wheel without asking a registry.
fn install(python: &Path, wheel: &Path) -> Command {
    let words = "-m pip install --quiet --disable-pip-version-check --force-reinstall --no-deps";
    let mut install = program(python);
    install.args(words.split(' ')).arg(wheel);
    install
}

fn clippy() -> Vec<&'static str> {
    vec!["clippy", "--locked", "--", "-D", "warnings"]
}

/// The programs of a virtual environment with all tools; why there is none.
fn environment(venv: &Path, fresh: bool) -> Result<PathBuf, String> {
    let printed = output(program("python3").args([
        "-c",
        "import sys; print(sys.version_info[0], sys.version_info[1])",
    ]))
    .map_err(|_| "there is no python3".to_owned())?;
    if !serves(&printed) {
        return Err(format!(
            "python3 is {}, and {}.{} is needed",
            printed.trim().replace(' ', "."),
            OLDEST.0,
            OLDEST.1
        ));
    }
    if fresh && venv.exists() {
        fs::remove_dir_all(venv).map_err(|error| error.to_string())?;
    }
    let programs = venv.join("bin");
    if !programs.join("python").exists() {
        output(program("python3").args(["-m", "venv"]).arg(venv))
            .map_err(|error| error.to_string())?;
    }
    let mut install = program(programs.join("python"));
    install.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
    ]);
    output(install.args(TOOLS))
        .map_err(|error| format!("its tools cannot be installed: {error}"))?;
    Ok(programs)
}

/// Whether a Python of this version serves.
fn serves(printed: &str) -> bool {
    let mut numbers = printed.split_whitespace().map(|word| word.parse().ok());
    matches!((numbers.next(), numbers.next()), (Some(Some(major)), Some(Some(minor))) if (major, minor) >= OLDEST)
}

/// The one file of a folder.
fn only_file(folder: &Path) -> Result<PathBuf, Failure> {
    let entries = fs::read_dir(folder)
        .map_err(|error| Failure::input_output(folder.display(), error))?
        .filter_map(Result::ok)
        .map(|entry| entry.path());
    let mut files: Vec<PathBuf> = entries.collect();
    files.pop().filter(|_| files.is_empty()).ok_or_else(|| {
        Failure::input_output(
            folder.display(),
            "there should be one wheel and nothing else",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_number() {
        assert!(serves("3 10\n") && serves("3 9999") && serves("4 0"));
        assert!(!serves("3 9\n") && !serves("2 7") && !serves("") && !serves("3"));
    }

    /// GOAL: the package has the version of the program.
    #[test]
    fn the_package_has_the_version_of_the_workspace() {
        let version = |path: &str| {
            let text = fs::read_to_string(root().join(path)).unwrap();
            let line = text.lines().find(|line| line.starts_with("version = "));
            line.unwrap().to_owned()
        };
        assert_eq!(version(MANIFEST), version("Cargo.toml"));
    }
}
