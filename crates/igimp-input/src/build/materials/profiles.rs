//! Properties of materials that vary with the level, with the depth, with the stress or in the plane.

use igimp_geometry::polygon::Polygon;
use igimp_model::{BodyPart, Ground, Profile, Raster, StressShare, Variation, front, in_plane};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::StressPoints;
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number, point};
use igimp_schema::tree::read::At;
use igimp_schema::tree::{Node, Wrong};

use crate::build::bodies::surfaces::plain;

/// A property of a material as a case file states it.
pub(crate) struct Property {
    /// Its constant: the greatest value in the soil where it varies.
    pub(crate) constant: f64,
    /// How it varies, if it does.
    pub(crate) profile: Option<Profile>,
}

/// Where the soil of a material lies, and its name for messages.
#[derive(Clone, Copy)]
pub(crate) struct Extent<'a, const D: usize> {
    pub name: &'a str,
    pub(crate) material: usize,
    pub(crate) bodies: &'a [Option<BodyPart<D>>],
    pub(crate) ground: &'a Ground<D>,
}

impl<'a, const D: usize> Extent<'a, D> {
    /// The bodies of the material.
    fn of_material(&self) -> impl Iterator<Item = &'a BodyPart<D>> {
        let material = self.material;
        let own = self.bodies.iter().flatten();
        own.filter(move |body| body.material == material)
    }

    /// Their outlines as seen from the front: polygons in the plane, else the boxes around them.
    fn outlines(&self) -> Vec<Polygon> {
        let outline = |body: &BodyPart<D>| {
            if let Some(body) = in_plane::<_, BodyPart<2>>(body) {
                return body.polygon().to_vec();
            }
            let (lower, upper) = body.region.bounds();
            let ([left, bottom], [right, top]) = (front(&lower), front(&upper));
            vec![[left, bottom], [right, bottom], [right, top], [left, top]]
        };
        self.of_material().map(outline).collect()
    }

    /// Its lowest and its highest level \[m\]; none: no body is of this material.
    fn levels(&self) -> Option<[f64; 2]> {
        let levels = self.of_material().map(|body| {
            let (lower, upper) = body.region.bounds();
            [lower[D - 1], upper[D - 1]]
        });
        levels.reduce(union)
    }

    /// Its least and its greatest depth \[m\], to the micrometre.
    fn depths(&self) -> Option<[f64; 2]> {
        let depths = self
            .of_material()
            .filter_map(|body| self.ground.depths(&*body.region));
        let depths = depths.reduce(union)?;
        Some(depths.map(|depth| (depth * 1e6).round() / 1e6))
    }

    /// Places all over its soil.
    fn places(&self) -> Vec<[f64; D]> {
        let edges = (self.of_material()).map(|body| self.ground.places(&*body.region));
        let mut places: Vec<[f64; D]> = edges.flatten().collect();
        let ends = places.clone();
        let is_upright = |pair: &&[[f64; D]]| {
            (0..D - 1).all(|axis| pair[0][axis].total_cmp(&pair[1][axis]).is_eq())
        };
        for pair in ends.windows(2).filter(is_upright) {
            places.extend((1..PARTS).map(|k| {
                let share = f64::from(k) / f64::from(PARTS);
                let mut place = pair[0];
                place[D - 1] += share * (pair[1][D - 1] - pair[0][D - 1]);
                place
            }));
        }
        places
    }
}

/// Parts of an upright line through soil at whose ends a stress is looked at.
const PARTS: u32 = 32;
/// A usual stress \[Pa\], for a strength that no soil has.
const USUAL_STRESS: f64 = 1e5;

