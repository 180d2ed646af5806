//! A surface in space while it is made: points, facets between them, and knots.

use crate::space::Space;
use crate::tree::Tree;
use crate::vectors::{cross, dot, minus, norm};
use crate::{Facet, MOST_KNOTS, Surface, SurfaceError, extent_of};

/// A facet of the core with less than this area over the square of its longest edge is a line \[-\].
const FLAT: f64 = 1e-10;

/// Points, facets and knots.
#[derive(Debug, Default)]
pub(crate) struct Draft {
    core: Vec<[f64; 3]>,
    outer: Vec<[f64; 3]>,
    shares: Vec<Vec<(usize, f64)>>,
    places: Vec<[f64; 3]>,
    side_of: Vec<usize>,
    facets: Vec<Facet<3>>,
}

impl Draft {
    /// A point that is a knot of its own, from its place on the core and on the surface; returns the point.
    pub(crate) fn knot(&mut self, core: [f64; 3], outer: [f64; 3], side: usize) -> usize {
        self.shares.push(vec![(self.places.len(), 1.0)]);
        self.places.push(outer);
        self.side_of.push(side);
        self.core.push(core);
        self.outer.push(outer);
        self.core.len() - 1
    }

    /// A point that belongs to the knot of another.
    pub(crate) fn beside(&mut self, core: [f64; 3], outer: [f64; 3], other: usize) -> usize {
        self.shares.push(self.shares[other].clone());
        self.core.push(core);
        self.outer.push(outer);
        self.core.len() - 1
    }

    /// A facet; nothing if it has no area.
    pub(crate) fn facet(&mut self, corners: [usize; 3], side: usize, outward: &[f64; 3]) {
        let [a, b, c] = corners.map(|corner| self.outer[corner]);
        let normal = cross(&minus(&b, &a), &minus(&c, &a));
        let size = norm(&normal);
        if is_line(&[a, b, c]) {
            return;
        }
        let flips = dot(&normal, outward) < 0.0;
        let sense = if flips { -size } else { size };
        let [a, b, c] = corners;
        self.facets.push(Facet {
            corners: if flips { [a, c, b] } else { corners },
            side,
            normal: normal.map(|n| n / sense),
        });
    }

    /// Four corners in order, as four facets about their middle, which carries a quarter of each knot: their
    /// tents along both directions are those of the plane.
    pub(crate) fn quad(&mut self, corners: [usize; 4], side: usize, outward: &[f64; 3]) {
        let mean = |of: &[[f64; 3]]| {
            std::array::from_fn(|axis| 0.25 * corners.iter().map(|&k| of[k][axis]).sum::<f64>())
        };
        let (core, outer) = (mean(&self.core), mean(&self.outer));
        let knots = corners.iter().flat_map(|&corner| &self.shares[corner]);
        let shares = knots.map(|&(knot, share)| (knot, 0.25 * share)).collect();
        self.core.push(core);
        self.outer.push(outer);
        self.shares.push(shares);
        let middle = self.core.len() - 1;
        for k in 0..4 {
            self.facet([corners[k], corners[(k + 1) % 4], middle], side, outward);
        }
    }

    /// Knots on a flat quadrilateral with four corners in order on core and surface, at shares of its length
    /// along its first and its second edge.
    pub(crate) fn grid(
        &mut self,
        core: [[f64; 3]; 4],
        outer: [[f64; 3]; 4],
        [along, across]: [&[f64]; 2],
        side: usize,
        outward: &[f64; 3],
    ) {
        let at = |corners: &[[f64; 3]; 4], s: f64, t: f64| -> [f64; 3] {
            std::array::from_fn(|axis| {
                let [a, b, c, d] = corners.map(|corner| corner[axis]);
                (1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * d + s * c)
            })
        };
        let rows: Vec<Vec<usize>> = across
            .iter()
            .map(|&t| {
                let row = along.iter();
                row.map(|&s| self.knot(at(&core, s, t), at(&outer, s, t), side))
                    .collect()
            })
            .collect();
        for pair in rows.windows(2) {
            for k in 1..along.len() {
                let corners = [pair[0][k - 1], pair[0][k], pair[1][k], pair[1][k - 1]];
                self.quad(corners, side, outward);
            }
        }
    }

