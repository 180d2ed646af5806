//! The face of a particle in space, cut along the facets of a surface and the lines of the grid.

use igimp_shape::Grid;

use crate::RigidBody;
use crate::face::Face;
use igimp_surface::Space;
use igimp_surface::vectors::{cross_size, dot, minus, norm};

/// Places and weights of six points in a triangle that integrate polynomials of degree four (Dunavant
/// 1985): two shares of corners with their weight, each in three turns.
const RULE: [(f64, f64, f64); 2] = [
    (
        0.108_103_018_168_070_23,
        0.445_948_490_915_964_9,
        0.223_381_589_678_011_47,
    ),
    (
        0.816_847_572_980_458_5,
        0.091_576_213_509_770_74,
        0.109_951_743_655_321_87,
    ),
];

/// Pieces with a smaller share of a face are none: round-off on a line \[-\].
const LEAST: f64 = 1e-12;

/// A point of the plane of a face.
type Flat = [f64; 2];

/// A piece of a face: it lies in one cell, above one facet.
pub struct Piece<const D: usize> {
    /// The corners of the facet, as points of the surface.
    pub corners: [usize; D],
    /// Points of integration in space \[length\], with their area \[length²\] and the shares of the corners.
    pub points: Vec<([f64; D], f64, [f64; 3])>,
}

/// The face of a particle with these half-lengths \[length\] as seen from the body, in pieces. `places` are
/// those of the points of the surface in space \[length\].
pub fn pieces<const D: usize>(
    face: &Face<D>,
    half_length: &[f64; D],
    body: &RigidBody<D>,
    space: &Space<D>,
    places: &[[f64; D]],
    grid: &Grid<D>,
) -> Vec<Piece<D>> {
    let (surface, pose) = (&*body.surface, &body.pose);
    let outline = outline(face, half_length);
    let least = LEAST * area(&outline);
    let reach = norm(half_length) + face.gap.abs();
    let middle = pose.into_body(&face.middle);
    let mut pieces = Vec::new();
    for facet in surface.seen(space, face.side, (&middle, reach), &face.facing) {
        let corners = surface.corners(facet);
        let triangle = [0, 1, 2].map(|k| {
            let arm = minus(&places[corners[k]], &face.middle);
            [dot(&arm, &face.along[0]), dot(&arm, &face.along[1])]
        });
        let double = turn(&triangle[0], &triangle[1], &triangle[2]);
        if double <= 0.0 {
            continue;
        }
        let mut above = outline.clone();
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            above = kept(&above, |p| turn(&a, &b, p));
        }
        if area(&above) <= least {
            continue;
        }
        for cell in by_cells(above, face, grid) {
            let mut points = Vec::new();
            for k in 2..cell.len() {
                let part = [cell[0], cell[k - 1], cell[k]];
                let size = 0.5 * turn(&part[0], &part[1], &part[2]);
                if size <= least {
                    continue;
                }
                for (p, weight) in points_in(&part) {
                    let share = |a: usize, b: usize| turn(&triangle[a], &triangle[b], &p) / double;
                    let shares = [share(1, 2), share(2, 0), share(0, 1)].map(|x| x.max(0.0));
                    points.push((face.at(&p), face.share * weight * size, shares));
                }
            }
            if !points.is_empty() {
                pieces.push(Piece { corners, points });
            }
        }
    }
    pieces
}

/// The area of each knot \[length²\], as far as it lies within the grid: on a plane of symmetry half
/// of a knot has no soil.
pub fn tents_within<const D: usize>(
    body: &RigidBody<D>,
    space: &Space<D>,
    grid: &Grid<D>,
) -> Vec<f64> {
    let surface = &*body.surface;
    let places: Vec<[f64; D]> = space
        .outer
        .iter()
        .map(|x| body.pose.into_space(x))
        .collect();
    let mut areas = vec![0.0; surface.knot_count()];
    for facet in 0..surface.facet_count() {
        let corners = surface.corners(facet);
        let at = corners.map(|corner| places[corner]);
        // The triangle in shares of its second and third corner, and what of it lies within.
        let mut part: Vec<Flat> = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        for axis in 0..D {
            let (start, end) = (grid.axes[axis].start(), grid.axes[axis].end());
            let along = |[s, t]: &Flat| {
                at[0][axis] + s * (at[1][axis] - at[0][axis]) + t * (at[2][axis] - at[0][axis])
            };
            if at.iter().any(|corner| corner[axis] < start) {
                part = kept(&part, |p| along(p) - start);
            }
            if at.iter().any(|corner| corner[axis] > end) {
                part = kept(&part, |p| end - along(p));
            }
        }
        let double = cross_size(&minus(&at[1], &at[0]), &minus(&at[2], &at[0]));
        for k in 2..part.len() {
            let triangle = [part[0], part[k - 1], part[k]];
            let area = 0.5 * double * turn(&triangle[0], &triangle[1], &triangle[2]);
            let [s, t] = [0, 1].map(|a| triangle.iter().map(|p| p[a]).sum::<f64>() / 3.0);
            for (corner, mean) in corners.into_iter().zip([1.0 - s - t, s, t]) {
                for &(knot, share) in &space.shares[corner] {
                    areas[knot] += area * mean * share;
                }
            }
        }
    }
    areas
}

