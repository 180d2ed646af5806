//! Data of a surface in space beside its core.

use crate::closest::{closest, combine};
use crate::tree::Tree;
use crate::vectors::{dot, minus};
use crate::{Nearest, Surface};

/// A facet is seen in a face if their normals are not further apart than an angle with this cosine \[-\].
const SEEN: f64 = 0.5;

/// Facets between points, tents between knots. A point carries shares of knots: its own, or those of
/// knots around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Space<const D: usize> {
    /// Where the points of the core stand on the surface, by point \[length\].
    pub outer: Vec<[f64; D]>,
    /// Knots with their shares, by point.
    pub shares: Vec<Vec<(usize, f64)>>,
    /// Where the knots stand \[length\].
    pub(crate) places: Vec<[f64; D]>,
    /// Normal and two tangents, by knot.
    pub(crate) frames: Vec<[[f64; D]; 3]>,
    /// The facets of the core that have an area.
    pub(crate) core: Tree<D>,
    /// The facets of each side.
    pub(crate) sides: Vec<Tree<D>>,
}

impl<const D: usize> Space<D> {
    /// Two tangents of the surface at a knot, in the frame of the body, as far as a face with this normal
    /// has them; the second is the normal times the first (theory, eq. 45a).
    pub fn tangents_at(&self, knot: usize, normal: &[f64; D]) -> [[f64; D]; 2] {
        let [_, first, second] = &self.frames[knot];
        let along = |tangent: &[f64; D]| {
            let share = dot(tangent, normal);
            let flat: [f64; D] = std::array::from_fn(|axis| tangent[axis] - share * normal[axis]);
            (dot(&flat, &flat).sqrt(), flat)
        };
        let (mut size, mut flat) = along(first);
        if size < 1e-3 {
            (size, flat) = along(second);
        }
        let t = flat.map(|x| x / size);
        let mut out = [t, [0.0; D]];
        for a in 0..D {
            let (b, c) = ((a + 1) % D, (a + 2) % D);
            out[1][a] = normal[b] * t[c] - normal[c] * t[b];
        }
        out
    }
}

/// A triangle that carries contact: its corners \[length\], knots with their shares at each of them, and its side.
pub type CarryingTriangle<'a> = ([[f64; 3]; 3], [&'a [(usize, f64)]; 3], usize);

impl<const D: usize> Surface<D> {
    /// Data beside the core of a surface in space; none in the plane.
    pub fn space(&self) -> Option<&Space<D>> {
        self.space.as_deref()
    }

    /// How many facets it has.
    pub fn facet_count(&self) -> usize {
        self.facets.len()
    }

    /// The corners of a facet, as points.
    pub fn corners(&self, facet: usize) -> [usize; D] {
        self.facets[facet].corners
    }

    /// The place of a side that is nearest to a point, in space.
    pub(crate) fn nearest_in_space(
        &self,
        space: &Space<D>,
        x: &[f64; D],
        side: usize,
    ) -> Nearest<D> {
        let arm = |facet: usize| {
            let corners = self.corners(facet).map(|corner| space.outer[corner]);
            let (shares, is_beyond) = closest(x, &corners);
            (minus(x, &combine(&corners, &shares)), shares, is_beyond)
        };
        if let Some(radius) = self.radius {
            let length = dot(x, x).sqrt();
            if length > 0.0 {
                return Nearest {
                    height: length - radius,
                    normal: x.map(|x| x / length),
                    knots: [(0, 0.0); D],
                    is_beyond: false,
                };
            }
        }
        let near = space.sides[side].near(x, |facet| {
            let (arm, ..) = arm(facet);
            dot(&arm, &arm).sqrt()
        });
        // Above an edge it is the facet that the point stands highest above.
        let mut best: Option<(f64, usize)> = None;
        for facet in near {
            let height = dot(&arm(facet).0, &self.facets[facet].normal);
            if best.is_none_or(|(most, _)| height > most) {
                best = Some((height, facet));
            }
        }
        let (height, facet) = best.expect("a side has facets");
        let (_, shares, is_beyond) = arm(facet);
        Nearest {
            height,
            normal: self.facets[facet].normal,
            knots: std::array::from_fn(|k| (self.corners(facet)[k], shares[k])),
            is_beyond,
        }
    }

    /// Facets of a side within reach of a point that look along a normal, all in the frame of the body.
    pub fn seen(
        &self,
        space: &Space<D>,
        side: usize,
        (x, reach): (&[f64; D], f64),
        normal: &[f64; D],
    ) -> Vec<usize> {
        let mut found = space.sides[side].within(x, reach);
        found.retain(|&facet| dot(&self.facets[facet].normal, normal) > SEEN);
        found
    }
}

impl Surface<3> {
    /// The same at another place of the frame of the body: its reference point lies elsewhere.
    ///
    /// # Panics
    /// For a sphere: it stays about the origin.
    #[must_use]
    pub fn shifted(mut self, by: [f64; 3]) -> Self {
        assert!(self.radius.is_none(), "a sphere stays about the origin");
        let shift = |x: &mut [f64; 3]| {
            for axis in 0..3 {
                x[axis] += by[axis];
            }
        };
        self.points.iter_mut().for_each(shift);
        shift(&mut self.bounds.0);
        shift(&mut self.bounds.1);
        if let Some(space) = &mut self.space {
            space.outer.iter_mut().for_each(shift);
            space.places.iter_mut().for_each(shift);
            space.core.shift(&by);
            space.sides.iter_mut().for_each(|side| side.shift(&by));
        }
        self
    }

    /// The triangles that carry contact: corners in the frame of the body \[length\], and the shares of knots
    /// at each corner, to draw what the knots carry.
    pub fn facets(&self) -> impl Iterator<Item = CarryingTriangle<'_>> {
        let space = self.space.as_deref();
        space.into_iter().flat_map(move |space| {
            self.facets.iter().map(move |facet| {
                let corners = facet.corners.map(|corner| space.outer[corner]);
                let shares = facet.corners.map(|corner| space.shares[corner].as_slice());
                (corners, shares, facet.side)
            })
        })
    }

    /// Normal and both tangents at a knot, in the frame of the body: the directions of its pressure and of
    /// its shear.
    pub fn frame(&self, knot: usize) -> [[f64; 3]; 3] {
        self.space
            .as_ref()
            .map_or([[0.0; 3]; 3], |space| space.frames[knot])
    }
}
