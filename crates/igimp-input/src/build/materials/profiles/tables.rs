//! The tables that say how a property varies.

use igimp_model::{Profile, Raster, StressShare, Variation};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::{self as keys, Rows, StrengthProfile};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number, point};
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::At;

use super::{Extent, ProfileKeys, Terms, property};
use crate::build::bodies::surfaces::plain;

/// A form of a table that says how a property varies: the key that tells it, those that it needs beside it, and those
/// that it may have.
pub(super) struct Form {
    key: &'static str,
    needs: &'static [&'static str],
    may_have: &'static [&'static str],
}

impl Form {
    /// All of them.
    pub(super) fn keys(&self) -> impl Iterator<Item = &&'static str> {
        let first = std::iter::once(&self.key);
        first.chain(self.needs).chain(self.may_have)
    }
}

/// All forms.
pub(super) const FORMS: [Form; 6] = [
    Form {
        key: "at_top",
        needs: &["gradient"],
        may_have: &["from"],
    },
    Form {
        key: "at_surface",
        needs: &["gradient"],
        may_have: &[],
    },
    Form {
        key: "levels",
        needs: &["values"],
        may_have: &[],
    },
    Form {
        key: "depths",
        needs: &["values"],
        may_have: &[],
    },
    Form {
        key: "ratio",
        needs: &[],
        may_have: &["ocr", "exponent", "at_least", "water_level"],
    },
    Form {
        key: "rows",
        needs: &["x", "y"],
        may_have: &[],
    },
];

/// The form of a table; reports a table of several or of none.
fn form(
    value: &ProfileKeys<'_>,
    key: &str,
    terms: Terms,
    problems: &mut Problems,
) -> Result<&'static Form, Wrong> {
    let has = |key: &&'static str| value.place_of(key).is_some();
    let lacks = |missing: &str, problems: &mut Problems| {
        problems
            .error(value.place, format!("`{key}` has no `{missing}`"))
            .help(format!("write {}", terms.forms));
        Wrong
    };
    let Some(form) = FORMS.iter().find(|form| has(&form.key)) else {
        let of_others = |form: &&Form| form.needs.iter().chain(form.may_have).any(has);
        let meant = FORMS
            .iter()
            .find(of_others)
            .map_or("levels", |form| form.key);
        let has_gradients = terms.forms.contains("at_top");
        let is_empty = value.is_empty();
        return Err(lacks(
            if is_empty && has_gradients {
                "at_top"
            } else {
                meant
            },
            problems,
        ));
    };
    let belongs =
        |key: &str| form.key == key || form.needs.contains(&key) || form.may_have.contains(&key);
    let mut keys = FORMS.iter().flat_map(Form::keys);
    if let Some(other) = keys.find(|key| !belongs(key) && has(key)) {
        problems
            .error(
                value.place_at(other),
                format!("`{key}` is stated by `{}` and by `{other}`", form.key),
            )
            .help(format!("keep one of {}", terms.forms));
        return Err(Wrong);
    }
    match form.needs.iter().find(|key| !has(key)) {
        Some(missing) => Err(lacks(missing, problems)),
        None => Ok(form),
    }
}