/// The domain of a particle as seen along the normal of its face, in the plane of the face: a hexagon, or a
/// rectangle along the axes; anticlockwise.
fn outline<const D: usize>(face: &Face<D>, half_length: &[f64; D]) -> Vec<Flat> {
    let mut edges: Vec<Flat> = (0..D)
        .map(|axis| {
            let [s, t] = [0, 1].map(|k| half_length[axis] * face.along[k][axis]);
            if t < 0.0 || (t == 0.0 && s < 0.0) {
                [-s, -t]
            } else {
                [s, t]
            }
        })
        .filter(|[s, t]| s.hypot(*t) > 1e-9 * norm(half_length))
        .collect();
    edges.sort_by(|a, b| a[1].atan2(a[0]).total_cmp(&b[1].atan2(b[0])));
    let mut at = [0, 1].map(|k| -edges.iter().map(|edge| edge[k]).sum::<f64>());
    let mut corners = Vec::with_capacity(2 * edges.len());
    for sense in [2.0, -2.0] {
        for edge in &edges {
            corners.push(at);
            at = [0, 1].map(|k| at[k] + sense * edge[k]);
        }
    }
    corners
}

/// A polygon cut along the lines of the grid.
fn by_cells<const D: usize>(polygon: Vec<Flat>, face: &Face<D>, grid: &Grid<D>) -> Vec<Vec<Flat>> {
    let mut parts = vec![polygon];
    for axis in 0..D {
        let along = |p: &Flat| face.at(p)[axis];
        let nodes = grid.axes[axis].nodes();
        let mut next = Vec::with_capacity(parts.len());
        for part in parts {
            let (lower, upper) = part
                .iter()
                .map(along)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(lower, upper), x| {
                    (lower.min(x), upper.max(x))
                });
            let first = nodes.partition_point(|line| *line <= lower);
            let last = nodes.partition_point(|line| *line < upper);
            let mut left = part;
            for line in nodes.get(first..last).unwrap_or(&[]) {
                next.push(kept(&left, |p| line - along(p)));
                left = kept(&left, |p| along(p) - line);
            }
            next.push(left);
        }
        next.retain(|part| part.len() > 2);
        parts = next;
    }
    parts
}

/// The part of a convex polygon where a linear function is not negative.
fn kept(polygon: &[Flat], function: impl Fn(&Flat) -> f64) -> Vec<Flat> {
    let values: Vec<f64> = polygon.iter().map(function).collect();
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for (k, p) in polygon.iter().enumerate() {
        let l = (k + 1) % polygon.len();
        let (value, next) = (values[k], values[l]);
        if value >= 0.0 {
            out.push(*p);
        }
        if (value > 0.0 && next < 0.0) || (value < 0.0 && next > 0.0) {
            let share = value / (value - next);
            let q = polygon[l];
            out.push([0, 1].map(|a| p[a] + share * (q[a] - p[a])));
        }
    }
    out
}

/// Points of integration in a triangle with their shares of its area.
fn points_in(&corners: &[Flat; 3]) -> impl Iterator<Item = (Flat, f64)> {
    RULE.into_iter().flat_map(move |(one, other, weight)| {
        (0..3).map(move |k| {
            let p = [0, 1].map(|a| {
                (0..3)
                    .map(|l| corners[l][a] * if l == k { one } else { other })
                    .sum()
            });
            (p, weight)
        })
    })
}

/// Twice the area of a triangle, positive if its corners run anticlockwise.
fn turn(a: &Flat, b: &Flat, c: &Flat) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The area of a convex polygon.
fn area(polygon: &[Flat]) -> f64 {
    (2..polygon.len())
        .map(|k| 0.5 * turn(&polygon[0], &polygon[k - 1], &polygon[k]))
        .sum()
}
