//! The study of the mesh error as the rows of a report.

use serde::Serialize;

use super::rows::{UNKNOWN, grouped, time};
use crate::check::short;
use crate::mesh_study::{MeshSummary, StudyResult, StudySummary};
use crate::sweep::Ending;

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
        rows: study.results.iter().map(result).collect(),
        shown: study.shown().map_or_else(String::new, MeshSummary::label),
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

fn result(result: &StudyResult) -> ResultView {
    let value = |value: Option<f64>| value.map_or_else(|| UNKNOWN.to_owned(), short);
    let found = result.estimate;
    let values = std::iter::zip(&result.values, &result.half_widths).map(|(&own, &width)| {
        let width = if width > 0.0 {
            format!(" ± {}", short(width))
        } else {
            String::new()
        };
        value(own) + &width
    });
    ResultView {
        name: result.name.clone(),
        values: values.collect(),
        extrapolated: value(found.map(|found| found.value)),
        uncertainty: found.map_or_else(String::new, |found| {
            format!("± {}", short(found.uncertainty))
        }),
        order: found.map_or_else(String::new, |found| found.order.sentence()),
    }
}
