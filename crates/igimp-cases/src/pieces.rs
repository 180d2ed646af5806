//! The bodies as they are drawn: pieces that tile them, carried and deformed by their particles.
//!
//! A particle stands for the part of its body within its part of a cell. That piece is cut by the edges
//! of the body as it was seeded, and moves with the particle: a corner X goes to
//! x_p + F_p (X − X_p) (theory, eq. 41).

use igimp_assembly::Particles;

use crate::case::Case;
use crate::error::CaseError;
use crate::measure::Buckets;
use crate::polygon::Polygon;
use crate::seed::{Piece, fill_in_pieces};

/// A point that moves with a particle: its place seen from the particle's, before both moved.
#[derive(Clone, Copy, Debug)]
struct Carried {
    particle: usize,
    offset: [f64; 2],
}

impl Carried {
    fn now(&self, particles: &Particles<2>) -> [f64; 2] {
        let (x, f) = (
            particles.x[self.particle],
            particles.def_grad[self.particle],
        );
        let [dx, dy] = self.offset;
        [0, 1].map(|a| x[a] + f[a][0] * dx + f[a][1] * dy)
    }
}

/// The pieces of all bodies of a case, and their edges.
#[derive(Clone, Debug)]
pub struct Pieces {
    particles: Vec<usize>,
    corners: Vec<Vec<Carried>>,
    edges: Vec<Vec<Carried>>,
}

impl Pieces {
    /// Cuts the bodies of a case as they are seeded.
    ///
    /// # Errors
    /// [`CaseError`] for bodies that cannot be seeded.
    pub fn of(case: &Case) -> Result<Self, CaseError> {
        let grid = case.grid.grid()?;
        let mut all = Self {
            particles: Vec::new(),
            corners: Vec::new(),
            edges: Vec::new(),
        };
        let mut first = 0;
        for body in &case.bodies {
            let (seeds, pieces) = fill_in_pieces(&grid, &body.polygon, body.per_direction, 0.0, 0)?;
            let centres: Vec<[f64; 2]> = seeds.iter().map(|seed| seed.x).collect();
            let carried = |particle: usize, at: [f64; 2]| Carried {
                particle: first + particle,
                offset: [0, 1].map(|axis| at[axis] - centres[particle][axis]),
            };
            for Piece { particle, polygon } in &pieces {
                all.particles.push(first + particle);
                let corners = polygon.iter().map(|&corner| carried(*particle, corner));
                all.corners.push(corners.collect());
            }
            let size = |seed: &igimp_assembly::ParticleSeed<2>| 2.0 * seed.half_length[0].max(seed.half_length[1]);
            let smallest = seeds.iter().map(size).fold(f64::INFINITY, f64::min);
            let largest = seeds.iter().map(size).fold(0.0, f64::max);
            let buckets = Buckets::new(&centres, 2.0 * largest);
            let edge = along(&body.polygon, smallest);
            let edge = edge.into_iter().filter_map(|at| {
                let nearest = buckets.nearest(&centres, &at)?;
                Some(carried(nearest, at))
            });
            all.edges.push(edge.collect());
            first += seeds.len();
        }
        Ok(all)
    }

    /// The pieces as the particles of the case carry them, each with its particle.
    ///
    /// # Panics
    /// If there are fewer particles than the case has.
    pub fn now(&self, particles: &Particles<2>) -> (Vec<Polygon>, &[usize]) {
        let polygon = |corners: &Vec<Carried>| corners.iter().map(|c| c.now(particles)).collect();
        (self.corners.iter().map(polygon).collect(), &self.particles)
    }

    /// The edges of the bodies as the particles carry them, closed lines.
    ///
    /// # Panics
    /// If there are fewer particles than the case has.
    pub fn edges(&self, particles: &Particles<2>) -> Vec<Polygon> {
        let line = |edge: &Vec<Carried>| edge.iter().map(|c| c.now(particles)).collect();
        self.edges.iter().map(line).collect()
    }
}

/// The corners of a polygon and points between them, about `spacing` apart; closed.
fn along(polygon: &[[f64; 2]], spacing: f64) -> Polygon {
    let mut points = Vec::new();
    for (k, from) in polygon.iter().enumerate() {
        let to = polygon[(k + 1) % polygon.len()];
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let parts = (length / spacing).round().max(1.0);
        points.push(*from);
        // In the middle of the faces of particles, where a side follows the grid.
        points.extend((0..parts as usize).map(|part| {
            let t = (part as f64 + 0.5) / parts;
            [0, 1].map(|axis| from[axis] + t * (to[axis] - from[axis]))
        }));
    }
    points.extend(polygon.first());
    points
}

#[cfg(test)]
mod tests {
    use igimp_assembly::ParticleFields;

    use super::*;
    use crate::estimate::tests::case;
    use crate::polygon::area_and_centroid;
    use crate::run::Model;

    fn slope() -> Case {
        let mut case = case();
        case.bodies[0].polygon = vec![[0.0, 0.0], [3.0, 0.0], [1.3, 1.7], [0.0, 1.7]];
        case
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(|polygon| area_and_centroid(polygon).0).sum()
    }

    /// GOAL: a slope is drawn along its line: the pieces of bodies at rest are the bodies.
    #[test]
    fn bodies_at_rest_are_drawn_as_they_are() {
        let case = slope();
        let particles = Model::new(&case).unwrap().1.body.particles;
        let pieces = Pieces::of(&case).unwrap();
        let whole = area_and_centroid(&case.bodies[0].polygon).0;
        assert!((area(&pieces.now(&particles).0) - whole).abs() < 1e-12 * whole);
        let inside = |&[x, y]: &[f64; 2]| y <= 1.7 + 1e-12 && x + y <= 3.0 + 1e-12;
        assert!(pieces.now(&particles).0.iter().flatten().all(inside));
        let edges = pieces.edges(&particles);
        assert!((area(&edges) - whole).abs() < 1e-12 * whole);
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
        let outline: Polygon = case.bodies[0].polygon.iter().map(|&x| moved(x)).collect();
        let whole = area_and_centroid(&outline).0;
        assert!((area(&pieces.now(&particles).0) - whole).abs() < 1e-12 * whole);
        assert!((area(&pieces.edges(&particles)) - whole).abs() < 1e-12 * whole);
    }
}
