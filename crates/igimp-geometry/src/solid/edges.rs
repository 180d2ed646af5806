//! Edges of solids: the lines that a drawing shows where a body ends, or where its boundary has a crease.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::Solid;
use super::difference::Difference;
use super::facets::Facets;
use super::layer::Layer;
use super::prism::{Prism, placed, seen};
use super::round::Cylinder;
use super::terrain::Height;
use crate::polygon::{bounding_box, clip_to_box};
use crate::region::Region;

type Point = [f64; 3];

/// Faces that turn by less than this from one to the next have no edge between them \[rad\].
const BLUNT: f64 = PI / 6.0;
/// Sides of the polygon that stands for a circle.
const AROUND: u32 = 48;
/// A line of which parts may be left out is cut into parts of this share of the size of its body \[-\].
const PART: f64 = 1.0 / 128.0;
/// So far beside a line it is looked whether there is soil, as a share of the size of the body \[-\]: further than the polygon of
/// a circle stands from it.
const BESIDE: f64 = 2e-3;
/// A share of the size of the body that is round-off \[-\].
const ROUND_OFF: f64 = 1e-9;

/// The edges of a solid; a sphere has none.
pub(super) fn of(solid: &Solid) -> Vec<Vec<Point>> {
    match solid {
        Solid::Cuboid(..) => of_prism(&upright(solid)),
        Solid::Prism(prism) => of_prism(prism),
        Solid::Cylinder(cylinder) => of_prism(&faceted(cylinder)),
        Solid::Sphere(_) => Vec::new(),
        Solid::Surface(surface) => creases(&surface.facets),
        Solid::Layer(layer) => of_layer(layer),
        Solid::Difference(difference) => of_difference(difference),
    }
}

