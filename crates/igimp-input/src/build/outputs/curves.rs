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
    own: &keys::Curve,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    file: &Path,
    problems: &mut Problems,
) -> Option<Curve> {
    if own.name.eq_ignore_ascii_case(OF_RUNS) {
        problems
            .error(
                own.name.place,
                format!("a curve cannot be called `{OF_RUNS}`: so is the table of factors of safety in time"),
            )
            .help("give it another name");
    }
    let mut axis = |own: &Found<keys::CurveAxis>| axis(own.as_ref().ok()?, names, loads, problems);
    let (x, y) = (axis(&own.x), axis(&own.y));
    let who = format!("curve `{}` records", clip(&own.name, 40));
    let stage = names
        .stages
        .find_optional(own.stage.as_ref(), &who, problems);
    let reference = own.reference.as_ref().ok().map(|reference| {
        let own = reference.as_ref()?;
        let stated = ReferenceKeys {
            y: own.y.as_ref(),
            at: own.at.as_ref(),
            points: own.points.as_ref(),
            file: own.file.as_ref(),
            label: &own.label,
            tolerance: own.tolerance.as_ref(),
            place: own.place,
        };
        Some(self::reference(&stated, file, problems))
    });
    Some(Curve {
        name: own.name.value.clone(),
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
    own: &keys::CurveAxis,
    names: &AllNames,
    loads: &[Option<Load<D>>],
    problems: &mut Problems,
) -> Option<CurveAxis> {
    let found = quantity(&own.of, names, loads, problems);
    if found == Some(Quantity::FactorOfSafety) {
        problems
            .error(
                own.of.place,
                "a factor of safety is one number, not a curve",
            )
            .help("hold it against a value in [[checks]]");
    }
    let divide_by = divisor(&own.divide_by, problems);
    Some(CurveAxis {
        of: found?,
        divide_by: divide_by?,
        label: own.label.as_ref()?.value.clone(),
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
    own: &ReferenceKeys<'_>,
    file: &Path,
    problems: &mut Problems,
) -> Option<Reference> {
    let values = match (own.y, own.points, own.file) {
        (Some(y), None, None) => ReferenceValues::Level {
            y: **y,
            at: own.at.map(|at| **at),
        },
        (None, Some(points), None) => {
            only_of_y(own.at, problems)?;
            ReferenceValues::Points(points.iter().map(|own| **own).collect())
        }
        (None, None, Some(name)) => {
            only_of_y(own.at, problems)?;
            ReferenceValues::Points(points_of(name, file, problems)?)
        }
        _ => {
            let forms = [
                own.y.map(|_| "y"),
                own.points.map(|_| "points"),
                own.file.map(|_| "file"),
            ];
            let forms: Vec<&str> = forms.into_iter().flatten().collect();
            let message = if forms.is_empty() {
                "the reference has no values".to_owned()
            } else {
                format!("the reference has several forms: {}", forms.join(", "))
            };
            problems.error(own.place, message).help(
                "write one of y = 5.14, points = [[0, 0], [1, 2]] and file = \"measured.csv\"",
            );
            return None;
        }
    };
    Some(Reference {
        label: own.label.value.clone(),
        values,
        tolerance: own.tolerance.map(|own| **own),
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
