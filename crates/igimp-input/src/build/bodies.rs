//! Bodies: polygons on the grid, apart from each other, held from below.

pub(crate) mod reach;
pub(crate) mod sequence;
pub(crate) mod sides;
pub(crate) mod site;
pub(crate) mod solids;
pub(crate) mod surfaces;

use std::sync::Arc;

use igimp_geometry::polygon::{area_and_centroid, bounding_box, contains};
use igimp_geometry::region::Region;
use igimp_model::{BodyPart, Boundaries, RigidPart, Side};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::bodies::Body;
use igimp_schema::schema::outline::Outline;
use igimp_schema::schema::stages::Stage;
use igimp_schema::source::Place;
use igimp_schema::text::{clip, count, number, point};
use igimp_schema::tree::read::{At, Either};
use igimp_schema::tree::{Node, Wrong};

use super::AllNames;
use super::grid::{Frame, MOST, cell_place};
use crate::build::Thing;
use igimp_geometry::outline::edge_distance;
use igimp_geometry::outline::{distinct, near_edge, overlap, self_crossing};
use igimp_text::short;
use sequence::{Sequence, placed};
use site::Site;

/// Most corners of all bodies together.
const MOST_CORNERS: usize = 5000;

/// Analyses, by the regions of their bodies.
pub(super) trait Fill<const D: usize> {
    /// The parts of their boundaries that bodies may share.
    const SHARED: &'static str;

    /// The region of a body.
    fn region(body: &At<Body>, problems: &mut Problems) -> Option<Arc<dyn Region<D>>>;

    /// Where the shape of a body stands.
    fn place(body: &At<Body>) -> Place;

    /// A place where two regions overlap, and by how much in words where it is known.
    fn overlap(a: &dyn Region<D>, b: &dyn Region<D>, round_off: f64) -> Option<([f64; D], String)>;
}

/// Plane strain: bodies are polygons.
pub(super) struct Plane;

impl Fill<2> for Plane {
    const SHARED: &'static str = "edges";

    fn region(body: &At<Body>, problems: &mut Problems) -> Option<Arc<dyn Region<2>>> {
        let corners = stated(&body.polygon)?;
        let polygon = corners_at(corners, polygon_place(body), &body.name, problems)?;
        Some(Arc::new(polygon))
    }

    fn place(body: &At<Body>) -> Place {
        polygon_place(body)
    }

    fn overlap(a: &dyn Region<2>, b: &dyn Region<2>, round_off: f64) -> Option<([f64; 2], String)> {
        let at = overlap(a.polygon(), b.polygon(), round_off)?;
        let by: f64 = [a, b]
            .map(|region| edge_distance(region.polygon(), at))
            .iter()
            .sum();
        let size = if by > round_off {
            format!(", by some {} m", short(by))
        } else {
            String::new()
        };
        Some((at, size))
    }
}

/// Space: bodies are solids.
pub(super) struct Space;

impl Fill<3> for Space {
    const SHARED: &'static str = "faces";

    fn region(body: &At<Body>, problems: &mut Problems) -> Option<Arc<dyn Region<3>>> {
        let solid = solids::solid(body, problems)?;
        Some(Arc::new(solid))
    }

    fn place(body: &At<Body>) -> Place {
        body.place
    }

    fn overlap(a: &dyn Region<3>, b: &dyn Region<3>, _: f64) -> Option<([f64; 3], String)> {
        Some((solids::overlap(a, b)?, String::new()))
    }
}

/// The bodies, as far as each is right by itself.
pub(super) fn bodies<A: Fill<D>, const D: usize>(
    tree: &Node,
    (tables, stages): (&[Thing<Body>], &[Thing<Stage>]),
    names: &AllNames,
    problems: &mut Problems,
) -> Vec<Option<BodyPart<D>>> {
    let polygons = tables.iter().flatten();
    let polygons = polygons.filter_map(|body| stated(&body.polygon));
    let corners: usize = polygons.map(<[_]>::len).sum();
    if D == 2 && corners > MOST_CORNERS {
        problems
            .error(
                Root::<D>::bodies(tree).ok().map(|bodies| bodies.place),
                format!("the bodies have {corners} corners together"),
            )
            .help(format!("at most {MOST_CORNERS} are possible"));
        return vec![None; tables.len()];
    }
    let later = placed(stages);
    let part = |body: &Thing<Body>| {
        let body = body.as_ref()?;
        let subject = format!("body `{}` uses", clip(&body.name, 40));
        let material = body.material.as_ref().ok();
        let material = material.and_then(|name| names.materials.find(name, &subject, problems));
        let region = A::region(body, problems);
        let points = **body.points_per_cell.as_ref().ok()?;
        Some(BodyPart {
            from_start: !later.contains(&body.name.as_str()),
            name: body.name.known()?,
            material: material?,
            per_direction: (1..=5).find(|count: &usize| count.pow(D as u32) >= points)?,
            region: region?,
        })
    };
    tables.iter().map(part).collect()
}

