//! Rigid bodies in space.

use std::sync::Arc;

use super::grid::Frame;
use super::rigid::interface;
use super::surfaces::closed_surface;
use crate::case::{Material, RigidInterface, RigidPart, RigidSolid};
use crate::input::diagnostic::Problems;
use crate::input::text::{clip, number};
use crate::input::tree::Node;

/// A body is at least so many cells thick.
const LEAST_CELLS: f64 = 2.0;

/// The rigid bodies.
pub(super) fn rigid(
    tree: &Node,
    frame: Option<&Frame<3>>,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Vec<Option<RigidPart<3>>> {
    let nodes = tree.items_at("rigid").iter();
    let parts: Vec<_> = nodes
        .map(|node| part(node, frame, materials, problems))
        .collect();
    let following = tree.items_at("rigid").iter();
    let mut following = following.filter(|node| node.flag_at("grid_follows") == Some(true));
    if let (Some(_), Some(second)) = (following.next(), following.next()) {
        problems
            .error(
                second.place_at("grid_follows"),
                "the grid follows something else already",
            )
            .help("it can follow one rigid body");
    }
    parts
}

fn part(
    node: &Node,
    frame: Option<&Frame<3>>,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<RigidPart<3>> {
    let name = node.text_at("name")?;
    let shape = shape(node, &clip(name, 40), problems);
    let whole = interface(node, None, materials, problems);
    let shape = shape?;
    let interfaces = all_sides(node, whole?, shape.sides(), materials, problems);
    let part = RigidPart {
        name: name.to_owned(),
        reference: shape.reference(),
        shape: Arc::new(shape),
        interfaces: interfaces?,
        stiffness: node.number_at("stiffness")?,
        rounding: node.number_at("rounding")?,
        weight: node.number_at("weight")?,
        force_factor: node.number_at("force_factor")?,
        grid_follows: node.flag_at("grid_follows")?,
        from_start: node.flag_at("from_start")?,
        most_penetration: node.number_at("most_penetration")?,
    };
    if let Some(frame) = frame {
        in_grid(node, &part, frame, problems);
    }
    Some(part)
}

fn shape(node: &Node, name: &str, problems: &mut Problems) -> Option<RigidSolid> {
    let kind = node.text_at("type")?;
    Some(match kind {
        "box" => {
            let (a, b) = (node.point_at::<3>("from")?, node.point_at::<3>("to")?);
            let lower: [f64; 3] = std::array::from_fn(|axis| a[axis].min(b[axis]));
            let upper: [f64; 3] = std::array::from_fn(|axis| a[axis].max(b[axis]));
            let largest = a
                .into_iter()
                .chain(b)
                .fold(0.0, |most: f64, x| most.max(x.abs()));
            if (0..3).any(|axis| upper[axis] - lower[axis] <= 1e-9 * largest) {
                problems.error(
                    node.place_at("to"),
                    format!("the rigid body `{name}` has no volume"),
                );
                return None;
            }
            RigidSolid::Cuboid(lower, upper)
        }
        "cylinder" => RigidSolid::Cylinder {
            axis: match node.text_at("axis")? {
                "x" => 0,
                "y" => 1,
                _ => 2,
            },
            middle: node.point_at("middle")?,
            radius: node.number_at("radius")?,
            half_length: 0.5 * node.number_at("length")?,
        },
        "sphere" => RigidSolid::Sphere {
            centre: node.point_at("centre")?,
            radius: node.number_at("radius")?,
        },
        "cone" => RigidSolid::Cone {
            tip: node.point_at("tip")?,
            radius: node.number_at("radius")?,
            height: node.number_at("height")?,
            shaft: node.number_at("shaft")?,
        },
        "surface" => {
            let who = format!("rigid body `{name}`");
            RigidSolid::Surface(closed_surface(node.get("surface")?, &who, problems)?)
        }
        _ => {
            problems
                .error(
                    node.place_at("type"),
                    format!("a {kind} is a shape of the plane"),
                )
                .help("shapes in space: box, cylinder, sphere, cone, surface");
            return None;
        }
    })
}

/// The interface of each side.
fn all_sides(
    node: &Node,
    whole: RigidInterface,
    names: &[&str],
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<Vec<RigidInterface>> {
    let mut interfaces = vec![whole; names.len()];
    for own in node.items_at("sides") {
        let value = own.get("side")?;
        let side = match value.text() {
            Some(name) => names.iter().position(|known| *known == name),
            None => value.count()?.checked_sub(1),
        };
        let Some(side) = side.filter(|side| *side < names.len()) else {
            problems
                .error(value.place, "this rigid body has no such side")
                .help(format!(
                    "sides here: {}, or 1 to {}",
                    names.join(", "),
                    names.len()
                ));
            return None;
        };
        interfaces[side] = interface(own, Some(whole), materials, problems)?;
    }
    Some(interfaces)
}

/// Refuses a body that lies outside the grid, is too thin for it, or cannot be made.
fn in_grid(node: &Node, part: &RigidPart<3>, frame: &Frame<3>, problems: &mut Problems) {
    let name = clip(&part.name, 40);
    let (lower, upper) = part.bounds();
    if (0..3).any(|k| upper[k] <= frame.lower[k] || lower[k] >= frame.upper[k]) {
        problems
            .error(
                node.place_at("name"),
                format!("the rigid body `{name}` lies outside the grid domain"),
            )
            .help("soil is only within the domain: move the body, or extend [grid] domain");
        return;
    }
    let axes = frame.axes.iter().enumerate();
    let cell = axes
        .map(|(axis, own)| own.smallest_between(lower[axis], upper[axis]))
        .fold(f64::INFINITY, f64::min);
    let thickness = (0..3)
        .map(|axis| upper[axis] - lower[axis])
        .fold(f64::INFINITY, f64::min);
    if thickness < LEAST_CELLS * cell * (1.0 - 1e-9) {
        problems
            .error(
                node.place_at("name"),
                format!(
                    "the rigid body `{name}` is {} m thick, thinner than two cells of {} m",
                    number(thickness),
                    number(cell)
                ),
            )
            .help("soil on both sides of it would share nodes of the grid, and stick together through it")
            .help(format!(
                "make it {} m thick, or the cells there smaller",
                number(LEAST_CELLS * cell)
            ));
    }
    if let Err(error) = part.surface(cell) {
        problems
            .error(
                node.place_at("name"),
                format!("the rigid body `{name}` cannot be made: {error}"),
            )
            .help("a smaller rounding, or smaller cells there, may help");
    }
    let level = frame.axes[2].place(lower[2]);
    if part.grid_follows && ((level - level.round()).abs() > 1e-6 || level.round() < 1.0) {
        problems
            .error(
                node.place_at("grid_follows"),
                format!(
                    "the lowest place of the rigid body `{name}` at z = {} m is not on a plane of the grid",
                    number(lower[2])
                ),
            )
            .help(format!(
                "add lines = {{ z = [\"{} m\"] }} to [grid]",
                number(lower[2])
            ));
    }
}
