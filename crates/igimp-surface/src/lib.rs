//! The surface of a rigid body: flat facets between knots, or round. Nothing here knows of soil or of a grid.

mod closest;
mod draft;
mod mesh;
mod plane;
mod refine;
mod round;
mod space;
mod tree;
pub mod vectors;

pub use mesh::SurfaceTriangle;
pub use space::CarryingTriangle;
pub use space::Space;

use thiserror::Error;

use crate::closest::{closest, combine};
use crate::vectors::{dot, minus, norm};

/// The largest number of knots of a surface.
const MOST_KNOTS: u32 = 1_000_000;

/// A round surface has at least so many knots around it, and a multiple of them: it is the same seen along all axes.
const QUARTERS: usize = 4;
const LEAST_AROUND: usize = 8;

/// The share by which a length may fall short of so many spacings and a half and count as that: a place 1 km from the origin is known to
/// 1e-13 m \[-\].
const HALVES_GO_UP: f64 = 1e-9;

/// Errors of surfaces.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SurfaceError {
    /// Too few corners, or corners that coincide.
    #[error("a rigid body needs at least three different corners")]
    TooFewCorners,
    /// Its edges are rounded so much that a side is used up.
    #[error("with edges rounded by {rounding} m nothing is left of side {side}")]
    RoundedAway {
        /// The side, from 0.
        side: usize,
        /// The radius \[length\].
        rounding: f64,
    },
    /// More knots than contact is ever averaged around.
    #[error("it is {length} m around, more than {MOST_KNOTS} cells of {spacing:.4} m")]
    TooLong {
        /// How long its sides are in all \[length\].
        length: f64,
        /// The distance of knots \[length\].
        spacing: f64,
    },
    /// More knots in space than contact is ever averaged around.
    #[error("its sides are {area} m2 large, more than {MOST_KNOTS} squares of {spacing:.4} m")]
    TooLarge {
        /// How large its sides are in all \[length²\].
        area: f64,
        /// The distance of knots \[length\].
        spacing: f64,
    },
    /// A corner of a triangle that is not in the list.
    #[error("triangle {triangle} has the corner {corner}, but there are {count} (from 0)")]
    UnknownCorner {
        /// The triangle, from 0.
        triangle: usize,
        /// Its corner.
        corner: usize,
        /// How many corners there are.
        count: usize,
    },
    /// A triangle without area.
    #[error("triangle {triangle} (from 0) has no area; its first corner is at {position:?} m")]
    FlatTriangle {
        /// The triangle, from 0.
        triangle: usize,
        /// Its first corner \[length\].
        position: [f64; 3],
    },
    /// A surface with a hole.
    #[error(
        "the surface is not closed: triangle {triangle} (from 0) has no neighbour at its edge from {from:?} m to {to:?} m"
    )]
    Open {
        /// The triangle, from 0.
        triangle: usize,
        /// Ends of the edge \[length\].
        from: [f64; 3],
        /// Likewise.
        to: [f64; 3],
    },
    /// Two triangles that are not the same way round, or more than two at an edge.
    #[error(
        "triangles {triangles:?} (from 0) both run along the edge from {from:?} m to {to:?} m: all of them must be the same way round, and two meet at an edge"
    )]
    Twisted {
        /// The triangles, from 0.
        triangles: [usize; 2],
        /// Ends of the edge \[length\].
        from: [f64; 3],
        /// Likewise.
        to: [f64; 3],
    },
    /// A number of a side that no triangle has.
    #[error("sides are numbered from 0 without gaps, but no triangle belongs to side {side}")]
    NoSuchSide {
        /// The side.
        side: usize,
    },
    /// Corners of a polygon that cross.
    #[error("the sides of the polygon cross")]
    Crossing,
    /// A profile that does not run from the axis to the axis, or crosses it.
    #[error(
        "a profile must begin and end at radius 0 and stay outside of the axis in between, but has {radius} m at corner {corner} (from 0)"
    )]
    OffAxis {
        /// The corner, from 0.
        corner: usize,
        /// Its distance from the axis \[length\].
        radius: f64,
    },
    /// A number that is not finite, or a size that is not positive.
    #[error("{quantity} must be positive and finite, but is {value}")]
    NotPositive {
        /// Its name.
        quantity: &'static str,
        /// The value.
        value: f64,
    },
}