/// The polygon of a case in plane strain, if it was found right.
fn stated(polygon: &Result<Option<At<Polygon>>, Wrong>) -> Option<&[At<[f64; 2]>]> {
    match &**polygon.as_ref().ok()?.as_ref()? {
        Either::First(corners) => Some(corners),
        Either::Second(_) => None,
    }
}

/// Where the polygon of a body stands.
pub(super) fn polygon_place(body: &At<Body>) -> Place {
    let polygon = body.polygon.as_ref().ok().and_then(Option::as_ref);
    polygon.map_or(body.place, |polygon| polygon.place)
}

/// Corners, or where they come from.
pub(super) type Polygon = Either<Vec<At<[f64; 2]>>, Outline>;

/// The corners of a polygon that is one.
pub(super) fn corners(
    polygon: &At<Polygon>,
    name: &str,
    problems: &mut Problems,
) -> Option<Vec<[f64; 2]>> {
    let Either::First(corners) = &polygon.value else {
        return None;
    };
    corners_at(corners, polygon.place, name, problems)
}

fn corners_at(
    corners: &[At<[f64; 2]>],
    place: Place,
    name: &str,
    problems: &mut Problems,
) -> Option<Vec<[f64; 2]>> {
    let written: Vec<[f64; 2]> = corners.iter().map(|corner| **corner).collect();
    let largest = written
        .iter()
        .flatten()
        .fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let round_off = 1e-9 * largest;
    let corners = distinct(&written, round_off);
    let name = clip(name, 40);
    if corners.len() < 3 {
        problems
            .error(
                place,
                format!("the polygon of `{name}` has fewer than 3 different corners"),
            )
            .help("name the corners in order");
        return None;
    }
    if let Some(at) = self_crossing(&corners, round_off) {
        problems
            .error(
                place,
                format!("the polygon of `{name}` crosses itself at {}", point(at)),
            )
            .help("name the corners in order, one way round");
        return None;
    }
    let (lower, upper) = bounding_box(&corners);
    let area = area_and_centroid(&corners).0.abs();
    let size = (upper[0] - lower[0]).max(upper[1] - lower[1]);
    if area.is_nan() || area <= 1e-9 * size * size {
        problems
            .error(place, format!("the polygon of `{name}` has no area"))
            .help("its corners lie on one line");
        return None;
    }
    Some(corners)
}

/// Refuses bodies that reach out of the grid, that overlap, and that would have too many particles together.
pub(super) fn check<A: Fill<D>, const D: usize>(
    (tree, tables): (&Node, &[Thing<Body>]),
    names: &AllNames,
    (bodies, sequence): (&[Option<BodyPart<D>>], &Sequence),
    (frame, round_off): (Option<&Frame<D>>, f64),
    problems: &mut Problems,
) {
    let place = |index: usize| tables[index].as_ref().map(A::place);
    if let Some(frame) = frame {
        let lower = frame.lower.map(|x| x - round_off);
        let upper = frame.upper.map(|x| x + round_off);
        let mut particles = 0.0;
        for (index, body) in bodies.iter().enumerate() {
            let Some(body) = body else { continue };
            if let Some(at) = body.region.beyond(lower, upper) {
                let name = names.bodies.name(index);
                let message = format!(
                    "body `{name}` reaches {}, outside the grid domain",
                    point(at)
                );
                problems
                    .error(place(index), message)
                    .help("extend [grid] domain");
                continue;
            }
            particles += cells_of(&*body.region, frame) * body.per_direction.pow(D as u32) as f64;
        }
        let cells: f64 = (0..D)
            .map(|axis| frame.axes[axis].place(frame.upper[axis]))
            .product();
        // Too many cells are reported as such.
        if particles > MOST && cells <= MOST {
            let message = format!("the bodies would have {} particles", count(particles));
            problems.error(cell_place(tree), message).help(format!(
                "at most {} are possible: use larger cells or fewer points_per_cell",
                count(MOST)
            ));
        }
    }
    for (second, b) in bodies.iter().enumerate() {
        for (first, a) in bodies[..second].iter().enumerate() {
            let (Some(a), Some(b)) = (a, b) else { continue };
            if !sequence.are_together(first, second) {
                continue;
            }
            let Some((at, size)) = A::overlap(&*a.region, &*b.region, round_off) else {
                continue;
            };
            let [one, other] = [first, second].map(|index| names.bodies.name(index));
            let message = format!(
                "body `{other}` overlaps body `{one}` near {}{size}",
                point(at)
            );
            problems
                .error(place(second), message)
                .help(format!("bodies may share {} only", A::SHARED));
        }
    }
}

