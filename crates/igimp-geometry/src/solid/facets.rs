//! Triangles in space, sorted by what they cover in plan, and the volume below them.
//!
//! The volume of what lies under triangles within a box is the sum, over the triangles, of the integral of
//! their height above the floor of the box, no more than the box is high, over what they cover of it in plan
//! (theory, eq. 44a). A triangle that faces down counts negative. Every term changes little when a corner does, so
//! that nothing has to be decided at edges and corners.

use crate::polygon::Polygon;
use crate::region::Part;

type Point = [f64; 3];

/// Most bins along one direction.
const MOST_BINS: f64 = 2048.0;

/// Less than this share of a box is round-off \[-\].
const ROUND_OFF: f64 = 1e-13;

/// Corners of a convex face; clipping a triangle by the sides of a box and of another triangle needs
/// no more.
const MOST_CORNERS: usize = 16;

/// A convex face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    corners: [Point; MOST_CORNERS],
    count: usize,
}

impl Face {
    pub(super) fn new(corners: &[Point]) -> Self {
        let mut face = Self {
            corners: [[0.0; 3]; MOST_CORNERS],
            count: 0,
        };
        for &corner in corners {
            face.push(corner);
        }
        face
    }

    fn push(&mut self, corner: Point) {
        self.corners[self.count] = corner;
        self.count += 1;
    }

    pub(super) fn corners(&self) -> &[Point] {
        &self.corners[..self.count]
    }

    /// The part where a linear function is not negative. A crossing is computed from the corner that stays, so that
    /// both faces at an edge find the same.
    fn clipped(&self, function: impl Fn(&Point) -> f64) -> Self {
        let mut left = Self::new(&[]);
        let corners = self.corners();
        for (k, p) in corners.iter().enumerate() {
            let q = &corners[(k + 1) % corners.len()];
            let (at_p, at_q) = (function(p), function(q));
            let crossing = |from: &Point, to: &Point, a: f64, b: f64| {
                let t = a / (a - b);
                std::array::from_fn(|axis| from[axis] + t * (to[axis] - from[axis]))
            };
            if at_p >= 0.0 {
                left.push(*p);
                if at_q < 0.0 && at_p > 0.0 {
                    left.push(crossing(p, q, at_p, at_q));
                }
            } else if at_q > 0.0 {
                left.push(crossing(q, p, at_q, at_p));
            }
        }
        left
    }

    fn not_below(&self, axis: usize, limit: f64) -> Self {
        let mut left = self.clipped(|corner| corner[axis] - limit);
        for corner in &mut left.corners[..left.count] {
            corner[axis] = corner[axis].max(limit);
        }
        left
    }

    fn not_above(&self, axis: usize, limit: f64) -> Self {
        let mut left = self.clipped(|corner| limit - corner[axis]);
        for corner in &mut left.corners[..left.count] {
            corner[axis] = corner[axis].min(limit);
        }
        left
    }

    /// Its part within a rectangle in plan.
    pub(super) fn in_plan(&self, lower: [f64; 2], upper: [f64; 2]) -> Self {
        let mut left = *self;
        for axis in 0..2 {
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for corner in left.corners() {
                least = least.min(corner[axis]);
                most = most.max(corner[axis]);
            }
            if least < lower[axis] {
                left = left.not_below(axis, lower[axis]);
            }
            if most > upper[axis] {
                left = left.not_above(axis, upper[axis]);
            }
        }
        left
    }

    /// Its part to the left of a line in plan, from p to q.
    fn left_of(&self, p: [f64; 2], q: [f64; 2]) -> Self {
        let along = [q[0] - p[0], q[1] - p[1]];
        self.clipped(|x| along[0] * (x[1] - p[1]) - along[1] * (x[0] - p[0]))
    }

    /// As seen from a level.
    pub(super) fn lowered(&self, level: f64) -> Self {
        let mut seen = *self;
        for corner in &mut seen.corners[..seen.count] {
            corner[2] -= level;
        }
        seen
    }

