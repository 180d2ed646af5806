//! Heads and rain in time, from CSV: time and value.

use std::path::Path;

use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::Dimension;
use igimp_schema::tree::{Entry, Node, Value};

use crate::columns::columns;
use crate::named::{LARGEST, Named, Trouble, quantity, text_of, unit_of};
use crate::record::ascending;

/// The columns of the file.
const COLUMNS: [&str; 2] = ["time", "value"];

/// Puts the samples of heads and rain on the faces of a condition in place of the files that have them.
pub(crate) fn of_faces(condition: &mut Node, folder: &Path, problems: &mut Problems) {
    let faces = condition
        .get_mut("seepage")
        .and_then(|seepage| seepage.get_mut("faces"));
    for face in faces.map(Node::items_mut).into_iter().flatten() {
        for (key, dimension) in [
            ("head", Dimension::Length),
            ("recharge", Dimension::Velocity),
        ] {
            if let Some(node) = face.get_mut(key) {
                resolve(node, dimension, folder, problems);
            }
        }
    }
}

fn resolve(node: &mut Node, dimension: Dimension, folder: &Path, problems: &mut Problems) {
    let Some(value) = node.get("file") else {
        return;
    };
    let Some(file) = Named::new(value, folder) else {
        node.value = Value::Invalid;
        return;
    };
    node.value = match samples(&file, node, dimension) {
        Ok(entries) => Value::Table(entries),
        Err(trouble) => {
            file.report(value, trouble, problems);
            Value::Invalid
        }
    };
}

/// The table with its samples in place of the file.
fn samples(file: &Named, table: &Node, dimension: Dimension) -> Result<Vec<Entry>, Trouble> {
    for other in ["time", "values"] {
        if table.get(other).is_some() {
            return Err(Trouble::new(
                format_args!("the values are stated by `file` and by `{other}`"),
                "keep one of them",
            ));
        }
    }
    let text = text_of(&file.path, LARGEST)
        .map_err(|error| Trouble::new(error, "its path starts from the case file"))?;
    let found = columns(&text, &COLUMNS)?;
    ascending(&found)?;
    let column = |k: usize, dimension: Dimension| {
        let header = (COLUMNS[k], found.units[k].as_deref());
        let Some(_) = header.1 else {
            let (name, usual) = (COLUMNS[k], dimension.usual_unit());
            return Err(Trouble::new(
                format_args!("nothing says in which unit its {name} is"),
                format_args!("write it into the header of the column, as in `{name} [{usual}]`"),
            ));
        };
        let unit = unit_of((COLUMNS[k], None), header, dimension)?;
        let values = found
            .rows
            .iter()
            .map(|row| quantity(row[k], &unit, dimension, table));
        Ok(Value::List(values.collect::<Result<Vec<_>, _>>()?))
    };
    let entry = |key: &str, value| Entry {
        key: key.to_owned(),
        key_place: table.place,
        node: Node::written(value, table.place),
    };
    Ok(vec![
        entry("time", column(0, Dimension::Time)?),
        entry("values", column(1, dimension)?),
    ])
}
