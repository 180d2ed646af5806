//! Polygons and the lines between layers, from CSV and DXF.

use std::path::Path;

use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::Dimension;
use igimp_schema::tree::{Node, Value, Wrong};

use crate::columns::columns;
use crate::dxf::{self, Line};
use crate::named::{LARGEST, Named, Trouble, quantity, text_of, unit_of};

/// Ends of two lines closer than this share of their extent are one \[-\].
const SAME: f64 = 1e-9;

/// Puts the corners in place of the table that says where they come from.
pub(crate) fn resolve(polygon: &mut Node, folder: &Path, problems: &mut Problems) {
    if !matches!(polygon.value, Value::Table(_)) {
        return;
    }
    let before = problems.errors();
    let corners = outline(polygon, folder, problems);
    polygon.value = match corners {
        Ok(corners) if problems.errors() == before => Value::List(corners),
        _ => Value::Invalid,
    };
}

fn outline(table: &Node, folder: &Path, problems: &mut Problems) -> Result<Vec<Node>, Wrong> {
    if table.entries().iter().any(|entry| entry.node.is_invalid()) {
        return Err(Wrong);
    }
    let has = |key: &str| table.get(key).is_some();
    match (has("file"), has("top"), has("bottom")) {
        (true, false, false) => corners(table, true, folder, problems),
        (false, true, true) if has("unit") || has("layer") => {
            problems
                .error(table.place, "`unit` and `layer` go with a file")
                .help("write them into `top` and `bottom`");
            Err(Wrong)
        }
        (false, true, true) => between(table, folder, problems),
        _ => {
            problems
                .error(table.place, "this does not say where the corners are")
                .help("write { file = \"ground.csv\", unit = \"m\" }, or { file = \"ground.dxf\", layer = \"clay\", unit = \"m\" }")
                .help("or the lines above and below, { top = { file = ... }, bottom = { file = ... } }");
            Err(Wrong)
        }
    }
}

/// The polygon between two lines that both run from one side to the other.
fn between(table: &Node, folder: &Path, problems: &mut Problems) -> Result<Vec<Node>, Wrong> {
    let mut lines = Vec::new();
    for key in ["top", "bottom"] {
        let line = table.get(key).ok_or(Wrong)?;
        let mut points = if matches!(line.value, Value::List(_)) {
            line.items().to_vec()
        } else {
            corners(line, false, folder, problems)?
        };
        let x = |node: Option<&Node>| node.and_then(Node::pair).map(|[x, _]| x);
        if x(points.last()) < x(points.first()) {
            points.reverse();
        }
        lines.push(points);
    }
    let [top, bottom] = lines.try_into().map_err(|_| Wrong)?;
    let pairs = |line: &[Node]| -> Option<Vec<[f64; 2]>> { line.iter().map(Node::pair).collect() };
    let (above, below) = (pairs(&top).ok_or(Wrong)?, pairs(&bottom).ok_or(Wrong)?);
    let extent = above.iter().chain(&below).map(|point| point[0].abs());
    let extent = extent.fold(0.0, f64::max);
    for (a, b, side) in [
        (above.first(), below.first(), "left"),
        (above.last(), below.last(), "right"),
    ] {
        let (Some(a), Some(b)) = (a, b) else {
            return Err(Wrong);
        };
        if (a[0] - b[0]).abs() > SAME * extent {
            problems
                .error(
                    table.place,
                    format!(
                        "the lines above and below do not end together on the {side}: at x = {} m and at x = {} m",
                        igimp_schema::text::number(a[0]),
                        igimp_schema::text::number(b[0])
                    ),
                )
                .help("let both run from one side of the ground to the other");
            return Err(Wrong);
        }
    }
    Ok(bottom.into_iter().chain(top.into_iter().rev()).collect())
}

/// The corners that a file has.
fn corners(
    table: &Node,
    closed: bool,
    folder: &Path,
    problems: &mut Problems,
) -> Result<Vec<Node>, Wrong> {
    let value = table.get("file").ok_or(Wrong)?;
    let file = Named::new(value, folder).ok_or(Wrong)?;
    match points(&file, table, closed) {
        Ok((points, note)) => {
            if let Some(Trouble { message, help }) = note {
                problems.warning(value.place, message).help(help);
            }
            Ok(points)
        }
        Err(trouble) => {
            file.report(value, trouble, problems);
            Err(Wrong)
        }
    }
}

/// The message where a drawing and the case name different units.
fn other_unit(unit: &str, header: &str) -> Trouble {
    Trouble::new(
        format_args!(
            "the drawing says that it is drawn in {header} ($INSUNITS), and counts as drawn in {unit}"
        ),
        "drawing programs set $INSUNITS unasked; unit in the case file counts",
    )
}

/// The corners that a file has, and a note on them.
fn points(
    file: &Named,
    table: &Node,
    closed: bool,
) -> Result<(Vec<Node>, Option<Trouble>), Trouble> {
    let mut note = None;
    let (unit, layer) = (table.text_at("unit"), table.text_at("layer"));
    let text = text_of(&file.path, LARGEST)
        .map_err(|error| Trouble::new(error, "its path starts from the case file"))?;
    let (points, unit) = if file.ends_in("dxf") {
        let Line { points, is_closed } = dxf::line_on(&text, layer)?;
        if is_closed != closed {
            let (is, needed) = if closed {
                (
                    "does not close",
                    "the outline of a body ends where it begins",
                )
            } else {
                (
                    "closes",
                    "a line between layers runs from one side to the other",
                )
            };
            return Err(Trouble::new(
                format_args!("the line on this layer {is}"),
                needed,
            ));
        }
        let header = dxf::unit_of_header(&text);
        let Some(unit) = unit.or(header) else {
            return Err(Trouble::new(
                "nothing says in which unit it is drawn",
                "add unit = \"m\", or what it is drawn in",
            ));
        };
        note = header
            .filter(|header| *header != unit)
            .map(|header| other_unit(unit, header));
        let unit = Some(unit);
        let unit = unit_of(("unit", unit), ("x", None), Dimension::Length)?;
        (points, [unit.clone(), unit])
    } else {
        if layer.is_some() {
            return Err(Trouble::new(
                "only drawings have layers, in files named .dxf",
                "remove layer",
            ));
        }
        let found = columns(&text, &["x", "y"])?;
        let unit_of = |k: usize, column| {
            let header = found.units[k].as_deref();
            unit_of(("unit", unit), (column, header), Dimension::Length)
        };
        let units = [unit_of(0, "x")?, unit_of(1, "y")?];
        let points = found.rows.iter().map(|row| [row[0], row[1]]);
        (points.collect(), units)
    };
    let least = if closed { 3 } else { 2 };
    if points.len() < least {
        return Err(Trouble::new(
            format_args!("it has {} points", points.len()),
            format_args!("at least {least} are needed"),
        ));
    }
    let node = |[x, y]: [f64; 2]| -> Result<Node, Trouble> {
        let pair = [(x, &unit[0]), (y, &unit[1])];
        let pair = pair.map(|(number, unit)| quantity(number, unit, Dimension::Length, table));
        let [x, y] = pair;
        Ok(Node::written(Value::List(vec![x?, y?]), table.place))
    };
    let points = points.into_iter().map(node).collect::<Result<_, _>>()?;
    Ok((points, note))
}
