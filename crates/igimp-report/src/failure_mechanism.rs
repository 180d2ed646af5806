//! The way in which soil begins to fail, from two equilibria on the way there: where it shears between
//! them, and the line along which it does so most (theory, eqs. 42 to 44).

mod in_space;

use igimp_results::measure::{Buckets, plane};

pub use in_space::IncrementInSpace;

/// Neighbours for the gradient of the increments lie within so many sizes of a particle \[-\].
const REACH: f64 = 1.55;
/// Soil that moves by more than this share of the most tells about which centre it turns \[-\].
const MOVES: f64 = 0.5;
/// Most of the motion that may be no motion of a rigid body \[-\], by squares.
const NOT_RIGID: f64 = 0.25;
/// A centre further away than so many sizes of the model is one of straight sliding \[-\].
const FAR: f64 = 20.0;
/// The line is drawn where the shear on it is so many times the mean of all soil \[-\] …
const ABOVE_MEAN: f64 = 3.0;
/// … and this share of the most \[-\].
const OF_MOST: f64 = 0.1;
/// The line is at least so many particles long.
const SHORTEST: f64 = 8.0;
/// Rays and places on each are at most so many.
const MOST: f64 = 3000.0;
/// From one ray to the next the line goes at most so many places up or down.
const STRIDE: usize = 2;
/// Price of a place up or down, in parts of the most shear.
const PRICE: f64 = 0.05;

/// Two equilibria and the displacements of the particles between them.
#[derive(Clone, Copy, Debug)]
pub struct Increment<'a> {
    /// Centres of the particles \[length\].
    pub x: &'a [[f64; 2]],
    /// Their half-lengths \[length\].
    pub half_length: &'a [[f64; 2]],
    /// Their volumes.
    pub volume: &'a [f64],
    /// Displacements from the first to the second \[length\].
    pub moved: &'a [[f64; 2]],
}

/// A point of a slip line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipPoint {
    /// Place \[length\].
    pub x: [f64; 2],
    /// Increment of shear strain there \[-\].
    pub shear: f64,
}