/// The box around a solid as a prism that stands upright.
fn upright(solid: &Solid) -> Prism {
    let (lower, upper) = solid.bounds();
    let corner = |x: usize, y: usize| [[lower, upper][x][0], [lower, upper][y][1]];
    let polygon = vec![corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
    Prism::new(polygon, 2, [lower[2], upper[2]])
}

/// A cylinder as a prism of many sides.
fn faceted(cylinder: &Cylinder) -> Prism {
    let around = |k| {
        let (sine, cosine) = (2.0 * PI * f64::from(k) / f64::from(AROUND)).sin_cos();
        [cosine, sine].map(|x| cylinder.radius * x)
    };
    let place = |[x, y]: [f64; 2]| [cylinder.centre[0] + x, cylinder.centre[1] + y];
    let polygon = (0..AROUND).map(around).map(place).collect();
    Prism::new(polygon, cylinder.axis, cylinder.between)
}

/// Both ends of a prism, and its sides where its polygon turns.
fn of_prism(prism: &Prism) -> Vec<Vec<Point>> {
    let end = |along: f64| {
        let corners = prism.polygon.iter().chain(prism.polygon.first());
        corners.map(|&at| placed(at, prism.axis, along)).collect()
    };
    let sides =
        turns(&prism.polygon).map(|at| prism.between.map(|along| placed(at, prism.axis, along)));
    prism
        .between
        .map(end)
        .into_iter()
        .chain(sides.map(Vec::from))
        .collect()
}

/// The corners at which a polygon turns.
fn turns(polygon: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> + '_ {
    let count = polygon.len();
    let way = move |k: usize| {
        let (p, q) = (polygon[k % count], polygon[(k + 1) % count]);
        [q[0] - p[0], q[1] - p[1]]
    };
    let is_turn = move |&k: &usize| {
        let (a, b) = (way(k + count - 1), way(k));
        let (cross, along) = (a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
        cross.atan2(along).abs() > BLUNT
    };
    (0..count).filter(is_turn).map(move |k| polygon[k])
}

/// The edges at which the faces of a surface turn; not the rim of an open one.
fn creases(facets: &Facets) -> Vec<Vec<Point>> {
    let mut faces: BTreeMap<[u32; 2], Vec<Point>> = BTreeMap::new();
    for (number, corners) in facets.triangles.iter().enumerate() {
        let normal = normal(facets.corners_of(number));
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let edge = [from.min(to), from.max(to)];
            faces.entry(edge).or_default().push(normal);
        }
    }
    let is_crease = |normals: &[Point]| {
        let [a, b] = normals else { return false };
        let cosine: f64 = (0..3).map(|k| a[k] * b[k]).sum();
        cosine < BLUNT.cos()
    };
    let creases = faces.iter().filter(|(_, normals)| is_crease(normals));
    creases
        .map(|(edge, _)| edge.map(|end| facets.points[end as usize]).to_vec())
        .collect()
}

/// The direction across a triangle, of length 1.
fn normal([a, b, c]: [Point; 3]) -> Point {
    let way = |to: Point| -> Point { std::array::from_fn(|k| to[k] - a[k]) };
    let (u, v) = (way(b), way(c));
    let across = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = across[0].hypot(across[1]).hypot(across[2]);
    across.map(|x| x / length)
}

/// The rims of a layer below and above the sides of its plan, the upright edges where the plan turns, and the creases of its
/// surfaces.
fn of_layer(layer: &Layer) -> Vec<Vec<Point>> {
    let (plan, heights) = (layer.plan(), [&layer.bottom, &layer.top]);
    let mut lines = Vec::new();
    for height in heights {
        let next = plan.iter().cycle().skip(1);
        lines.extend(std::iter::zip(plan, next).map(|(&p, &q)| along(height, p, q)));
        if let Height::Terrain(terrain) = height {
            let (lower, upper) = bounding_box(plan);
            let size = (upper[0] - lower[0]).max(upper[1] - lower[1]);
            let is_over = |point: &Point| plan.encloses([point[0], point[1]]);
            let creases = creases(&terrain.facets);
            lines.extend(creases.iter().flat_map(|line| kept(line, size, is_over)));
        }
    }
    let level = |height: &Height, at: [f64; 2]| Some([at[0], at[1], height.at(at)?]);
    let upright = |at: [f64; 2]| Some(vec![level(heights[0], at)?, level(heights[1], at)?]);
    lines.extend(turns(plan).filter_map(upright));
    lines
}

/// A surface over a side of a plan from p to q, with a corner at every edge of the surface that it crosses.
fn along(height: &Height, p: [f64; 2], q: [f64; 2]) -> Vec<Point> {
    let mut shares = vec![0.0, 1.0];
    if let Height::Terrain(terrain) = height {
        let [lower, upper] = [
            [p[0].min(q[0]), p[1].min(q[1])],
            [p[0].max(q[0]), p[1].max(q[1])],
        ];
        let way = [q[0] - p[0], q[1] - p[1]];
        let beside = |x: &Point| way[0] * (x[1] - p[1]) - way[1] * (x[0] - p[0]);
        let share = |x: [f64; 2]| {
            let along = way[0] * (x[0] - p[0]) + way[1] * (x[1] - p[1]);
            along / (way[0] * way[0] + way[1] * way[1])
        };
        terrain.facets.each(lower, upper, |triangle| {
            let corners = terrain.facets.corners_of(triangle);
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let (at_a, at_b) = (beside(&a), beside(&b));
                if (at_a > 0.0) != (at_b > 0.0) {
                    let t = at_a / (at_a - at_b);
                    shares.push(share([0, 1].map(|axis| a[axis] + t * (b[axis] - a[axis]))));
                }
            }
        });
    }
    shares.retain(|share| (0.0..=1.0).contains(share));
    shares.sort_by(f64::total_cmp);
    shares.dedup();
    let place = |t: f64| {
        let at = [0, 1].map(|axis| p[axis] + t * (q[axis] - p[axis]));
        Some([at[0], at[1], height.at(at)?])
    };
    shares.into_iter().filter_map(place).collect()
}

/// The edges of a solid and of its cuts, as far as they bound the rest, and the lines in which upright sides
/// of a cut meet the top and the underside of the solid.
fn of_difference(difference: &Difference) -> Vec<Vec<Point>> {
    let (lower, upper) = difference.bounds();
    let size = (0..3).fold(0.0_f64, |most, k| most.max(upper[k] - lower[k]));
    let mut lines = of(&difference.of);
    for solid in &difference.minus {
        let Some(prism) = within(solid, lower, upper) else {
            lines.extend(of(solid));
            continue;
        };
        lines.extend(of_prism(&prism));
        if prism.axis == 2 {
            lines.extend(rims(&difference.of, &prism, size));
        }
    }
    let bounds = |point: &Point| is_bound(difference, point, BESIDE * size);
    lines
        .iter()
        .flat_map(|line| kept(line, size, bounds))
        .collect()
}

