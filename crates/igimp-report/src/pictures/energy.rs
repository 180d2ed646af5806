//! Where the work of a stage that takes time went, over time.

use std::path::Path;

use igimp_figures::{Colour, CurvePlot, Series, SeriesLabels};
use igimp_model::Case;
use igimp_results::summary::FigureNote;
use igimp_results::tables::table::Table;
use igimp_text::short;

use super::{file_name, titled, write};
use crate::error::ReportError;

/// A curve is left out that stays below this share of the largest value \[-\].
const SEEN: f64 = 0.002;

/// Columns that place a row, or that are shown in another way.
const APART: [&str; 4] = ["stage", "step", "time", "kinetic_gain"];

/// Columns of the energy that the numerical method took, which is one curve.
const OF_METHOD: [&str; 3] = ["scheme", "map", "integration"];

/// The pictures of the energy of the stages that take time, by a table as `energy.csv` is: the work of loads, and where it went.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn energy_pictures<const D: usize>(
    folder: &Path,
    case: &Case<D>,
    table: &Table,
) -> Result<Vec<FigureNote>, ReportError> {
    let (Some(of_stage), Some(time)) = (column(table, "stage"), column(table, "time")) else {
        return Ok(Vec::new());
    };
    let mut notes = Vec::new();
    for (number, stage) in case.stages.iter().enumerate() {
        let in_stage = |row: &&Vec<f64>| (row[of_stage] - (number + 1) as f64).abs() < 0.5;
        let rows: Vec<&Vec<f64>> = table.rows.iter().filter(in_stage).collect();
        if rows.is_empty() {
            continue;
        }
        let curves = curves(table, &rows);
        let (divide_by, unit) = unit(table, &curves);
        let series = curves.iter().map(|(label, values)| {
            let times = rows.iter().map(|row| row[time]);
            let points = std::iter::zip(times, values).map(|(t, value)| [t, value / divide_by]);
            let series = Series::line(label.clone(), points.collect());
            match label.as_str() {
                "loads" => series.in_colour(Colour::BLACK),
                _ => series,
            }
        });
        let plot = CurvePlot {
            title: titled(&case.title, &format!("energy, {}", stage.name)),
            x_label: "time [s]".to_owned(),
            y_label: format!("energy [{unit}]"),
            series: series.collect(),
            labels: SeriesLabels::AtCurves,
            ..CurvePlot::default()
        };
        let caption = format!(
            "Energy of stage “{}” over time: what gravity and loads did, and where it went. {}",
            stage.name,
            left_out(&curves, table, &rows)
        );
        let name = format!("energy-{}-{}", number + 1, file_name(&stage.name));
        notes.push(write(
            folder,
            &name,
            &plot.draw()?,
            caption.trim_end().to_owned(),
        )?);
    }
    Ok(notes)
}

/// The place of a column by its name, without its unit.
fn column(table: &Table, name: &str) -> Option<usize> {
    table.header.iter().position(|header| named(header) == name)
}

/// The name in a header, without its unit.
fn named(header: &str) -> &str {
    header.split("_[").next().unwrap_or_default()
}

/// The curves that are large enough to be seen, with their labels.
fn curves(table: &Table, rows: &[&Vec<f64>]) -> Vec<(String, Vec<f64>)> {
    let mut all = all_curves(table, rows);
    let most = largest(&all);
    all.retain(|(_, values)| values.iter().any(|value| value.abs() > SEEN * most));
    all
}

/// All parts of the energy, the losses of the method as one.
fn all_curves(table: &Table, rows: &[&Vec<f64>]) -> Vec<(String, Vec<f64>)> {
    let mut method = vec![0.0; rows.len()];
    let mut all = Vec::new();
    for (place, header) in table.header.iter().enumerate() {
        let name = named(header);
        let values = || rows.iter().map(|row| row[place]);
        if OF_METHOD.contains(&name) {
            for (sum, value) in std::iter::zip(&mut method, values()) {
                *sum += value;
            }
        } else if !APART.contains(&name) {
            let label = match name {
                "elastic_gain" => "elastic",
                other => other,
            };
            all.push((label.replace('_', " "), values().collect()));
        }
    }
    all.push(("numerical method".to_owned(), method));
    all
}

fn largest(curves: &[(String, Vec<f64>)]) -> f64 {
    let values = curves.iter().flat_map(|(_, values)| values);
    values
        .filter(|value| value.is_finite())
        .fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// The unit in which the largest value reads well, and the divisor of values in J or J/m.
fn unit(table: &Table, curves: &[(String, Vec<f64>)]) -> (f64, String) {
    let per = if table.header.iter().any(|header| header.ends_with("[J/m]")) {
        "/m"
    } else {
        ""
    };
    let most = largest(curves);
    let (divide_by, prefix) = match most {
        _ if most >= 1e9 => (1e9, "G"),
        _ if most >= 1e6 => (1e6, "M"),
        _ if most >= 1e3 => (1e3, "k"),
        _ if most > 0.0 && most < 0.1 => (1e-3, "m"),
        _ => (1.0, ""),
    };
    (divide_by, format!("{prefix}J{per}"))
}

/// Parts that are too small to be seen, in words.
fn left_out(shown: &[(String, Vec<f64>)], table: &Table, rows: &[&Vec<f64>]) -> String {
    let all = all_curves(table, rows);
    let is_small = |(label, values): &&(String, Vec<f64>)| {
        let is_there = values.iter().any(|value| *value != 0.0);
        is_there && !shown.iter().any(|(name, _)| name == label)
    };
    let small: Vec<&str> = all
        .iter()
        .filter(is_small)
        .map(|curve| curve.0.as_str())
        .collect();
    if small.is_empty() {
        return String::new();
    }
    format!(
        "Below {} % of the largest, and not drawn: {}.",
        short(100.0 * SEEN),
        small.join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: columns are found by their names, wherever they stand; one that is new has a curve; the loss of the method is the
    /// sum of its parts; a part that cannot be seen is named.
    #[test]
    fn energy_is_read_by_the_names_of_its_columns() {
        let header = [
            "stage",
            "step",
            "time_[s]",
            "kinetic_[J/m]",
            "kinetic_gain_[J/m]",
            "boundaries_[J/m]",
            "scheme_[J/m]",
            "elastic_gain_[J/m]",
            "map_[J/m]",
            "contact_[J/m]",
        ];
        let mut table = Table::new("energy", &header);
        table.push(vec![1.0, 1.0, 0.1, 2e3, 2e3, 300.0, 10.0, 40.0, 5.0, 0.0]);
        table.push(vec![1.0, 2.0, 0.2, 1e3, 1e3, 600.0, 20.0, 1.0, 6.0, 1e-3]);
        let rows: Vec<&Vec<f64>> = table.rows.iter().collect();
        let curves = curves(&table, &rows);
        let labels: Vec<&str> = curves.iter().map(|curve| curve.0.as_str()).collect();
        assert_eq!(
            labels,
            ["kinetic", "boundaries", "elastic", "numerical method"]
        );
        assert_eq!(curves[3].1, [15.0, 26.0]);
        assert_eq!(unit(&table, &curves), (1e3, "kJ/m".to_owned()));
        assert!(left_out(&curves, &table, &rows).ends_with("not drawn: contact."));
    }
}