impl Increment<'_> {
    /// The largest engineering shear strain of the increment at every particle, from the planes fitted to
    /// the displacements of its neighbours (eq. 42); not a number where there are too few of them.
    pub fn shear(&self) -> Vec<f64> {
        let size = self.size();
        let buckets = Buckets::new(self.x, REACH * size.max(f64::MIN_POSITIVE));
        (0..self.x.len())
            .map(|particle| {
                let at = self.x[particle];
                let reach = REACH * self.size_of(particle);
                let near: Vec<usize> = buckets
                    .near(&at)
                    .filter(|&other| distance(self.x[other], at) <= reach)
                    .collect();
                let gradient = |axis: usize| plane(&near, |p| self.x[p], |p| self.moved[p][axis]);
                match (gradient(0), gradient(1)) {
                    (Some(x), Some(y)) => (x[0] - y[1]).hypot(x[1] + y[0]),
                    _ => f64::NAN,
                }
            })
            .collect()
    }

    /// The line of the most shear, seen from the centre about which the moving soil turns: on every ray
    /// the place of the most, joined so that the line does not jump, as far as it stands out clearly
    /// (eqs. 43 and 44). None where the motion is not that of one body, or no line stands out.
    pub fn slip_line(&self, shear: &[f64]) -> Option<Vec<SlipPoint>> {
        let (centre, middle) = self.centre()?;
        let rays = Rays::new(self, shear, centre)?;
        let ridge = rays.ridge();
        let points = rays.refined(&ridge);
        let clear = |ray: &usize| points[*ray].is_some_and(|point| point.shear >= rays.clear);
        let (mut best, mut run) = (0..0, 0..0);
        for ray in 0..points.len() {
            run = if clear(&ray) {
                run.start..ray + 1
            } else {
                ray + 1..ray + 1
            };
            if run.len() > best.len() {
                best = run.clone();
            }
        }
        // Where the line comes out at the surface it ends; along the surface it would go on alone.
        let out = |ray: usize| rays.comes_out(ray, ridge[ray], middle);
        while best.len() > 1 && out(best.start) && out(best.start + 1) {
            best.start += 1;
        }
        while best.len() > 1 && out(best.end - 1) && out(best.end - 2) {
            best.end -= 1;
        }
        let best: Vec<SlipPoint> = points[best].iter().flatten().copied().collect();
        let line = smoothed(&best);
        let length: f64 = line.windows(2).map(|p| distance(p[0].x, p[1].x)).sum();
        (length >= SHORTEST * self.size()).then_some(line)
    }

    /// Size of the largest particle.
    fn size(&self) -> f64 {
        (0..self.x.len())
            .map(|p| self.size_of(p))
            .fold(0.0, f64::max)
    }

    fn size_of(&self, particle: usize) -> f64 {
        let [a, b] = self.half_length[particle];
        2.0 * a.max(b)
    }

    /// The centre about which the soil that moves turns as a rigid body, by least squares (eq. 43), and
    /// the middle of that soil.
    fn centre(&self) -> Option<([f64; 2], [f64; 2])> {
        let length = |p: usize| self.moved[p][0].hypot(self.moved[p][1]);
        let most = (0..self.x.len()).map(length).fold(0.0, f64::max);
        let moving: Vec<usize> = (0..self.x.len())
            .filter(|&p| length(p) >= MOVES * most)
            .collect();
        if most <= 0.0 || !most.is_finite() {
            return None;
        }
        let weight: f64 = moving.iter().map(|&p| self.volume[p]).sum();
        let mean = |of: &dyn Fn(usize) -> f64| {
            moving.iter().map(|&p| self.volume[p] * of(p)).sum::<f64>() / weight
        };
        let x0 = [0, 1].map(|axis| mean(&|p| self.x[p][axis]));
        let u0 = [0, 1].map(|axis| mean(&|p| self.moved[p][axis]));
        let arm = |p: usize| [0, 1].map(|axis| self.x[p][axis] - x0[axis]);
        let square = mean(&|p| arm(p)[0].powi(2) + arm(p)[1].powi(2));
        let turn = mean(&|p| {
            arm(p)[0] * (self.moved[p][1] - u0[1]) - arm(p)[1] * (self.moved[p][0] - u0[0])
        }) / square;
        let rest = mean(&|p| {
            let [dx, dy] = arm(p);
            let rigid = [u0[0] - turn * dy, u0[1] + turn * dx];
            (self.moved[p][0] - rigid[0]).powi(2) + (self.moved[p][1] - rigid[1]).powi(2)
        });
        let is_rigid = rest <= NOT_RIGID * mean(&|p| length(p).powi(2));
        if !is_rigid {
            return None;
        }
        let (lower, upper) = igimp_geometry::polygon::bounding_box(self.x);
        let far = FAR * distance(lower, upper);
        let speed = u0[0].hypot(u0[1]);
        let away = if turn.abs() * far > speed {
            [-u0[1] / turn, u0[0] / turn]
        } else {
            [-u0[1] * far / speed, u0[0] * far / speed]
        };
        Some(([x0[0] + away[0], x0[1] + away[1]], x0))
    }
}

/// Shear on rays from a centre.
struct Rays {
    centre: [f64; 2],
    /// Angle of the first ray and between rays; radius of the first place and between places.
    angle: [f64; 2],
    radius: [f64; 2],
    /// By ray and place; none outside the soil.
    shear: Vec<Vec<Option<f64>>>,
    most: f64,
    clear: f64,
}