    /// The lowest and highest of its corners on an axis.
    pub(super) fn extent(&self, axis: usize) -> [f64; 2] {
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        self.corners().iter().fold(start, |[least, most], corner| {
            [least.min(corner[axis]), most.max(corner[axis])]
        })
    }

    /// Area in plan, positive where it faces up.
    pub(super) fn area_in_plan(&self) -> f64 {
        let mut moments = Moments::default();
        moments.add_prism(self, 1.0, 1.0);
        moments.volume
    }
}

/// Volume and first moments \[length³, length⁴\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    pub(super) volume: f64,
    pub(super) moment: Point,
}

impl Moments {
    /// The part that they are of, from the lower corner of its box.
    pub(super) fn part(&self, lower: Point, upper: Point) -> Part<3> {
        let whole = Part::whole(lower, upper).volume;
        if self.volume <= ROUND_OFF * whole {
            return Part::NOTHING;
        }
        Part {
            volume: self.volume,
            centroid: std::array::from_fn(|axis| lower[axis] + self.moment[axis] / self.volume),
        }
    }

    /// The prism under a face, from level 0 up to at most this height.
    pub(super) fn add_under(&mut self, face: &Face, height: f64, sign: f64) {
        let [least, most] = face.extent(2);
        if face.count < 3 || most <= 0.0 {
            return;
        }
        if least >= height {
            return self.add_prism(face, height, sign);
        }
        let mut slope = *face;
        if most > height {
            self.add_prism(&face.not_below(2, height), height, sign);
            slope = slope.not_above(2, height);
        }
        if least < 0.0 {
            slope = slope.not_below(2, 0.0);
        }
        self.add_slope(&slope, sign);
    }

    /// Of prisms of this height, if these are of prisms of height 1.
    pub(super) fn of_height(&self, height: f64) -> Self {
        let [x, y, z] = self.moment;
        Self {
            volume: self.volume * height,
            moment: [x * height, y * height, z * height * height],
        }
    }

    /// Of the area that a face covers in plan, with this height.
    pub(super) fn add_prism(&mut self, face: &Face, height: f64, sign: f64) {
        for [a, b, c] in fan(face.corners()) {
            let volume = sign * height * area(a, b, c);
            self.volume += volume;
            for axis in 0..2 {
                self.moment[axis] += volume * (a[axis] + b[axis] + c[axis]) / 3.0;
            }
            self.moment[2] += 0.5 * height * volume;
        }
    }

    /// Under a face that is not below 0.
    fn add_slope(&mut self, face: &Face, sign: f64) {
        for [a, b, c] in fan(face.corners()) {
            let area = sign * area(a, b, c);
            let height = a[2] + b[2] + c[2];
            // The integral of a product of linear functions over a triangle.
            let product = |axis: usize| {
                let each = a[axis] * a[2] + b[axis] * b[2] + c[axis] * c[2];
                area / 12.0 * ((a[axis] + b[axis] + c[axis]) * height + each)
            };
            self.volume += area * height / 3.0;
            self.moment[0] += product(0);
            self.moment[1] += product(1);
            self.moment[2] += 0.5 * product(2);
        }
    }
}

fn fan(corners: &[Point]) -> impl Iterator<Item = [&Point; 3]> {
    (2..corners.len()).map(|k| [&corners[0], &corners[k - 1], &corners[k]])
}

fn area(a: &Point, b: &Point, c: &Point) -> f64 {
    0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
}

/// Calls with the part of a face over a polygon in plan, as faces with signs that add up to it: the polygon is the
/// sum of the triangles between its first corner and its sides, counted with their sense.
pub(super) fn over(face: &Face, plan: &Polygon, mut call: impl FnMut(&Face, f64)) {
    for k in 2..plan.len() {
        let [a, mut b, mut c] = [plan[0], plan[k - 1], plan[k]];
        let cross = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        if cross == 0.0 {
            continue;
        }
        if cross < 0.0 {
            (b, c) = (c, b);
        }
        let part = face.left_of(a, b).left_of(b, c).left_of(c, a);
        if part.count > 2 {
            call(&part, cross.signum());
        }
    }
}

