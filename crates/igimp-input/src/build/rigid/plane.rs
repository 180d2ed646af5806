//! Rigid bodies in plane strain: their shapes, and whether they have a place beside the soil.

use std::sync::Arc;

use igimp_geometry::polygon::area_and_centroid;
use igimp_model::{Load, LoadKind, Material, RigidPart, RigidShape};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, point};
use igimp_schema::tree::Node;

use super::{Basis, Sides, follow_once, part_of};
use crate::build::bodies::sequence::Sequence;
use crate::build::bodies::site::Site;
use crate::geometry::{distinct, overlap, self_crossing};

/// Corners of a circle where it is looked at as a polygon.
const POINTS_OF_CIRCLE: usize = 90;

/// What rigid bodies are held against.
pub(crate) struct Around<'a> {
    pub(crate) site: &'a Site,
    pub(crate) materials: &'a [Option<Material>],
    pub(crate) loads: &'a [Option<Load<2>>],
    pub(crate) tree: &'a Node,
    pub(crate) sequence: &'a Sequence,
}

/// The rigid bodies.
pub(crate) fn rigid(
    tree: &Node,
    around: &Around<'_>,
    problems: &mut Problems,
) -> Vec<Option<RigidPart<2>>> {
    let nodes = tree.items_at("rigid");
    let parts: Vec<_> = nodes
        .iter()
        .map(|node| part(node, around, problems))
        .collect();
    let is_footing = |load: &Load<2>| matches!(load.kind, LoadKind::RigidFooting { .. });
    let is_taken = around.loads.iter().flatten().any(is_footing);
    let help = "it can follow one rigid body, or one rigid footing";
    follow_once(nodes, (is_taken, help), problems);
    parts
}

fn part(node: &Node, around: &Around<'_>, problems: &mut Problems) -> Option<RigidPart<2>> {
    let name = node.text_at("name")?;
    let shown = clip(name, 40);
    let shape = shape(node, &shown, around.site, problems);
    let stated = match node.get("reference") {
        None => None,
        Some(value) => Some(value.pair()?),
    };
    if let (Some(RigidShape::Circle { .. }), Some(_)) = (&shape, stated) {
        problems
            .error(
                node.place_at("reference"),
                "the reference point of a circle is its centre",
            )
            .help("remove reference, or use a polygon");
    }
    let basis = shape.map(|shape| Basis {
        reference: stated.unwrap_or_else(|| reference(node, &shape)),
        sides: sides(node, &shape),
        thickness: thickness(&shape),
        shape: Arc::new(shape),
    });
    let around_it = (around.site.frame.as_ref(), around.materials);
    let part = part_of(node, basis, around_it, problems)?;
    beside_soil(node, &part, around, problems);
    Some(part)
}

/// The sides, and the names that they have.
fn sides(node: &Node, shape: &RigidShape) -> Sides {
    let count = match shape {
        RigidShape::Polygon(corners) => corners.len(),
        RigidShape::Circle { .. } => 1,
    };
    let names: &[&str] = match node.text_at("type") {
        Some("rectangle") => &["bottom", "right", "top", "left"],
        Some("wall") => &["face"],
        _ => &[],
    };
    Sides { count, names }
}