/// A facet between D knots: a segment in the plane, a triangle in space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Facet<const D: usize> {
    corners: [usize; D],
    side: usize,
    /// Out of the body.
    normal: [f64; D],
}

/// The surface of a rigid body in its own frame: a core of facets between knots, and all points as far
/// from it as its edges are rounded. Contact is averaged around the knots (theory, eq. 45).
#[derive(Clone, Debug, PartialEq)]
pub struct Surface<const D: usize> {
    /// Corners of the facets of the core; in the plane a knot each.
    points: Vec<[f64; D]>,
    /// Its extent: lower and upper corner \[length\].
    bounds: ([f64; D], [f64; D]),
    facets: Vec<Facet<D>>,
    /// Radius of its edges \[length\].
    rounding: f64,
    /// The radius, if the surface is round about the origin of the frame.
    radius: Option<f64>,
    sides: usize,
    /// The side of each knot.
    side_of: Vec<usize>,
    /// Further data of a surface in space.
    space: Option<Box<Space<D>>>,
}

/// The place of a side that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest<const D: usize> {
    /// Height above the facet, negative below \[length\].
    pub height: f64,
    /// Out of the body.
    pub normal: [f64; D],
    /// Knots of the facet, with their shares.
    pub knots: [(usize, f64); D],
    /// Whether the point stands beyond the edge of the side.
    pub is_beyond: bool,
}

impl<const D: usize> Surface<D> {
    /// How many sides have an interface of their own.
    pub fn side_count(&self) -> usize {
        self.sides
    }

    /// The side of a knot.
    pub fn side_of(&self, knot: usize) -> usize {
        self.side_of[knot]
    }

    /// How many knots contact is averaged around.
    pub fn knot_count(&self) -> usize {
        self.side_of.len()
    }

    /// The knots on the surface with their sides, in the frame of the body \[length\].
    pub fn knots(&self) -> Vec<([f64; D], usize)> {
        if let Some(space) = &self.space {
            let sides = self.side_of.iter().copied();
            return std::iter::zip(space.places.iter().copied(), sides).collect();
        }
        let mut knots = vec![([0.0; D], 0); self.knot_count()];
        for facet in &self.facets {
            for &knot in &facet.corners {
                let core = self.points[knot];
                let place = std::array::from_fn(|a| core[a] + self.rounding * facet.normal[a]);
                knots[knot] = (place, facet.side);
            }
        }
        knots
    }

    /// Radius of the edges \[length\].
    pub fn rounding(&self) -> f64 {
        self.rounding
    }

    /// The radius, if it is round about the origin of its frame \[length\].
    pub fn radius(&self) -> Option<f64> {
        self.radius
    }

    /// Its extent in the frame of the body: lower and upper corner \[length\].
    pub fn bounds(&self) -> ([f64; D], [f64; D]) {
        self.bounds
    }

    /// Its bounding box in the frame of the body: lower and upper corner \[length\]. The knots of a circle
    /// need not lie at its outermost places.
    pub fn extent(&self) -> ([f64; D], [f64; D]) {
        self.radius
            .map_or_else(|| self.bounds(), |radius| ([-radius; D], [radius; D]))
    }

    /// A length of the body: that of the diagonal of its extent \[length\].
    pub fn size(&self) -> f64 {
        let (lower, upper) = self.bounds();
        norm(&minus(&upper, &lower))
    }

    /// The longest edge of a facet \[length\].
    pub fn longest_facet(&self) -> f64 {
        let edges = self.facets.iter().flat_map(|facet| {
            let from = |k: usize| &self.points[facet.corners[k]];
            (0..D).map(move |k| norm(&minus(from((k + 1) % D), from(k))))
        });
        edges.fold(0.0, f64::max)
    }

