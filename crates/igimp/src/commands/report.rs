//! `igimp report`.

use igimp_report::report::write_report;

use crate::arguments::Report;
use crate::commands::pieces;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn report(arguments: &Report) -> Result<Exit, ProgramError> {
    let pieces = pieces(&arguments.folder);
    let path = write_report(&arguments.folder, pieces.as_ref())?;
    output::print(&path.display().to_string())?;
    Ok(Exit::Done)
}
