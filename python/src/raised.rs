//! Errors of the engine as exceptions: one class for each exit code of the program, with its text.

use std::error::Error;

use igimp_cases::{CaseError, chain, is_of_the_system};
use igimp_input::InputError;
use igimp_results::ResultsError;
use igimp_results::checkpoint::CheckpointError;
use igimp_results::ending::Ending;
use igimp_schema::Diagnostic;
use pyo3::prelude::*;
use serde_json::json;

/// Exit code of the program for input that makes no sense.
const BAD_INPUT: u8 = 2;
/// Exit code of the program for what did not converge.
const NOT_CONVERGED: u8 = 3;
/// Exit code of the program for files, memory and folders that the system does not give.
const INPUT_OUTPUT: u8 = 4;

/// The exit code of the program for a run that ended so.
pub(crate) fn code(ending: Ending) -> u8 {
    match ending {
        Ending::Done => 0,
        Ending::Missed => 1,
        Ending::Failed => BAD_INPUT,
        Ending::NotConverged | Ending::Interrupted | Ending::Running => NOT_CONVERGED,
    }
}

/// An error as Python raises it; made where Python is at hand.
#[derive(Clone, Debug)]
pub(crate) struct Raised {
    pub(crate) code: u8,
    pub(crate) text: String,
    diagnostics: String,
}

impl Raised {
    /// Input that makes no sense.
    pub(crate) fn bad_input(text: impl Into<String>) -> Self {
        Self::with(BAD_INPUT, text)
    }

    /// A search that did not converge.
    pub(crate) fn not_converged(text: impl Into<String>) -> Self {
        Self::with(NOT_CONVERGED, text)
    }

    /// Something that the engine should never say.
    pub(crate) fn internal(text: impl Into<String>) -> Self {
        Self::with(0, text)
    }

    fn with(code: u8, text: impl Into<String>) -> Self {
        Self {
            code,
            text: text.into(),
            diagnostics: "[]".into(),
        }
    }

    fn of(error: &(dyn Error + 'static), text: String) -> Self {
        Self {
            code: if is_of_the_system(error) {
                INPUT_OUTPUT
            } else {
                BAD_INPUT
            },
            text,
            diagnostics: "[]".into(),
        }
    }

    /// The exception.
    pub(crate) fn exception(&self, py: Python<'_>) -> PyErr {
        let make = || {
            let errors = py.import("igimp._errors")?;
            let made = errors.getattr("raised")?;
            made.call1((self.code, &self.text, &self.diagnostics))
        };
        match make() {
            Ok(exception) => PyErr::from_value(exception),
            Err(error) => error,
        }
    }
}

impl From<InputError> for Raised {
    fn from(error: InputError) -> Self {
        match &error {
            InputError::Invalid { diagnostics, .. } => Self {
                code: BAD_INPUT,
                text: error.to_string(),
                diagnostics: as_json(diagnostics),
            },
            InputError::File { .. } => Self::of(&error, chain(&error)),
        }
    }
}

impl From<ResultsError> for Raised {
    fn from(error: ResultsError) -> Self {
        CaseError::from(error).into()
    }
}

impl From<CaseError> for Raised {
    fn from(error: CaseError) -> Self {
        let error = match error {
            CaseError::Input(input) => return input.into(),
            other => other,
        };
        let help = match &error {
            CaseError::Results(ResultsError::OtherResults { .. }) => {
                "out=... chooses another folder, overwrite=True replaces them"
            }
            CaseError::Results(ResultsError::Unfinished { .. }) => {
                "resume=True goes on with a run of the same input, overwrite=True begins afresh"
            }
            CaseError::Results(ResultsError::Checkpoint(CheckpointError::Damaged { .. })) => {
                "without that folder, resume=True goes on from the one before it; overwrite=True begins afresh"
            }
            _ => "",
        };
        let mut text = chain(&error);
        if !help.is_empty() {
            text = format!("{text}\n  in Python: {help}");
        }
        Self::of(&error, text)
    }
}

/// Problems as JSON, for the exception and for those who look at warnings.
pub(crate) fn as_json(diagnostics: &[Diagnostic]) -> String {
    let each = diagnostics.iter().map(|problem| {
        json!({
            "is_error": problem.is_error,
            "message": problem.message,
            "help": problem.help,
            "setting": problem.place.as_ref().and_then(|place| place.override_number),
            "bytes": problem.place.as_ref().map(|place| [place.bytes.start, place.bytes.end]),
        })
    });
    serde_json::Value::Array(each.collect()).to_string()
}