    /// The surface.
    pub(crate) fn finish(
        self,
        sides: usize,
        rounding: f64,
        radius: Option<f64>,
    ) -> Result<Surface<3>, SurfaceError> {
        if self.facets.len() < 4 {
            return Err(SurfaceError::TooFewCorners);
        }
        let corners = |of: &[[f64; 3]], k: usize| self.facets[k].corners.map(|corner| of[corner]);
        let all = 0..self.facets.len();
        let core = all
            .clone()
            .map(|k| (k, corners(&self.core, k)))
            .filter(|(_, corners)| !is_line(corners));
        let core = Tree::new(core.collect());
        let mut by_side = vec![Vec::new(); sides];
        for k in all {
            by_side[self.facets[k].side].push((k, corners(&self.outer, k)));
        }
        if let Some(side) = by_side.iter().position(Vec::is_empty) {
            return Err(SurfaceError::RoundedAway { side, rounding });
        }
        let frames = self.frames();
        Ok(Surface {
            bounds: extent_of(&self.core, rounding),
            points: self.core,
            facets: self.facets,
            rounding,
            radius,
            sides,
            side_of: self.side_of,
            space: Some(Box::new(Space {
                outer: self.outer,
                shares: self.shares,
                places: self.places,
                frames,
                core,
                sides: by_side.into_iter().map(Tree::new).collect(),
            })),
        })
    }

    /// Normal and tangents by knot: the normal is the mean of the facets around it, the first tangent the
    /// axis that is least along it, as far as it lies in the surface.
    fn frames(&self) -> Vec<[[f64; 3]; 3]> {
        let mut normals = vec![[0.0; 3]; self.places.len()];
        for facet in &self.facets {
            let [a, b, c] = facet.corners.map(|corner| self.outer[corner]);
            let area = norm(&cross(&minus(&b, &a), &minus(&c, &a)));
            for &point in &facet.corners {
                for &(knot, share) in &self.shares[point] {
                    for axis in 0..3 {
                        normals[knot][axis] += share * area * facet.normal[axis];
                    }
                }
            }
        }
        normals.iter().map(frame).collect()
    }
}

/// The frame with this normal, of any length.
fn frame(normal: &[f64; 3]) -> [[f64; 3]; 3] {
    let size = norm(normal);
    let n = if size > 0.0 {
        normal.map(|x| x / size)
    } else {
        [0.0, 0.0, 1.0]
    };
    // Round-off must not choose among axes.
    let least = (0..3).fold(0, |best, axis| {
        if n[axis].abs() < n[best].abs() - 1e-6 {
            axis
        } else {
            best
        }
    });
    let flat: [f64; 3] =
        std::array::from_fn(|axis| f64::from(u8::from(axis == least)) - n[least] * n[axis]);
    let size = norm(&flat);
    let first = flat.map(|x| x / size);
    [n, first, cross(&n, &first)]
}

/// Whether a triangle is a line or a point.
fn is_line([a, b, c]: &[[f64; 3]; 3]) -> bool {
    let edges = [minus(b, a), minus(c, a), minus(c, b)];
    let longest = edges.iter().map(|edge| dot(edge, edge)).fold(0.0, f64::max);
    norm(&cross(&edges[0], &edges[1])) <= FLAT * longest
}

/// Refuses more knots than a surface may have; so does an area that is no number.
pub(crate) fn countable(area: f64, spacing: f64) -> Result<(), SurfaceError> {
    if area <= f64::from(MOST_KNOTS) * spacing * spacing {
        Ok(())
    } else {
        Err(SurfaceError::TooLarge { area, spacing })
    }
}