/// Triangles by their corners, and where they lie in plan.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Facets {
    pub(super) points: Vec<Point>,
    pub(super) triangles: Vec<[u32; 3]>,
    lower: Point,
    upper: Point,
    bins: [usize; 2],
    /// By bin, where its triangles begin in `of_bin`; one more at the end.
    first: Vec<u32>,
    of_bin: Vec<u32>,
}

impl Facets {
    /// Sorts triangles between points, one or more.
    pub(super) fn new(points: Vec<Point>, triangles: Vec<[u32; 3]>) -> Self {
        let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &corner in triangles.iter().flatten() {
            for axis in 0..3 {
                lower[axis] = lower[axis].min(points[corner as usize][axis]);
                upper[axis] = upper[axis].max(points[corner as usize][axis]);
            }
        }
        // Two triangles to a bin or so, bins as square as may be.
        let size = [upper[0] - lower[0], upper[1] - lower[1]];
        let count = 0.5 * triangles.len() as f64;
        let ratio = [size[0] / size[1], size[1] / size[0]];
        let bins = ratio.map(|ratio| {
            let along = (count * ratio).sqrt();
            let along = if along.is_finite() { along } else { 1.0 };
            along.clamp(1.0, MOST_BINS.min(count.max(1.0))) as usize
        });
        let mut facets = Self {
            points,
            triangles,
            lower,
            upper,
            bins,
            first: vec![0; bins[0] * bins[1] + 1],
            of_bin: Vec::new(),
        };
        let ranges: Vec<_> = (0..facets.triangles.len())
            .map(|triangle| facets.range_of(triangle))
            .collect();
        let each = |range: &[[usize; 2]; 2], call: &mut dyn FnMut(usize)| {
            for y in range[0][1]..=range[1][1] {
                for x in range[0][0]..=range[1][0] {
                    call(y * bins[0] + x);
                }
            }
        };
        for range in &ranges {
            each(range, &mut |bin| facets.first[bin + 1] += 1);
        }
        for bin in 0..bins[0] * bins[1] {
            facets.first[bin + 1] += facets.first[bin];
        }
        let mut next = facets.first.clone();
        let total = facets.first.last().map_or(0, |&total| total as usize);
        facets.of_bin = vec![0; total];
        for (triangle, range) in ranges.iter().enumerate() {
            each(range, &mut |bin| {
                facets.of_bin[next[bin] as usize] = triangle as u32;
                next[bin] += 1;
            });
        }
        facets
    }

    pub(super) fn bounds(&self) -> (Point, Point) {
        (self.lower, self.upper)
    }

    pub(super) fn corners_of(&self, triangle: usize) -> [Point; 3] {
        self.triangles[triangle].map(|corner| self.points[corner as usize])
    }

    /// The bin of a place in plan.
    fn bin(&self, x: f64, axis: usize) -> usize {
        let size = self.upper[axis] - self.lower[axis];
        let place = (x - self.lower[axis]) / size * self.bins[axis] as f64;
        // The cast takes NaN and what is below to 0.
        (place as usize).min(self.bins[axis] - 1)
    }

    /// The first and the last bin of a triangle.
    fn range_of(&self, triangle: usize) -> [[usize; 2]; 2] {
        let corners = self.corners_of(triangle);
        let along = |axis: usize| corners.map(|corner| self.bin(corner[axis], axis));
        let (x, y) = (along(0), along(1));
        let least = |all: [usize; 3]| all[0].min(all[1]).min(all[2]);
        let most = |all: [usize; 3]| all[0].max(all[1]).max(all[2]);
        [[least(x), least(y)], [most(x), most(y)]]
    }

