//! Curves and their references.

use std::path::Path;

use igimp_files::text_of;
use igimp_model::{Curve, CurveAxis, Load, Quantity, Reference, ReferenceValues};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::outputs as keys;
use igimp_schema::source::Place;
use igimp_schema::text::clip;
use igimp_schema::tree::read::{At, Found};

use super::quantities::{divisor, quantity};
use crate::build::AllNames;

/// Most bytes of a reference file.
const LARGEST: u64 = 1 << 20;

/// The name of a table that runs write among curves.
const OF_RUNS: &str = "safety-in-time";

/// A curve; files of references are beside the case file.
pub(crate) fn curve<const D: usize>(
    curve: &keys::Curve,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    file: &Path,
    problems: &mut Problems,
) -> Option<Curve> {
    if curve.name.eq_ignore_ascii_case(OF_RUNS) {
        problems
            .error(
                curve.name.place,
                format!("a curve cannot be called `{OF_RUNS}`: so is the table of factors of safety in time"),
            )
            .help("give it another name");
    }
    let mut axis = |key: &Found<keys::CurveAxis>| axis(key.as_ref().ok()?, names, loads, problems);
    let (x, y) = (axis(&curve.x), axis(&curve.y));
    let subject = format!("curve `{}` records", clip(&curve.name, 40));
    let stage = names
        .stages
        .find_optional(curve.stage.as_ref(), &subject, problems);
    let reference = curve.reference.as_ref().ok().map(|reference| {
        let table = reference.as_ref()?;
        let stated = ReferenceKeys {
            y: table.y.as_ref(),
            at: table.at.as_ref(),
            points: table.points.as_ref(),
            file: table.file.as_ref(),
            label: &table.label,
            tolerance: table.tolerance.as_ref(),
            place: table.place,
        };
        Some(self::reference(&stated, file, problems))
    });
    Some(Curve {
        name: curve.name.value.clone(),
        x: x?,
        y: y?,
        stage: stage.ok()?,
        reference: match reference? {
            None => None,
            Some(found) => Some(found?),
        },
    })
}

fn axis<const D: usize>(
    axis: &keys::CurveAxis,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    problems: &mut Problems,
) -> Option<CurveAxis> {
    let found = quantity(&axis.of, names, loads, problems);
    if found == Some(Quantity::FactorOfSafety) {
        problems
            .error(
                axis.of.place,
                "a factor of safety is one number, not a curve",
            )
            .help("hold it against a value in [[checks]]");
    }
    let divide_by = divisor(&axis.divide_by, problems);
    Some(CurveAxis {
        of: found?,
        divide_by: divide_by?,
        label: axis.label.as_ref()?.value.clone(),
    })
}

/// A reference for a curve, or for a field along a section, as it is stated.
pub(crate) struct ReferenceKeys<'a> {
    pub(crate) y: Option<&'a At<f64>>,
    pub(crate) at: Option<&'a At<f64>>,
    pub(crate) points: Option<&'a At<Vec<At<[f64; 2]>>>>,
    pub(crate) file: Option<&'a At<String>>,
    pub(crate) label: &'a At<String>,
    pub(crate) tolerance: Option<&'a At<f64>>,
    pub(crate) place: Place,
}

/// A reference for a curve, or for a field along a section.
pub(crate) fn reference(
    stated: &ReferenceKeys<'_>,
    file: &Path,
    problems: &mut Problems,
) -> Option<Reference> {
    let values = match (stated.y, stated.points, stated.file) {
        (Some(y), None, None) => ReferenceValues::Level {
            y: **y,
            at: stated.at.map(|at| **at),
        },
        (None, Some(points), None) => {
            only_of_y(stated.at, problems)?;
            ReferenceValues::Points(points.iter().map(|point| **point).collect())
        }
        (None, None, Some(name)) => {
            only_of_y(stated.at, problems)?;
            ReferenceValues::Points(points_of(name, file, problems)?)
        }
        _ => {
            let forms = [
                stated.y.map(|_| "y"),
                stated.points.map(|_| "points"),
                stated.file.map(|_| "file"),
            ];
            let forms: Vec<&str> = forms.into_iter().flatten().collect();
            let message = if forms.is_empty() {
                "the reference has no values".to_owned()
            } else {
                format!("the reference has several forms: {}", forms.join(", "))
            };
            problems.error(stated.place, message).help(
                "write one of y = 5.14, points = [[0, 0], [1, 2]] and file = \"measured.csv\"",
            );
            return None;
        }
    };
    Some(Reference {
        label: stated.label.value.clone(),
        values,
        tolerance: stated.tolerance.map(|value| **value),
    })
}

/// Refuses the abscissa of a value where points have their own.
fn only_of_y(at: Option<&At<f64>>, problems: &mut Problems) -> Option<()> {
    let Some(at) = at else { return Some(()) };
    problems
        .error(at.place, "`at` goes with `y` only")
        .help("points and files have abscissae of their own");
    None
}

/// The points of a file beside the case file.
fn points_of(name: &At<String>, file: &Path, problems: &mut Problems) -> Option<Vec<[f64; 2]>> {
    let path = file.parent().unwrap_or(Path::new("")).join(&name.value);
    match read_points(&path) {
        Ok(points) => Some(points),
        Err(reason) => {
            problems
                .error(
                    name.place,
                    format!(
                        "cannot use {}: {reason}",
                        clip(&path.display().to_string(), 80)
                    ),
                )
                .help("a CSV file with a header and two columns, its path from the case file");
            None
        }
    }
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
