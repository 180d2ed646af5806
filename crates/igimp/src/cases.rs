//! `igimp check` and `igimp explain`.

use std::path::Path;

use igimp_cases::case::Case;
use igimp_cases::check::count;
use igimp_cases::estimate::speed::Speed;
use igimp_cases::estimate::watch::side_by_side;
use igimp_cases::estimate::{estimate, linear_solver, per_item, readable, storage, time, together};
use igimp_cases::in_any_dimension;
use igimp_cases::input::CaseFile;
use igimp_cases::mesh_study::plan;
use igimp_cases::printable::on_a_line;
use igimp_cases::sweep::is_sweep;

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
    in_any_dimension!(file.any_case(), case => checked(case, &file, &arguments.case))
}

/// What a case will cost.
fn checked<const D: usize>(
    case: &Case<D>,
    file: &CaseFile,
    path: &Path,
) -> Result<Exit, ProgramError> {
    for material in &case.materials {
        material.law().map_err(igimp_cases::CaseError::from)?;
    }
    let size = estimate(case)?;
    let speed = Speed::measured()?;
    output::warn(&file.warnings());
    let cells = case.grid.cells().map(|count| count.to_string()).join(" x ");
    let storage = storage(case, size.unknowns);
    let [particle, unknown] = per_item(D, storage, size.unknowns).map(|bytes| count(round(bytes)));
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let rows = [
        row("method", case.method.label()),
        row("particles", count(size.particles)),
        row("cells", format!("{} ({cells})", count(size.cells))),
        row("unknowns", format!("about {}", count(size.unknowns))),
        row("solver", linear_solver(case, size.unknowns)),
        row("memory", format!("about {}", readable(size.bytes))),
        row(
            "",
            format!("about {particle} bytes for a particle, {unknown} for an unknown"),
        ),
        row("time", time::sentence(&time::time(case, &size, speed))),
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
        "{} is fine\n  {}\n\n{}\nstages\n{}{}",
        path.display(),
        on_a_line(&case.title),
        output::table(&rows),
        output::table(&stages),
        study(case, speed)?
    ))?;
    Ok(Exit::Done)
}

/// The meshes of a study of the mesh error, each with its size, and the cost of all; empty without one.
fn study<const D: usize>(case: &Case<D>, speed: Speed) -> Result<String, ProgramError> {
    if case.mesh_study.meshes < 2 {
        return Ok(String::new());
    }
    let mut rows = Vec::new();
    let (mut bytes, mut all) = (Vec::new(), None::<time::Time>);
    for (mesh, parts) in std::iter::zip(plan::meshes(case), plan::refinements(case)) {
        let size = estimate(&mesh)?;
        let own = time::time(&mesh, &size, speed);
        rows.push(vec![
            plan::label(parts),
            format!("{} particles", count(size.particles)),
            format!("{} cells", count(size.cells)),
            format!("about {} unknowns", count(size.unknowns)),
            format!("about {}", readable(size.bytes)),
            format!("about {}", time::readable(own.seconds)),
        ]);
        bytes.push(size.bytes);
        all = Some(all.map_or(own, |all| time::Time {
            seconds: all.seconds + own.seconds,
            ..own
        }));
    }
    let how = if side_by_side(&bytes) > 1 {
        "side by side"
    } else {
        "one after another"
    };
    Ok(format!(
        "\nmeshes\n{}  {how}: about {} of memory, {}\n",
        output::table(&rows),
        readable(together(&bytes)),
        all.map_or_else(String::new, |all| time::sentence(&all))
    ))
}

/// A number of bytes to two digits: more are not known.
fn round(bytes: f64) -> usize {
    let unit = 10.0_f64.powf(bytes.max(1.0).log10().floor() - 1.0).max(1.0);
    ((bytes / unit).round() * unit) as usize
}

/// The name of a case that comes from standard input.
const STANDARD_INPUT: &str = "-";

/// Reads a case file; a sweep file is named as what it is.
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
