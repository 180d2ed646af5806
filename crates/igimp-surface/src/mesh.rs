//! Surfaces in space with flat sides: boxes, prisms, and closed surfaces of triangles.

use std::collections::BTreeMap;

use crate::draft::{Draft, countable};
use crate::refine::{divided, triangulated};
use crate::vectors::{cross, dot, minus, norm};
use crate::{Surface, SurfaceError, positive, shares_along};

/// A triangle with less than this area over the square of its longest edge is a line \[-\].
const FLAT: f64 = 1e-12;

/// Edges of triangles are divided down to so many distances of knots, and knots of a side are at least so
/// many apart \[-\].
const LONGEST: f64 = 1.5;
const NEAREST: f64 = 0.5;

/// Around a knot normals are not further apart than an angle with this cosine \[-\].
const SMOOTH: f64 = 0.7;

/// A triangle of a closed surface: its corners anticlockwise as seen from outside, and the number of its
/// side.
pub type SurfaceTriangle = ([usize; 3], usize);

impl Surface<3> {
    /// A box about the origin, from its half-lengths \[length\], its edges rounded by a radius \[length\], with
    /// knots about `spacing` apart \[length\]. Its sides look down and up the first axis, then the second, then
    /// the third.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn cuboid(half: [f64; 3], rounding: f64, spacing: f64) -> Result<Self, SurfaceError> {
        positive("the distance of knots", spacing)?;
        for half in half {
            positive("half of a length of the box", half)?;
        }
        let [a, b, c] = half;
        countable(8.0 * (a * b + b * c + c * a), spacing)?;
        let inner = half.map(|half| half - rounding);
        let mut draft = Draft::default();
        for side in 0..6 {
            let (axis, sense) = (side / 2, if side % 2 == 0 { -1.0 } else { 1.0 });
            let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
            if inner[first] <= 0.0 || inner[second] <= 0.0 {
                return Err(SurfaceError::RoundedAway { side, rounding });
            }
            let corner = |s: f64, t: f64, height: f64| {
                let mut x = [0.0; 3];
                x[axis] = sense * height;
                x[first] = s * inner[first];
                x[second] = t * inner[second];
                x
            };
            let around = |height: f64| {
                [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                    .map(|(s, t)| corner(s, t, height))
            };
            let shares = [first, second].map(|k| shares_along(2.0 * inner[k], spacing));
            let outward = corner(0.0, 0.0, 1.0);
            draft.grid(
                around(inner[axis]),
                around(half[axis]),
                [&shares[0], &shares[1]],
                side,
                &outward,
            );
        }
        draft.finish(6, rounding, None)
    }