/// The part of a box, a prism or a cylinder within a box, so that what is cut beyond a body ends at its sides; none of other
/// solids.
fn within(solid: &Solid, lower: Point, upper: Point) -> Option<Prism> {
    let prism = match solid {
        Solid::Prism(prism) => prism.clone(),
        Solid::Cylinder(cylinder) => faceted(cylinder),
        Solid::Cuboid(..) => upright(solid),
        _ => return None,
    };
    let axis = prism.axis;
    Some(Prism {
        polygon: clip_to_box(&prism.polygon, seen(lower, axis), seen(upper, axis)),
        between: prism.between.map(|end| end.clamp(lower[axis], upper[axis])),
        axis,
    })
}

/// Where the sides of an upright prism meet the top and the underside of a solid.
fn rims(of: &Solid, prism: &Prism, size: f64) -> Vec<Vec<Point>> {
    // The ends of the prism have their edges.
    let [from, to] = prism.between;
    let inside = from + ROUND_OFF * size..to - ROUND_OFF * size;
    let corners = prism.polygon.iter().chain(prism.polygon.first());
    let outline: Vec<Point> = corners.map(|&[x, y]| [x, y, from]).collect();
    let places = parts(&outline, PART * size);
    let rim = |pick: fn(f64, f64) -> f64| {
        let level = |place: &Point| {
            let levels = of.crossings(place).into_iter().map(|hit| hit.level);
            let level = levels.reduce(pick)?;
            (inside.contains(&level)).then_some([place[0], place[1], level])
        };
        let runs = places
            .chunk_by(|a, b| level(a).is_some() == level(b).is_some())
            .map(|run| run.iter().filter_map(level).collect::<Vec<_>>());
        runs.filter(|run| run.len() > 1).collect::<Vec<_>>()
    };
    [rim(f64::max), rim(f64::min)].concat()
}

/// Whether there is soil on some sides of a point and none on others.
fn is_bound(difference: &Difference, point: &Point, beside: f64) -> bool {
    let has_soil = |side: usize| {
        difference.encloses(std::array::from_fn(|axis| {
            let sign = if side >> axis & 1 == 1 { 1.0 } else { -1.0 };
            // Not the same along the axes, so that a face across their diagonal is not missed.
            point[axis] + sign * beside * [1.0, 1.3, 0.8][axis]
        }))
    };
    let sides = (0..8).filter(|&side| has_soil(side)).count();
    (1..8).contains(&sides)
}

/// A line with corners no further apart than a length.
fn parts(line: &[Point], longest: f64) -> Vec<Point> {
    let mut points: Vec<Point> = line.first().copied().into_iter().collect();
    for ends in line.windows(2) {
        let way: Point = std::array::from_fn(|k| ends[1][k] - ends[0][k]);
        let length = way[0].hypot(way[1]).hypot(way[2]);
        let count = (length / longest).ceil().max(1.0) as usize;
        let place = |k: usize| {
            let t = k as f64 / count as f64;
            std::array::from_fn(|axis| ends[0][axis] + t * way[axis])
        };
        points.extend((1..=count).map(place));
    }
    points
}

/// The parts of a line whose middles are to be kept.
fn kept(line: &[Point], size: f64, is_kept: impl Fn(&Point) -> bool) -> Vec<Vec<Point>> {
    let points = parts(line, PART * size);
    let is_part = |k: usize| {
        let middle = std::array::from_fn(|axis| 0.5 * (points[k][axis] + points[k + 1][axis]));
        is_kept(&middle)
    };
    let kept: Vec<usize> = (0..points.len().saturating_sub(1))
        .filter(|&k| is_part(k))
        .collect();
    kept.chunk_by(|a, b| a + 1 == *b)
        .map(|run| points[run[0]..=run[run.len() - 1] + 1].to_vec())
        .collect()
}

#[cfg(test)]
mod tests;