    /// Calls with each triangle that may be seen within a rectangle in plan, once.
    pub(super) fn each(&self, lower: [f64; 2], upper: [f64; 2], mut call: impl FnMut(usize)) {
        let is_off =
            (0..2).any(|axis| upper[axis] < self.lower[axis] || lower[axis] > self.upper[axis]);
        if is_off {
            return;
        }
        let from = [self.bin(lower[0], 0), self.bin(lower[1], 1)];
        let to = [self.bin(upper[0], 0), self.bin(upper[1], 1)];
        for y in from[1]..=to[1] {
            for x in from[0]..=to[0] {
                let bin = y * self.bins[0] + x;
                for &triangle in
                    &self.of_bin[self.first[bin] as usize..self.first[bin + 1] as usize]
                {
                    let [first, _] = self.range_of(triangle as usize);
                    // In the first of the bins that both have.
                    if x == first[0].max(from[0]) && y == first[1].max(from[1]) {
                        call(triangle as usize);
                    }
                }
            }
        }
    }

    /// Calls with what is seen of each triangle within a rectangle in plan, from an origin.
    pub(super) fn each_within(&self, origin: Point, size: [f64; 2], mut call: impl FnMut(&Face)) {
        let upper = [origin[0] + size[0], origin[1] + size[1]];
        self.each([origin[0], origin[1]], upper, |triangle| {
            let corners = self.corners_of(triangle);
            let corners = corners.map(|x| std::array::from_fn(|axis| x[axis] - origin[axis]));
            let beside = (0..2).any(|axis| {
                corners.iter().all(|x| x[axis] <= 0.0)
                    || corners.iter().all(|x| x[axis] >= size[axis])
            });
            if !beside {
                let face = Face::new(&corners).in_plan([0.0; 2], size);
                if face.count > 2 {
                    call(&face);
                }
            }
        });
    }

    /// Whether a triangle runs through the inside of a box.
    pub(super) fn run_into(&self, lower: Point, upper: Point) -> bool {
        let is_off =
            (0..3).any(|axis| upper[axis] <= self.lower[axis] || self.upper[axis] <= lower[axis]);
        let mut found = false;
        if is_off {
            return found;
        }
        let runs = |corners: &[Point]| {
            (0..3).all(|axis| {
                corners.iter().any(|x| x[axis] > lower[axis])
                    && corners.iter().any(|x| x[axis] < upper[axis])
            })
        };
        let [from, to] = [lower, upper].map(|[x, y, _]| [x, y]);
        self.each(from, to, |triangle| {
            let corners = self.corners_of(triangle);
            found =
                found || runs(&corners) && runs(Face::new(&corners).in_plan(from, to).corners());
        });
        found
    }

    /// The height of the plane of a triangle over a place in plan.
    pub(super) fn plane_at(&self, triangle: usize, [x, y]: [f64; 2]) -> f64 {
        let [a, b, c] = self.corners_of(triangle);
        let point = [x, y, 0.0];
        let [first, second] = [area(&a, &point, &c), area(&a, &b, &point)];
        let whole = area(&a, &b, &c);
        a[2] + (first * (b[2] - a[2]) + second * (c[2] - a[2])) / whole
    }

    /// The height over a place in plan: of the triangle that has it most in its middle.
    pub(super) fn height_at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let slack = 1e-9;
        let reach = [0, 1].map(|axis| slack * (self.upper[axis] - self.lower[axis]));
        let (mut height, mut best) = (None, -slack);
        self.each(
            [x - reach[0], y - reach[1]],
            [x + reach[0], y + reach[1]],
            |triangle| {
                let [a, b, c] = self.corners_of(triangle);
                let point = [x, y, 0.0];
                let whole = area(&a, &b, &c);
                let shares = [
                    area(&point, &b, &c),
                    area(&a, &point, &c),
                    area(&a, &b, &point),
                ];
                let shares = shares.map(|share| share / whole);
                let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
                if least >= best {
                    best = least;
                    height = Some(shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2]);
                }
            },
        );
        height
    }
}
