//! Rigid bodies: their shapes, what their sides are like, and whether they have a place.

use std::sync::Arc;

use igimp_assembly::{SurfaceError, Tension};

use super::AllNames;
use super::grid::Frame;
use super::sequence::Sequence;
use super::site::Site;
use super::stages::Context;
use crate::case::{
    Adhesion, COMPONENTS, Load, LoadKind, Material, RigidDrive, RigidInterface, RigidMove,
    RigidPart, RigidShape, RigidShear, StageKind, Strength,
};
use crate::input::diagnostic::Problems;
use crate::input::geometry::{distinct, overlap, self_crossing};
use crate::input::text::{clip, number, point};
use crate::input::tree::{Node, Wrong};
use crate::polygon::area_and_centroid;

/// A body is at least so many cells thick.
const LEAST_CELLS: f64 = 2.0;
/// Corners of a circle where it is looked at as a polygon.
const POINTS_OF_CIRCLE: usize = 90;

/// What rigid bodies are held against.
pub(super) struct Around<'a> {
    pub(super) site: &'a Site,
    pub(super) materials: &'a [Option<Material>],
    pub(super) loads: &'a [Option<Load>],
    pub(super) tree: &'a Node,
    pub(super) sequence: &'a Sequence,
}

/// The rigid bodies.
pub(super) fn rigid(
    tree: &Node,
    around: &Around<'_>,
    problems: &mut Problems,
) -> Vec<Option<RigidPart>> {
    let nodes = tree.items_at("rigid");
    let parts: Vec<_> = nodes
        .iter()
        .map(|node| part(node, around, problems))
        .collect();
    follow_once(nodes, around, problems);
    parts
}

fn part(node: &Node, around: &Around<'_>, problems: &mut Problems) -> Option<RigidPart> {
    let name = node.text_at("name")?;
    let shown = clip(name, 40);
    let shape = shape(node, &shown, around.site, problems);
    let sides = match &shape {
        Some(RigidShape::Polygon(corners)) => corners.len(),
        _ => 1,
    };
    let whole = interface(node, None, around.materials, problems);
    let interfaces =
        whole.and_then(|whole| all_sides(node, whole, sides, around.materials, problems));
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
    let shape = shape?;
    let part = RigidPart {
        name: name.to_owned(),
        reference: stated.unwrap_or_else(|| reference(node, &shape)),
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
    if let Some(frame) = &around.site.frame {
        in_grid(node, &part, frame, problems);
    }
    beside_soil(node, &part, around, problems);
    Some(part)
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
                let (lower, upper) = crate::polygon::bounding_box(corners);
                middle(lower, upper)
            }
        }
    }
}

