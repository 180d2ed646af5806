//! Properties of materials that vary with the level, with the depth, with the stress or in the plane.

use igimp_geometry::polygon::Polygon;
use igimp_model::{BodyPart, Ground, Profile, Raster, StressShare, Variation, front, in_plane};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::{self as keys, Growth, Rows, StrengthProfile};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number, point};
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::{At, Either};

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

/// A table that says how a property varies, as it is stated.
pub(crate) struct ProfileKeys<'a> {
    growth: Option<&'a Growth>,
    rows: &'a Rows,
    points: Option<&'a keys::Points>,
    share: Option<&'a StrengthProfile>,
    place: Place,
}

/// A table that says how a property varies.
pub(crate) trait Varies {
    /// What it states.
    fn stated(&self, place: Place) -> ProfileKeys<'_>;
}

impl Varies for keys::Profile {
    fn stated(&self, place: Place) -> ProfileKeys<'_> {
        ProfileKeys {
            growth: Some(&self.growth),
            rows: &self.table,
            points: Some(&self.points),
            share: None,
            place,
        }
    }
}

impl Varies for StrengthProfile {
    fn stated(&self, place: Place) -> ProfileKeys<'_> {
        ProfileKeys {
            share: Some(self),
            ..self.stress.stated(place)
        }
    }
}

impl Varies for Rows {
    fn stated(&self, place: Place) -> ProfileKeys<'_> {
        ProfileKeys {
            growth: None,
            rows: self,
            points: None,
            share: None,
            place,
        }
    }
}

impl ProfileKeys<'_> {
    /// Where a key of a form is stated, if it is.
    fn place_of(&self, key: &str) -> Option<Place> {
        fn of<T>(own: Option<&At<T>>) -> Option<Place> {
            own.map(|own| own.place)
        }
        let (growth, points, share) = (self.growth, self.points, self.share);
        match key {
            "at_surface" => of(growth?.at_surface.as_ref()),
            "at_top" => of(growth?.at_top.as_ref()),
            "gradient" => of(growth?.gradient.as_ref()),
            "from" => of(growth?.from.as_ref()),
            "levels" => of(self.rows.levels.as_ref()),
            "depths" => of(self.rows.depths.as_ref()),
            "values" => of(self.rows.values.as_ref()),
            "x" => of(points?.x.as_ref()),
            "y" => of(points?.y.as_ref()),
            "rows" => of(points?.rows.as_ref()),
            "ratio" => of(share?.ratio.as_ref()),
            "ocr" => of(share?.ocr.as_ref()),
            "exponent" => of(share?.exponent.as_ref()),
            "at_least" => of(share?.at_least.as_ref()),
            "water_level" => of(share?.water_level.as_ref()),
            _ => None,
        }
    }

    /// Whether no key is stated.
    fn is_empty(&self) -> bool {
        let of_files = |own: &keys::Points| {
            let keys = [&own.raster, &own.unit, &own.length_unit];
            keys.into_iter().any(Option::is_some)
        };
        let mut keys = FORMS.iter().flat_map(Form::keys);
        !self.points.is_some_and(of_files) && keys.all(|key| self.place_of(key).is_none())
    }

    /// Where a key is stated; the table where it is not.
    fn place_at(&self, key: &str) -> Place {
        self.place_of(key).unwrap_or(self.place)
    }
}

/// The property of a key: a quantity, or a table that says how it varies.
pub(crate) fn property<T: Varies, const D: usize>(
    own: &At<Either<f64, T>>,
    key: &str,
    extent: Extent<'_, D>,
    terms: Terms,
    problems: &mut Problems,
) -> Option<Property> {
    let value = match &**own {
        Either::First(constant) => {
            return Some(Property {
                constant: (terms.kept)(*constant),
                profile: None,
            });
        }
        Either::Second(table) => table.stated(own.place),
    };
    let profile = stated(&value, key, extent, terms, problems).ok()?;
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

impl Form {
    /// All of them.
    fn keys(&self) -> impl Iterator<Item = &&'static str> {
        let own = std::iter::once(&self.key);
        own.chain(self.needs).chain(self.may_have)
    }
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
    let own =
        |key: &str| form.key == key || form.needs.contains(&key) || form.may_have.contains(&key);
    let mut keys = FORMS.iter().flat_map(Form::keys);
    if let Some(other) = keys.find(|key| !own(key) && has(key)) {
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
            let own = value.points.ok_or(Wrong)?;
            let raster = points(own, value.place, key, problems)?;
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
    own: &StrengthProfile,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Result<StressShare, Wrong> {
    let (ocr, ocr_profile) = match &own.ocr {
        Some(ocr) => {
            let own = property(ocr, "ocr", extent, OCR, problems).ok_or(Wrong)?;
            (own.constant, own.profile)
        }
        None => (1.0, None),
    };
    let value = |own: &Option<At<f64>>| own.as_ref().map(|own| **own);
    Ok(StressShare {
        ratio: value(&own.ratio).ok_or(Wrong)?,
        ocr,
        ocr_profile,
        exponent: value(&own.exponent).unwrap_or(0.8),
        at_least: value(&own.at_least).unwrap_or(0.0),
        water_level: value(&own.water_level),
    })
}

/// Soil this far beyond a raster has what its edge has, in spacings of its lines \[-\].
const BEYOND: f64 = 0.5 + 1e-9;

/// Points in the plane, stated at a place.
pub(crate) fn points(
    own: &keys::Points,
    place: Place,
    key: &str,
    problems: &mut Problems,
) -> Result<Raster, Wrong> {
    let help = "write x = [...], y = [...] and rows = [[...], ...] with a list for every y, or raster = \"cu.csv\"";
    let (Some(xs), Some(ys), Some(rows)) = (&own.x, &own.y, &own.rows) else {
        let missing = match (&own.x, &own.y) {
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
    own: &Rows,
    levels: Option<&At<Vec<At<f64>>>>,
    key: &str,
    form: &Form,
    terms: Terms,
    problems: &mut Problems,
) -> Result<Variation, Wrong> {
    let places = form.key;
    let (stated, of_them) = (levels.ok_or(Wrong)?, own.values.as_ref().ok_or(Wrong)?);
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