fn union(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// What a property must be in the soil, and how it is read and printed.
#[derive(Clone, Copy)]
pub(crate) struct Terms {
    /// Whether it may be zero somewhere.
    pub(crate) may_vanish: bool,
    /// Whether it may be zero everywhere.
    pub(crate) may_be_nothing: bool,
    /// What is kept of a number as read.
    pub(crate) kept: fn(f64) -> f64,
    /// What was kept, with its unit.
    pub(crate) printed: fn(f64) -> String,
    /// The forms of a table that says how it varies.
    pub(crate) forms: &'static str,
}

/// A value with the words for its place.
struct Extreme {
    value: f64,
    place: String,
}

/// The property of a key: a quantity, or a table that says how it varies.
pub(crate) fn property<const D: usize>(
    node: &Node,
    key: &str,
    extent: Extent<'_, D>,
    terms: Terms,
    problems: &mut Problems,
) -> Option<Property> {
    let value = node.get(key)?;
    if let Some(constant) = value.number() {
        return Some(Property {
            constant: (terms.kept)(constant),
            profile: None,
        });
    }
    if value.is_invalid() {
        return None;
    }
    let profile = stated(value, key, extent, terms, problems).ok()?;
    let [least, greatest] = extremes(&profile, extent);
    let name = clip(extent.name, 40);
    let place = match &profile {
        Profile::StressShare(_) => value.place_at("ratio"),
        Profile::Raster(_) => value.place_at("rows"),
        Profile::Level(Variation::Gradient { .. }) | Profile::Depth(Variation::Gradient { .. }) => {
            value.place_at("gradient")
        }
        Profile::Level(Variation::Table(_)) | Profile::Depth(Variation::Table(_)) => {
            value.place_at("values")
        }
    };
    let told = || {
        format!(
            "`{key}` is {} {}, in the soil of `{name}`",
            (terms.printed)(least.value),
            least.place
        )
    };
    if !greatest.value.is_finite() || least.value < 0.0 {
        problems.error(place, told()).help(match &profile {
            Profile::Raster(_) => "points that are positive wherever there is soil",
            _ => "a smaller gradient, or `levels` and `values` that stay positive",
        });
        return None;
    }
    if least.value == 0.0 && !terms.may_vanish {
        problems
            .error(place, told())
            .help("it must be positive wherever there is soil");
        return None;
    }
    if greatest.value == 0.0 && !terms.may_be_nothing {
        let [lower, upper] = extent.levels().unwrap_or_default();
        let problem = problems.error(
            place,
            format!("`{key}` is zero in all the soil of `{name}`"),
        );
        match &profile {
            Profile::StressShare(_) => problem.help(
                "no effective stress: is there a unit weight, and is `water_level` as high as meant?",
            ),
            _ => problem.help(format!(
                "its soil lies from y = {} m to {} m: give it a value there",
                number(lower),
                number(upper)
            )),
        };
        return None;
    }
    Some(Property {
        constant: greatest.value,
        profile: Some(profile),
    })
}

/// The least and the greatest value in the soil of a material.
fn extremes<const D: usize>(profile: &Profile, extent: Extent<'_, D>) -> [Extreme; 2] {
    let of = |variation: &Variation, range: Option<[f64; 2]>, words: &dyn Fn(f64) -> String| {
        let [lower, upper] = range.unwrap_or_else(|| match variation {
            Variation::Gradient { from, .. } => [*from; 2],
            Variation::Table(rows) => [rows[0][0], rows[rows.len() - 1][0]],
        });
        variation.extremes(lower, upper).map(|level| Extreme {
            value: variation.at(level),
            place: words(level),
        })
    };
    match profile {
        Profile::Level(variation) => of(variation, extent.levels(), &|level| {
            format!("at y = {} m", number(level))
        }),
        Profile::Depth(variation) => {
            let levels = extent.depths().map(|[least, most]| [-most, 0.0 - least]);
            of(variation, levels, &|level| {
                format!("at a depth of {} m", number(0.0 - level))
            })
        }
        Profile::Raster(raster) => {
            let mut places: Vec<[f64; 2]> = extent
                .outlines()
                .iter()
                .flat_map(|outline| raster.places_in(outline))
                .collect();
            // No soil: where the raster begins.
            places.push(
                places
                    .first()
                    .copied()
                    .unwrap_or([raster.x[0], raster.y[0]]),
            );
            places.sort_by(|a, b| raster.at(*a).total_cmp(&raster.at(*b)));
            [places[0], places[places.len() - 1]].map(|place| Extreme {
                value: raster.at(place),
                place: format!("at {}", point(place)),
            })
        }
        Profile::StressShare(share) => {
            let places = extent.places();
            let values = places.iter().map(|place| Extreme {
                value: profile.at(place, extent.ground),
                place: format!("at {}", point(*place)),
            });
            let unused = || Extreme {
                value: share.at_least.max(share.ratio * USUAL_STRESS),
                place: String::new(),
            };
            let mut values: Vec<Extreme> = values.collect();
            values.sort_by(|a, b| a.value.total_cmp(&b.value));
            let greatest = values.pop().unwrap_or_else(unused);
            let least = values.into_iter().next().unwrap_or_else(unused);
            [least, greatest]
        }
    }
}

/// A form of a table that says how a property varies: the key that tells it, those that it needs beside it, and those
/// that it may have.
struct Form {
    key: &'static str,
    needs: &'static [&'static str],
    may_have: &'static [&'static str],
}