/// The profile that a table states.
pub(super) fn stated<const D: usize>(
    value: &ProfileKeys<'_>,
    key: &str,
    extent: Extent<'_, D>,
    terms: Terms,
    problems: &mut Problems,
) -> Result<Profile, Wrong> {
    let form = form(value, key, terms, problems)?;
    match form.key {
        "ratio" => Ok(Profile::StressShare(Box::new(share(
            value.share.ok_or(Wrong)?,
            extent,
            problems,
        )?))),
        "levels" => {
            let levels = value.rows.levels.as_ref();
            let table = table(value.rows, levels, key, form, terms, problems)?;
            Ok(Profile::Level(table))
        }
        "depths" => {
            let depths = value.rows.depths.as_ref();
            let table = table(value.rows, depths, key, form, terms, problems)?;
            Ok(Profile::Depth(table))
        }
        "rows" => {
            let lists = value.points.ok_or(Wrong)?;
            let raster = points(lists, value.place, key, problems)?;
            let outlines = extent.outlines();
            let polygons: Vec<&[[f64; 2]]> = outlines.iter().map(Vec::as_slice).collect();
            let of = format!("the soil of `{}`", clip(extent.name, 40));
            reach(&raster, (value.place, key), (&polygons, &of), problems)?;
            Ok(Profile::Raster(raster))
        }
        _ => {
            let growth = value.growth.ok_or(Wrong)?;
            let gradient = **growth.gradient.as_ref().ok_or(Wrong)?;
            if let Some(at_top) = &growth.at_top {
                let highest = || extent.levels().map_or(0.0, |[_, upper]| upper);
                return Ok(Profile::Level(Variation::Gradient {
                    from: growth.from.as_ref().map_or_else(highest, |from| **from),
                    at_top: **at_top,
                    gradient,
                }));
            }
            Ok(Profile::Depth(Variation::Gradient {
                from: 0.0,
                at_top: **growth.at_surface.as_ref().ok_or(Wrong)?,
                gradient,
            }))
        }
    }
}

/// Terms of a ratio of overconsolidation.
const OCR: Terms = Terms {
    may_vanish: false,
    may_be_nothing: false,
    kept: |value| value,
    printed: number,
    forms: TABLES,
};
/// All forms but those of a strength by stress.
pub(crate) const FORMS_OF_ALL: &str = "{ at_top = ..., gradient = ... }, { at_surface = ..., gradient = ... }, { levels = [...], values = [...] }, or { raster = ... }";
/// The forms of properties that have no gradient.
pub(crate) const TABLES: &str =
    "{ levels = [...], values = [...] }, or { depths = [...], values = [...] }";

