//! What is kept of a task beside its results: `task.json`.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::{self, Write as _};
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::{Sweep, SweepError, Task};
use crate::check::short;
use crate::input::CaseFile;
use crate::mesh_study::StudySummary;
use crate::results::atomic::write_whole;
use crate::run::Account;
use crate::summary::{StageOutcome, Summary};

/// How a task ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ending {
    /// It began and has not ended yet, or was stopped hard.
    #[default]
    Running,
    /// Done, and references met.
    Done,
    /// Done, and a reference missed.
    Missed,
    /// A stage found no equilibrium.
    NotConverged,
    /// The user interrupted it.
    Interrupted,
    /// It could not be set up, or its results could not be written.
    Failed,
}

impl Ending {
    /// How a run with this summary ended.
    pub fn of(summary: &Summary) -> Self {
        let stage = |outcome| summary.stages.iter().any(|stage| stage.outcome == outcome);
        let meshes = summary.mesh_study.as_ref();
        let meshes = meshes.map_or(Self::Done, StudySummary::ending);
        if meshes != Self::Done {
            meshes
        } else if summary.interrupted || stage(StageOutcome::Interrupted) {
            Self::Interrupted
        } else if stage(StageOutcome::NotConverged) {
            Self::NotConverged
        } else if summary.checks.iter().any(|row| !row.pass) {
            Self::Missed
        } else {
            Self::Done
        }
    }

    /// Whether running the task again would tell nothing new.
    pub fn is_verdict(self) -> bool {
        matches!(self, Self::Done | Self::Missed | Self::NotConverged)
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Running => "running",
            Self::Done => "done",
            Self::Missed => "reference missed",
            Self::NotConverged => "not converged",
            Self::Interrupted => "interrupted",
            Self::Failed => "failed",
        })
    }
}

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

/// Why a run is not what was wanted, on one line; empty when it is.
pub(super) fn message(run: &Account) -> String {
    let summary = &run.summary;
    if let Some(error) = run.lost.first() {
        return chain(error);
    }
    if let Some(failure) = &summary.failure {
        return failure.lines().next().unwrap_or_default().to_owned();
    }
    let missed = summary.checks.iter().filter(|row| !row.pass);
    let missed: Vec<String> = missed
        .map(|row| {
            let check = &row.check;
            let (measured, band) = (short(check.measured), check.band);
            format!(
                "{} is {measured}, expected {} {band}",
                check.quantity,
                short(check.expected)
            )
        })
        .collect();
    missed.join("; ")
}

/// An error and its causes on one line.
pub(crate) fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(next) = cause {
        text = format!("{text}: {next}");
        cause = next.source();
    }
    text
}