    /// A polygon that is extruded along a coordinate axis between two places \[length\]: corners in order, either
    /// way round, in the plane of the two axes that follow it (after the third comes the first). Its edges are
    /// rounded by a radius \[length\], knots are about `spacing` apart \[length\]. Its sides are numbered by the
    /// corner that they begin with, then come the lower and the upper end.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn prism(
        axis: usize,
        corners: &[[f64; 2]],
        [from, to]: [f64; 2],
        rounding: f64,
        spacing: f64,
    ) -> Result<Self, SurfaceError> {
        positive("the distance of knots", spacing)?;
        positive("the length of the prism", to - from)?;
        let outline = Outline::new(corners, rounding)?;
        let around: f64 = (0..outline.len()).map(|k| norm(&outline.side(k))).sum();
        countable(around * (to - from) + 2.0 * outline.area.abs(), spacing)?;
        let (lower, upper) = (from + rounding, to - rounding);
        if upper <= lower {
            return Err(SurfaceError::RoundedAway { side: 0, rounding });
        }
        let place = |x: [f64; 2], along: f64| {
            let mut out = [0.0; 3];
            out[axis] = along;
            out[(axis + 1) % 3] = x[0];
            out[(axis + 2) % 3] = x[1];
            out
        };
        let mut draft = Draft::default();
        let across = shares_along(upper - lower, spacing);
        for k in 0..outline.len() {
            let (a, b, normal) = (outline.core(k), outline.core(k + 1), outline.outward(k));
            let way = [b[0] - a[0], b[1] - a[1]];
            if dot(&way, &outline.side(k)) <= 0.0 {
                return Err(SurfaceError::RoundedAway { side: k, rounding });
            }
            let quad = |off: f64| {
                let [a, b] = [a, b].map(|x| [0, 1].map(|d| x[d] + off * normal[d]));
                [
                    place(a, lower),
                    place(b, lower),
                    place(b, upper),
                    place(a, upper),
                ]
            };
            let along = shares_along(norm(&way), spacing);
            let shares = [along.as_slice(), across.as_slice()];
            draft.grid(quad(0.0), quad(rounding), shares, k, &place(normal, 0.0));
        }
        let cores = outline.cores();
        let mut points: Vec<[f64; 3]> = cores.iter().map(|&x| place(x, 0.0)).collect();
        let triangles = divided(&mut points, triangulated(&cores)?, LONGEST * spacing);
        let n = outline.len();
        for (side, along, outer, sense) in [(n, lower, from, -1.0), (n + 1, upper, to, 1.0)] {
            let at = |x: &[f64; 3], along: f64| {
                let mut x = *x;
                x[axis] = along;
                x
            };
            let knots: Vec<usize> = points
                .iter()
                .map(|x| draft.knot(at(x, along), at(x, outer), side))
                .collect();
            for (corners, _) in &triangles {
                let corners = corners.map(|corner| knots[corner]);
                draft.facet(corners, side, &place([0.0; 2], sense));
            }
        }
        draft.finish(n + 2, rounding, None)
    }

    /// A closed surface of triangles, all of them the same way round, each with the number of its side. Knots are
    /// about `spacing` apart \[length\]: larger triangles are divided, and where they are smaller several of
    /// their corners make one knot. Edges between sides stay sharp, and so do those within a side at which it
    /// turns by much.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn triangles(
        corners: &[[f64; 3]],
        triangles: &[SurfaceTriangle],
        spacing: f64,
    ) -> Result<Self, SurfaceError> {
        positive("the distance of knots", spacing)?;
        if triangles.len() < 4 {
            return Err(SurfaceError::TooFewCorners);
        }
        let sides = triangles
            .iter()
            .map(|&(_, side)| side + 1)
            .max()
            .unwrap_or(0);
        if let Some(side) = (0..sides.min(triangles.len() + 1))
            .find(|side| triangles.iter().all(|(_, other)| other != side))
        {
            return Err(SurfaceError::NoSuchSide { side });
        }
        let (mut points, mut welded) = welded(corners, triangles)?;
        closed(&points, &welded)?;
        let volume: f64 = welded
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|corner| points[corner]);
                dot(&a, &cross(&b, &c))
            })
            .sum();
        if volume < 0.0 {
            for triangle in &mut welded {
                triangle.swap(1, 2);
            }
        }
        let area = |triangle: &[usize; 3]| {
            let [a, b, c] = triangle.map(|corner| points[corner]);
            0.5 * norm(&cross(&minus(&b, &a), &minus(&c, &a)))
        };
        countable(welded.iter().map(area).sum(), spacing)?;
        let parts = divided(&mut points, welded, LONGEST * spacing);
        let mut draft = Draft::default();
        let mut knots = Knots::new(spacing);
        for (corners, of) in parts {
            let side = triangles[of].1;
            let [a, b, c] = corners.map(|corner| points[corner]);
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            let size = norm(&normal);
            let normal = normal.map(|x| x / size);
            let facet = corners
                .map(|corner| knots.point(&mut draft, (corner, &points[corner]), side, &normal));
            draft.facet(facet, side, &normal);
        }
        draft.finish(sides, 0.0, None)
    }
}

/// The outline of a prism, and its core within a rounding.
struct Outline<'c> {
    corners: &'c [[f64; 2]],
    rounding: f64,
    /// Positive where the corners run anticlockwise \[length²\].
    area: f64,
}

impl<'c> Outline<'c> {
    fn new(corners: &'c [[f64; 2]], rounding: f64) -> Result<Self, SurfaceError> {
        let n = corners.len();
        let area = (0..n).map(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % n]);
            0.5 * (a[0] * b[1] - a[1] * b[0])
        });
        let outline = Self {
            corners,
            rounding,
            area: area.sum(),
        };
        if n < 3 || (0..n).any(|k| norm(&outline.side(k)) <= 0.0) {
            return Err(SurfaceError::TooFewCorners);
        }
        if crosses(corners) {
            return Err(SurfaceError::Crossing);
        }
        Ok(outline)
    }

    fn len(&self) -> usize {
        self.corners.len()
    }

    /// From a corner to the next one.
    fn side(&self, k: usize) -> [f64; 2] {
        let (from, to) = (self.corners[k], self.corners[(k + 1) % self.len()]);
        [0, 1].map(|a| to[a] - from[a])
    }

    /// The normal of a side.
    fn outward(&self, k: usize) -> [f64; 2] {
        let [x, y] = self.side(k);
        let length = self.area.signum() * x.hypot(y);
        [y / length, -x / length]
    }

    /// A corner, drawn in from both sides by the rounding.
    fn core(&self, k: usize) -> [f64; 2] {
        let n = self.len();
        let (before, after) = (self.outward((k + n - 1) % n), self.outward(k % n));
        let share = self.rounding / (1.0 + dot(&before, &after));
        [0, 1].map(|a| self.corners[k % n][a] - share * (before[a] + after[a]))
    }

    /// All corners, drawn in, anticlockwise.
    fn cores(&self) -> Vec<[f64; 2]> {
        let mut cores: Vec<[f64; 2]> = (0..self.len()).map(|k| self.core(k)).collect();
        if self.area < 0.0 {
            cores.reverse();
        }
        cores
    }
}

