//! `report.html`: one page without outside parts on the results of a run.

mod files;
mod meshes;
mod numbers;
pub mod page;
mod rows;
mod template;
mod verdict;

use std::path::{Path, PathBuf};

use igimp_results::ResultsError;
use igimp_results::summary::{SetupTable, Summary};
use serde::Serialize;

use super::viewer::{Held, Surroundings, held};
use crate::error::ReportError;

/// The page; values are escaped as they are filled in.
const TEMPLATE: &str = include_str!("report.html");

/// Makes `report.html` of the files of a results folder, and returns its path.
///
/// `summary.json` must be there; pictures, tables, `convergence.csv` and the two texts of the case
/// take part as far as they exist. Pictures are embedded, tables are linked by relative paths. Frames show the bodies
/// and the water of the case as far as `around` has them, else the domains of the particles alone.
///
/// # Errors
/// [`ResultsError::File`] if the summary cannot be read or the report cannot be written.
pub fn write_report(folder: &Path, around: &Surroundings) -> Result<PathBuf, ReportError> {
    let path = folder.join("summary.json");
    let summary = std::fs::read(&path)
        .and_then(|bytes| Ok(serde_json::from_slice::<Summary>(&bytes)?))
        .map_err(|source| ResultsError::File { path, source })?;
    let path = folder.join("report.html");
    let page = render(folder, &summary, around).map_err(|source| ResultsError::File {
        path: path.clone(),
        source: std::io::Error::other(source),
    })?;
    igimp_results::atomic::write_new(&path, page).map_err(|source| ResultsError::File {
        path: path.clone(),
        source,
    })?;
    Ok(path)
}

fn render(
    folder: &Path,
    summary: &Summary,
    around: &Surroundings,
) -> Result<String, minijinja::Error> {
    let pictures = files::pictures(folder, summary);
    let tables = files::tables(folder);
    let inputs = files::inputs(folder);
    let safety = rows::safety(summary);
    let study = summary.mesh_study.as_ref().map(meshes::view);
    let mut verdict = verdict::verdict(summary);
    let mut numbers = rows::headline(summary);
    if let Some(study) = &summary.mesh_study {
        meshes::add_to(&mut verdict, study);
        numbers.splice(0..0, meshes::numbers(study));
    }
    let (convergence, pictures): (Vec<_>, Vec<_>) = pictures
        .into_iter()
        .partition(|group| group.id == "convergence");
    let held = held(folder, around);
    let reinforcement = rows::reinforcement(summary);
    let entries = contents(
        [
            (true, "numbers", "Results"),
            (study.is_some(), "meshes", "Mesh error"),
            (!summary.checks.is_empty(), "checks", "Checks"),
            (summary.failure.is_some(), "failure", "Want of equilibrium"),
            (!summary.warnings.is_empty(), "warnings", "Warnings"),
            (!summary.setup.is_empty(), "setup", "The model"),
            (true, "stages", "Stages"),
            (!reinforcement.is_empty(), "reinforcement", "Reinforcement"),
            (!safety.is_empty(), "safety", "Factor of safety"),
        ],
        &pictures,
        [
            (held.is_some(), "frame", "A closer look"),
            (!tables.is_empty(), "tables", "Tables and files"),
            (!inputs.is_empty(), "input", "Input"),
            (true, "effort", "How it was computed"),
        ],
    );
    let title = if summary.title.is_empty() {
        "Results"
    } else {
        &summary.title
    };
    let page = Page {
        title,
        program: &summary.program,
        method: &summary.method,
        verdict,
        contents: entries,
        head: rows::head(summary),
        numbers,
        setup: &summary.setup,
        study,
        checks: rows::checks(summary),
        failure: summary.failure.as_deref(),
        warnings: &summary.warnings,
        stages: rows::stages(summary),
        phase_names: rows::PHASES,
        reinforcement,
        safety,
        pictures,
        tables,
        inputs,
        effort: rows::effort(summary),
        convergence,
        held,
    };
    template::filled("report.html", TEMPLATE, page)
}

/// The values that the template fills in.
#[derive(Serialize)]
struct Page<'a> {
    title: &'a str,
    program: &'a str,
    method: &'a str,
    verdict: verdict::Verdict,
    contents: Vec<Entry>,
    head: Vec<rows::HeadView>,
    numbers: Vec<rows::Number>,
    setup: &'a [SetupTable],
    study: Option<meshes::StudyView>,
    checks: Vec<rows::CheckView>,
    failure: Option<&'a str>,
    warnings: &'a [String],
    stages: Vec<rows::StageView>,
    phase_names: [&'static str; 5],
    reinforcement: Vec<rows::MemberView>,
    safety: Vec<rows::SafetyView>,
    pictures: Vec<files::Group>,
    tables: Vec<files::FileView>,
    inputs: Vec<files::InputView>,
    effort: Vec<rows::Number>,
    convergence: Vec<files::Group>,
    held: Option<Held>,
}

/// A line of the table of contents.
#[derive(Serialize)]
struct Entry {
    id: &'static str,
    title: &'static str,
}

fn contents<const N: usize, const M: usize>(
    before: [(bool, &'static str, &'static str); N],
    pictures: &[files::Group],
    after: [(bool, &'static str, &'static str); M],
) -> Vec<Entry> {
    let groups = pictures.iter().map(|group| (true, group.id, group.title));
    before
        .into_iter()
        .chain(groups)
        .chain(after)
        .filter(|(shown, ..)| *shown)
        .map(|(_, id, title)| Entry { id, title })
        .collect()
}