fn share<const D: usize>(
    profile: &StrengthProfile,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Result<StressShare, Wrong> {
    let (ocr, ocr_profile) = match &profile.ocr {
        Some(ocr) => {
            let ratio = property(ocr, "ocr", extent, OCR, problems).ok_or(Wrong)?;
            (ratio.constant, ratio.profile)
        }
        None => (1.0, None),
    };
    let value = |key: &Option<At<f64>>| key.as_ref().map(|at| **at);
    if let (Some(exponent), None) = (&profile.exponent, &profile.ocr) {
        let message = "`exponent` has no effect: it is that of `ocr`, which is not stated";
        problems
            .warning(exponent.place, message)
            .help("add ocr = 2.0, or remove it");
    }
    Ok(StressShare {
        ratio: value(&profile.ratio).ok_or(Wrong)?,
        ocr,
        ocr_profile,
        exponent: value(&profile.exponent).unwrap_or(0.8),
        at_least: value(&profile.at_least).unwrap_or(0.0),
        water_level: value(&profile.water_level),
    })
}

/// Soil this far beyond a raster has what its edge has, in spacings of its lines \[-\].
const BEYOND: f64 = 0.5 + 1e-9;

/// Points in the plane, stated at a place.
pub(crate) fn points(
    lists: &keys::Points,
    place: Place,
    key: &str,
    problems: &mut Problems,
) -> Result<Raster, Wrong> {
    let help = "write x = [...], y = [...] and rows = [[...], ...] with a list for every y, or raster = \"cu.csv\"";
    let (Some(xs), Some(ys), Some(rows)) = (&lists.x, &lists.y, &lists.rows) else {
        let missing = match (&lists.x, &lists.y) {
            (None, _) => "x",
            (_, None) => "y",
            _ => "rows",
        };
        let message = format!("`{key}` has no `{missing}`");
        problems.error(place, message).help(help);
        return Err(Wrong);
    };
    let (x, y) = (plain(xs), plain(ys));
    let values: Vec<Vec<f64>> = rows.iter().map(|row| plain(row)).collect();
    if values.len() != y.len() || values.iter().any(|row| row.len() != x.len()) {
        let message = format!(
            "the rows of `{key}` are not those of {} y and {} x",
            y.len(),
            x.len()
        );
        problems.error(rows.place, message).help(help);
        return Err(Wrong);
    }
    for (name, lines, place) in [("x", &x, xs.place), ("y", &y, ys.place)] {
        if let Some(at) = lines.windows(2).position(|pair| pair[0] >= pair[1]) {
            let message = format!(
                "the {name} of `{key}` do not go up: {} m after {} m",
                number(lines[at + 1]),
                number(lines[at])
            );
            problems
                .error(place, message)
                .help("write them upwards, each once");
            return Err(Wrong);
        }
    }
    Ok(Raster { x, y, values })
}

/// Refuses points that soil lies too far beyond; `of` are the words for the soil.
pub(crate) fn reach(
    raster: &Raster,
    (place, key): (Place, &str),
    (polygons, of): (&[&[[f64; 2]]], &str),
    problems: &mut Problems,
) -> Result<(), Wrong> {
    let corners = polygons.iter().flat_map(|polygon| polygon.iter().copied());
    let far = |at: &[f64; 2]| raster.beyond(*at) > BEYOND;
    if let Some(at) = corners.into_iter().find(far) {
        let ends = |lines: &[f64]| {
            format!(
                "{} m to {} m",
                number(lines[0]),
                number(lines[lines.len() - 1])
            )
        };
        problems
            .error(
                place,
                format!("`{key}` has no value at {}, in {of}", point(at)),
            )
            .help(format!(
                "its points reach from x = {}, and from y = {}",
                ends(&raster.x),
                ends(&raster.y)
            ))
            .help("soil may lie beyond them by half the distance of two points");
        return Err(Wrong);
    }
    Ok(())
}

fn table(
    lists: &Rows,
    levels: Option<&At<Vec<At<f64>>>>,
    key: &str,
    form: &Form,
    terms: Terms,
    problems: &mut Problems,
) -> Result<Variation, Wrong> {
    let places = form.key;
    let (stated, of_them) = (levels.ok_or(Wrong)?, lists.values.as_ref().ok_or(Wrong)?);
    let (levels, values) = (plain(stated), plain(of_them));
    if levels.len() != values.len() {
        problems
            .error(
                of_them.place,
                format!(
                    "`{key}` has {} {places} and {} values",
                    levels.len(),
                    values.len()
                ),
            )
            .help("one value for each of them");
        return Err(Wrong);
    }
    if places == "depths"
        && let Some(at) = levels.iter().position(|depth| *depth < 0.0)
    {
        problems
            .error(
                stated[at].place,
                format!("a depth of `{key}` is {} m", number(levels[at])),
            )
            .help("depths are positive downwards from the surface");
        return Err(Wrong);
    }
    let goes_up = levels.first() < levels.last();
    let wrong = levels.windows(2).position(|pair| {
        pair[0]
            .partial_cmp(&pair[1])
            .is_none_or(|order| order.is_lt() != goes_up || order.is_eq())
    });
    if let Some(at) = wrong {
        let place = stated[at + 1].place;
        problems
            .error(
                place,
                format!(
                    "the {places} of `{key}` go up and down: {} m after {} m",
                    number(levels[at + 1]),
                    number(levels[at])
                ),
            )
            .help(format!("write them all upwards or all downwards, each once; a jump needs two {places} close together"));
        return Err(Wrong);
    }
    let sign = if places == "depths" { -1.0 } else { 1.0 };
    let mut rows: Vec<[f64; 2]> = std::iter::zip(levels, values)
        .map(|(level, value)| [sign * level, (terms.kept)(value)])
        .collect();
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Ok(Variation::Table(rows))
}