    /// In the plane the length of each knot's share \[length\].
    pub fn tents(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.knot_count()];
        for facet in &self.facets {
            let corners = facet.corners.map(|corner| self.points[corner]);
            let area = norm(&minus(&corners[1], &corners[0]));
            for &knot in &facet.corners {
                areas[knot] += area / D as f64;
            }
        }
        areas
    }

    /// Signed distance of a point in the frame of the body, negative within it \[length\], and the direction
    /// in which it grows.
    ///
    /// # Panics
    /// If no facet is at a distance, as of a point that is not a number.
    pub fn distance(&self, x: &[f64; D]) -> (f64, [f64; D]) {
        if let Some(radius) = self.radius {
            let length = norm(x);
            let normal = x.map(|x| x / length.max(f64::MIN_POSITIVE));
            return (length - radius, normal);
        }
        // On an edge of two facets the sign is that of the one that the point stands higher above.
        let mut best: Option<(f64, f64, [f64; D], &Facet<D>)> = None;
        let mut look_at = |facet| {
            let (arm, ..) = self.above(facet, x);
            let (length, height) = (norm(&arm), dot(&arm, &facet.normal));
            let nearer = best.as_ref().is_none_or(|(least, highest, ..)| {
                let tie = (length - least).abs() <= 1e-9 * length;
                (tie && height.abs() > highest.abs()) || (!tie && length < *least)
            });
            if nearer {
                best = Some((length, height, arm, facet));
            }
        };
        match &self.space {
            None => self.facets.iter().for_each(&mut look_at),
            Some(space) => {
                let off = |facet: usize| norm(&self.above(&self.facets[facet], x).0);
                let near = space.core.near(x, off).into_iter();
                near.for_each(|facet| look_at(&self.facets[facet]));
            }
        }
        let (length, height, arm, facet) = best.expect("a surface has facets");
        if height < 0.0 {
            (-length - self.rounding, facet.normal)
        } else if length > 0.0 {
            (length - self.rounding, arm.map(|a| a / length))
        } else {
            (-self.rounding, facet.normal)
        }
    }

    /// The place of a side that is nearest to a point, both in the frame of the body.
    ///
    /// # Panics
    /// If there is no such side.
    pub fn nearest(&self, x: &[f64; D], side: usize) -> Nearest<D> {
        if let Some(space) = &self.space {
            return self.nearest_in_space(space, x, side);
        }
        let of_side = |facet: &&Facet<D>| facet.side == side;
        let mut best: Option<(f64, &Facet<D>)> = None;
        for facet in self.facets.iter().filter(of_side) {
            let length = norm(&self.above(facet, x).0);
            if best.is_none_or(|(least, _)| length < least) {
                best = Some((length, facet));
            }
        }
        let (_, facet) = best.expect("a side has facets");
        let (arm, shares, is_beyond) = self.above(facet, x);
        let knots = std::array::from_fn(|k| (facet.corners[k], shares[k]));
        match self.radius {
            Some(radius) => {
                let length = norm(x);
                Nearest {
                    height: length - radius,
                    normal: if length > 0.0 {
                        x.map(|x| x / length)
                    } else {
                        facet.normal
                    },
                    knots,
                    is_beyond: false,
                }
            }
            None => Nearest {
                height: dot(&arm, &facet.normal) - self.rounding,
                normal: facet.normal,
                knots,
                is_beyond,
            },
        }
    }

    /// From the nearest place of a facet to a point, with the shares of its knots there, and whether the
    /// point stands beyond the edge of the facet.
    fn above(&self, facet: &Facet<D>, x: &[f64; D]) -> ([f64; D], [f64; D], bool) {
        let corners = facet.corners.map(|corner| self.points[corner]);
        let (shares, is_beyond) = closest(x, &corners);
        (minus(x, &combine(&corners, &shares)), shares, is_beyond)
    }
}

/// How many spacings a length is divided into, one at least: halves go up, with the round-off of places far from the origin.
fn parts_of(length: f64, spacing: f64) -> usize {
    (length / spacing * (1.0 + HALVES_GO_UP)).round().max(1.0) as usize
}

/// Knots along a side, as shares of its length: equally far apart, save for the first and the last space,
/// which are twice as wide.
fn shares_along(length: f64, spacing: f64) -> Vec<f64> {
    let parts = parts_of(length, spacing);
    let inner = (0..=parts).filter(|&part| parts < 4 || (part != 1 && part + 1 != parts));
    inner.map(|part| part as f64 / parts as f64).collect()
}

/// The extent of points with a radius about them.
fn extent_of<const D: usize>(points: &[[f64; D]], rounding: f64) -> ([f64; D], [f64; D]) {
    let mut bounds = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    for point in points {
        for axis in 0..D {
            bounds.0[axis] = bounds.0[axis].min(point[axis] - rounding);
            bounds.1[axis] = bounds.1[axis].max(point[axis] + rounding);
        }
    }
    bounds
}

fn positive(quantity: &'static str, value: f64) -> Result<(), SurfaceError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(SurfaceError::NotPositive { quantity, value })
    }
}
