//! Records of the motion of the ground, from CSV: time, and acceleration or velocity.

use std::path::Path;

use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::Dimension;
use igimp_schema::schema::ground_motion::RecordUnit;
use igimp_schema::text::{clip, number, row};
use igimp_schema::tree::{Entry, Node, Value};

use crate::columns::{Columns, columns};
use crate::named::{LARGEST, Named, Trouble, quantity, text_of, unit_of};

/// The columns of the file; the second column may be a velocity as well.
const COLUMNS: [&str; 2] = ["time", "acceleration"];
/// Most samples.
const MOST: usize = 100_000;

/// Puts the samples in place of the file that has them.
pub(crate) fn resolve(motion: &mut Node, folder: &Path, problems: &mut Problems) {
    let Some(value) = motion.get("file") else {
        return;
    };
    let Some(file) = Named::new(value, folder) else {
        motion.value = Value::Invalid;
        return;
    };
    motion.value = match samples(&file, motion) {
        Ok(entries) => Value::Table(entries),
        Err(trouble) => {
            file.report(value, trouble, problems);
            Value::Invalid
        }
    };
}

/// The table with its samples in place of the file.
fn samples(file: &Named, table: &Node) -> Result<Vec<Entry>, Trouble> {
    for other in ["time", "values"] {
        if table.get(other).is_some() {
            return Err(Trouble::new(
                format_args!("the motion is stated by `file` and by `{other}`"),
                "keep one of them",
            ));
        }
    }
    let text = text_of(&file.path, LARGEST)
        .map_err(|error| Trouble::new(error, "its path starts from the case file"))?;
    let found = columns(&text, &COLUMNS)?;
    if found.rows.len() > MOST {
        return Err(Trouble::new(
            format_args!(
                "it has {} samples; at most {MOST} are possible",
                found.rows.len()
            ),
            "take fewer of them",
        ));
    }
    ascending(&found)?;
    let time = unit_of(
        ("time", Some("s").filter(|_| found.units[0].is_none())),
        (COLUMNS[0], found.units[0].as_deref()),
        Dimension::Time,
    )?;
    let unit = unit_of_values(table.text_at("unit"), found.units[1].as_deref())?;
    agrees(found.names[1].as_deref(), unit)?;
    let times = (found.rows.iter()).map(|row| quantity(row[0], &time, Dimension::Time, table));
    let times = times.collect::<Result<Vec<_>, _>>()?;
    let value = |row: &Vec<f64>| Node::written(Value::Number(row[1]), table.place);
    let values = found.rows.iter().map(value).collect();
    let entry = |key: &str, value| Entry {
        key: key.to_owned(),
        key_place: table.place,
        node: Node::written(value, table.place),
    };
    let others = table.entries().iter();
    let mut entries: Vec<Entry> = others
        .filter(|other| !["file", "unit"].contains(&other.key.as_str()))
        .cloned()
        .collect();
    entries.extend([
        entry("unit", Value::Text(unit.name().to_owned())),
        entry("time", Value::List(times)),
        entry("values", Value::List(values)),
    ]);
    Ok(entries)
}

/// Refuses a time that is not after the one before.
pub(crate) fn ascending(found: &Columns) -> Result<(), Trouble> {
    let pairs = found.rows.windows(2).zip(found.lines.windows(2));
    for (rows, lines) in pairs {
        if rows[1][0] <= rows[0][0] {
            return Err(Trouble::new(
                format_args!(
                    "line {}: the time {} is not after {} in line {}",
                    lines[1],
                    number(rows[1][0]),
                    number(rows[0][0]),
                    lines[0]
                ),
                "times of a record ascend, each once",
            ));
        }
    }
    if found.rows.len() < 2 {
        return Err(Trouble::new(
            format_args!("line {}: it has one sample only", found.lines[0]),
            "a record has two samples or more",
        ));
    }
    if found.rows[0][0] < 0.0 {
        return Err(Trouble::new(
            format_args!("line {}: its time is negative", found.lines[0]),
            "times count from the beginning",
        ));
    }
    Ok(())
}

/// The unit of the second column: that of the case file or of the header, which have to agree.
fn unit_of_values(stated: Option<&str>, header: Option<&str>) -> Result<RecordUnit, Trouble> {
    let units = || {
        format!(
            "units of acceleration and velocity: {}",
            row(RecordUnit::names())
        )
    };
    let header = header.map(|text| text.trim().replace('²', "2").replace("^2", "2"));
    let unit = match (stated, header) {
        (Some(stated), Some(header)) if stated.trim() != header => {
            return Err(Trouble::new(
                format_args!(
                    "its values are in `{}` by its header, and in `{}` by the case file",
                    clip(&header, 20),
                    clip(stated, 20)
                ),
                "keep one of them",
            ));
        }
        (Some(unit), _) => unit.trim().to_owned(),
        (None, Some(unit)) => unit,
        (None, None) => {
            return Err(Trouble::new(
                "nothing says in which unit its values are",
                "write it into the header, as in `acceleration [g]`, or beside the file, as in unit = \"g\"",
            ));
        }
    };
    RecordUnit::named(&unit).ok_or_else(|| {
        let message = format!("unknown unit `{}` of its values", clip(&unit, 20));
        Trouble::new(message, units())
    })
}

/// Refuses a unit of velocity in a column that is called acceleration by the header, and the reverse.
fn agrees(name: Option<&str>, unit: RecordUnit) -> Result<(), Trouble> {
    let (_, is_velocity) = unit.in_si();
    let kinds = ["acceleration", "velocity"];
    let [of_unit, other] = if is_velocity {
        [kinds[1], kinds[0]]
    } else {
        kinds
    };
    // `acc` and `vel` are usual short names.
    match name.filter(|name| name.starts_with(&other[..3])) {
        None => Ok(()),
        Some(name) => Err(Trouble::new(
            format_args!(
                "its column 2 is `{}` by its header, and in `{}`, a unit of {of_unit}",
                clip(name, 40),
                unit.name()
            ),
            format_args!("name the column {of_unit}, or state a unit of {other}"),
        )),
    }
}
