//! Curves and their references.

use std::path::Path;

use igimp_model::{Curve, CurveAxis, Load, Quantity, Reference, ReferenceValues};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::clip;
use igimp_schema::tree::Node;

use super::quantities::{divisor, quantity};
use crate::build::AllNames;
use crate::files::text_of;

/// Most bytes of a reference file.
const LARGEST: u64 = 1 << 20;

/// The curves; files of references are beside the case file.
pub(crate) fn curves<const D: usize>(
    tree: &Node,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    file: &Path,
    problems: &mut Problems,
) -> Vec<Option<Curve>> {
    let items = tree.items_at("curves").iter();
    items
        .map(|node| {
            let name = node.text_at("name");
            let x = axis(node.get("x")?, names, loads, problems);
            let y = axis(node.get("y")?, names, loads, problems);
            let who = format!("curve `{}` records", clip(name.unwrap_or("?"), 40));
            let stage = names.stages.find_optional(node, "stage", &who, problems);
            let reference = node
                .get("reference")
                .map(|reference| self::reference(reference, file, problems));
            Some(Curve {
                name: name?.to_owned(),
                x: x?,
                y: y?,
                stage: stage.ok()?,
                reference: reference.map_or(Some(None), |found| found.map(Some))?,
            })
        })
        .collect()
}

fn axis<const D: usize>(
    node: &Node,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    problems: &mut Problems,
) -> Option<CurveAxis> {
    let of = node.get("of")?;
    let found = quantity(of, names, loads, problems);
    if found == Some(Quantity::FactorOfSafety) {
        problems
            .error(of.place, "a factor of safety is one number, not a curve")
            .help("hold it against a value in [[checks]]");
    }
    let divide_by = divisor(node, problems);
    Some(CurveAxis {
        of: found?,
        divide_by: divide_by?,
        label: node.text_at("label")?.to_owned(),
    })
}

/// A reference for a curve, or for a field along a section.
pub(crate) fn reference(node: &Node, file: &Path, problems: &mut Problems) -> Option<Reference> {
    let forms: Vec<&str> = ["y", "points", "file"]
        .into_iter()
        .filter(|form| node.get(form).is_some())
        .collect();
    let &[form] = forms.as_slice() else {
        let message = if forms.is_empty() {
            "the reference has no values".to_owned()
        } else {
            format!("the reference has several forms: {}", forms.join(", "))
        };
        problems
            .error(node.place, message)
            .help("write one of y = 5.14, points = [[0, 0], [1, 2]] and file = \"measured.csv\"");
        return None;
    };
    if form != "y" && node.get("at").is_some() {
        problems
            .error(node.place_at("at"), "`at` goes with `y` only")
            .help("points and files have abscissae of their own");
        return None;
    }
    let value = node.get(form)?;
    let values = match form {
        "y" => ReferenceValues::Level {
            y: value.number()?,
            at: node.optional_number("at").ok()?,
        },
        "points" => {
            let points: Option<Vec<_>> = value.items().iter().map(Node::pair).collect();
            ReferenceValues::Points(points?)
        }
        _ => {
            let path = file.parent().unwrap_or(Path::new("")).join(value.text()?);
            match read_points(&path) {
                Ok(points) => ReferenceValues::Points(points),
                Err(reason) => {
                    problems
                        .error(
                            value.place,
                            format!(
                                "cannot use {}: {reason}",
                                clip(&path.display().to_string(), 80)
                            ),
                        )
                        .help(
                            "a CSV file with a header and two columns, its path from the case file",
                        );
                    return None;
                }
            }
        }
    };
    Some(Reference {
        label: node.text_at("label")?.to_owned(),
        values,
        tolerance: node.optional_number("tolerance").ok()?,
    })
}

/// The points of a CSV file: a header and two columns.
fn read_points(path: &Path) -> Result<Vec<[f64; 2]>, String> {
    let text = text_of(path, LARGEST)?;
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes());
    let mut points = Vec::new();
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|error| error.to_string())?;
        let number = |column: usize| {
            let value: f64 = record.get(column)?.parse().ok()?;
            value.is_finite().then_some(value)
        };
        match (record.len(), number(0), number(1)) {
            (2, Some(x), Some(y)) => points.push([x, y]),
            _ => return Err(format!("row {} does not hold two numbers", row + 2)),
        }
    }
    if points.is_empty() {
        return Err("it has no rows below its header".to_owned());
    }
    Ok(points)
}