/// What a table says of its interface; what it does not say is that of the whole body.
pub(super) fn interface(
    node: &Node,
    whole: Option<RigidInterface>,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<RigidInterface> {
    let shear = match node.get("interface") {
        Some(value) => shear(value, materials, problems)?,
        None => whole?.shear,
    };
    let limit = node.optional_number("tension_limit").ok()?;
    if let (Some(_), Some("bonded")) = (limit, node.text_at("tension")) {
        problems
            .error(
                node.place_at("tension_limit"),
                "soil that is bonded never lets go: there is no limit",
            )
            .help("keep one of tension and tension_limit");
    }
    let tension = match (limit, node.text_at("tension")) {
        (Some(limit), _) => Tension::Limit(limit),
        (None, Some("bonded")) => Tension::Bonded,
        (None, Some(_)) => Tension::None,
        (None, None) => whole?.tension,
    };
    Some(RigidInterface { shear, tension })
}

fn shear(
    value: &Node,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<RigidShear> {
    match value.text() {
        Some("smooth") => return Some(RigidShear::Smooth),
        Some(_) => return Some(RigidShear::Rough),
        None if value.is_invalid() => return None,
        None => {}
    }
    let number = |key| value.optional_number(key).ok();
    let friction = match (number("friction")?, number("angle")?) {
        (Some(_), Some(_)) => {
            problems
                .error(
                    value.place_at("angle"),
                    "both `friction` and `angle` are given",
                )
                .help("keep one of them");
            return None;
        }
        (friction, angle) => friction.or(angle.map(f64::tan)).unwrap_or(0.0),
    };
    if !(0.0..=1e3).contains(&friction) {
        problems.error(
            value.place_at("angle"),
            "an angle of friction is less than 90 deg",
        );
        return None;
    }
    let adhesion = match (number("adhesion")?, number("adhesion_share")?) {
        (Some(_), Some(_)) => {
            problems
                .error(
                    value.place_at("adhesion_share"),
                    "both `adhesion` and `adhesion_share` are given",
                )
                .help("keep one of them");
            return None;
        }
        (None, Some(share)) => {
            for material in materials.iter().flatten() {
                if material.strength == Strength::Elastic {
                    problems.warning(
                        value.place_at("adhesion_share"),
                        format!(
                            "the material `{}` is elastic and has no strength to take a share of: no \
                             adhesion where it touches",
                            clip(&material.name, 40)
                        ),
                    );
                }
            }
            Adhesion::Share(share)
        }
        (stress, None) => Adhesion::Stress(stress.unwrap_or(0.0)),
    };
    Some(RigidShear::Limited { friction, adhesion })
}

/// The interface of each side.
fn all_sides(
    node: &Node,
    whole: RigidInterface,
    sides: usize,
    materials: &[Option<Material>],
    problems: &mut Problems,
) -> Option<Vec<RigidInterface>> {
    let mut interfaces = vec![whole; sides];
    for own in node.items_at("sides") {
        let value = own.get("side")?;
        let kind = node.text_at("type")?;
        let side = match (value.text(), kind) {
            (Some("bottom"), "rectangle") | (Some("face"), "wall") => Some(1),
            (Some("right"), "rectangle") => Some(2),
            (Some("top"), "rectangle") => Some(3),
            (Some("left"), "rectangle") => Some(4),
            (Some(_), _) => None,
            (None, _) => Some(value.count()?),
        };
        let Some(side) = side.filter(|side| (1..=sides).contains(side)) else {
            let names = match kind {
                "rectangle" => "bottom, right, top, left, or 1 to 4".to_owned(),
                "wall" => "face, or 1 to 4".to_owned(),
                _ if sides == 1 => "1".to_owned(),
                _ => format!("1 to {sides}"),
            };
            problems
                .error(value.place, format!("a {kind} has no such side"))
                .help(format!("sides here: {names}"));
            return None;
        };
        interfaces[side - 1] = interface(own, Some(whole), materials, problems)?;
    }
    Some(interfaces)
}

/// Refuses a body that lies outside the grid, or is too thin for it.
fn in_grid(node: &Node, part: &RigidPart, frame: &Frame, problems: &mut Problems) {
    let name = clip(&part.name, 40);
    let (lower, upper) = part.bounds();
    if (0..2).any(|k| upper[k] <= frame.lower[k] || lower[k] >= frame.upper[k]) {
        problems
            .error(
                node.place_at("name"),
                format!("the rigid body `{name}` lies outside the grid domain"),
            )
            .help("soil is only within the domain: move the body, or extend [grid] domain");
        return;
    }
    let [x, y] = &frame.axes;
    let cell = x
        .smallest_between(lower[0], upper[0])
        .min(y.smallest_between(lower[1], upper[1]));
    let thickness = thickness(part);
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
    match part.surface(cell) {
        Ok(_) => {}
        Err(SurfaceError::RoundedAway { side, rounding }) => {
            problems
                .error(
                    node.place_at("rounding"),
                    format!(
                        "with corners rounded by {} m nothing is left of side {} of the rigid body `{name}`",
                        number(rounding),
                        side + 1
                    ),
                )
                .help("a smaller rounding, smaller cells there, or a longer side");
        }
        Err(error) => {
            problems
                .error(
                    node.place_at("name"),
                    format!("the rigid body `{name}` cannot be made: {error}"),
                )
                .help("soil is only within the domain: the body need not reach far beyond it");
        }
    }
    let level = lower[1];
    if part.grid_follows {
        let place = y.place(level);
        if (place - place.round()).abs() > 1e-6 || place.round() < 1.0 {
            problems
                .error(
                    node.place_at("grid_follows"),
                    format!(
                        "no row of the grid lies at y = {} m, its lowest place",
                        number(level)
                    ),
                )
                .help(format!(
                    "add lines = {{ y = [\"{} m\"] }} to [grid]",
                    number(level)
                ));
        }
    }
}

/// The smallest distance of two parallel lines that hold a body between them \[m\].
fn thickness(part: &RigidPart) -> f64 {
    let Some(RigidShape::Polygon(corners)) = part.shape.in_plane() else {
        let (lower, upper) = part.bounds();
        return upper[0] - lower[0];
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
fn beside_soil(node: &Node, part: &RigidPart, around: &Around<'_>, problems: &mut Problems) {
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

/// Refuses a second thing that the grid would follow.
fn follow_once(nodes: &[Node], around: &Around<'_>, problems: &mut Problems) {
    let is_footing = |load: &Load| matches!(load.kind, LoadKind::RigidFooting { .. });
    let mut is_taken = around.loads.iter().flatten().any(is_footing);
    for node in nodes {
        if node.flag_at("grid_follows") == Some(true) && std::mem::replace(&mut is_taken, true) {
            problems
                .error(
                    node.place_at("grid_follows"),
                    "the grid follows something else already",
                )
                .help("it can follow one rigid body, or one rigid footing");
        }
    }
}

/// A stage that moves rigid bodies.
pub(super) fn stage<const D: usize>(
    context: &Context<'_, D>,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<StageKind> {
    let mut moves: Vec<RigidMove> = Vec::new();
    let mut is_right = true;
    for own in node.items_at("bodies") {
        let who = format!("stage `{name}` moves");
        let Some(body) =
            (own.get("body")).and_then(|value| context.names.rigid.find(value, &who, problems))
        else {
            is_right = false;
            continue;
        };
        if moves.iter().any(|other| other.body == body) {
            problems.error(own.place_at("body"), "this rigid body is named twice");
        }
        match drives::<D>(own, problems) {
            Ok(drives) => moves.push(RigidMove { body, drives }),
            Err(Wrong) => is_right = false,
        }
    }
    is_right.then_some(StageKind::Rigid(moves))
}

fn drives<const D: usize>(
    own: &Node,
    problems: &mut Problems,
) -> Result<[Option<RigidDrive>; COMPONENTS], Wrong> {
    let free: Vec<&str> = own.items_at("free").iter().filter_map(Node::text).collect();
    let mut drives = [None; COMPONENTS];
    let components: &[(&str, &str)] = if D == 2 {
        &[("x", "force_x"), ("y", "force_y"), ("rotation", "moment")]
    } else {
        &[
            ("x", "force_x"),
            ("y", "force_y"),
            ("z", "force_z"),
            ("rotation_x", "moment_x"),
            ("rotation_y", "moment_y"),
            ("rotation_z", "moment_z"),
        ]
    };
    for (drive, &(by, force)) in drives.iter_mut().zip(components) {
        let (moved, loaded) = (own.optional_number(by)?, own.optional_number(force)?);
        let is_free = free.contains(&by);
        let told = usize::from(moved.is_some()) + usize::from(loaded.is_some());
        if told + usize::from(is_free) > 1 {
            let second = if loaded.is_some() { force } else { "free" };
            let first = if moved.is_some() { by } else { "free" };
            problems
                .error(
                    own.place_at(second),
                    format!("both `{first}` and `{second}` are said of one component"),
                )
                .help("a component is moved, or loaded, or free: keep one of them");
            return Err(Wrong);
        }
        *drive = match (moved, loaded) {
            (Some(by), _) => Some(RigidDrive::By(by)),
            (_, Some(force)) => Some(RigidDrive::Force(force)),
            _ if is_free => Some(RigidDrive::Force(0.0)),
            _ => None,
        };
    }
    Ok(drives)
}

/// Warns of rigid bodies that never come in.
pub(super) fn check_use(tree: &Node, names: &AllNames, problems: &mut Problems) {
    let moved: Vec<&str> = (tree.items_at("stages").iter())
        .filter(|stage| stage.text_at("type") == Some("rigid"))
        .flat_map(|stage| stage.items_at("bodies"))
        .filter_map(|own| own.text_at("body"))
        .collect();
    if moved
        .iter()
        .any(|name| names.rigid.position(name).is_none())
    {
        return;
    }
    for node in tree.items_at("rigid") {
        let is_there = node.flag_at("from_start") != Some(false);
        if let Some(name) = node.text_at("name")
            && !is_there
            && !moved.contains(&name)
        {
            problems.warning(
                node.place_at("name"),
                format!(
                    "no stage names the rigid body `{}`, which is never there",
                    clip(name, 40)
                ),
            );
        }
    }
}
