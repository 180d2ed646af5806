//! Histories at monitors and fields along sections: one picture for the fields of a kind.

use std::path::Path;

use igimp_figures::{
    Band, Colour, CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Series, SeriesStyle,
};
use igimp_model::{
    Average, Case, Field, Monitor, ReferenceValues, Section, SectionReference, StageKind,
};
use igimp_results::fields::{self, Axes, Dimension, Scale};
use igimp_results::summary::FigureNote;
use igimp_results::tables::table::Table;
use igimp_text::short;

use super::{axes_of, file_name, points, style, titled, write};
use crate::error::ReportError;

/// Most changes of stage that are marked in a history.
const MOST_MARKS: usize = 12;

/// The pictures of a monitor: the columns of its table under the [headers](igimp_model::Field::header) of the
/// recorded fields, over the accepted steps, or over time where every stage moves in time. Where a column `stage` changes stands
/// a line, and a curve that does not go on there is not joined: displacements that count anew, a stage
/// that starts from another one than that before it.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn monitor_pictures<const D: usize>(
    folder: &Path,
    case: &Case<D>,
    monitor: &Monitor<D>,
    table: &Table,
) -> Result<Vec<FigureNote>, ReportError> {
    let times = times(case, table);
    let (over, x_label) = match times {
        Some(_) => ("over time", "time [s]"),
        None => ("over the accepted steps", "accepted step"),
    };
    let marks = stage_marks(table, times.as_deref());
    let along = times.unwrap_or_else(|| (1..=table.rows.len()).map(|row| row as f64).collect());
    let marked = if marks.is_empty() {
        ""
    } else {
        "; upright lines: a new stage begins"
    };
    let mut notes = Vec::new();
    for group in groups(&monitor.record, table, axes_of(case)) {
        let breaks = breaks(case, table, group.dimension);
        let broken = if breaks.is_empty() {
            ""
        } else {
            "; lines are broken where a quantity begins anew"
        };
        let (label, series) = group.series(table, (&along, &breaks), false);
        let plot = CurvePlot {
            title: titled(&case.title, &format!("monitor {}", monitor.name)),
            x_label: x_label.to_owned(),
            y_label: label,
            lines: marks.clone(),
            series,
            ..CurvePlot::default()
        };
        let caption = format!(
            "{} at monitor “{}” {over}{marked}{broken}.",
            group.words(),
            monitor.name
        );
        let name = format!("monitor-{}-{}", file_name(&monitor.name), group.slug());
        notes.push(write(folder, &name, &plot.draw()?, caption)?);
    }
    Ok(notes)
}

/// The times of the rows of a table \[s\]; none where a stage among them does not move in time.
fn times<const D: usize>(case: &Case<D>, table: &Table) -> Option<Vec<f64>> {
    let column = |name: &str| table.header.iter().position(|head| head.starts_with(name));
    let (stage, time) = (column("stage")?, column("time")?);
    let of_motion = |row: &Vec<f64>| {
        let found = case.stages.get((row[stage] as usize).checked_sub(1)?)?;
        matches!(found.kind, StageKind::Dynamic(_)).then_some(row[time])
    };
    table.rows.iter().map(of_motion).collect()
}

/// The changes of stage of a table: the row before, and the stages before and after, from 1.
fn changes(table: &Table) -> Vec<(usize, [usize; 2])> {
    let Some(column) = table
        .header
        .iter()
        .position(|header| header.starts_with("stage"))
    else {
        return Vec::new();
    };
    let stage = |row: &Vec<f64>| row.get(column).map_or(0, |&stage| stage as usize);
    let pairs = table.rows.windows(2).enumerate();
    pairs
        .map(|(row, pair)| (row, [stage(&pair[0]), stage(&pair[1])]))
        .filter(|(_, [before, after])| before != after)
        .collect()
}

/// The rows after which a quantity of this kind begins anew.
fn breaks<const D: usize>(case: &Case<D>, table: &Table, of: Dimension) -> Vec<usize> {
    let anew = |&(_, [before, after]): &(usize, [usize; 2])| {
        let stage = |number: usize| case.stages.get(number.checked_sub(1)?);
        let (Some(ended), Some(begun)) = (stage(before), stage(after)) else {
            return false;
        };
        let reset = ended.reset_displacements && of == Dimension::Displacement;
        reset || begun.start_from != Some(before - 1)
    };
    changes(table)
        .into_iter()
        .filter(anew)
        .map(|(row, _)| row)
        .collect()
}

/// Lines between rows of different stages; over time at the ends of stages.
fn stage_marks(table: &Table, times: Option<&[f64]>) -> Vec<ReferenceLine> {
    let marks: Vec<_> = changes(table)
        .into_iter()
        .map(|(row, _)| ReferenceLine {
            label: String::new(),
            at: ReferenceValue::X(times.map_or(row as f64 + 1.5, |times| times[row])),
        })
        .collect();
    if marks.len() > MOST_MARKS {
        Vec::new()
    } else {
        marks
    }
}

