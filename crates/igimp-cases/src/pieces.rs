//! The bodies as they are drawn: pieces that tile them, carried and deformed by their particles.
//!
//! A particle stands for the part of its body within its part of a cell. That piece is cut by the edges
//! of the body as it was seeded, and moves with the particle: a corner X goes to
//! x_p + F_p (X − X_p) (theory, eq. 41). Corners that neighbours share meet in the middle of where these
//! carry them, so that soil has no gaps; where it parts they go their own ways.

use std::collections::HashMap;
use std::ops::Range;

use igimp_assembly::Particles;

use crate::case::Case;
use crate::error::CaseError;
use crate::polygon::Polygon;
use crate::seed::{Piece, fill_in_pieces};

/// Corners that a particle carries further from their middle than so many times its size have
/// parted \[-\].
const PARTED: f64 = 1.5;
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
        let [dx, dy] = self.offset;
        Some([0, 1].map(|a| x[a] + f[a][0] * dx + f[a][1] * dy))
    }
}

/// The particles that are there, found by their numbers: bodies are placed and taken away.
struct There<'a> {
    particles: &'a Particles<2>,
    /// Place by number.
    places: Vec<Option<usize>>,
}

impl<'a> There<'a> {
    fn new(particles: &'a Particles<2>) -> Self {
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
}

impl Pieces {
    /// Cuts the bodies of a case as they are seeded.
    ///
    /// # Errors
    /// [`CaseError`] for bodies that cannot be seeded.
    pub fn of(case: &Case) -> Result<Self, CaseError> {
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
        };
        let mut first = 0;
        for body in &case.bodies {
            let (seeds, pieces) =
                fill_in_pieces(&grid, body.polygon(), body.per_direction, 0.0, 0)?;
            let own = all.corners.len();
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
                all.particles.push(first + particle);
                all.corners.push(corners);
            }
            all.edges.extend(outline(&all.corners[own..]));
            all.bodies.push(first..first + seeds.len());
            first += seeds.len();
        }
        all.places = numbers.len();
        Ok(all)
    }

    /// The pieces of the bodies that are there as the particles carry them, each with the place of its particle.
    pub fn now(&self, particles: &Particles<2>) -> (Vec<Polygon>, Vec<usize>) {
        let there = There::new(particles);
        let met = self.met(&there);
        std::iter::zip(&self.corners, &self.particles)
            .filter_map(|(corners, &number)| {
                let place = there.place_of(number)?;
                Some((moved(corners, &met, &there), place))
            })
            .unzip()
    }

    /// The edges of the bodies that are there as the particles carry them, closed lines.
    pub fn edges(&self, particles: &Particles<2>) -> Vec<Polygon> {
        let there = There::new(particles);
        let met = self.met(&there);
        let edges = self.edges.iter().filter(|edge| there.has(edge));
        edges.map(|edge| moved(edge, &met, &there)).collect()
    }

    /// By body of the case: whether it is there.
    pub fn there(&self, particles: &Particles<2>) -> Vec<bool> {
        let there = There::new(particles);
        let is_there = |own: &Range<usize>| {
            let mut numbers = own.clone();
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
                    .map_or(0.0, |place| size(there.particles, place));
            met[corner.place] = met[corner.place]
                .filter(|middle| (middle[0] - at[0]).hypot(middle[1] - at[1]) <= reach);
        }
        met
    }
}

