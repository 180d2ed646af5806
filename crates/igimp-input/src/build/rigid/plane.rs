//! Rigid bodies in plane strain: their shapes, and whether they have a place beside the soil.

use std::sync::Arc;

use igimp_geometry::polygon::area_and_centroid;
use igimp_model::{Load, LoadKind, RigidPart, RigidShape};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::rigid::{RigidBody, RigidShape as Form};
use igimp_schema::schema::stages::Stage;
use igimp_schema::text::{clip, point};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::At;

use super::{Basis, Room, Sides, narrow};
use crate::build::bodies::sequence::Sequence;
use crate::build::bodies::site::Site;
use crate::build::grid::Frame;
use crate::build::{Thing, things};
use igimp_geometry::outline::{distinct, overlap, self_crossing};

/// Corners of a circle where it is looked at as a polygon.
const POINTS_OF_CIRCLE: usize = 90;

/// The surroundings of rigid bodies.
pub(crate) struct Around<'a> {
    pub(crate) site: &'a Site,
    pub(crate) loads: &'a [Option<Load<2>>],
    pub(crate) stages: &'a [Thing<Stage>],
    pub(crate) sequence: &'a Sequence,
}

impl Room<2> for Around<'_> {
    fn frame(&self) -> Option<&Frame<2>> {
        self.site.frame.as_ref()
    }

    fn basis(&self, body: &At<RigidBody<2>>, problems: &mut Problems) -> Option<Basis<2>> {
        let shape = shape(body, &clip(&body.name, 40), self.site.round_off, problems);
        let stated = body
            .common
            .as_ref()
            .ok()
            .and_then(|common| common.reference.as_ref());
        if let (Some(RigidShape::Circle { .. }), Some(stated)) = (&shape, stated) {
            problems
                .error(
                    stated.place,
                    "the reference point of a circle is its centre",
                )
                .help("remove reference, or use a polygon");
        }
        shape.map(|shape| Basis {
            reference: stated.map_or_else(|| reference(&body.form, &shape), |point| **point),
            sides: sides(&body.form, &shape),
            thickness: thickness(&shape),
            shape: Arc::new(shape),
        })
    }

    fn check(&self, body: &RigidBody<2>, part: &RigidPart<2>, problems: &mut Problems) {
        beside_soil(body, part, self, problems);
        narrow_in_soil(body, part, self.site, problems);
    }

    fn followed(&self) -> (bool, &'static str) {
        let is_footing = |load: &Load<2>| matches!(load.kind, LoadKind::RigidFooting { .. });
        let is_taken = self.loads.iter().flatten().any(is_footing);
        (
            is_taken,
            "it can follow one rigid body, or one rigid footing",
        )
    }
}

/// The sides, and the names that they have.
fn sides(form: &Form<2>, shape: &RigidShape) -> Sides {
    let count = match shape {
        RigidShape::Polygon(corners) => corners.len(),
        RigidShape::Circle { .. } => 1,
    };
    let names: &[&str] = match form {
        Form::Rectangle(_) => &["bottom", "right", "top", "left"],
        Form::Wall(_) => &["face"],
        _ => &[],
    };
    Sides { count, names }
}

/// The shapes of the bodies that lines of the grid are fitted to; problems are those of the bodies as they are built.
pub(crate) fn outlines(tree: &Node) -> Vec<RigidShape> {
    let all = things(Root::<2>::rigid(tree));
    let shapes = all.iter().flatten();
    shapes
        .filter_map(|body| shape(body, &body.name, 0.0, &mut Problems::default()))
        .collect()
}

