//! The bodies as they are drawn: pieces that tile them, carried and deformed by their particles.
//!
//! A particle stands for the part of its body within its part of a cell. That piece is cut by the edges
//! of the body as it was seeded, and moves with the particle: a corner X goes to
//! x_p + F_p (X − X_p) (theory, eq. 41), but no further than three times as far off as it was.
//! Corners that neighbours share meet in the middle of where these carry them, so that soil has no
//! gaps; where it parts they go their own ways.

use std::collections::HashMap;
use std::ops::Range;

use igimp_assembly::Particles;
use igimp_geometry::polygon::Polygon;
use igimp_geometry::seed::{Piece, fill_in_pieces};
use igimp_model::Case;

use crate::error::ReportError;

/// Corners that a particle carries further from their middle than so many times its size have
/// parted \[-\].
pub(crate) const PARTED: f64 = 1.5;
/// A corner is drawn no further from its particle than so many times as far as it was seeded \[-\]: soil that has flowed far is
/// sheared into threads that no soil has.
const MOST_STRETCHED: f64 = 3.0;
/// Corners closer than this share of the smallest cell are one \[-\].
const SAME: f64 = 1e-6;

/// A corner of a piece.
#[derive(Clone, Copy, Debug)]
struct Corner {
    /// Number of the particle, which it keeps.
    particle: usize,
    /// Its place seen from the particle's, before both moved.
    offset: [f64; 2],
    /// Number of the place, which it may share with corners of other pieces.
    place: usize,
}

impl Corner {
    /// Where its particle carries it, if that is there.
    fn carried(&self, there: &There<'_>) -> Option<[f64; 2]> {
        let particle = there.place_of(self.particle)?;
        let (x, f) = (
            there.particles.x[particle],
            there.particles.def_grad[particle],
        );
        Some(carried(x, f, self.offset))
    }
}

/// Where a particle at `x` with the deformation gradient `f` carries a point (theory, eq. 41) that stood at an offset from it,
/// but no further than it may be stretched \[m\].
pub(crate) fn carried<const D: usize>(x: [f64; D], f: [[f64; D]; D], offset: [f64; D]) -> [f64; D] {
    let length = |v: &[f64; D]| v.iter().fold(0.0_f64, |sum, x| sum.hypot(*x));
    let arm: [f64; D] = std::array::from_fn(|a| (0..D).map(|b| f[a][b] * offset[b]).sum());
    let stretch = length(&arm) / length(&offset);
    let shown = if stretch > MOST_STRETCHED {
        MOST_STRETCHED / stretch
    } else {
        1.0
    };
    std::array::from_fn(|a| x[a] + shown * arm[a])
}

/// Columns of particles that carry pieces: of a body, or of a frame that was read back.
#[derive(Clone, Copy, Debug)]
pub struct Carriers<'a> {
    /// Centres \[m\].
    pub x: &'a [[f64; 2]],
    /// Deformation gradients \[-\].
    pub def_grad: &'a [[[f64; 2]; 2]],
    /// Half-lengths as seeded \[m\].
    pub half_length0: &'a [[f64; 2]],
    /// The numbers that particles keep.
    pub number: &'a [usize],
}

impl<'a> From<&'a Particles<2>> for Carriers<'a> {
    fn from(particles: &'a Particles<2>) -> Self {
        Self {
            x: &particles.x,
            def_grad: &particles.def_grad,
            half_length0: &particles.half_length0,
            number: &particles.number,
        }
    }
}

/// The particles that are there, found by their numbers: bodies are placed and taken away.
struct There<'a> {
    particles: Carriers<'a>,
    /// Place by number.
    places: Vec<Option<usize>>,
}

impl<'a> There<'a> {
    fn new(particles: Carriers<'a>) -> Self {
        let count = particles.number.iter().max().map_or(0, |last| last + 1);
        let mut places = vec![None; count];
        for (place, &number) in particles.number.iter().enumerate() {
            places[number] = Some(place);
        }
        Self { particles, places }
    }

    fn place_of(&self, number: usize) -> Option<usize> {
        self.places.get(number).copied().flatten()
    }

    /// Whether the body of a line of corners is there.
    fn has(&self, corners: &[Corner]) -> bool {
        let is_there = |corner: &Corner| self.place_of(corner.particle).is_some();
        corners.iter().all(is_there)
    }
}

/// The pieces of all bodies of a case, and their edges.
#[derive(Clone, Debug)]
pub struct Pieces {
    particles: Vec<usize>,
    corners: Vec<Vec<Corner>>,
    places: usize,
    /// Closed lines; the first corner stands at the end once more.
    edges: Vec<Vec<Corner>>,
    /// By body: the numbers of its particles.
    bodies: Vec<Range<usize>>,
    /// By number of a particle: its half-lengths as seeded \[m\].
    half_lengths: Vec<[f64; 2]>,
}

