//! The study of the mesh error as the rows of a report.

use std::fmt::Write as _;

use igimp_results::ending::Ending;
use igimp_results::mesh_study::{MeshSummary, ResultKind, StudyResult, StudySummary};
use igimp_text::short;
use serde::Serialize;

use super::rows::{Number, grouped, time};
use super::verdict::Verdict;
use crate::report::numbers::UNKNOWN;

/// A study.
#[derive(Serialize)]
pub(super) struct StudyView {
    meshes: Vec<MeshView>,
    rows: Vec<ResultView>,
    /// The mesh whose stages and pictures are shown.
    shown: String,
}

/// A mesh.
#[derive(Serialize)]
struct MeshView {
    label: String,
    class: &'static str,
    ending: String,
    message: String,
    cells: String,
    particles: String,
    unknowns: String,
    steps: String,
    time: String,
    folder: String,
}

/// A result on all meshes.
#[derive(Serialize)]
struct ResultView {
    name: String,
    values: Vec<String>,
    extrapolated: String,
    uncertainty: String,
    order: String,
}

pub(super) fn view(study: &StudySummary) -> StudyView {
    StudyView {
        meshes: study.meshes.iter().map(mesh).collect(),
        rows: study
            .results
            .iter()
            .map(StudyResult::as_printed)
            .map(result)
            .collect(),
        shown: study.shown().map_or_else(String::new, MeshSummary::label),
    }
}

/// Factors of safety and limit loads as extrapolated.
pub(super) fn numbers(study: &StudySummary) -> Vec<Number> {
    let number = |result: &StudyResult| {
        let name = match result.kind {
            ResultKind::FactorOfSafety => "Factor of safety",
            ResultKind::LimitLoad => "Limit load",
            ResultKind::Check => return None,
        };
        let found = result.estimate?;
        Some(Number {
            name: format!("{name}, {}", found.lead()),
            value: found.sentence(),
            note: format!("with its mesh error, order {}", found.order.sentence()),
        })
    };
    study.results.iter().filter_map(number).collect()
}

/// Adds the result of the study to the verdict, and that a mesh went wrong if one did.
pub(super) fn add_to(verdict: &mut Verdict, study: &StudySummary) {
    match study.ending() {
        Ending::NotConverged => (verdict.class, verdict.word) = ("bad", "Not converged"),
        Ending::Failed => (verdict.class, verdict.word) = ("bad", "A mesh failed"),
        _ => {}
    }
    let no_check = |result: &&StudyResult| result.kind != ResultKind::Check;
    for result in study.results.iter().filter(no_check) {
        let name = &result.name;
        if let Some(found) = result.estimate {
            let _ = write!(
                verdict.text,
                " By all meshes, {}: {name}, {} (order {}).",
                found.lead(),
                found.sentence(),
                found.order.sentence()
            );
        } else if let Some(refusal) = result.refusal(&study.meshes) {
            let _ = write!(verdict.text, " {name}: {refusal}.");
        }
    }
    let checks = study.results.iter().filter(|result| !no_check(result));
    for result in checks.filter(|result| result.finest().is_none()) {
        let name = &result.name;
        let _ = write!(
            verdict.text,
            " Check “{name}” is not held: no mesh came to its value."
        );
    }
    for mesh in &study.meshes {
        if let Some(message) = mesh.message.as_ref().and_then(|text| text.lines().next()) {
            let _ = write!(verdict.text, " Mesh {}: {message}", mesh.label());
        }
    }
}

fn mesh(mesh: &MeshSummary) -> MeshView {
    let class = match mesh.ending {
        Ending::Done | Ending::Missed => "good",
        Ending::NotConverged | Ending::Failed => "bad",
        Ending::Running | Ending::Interrupted => "fair",
    };
    MeshView {
        label: mesh.label(),
        class,
        ending: mesh.ending.to_string(),
        message: mesh.message.clone().unwrap_or_default(),
        cells: grouped(mesh.size.cells),
        particles: grouped(mesh.size.particles),
        unknowns: grouped(mesh.size.unknowns),
        steps: grouped(mesh.steps),
        time: time(mesh.seconds),
        folder: mesh.folder.clone(),
    }
}

fn result(result: StudyResult) -> ResultView {
    let value = |value: Option<f64>| value.map_or_else(|| UNKNOWN.to_owned(), short);
    let found = result.estimate;
    let values = std::iter::zip(&result.values, &result.half_widths).enumerate();
    let values = values.map(|(mesh, (&number, &width))| {
        if result.ended_early(mesh) {
            value(number) + " (ended early)"
        } else if width > 0.0 {
            format!("{} ± {}", value(number), short(width))
        } else {
            value(number)
        }
    });
    ResultView {
        values: values.collect(),
        extrapolated: value(found.map(|found| found.value)),
        uncertainty: found.map_or_else(String::new, |found| {
            format!("± {}", short(found.rounded_uncertainty()))
        }),
        order: found.map_or_else(String::new, |found| found.order.sentence()),
        name: result.name,
    }
}