/// The pictures of a section at the end of a stage, with its references. The distance along the section stands in the
/// first column whose header begins with `distance` (else the first of all). An upright section is
/// drawn upright, over the height.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn section_pictures<const D: usize>(
    folder: &Path,
    (case_title, axes): (&str, Axes),
    section: &Section<D>,
    stage: &str,
    references: &[&SectionReference],
    table: &Table,
) -> Result<Vec<FigureNote>, ReportError> {
    let course = Course::of(section, table);
    let mut notes = Vec::new();
    for group in groups(&section.record, table, axes) {
        let (label, mut series) = group.series(table, (&course.along, &[]), course.is_upright);
        let scale = group.scale(table);
        let mut bands = Vec::new();
        let mut sources = String::new();
        for held in references.iter().filter(|held| group.has(held.of)) {
            let (points, band) = course.reference(held, scale);
            bands.extend(band);
            let style = SeriesStyle::LineAndMarkers(LineStyle::Dashed);
            let name = held.reference.label.clone();
            sources = format!("{sources} Reference: {}.", fields::plain(&name));
            series.push(Series::new(name, points, style).in_colour(Colour::BLACK));
        }
        let (x_label, y_label) = if course.is_upright {
            (label, format!("height {} [m]", ["y", "z"][D - 2]))
        } else {
            (format!("distance along {} [m]", section.name), label)
        };
        let plot = CurvePlot {
            title: titled(case_title, &format!("section {}, {stage}", section.name)),
            x_label,
            y_label,
            series,
            bands,
            ..CurvePlot::default()
        };
        let of = match section.average {
            Average::None => "",
            Average::Cell => ", means over cells",
        };
        let caption = format!(
            "{} {}{of}.{sources}",
            group.words(),
            along_at_end(&section.name, stage)
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

/// Place and time of a section, for the caption of its picture.
fn along_at_end(section: &str, stage: &str) -> String {
    format!("along section “{section}” at the end of stage “{stage}”")
}

/// Whether a picture is one of a section at the end of a stage.
pub fn is_of_section(figure: &FigureNote, section: &str, stage: &str) -> bool {
    figure.caption.contains(&along_at_end(section, stage))
}

/// Where the rows of a section stand.
struct Course {
    /// The distance along the section, or the height where it is upright \[m\].
    along: Vec<f64>,
    is_upright: bool,
    /// Height at which it begins \[m\], and whether it goes up (1) or down (−1).
    foot: f64,
    sense: f64,
}

impl Course {
    fn of<const D: usize>(section: &Section<D>, table: &Table) -> Self {
        let mut headers = table.header.iter();
        let column = headers
            .position(|header| header.starts_with("distance"))
            .unwrap_or(0);
        let along: [f64; D] = std::array::from_fn(|axis| section.to[axis] - section.from[axis]);
        let rise = along[D - 1];
        let is_level = |run: &f64| run.abs() <= 1e-6 * rise.abs();
        let mut course = Self {
            along: Vec::new(),
            is_upright: rise.abs() > 0.0 && along[..D - 1].iter().all(is_level),
            foot: section.from[D - 1],
            sense: rise.signum(),
        };
        let distance = points(table, column, column);
        course.along = distance
            .iter()
            .map(|point| course.place(point[0]))
            .collect();
        course
    }

    /// A distance along the section as it is drawn.
    fn place(&self, distance: f64) -> f64 {
        if self.is_upright {
            self.foot + self.sense * distance
        } else {
            distance
        }
    }

    /// A reference as it is drawn, in the unit of the plot, and the band of its tolerance.
    fn reference(&self, held: &SectionReference, scale: Scale) -> (Vec<[f64; 2]>, Option<Band>) {
        let (points, band) = reference(held, &self.along, scale, &|distance| self.place(distance));
        let band = band.map(|band| Band {
            lower: self.turned(&band.lower),
            upper: self.turned(&band.upper),
            ..band
        });
        (self.turned(&points), band)
    }

    /// Points with the height upright.
    fn turned(&self, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let turn = |&[a, b]: &[f64; 2]| if self.is_upright { [b, a] } else { [a, b] };
        points.iter().map(turn).collect()
    }
}

/// The points of a reference over the distance, or the height, along a section, in the unit of the plot,
/// and the band of its tolerance.
fn reference(
    held: &SectionReference,
    along: &[f64],
    scale: Scale,
    height: &dyn Fn(f64) -> f64,
) -> (Vec<[f64; 2]>, Option<Band>) {
    let points: Vec<[f64; 2]> = match &held.reference.values {
        ReferenceValues::Level { y, at: Some(at) } => vec![[height(*at), y / scale.divide_by]],
        ReferenceValues::Level { y, at: None } => {
            let end = along.last().copied();
            end.map(|end| [end, y / scale.divide_by])
                .into_iter()
                .collect()
        }
        ReferenceValues::Points(points) => {
            let place = |&[s, y]: &[f64; 2]| [height(s), y / scale.divide_by];
            points.iter().map(place).collect()
        }
    };
    let band = held.reference.tolerance.filter(|_| points.len() > 1);
    let band =
        band.map(|share| Band::around(format!("±{} %", short(100.0 * share)), &points, share));
    (points, band)
}

/// Recorded fields of one kind, with their columns.
struct Group {
    axes: Axes,
    dimension: Dimension,
    columns: Vec<(Field, usize)>,
}

/// The recorded fields that the table holds, by kind, in the order of the record.
fn groups(record: &[Field], table: &Table, axes: Axes) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for &field in record {
        let wanted = field.header();
        let Some(column) = table.header.iter().position(|header| *header == wanted) else {
            continue;
        };
        let dimension = field.dimension();
        match groups.iter_mut().find(|group| group.dimension == dimension) {
            Some(group) => group.columns.push((field, column)),
            None => groups.push(Group {
                axes,
                dimension,
                columns: vec![(field, column)],
            }),
        }
    }
    groups
}

impl Group {
    fn has(&self, field: Field) -> bool {
        self.columns.iter().any(|&(other, _)| other == field)
    }

    /// The unit of its values.
    fn scale(&self, table: &Table) -> Scale {
        let values = |column: usize| table.rows.iter().filter_map(move |row| row.get(column));
        let all = self.columns.iter().flat_map(|&(_, column)| values(column));
        Scale::of(self.dimension, all.copied())
    }

    /// The label of the common axis, and a series for every field, broken after some rows.
    fn series(
        &self,
        table: &Table,
        (along, breaks): (&[f64], &[usize]),
        upright: bool,
    ) -> (String, Vec<Series>) {
        let values = |column: usize| table.rows.iter().filter_map(move |row| row.get(column));
        let scale = self.scale(table);
        let make = |&(field, column): &(Field, usize)| {
            let mut points: Vec<[f64; 2]> = std::iter::zip(along, values(column))
                .map(|(&along, value)| [along, value / scale.divide_by])
                .map(|[a, b]| if upright { [b, a] } else { [a, b] })
                .collect();
            for &row in breaks.iter().rev() {
                points.insert((row + 1).min(points.len()), [f64::NAN; 2]);
            }
            let style = style(points.len());
            Series::new(field.title_in(self.axes), points, style)
        };
        match self.columns.as_slice() {
            [only] => {
                let series = Series {
                    label: String::new(),
                    ..make(only)
                };
                (fields::label_in(self.axes, only.0, scale), vec![series])
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
            Dimension::Angle => "angle",
            Dimension::Velocity => "velocity",
            Dimension::Acceleration => "acceleration",
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
            .map(|&(field, _)| fields::plain(field.title_in(self.axes)))
            .collect();
        super::sentence(&titles.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_input::CaseFile;
    use igimp_input::shipped::SHIPPED;

    /// GOAL: histories of a motion are over time, of a stage that follows another one too; of other stages over steps.
    /// ORACLE: the times of the table.
    #[test]
    fn histories_of_a_motion_are_over_time() {
        let shipped = |name: &str| {
            let found = SHIPPED.iter().find(|case| case.name == name).unwrap();
            let file = CaseFile::parse(&format!("{name}.toml"), found.text, &[]);
            file.unwrap().case().clone()
        };
        let mut case = shipped("column_collapse");
        case.stages.push(case.stages[0].clone());
        let mut table = Table::new("corner", &["stage", "step", "time_[s]", "speed_[m/s]"]);
        let rows = [(1.0, 0.0), (1.0, 0.15), (1.0, 0.3), (2.0, 0.4), (2.0, 0.5)];
        for (stage, time) in rows {
            table.push(vec![stage, 1.0, time, 0.0]);
        }
        let found = times(&case, &table).unwrap();
        assert_eq!(found, rows.map(|(_, time)| time));
        let marks = stage_marks(&table, Some(&found));
        assert!(
            matches!(marks[..], [ReferenceLine { at: ReferenceValue::X(x), .. }] if (x - 0.3).abs() < 1e-12)
        );
        assert_eq!(times(&shipped("slope"), &table), None);
    }

    /// GOAL: a fall to zero that nothing made is not drawn: the slope's displacements count anew after its
    /// first stage, and its run-out starts from there.
    #[test]
    fn lines_end_where_a_quantity_begins_anew() {
        let slope = SHIPPED.iter().find(|case| case.name == "slope").unwrap();
        let file = CaseFile::parse("slope.toml", slope.text, &[]).unwrap();
        let mut case = file.case().clone();
        let mut table = Table::new("crest", &["stage", "step", "displacement_[m]"]);
        for (stage, displacement) in [(1.0, 0.1), (1.0, 0.2), (3.0, 0.01), (3.0, 0.02)] {
            table.push(vec![stage, 1.0, displacement]);
        }
        assert_eq!(breaks(&case, &table, Dimension::Displacement), [1]);
        assert!(breaks(&case, &table, Dimension::Stress).is_empty());
        case.stages[2].start_from = Some(1);
        assert_eq!(breaks(&case, &table, Dimension::Stress), [1]);
        let group = &groups(&[Field::Displacement], &table, Axes::Plane)[0];
        let (_, series) = group.series(&table, (&[1.0, 2.0, 3.0, 4.0], &[1]), false);
        let points = &series[0].points;
        assert_eq!(points.len(), 5);
        assert!(points[2][0].is_nan() && points[1][0] < 3.0 && points[3][0] > 2.0);
    }
}