fn shape(node: &Node, name: &str, site: &Site, problems: &mut Problems) -> Option<RigidShape> {
    let mut flat = |place| {
        problems.error(place, format!("the rigid body `{name}` has no area"));
        None
    };
    Some(match node.text_at("type")? {
        "rectangle" => {
            let (a, b) = (node.pair_at("from")?, node.pair_at("to")?);
            let [left, bottom] = [a[0].min(b[0]), a[1].min(b[1])];
            let [right, top] = [a[0].max(b[0]), a[1].max(b[1])];
            if right - left <= site.round_off || top - bottom <= site.round_off {
                return flat(node.place_at("to"));
            }
            RigidShape::Polygon(vec![
                [left, bottom],
                [right, bottom],
                [right, top],
                [left, top],
            ])
        }
        "circle" => RigidShape::Circle {
            centre: node.pair_at("centre")?,
            radius: node.number_at("radius")?,
        },
        "wall" => {
            let (from, to) = (node.pair_at("from")?, node.pair_at("to")?);
            let thickness = node.number_at("thickness")?;
            let along = [to[0] - from[0], to[1] - from[1]];
            let length = along[0].hypot(along[1]);
            if length <= site.round_off {
                return flat(node.place_at("to"));
            }
            let back = [-along[1], along[0]].map(|x| x / length * thickness);
            let behind = |at: [f64; 2]| [at[0] + back[0], at[1] + back[1]];
            RigidShape::Polygon(vec![from, to, behind(to), behind(from)])
        }
        _ => {
            let corners: Option<Vec<_>> = node.items_at("corners").iter().map(Node::pair).collect();
            let corners = distinct(&corners?, site.round_off);
            if corners.len() < 3 {
                return flat(node.place_at("corners"));
            }
            if let Some(at) = self_crossing(&corners, site.round_off) {
                problems.error(
                    node.place_at("corners"),
                    format!("the rigid body `{name}` crosses itself at {}", point(at)),
                );
                return None;
            }
            if area_and_centroid(&corners).0 == 0.0 {
                return flat(node.place_at("corners"));
            }
            RigidShape::Polygon(corners)
        }
    })
}

/// The point that displacement and forces are told of where the file does not say.
fn reference(node: &Node, shape: &RigidShape) -> [f64; 2] {
    let middle = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    match shape {
        RigidShape::Circle { centre, .. } => *centre,
        RigidShape::Polygon(corners) => {
            if let Some("rectangle" | "wall") = node.text_at("type") {
                middle(corners[0], corners[1])
            } else {
                let (lower, upper) = igimp_geometry::polygon::bounding_box(corners);
                middle(lower, upper)
            }
        }
    }
}

/// The smallest distance of two parallel lines that hold a body between them \[m\].
fn thickness(shape: &RigidShape) -> f64 {
    let corners = match shape {
        RigidShape::Circle { radius, .. } => return 2.0 * radius,
        RigidShape::Polygon(corners) => corners,
    };
    let n = corners.len();
    let mut least = f64::INFINITY;
    // The narrowest strip runs along an edge of the hull: a line between two corners.
    for a in 0..n {
        for b in a + 1..n {
            let along = [corners[b][0] - corners[a][0], corners[b][1] - corners[a][1]];
            let length = along[0].hypot(along[1]);
            if length == 0.0 || n > MOST_PAIRED && b != a + 1 {
                continue;
            }
            let heights = corners.iter().map(|corner| {
                (along[0] * (corner[1] - corners[a][1]) - along[1] * (corner[0] - corners[a][0]))
                    / length
            });
            let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(low, high), height| {
                (low.min(height), high.max(height))
            });
            least = least.min(high - low);
        }
    }
    least
}

/// Corners up to which every pair is looked at for the thickness of a body.
const MOST_PAIRED: usize = 100;

/// Refuses a body that overlaps soil as it starts, or that is placed while it is there.
fn beside_soil(node: &Node, part: &RigidPart<2>, around: &Around<'_>, problems: &mut Problems) {
    let Around { site, sequence, .. } = around;
    let outline = part.outline(POINTS_OF_CIRCLE);
    let names = |stage: &Node| {
        let mut moved = stage.items_at("bodies").iter();
        moved.any(|own| own.text_at("body") == Some(&part.name))
    };
    let first = around.tree.items_at("stages").iter().position(names);
    let (before, after) = match first {
        Some(stage) if !part.from_start => (sequence.before(stage), &sequence.ends[stage..]),
        _ => (&sequence.start, &sequence.ends[..]),
    };
    let is_there = |body: usize| {
        let mut scenes = std::iter::once(before).chain(after);
        !site.is_complete || scenes.any(|scene| scene.present[body])
    };
    let found = (site.polygons.iter().enumerate())
        .filter(|(body, _)| is_there(*body))
        .find_map(|(_, polygon)| overlap(polygon, &outline, site.round_off));
    if let Some(at) = found {
        problems
            .error(
                node.place_at("name"),
                format!(
                    "the rigid body `{}` overlaps soil at {}",
                    clip(&part.name, 40),
                    point(at)
                ),
            )
            .help(
                "leave its place free in the polygons of [[bodies]], or let it start beside them",
            );
    }
}
