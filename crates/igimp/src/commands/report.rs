//! `igimp report`.

use igimp_input::CaseFile;
use igimp_model::AnyCase;
use igimp_report::report::write_report;
use igimp_report::viewer::Surroundings;
use igimp_results::folder::holds_results;

use crate::arguments::Report;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn report(arguments: &Report) -> Result<Exit, ProgramError> {
    let folder = &arguments.folder;
    let file = CaseFile::read(&folder.join("case.completed.toml"), &[]).ok();
    let around = match file.as_ref().map(CaseFile::any_case) {
        Some(AnyCase::Plane(case)) => Surroundings::of(case, folder, None),
        Some(AnyCase::Space(case)) => Surroundings::of(case, folder, None),
        None => Surroundings::default(),
    };
    if !folder.join("summary.json").exists() && holds_results(folder) {
        return Err(ProgramError::usage(
            format!(
                "the run in {} was ended before its first stage was, and has no summary to report",
                folder.display()
            ),
            "igimp run with --resume goes on with it, and writes the report at its end",
        ));
    }
    let path = write_report(folder, &around)?;
    output::print(&path.display().to_string())?;
    Ok(Exit::Done)
}