/// Whether sides of a polygon that do not follow each other cross.
fn crosses(corners: &[[f64; 2]]) -> bool {
    let n = corners.len();
    let side = |k: usize| (corners[k], corners[(k + 1) % n]);
    let parts = |(a, b): ([f64; 2], [f64; 2]), (p, q): ([f64; 2], [f64; 2])| {
        let turn = |c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        turn(p) * turn(q) < 0.0
    };
    (0..n).any(|k| {
        (k + 2..n)
            .filter(|l| (l + 1) % n != k)
            .any(|l| parts(side(k), side(l)) && parts(side(l), side(k)))
    })
}

/// Corners, and triangles between them.
type Welded = (Vec<[f64; 3]>, Vec<[usize; 3]>);

/// Corners that differ in place, and triangles between them.
fn welded(corners: &[[f64; 3]], triangles: &[SurfaceTriangle]) -> Result<Welded, SurfaceError> {
    let mut places: BTreeMap<[u64; 3], usize> = BTreeMap::new();
    let mut points = Vec::new();
    let mut out = Vec::with_capacity(triangles.len());
    for (triangle, (triple, _)) in triangles.iter().enumerate() {
        let mut new = [0; 3];
        for (k, &corner) in triple.iter().enumerate() {
            let count = corners.len();
            let x = corners.get(corner).ok_or(SurfaceError::UnknownCorner {
                triangle,
                corner,
                count,
            })?;
            if let Some(&value) = x.iter().find(|x| !x.is_finite()) {
                let quantity = "a coordinate of a corner";
                return Err(SurfaceError::NotPositive { quantity, value });
            }
            // Minus zero is zero.
            new[k] = *places
                .entry(x.map(|x| (x + 0.0).to_bits()))
                .or_insert_with(|| {
                    points.push(*x);
                    points.len() - 1
                });
        }
        let [a, b, c] = new.map(|corner| points[corner]);
        let edges = [minus(&b, &a), minus(&c, &a), minus(&c, &b)];
        let longest = edges.iter().map(|edge| dot(edge, edge)).fold(0.0, f64::max);
        if norm(&cross(&edges[0], &edges[1])) <= FLAT * longest {
            return Err(SurfaceError::FlatTriangle {
                triangle,
                position: a,
            });
        }
        out.push(new);
    }
    Ok((points, out))
}

/// Two triangles meet at every edge, and run along it in opposite ways.
fn closed(points: &[[f64; 3]], triangles: &[[usize; 3]]) -> Result<(), SurfaceError> {
    let mut edges: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (triangle, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            if let Some(other) = edges.insert((from, to), triangle) {
                return Err(SurfaceError::Twisted {
                    triangles: [other, triangle],
                    from: points[from],
                    to: points[to],
                });
            }
        }
    }
    for (&(from, to), &triangle) in &edges {
        if !edges.contains_key(&(to, from)) {
            return Err(SurfaceError::Open {
                triangle,
                from: points[from],
                to: points[to],
            });
        }
    }
    Ok(())
}

/// Knots of a surface of triangles: corners of a side that are near each other, and look the same way.
struct Knots {
    spacing: f64,
    /// Points with the knots that they made, by place in a grid of the spacing, with side and normal.
    near: BTreeMap<[i64; 3], Vec<MeshKnot>>,
    /// Points of the draft by corner and knot.
    known: BTreeMap<(usize, usize), usize>,
}

/// A knot: its point, where it stands, its side and its normal.
struct MeshKnot {
    point: usize,
    x: [f64; 3],
    side: usize,
    normal: [f64; 3],
}

impl Knots {
    fn new(spacing: f64) -> Self {
        Self {
            spacing,
            near: BTreeMap::new(),
            known: BTreeMap::new(),
        }
    }

    /// The point of the draft for a corner of a triangle.
    fn point(
        &mut self,
        draft: &mut Draft,
        (corner, x): (usize, &[f64; 3]),
        side: usize,
        normal: &[f64; 3],
    ) -> usize {
        let place = x.map(|x| (x / self.spacing).floor() as i64);
        let mut best: Option<(f64, usize)> = None;
        for k in 0..27_i64 {
            let by = [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1];
            let at: [i64; 3] = std::array::from_fn(|axis| place[axis].saturating_add(by[axis]));
            for known in self.near.get(&at).into_iter().flatten() {
                let far = norm(&minus(x, &known.x));
                let fits = known.side == side && dot(&known.normal, normal) > SMOOTH;
                let nearer = best.is_none_or(|(least, _)| far < least);
                if fits && nearer && far <= NEAREST * self.spacing {
                    best = Some((far, known.point));
                }
            }
        }
        let Some((_, knot)) = best else {
            let point = draft.knot(*x, *x, side);
            self.near.entry(place).or_default().push(MeshKnot {
                point,
                x: *x,
                side,
                normal: *normal,
            });
            self.known.insert((corner, point), point);
            return point;
        };
        *self
            .known
            .entry((corner, knot))
            .or_insert_with(|| draft.beside(*x, *x, knot))
    }
}
