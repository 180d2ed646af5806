//! Properties of materials that vary with the level, with the depth, with the stress or in the plane.

mod tables;

use igimp_geometry::polygon::Polygon;
use igimp_model::{BodyPart, Ground, Profile, Variation, front, in_plane};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::{self as keys, Growth, Rows, StrengthProfile};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number, point};
use igimp_schema::tree::read::{At, Either};

use tables::{FORMS, Form, stated};
pub(crate) use tables::{FORMS_OF_ALL, TABLES, points, reach};

/// A property of a material as a case file states it.
pub(crate) struct Property {
    /// The least value in the soil.
    pub(crate) least: f64,
    /// Its constant: the greatest value in the soil where it varies.
    pub(crate) constant: f64,
    /// How it varies, if it does.
    pub(crate) profile: Option<Profile>,
}

/// Where the soil of a material lies, and its name for messages.
#[derive(Clone, Copy)]
pub(crate) struct Extent<'a, const D: usize> {
    pub(crate) name: &'a str,
    pub(crate) material: usize,
    pub(crate) bodies: &'a [Option<BodyPart<D>>],
    pub(crate) ground: &'a Ground<D>,
}

impl<'a, const D: usize> Extent<'a, D> {
    /// The bodies of the material.
    fn of_material(&self) -> impl Iterator<Item = &'a BodyPart<D>> {
        let material = self.material;
        let parts = self.bodies.iter().flatten();
        parts.filter(move |body| body.material == material)
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
}

/// A usual stress \[Pa\], for a strength that no soil has.
const USUAL_STRESS: f64 = 1e5;

fn union(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// Demands on a property in the soil, and how it is read and printed.
#[derive(Clone, Copy)]
pub(crate) struct Terms {
    /// Whether it may be zero somewhere.
    pub(crate) may_vanish: bool,
    /// Whether it may be zero everywhere.
    pub(crate) may_be_nothing: bool,
    /// The kept form of a number as read.
    pub(crate) kept: fn(f64) -> f64,
    /// The kept number, with its unit.
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
    /// The keys that it states.
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
        fn of<T>(at: Option<&At<T>>) -> Option<Place> {
            at.map(|at| at.place)
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
        let of_files = |points: &keys::Points| {
            let keys = [&points.raster, &points.unit, &points.length_unit];
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
    given: &At<Either<f64, T>>,
    key: &str,
    extent: Extent<'_, D>,
    terms: Terms,
    problems: &mut Problems,
) -> Option<Property> {
    let value = match &**given {
        Either::First(constant) => {
            let constant = (terms.kept)(*constant);
            return Some(Property {
                least: constant,
                constant,
                profile: None,
            });
        }
        Either::Second(table) => table.stated(given.place),
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
    let message = || {
        format!(
            "`{key}` is {} {}, in the soil of `{name}`",
            (terms.printed)(least.value),
            least.place
        )
    };
    if !greatest.value.is_finite() || least.value < 0.0 {
        problems.error(place, message()).help(match &profile {
            Profile::Raster(_) => "points that are positive wherever there is soil",
            _ => "a smaller gradient, or `levels` and `values` that stay positive",
        });
        return None;
    }
    if least.value == 0.0 && !terms.may_vanish {
        problems
            .error(place, message())
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
        least: least.value,
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
            let of_body = |body: &BodyPart<D>| extent.ground.places_within(&*body.region);
            let places: Vec<[f64; D]> = extent.of_material().flat_map(of_body).collect();
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
