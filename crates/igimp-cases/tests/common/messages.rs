//! What is said of case files.

use std::fmt::Write as _;

use igimp_input::{CaseFile, InputError};

use crate::edits::{Edits, edited};

pub(crate) fn printed(result: &Result<CaseFile, InputError>) -> String {
    match result {
        Ok(file) if file.warnings().is_empty() => "(nothing)\n".to_owned(),
        Ok(file) => file.warnings(),
        Err(error) => error.to_string(),
    }
}

/// What is said of a file, its name and its text, after each set of edits.
pub(crate) fn messages((name, text): (&str, &str), cases: &[Edits<'_>]) -> String {
    let mut out = String::new();
    for edits in cases {
        for (from, to) in *edits {
            let _ = writeln!(out, "## {from:?} -> {to:?}");
        }
        let result = CaseFile::parse(name, &edited(text, edits), &[]);
        let _ = writeln!(out, "{}", printed(&result));
    }
    out
}
