//! Bodies in space: what their keys say, made into solids.

use igimp_geometry::region::{Cover, Part, Region};
use igimp_geometry::solid::{Cylinder, Difference, Prism, Solid, Sphere};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::bodies::Body;
use igimp_schema::schema::solids::{Axis, Cuboid, Shape};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::read::At;

use super::corners;
use crate::build::bodies::surfaces::{Label, closed_surface, ground};

/// Where two solids are sought to overlap, the box around what they may share is cut so many times into eight.
const DEPTH: u32 = 5;
/// Solids overlap in a box if they have more than this share of it together \[-\].
const SHARED: f64 = 1.01;

/// The solid of a body, less what is taken out of it.
pub(crate) fn solid(body: &At<Body>, problems: &mut Problems) -> Option<Solid> {
    let name = &clip(&body.name, 40);
    let label = Label { name, taken: None };
    let whole = body.shape.as_ref().ok();
    let whole = whole.and_then(|shape| self::shape(shape, body.place, &label, problems));
    let minus_keys = body.minus.iter().flatten().flat_map(|minus| minus.iter());
    let mut taken = Vec::new();
    for (cut, number) in std::iter::zip(minus_keys.clone(), 1..) {
        let label = Label {
            name,
            taken: Some(number),
        };
        let cut = cut.as_ref().ok();
        taken.push(cut.and_then(|cut| shape(&cut.shape, cut.place, &label, problems)));
    }
    let (of, minus) = (whole?, taken.into_iter().collect::<Option<Vec<_>>>()?);
    if minus.is_empty() {
        return Some(of);
    }
    let of = Box::new(of);
    for (taken, cut) in std::iter::zip(&minus, minus_keys.flatten()) {
        let (a, b) = (of.bounds(), taken.bounds());
        if (0..3).any(|axis| a.1[axis] <= b.0[axis] || b.1[axis] <= a.0[axis]) {
            problems
                .warning(cut.place, format!("nothing of this lies in {label}"))
                .help("it takes nothing out");
        }
    }
    Some(Solid::Difference(Difference { of, minus }))
}

/// The solid of the one key that says a shape.
fn shape(shape: &Shape, place: Place, label: &Label<'_>, problems: &mut Problems) -> Option<Solid> {
    let stated = [
        shape.cuboid.as_ref().map(|at| ("box", at.place)),
        shape.polygon.as_ref().map(|at| ("polygon", at.place)),
        shape.plan.as_ref().map(|at| ("plan", at.place)),
        shape.cylinder.as_ref().map(|at| ("cylinder", at.place)),
        shape.sphere.as_ref().map(|at| ("sphere", at.place)),
        shape.surface.as_ref().map(|at| ("surface", at.place)),
    ];
    let stated: Vec<(&str, Place)> = stated.into_iter().flatten().collect();
    let [(key, key_place)] = stated[..] else {
        let (message, help) = if stated.is_empty() {
            (
                format!("{label} has no shape"),
                "write one of box, polygon (with across), plan (with between), cylinder, sphere and surface",
            )
        } else {
            let keys: Vec<&str> = stated.iter().map(|(key, _)| *key).collect();
            (
                format!("{label} has several shapes: {}", keys.join(", ")),
                "keep one of them; what is taken out of a body stands in `minus`",
            )
        };
        problems.error(place, message).help(help);
        return None;
    };
    let beside = [
        (
            "across",
            "polygon",
            shape.across.as_ref().map(|at| at.place),
            "say from where to where on y it reaches, as in across = [\"0 m\", \"1 m\"]",
        ),
        (
            "between",
            "plan",
            shape.between.as_ref().map(|at| at.place),
            "say its bottom and top, as in between = [\"0 m\", { raster = \"ground.asc\", unit = \"m\" }]",
        ),
    ];
    for (needed, by, stated, help) in beside {
        match (stated, key == by) {
            (None, true) => {
                let message = format!("the {by} of {label} needs `{needed}`");
                problems.error(key_place, message).help(help);
                return None;
            }
            (Some(extra), false) => {
                problems
                    .error(extra, format!("`{needed}` goes with `{by}`"))
                    .help(format!("{label} is a {key}"));
                return None;
            }
            _ => {}
        }
    }
    solid_of(shape, label, problems)
}

/// The solid of a shape of which one key is stated.
fn solid_of(shape: &Shape, label: &Label<'_>, problems: &mut Problems) -> Option<Solid> {
    if let Some(block) = &shape.cuboid {
        return cuboid(block, label, problems);
    }
    if let (Some(polygon), Some(across)) = (&shape.polygon, &shape.across) {
        let polygon = corners(polygon, label.name, problems);
        let between = ascending(across, label, problems);
        return Some(Solid::Prism(Prism::new(polygon?, 1, between?)));
    }
    if let (Some(plan), Some(between)) = (&shape.plan, &shape.between) {
        return ground(plan, between, label, problems);
    }
    if let Some(cylinder) = &shape.cylinder {
        return Some(Solid::Cylinder(Cylinder {
            between: ascending(&cylinder.between, label, problems)?,
            axis: match *cylinder.axis {
                Axis::X => 0,
                Axis::Y => 1,
                Axis::Z => 2,
            },
            centre: *cylinder.centre,
            radius: *cylinder.radius,
        }));
    }
    if let Some(sphere) = &shape.sphere {
        return Some(Solid::Sphere(Sphere {
            centre: *sphere.centre,
            radius: *sphere.radius,
        }));
    }
    let surface = shape.surface.as_ref()?;
    closed_surface(surface, label, problems).map(Solid::Surface)
}

fn cuboid(block: &At<Cuboid>, label: &Label<'_>, problems: &mut Problems) -> Option<Solid> {
    let (a, b) = (*block.from, *block.to);
    let lower: [f64; 3] = std::array::from_fn(|axis| a[axis].min(b[axis]));
    let upper: [f64; 3] = std::array::from_fn(|axis| a[axis].max(b[axis]));
    if let Some(axis) = (0..3).find(|&axis| lower[axis] >= upper[axis]) {
        let axis = ["x", "y", "z"][axis];
        problems
            .error(
                block.place,
                format!("the box of {label} has no extent along {axis}"),
            )
            .help("its two corners are opposite ones");
        return None;
    }
    Some(Solid::Cuboid(lower, upper))
}

/// Two places in their order.
fn ascending(ends: &At<[f64; 2]>, name: &Label<'_>, problems: &mut Problems) -> Option<[f64; 2]> {
    let [from, to] = **ends;
    if from < to {
        return Some([from, to]);
    }
    problems
        .error(
            ends.place,
            format!("{name} reaches from {} m to {} m", number(from), number(to)),
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
