//! Cylinders and spheres.

use std::f64::consts::PI;

use igimp_text::short;

use super::prism::{both, overlap, placed, seen};
use crate::region::{Cover, Crossing, Part, Region};

/// Points that stand for a circle where straight edges are wanted.
const POINTS_AROUND: u32 = 24;

/// The ends of the upright chord of a circle at a distance from its upright axis.
fn chord(level: f64, radius: f64, distance: f64) -> Option<[f64; 2]> {
    let square = radius * radius - distance * distance;
    (square > 0.0).then(|| [level - square.sqrt(), level + square.sqrt()])
}

/// A circular cylinder along an axis. Its part within a box is exact but for round-off.
#[derive(Clone, Debug, PartialEq)]
pub struct Cylinder {
    /// The axis along which it lies: 0, 1 or 2.
    pub axis: usize,
    /// Centre of its circle, by the two other axes in their order \[length\].
    pub centre: [f64; 2],
    /// Radius \[length\].
    pub radius: f64,
    /// From where to where on its axis \[length\].
    pub between: [f64; 2],
}

/// A sphere. Its part within a box is right to 1e-11 of the smaller of the two volumes' cubes around.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    /// Centre \[length\].
    pub centre: [f64; 3],
    /// Radius \[length\].
    pub radius: f64,
}

/// Area of a disc about the origin within a polygon, positive counter-clockwise, and its first moments.
///
/// Every edge contributes its triangle with the origin as far as it runs inside the circle, and beyond it
/// the sector that it is seen under (theory, eq. 44b).
pub(super) fn disc_within(polygon: &[[f64; 2]], radius: f64) -> (f64, [f64; 2]) {
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    let next = polygon.iter().cycle().skip(1);
    for (p, q) in std::iter::zip(polygon, next) {
        let d = [q[0] - p[0], q[1] - p[1]];
        let a = d[0] * d[0] + d[1] * d[1];
        if a == 0.0 {
            continue;
        }
        let b = p[0] * d[0] + p[1] * d[1];
        let cross = p[0] * d[1] - p[1] * d[0];
        // Half the chord squared, times a.
        let reach = a * radius * radius - cross * cross;
        let root = reach.max(0.0).sqrt();
        let ends = [(-b - root) / a, (-b + root) / a].map(|t| t.clamp(0.0, 1.0));
        let at = |t: f64| [p[0] + t * d[0], p[1] + t * d[1]];
        for (from, to, is_inside) in [
            (0.0, ends[0], false),
            (ends[0], ends[1], reach > 0.0),
            (ends[1], 1.0, false),
        ] {
            if from >= to {
                continue;
            }
            let (u, v) = (at(from), at(to));
            let cross = u[0] * v[1] - u[1] * v[0];
            if is_inside {
                area += 0.5 * cross;
                moment[0] += cross * (u[0] + v[0]) / 6.0;
                moment[1] += cross * (u[1] + v[1]) / 6.0;
            } else {
                let angle = cross.atan2(u[0] * v[0] + u[1] * v[1]);
                let (u, v) = (unit(u), unit(v));
                let cube = radius * radius * radius / 3.0;
                area += 0.5 * radius * radius * angle;
                moment[0] += cube * (v[1] - u[1]);
                moment[1] += cube * (u[0] - v[0]);
            }
        }
    }
    (area, moment)
}

fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let length = x.hypot(y);
    [x / length, y / length]
}

/// A disc about the origin within a rectangle.
fn disc_in_box(lower: [f64; 2], upper: [f64; 2], radius: f64) -> (f64, [f64; 2]) {
    let corners = [lower, [upper[0], lower[1]], upper, [lower[0], upper[1]]];
    match ball_cover(lower, upper, radius) {
        Cover::Nothing => (0.0, [0.0; 2]),
        Cover::Whole => {
            let part = Part::whole(lower, upper);
            (part.volume, part.centroid.map(|x| part.volume * x))
        }
        Cover::Cut => disc_within(&corners, radius),
    }
}

