//! `igimp check` and `igimp explain`.

use igimp_cases::check::count;
use igimp_cases::estimate::speed::Speed;
use igimp_cases::estimate::{estimate, per_item, readable, time};
use igimp_cases::input::CaseFile;

use crate::arguments::CaseArguments;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn explain(arguments: &CaseArguments) -> Result<Exit, ProgramError> {
    let file = read(&arguments.case, &arguments.set)?;
    output::warn(&file.warnings());
    output::print(&file.explain())?;
    Ok(Exit::Done)
}

pub(crate) fn check(arguments: &CaseArguments) -> Result<Exit, ProgramError> {
    let file = read(&arguments.case, &arguments.set)?;
    let case = file.case();
    for material in &case.materials {
        material.law().map_err(igimp_cases::CaseError::from)?;
    }
    let size = estimate(case)?;
    output::warn(&file.warnings());
    let [nx, ny] = case.grid.cells();
    let [particle, unknown] = per_item(size.unknowns).map(|bytes| count(round(bytes)));
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let rows = [
        row("method", case.method.label()),
        row("particles", count(size.particles)),
        row("cells", format!("{} ({nx} x {ny})", count(size.cells))),
        row("unknowns", format!("about {}", count(size.unknowns))),
        row("memory", format!("about {}", readable(size.bytes))),
        row(
            "",
            format!("about {particle} bytes for a particle, {unknown} for an unknown"),
        ),
        row(
            "time",
            time::sentence(&time::time(case, &size, Speed::measured()?)),
        ),
        row("results", case.output.folder.display().to_string()),
    ];
    let stages: Vec<Vec<String>> = case
        .stages
        .iter()
        .enumerate()
        .map(|(index, stage)| {
            vec![
                format!("{}. {}", index + 1, stage.name),
                output::kind(stage).to_owned(),
                format!("{} steps", stage.steps),
            ]
        })
        .collect();
    output::print(&format!(
        "{} is fine\n  {}\n\n{}\nstages\n{}",
        arguments.case.display(),
        case.title,
        output::table(&rows),
        output::table(&stages)
    ))?;
    Ok(Exit::Done)
}

/// A number of bytes to two digits: more are not known.
fn round(bytes: f64) -> usize {
    let unit = 10.0_f64.powf(bytes.max(1.0).log10().floor() - 1.0).max(1.0);
    ((bytes / unit).round() * unit) as usize
}

/// Reads a case file; a sweep file is named as what it is.
pub(crate) fn read(path: &std::path::Path, set: &[String]) -> Result<CaseFile, ProgramError> {
    let is_sweep = |text: &str| {
        let mut lines = text.lines().map(str::trim_start);
        lines.any(|line| line.starts_with("igimp_sweep"))
    };
    if std::fs::read_to_string(path).is_ok_and(|text| is_sweep(&text)) {
        return Err(ProgramError::usage(
            format!("{} is a sweep, not a case", path.display()),
            format!("igimp sweep {0}, or igimp run {0} --task N", path.display()),
        ));
    }
    Ok(CaseFile::read(path, set)?)
}
