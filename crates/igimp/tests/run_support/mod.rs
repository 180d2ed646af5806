//! Whole runs of a coarse slope through the program, and all that they leave behind.

#![allow(dead_code, reason = "each test target uses its part")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use igimp_input::shipped::SHIPPED;
use serde_json::Value;

/// Coarse, with a checkpoint after every other step, and with the frames of a film, as every run has.
const SETTINGS: [&str; 5] = [
    "grid.cell=2 m",
    "stages.run-out.steps=60",
    "output.checkpoint.every=2",
    "output.figures=[]",
    "output.report=false",
];

/// Keys that depend on the computer and the hour.
const TIMES: [&str; 7] = [
    "date",
    "seconds",
    "output_seconds",
    "cpu_seconds",
    "peak_memory_mib",
    "memory",
    "estimate",
];

/// A folder with the case in it, gone when dropped.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("igimp-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        let slope = SHIPPED.iter().find(|case| case.name == "slope").unwrap();
        std::fs::write(path.join("slope.toml"), slope.text).unwrap();
        Self(path)
    }

    /// The words of a run into a folder.
    pub(crate) fn words(out: &str, more: &[&str]) -> Vec<String> {
        let mut words = ["run", "slope.toml", "--out", out, "--quiet"]
            .map(str::to_owned)
            .to_vec();
        for setting in SETTINGS {
            words.extend(["--set".to_owned(), setting.to_owned()]);
        }
        words.extend(more.iter().map(|&word| word.to_owned()));
        words
    }

    pub(crate) fn run(&self, out: &str, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(Self::words(out, more)).current_dir(&self.0);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command
    }

    /// Runs to the end and returns the exit code with the output.
    pub(crate) fn end(&self, out: &str, more: &[&str]) -> (Option<i32>, String) {
        let output = self.run(out, more).output().unwrap();
        let printed = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), printed)
    }

    /// Every table of a results folder, by its path there.
    pub(crate) fn tables(&self, out: &str) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut files = self.everything(out);
        files.retain(|path, _| path.extension().is_some_and(|extension| extension == "csv"));
        files
    }

    /// Every file of a results folder by its path there: tables, pictures, frames, the arrays of the
    /// ends of stages, and the summary without its times. Files saved within a stage are not there:
    /// they depend on where a run was taken up. Nor is the file that says whose the folder is.
    pub(crate) fn everything(&self, out: &str) -> BTreeMap<PathBuf, Vec<u8>> {
        let root = self.0.join(out);
        let mut files = BTreeMap::new();
        collect(&root, &root, &mut files);
        files.retain(|path, _| {
            let text = path.to_string_lossy();
            !text.contains("checkpoint/step-")
                && !text.ends_with("meta.json")
                && !text.starts_with(".igimp")
        });
        for (path, bytes) in &mut files {
            if path.ends_with("summary.json") {
                let mut summary: Value = serde_json::from_slice(bytes).unwrap();
                without_times(&mut summary);
                *bytes = summary.to_string().into_bytes();
            }
        }
        files
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(root, &path, files);
        } else {
            let name = path.strip_prefix(root).unwrap().to_path_buf();
            files.insert(name, std::fs::read(&path).unwrap());
        }
    }
}

fn without_times(summary: &mut Value) {
    let whole = summary.as_object_mut().unwrap();
    whole.retain(|key, _| !TIMES.contains(&key.as_str()));
    for mesh in whole["mesh_study"]["meshes"]
        .as_array_mut()
        .into_iter()
        .flatten()
    {
        mesh.as_object_mut().unwrap().remove("seconds");
    }
    for stage in whole["stages"].as_array_mut().unwrap() {
        let stage = stage.as_object_mut().unwrap();
        stage.retain(|key, _| key != "seconds" && key != "phases");
    }
}

/// The names of files that differ, or that one of the two does not have.
pub(crate) fn differing(
    a: &BTreeMap<PathBuf, Vec<u8>>,
    b: &BTreeMap<PathBuf, Vec<u8>>,
) -> Vec<PathBuf> {
    let names = a
        .keys()
        .chain(b.keys().filter(|&name| !a.contains_key(name)));
    names
        .filter(|&name| a.get(name) != b.get(name))
        .cloned()
        .collect()
}
