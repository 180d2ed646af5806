//! Outlines of bodies in space: the edges of the regions that they fill, carried by their particles.
//!
//! A line along an edge is cut into parts as long as a particle is wide. Each corner X is carried by the particles whose
//! domains it lay on as they were seeded, to the mean of x_p + F_p (X − X_p) (theory, eq. 41), as the edges of the plane are.
//! Where these places part, the soil has parted, and the line ends.

use std::collections::HashMap;

use igimp_assembly::ParticleSeed;
use igimp_geometry::seed::fill;
use igimp_model::Case;
use igimp_results::paraview::read_back::FrameParticles;

use crate::error::ReportError;
use crate::patches::{PARTED, carried};

/// A corner lies on a domain if it is no further from its centre than this, in half-lengths of the domain \[-\].
const ON: f64 = 1.000_001;
/// Corners that were neighbours and are further apart than so many times their distance have parted \[-\].
const TORN: f64 = 4.0;

type Point = [f64; 3];

/// A corner of a line: the particles that carry it, by number, with its place seen from theirs as they were seeded.
#[derive(Clone, Debug)]
struct Corner {
    carriers: Vec<(usize, Point)>,
    /// Size of a domain there \[m\].
    size: f64,
}

/// The outlines of the bodies of a case in space.
#[derive(Clone, Debug)]
pub struct Outlines {
    lines: Vec<Vec<Corner>>,
}

impl Outlines {
    /// The edges of all bodies of a case, on the particles that these are seeded with.
    ///
    /// # Errors
    /// [`ReportError`] for bodies that cannot be seeded.
    pub fn of(case: &Case<3>) -> Result<Self, ReportError> {
        let grid = case.grid.grid()?;
        let mut lines = Vec::new();
        let mut first = 0;
        for body in &case.bodies {
            let seeds = fill(&grid, &*body.region, body.per_direction, 1.0, 0)?;
            let bins = Bins::new(&seeds);
            let edges = body.region.edges();
            let line = |edge: &Vec<Point>| -> Vec<Corner> {
                let points = bins.cut(edge).into_iter();
                points.map(|at| bins.corner(at, first)).collect()
            };
            lines.extend(edges.iter().map(line));
            first += seeds.len();
        }
        Ok(Self { lines })
    }

    /// The lines of the bodies that are there, as the particles carry them.
    pub fn now(&self, particles: &FrameParticles<3>) -> Vec<Vec<Point>> {
        let numbers = particles.number.iter().zip(0..);
        let places: HashMap<usize, usize> =
            numbers.map(|(&number, place)| (number, place)).collect();
        let now = |corner: &Corner| {
            let there = corner.carriers.iter().filter_map(|&(number, offset)| {
                let place = *places.get(&number)?;
                Some(carried(
                    particles.x[place],
                    particles.def_grad[place],
                    offset,
                ))
            });
            middle(&there.collect::<Vec<_>>(), PARTED * corner.size)
        };
        let mut lines = Vec::new();
        for line in &self.lines {
            let mut run: Vec<Point> = Vec::new();
            let mut size = 0.0;
            for (corner, at) in line.iter().map(|corner| (corner, now(corner))) {
                let is_torn = at
                    .zip(run.last().copied())
                    .is_some_and(|(at, last)| distance(at, last) > TORN * corner.size.max(size));
                if at.is_none() || is_torn {
                    lines.push(std::mem::take(&mut run));
                }
                run.extend(at);
                size = corner.size;
            }
            lines.push(run);
        }
        lines.retain(|line| line.len() > 1);
        lines
    }
}

fn distance(a: Point, b: Point) -> f64 {
    (0..3).fold(0.0_f64, |sum, k| sum.hypot(a[k] - b[k]))
}

