//! Bodies in space: what their keys say, made into solids.

use igimp_geometry::region::{Cover, Part, Region};
use igimp_geometry::solid::{Cylinder, Difference, Prism, Solid, Sphere};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Node;

use super::corners;
use crate::build::bodies::surfaces::{Who, closed_surface, ground};

/// The keys that say a shape.
const SHAPES: [&str; 6] = ["box", "polygon", "plan", "cylinder", "sphere", "surface"];
/// Where two solids are sought to overlap, the box around what they may share is cut so many times into eight.
const DEPTH: u32 = 5;
/// Solids overlap in a box if they have more than this share of it together \[-\].
const SHARED: f64 = 1.01;

/// The solid of a body, less what is taken out of it.
pub(crate) fn solid(node: &Node, name: &str, problems: &mut Problems) -> Option<Solid> {
    let name = &clip(name, 40);
    let who = Who { name, taken: None };
    let own = shape(node, &who, problems);
    let mut taken = Vec::new();
    for (node, number) in std::iter::zip(node.items_at("minus"), 1..) {
        let taken_out = Who {
            name,
            taken: Some(number),
        };
        taken.push(shape(node, &taken_out, problems));
    }
    let (of, minus) = (own?, taken.into_iter().collect::<Option<Vec<_>>>()?);
    if minus.is_empty() {
        return Some(of);
    }
    let of = Box::new(of);
    for (taken, node) in std::iter::zip(&minus, node.items_at("minus")) {
        let (a, b) = (of.bounds(), taken.bounds());
        if (0..3).any(|axis| a.1[axis] <= b.0[axis] || b.1[axis] <= a.0[axis]) {
            problems
                .warning(node.place, format!("nothing of this lies in {who}"))
                .help("it takes nothing out");
        }
    }
    Some(Solid::Difference(Difference { of, minus }))
}

/// The solid of the one key that says a shape.
fn shape(node: &Node, who: &Who<'_>, problems: &mut Problems) -> Option<Solid> {
    let stated: Vec<&str> = (SHAPES.into_iter())
        .filter(|key| node.get(key).is_some())
        .collect();
    let [key] = stated[..] else {
        let (message, help) = match stated[..] {
            [] => (
                format!("{who} has no shape"),
                "write one of box, polygon (with across), plan (with between), cylinder, sphere and surface",
            ),
            _ => (
                format!("{who} has several shapes: {}", stated.join(", ")),
                "keep one of them; what is taken out of a body stands in `minus`",
            ),
        };
        problems.error(node.place, message).help(help);
        return None;
    };
    for (needed, by) in [("across", "polygon"), ("between", "plan")] {
        match (node.get(needed), key == by) {
            (None, true) => {
                let message = format!("the {by} of {who} needs `{needed}`");
                let help = match needed {
                    "across" => {
                        "say from where to where on y it reaches, as in across = [\"0 m\", \"1 m\"]"
                    }
                    _ => {
                        "say its bottom and top, as in between = [\"0 m\", { raster = \"ground.asc\", unit = \"m\" }]"
                    }
                };
                problems.error(node.place_at(by), message).help(help);
                return None;
            }
            (Some(extra), false) => {
                problems
                    .error(extra.place, format!("`{needed}` goes with `{by}`"))
                    .help(format!("{who} is a {key}"));
                return None;
            }
            _ => {}
        }
    }
    let value = node.get(key).filter(|value| !value.is_invalid())?;
    match key {
        "box" => cuboid(value, who, problems),
        "polygon" => {
            let polygon = corners(value, who.name, problems);
            let between = ascending(node.get("across")?, who, problems);
            Some(Solid::Prism(Prism::new(polygon?, 1, between?)))
        }
        "plan" => ground(value, node.get("between")?, who, problems),
        "cylinder" => {
            let between = ascending(value.get("between")?, who, problems);
            let axis = ["x", "y", "z"];
            let axis = axis
                .iter()
                .position(|name| value.text_at("axis") == Some(name))?;
            Some(Solid::Cylinder(Cylinder {
                axis,
                centre: value.pair_at("centre")?,
                radius: value.number_at("radius")?,
                between: between?,
            }))
        }
        "sphere" => Some(Solid::Sphere(Sphere {
            centre: value.point_at("centre")?,
            radius: value.number_at("radius")?,
        })),
        _ => closed_surface(value, who, problems).map(Solid::Surface),
    }
}