impl Rays {
    fn new(of: &Increment<'_>, shear: &[f64], centre: [f64; 2]) -> Option<Self> {
        let known: Vec<usize> = (0..shear.len()).filter(|&p| shear[p].is_finite()).collect();
        let volume: f64 = known.iter().map(|&p| of.volume[p]).sum();
        let mean = known.iter().map(|&p| of.volume[p] * shear[p]).sum::<f64>() / volume;
        let mut sorted: Vec<f64> = known.iter().map(|&p| shear[p]).collect();
        sorted.sort_by(f64::total_cmp);
        let most = *sorted.get((0.995 * sorted.len() as f64) as usize)?;
        let clear = (ABOVE_MEAN * mean).max(OF_MOST * most);
        let shears: Vec<usize> = known.into_iter().filter(|&p| shear[p] >= clear).collect();
        if shears.is_empty() {
            return None;
        }
        // Angles count from the middle of the shear, so that they do not jump there.
        let middle = [0, 1].map(|axis| {
            shears.iter().map(|&p| of.x[p][axis]).sum::<f64>() / shears.len() as f64 - centre[axis]
        });
        let zero = middle[1].atan2(middle[0]);
        let polar = |p: usize| {
            let [dx, dy] = [0, 1].map(|axis| of.x[p][axis] - centre[axis]);
            let angle =
                (dy.atan2(dx) - zero + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU);
            [angle - std::f64::consts::PI, dx.hypot(dy)]
        };
        let range = |k: usize| {
            let values = || shears.iter().map(|&p| polar(p)[k]);
            [
                values().fold(f64::INFINITY, f64::min),
                values().fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        let (angles, radii) = (range(0), range(1));
        let size = of.size();
        let step = 0.5 * size;
        let by_angle = step / radii[1].max(step);
        let count = |[from, to]: [f64; 2], step: f64| ((to - from) / step).ceil() + 1.0;
        let (rays, places) = (count(angles, by_angle), count(radii, step));
        let few = rays <= MOST && places <= MOST;
        if !few {
            return None;
        }
        let mut found = Self {
            centre,
            angle: [zero + angles[0], by_angle],
            radius: [radii[0], step],
            shear: Vec::new(),
            most,
            clear,
        };
        let buckets = Buckets::new(of.x, size);
        found.shear = (0..rays as usize)
            .map(|ray| {
                let on = |place: usize| {
                    let at = found.place(ray, place as f64);
                    let near = buckets.nearest(of.x, &at)?;
                    let inside = distance(of.x[near], at) <= 0.75 * of.size_of(near);
                    Some(shear[near]).filter(|shear| inside && shear.is_finite())
                };
                (0..places as usize).map(on).collect()
            })
            .collect();
        Some(found)
    }

    fn place(&self, ray: usize, place: f64) -> [f64; 2] {
        let angle = self.angle[0] + ray as f64 * self.angle[1];
        let radius = self.radius[0] + place * self.radius[1];
        [
            self.centre[0] + radius * angle.cos(),
            self.centre[1] + radius * angle.sin(),
        ]
    }

    /// Whether less than a particle of soil lies between a place and the air on the side of the soil that
    /// moves, whose middle is given.
    fn comes_out(&self, ray: usize, place: usize, middle: [f64; 2]) -> bool {
        let radius = self.radius[0] + place as f64 * self.radius[1];
        let inwards = distance(middle, self.centre) < radius;
        (1..=2).any(|k| {
            let other = if inwards {
                place.checked_sub(k)
            } else {
                Some(place + k)
            };
            let soil = other.and_then(|other| *self.shear[ray].get(other)?);
            // Beyond the first and the last place there was no need to look for soil.
            other.is_some_and(|other| other < self.shear[ray].len()) && soil.is_none()
        })
    }

    /// The place on every ray of the line with the largest sum of shear less the price of its jumps
    /// (eq. 44), by dynamic programming.
    fn ridge(&self) -> Vec<usize> {
        let places = self.shear.first().map_or(0, Vec::len);
        let worth = |ray: usize, place: usize| {
            self.shear[ray][place].map_or(0.0, |shear| (shear / self.most).min(1.5))
        };
        let mut sums: Vec<f64> = (0..places).map(|place| worth(0, place)).collect();
        let mut came_from: Vec<Vec<usize>> = Vec::new();
        for ray in 1..self.shear.len() {
            let mut next = Vec::with_capacity(places);
            let mut from = Vec::with_capacity(places);
            for place in 0..places {
                let near = place.saturating_sub(STRIDE)..=(place + STRIDE).min(places - 1);
                let (before, sum) = near
                    .map(|other| (other, sums[other] - PRICE * place.abs_diff(other) as f64))
                    .fold((place, f64::NEG_INFINITY), |best, one| {
                        if one.1 > best.1 { one } else { best }
                    });
                next.push(sum + worth(ray, place));
                from.push(before);
            }
            sums = next;
            came_from.push(from);
        }
        let mut place = (0..places).fold(0, |best, k| if sums[k] > sums[best] { k } else { best });
        let mut line = vec![place];
        for from in came_from.iter().rev() {
            place = from[place];
            line.push(place);
        }
        line.reverse();
        line
    }

    /// Points of the ridge, each in the middle of the shear about its place; none outside the soil.
    fn refined(&self, ridge: &[usize]) -> Vec<Option<SlipPoint>> {
        ridge
            .iter()
            .enumerate()
            .map(|(ray, &place)| {
                let shear = self.shear[ray][place]?;
                let about = place.saturating_sub(4)..(place + 5).min(self.shear[ray].len());
                let (mut sum, mut moment) = (0.0, 0.0);
                for k in about {
                    let above = self.shear[ray][k].map_or(0.0, |s| (s - 0.5 * shear).max(0.0));
                    sum += above;
                    moment += above * k as f64;
                }
                let middle = if sum > 0.0 {
                    moment / sum
                } else {
                    place as f64
                };
                Some(SlipPoint {
                    x: self.place(ray, middle),
                    shear,
                })
            })
            .collect()
    }
}

/// Every point in the mean of itself and of up to four on either side, as many as both sides have.
fn smoothed(line: &[SlipPoint]) -> Vec<SlipPoint> {
    (0..line.len())
        .map(|k| {
            let reach = 4.min(k).min(line.len() - 1 - k);
            let about = &line[k - reach..=k + reach];
            let mean = |of: &dyn Fn(&SlipPoint) -> f64| {
                about.iter().map(of).sum::<f64>() / about.len() as f64
            };
            SlipPoint {
                x: [mean(&|p| p.x[0]), mean(&|p| p.x[1])],
                shear: mean(&|p| p.shear),
            }
        })
        .collect()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Field {
        x: Vec<[f64; 2]>,
        half_length: Vec<[f64; 2]>,
        volume: Vec<f64>,
        moved: Vec<[f64; 2]>,
    }

    impl Field {
        /// A block of 20 × 10 with particles of half a metre.
        fn new(moved: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
            let x: Vec<[f64; 2]> = (0..40 * 20)
                .map(|k| {
                    [
                        0.25 + 0.5 * f64::from(k % 40),
                        0.25 + 0.5 * f64::from(k / 40),
                    ]
                })
                .collect();
            Self {
                half_length: vec![[0.25; 2]; x.len()],
                volume: vec![0.25; x.len()],
                moved: x.iter().map(|&x| moved(x)).collect(),
                x,
            }
        }

        fn increment(&self) -> Increment<'_> {
            Increment {
                x: &self.x,
                half_length: &self.half_length,
                volume: &self.volume,
                moved: &self.moved,
            }
        }
    }

    /// A part that turns about a centre within a radius, over a band of half a metre.
    fn turning(x: [f64; 2], centre: [f64; 2], radius: f64) -> [f64; 2] {
        let [dx, dy] = [x[0] - centre[0], x[1] - centre[1]];
        let turn = 0.01 / (1.0 + ((dx.hypot(dy) - radius) / 0.2).exp());
        [-turn * dy, turn * dx]
    }

    /// ORACLE: u = (γ y, 0) shears by γ, u = (ε x, −ε y) by 2 ε, and a turn by nothing.
    #[test]
    fn shear_is_that_of_the_books() {
        for (moved, expected) in [
            (Field::new(|[_, y]| [0.03 * y, 0.0]), 0.03),
            (Field::new(|[x, y]| [0.01 * x, -0.01 * y]), 0.02),
            (Field::new(|[x, y]| [-0.05 * y, 0.05 * x]), 0.0),
        ] {
            for shear in moved.increment().shear() {
                assert!((shear - expected).abs() < 1e-12, "{shear} for {expected}");
            }
        }
    }

    /// ORACLE: the circle that the field was made of.
    #[test]
    fn a_circle_is_found() {
        let (centre, radius) = ([10.0, 13.0], 8.0);
        let field = Field::new(|x| turning(x, centre, radius));
        let increment = field.increment();
        let line = increment.slip_line(&increment.shear()).unwrap();
        for point in &line {
            let off = distance(point.x, centre) - radius;
            assert!(off.abs() < 0.15, "{off} at {:?}", point.x);
        }
        let (first, last) = (line[0].x, line[line.len() - 1].x);
        assert!(
            first[1] > 9.0 && last[1] > 9.0,
            "from {first:?} to {last:?}"
        );
        assert!(
            (first[0] - last[0]).abs() > 13.0,
            "from {first:?} to {last:?}"
        );
    }

    /// ORACLE: the straight line that the field was made of.
    #[test]
    fn a_plane_is_found() {
        let field = Field::new(|[x, y]| {
            let slides = 0.01 / (1.0 + (-(y - 2.0 - 0.3 * x) / 0.2).exp());
            [-slides, -0.3 * slides]
        });
        let increment = field.increment();
        let line = increment.slip_line(&increment.shear()).unwrap();
        for point in &line {
            let off = point.x[1] - 2.0 - 0.3 * point.x[0];
            assert!(off.abs() < 0.15, "{off} at {:?}", point.x);
        }
        let ends = (line[0].x[0] - line[line.len() - 1].x[0]).abs();
        assert!(ends > 18.0, "{ends}");
    }

    /// GOAL: no line is made up: not of soil at rest, not of even shear, not of two bodies that part.
    #[test]
    fn no_line_where_none_stands_out() {
        for (name, field) in [
            ("rest", Field::new(|_| [0.0; 2])),
            ("even shear", Field::new(|[_, y]| [0.01 * y, 0.0])),
            (
                "parting",
                Field::new(|[x, _]| [if x > 10.0 { 0.01 } else { -0.01 }, 0.0]),
            ),
        ] {
            let increment = field.increment();
            assert_eq!(increment.slip_line(&increment.shear()), None, "{name}");
        }
    }
}
