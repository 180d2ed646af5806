//! `igimp film`: the frames of a results folder as an animated GIF.

use std::path::Path;

use igimp_input::CaseFile;
use igimp_model::{AnyCase, Case, Field};
use igimp_report::film::{Film, FilmRequest, film_of};
use igimp_results::atomic::write_new;
use igimp_text::short;

use crate::arguments::FilmArguments;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn film(arguments: &FilmArguments) -> Result<Exit, ProgramError> {
    let file = CaseFile::read(&arguments.folder.join("case.completed.toml"), &[])?;
    let AnyCase::Plane(case) = file.any_case() else {
        return Err(ProgramError::usage(
            "films are of cases in plane strain",
            "`igimp view` plays the frames of a case in space",
        ));
    };
    let request = FilmRequest {
        field: field(arguments, case)?,
        stage: stage(arguments, case)?,
        pace: arguments.pace,
        width: arguments.width,
    };
    let made = film_of(&arguments.folder, case, &request)?;
    let path = arguments.out.clone().unwrap_or_else(|| {
        let name = format!("film-{}.gif", request.field.name());
        arguments.folder.join("figures").join(name)
    });
    write_new(&path, &made.gif).map_err(|source| ProgramError::File {
        path: path.clone(),
        source,
    })?;
    output::print(&summary(&path, &made))?;
    Ok(Exit::Done)
}

/// The field that is asked for, or the speed of a motion, or the displacement.
fn field(arguments: &FilmArguments, case: &Case<2>) -> Result<Field, ProgramError> {
    let Some(name) = &arguments.field else {
        return Ok(if case.has_motion() {
            Field::Speed
        } else {
            Field::Displacement
        });
    };
    let known = Field::of_name(name).filter(|field| field.exists_in(2));
    known.ok_or_else(|| {
        let all = Field::ALL.iter().filter(|field| field.exists_in(2));
        let names: Vec<&str> = all.map(|field| field.name()).collect();
        ProgramError::usage(
            format!("there is no field {name}"),
            format!("fields are {}", names.join(", ")),
        )
    })
}

/// The number of the stage that is asked for.
fn stage(arguments: &FilmArguments, case: &Case<2>) -> Result<Option<usize>, ProgramError> {
    let Some(name) = &arguments.stage else {
        return Ok(None);
    };
    let found = case.stages.iter().position(|stage| stage.name == *name);
    let names = || {
        case.stages
            .iter()
            .map(|stage| format!("\"{}\"", stage.name))
    };
    found.map(Some).ok_or_else(|| {
        ProgramError::usage(
            format!("the case has no stage \"{name}\""),
            format!("its stages are {}", names().collect::<Vec<_>>().join(", ")),
        )
    })
}

/// File, frames, time and size of a film.
fn summary(path: &Path, film: &Film) -> String {
    let pace = film
        .pace
        .map_or_else(String::new, |pace| format!(", pace {}", short(pace)));
    format!(
        "{}: {} frames, {} s{pace}, {} kB",
        path.display(),
        film.frames,
        short((10.0 * film.seconds).round() / 10.0),
        film.gif.len().div_ceil(1000)
    )
}
