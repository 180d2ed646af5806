//! `igimp check` and `igimp explain`.

use igimp_input::CaseFile;
use igimp_model::in_any_dimension;
use igimp_study::narration::size::size;
use igimp_study::sweep::is_sweep;

use crate::arguments::CaseArguments;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn explain(arguments: &CaseArguments) -> Result<Exit, ProgramError> {
    let file = read(&arguments.case, &arguments.settings())?;
    output::warn(&file.warnings());
    output::print(&file.explain())?;
    Ok(Exit::Done)
}

pub(crate) fn check(arguments: &CaseArguments) -> Result<Exit, ProgramError> {
    let file = read(&arguments.case, &arguments.settings())?;
    output::warn(&file.warnings());
    let size = in_any_dimension!(file.any_case(), case => size(case, &arguments.case))?;
    output::print(&size.text)?;
    Ok(Exit::Done)
}

/// The name of a case that comes from standard input.
const STANDARD_INPUT: &str = "-";

/// Reads a case file; a sweep file is named as one.
pub(crate) fn read(path: &std::path::Path, set: &[String]) -> Result<CaseFile, ProgramError> {
    if path == std::path::Path::new(STANDARD_INPUT) {
        return Ok(CaseFile::read_from("stdin", std::io::stdin(), set)?);
    }
    let file = CaseFile::read(path, set);
    if file.is_err() && is_sweep(path) {
        return Err(ProgramError::usage(
            format!("{} is a sweep, not a case", path.display()),
            format!("igimp sweep {0}, or igimp run {0} --task N", path.display()),
        ));
    }
    Ok(file?)
}