/// Cells that the soil of a region fills: those of the box around it, times its share of the box.
fn cells_of<const D: usize>(region: &dyn Region<D>, frame: &Frame<D>) -> f64 {
    let (from, to) = region.bounds();
    let by_volume: f64 = (0..D)
        .map(|axis| {
            let [first, last] = [from, to].map(|x| frame.axes[axis].place(x[axis]));
            (last - first) / (to[axis] - from[axis])
        })
        .product();
    region.volume() * by_volume
}

/// Warns of bodies that neither boundaries nor rigid bodies hold from below.
pub(super) fn check_support(
    tables: &[Thing<Body>],
    bodies: &[Option<BodyPart<2>>],
    (boundaries, rigid): (Option<&Boundaries<2>>, &[Option<RigidPart<2>>]),
    site: &Site,
    problems: &mut Problems,
) {
    let (Some(boundaries), Some(frame), true) = (boundaries, &site.frame, site.is_complete) else {
        return;
    };
    let [x, y] = frame.axes.each_ref().map(|axis| axis.extremes()[1]);
    let reach = x.max(y);
    let polygons = &site.polygons;
    let from_start = rigid.iter().flatten().filter(|part| part.from_start);
    let outlines: Vec<_> = from_start.map(|part| part.outline(64)).collect();
    let held = |polygon: &Vec<[f64; 2]>| {
        let (lower, upper) = bounding_box(polygon);
        let boxed = boundaries.boxes.iter().any(|part| {
            part.fix[1]
                && (0..2).all(|axis| {
                    part.lower[axis] <= upper[axis] + reach
                        && lower[axis] <= part.upper[axis] + reach
                })
        });
        boxed
            || outlines.iter().any(|outline| {
                bounding_box(outline).0[1] < lower[1] - reach && touch(outline, polygon, reach)
            })
            || boundaries.sides[1][0] != Side::Free && lower[1] < frame.lower[1] + reach
            || boundaries.sides[0][0] == Side::Fixed && lower[0] < frame.lower[0] + reach
            || boundaries.sides[0][1] == Side::Fixed && upper[0] > frame.upper[0] - reach
            || boundaries.sides[1][1] != Side::Free && upper[1] > frame.upper[1] - reach
    };
    let mut is_held: Vec<bool> = polygons.iter().map(held).collect();
    let mut queue: Vec<usize> = (0..polygons.len()).filter(|&k| is_held[k]).collect();
    while let Some(from) = queue.pop() {
        for k in 0..polygons.len() {
            if !is_held[k] && touch(&polygons[from], &polygons[k], reach) {
                is_held[k] = true;
                queue.push(k);
            }
        }
    }
    for (k, body) in bodies.iter().flatten().enumerate() {
        if !is_held[k] {
            let lowest = bounding_box(body.polygon()).0[1];
            problems
                .warning(
                    tables[k].as_ref().map(polygon_place),
                    format!("nothing holds body `{}` from below", body.name),
                )
                .help(format!(
                    "its lowest point is at y = {} m, the bottom of the grid at {} m",
                    number(lowest),
                    number(frame.lower[1])
                ));
        }
    }
}

/// Whether two polygons come closer than a distance.
fn touch(a: &[[f64; 2]], b: &[[f64; 2]], distance: f64) -> bool {
    let ((a_low, a_high), (b_low, b_high)) = (bounding_box(a), bounding_box(b));
    let apart = |axis: usize| {
        a_high[axis] + distance < b_low[axis] || b_high[axis] + distance < a_low[axis]
    };
    let near = |polygon: &[[f64; 2]], corners: &[[f64; 2]]| {
        corners
            .iter()
            .any(|&corner| contains(polygon, corner) || near_edge(polygon, corner, distance))
    };
    !(apart(0) || apart(1)) && (near(a, b) || near(b, a))
}