const FORMS: [Form; 6] = [
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
    value: &Node,
    key: &str,
    terms: Terms,
    problems: &mut Problems,
) -> Result<&'static Form, Wrong> {
    let has = |key: &&'static str| value.get(key).is_some();
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
        let is_empty = value.entries().is_empty();
        return Err(lacks(
            if is_empty && has_gradients {
                "at_top"
            } else {
                meant
            },
            problems,
        ));
    };
    let own =
        |key: &str| form.key == key || form.needs.contains(&key) || form.may_have.contains(&key);
    let keys = FORMS.iter().flat_map(|form| {
        std::iter::once(&form.key)
            .chain(form.needs)
            .chain(form.may_have)
    });
    if let Some(other) = keys.into_iter().find(|key| !own(key) && has(key)) {
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
fn stated<const D: usize>(
    value: &Node,
    key: &str,
    extent: Extent<'_, D>,
    terms: Terms,
    problems: &mut Problems,
) -> Result<Profile, Wrong> {
    let form = form(value, key, terms, problems)?;
    match form.key {
        "ratio" => Ok(Profile::StressShare(Box::new(share(
            value, extent, problems,
        )?))),
        "levels" => Ok(Profile::Level(table(value, key, form, terms, problems)?)),
        "depths" => Ok(Profile::Depth(table(value, key, form, terms, problems)?)),
        "rows" => {
            let (x, y) = (StressPoints::x(value)?, StressPoints::y(value)?);
            let rows = StressPoints::rows(value)?;
            let stated = Points {
                x: x.as_ref(),
                y: y.as_ref(),
                rows: rows.as_ref(),
                place: value.place,
            };
            let raster = points(&stated, key, problems)?;
            let outlines = extent.outlines();
            let polygons: Vec<&[[f64; 2]]> = outlines.iter().map(Vec::as_slice).collect();
            let of = format!("the soil of `{}`", clip(extent.name, 40));
            reach(&raster, (value.place, key), (&polygons, &of), problems)?;
            Ok(Profile::Raster(raster))
        }
        top => {
            let from = match (top, value.optional_number("from")?, extent.levels()) {
                ("at_surface", ..) => 0.0,
                (_, Some(from), _) => from,
                (_, None, levels) => levels.map_or(0.0, |[_, upper]| upper),
            };
            let variation = Variation::Gradient {
                from,
                at_top: value.number_at(top).ok_or(Wrong)?,
                gradient: value.number_at("gradient").ok_or(Wrong)?,
            };
            Ok(match top {
                "at_surface" => Profile::Depth(variation),
                _ => Profile::Level(variation),
            })
        }
    }
}

/// What is said of a ratio of overconsolidation.
const OCR: Terms = Terms {
    may_vanish: false,
    may_be_nothing: false,
    kept: |value| value,
    printed: number,
    forms: TABLES,
};
/// The forms of properties that have no gradient.
pub(crate) const TABLES: &str =
    "{ levels = [...], values = [...] }, or { depths = [...], values = [...] }";

fn share<const D: usize>(
    value: &Node,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Result<StressShare, Wrong> {
    let (ocr, ocr_profile) = if value.get("ocr").is_some() {
        let own = property(value, "ocr", extent, OCR, problems).ok_or(Wrong)?;
        (own.constant, own.profile)
    } else {
        (1.0, None)
    };
    Ok(StressShare {
        ratio: value.number_at("ratio").ok_or(Wrong)?,
        ocr,
        ocr_profile,
        exponent: value.optional_number("exponent")?.unwrap_or(0.8),
        at_least: value.optional_number("at_least")?.unwrap_or(0.0),
        water_level: value.optional_number("water_level")?,
    })
}

/// The numbers of a list.
fn numbers(list: Option<&Node>) -> Result<Vec<f64>, Wrong> {
    let list = list.filter(|list| !list.is_invalid()).ok_or(Wrong)?;
    let items = list.items().iter();
    items.map(|item| item.number().ok_or(Wrong)).collect()
}

/// Soil this far beyond a raster has what its edge has, in spacings of its lines \[-\].
const BEYOND: f64 = 0.5 + 1e-9;

/// A list of numbers.
type Numbers = Vec<At<f64>>;

/// Values by points in the plane, as they are stated.
pub(crate) struct Points<'a> {
    pub(crate) x: Option<&'a At<Numbers>>,
    pub(crate) y: Option<&'a At<Numbers>>,
    pub(crate) rows: Option<&'a At<Vec<At<Numbers>>>>,
    pub(crate) place: Place,
}

/// Points in the plane.
pub(crate) fn points(
    own: &Points<'_>,
    key: &str,
    problems: &mut Problems,
) -> Result<Raster, Wrong> {
    let help = "write x = [...], y = [...] and rows = [[...], ...] with a list for every y, or raster = \"cu.csv\"";
    let (Some(xs), Some(ys), Some(rows)) = (own.x, own.y, own.rows) else {
        let missing = match (own.x, own.y) {
            (None, _) => "x",
            (_, None) => "y",
            _ => "rows",
        };
        let message = format!("`{key}` has no `{missing}`");
        problems.error(own.place, message).help(help);
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
    value: &Node,
    key: &str,
    form: &Form,
    terms: Terms,
    problems: &mut Problems,
) -> Result<Variation, Wrong> {
    let places = form.key;
    let (levels, values) = (numbers(value.get(places))?, numbers(value.get("values"))?);
    if levels.len() != values.len() {
        problems
            .error(
                value.place_at("values"),
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
                value.items_at(places)[at].place,
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
        let place = value.items_at(places)[at + 1].place;
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