/// The sum of the two sides of a particle as F makes them, and no less than as they were.
fn size(particles: &Particles<2>, particle: usize) -> f64 {
    let f = particles.def_grad[particle];
    let sides = particles.half_length0[particle].map(|half| 2.0 * half);
    let side = |axis: usize| sides[axis] * f[0][axis].hypot(f[1][axis]).max(1.0);
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use igimp_assembly::ParticleFields;

    use super::*;
    use crate::estimate::tests::case;
    use crate::polygon::area_and_centroid;
    use crate::run::Model;

    fn slope() -> Case {
        let mut case = case();
        case.bodies[0].region = Arc::new(vec![[0.0, 0.0], [3.0, 0.0], [1.3, 1.7], [0.0, 1.7]]);
        case
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons
            .iter()
            .map(|polygon| area_and_centroid(polygon).0)
            .sum()
    }

    /// GOAL: a slope is drawn along its line: the pieces of bodies at rest are the bodies.
    #[test]
    fn bodies_at_rest_are_drawn_as_they_are() {
        let case = slope();
        let particles = Model::new(&case).unwrap().1.body.particles;
        let pieces = Pieces::of(&case).unwrap();
        let whole = area_and_centroid(case.bodies[0].polygon()).0;
        assert!((area(&pieces.now(&particles).0) - whole).abs() < 1e-12 * whole);
        let inside = |&[x, y]: &[f64; 2]| y <= 1.7 + 1e-12 && x + y <= 3.0 + 1e-12;
        assert!(pieces.now(&particles).0.iter().flatten().all(inside));
        let edges = pieces.edges(&particles);
        assert!((area(&edges) - whole).abs() < 1e-12 * whole);
    }

    /// GOAL: bodies that were taken away, or are not yet there, are not drawn, and the others by their own particles.
    #[test]
    fn only_what_is_there_is_drawn() {
        let mut case = slope();
        let mut hill = case.bodies[0].clone();
        hill.region = Arc::new(vec![[0.0, 1.7], [1.3, 1.7], [0.8, 2.4], [0.0, 2.4]]);
        let area_of_hill = area_and_centroid(hill.polygon()).0;
        case.bodies.push(hill);
        let (model, state) = Model::new(&case).unwrap();
        let all = state.body.particles;
        let of_hill = |particle: usize| model.seeded.body[all.number[particle]] == 1;
        let pieces = Pieces::of(&case).unwrap();
        assert_eq!(pieces.there(&all), [true, true]);
        let left = all.keeping(of_hill).unwrap();
        assert_eq!(pieces.there(&left), [false, true]);
        let (polygons, whose) = pieces.now(&left);
        assert!(whose.iter().all(|&place| place < left.len()));
        assert!((area(&polygons) - area_of_hill).abs() < 1e-12 * area_of_hill);
        assert!((area(&pieces.edges(&left)) - area_of_hill).abs() < 1e-12 * area_of_hill);
        // The same particles in another order are the same picture.
        let below = all.keeping(|particle| !of_hill(particle)).unwrap();
        let turned = left.joined_by(&below);
        assert_eq!(pieces.edges(&turned), pieces.edges(&all));
        let drawn = |particles: &Particles<2>| {
            let (polygons, whose) = pieces.now(particles);
            std::iter::zip(polygons, whose)
                .map(|(piece, place)| (piece, particles.number[place]))
                .collect::<Vec<_>>()
        };
        assert_eq!(drawn(&turned), drawn(&all));
    }

    /// GOAL: neighbours that deform differently leave no gaps, soil that parts is not drawn as joined.
    #[test]
    fn neighbours_meet_and_parted_soil_does_not() {
        let case = slope();
        let start = Model::new(&case).unwrap().1.body.particles;
        let pieces = Pieces::of(&case).unwrap();
        let with = |moved: &dyn Fn([f64; 2]) -> [f64; 2]| {
            let mut fields: ParticleFields<2> = (*start).clone();
            for x in &mut fields.x {
                *x = moved(*x);
            }
            Particles::from_fields(fields).unwrap()
        };
        // Particles move apart by a fifth of their size and do not know of it.
        let spread = with(&|[x, y]| [1.2 * x, y]);
        let polygons = pieces.now(&spread).0;
        let edges = pieces.edges(&spread);
        assert_eq!(edges.len(), 1);
        assert!((area(&polygons) - area(&edges)).abs() < 1e-12 * area(&edges));
        let parted = with(&|[x, y]| [if x > 1.0 { x + 5.0 } else { x }, y]);
        let across = |polygon: &Polygon| {
            let [low, high] = polygon
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| {
                    [a.min(p[0]), b.max(p[0])]
                });
            high - low
        };
        assert!(
            pieces
                .now(&parted)
                .0
                .iter()
                .all(|polygon| across(polygon) < 0.3)
        );
    }

    /// GOAL: soil in one motion has neither gaps nor combs: under simple shear and a turn the pieces
    /// tile the moved body.
    #[test]
    fn one_motion_leaves_no_gaps() {
        let case = slope();
        let particles = Model::new(&case).unwrap().1.body.particles;
        let f = [[0.8, 1.1], [-0.5, 1.4]];
        let moved = |[x, y]: [f64; 2]| [0, 1].map(|a| 5.0 + f[a][0] * x + f[a][1] * y);
        let mut fields: ParticleFields<2> = (*particles).clone();
        for particle in 0..fields.x.len() {
            fields.x[particle] = moved(fields.x[particle]);
            fields.def_grad[particle] = f;
        }
        let particles = Particles::from_fields(fields).unwrap();
        let pieces = Pieces::of(&case).unwrap();
        let outline: Polygon = case.bodies[0].polygon().iter().map(|&x| moved(x)).collect();
        let whole = area_and_centroid(&outline).0;
        assert!((area(&pieces.now(&particles).0) - whole).abs() < 1e-12 * whole);
        assert!((area(&pieces.edges(&particles)) - whole).abs() < 1e-12 * whole);
    }
}
