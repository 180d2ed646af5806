//! The pictures of a run, written as `figures/NAME.svg` and `.png` into its results folder.
//!
//! | picture | file |
//! |---|---|
//! | [`model_picture`] | `model` |
//! | [`curve_picture`] | `curve-NAME` |
//! | [`energy_pictures`] | `energy-STAGE` |
//! | [`safety_picture`] | `safety-STAGE` |
//! | [`monitor_pictures`] | `monitor-NAME-KIND` |
//! | [`section_pictures`] | `section-NAME-KIND` |
//! | [`seepage_pictures`] | `seepage-WATER`, in space `seepage-WATER-AXIS` |
//! | [`mechanism_picture`] | `mechanism-STAGE` |
//! | [`field_picture`] | `field-STAGE-FIELD` |
//! | [`InSpace`] | `space-STAGE-FIELD`, `cut-AXIS-STAGE-FIELD` |
//! | [`convergence_pictures`] | `convergence-STAGE` |
//! | [`mesh_pictures`] | `mesh-study-NUMBER-RESULT` |
//!
//! Each makes the folder, replaces older pictures of its name, and returns the note of the summary
//! on it. Tables without rows make pictures that say "no data".

mod convergence;
mod curve;
mod energy;
mod field;
mod histories;
mod in_time;
mod mechanism;
mod meshes;
mod model;
pub mod rigid;
mod safety;
mod seepage;
mod space;
pub mod water;

use std::path::Path;

pub use convergence::{History, convergence_pictures, convergence_plot, histories};
pub(super) use convergence::{convergence_caption, stages_of};
pub use curve::curve_picture;
pub use energy::energy_pictures;
pub use field::{Canvas, Over, Seen, Shown, field_picture};
pub(crate) use field::{Colours, edges};
pub use histories::{is_of_section, monitor_pictures, section_pictures};
pub use in_time::{SafetyInTime, safety_in_time_picture};
pub use mechanism::{Failing, Mechanism, mechanism, mechanism_picture, slip_surface};
pub use meshes::mesh_pictures;
pub use model::model_picture;
pub use safety::safety_picture;
pub use seepage::seepage_pictures;
pub use space::InSpace;

use crate::error::ReportError;
use igimp_figures::{Drawing, LineStyle, SeriesStyle};
use igimp_model::Case;
use igimp_results::ResultsError;
use igimp_results::fields::Axes;
use igimp_results::summary::FigureNote;
use igimp_results::tables::table::Table;

/// Folder of the pictures within a results folder.
pub const FOLDER: &str = "figures";

/// The names of the axes of a case.
pub fn axes_of<const D: usize>(case: &Case<D>) -> Axes {
    match D {
        2 if case.method.section.is_axisymmetric() => Axes::Revolution,
        2 => Axes::Plane,
        _ => Axes::Space,
    }
}

/// A name for files: lower-case letters, digits, `_` and single hyphens.
pub fn file_name(text: &str) -> String {
    let mut name = String::with_capacity(text.len());
    for sign in text.chars() {
        if sign.is_ascii_alphanumeric() || sign == '_' {
            name.push(sign.to_ascii_lowercase());
        } else if !name.is_empty() && !name.ends_with('-') {
            name.push('-');
        }
    }
    let name = name.trim_end_matches('-');
    if name.is_empty() { "x" } else { name }.to_owned()
}

/// Writes a drawing as both files.
fn write(
    folder: &Path,
    name: &str,
    drawing: &Drawing,
    caption: String,
) -> Result<FigureNote, ReportError> {
    let figures = folder.join(FOLDER);
    std::fs::create_dir_all(&figures).map_err(|source| ResultsError::File {
        path: figures.clone(),
        source,
    })?;
    drawing.write(&figures.join(name))?;
    Ok(FigureNote {
        file: format!("{FOLDER}/{name}"),
        caption,
    })
}

/// Two columns as points; rows and columns that are missing are left out.
fn points(table: &Table, x: usize, y: usize) -> Vec<[f64; 2]> {
    let value = |row: &Vec<f64>, column: usize| row.get(column).copied();
    table
        .rows
        .iter()
        .filter_map(|row| Some([value(row, x)?, value(row, y)?]))
        .collect()
}

/// A line, with markers as long as they do not overlap.
fn style(points: usize) -> SeriesStyle {
    if points > 25 {
        SeriesStyle::Line(LineStyle::Solid)
    } else {
        SeriesStyle::LineAndMarkers(LineStyle::Solid)
    }
}

/// The title of a picture: the case, and its part that is seen.
pub(super) fn titled(case_title: &str, seen: &str) -> String {
    if case_title.is_empty() || seen.is_empty() {
        format!("{case_title}{seen}")
    } else {
        format!("{case_title} – {seen}")
    }
}

/// A text with its first letter in upper case.
fn sentence(text: &str) -> String {
    let mut signs = text.chars();
    signs.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(signs).collect()
    })
}
