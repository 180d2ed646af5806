//! Errors that end the program early, and its exit codes.

use std::error::Error;
use std::io::ErrorKind;
use std::path::PathBuf;

use igimp_cases::{CaseError, is_of_the_system};
use igimp_estimate::EstimateError;
use igimp_input::InputError;
use igimp_report::ReportError;
use igimp_results::ResultsError;
use igimp_results::checkpoint::CheckpointError;
use igimp_results::ending::Ending;
use igimp_study::sweep::SweepError;
use thiserror::Error;

/// Exit codes; part of the contract with callers. Ordered by how bad they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub(crate) enum Exit {
    Done = 0,
    ReferenceMissed = 1,
    BadInput = 2,
    NotConverged = 3,
    InputOutput = 4,
}

impl From<Ending> for Exit {
    fn from(ending: Ending) -> Self {
        match ending {
            Ending::Done => Self::Done,
            Ending::Missed => Self::ReferenceMissed,
            Ending::NotConverged | Ending::Interrupted | Ending::Running => Self::NotConverged,
            Ending::Failed => Self::BadInput,
        }
    }
}

/// Why a command could not do its work.
#[derive(Debug, Error)]
pub(crate) enum ProgramError {
    /// Arguments that make no sense together with the files.
    #[error("{message}")]
    Usage {
        /// The fault.
        message: String,
        /// Its remedy.
        help: String,
    },
    #[error(transparent)]
    Input(#[from] InputError),
    #[error(transparent)]
    Case(#[from] CaseError),
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error("cannot access {}", path.display())]
    File {
        path: PathBuf,
        #[source]
        source: std::io::Error,
    },
    #[error("cannot write to standard output")]
    Output(#[source] std::io::Error),
}

impl From<ResultsError> for ProgramError {
    fn from(error: ResultsError) -> Self {
        Self::Case(error.into())
    }
}

impl From<ReportError> for ProgramError {
    fn from(error: ReportError) -> Self {
        Self::Case(error.into())
    }
}

impl From<EstimateError> for ProgramError {
    fn from(error: EstimateError) -> Self {
        Self::Case(error.into())
    }
}

impl ProgramError {
    pub(crate) fn usage(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Usage {
            message: message.into(),
            help: help.into(),
        }
    }

    /// Whether the reader of standard output went away, as `head` does.
    pub(crate) fn is_closed_pipe(&self) -> bool {
        matches!(self, Self::Output(source) if source.kind() == ErrorKind::BrokenPipe)
    }

    /// The exit code: anything that comes from a file is input or output, the rest is bad input.
    pub(crate) fn exit(&self) -> Exit {
        if self.is_closed_pipe() {
            return Exit::Done;
        }
        // Transparent: its source is that of the case's error.
        match self {
            Self::Case(error) => of_error(error),
            other => of_error(other),
        }
    }

    /// The complete message.
    pub(crate) fn render(&self) -> String {
        match self {
            Self::Input(InputError::Invalid { .. }) | Self::Sweep(SweepError::Invalid { .. }) => {
                self.to_string()
            }
            // Both messages in one: the task's, then the case's with its place.
            Self::Sweep(SweepError::Task {
                source: InputError::Invalid { .. },
                ..
            }) => format!("error: {self}"),
            Self::Usage { message, help } if help.is_empty() => format!("error: {message}"),
            Self::Usage { message, help } => format!("error: {message}\n  help: {help}"),
            Self::Case(CaseError::Results(ResultsError::Checkpoint(
                CheckpointError::Damaged { .. },
            ))) => format!(
                "{}\n  help: without that folder, --resume goes on from the one before it; --overwrite \
                 begins afresh",
                igimp_cases::chain(self)
            ),
            _ => igimp_cases::chain(self),
        }
    }
}

/// The exit code of an error: files and memory that the system refuses, or a folder in use elsewhere,
/// count apart from bad input.
pub(crate) fn of_error(error: &(dyn Error + 'static)) -> Exit {
    if is_of_the_system(error) {
        Exit::InputOutput
    } else {
        Exit::BadInput
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_geometry::SeedError;

    fn denied() -> std::io::Error {
        ErrorKind::PermissionDenied.into()
    }

    #[test]
    fn files_and_input_have_their_codes() {
        let path = PathBuf::from("a.toml");
        let file = InputError::File {
            path: path.clone(),
            source: denied(),
        };
        assert_eq!(ProgramError::from(file).exit(), Exit::InputOutput);
        let invalid = InputError::Invalid {
            text: "error: no".into(),
            errors: 1,
            diagnostics: Vec::new(),
        };
        let invalid = ProgramError::from(invalid);
        assert_eq!(invalid.exit(), Exit::BadInput);
        assert_eq!(invalid.render(), "error: no");
        let case = ResultsError::File {
            path,
            source: denied(),
        };
        let case = ProgramError::from(SweepError::from(case));
        assert_eq!(case.exit(), Exit::InputOutput);
        assert_eq!(
            case.render(),
            "error: the task cannot be run\n  because: cannot access a.toml\n  \
             because: permission denied"
        );
        assert_eq!(
            ProgramError::from(CaseError::Seed(SeedError::EmptyBody)).exit(),
            Exit::BadInput
        );
    }

    #[test]
    fn a_closed_pipe_is_no_failure() {
        let error = ProgramError::Output(ErrorKind::BrokenPipe.into());
        assert_eq!(error.exit(), Exit::Done);
        assert_eq!(ProgramError::Output(denied()).exit(), Exit::InputOutput);
    }
}
