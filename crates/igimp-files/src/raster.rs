//! A property of a material by points in the plane, from CSV: x, y and the value, on the lines of a rectangular grid.

use std::path::Path;

use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::Dimension;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::{Entry, Node, Value};

use crate::columns::{Columns, columns};
use crate::named::{LARGEST, Named, Trouble, quantity, text_of, unit_of};

/// The columns of the file.
const COLUMNS: [&str; 3] = ["x", "y", "value"];
/// Properties that are numbers without a unit.
const NUMBERS: [&str; 11] = [
    "poisson",
    "lambda",
    "kappa",
    "critical_ratio",
    "ocr",
    "gsi",
    "mi",
    "disturbance",
    "power",
    "failure_ratio",
    "k0_normal",
];
/// Most points.
const MOST: usize = 100_000;
/// Coordinates closer than this share of the extent are one \[-\].
const SAME: f64 = 1e-9;

/// Puts the points in place of the file that has them, in a table that names one in `raster`.
pub(crate) fn resolve(property: &mut Node, key: &str, folder: &Path, problems: &mut Problems) {
    let Some(value) = property.get("raster") else {
        return;
    };
    let Some(file) = Named::new(value, folder) else {
        property.value = Value::Invalid;
        return;
    };
    property.value = match points(&file, property, key) {
        Ok(entries) => Value::Table(entries),
        Err(trouble) => {
            file.report(value, trouble, problems);
            Value::Invalid
        }
    };
}

/// The table with its points.
fn points(file: &Named, table: &Node, key: &str) -> Result<Vec<Entry>, Trouble> {
    let keys = ["raster", "unit", "length_unit"];
    let mut others = table.entries().iter().map(|entry| entry.key.as_str());
    if let Some(other) = others.find(|other| !keys.contains(other)) {
        return Err(Trouble::new(
            format_args!("`{key}` is stated by `raster` and by `{other}`"),
            "keep one of them",
        ));
    }
    let dimension = match key {
        "unit_weight" => Some(Dimension::UnitWeight),
        "friction" | "dilation" => Some(Dimension::Angle),
        key if NUMBERS.contains(&key) => None,
        _ => Some(Dimension::Stress),
    };
    let text = text_of(&file.path, LARGEST)
        .map_err(|error| Trouble::new(error, "its path starts from the case file"))?;
    let found = columns(&text, &COLUMNS)?;
    let unit = |key: &str, column: usize, dimension| {
        let header = found.units[column].as_deref();
        unit_of(
            (key, table.text_at(key)),
            (COLUMNS[column], header),
            dimension,
        )
    };
    let along = [
        unit("length_unit", 0, Dimension::Length)?,
        unit("length_unit", 1, Dimension::Length)?,
    ];
    let of_values = match dimension {
        Some(dimension) => Some((unit("unit", 2, dimension)?, dimension)),
        None => without_unit(key, [table.text_at("unit"), found.units[2].as_deref()])?,
    };
    let [x, y] = [0, 1].map(|column| lines(&found, column));
    let rows = rows(&found, &x, &y)?;
    let list = |numbers: &[f64], unit: Option<(&str, Dimension)>| -> Result<Node, Trouble> {
        let items = numbers.iter().map(|&value| match unit {
            Some((unit, dimension)) => quantity(value, unit, dimension, table),
            None => Ok(Node::written(Value::Number(value), table.place)),
        });
        let items = items.collect::<Result<Vec<_>, _>>()?;
        Ok(Node::written(Value::List(items), table.place))
    };
    let of_values = of_values.as_ref().map(|(unit, d)| (unit.as_str(), *d));
    let rows = rows.iter().map(|row| list(row, of_values));
    let rows = rows.collect::<Result<Vec<_>, _>>()?;
    let entry = |key: &str, node| Entry {
        key: key.to_owned(),
        key_place: table.place,
        node,
    };
    Ok(vec![
        entry("x", list(&x, Some((&along[0], Dimension::Length)))?),
        entry("y", list(&y, Some((&along[1], Dimension::Length)))?),
        entry("rows", Node::written(Value::List(rows), table.place)),
    ])
}

/// No unit, as numbers have none; refuses one that the case file or the header of the column states.
fn without_unit<T>(key: &str, stated: [Option<&str>; 2]) -> Result<Option<T>, Trouble> {
    let is_unit = |unit: &&str| !["", "-", "−", "1"].contains(&unit.trim());
    match stated.into_iter().flatten().find(is_unit) {
        None => Ok(None),
        Some(unit) => Err(Trouble::new(
            format_args!(
                "its value is in `{}`, and `{key}` is a number without a unit",
                clip(unit, 20)
            ),
            "leave the unit out, or write `value [-]` into the header of the column",
        )),
    }
}

/// The coordinates that points have, ascending, each once.
fn lines(found: &Columns, column: usize) -> Vec<f64> {
    let mut all: Vec<f64> = found.rows.iter().map(|row| row[column]).collect();
    all.sort_by(f64::total_cmp);
    let extent = all.last().unwrap_or(&0.0) - all.first().unwrap_or(&0.0);
    all.dedup_by(|next, kept| *next - *kept <= SAME * extent);
    all
}

/// Values by y, then by x: every pair once.
fn rows(found: &Columns, x: &[f64], y: &[f64]) -> Result<Vec<Vec<f64>>, Trouble> {
    let help = "every x goes with every y, each pair once";
    let count = found.rows.len();
    if count > MOST {
        let message = format!("it has {count} points; at most {MOST} are possible");
        return Err(Trouble::new(message, "take fewer of them"));
    }
    // The last line that is not beyond a coordinate, but for round-off.
    let nearest = |lines: &[f64], at: f64| {
        let after = lines.partition_point(|line| *line <= at);
        after.saturating_sub(1)
    };
    let mut line_of = std::collections::BTreeMap::new();
    for (row, line) in found.rows.iter().zip(&found.lines) {
        let place = [nearest(y, row[1]), nearest(x, row[0])];
        if let Some((first, _)) = line_of.insert(place, (*line, row[2])) {
            return Err(Trouble::new(
                format_args!(
                    "line {line}: the point ({}, {}) is in line {first} already",
                    number(row[0]),
                    number(row[1])
                ),
                help,
            ));
        }
    }
    if count != x.len() * y.len() {
        let missing = (0..y.len()).find_map(|j| {
            let empty = |i: &usize| !line_of.contains_key(&[j, *i]);
            (0..x.len()).find(empty).map(|i| [x[i], y[j]])
        });
        let [a, b] = missing.unwrap_or([f64::NAN; 2]);
        return Err(Trouble::new(
            format_args!(
                "its points fill no rectangle: {} x and {} y make {} points, {count} are there, and none is at ({}, {})",
                x.len(),
                y.len(),
                x.len() * y.len(),
                clip(&number(a), 20),
                clip(&number(b), 20)
            ),
            help,
        ));
    }
    let values: Vec<f64> = line_of.into_values().map(|(_, value)| value).collect();
    Ok(values.chunks(x.len()).map(<[f64]>::to_vec).collect())
}
