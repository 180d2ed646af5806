//! Properties of materials that vary with the level.

use crate::case::{BodyPart, Profile};
use crate::input::diagnostic::Problems;
use crate::input::text::{clip, number};
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
    /// The lowest and the highest level \[m\]; none: no body is of this material.
    levels: Option<[f64; 2]>,
}

impl<'a> Extent<'a> {
    /// That of the material of a number.
    pub(super) fn of(name: &'a str, material: usize, bodies: &[Option<BodyPart>]) -> Self {
        let own = bodies.iter().flatten();
        let own = own.filter(|body| body.material == material);
        let levels = own.map(|body| {
            let (lower, upper) = bounding_box(&body.polygon);
            [lower[1], upper[1]]
        });
        Self {
            name,
            levels: levels.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]),
        }
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
    let [lower, upper] = extent.levels.unwrap_or_else(|| match &profile {
        Profile::Gradient { from, .. } => [*from; 2],
        Profile::Table(rows) => [rows[0][0], rows[rows.len() - 1][0]],
    });
    let [least, greatest] = profile.extremes(lower, upper);
    let constant = profile.at(greatest);
    let name = clip(extent.name, 40);
    let in_words = |level: f64| {
        format!(
            "{} k{} at y = {} m",
            number(profile.at(level) / 1e3),
            terms.unit,
            number(level)
        )
    };
    let place = match profile {
        Profile::Gradient { .. } => value.place_at("gradient"),
        Profile::Table(_) => value.place_at("values"),
    };
    if !constant.is_finite() || profile.at(least) < 0.0 {
        problems
            .error(
                place,
                format!("`{key}` is {}, in the soil of `{name}`", in_words(least)),
            )
            .help("a smaller gradient, or `levels` and `values` that stay positive");
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
    let has = |keys: &[&'static str]| keys.iter().copied().find(|key| value.get(key).is_some());
    let (first, other) = (has(&by_gradient), has(&by_levels));
    if let (Some(first), Some(other)) = (first, other) {
        problems
            .error(
                value.place_at(other),
                format!("`{key}` is stated by `{first}` and by `{other}`"),
            )
            .help("keep at_top and gradient, or levels and values");
        return Err(Wrong);
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
    let top = extent.levels.map_or(0.0, |[_, upper]| upper);
    Ok(Profile::Gradient {
        from: value.optional_number("from")?.unwrap_or(top),
        at_top: value.number_at("at_top").ok_or(Wrong)?,
        gradient: value.number_at("gradient").ok_or(Wrong)?,
    })
}

fn table(value: &Node, key: &str, problems: &mut Problems) -> Result<Profile, Wrong> {
    let numbers = |list: &'static str| -> Result<Vec<f64>, Wrong> {
        let list = value.get(list).filter(|list| !list.is_invalid());
        let items = list.ok_or(Wrong)?.items().iter();
        items.map(|item| item.number().ok_or(Wrong)).collect()
    };
    let (levels, values) = (numbers("levels")?, numbers("values")?);
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
