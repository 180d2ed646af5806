//! Histories at monitors and fields along sections: one picture for the fields of a kind.

use std::path::Path;

use super::{file_name, points, style, titled, write};
use crate::case::{Field, Monitor, Section};
use crate::error::CaseError;
use crate::results::fields::{self, Dimension, Scale};
use crate::summary::FigureNote;
use crate::table::Table;
use igimp_figures::{CurvePlot, ReferenceLine, ReferenceValue, Series};

/// Most changes of stage that are marked in a history.
const MOST_MARKS: usize = 12;

/// The pictures of a monitor: what its table holds under the [headers](fields::header) of the
/// recorded fields, over the accepted steps. Where a column `stage` changes stands a line.
///
/// # Errors
/// [`CaseError::File`] and [`CaseError::Figure`].
pub fn monitor_pictures(
    folder: &Path,
    case_title: &str,
    monitor: &Monitor,
    table: &Table,
) -> Result<Vec<FigureNote>, CaseError> {
    let along: Vec<f64> = (1..=table.rows.len()).map(|row| row as f64).collect();
    let marks = stage_marks(table);
    let marked = if marks.is_empty() {
        ""
    } else {
        "; upright lines: a new stage begins"
    };
    let mut notes = Vec::new();
    for group in groups(&monitor.record, table) {
        let (label, series) = group.series(table, &along, false);
        let plot = CurvePlot {
            title: titled(case_title, &format!("monitor {}", monitor.name)),
            x_label: "accepted step".into(),
            y_label: label,
            lines: marks.clone(),
            series,
            ..CurvePlot::default()
        };
        let caption = format!(
            "{} at monitor “{}” over the accepted steps{marked}.",
            group.words(),
            monitor.name
        );
        let name = format!("monitor-{}-{}", file_name(&monitor.name), group.slug());
        notes.push(write(folder, &name, &plot.draw()?, caption)?);
    }
    Ok(notes)
}

/// Lines between rows of different stages.
fn stage_marks(table: &Table) -> Vec<ReferenceLine> {
    let Some(column) = table
        .header
        .iter()
        .position(|header| header.starts_with("stage"))
    else {
        return Vec::new();
    };
    let stage = |row: &Vec<f64>| row.get(column).copied().unwrap_or(0.0).to_bits();
    let pairs = table.rows.windows(2).enumerate();
    let marks: Vec<_> = pairs
        .filter(|(_, pair)| stage(&pair[0]) != stage(&pair[1]))
        .map(|(row, _)| ReferenceLine {
            label: String::new(),
            at: ReferenceValue::X(row as f64 + 1.5),
        })
        .collect();
    if marks.len() > MOST_MARKS {
        Vec::new()
    } else {
        marks
    }
}

/// The pictures of a section at the end of a stage. The distance along the section stands in the
/// first column whose header begins with `distance` (else the first of all). An upright section is
/// drawn upright, over the height.
///
/// # Errors
/// [`CaseError::File`] and [`CaseError::Figure`].
pub fn section_pictures(
    folder: &Path,
    case_title: &str,
    section: &Section,
    stage: &str,
    table: &Table,
) -> Result<Vec<FigureNote>, CaseError> {
    let mut headers = table.header.iter();
    let column = headers
        .position(|header| header.starts_with("distance"))
        .unwrap_or(0);
    let distance = points(table, column, column)
        .into_iter()
        .map(|point| point[0]);
    let [dx, dy] = [0, 1].map(|axis| section.to[axis] - section.from[axis]);
    let upright = dx.abs() <= 1e-6 * dy.abs() && dy != 0.0;
    let along: Vec<f64> = if upright {
        distance
            .map(|s| section.from[1] + dy.signum() * s)
            .collect()
    } else {
        distance.collect()
    };
    let mut notes = Vec::new();
    for group in groups(&section.record, table) {
        let (label, series) = group.series(table, &along, upright);
        let (x_label, y_label) = if upright {
            (label, "height y [m]".to_owned())
        } else {
            (format!("distance along {} [m]", section.name), label)
        };
        let plot = CurvePlot {
            title: titled(case_title, &format!("section {}, {stage}", section.name)),
            x_label,
            y_label,
            series,
            ..CurvePlot::default()
        };
        let caption = format!(
            "{} along section “{}” at the end of stage “{stage}”.",
            group.words(),
            section.name
        );
        let name = format!(
            "section-{}-{}-{}",
            file_name(&section.name),
            file_name(stage),
            group.slug()
        );
        notes.push(write(folder, &name, &plot.draw()?, caption)?);
    }
    Ok(notes)
}

/// Recorded fields of one kind, with their columns.
struct Group {
    dimension: Dimension,
    columns: Vec<(Field, usize)>,
}

/// The recorded fields that the table holds, by kind, in the order of the record.
fn groups(record: &[Field], table: &Table) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for &field in record {
        let wanted = fields::header(field);
        let Some(column) = table.header.iter().position(|header| *header == wanted) else {
            continue;
        };
        let dimension = fields::dimension(field);
        match groups.iter_mut().find(|group| group.dimension == dimension) {
            Some(group) => group.columns.push((field, column)),
            None => groups.push(Group {
                dimension,
                columns: vec![(field, column)],
            }),
        }
    }
    groups
}

impl Group {
    /// The label of the common axis, and a series for every field.
    fn series(&self, table: &Table, along: &[f64], upright: bool) -> (String, Vec<Series>) {
        let values = |column: usize| table.rows.iter().filter_map(move |row| row.get(column));
        let all = self.columns.iter().flat_map(|&(_, column)| values(column));
        let scale = Scale::of(self.dimension, all.copied());
        let make = |&(field, column): &(Field, usize)| {
            let points: Vec<[f64; 2]> = std::iter::zip(along, values(column))
                .map(|(&along, value)| [along, value / scale.divide_by])
                .map(|[a, b]| if upright { [b, a] } else { [a, b] })
                .collect();
            let style = style(points.len());
            Series::new(fields::title(field), points, style)
        };
        match self.columns.as_slice() {
            [only] => {
                let series = Series {
                    label: String::new(),
                    ..make(only)
                };
                (fields::label(only.0, scale), vec![series])
            }
            several => {
                let label = format!("{} [{}]{}", self.noun(), scale.unit, self.sign());
                (label, several.iter().map(make).collect())
            }
        }
    }

    fn noun(&self) -> &'static str {
        match self.dimension {
            Dimension::Displacement => "displacement",
            Dimension::Position => "position",
            Dimension::Stress => "stress",
            Dimension::Strain => "strain",
            Dimension::Share => "share",
        }
    }

    fn sign(&self) -> &'static str {
        if self.dimension == Dimension::Stress {
            ", compression positive"
        } else {
            ""
        }
    }

    fn slug(&self) -> &'static str {
        self.noun()
    }

    fn words(&self) -> String {
        let titles: Vec<String> = self
            .columns
            .iter()
            .map(|&(field, _)| fields::plain(fields::title(field)))
            .collect();
        super::sentence(&titles.join(", "))
    }
}