fn shape(
    body: &At<RigidBody<2>>,
    name: &str,
    round_off: f64,
    problems: &mut Problems,
) -> Option<RigidShape> {
    let mut flat = |place| {
        problems.error(place, format!("the rigid body `{name}` has no area"));
        None
    };
    Some(match &*body.form {
        Form::Rectangle(rectangle) => {
            let rectangle = rectangle.as_ref().ok()?;
            let (a, b) = (*rectangle.from, *rectangle.to);
            let [left, bottom] = [a[0].min(b[0]), a[1].min(b[1])];
            let [right, top] = [a[0].max(b[0]), a[1].max(b[1])];
            if right - left <= round_off || top - bottom <= round_off {
                return flat(rectangle.to.place);
            }
            RigidShape::Polygon(vec![
                [left, bottom],
                [right, bottom],
                [right, top],
                [left, top],
            ])
        }
        Form::Circle(circle) => {
            let circle = circle.as_ref().ok()?;
            RigidShape::Circle {
                centre: *circle.centre,
                radius: *circle.radius,
            }
        }
        Form::Wall(wall) => {
            let wall = wall.as_ref().ok()?;
            let (from, to) = (*wall.from, *wall.to);
            let along = [to[0] - from[0], to[1] - from[1]];
            let length = along[0].hypot(along[1]);
            if length <= round_off {
                return flat(wall.to.place);
            }
            let back = [-along[1], along[0]].map(|x| x / length * *wall.thickness);
            let behind = |at: [f64; 2]| [at[0] + back[0], at[1] + back[1]];
            RigidShape::Polygon(vec![from, to, behind(to), behind(from)])
        }
        Form::Polygon(polygon) => {
            let stated = &polygon.as_ref().ok()?.corners;
            let corners: Vec<_> = stated.iter().map(|corner| **corner).collect();
            let corners = distinct(&corners, round_off);
            if corners.len() < 3 {
                return flat(stated.place);
            }
            if let Some(at) = self_crossing(&corners, round_off) {
                problems.error(
                    stated.place,
                    format!("the rigid body `{name}` crosses itself at {}", point(at)),
                );
                return None;
            }
            if area_and_centroid(&corners).0 == 0.0 {
                return flat(stated.place);
            }
            RigidShape::Polygon(corners)
        }
        // A shape in space has none here.
        _ => return flat(body.place),
    })
}

/// The point whose displacement and forces are printed where the file does not say.
fn reference(form: &Form<2>, shape: &RigidShape) -> [f64; 2] {
    let middle = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    match (shape, form) {
        (RigidShape::Circle { centre, .. }, _) => *centre,
        (RigidShape::Polygon(corners), Form::Rectangle(_) | Form::Wall(_)) => {
            middle(corners[0], corners[1])
        }
        (RigidShape::Polygon(corners), _) => {
            let (lower, upper) = igimp_geometry::polygon::bounding_box(corners);
            middle(lower, upper)
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

/// Warns of a corner of a body that is narrower than two cells, in the box around the soil or less than a cell beyond it. A corner on a
/// side of the grid has soil on one side alone (theory, eq. 45g).
fn narrow_in_soil(body: &RigidBody<2>, part: &RigidPart<2>, site: &Site, problems: &mut Problems) {
    let (Some(frame), Some(RigidShape::Polygon(corners))) = (&site.frame, part.shape.in_plane())
    else {
        return;
    };
    let (lower, upper) = part.bounds();
    let axes = frame.axes.iter().enumerate();
    let cell = axes
        .map(|(axis, lines)| lines.smallest_between(lower[axis], upper[axis]))
        .fold(f64::INFINITY, f64::min);
    let mut within = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for corner in site.polygons.iter().flatten() {
        for axis in 0..2 {
            within[0][axis] = within[0][axis].min(corner[axis] - cell);
            within[1][axis] = within[1][axis].max(corner[axis] + cell);
        }
    }
    let is_on_side = |corner: &[f64; 2]| {
        let mut axes = std::iter::zip(&frame.axes, corner);
        axes.any(|(axis, x)| {
            [axis.lower(), axis.upper()]
                .iter()
                .any(|end| (x - end).abs() <= site.round_off)
        })
    };
    let name = clip(&part.name, 40);
    let is_near = |at: &[f64; 2]| (0..2).all(|d| within[0][d] <= at[d] && at[d] <= within[1][d]);
    let meets_soil = |corner: &[f64; 2]| is_near(corner) && !is_on_side(corner);
    narrow::warn(
        (&name, body.name.place),
        corners,
        (cell, meets_soil),
        problems,
    );
}

/// Refuses a body that overlaps soil as it starts, or that is placed while it is there.
fn beside_soil(
    rigid: &RigidBody<2>,
    part: &RigidPart<2>,
    around: &Around<'_>,
    problems: &mut Problems,
) {
    let Around { site, sequence, .. } = around;
    let outline = part.outline(POINTS_OF_CIRCLE);
    let names = |stage: &Thing<Stage>| {
        let mut moved = stage.iter().flat_map(|stage| stage.moves()).flatten();
        moved.any(|motion| motion.body.value == part.name)
    };
    let first = around.stages.iter().position(names);
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
                rigid.name.place,
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