/// How much of a box belongs to a disc or ball about the origin.
fn ball_cover<const D: usize>(lower: [f64; D], upper: [f64; D], radius: f64) -> Cover {
    let (mut nearest, mut furthest) = (0.0, 0.0);
    for axis in 0..D {
        let (from, to) = (lower[axis], upper[axis]);
        let near = from.max(-to).max(0.0);
        let far = from.abs().max(to.abs());
        nearest += near * near;
        furthest += far * far;
    }
    if nearest >= radius * radius {
        Cover::Nothing
    } else if furthest <= radius * radius {
        Cover::Whole
    } else {
        Cover::Cut
    }
}

fn less<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

impl Region<3> for Cylinder {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let [from, to] = self.between;
        (
            placed(self.centre.map(|x| x - self.radius), self.axis, from),
            placed(self.centre.map(|x| x + self.radius), self.axis, to),
        )
    }

    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        let stretch = [lower[self.axis], upper[self.axis]];
        let Some([from, to]) = overlap(self.between, stretch) else {
            return Part::NOTHING;
        };
        let [lower, upper] =
            [lower, upper].map(|corner| less(seen(corner, self.axis), self.centre));
        let (area, moment) = disc_in_box(lower, upper, self.radius);
        if area <= 0.0 {
            return Part::NOTHING;
        }
        let centroid = std::array::from_fn(|axis| self.centre[axis] + moment[axis] / area);
        Part {
            volume: area * (to - from),
            centroid: placed(centroid, self.axis, 0.5 * (from + to)),
        }
    }

    fn cover(&self, lower: [f64; 3], upper: [f64; 3]) -> Cover {
        let stretch = [lower[self.axis], upper[self.axis]];
        let [lower, upper] =
            [lower, upper].map(|corner| less(seen(corner, self.axis), self.centre));
        both(overlap(self.between, stretch), stretch, || {
            ball_cover(lower, upper, self.radius)
        })
    }

    fn encloses(&self, point: [f64; 3]) -> bool {
        let [from, to] = self.between;
        let [x, y] = less(seen(point, self.axis), self.centre);
        (from..=to).contains(&point[self.axis]) && x.hypot(y) <= self.radius
    }

    fn crossings(&self, place: &[f64; 3]) -> Vec<Crossing> {
        let [from, to] = self.between;
        let [x, y] = less(seen(*place, self.axis), self.centre);
        let stretch = if self.axis == 2 {
            (x.hypot(y) < self.radius).then_some([from, to])
        } else {
            let is_met = (from..to).contains(&place[self.axis]);
            chord(self.centre[1], self.radius, x).filter(|_| is_met)
        };
        stretch.into_iter().flat_map(Crossing::ends).collect()
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        let points = (0..POINTS_AROUND).flat_map(|k| {
            let angle = 2.0 * PI * f64::from(k) / f64::from(POINTS_AROUND);
            let (sine, cosine) = angle.sin_cos();
            let at = [
                self.centre[0] + self.radius * cosine,
                self.centre[1] + self.radius * sine,
            ];
            self.between.map(|along| placed(at, self.axis, along))
        });
        points.collect()
    }

    fn words(&self) -> String {
        let name = ["x", "y", "z"][self.axis];
        let [from, to] = self.between.map(short);
        let [a, b] = self.centre.map(short);
        format!(
            "cylinder of radius {} about ({a}, {b}) from {name} = {from} to {to}",
            short(self.radius)
        )
    }
}

/// Half of the places and the weights of Gauss and Legendre's rule with 16 points on \[-1, 1\].
const GAUSS: [[f64; 2]; 8] = [
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_6],
    [0.458_016_777_657_227_4, 0.169_156_519_395_002_54],
    [0.617_876_244_402_643_7, 0.149_595_988_816_576_73],
    [0.755_404_408_355_003, 0.124_628_971_255_533_87],
    [0.865_631_202_387_831_7, 0.095_158_511_682_492_78],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_89],
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_095],
];

