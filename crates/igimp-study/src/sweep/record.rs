//! The record of a task beside its results: `task.json`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use igimp_cases::on_one_line;
use igimp_cases::run::Account;
use igimp_input::CaseFile;
use igimp_results::atomic::write_whole;
use igimp_results::ending::Ending;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::{Sweep, SweepError, Task};

/// The content of `task.json`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    /// Number of the task, from 1.
    pub task: usize,
    /// The case file.
    pub case: String,
    /// Values of the parameters by key, as TOML.
    pub settings: BTreeMap<String, String>,
    /// SHA-256 of the case with every default and this task's settings.
    pub fingerprint: String,
    /// How it ended.
    pub ending: Ending,
    /// Why it failed or found no equilibrium, or which references it missed; empty otherwise.
    pub message: String,
}

impl Record {
    pub(super) fn new(sweep: &Sweep, task: &Task, file: &CaseFile) -> Self {
        Self {
            task: task.number,
            case: sweep.case.display().to_string(),
            settings: sweep
                .keys
                .iter()
                .cloned()
                .zip(task.values.iter().cloned())
                .collect(),
            fingerprint: fingerprint(file),
            ..Self::default()
        }
    }

    /// The record in a task's folder, if there is a readable one.
    pub fn read(folder: &Path) -> Option<Self> {
        let text = std::fs::read_to_string(folder.join("task.json")).ok()?;
        serde_json::from_str(&text).ok()
    }

    pub(super) fn write(&self, folder: &Path) -> Result<(), SweepError> {
        let path = folder.join("task.json");
        let file = |source| SweepError::File {
            path: path.clone(),
            source,
        };
        std::fs::create_dir_all(folder).map_err(file)?;
        let text = serde_json::to_string_pretty(self).map_err(|error| file(error.into()))?;
        // Whoever collects while tasks run finds a whole record.
        Ok(write_whole(&path, text + "\n")?)
    }
}

/// SHA-256 of a case with every default and its settings.
pub(super) fn fingerprint(file: &CaseFile) -> String {
    let mut text = String::new();
    for byte in Sha256::digest(file.explain()) {
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// Reason for a failure on one line; empty on success.
pub(super) fn message(run: &Account) -> String {
    let summary = &run.summary;
    if let Some(error) = run.lost.first() {
        return on_one_line(error);
    }
    if let Some(failure) = &summary.failure {
        return failure.lines().next().unwrap_or_default().to_owned();
    }
    let missed = summary.checks.iter().filter(|row| !row.pass);
    let missed: Vec<String> = missed
        .map(|row| {
            let check = &row.check;
            if !row.is_reached() {
                return format!("{} was not reached", check.quantity);
            }
            format!(
                "{} is {}, expected {} {}",
                check.quantity,
                row.measured(),
                check.printed(check.expected),
                check.printed_band()
            )
        })
        .collect();
    missed.join("; ")
}