/// The middle of places; none where there is none, or one lies further from it than a length.
fn middle(places: &[Point], reach: f64) -> Option<Point> {
    let count = places.len() as f64;
    let mean = std::array::from_fn(|k| places.iter().map(|at| at[k]).sum::<f64>() / count);
    let is_near = |at: &Point| distance(*at, mean) <= reach;
    (!places.is_empty() && places.iter().all(is_near)).then_some(mean)
}

/// The seeds of a body by where they are.
struct Bins<'a> {
    seeds: &'a [ParticleSeed<3>],
    /// Size of the largest domain by direction \[m\].
    size: Point,
    by_bin: HashMap<[i64; 3], Vec<usize>>,
}

impl<'a> Bins<'a> {
    fn new(seeds: &'a [ParticleSeed<3>]) -> Self {
        let mut size = [f64::MIN_POSITIVE; 3];
        for (k, size) in size.iter_mut().enumerate() {
            *size = (seeds.iter()).fold(*size, |most, seed| most.max(2.0 * seed.half_length[k]));
        }
        let mut all = Self {
            seeds,
            size,
            by_bin: HashMap::new(),
        };
        for (number, seed) in seeds.iter().enumerate() {
            all.by_bin.entry(all.bin(&seed.x)).or_default().push(number);
        }
        all
    }

    fn bin(&self, at: &Point) -> [i64; 3] {
        std::array::from_fn(|k| (at[k] / self.size[k]).floor() as i64)
    }

    /// Seeds in a bin and those beside it.
    fn around(&self, at: &Point) -> impl Iterator<Item = usize> + '_ {
        let middle = self.bin(at);
        (0..27).flat_map(move |k| {
            let shift = [k % 3, k / 3 % 3, k / 9].map(|shift| shift - 1);
            let bin: [i64; 3] = std::array::from_fn(|k| middle[k].saturating_add(shift[k]));
            self.by_bin.get(&bin).into_iter().flatten().copied()
        })
    }

    /// How far a point lies from the centre of a domain, in half-lengths of it.
    fn off(&self, seed: usize, at: &Point) -> f64 {
        let seed = &self.seeds[seed];
        (0..3).fold(0.0, |most, k| {
            most.max((at[k] - seed.x[k]).abs() / seed.half_length[k])
        })
    }

    /// A corner at a place, on the domains that touch it, or else on the nearest one; `first` is the number of the first seed.
    fn corner(&self, at: Point, first: usize) -> Corner {
        let on = self.around(&at).filter(|&seed| self.off(seed, &at) <= ON);
        let mut carriers: Vec<usize> = on.collect();
        if carriers.is_empty() {
            let nearest = |seeds: &mut dyn Iterator<Item = usize>| {
                seeds.min_by(|&a, &b| self.off(a, &at).total_cmp(&self.off(b, &at)))
            };
            let near = nearest(&mut self.around(&at));
            carriers.extend(near.or_else(|| nearest(&mut (0..self.seeds.len()))));
        }
        let offset = |seed: usize| std::array::from_fn(|k| at[k] - self.seeds[seed].x[k]);
        Corner {
            carriers: (carriers.iter())
                .map(|&seed| (first + seed, offset(seed)))
                .collect(),
            size: self.size.iter().copied().fold(0.0, f64::max),
        }
    }

    /// A line with corners no further apart than the smallest side of the largest domain.
    fn cut(&self, line: &[Point]) -> Vec<Point> {
        let longest = self.size.iter().copied().fold(f64::INFINITY, f64::min);
        let mut points: Vec<Point> = line.first().copied().into_iter().collect();
        for ends in line.windows(2) {
            let count = (distance(ends[0], ends[1]) / longest).ceil().max(1.0) as usize;
            let place = |k: usize| {
                let share = k as f64 / count as f64;
                std::array::from_fn(|axis| ends[0][axis] + share * (ends[1][axis] - ends[0][axis]))
            };
            points.extend((1..=count).map(place));
        }
        points
    }
}

#[cfg(test)]
mod tests;
