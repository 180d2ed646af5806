//! How a run ended.

use std::fmt;

use serde::{Deserialize, Serialize};

/// How a run ended.
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
