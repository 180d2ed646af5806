//! `igimp report`.

use igimp_report::report::write_report;

use crate::arguments::Report;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn report(arguments: &Report) -> Result<Exit, ProgramError> {
    let path = write_report(&arguments.folder)?;
    output::print(&path.display().to_string())?;
    Ok(Exit::Done)
}