impl Pieces {
    /// Cuts the bodies of a case as they are seeded.
    ///
    /// # Errors
    /// [`ReportError`] for bodies that cannot be seeded.
    pub fn of(case: &Case<2>) -> Result<Self, ReportError> {
        let grid = case.grid.grid()?;
        let [width, height] = case.grid.smallest_cell();
        let near = SAME * width.min(height);
        let mut numbers: HashMap<[i64; 2], usize> = HashMap::new();
        let mut all = Self {
            particles: Vec::new(),
            corners: Vec::new(),
            places: 0,
            edges: Vec::new(),
            bodies: Vec::new(),
            half_lengths: Vec::new(),
        };
        let mut first = 0;
        for body in &case.bodies {
            let (seeds, pieces) =
                fill_in_pieces(&grid, body.polygon(), body.per_direction, 0.0, 0)?;
            let start = all.corners.len();
            for Piece { particle, polygon } in pieces {
                let mut corners: Vec<Corner> = Vec::with_capacity(polygon.len());
                for at in polygon {
                    let next = numbers.len();
                    let place = *numbers
                        .entry(at.map(|x| (x / near).round() as i64))
                        .or_insert(next);
                    if corners.last().is_none_or(|last| last.place != place) {
                        corners.push(Corner {
                            particle: first + particle,
                            offset: [0, 1].map(|axis| at[axis] - seeds[particle].x[axis]),
                            place,
                        });
                    }
                }
                if corners.len() > 1 && corners[0].place == corners[corners.len() - 1].place {
                    corners.pop();
                }
                // A sliver of the width of round-off has no sides of its own.
                if corners.len() > 2 {
                    all.particles.push(first + particle);
                    all.corners.push(corners);
                }
            }
            all.edges.extend(outline(&all.corners[start..]));
            all.bodies.push(first..first + seeds.len());
            all.half_lengths
                .extend(seeds.iter().map(|seed| seed.half_length));
            first += seeds.len();
        }
        all.places = numbers.len();
        Ok(all)
    }

    /// Half-lengths as seeded of the particle of a number \[m\]; none for numbers that the case has not.
    pub fn half_length(&self, number: usize) -> Option<[f64; 2]> {
        self.half_lengths.get(number).copied()
    }

    /// The pieces of the bodies that are there as the particles carry them, each with the place of its particle.
    pub fn now<'a>(&self, particles: impl Into<Carriers<'a>>) -> (Vec<Polygon>, Vec<usize>) {
        let there = There::new(particles.into());
        let met = self.met(&there);
        std::iter::zip(&self.corners, &self.particles)
            .filter_map(|(corners, &number)| {
                let place = there.place_of(number)?;
                Some((moved(corners, &met, &there), place))
            })
            .unzip()
    }

    /// The edges of the bodies that are there as the particles carry them, closed lines.
    pub fn edges<'a>(&self, particles: impl Into<Carriers<'a>>) -> Vec<Polygon> {
        let there = There::new(particles.into());
        let met = self.met(&there);
        let edges = self.edges.iter().filter(|edge| there.has(edge));
        edges.map(|edge| moved(edge, &met, &there)).collect()
    }

    /// By body of the case: whether it is there.
    pub fn there<'a>(&self, particles: impl Into<Carriers<'a>>) -> Vec<bool> {
        let there = There::new(particles.into());
        let is_there = |range: &Range<usize>| {
            let mut numbers = range.clone();
            numbers.any(|number| there.place_of(number).is_some())
        };
        self.bodies.iter().map(is_there).collect()
    }

    /// By place: where its corners meet, if they have not parted.
    fn met(&self, there: &There<'_>) -> Vec<Option<[f64; 2]>> {
        let carried = |corner: &Corner| Some((*corner, corner.carried(there)?));
        let all = || self.corners.iter().flatten().filter_map(carried);
        let mut sums = vec![([0.0; 2], 0.0); self.places];
        for (corner, at) in all() {
            let (sum, count) = &mut sums[corner.place];
            *sum = [sum[0] + at[0], sum[1] + at[1]];
            *count += 1.0;
        }
        let mut met: Vec<Option<[f64; 2]>> = sums
            .into_iter()
            .map(|(sum, count)| Some(sum.map(|sum| sum / count)))
            .collect();
        for (corner, at) in all() {
            let reach = PARTED
                * there
                    .place_of(corner.particle)
                    .map_or(0.0, |place| size(&there.particles, place));
            met[corner.place] = met[corner.place]
                .filter(|middle| (middle[0] - at[0]).hypot(middle[1] - at[1]) <= reach);
        }
        met
    }
}

/// The sum of the two sides of a particle as F makes them, and no less than as they were.
fn size(particles: &Carriers<'_>, particle: usize) -> f64 {
    let f = particles.def_grad[particle];
    let sides = particles.half_length0[particle].map(|half| 2.0 * half);
    let side = |axis: usize| sides[axis] * f[0][axis].hypot(f[1][axis]).clamp(1.0, MOST_STRETCHED);
    side(0) + side(1)
}

fn moved(corners: &[Corner], met: &[Option<[f64; 2]>], there: &There<'_>) -> Polygon {
    let now = |corner: &Corner| met[corner.place].or_else(|| corner.carried(there));
    corners.iter().filter_map(now).collect()
}

/// The closed lines around pieces: sides that no other piece goes along the other way.
fn outline(pieces: &[Vec<Corner>]) -> Vec<Vec<Corner>> {
    let sides = || {
        pieces.iter().flat_map(|corners| {
            (0..corners.len()).map(move |k| [corners[k], corners[(k + 1) % corners.len()]])
        })
    };
    let mut ways: HashMap<[usize; 2], usize> = HashMap::new();
    for [from, to] in sides() {
        *ways.entry([from.place, to.place]).or_default() += 1;
    }
    let mut ahead: HashMap<usize, Vec<[Corner; 2]>> = HashMap::new();
    let mut starts = Vec::new();
    for side in sides() {
        let [from, to] = side.map(|corner| corner.place);
        if from != to && !ways.contains_key(&[to, from]) {
            ahead.entry(from).or_default().push(side);
            starts.push(from);
        }
    }
    let mut lines = Vec::new();
    for start in starts {
        let mut line: Vec<Corner> = Vec::new();
        let mut at = start;
        while let Some([from, to]) = ahead.get_mut(&at).and_then(Vec::pop) {
            line.push(from);
            at = to.place;
            if at == start {
                line.push(to);
                break;
            }
        }
        if line.len() > 2 {
            lines.push(line);
        }
    }
    lines
}