fn cuboid(node: &Node, who: &Who<'_>, problems: &mut Problems) -> Option<Solid> {
    let (a, b) = (node.point_at::<3>("from")?, node.point_at::<3>("to")?);
    let lower: [f64; 3] = std::array::from_fn(|axis| a[axis].min(b[axis]));
    let upper: [f64; 3] = std::array::from_fn(|axis| a[axis].max(b[axis]));
    if let Some(axis) = (0..3).find(|&axis| lower[axis] >= upper[axis]) {
        let axis = ["x", "y", "z"][axis];
        problems
            .error(
                node.place,
                format!("the box of {who} has no extent along {axis}"),
            )
            .help("its two corners are opposite ones");
        return None;
    }
    Some(Solid::Cuboid(lower, upper))
}

/// Two places in their order.
fn ascending(node: &Node, who: &Who<'_>, problems: &mut Problems) -> Option<[f64; 2]> {
    let [from, to] = node.pair()?;
    if from < to {
        return Some([from, to]);
    }
    problems
        .error(
            node.place,
            format!("{who} reaches from {} m to {} m", number(from), number(to)),
        )
        .help("the first place is the lower one");
    None
}

/// A place where two solids overlap, if they share more than their boundaries.
pub(crate) fn overlap(a: &dyn Region<3>, b: &dyn Region<3>) -> Option<[f64; 3]> {
    let ((a_low, a_high), (b_low, b_high)) = (a.bounds(), b.bounds());
    let lower: [f64; 3] = std::array::from_fn(|axis| a_low[axis].max(b_low[axis]));
    let upper: [f64; 3] = std::array::from_fn(|axis| a_high[axis].min(b_high[axis]));
    let has_volume = (0..3).all(|axis| lower[axis] < upper[axis]);
    has_volume
        .then(|| overlap_in(a, b, lower, upper, DEPTH))
        .flatten()
}

fn overlap_in(
    a: &dyn Region<3>,
    b: &dyn Region<3>,
    lower: [f64; 3],
    upper: [f64; 3],
    depth: u32,
) -> Option<[f64; 3]> {
    let covers = [a.cover(lower, upper), b.cover(lower, upper)];
    if covers.contains(&Cover::Nothing) {
        return None;
    }
    let whole = Part::whole(lower, upper);
    if covers == [Cover::Whole; 2] {
        return Some(whole.centroid);
    }
    let parts = [a, b].map(|region| region.within(lower, upper));
    if parts[0].volume + parts[1].volume > SHARED * whole.volume {
        let of_both =
            [0, 1, 2].map(|axis| 0.5 * (parts[0].centroid[axis] + parts[1].centroid[axis]));
        return Some(of_both);
    }
    if depth == 0 || parts.iter().any(|part| part.volume <= 0.0) {
        return None;
    }
    // Both may be thin and yet share a place.
    (0..8).find_map(|eighth| {
        let middle = whole.centroid;
        let is_upper = |axis: usize| eighth >> axis & 1 == 1;
        let from = std::array::from_fn(|axis| {
            if is_upper(axis) {
                middle[axis]
            } else {
                lower[axis]
            }
        });
        let to = std::array::from_fn(|axis| {
            if is_upper(axis) {
                upper[axis]
            } else {
                middle[axis]
            }
        });
        overlap_in(a, b, from, to, depth - 1)
    })
}