impl Region<3> for Sphere {
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        (
            self.centre.map(|x| x - self.radius),
            self.centre.map(|x| x + self.radius),
        )
    }

    /// Discs of exact area, summed over z. Between the levels where circles begin to touch sides and
    /// corners the area is smooth but for roots at the ends, which z = cos θ takes away.
    fn within(&self, lower: [f64; 3], upper: [f64; 3]) -> Part<3> {
        let [lower, upper] = [lower, upper].map(|corner| less(corner, self.centre));
        let sides = [lower[0], upper[0], lower[1], upper[1]].map(|side| side * side);
        let corners = [
            sides[0] + sides[2],
            sides[0] + sides[3],
            sides[1] + sides[2],
            sides[1] + sides[3],
        ];
        let [from, to] = [lower[2].max(-self.radius), upper[2].min(self.radius)];
        let mut levels = vec![from, to];
        for square in sides.into_iter().chain(corners) {
            let height = (self.radius * self.radius - square).max(0.0).sqrt();
            levels.extend([-height, height].iter().filter(|&&z| from < z && z < to));
        }
        levels.sort_by(f64::total_cmp);
        let [lower, upper] = [lower, upper].map(|[x, y, _]| [x, y]);
        let (mut volume, mut moment) = (0.0, [0.0; 3]);
        for pair in levels.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            if half <= 0.0 {
                continue;
            }
            for [place, weight] in GAUSS {
                for place in [-place, place] {
                    let (sine, cosine) = (0.5 * PI * (1.0 + place)).sin_cos();
                    let z = middle - half * cosine;
                    let share = weight * 0.5 * PI * half * sine;
                    let radius = (self.radius * self.radius - z * z).max(0.0).sqrt();
                    let (area, [x, y]) = disc_in_box(lower, upper, radius);
                    volume += share * area;
                    moment[0] += share * x;
                    moment[1] += share * y;
                    moment[2] += share * area * z;
                }
            }
        }
        if volume <= 0.0 {
            return Part::NOTHING;
        }
        Part {
            volume,
            centroid: std::array::from_fn(|axis| self.centre[axis] + moment[axis] / volume),
        }
    }

    fn cover(&self, lower: [f64; 3], upper: [f64; 3]) -> Cover {
        ball_cover(
            less(lower, self.centre),
            less(upper, self.centre),
            self.radius,
        )
    }

    fn encloses(&self, point: [f64; 3]) -> bool {
        let [x, y, z] = less(point, self.centre);
        x.hypot(y).hypot(z) <= self.radius
    }

    fn crossings(&self, place: &[f64; 3]) -> Vec<Crossing> {
        let [x, y, _] = less(*place, self.centre);
        let stretch = chord(self.centre[2], self.radius, x.hypot(y));
        stretch.into_iter().flat_map(Crossing::ends).collect()
    }

    fn corners(&self) -> Vec<[f64; 3]> {
        let ring = |level: f64| {
            let radius = self.radius * (1.0 - level * level).sqrt();
            (0..POINTS_AROUND).map(move |k| {
                let angle = 2.0 * PI * f64::from(k) / f64::from(POINTS_AROUND);
                let (sine, cosine) = angle.sin_cos();
                let off = [radius * cosine, radius * sine, self.radius * level];
                std::array::from_fn(|axis| self.centre[axis] + off[axis])
            })
        };
        let poles = [-1.0, 1.0].map(|side| {
            let [x, y, z] = self.centre;
            [x, y, z + side * self.radius]
        });
        let rings = [-0.75, -0.5, 0.0, 0.5, 0.75].into_iter().flat_map(ring);
        rings.chain(poles).collect()
    }

    fn words(&self) -> String {
        let [x, y, z] = self.centre.map(short);
        format!(
            "sphere of radius {} about ({x}, {y}, {z})",
            short(self.radius)
        )
    }
}
