//! Properties of materials that vary with the level, or from place to place.

use crate::case::{BodyPart, Profile, Raster};
use crate::input::diagnostic::Problems;
use crate::input::text::{clip, number, point};
use crate::input::tree::{Node, Wrong};
use crate::polygon::bounding_box;

/// A property of a material as a case file states it.
pub(super) struct Property {
    /// Its constant: the greatest value in the soil where it varies.
    pub(super) constant: f64,
    /// How it varies, if it does.
    pub(super) profile: Option<Profile>,
}

/// Where the soil of a material lies, and its name for messages.
#[derive(Clone, Copy)]
pub(super) struct Extent<'a> {
    pub(super) name: &'a str,
    material: usize,
    bodies: &'a [Option<BodyPart>],
}

impl<'a> Extent<'a> {
    /// That of the material of a number.
    pub(super) fn of(name: &'a str, material: usize, bodies: &'a [Option<BodyPart>]) -> Self {
        Self {
            name,
            material,
            bodies,
        }
    }

    /// The polygons of its bodies.
    fn polygons(&self) -> Vec<&'a [[f64; 2]]> {
        let own = self.bodies.iter().flatten();
        let own = own.filter(|body| body.material == self.material);
        own.map(|body| &body.polygon[..]).collect()
    }

    /// The lowest and the highest level \[m\]; none: no body is of this material.
    fn levels(&self) -> Option<[f64; 2]> {
        let boxes = self.polygons().into_iter().map(bounding_box);
        let levels = boxes.map(|(lower, upper)| [lower[1], upper[1]]);
        levels.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// What a profile must be in the soil, with the unit that messages print.
#[derive(Clone, Copy)]
pub(super) struct Terms {
    /// Whether it may be zero somewhere.
    pub(super) may_vanish: bool,
    /// Whether it may be zero everywhere.
    pub(super) may_be_nothing: bool,
    /// k before this unit.
    pub(super) unit: &'static str,
}

/// The property of a key: a quantity, or a table that says how it varies.
pub(super) fn property(
    node: &Node,
    key: &str,
    extent: Extent<'_>,
    terms: Terms,
    problems: &mut Problems,
) -> Option<Property> {
    let value = node.get(key)?;
    if let Some(constant) = value.number() {
        return Some(Property {
            constant,
            profile: None,
        });
    }
    if value.is_invalid() {
        return None;
    }
    let profile = stated(value, key, extent, problems).ok()?;
    let [least, greatest] = profile.extremes(&extent.polygons()).unwrap_or_else(|| {
        // No soil: where the profile itself is told.
        match &profile {
            Profile::Gradient { from, .. } => [[0.0, *from]; 2],
            Profile::Table(rows) => [rows[0][0], rows[rows.len() - 1][0]].map(|y| [0.0, y]),
            Profile::Raster(raster) => [[raster.x[0], raster.y[0]]; 2],
        }
    });
    let constant = profile.at(greatest);
    let name = clip(extent.name, 40);
    let in_words = |at: [f64; 2]| {
        let value = format!("{} k{}", number(profile.at(at) / 1e3), terms.unit);
        match profile {
            Profile::Raster(_) => format!("{value} at {}", point(at)),
            _ => format!("{value} at y = {} m", number(at[1])),
        }
    };
    let place = match profile {
        Profile::Gradient { .. } => value.place_at("gradient"),
        Profile::Table(_) => value.place_at("values"),
        Profile::Raster(_) => value.place_at("rows"),
    };
    if !constant.is_finite() || profile.at(least) < 0.0 {
        problems
            .error(
                place,
                format!("`{key}` is {}, in the soil of `{name}`", in_words(least)),
            )
            .help(match profile {
                Profile::Raster(_) => "points that are positive wherever there is soil",
                _ => "a smaller gradient, or `levels` and `values` that stay positive",
            });
        return None;
    }
    if profile.at(least) == 0.0 && !terms.may_vanish {
        problems
            .error(
                place,
                format!("`{key}` is {}, in the soil of `{name}`", in_words(least)),
            )
            .help("it must be positive wherever there is soil");
        return None;
    }
    if constant == 0.0 && !terms.may_be_nothing {
        let [lower, upper] = extent.levels().unwrap_or([0.0; 2]);
        problems
            .error(
                place,
                format!("`{key}` is zero in all the soil of `{name}`"),
            )
            .help(format!(
                "its soil lies from y = {} m to {} m: give it a value there",
                number(lower),
                number(upper)
            ));
        return None;
    }
    Some(Property {
        constant,
        profile: Some(profile),
    })
}

/// The profile that a table states.
fn stated(
    value: &Node,
    key: &str,
    extent: Extent<'_>,
    problems: &mut Problems,
) -> Result<Profile, Wrong> {
    let by_gradient = ["at_top", "gradient", "from"];
    let by_levels = ["levels", "values"];
    let in_plane = ["x", "y", "rows"];
    let has = |keys: &[&'static str]| keys.iter().copied().find(|key| value.get(key).is_some());
    let (first, other) = (has(&by_gradient), has(&by_levels));
    let plane = has(&in_plane);
    let forms = [first, other, plane].into_iter().flatten();
    let mut forms = forms.collect::<Vec<_>>().into_iter();
    if let (Some(first), Some(other)) = (forms.next(), forms.next()) {
        problems
            .error(
                value.place_at(other),
                format!("`{key}` is stated by `{first}` and by `{other}`"),
            )
            .help("keep at_top and gradient, or levels and values, or a raster");
        return Err(Wrong);
    }
    if plane.is_some() {
        return raster(value, key, extent, problems);
    }
    let needed = if other.is_some() {
        by_levels
    } else {
        ["at_top", "gradient"]
    };
    for needed in needed {
        if value.get(needed).is_none() {
            problems
                .error(value.place, format!("`{key}` has no `{needed}`"))
                .help(
                    "write { at_top = ..., gradient = ... }, or { levels = [...], values = [...] }",
                );
            return Err(Wrong);
        }
    }
    if other.is_some() {
        return table(value, key, problems);
    }
    let top = extent.levels().map_or(0.0, |[_, upper]| upper);
    Ok(Profile::Gradient {
        from: value.optional_number("from")?.unwrap_or(top),
        at_top: value.number_at("at_top").ok_or(Wrong)?,
        gradient: value.number_at("gradient").ok_or(Wrong)?,
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

/// Points in the plane.
fn raster(
    value: &Node,
    key: &str,
    extent: Extent<'_>,
    problems: &mut Problems,
) -> Result<Profile, Wrong> {
    let help = "write x = [...], y = [...] and rows = [[...], ...] with a list for every y, or raster = \"cu.csv\"";
    let list = |name: &'static str| value.get(name);
    if list("rows").is_some_and(Node::is_invalid) {
        return Err(Wrong);
    }
    let (Some(_), Some(_), Some(rows)) = (list("x"), list("y"), list("rows")) else {
        let message = format!("`{key}` needs all of `x`, `y` and `rows`");
        problems.error(value.place, message).help(help);
        return Err(Wrong);
    };
    let (x, y) = (numbers(list("x"))?, numbers(list("y"))?);
    let rows = rows.items().iter().map(|row| numbers(Some(row)));
    let values = rows.collect::<Result<Vec<_>, _>>()?;
    if values.len() != y.len() || values.iter().any(|row| row.len() != x.len()) {
        let message = format!(
            "the rows of `{key}` are not those of {} y and {} x",
            y.len(),
            x.len()
        );
        problems.error(value.place_at("rows"), message).help(help);
        return Err(Wrong);
    }
    for (name, lines) in [("x", &x), ("y", &y)] {
        if let Some(at) = lines.windows(2).position(|pair| pair[0] >= pair[1]) {
            let message = format!(
                "the {name} of `{key}` do not go up: {} m after {} m",
                number(lines[at + 1]),
                number(lines[at])
            );
            problems
                .error(value.place_at(name), message)
                .help("write them upwards, each once");
            return Err(Wrong);
        }
    }
    let raster = Raster { x, y, values };
    let corners = extent.polygons().into_iter().flatten().copied();
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
                value.place,
                format!(
                    "`{key}` has no value at {}, in the soil of `{}`",
                    point(at),
                    clip(extent.name, 40)
                ),
            )
            .help(format!(
                "its points reach from x = {}, and from y = {}",
                ends(&raster.x),
                ends(&raster.y)
            ))
            .help("soil may lie beyond them by half the distance of two points");
        return Err(Wrong);
    }
    Ok(Profile::Raster(raster))
}

fn table(value: &Node, key: &str, problems: &mut Problems) -> Result<Profile, Wrong> {
    let (levels, values) = (numbers(value.get("levels"))?, numbers(value.get("values"))?);
    if levels.len() != values.len() {
        problems
            .error(
                value.place_at("values"),
                format!(
                    "`{key}` has {} levels and {} values",
                    levels.len(),
                    values.len()
                ),
            )
            .help("one value for each level");
        return Err(Wrong);
    }
    let goes_up = levels.first() < levels.last();
    let wrong = levels.windows(2).position(|pair| {
        pair[0]
            .partial_cmp(&pair[1])
            .is_none_or(|order| order.is_lt() != goes_up || order.is_eq())
    });
    if let Some(at) = wrong {
        let place = value.items_at("levels")[at + 1].place;
        problems
            .error(
                place,
                format!(
                    "the levels of `{key}` go up and down: {} m after {} m",
                    number(levels[at + 1]),
                    number(levels[at])
                ),
            )
            .help("write them all upwards or all downwards, each once; a jump needs two levels close together");
        return Err(Wrong);
    }
    let mut rows: Vec<[f64; 2]> = std::iter::zip(levels, values)
        .map(|(level, value)| [level, value])
        .collect();
    if !goes_up {
        rows.reverse();
    }
    Ok(Profile::Table(rows))
}
