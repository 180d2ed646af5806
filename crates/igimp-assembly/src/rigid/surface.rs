//! The surface of a rigid body: flat facets between knots, or round.

use thiserror::Error;

/// The largest number of knots of a surface in the plane.
const MOST_KNOTS: u32 = 1_000_000;

/// What makes no surface.
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
    #[error("it is {length} m around, more than {MOST_KNOTS} cells of {spacing} m")]
    TooLong {
        /// How long its sides are in all \[length\].
        length: f64,
        /// The distance of knots \[length\].
        spacing: f64,
    },
    /// A number that is not finite, or a size that is not positive.
    #[error("{what} must be positive and finite, but is {value}")]
    NotPositive {
        /// What it is.
        what: &'static str,
        /// The value.
        value: f64,
    },
}

/// A facet between D knots: a segment in the plane, a triangle in space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Facet<const D: usize> {
    knots: [usize; D],
    side: usize,
    /// Out of the body.
    normal: [f64; D],
}

/// The surface of a rigid body in its own frame: a core of facets between knots, and all points as far
/// from it as its edges are rounded. Contact is averaged around the knots (theory, eq. 45).
#[derive(Clone, Debug, PartialEq)]
pub struct Surface<const D: usize> {
    knots: Vec<[f64; D]>,
    facets: Vec<Facet<D>>,
    /// Radius of its edges \[length\].
    rounding: f64,
    /// The radius, if the surface is round about the origin of the frame.
    radius: Option<f64>,
    sides: usize,
    /// The side of each knot.
    side_of: Vec<usize>,
}

/// The place of a side that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest<const D: usize> {
    /// Height above the facet, negative below \[length\].
    pub(crate) height: f64,
    /// Out of the body.
    pub(crate) normal: [f64; D],
    /// Knots of the facet, with their shares.
    pub(crate) knots: [(usize, f64); D],
    /// Whether the point stands beyond the edge of the side.
    pub(crate) is_beyond: bool,
}

impl Surface<2> {
    /// A polygon with corners in order, either way round \[length\], its corners rounded by a radius
    /// \[length\], with knots about `spacing` apart \[length\]. Its sides are numbered by the corner that they
    /// begin with. The roundings carry nothing: a grid cannot hold the soil of two sides apart in the cell
    /// of an edge.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn polygon(
        corners: &[[f64; 2]],
        rounding: f64,
        spacing: f64,
    ) -> Result<Self, SurfaceError> {
        positive("the distance of knots", spacing)?;
        let n = corners.len();
        let side = |k: usize| {
            let (a, b) = (corners[k % n], corners[(k + 1) % n]);
            [b[0] - a[0], b[1] - a[1]]
        };
        if n < 3 || (0..n).any(|k| norm(&side(k)) <= 0.0) {
            return Err(SurfaceError::TooFewCorners);
        }
        countable((0..n).map(|k| norm(&side(k))).sum(), spacing)?;
        let area: f64 = (0..n)
            .map(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % n]);
                a[0] * b[1] - a[1] * b[0]
            })
            .sum();
        let sense = area.signum();
        let outward = |k: usize| {
            let [x, y] = side(k);
            let length = sense * x.hypot(y);
            [y / length, -x / length]
        };
        let core = |k: usize| {
            let (before, after) = (outward((k + n - 1) % n), outward(k % n));
            let share = rounding / (1.0 + dot(&before, &after));
            let corner = corners[k % n];
            [0, 1].map(|axis| corner[axis] - share * (before[axis] + after[axis]))
        };
        let mut surface = Self {
            knots: Vec::new(),
            facets: Vec::new(),
            rounding,
            radius: None,
            sides: n,
            side_of: Vec::new(),
        };
        for k in 0..n {
            let (a, b) = (core(k), core(k + 1));
            let along = [b[0] - a[0], b[1] - a[1]];
            if dot(&along, &side(k)) <= 0.0 {
                return Err(SurfaceError::RoundedAway { side: k, rounding });
            }
            let shares = shares_along(norm(&along), spacing);
            let parts = shares.len() - 1;
            let first = surface.knots.len();
            for share in shares {
                surface
                    .knots
                    .push([0, 1].map(|axis| a[axis] + share * along[axis]));
                surface.side_of.push(k);
            }
            surface.facets.extend((0..parts).map(|part| Facet {
                knots: [first + part, first + part + 1],
                side: k,
                normal: outward(k),
            }));
        }
        Ok(surface)
    }

    /// A circle about the origin of the body's frame, with knots about `spacing` apart \[length\].
    ///
    /// # Errors
    /// [`SurfaceError::NotPositive`], [`SurfaceError::TooLong`].
    pub fn circle(radius: f64, spacing: f64) -> Result<Self, SurfaceError> {
        positive("the radius", radius)?;
        positive("the distance of knots", spacing)?;
        let around = std::f64::consts::TAU;
        countable(around * radius, spacing)?;
        let parts = (around * radius / spacing).round().max(8.0) as usize;
        let at = |part: f64| {
            let (sin, cos) = (around * part / parts as f64).sin_cos();
            [cos, sin]
        };
        Ok(Self {
            knots: (0..parts)
                .map(|part| at(part as f64).map(|x| radius * x))
                .collect(),
            facets: (0..parts)
                .map(|part| Facet {
                    knots: [part, (part + 1) % parts],
                    side: 0,
                    normal: at(part as f64 + 0.5),
                })
                .collect(),
            rounding: 0.0,
            radius: Some(radius),
            sides: 1,
            side_of: vec![0; parts],
        })
    }
}

impl Surface<3> {
    /// A closed surface of triangles, their corners anticlockwise as seen from outside, each with the
    /// number of its side; edges between triangles of different sides stay sharp.
    ///
    /// # Errors
    /// [`SurfaceError::TooFewCorners`] for a triangle without area.
    pub fn triangles(
        corners: &[[f64; 3]],
        triangles: &[([usize; 3], usize)],
    ) -> Result<Self, SurfaceError> {
        let sides = triangles.iter().map(|&(_, side)| side + 1).max();
        let mut surface = Self {
            knots: Vec::new(),
            facets: Vec::new(),
            rounding: 0.0,
            radius: None,
            sides: sides.unwrap_or(0),
            side_of: Vec::new(),
        };
        let mut known = std::collections::BTreeMap::new();
        for &(own, side) in triangles {
            let knots = own.map(|corner| {
                *known.entry((side, corner)).or_insert_with(|| {
                    surface.knots.push(corners[corner]);
                    surface.side_of.push(side);
                    surface.knots.len() - 1
                })
            });
            let [a, b, c] = knots.map(|knot| surface.knots[knot]);
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            let size = norm(&normal);
            if size <= 0.0 || !size.is_finite() {
                return Err(SurfaceError::TooFewCorners);
            }
            surface.facets.push(Facet {
                knots,
                side,
                normal: normal.map(|n| n / size),
            });
        }
        if surface.facets.len() < 4 {
            return Err(SurfaceError::TooFewCorners);
        }
        Ok(surface)
    }
}

impl Surface<3> {
    /// A box about the origin, from its half-lengths \[length\]. Its sides look down and up the first axis, then
    /// the second, then the third.
    ///
    /// # Errors
    /// [`SurfaceError::TooFewCorners`] for a box without volume.
    pub fn cuboid(half: [f64; 3]) -> Result<Self, SurfaceError> {
        let corner = |k: usize| {
            std::array::from_fn(|axis| match k >> axis & 1 {
                0 => -half[axis],
                _ => half[axis],
            })
        };
        let corners: Vec<[f64; 3]> = (0..8).map(corner).collect();
        let triangles = [
            ([0, 4, 6], 0),
            ([0, 6, 2], 0),
            ([1, 3, 7], 1),
            ([1, 7, 5], 1),
            ([0, 1, 5], 2),
            ([0, 5, 4], 2),
            ([2, 6, 7], 3),
            ([2, 7, 3], 3),
            ([0, 2, 3], 4),
            ([0, 3, 1], 4),
            ([4, 5, 7], 5),
            ([4, 7, 6], 5),
        ];
        Self::triangles(&corners, &triangles)
    }
}

impl<const D: usize> Surface<D> {
    /// How many sides have an interface of their own.
    pub fn side_count(&self) -> usize {
        self.sides
    }

    /// The side of a knot.
    pub(crate) fn side_of(&self, knot: usize) -> usize {
        self.side_of[knot]
    }

    /// How many knots contact is averaged around.
    pub fn knot_count(&self) -> usize {
        self.knots.len()
    }

    /// The knots of each facet, by their numbers.
    pub fn facets(&self) -> impl Iterator<Item = [usize; D]> {
        self.facets.iter().map(|facet| facet.knots)
    }

    /// The knots on the surface with their sides, in the frame of the body \[length\].
    pub fn knots(&self) -> Vec<([f64; D], usize)> {
        let mut knots = vec![([0.0; D], 0); self.knots.len()];
        for facet in &self.facets {
            for &knot in &facet.knots {
                let core = self.knots[knot];
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

    /// Its extent in the frame of the body: lower and upper corner \[length\].
    pub fn bounds(&self) -> ([f64; D], [f64; D]) {
        let mut bounds = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for knot in &self.knots {
            for axis in 0..D {
                bounds.0[axis] = bounds.0[axis].min(knot[axis] - self.rounding);
                bounds.1[axis] = bounds.1[axis].max(knot[axis] + self.rounding);
            }
        }
        bounds
    }

    /// What holds all of it in the frame of the body: lower and upper corner \[length\]. The knots of a circle
    /// need not lie at its outermost places.
    pub(crate) fn extent(&self) -> ([f64; D], [f64; D]) {
        self.radius
            .map_or_else(|| self.bounds(), |radius| ([-radius; D], [radius; D]))
    }

    /// A length of the body: that of the diagonal of its extent \[length\].
    pub fn size(&self) -> f64 {
        let (lower, upper) = self.bounds();
        norm(&minus(&upper, &lower))
    }

    /// The area of what belongs to each knot \[length^(D-1)\].
    pub(crate) fn tents(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.knots.len()];
        for facet in &self.facets {
            let corners = facet.knots.map(|knot| self.knots[knot]);
            let area = match D {
                2 => norm(&minus(&corners[1], &corners[0])),
                3 => {
                    0.5 * cross_size(
                        &minus(&corners[1], &corners[0]),
                        &minus(&corners[2], &corners[0]),
                    )
                }
                _ => unreachable!("bodies stand in the plane or in space"),
            };
            for &knot in &facet.knots {
                areas[knot] += area / D as f64;
            }
        }
        areas
    }

    /// Signed distance of a point in the frame of the body, negative within it \[length\], and the direction
    /// in which it grows.
    pub(crate) fn distance(&self, x: &[f64; D]) -> (f64, [f64; D]) {
        if let Some(radius) = self.radius {
            let length = norm(x);
            let normal = x.map(|x| x / length.max(f64::MIN_POSITIVE));
            return (length - radius, normal);
        }
        // On an edge of two facets the sign is that of the one that the point stands higher above.
        let mut best: Option<(f64, f64, [f64; D], &Facet<D>)> = None;
        for facet in &self.facets {
            let (arm, ..) = self.above(facet, x);
            let (length, height) = (norm(&arm), dot(&arm, &facet.normal));
            let nearer = best.as_ref().is_none_or(|(least, own, ..)| {
                let tie = (length - least).abs() <= 1e-9 * length;
                (tie && height.abs() > own.abs()) || (!tie && length < *least)
            });
            if nearer {
                best = Some((length, height, arm, facet));
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
    pub(crate) fn nearest(&self, x: &[f64; D], side: usize) -> Nearest<D> {
        let own = |facet: &&Facet<D>| facet.side == side;
        let mut best: Option<(f64, &Facet<D>)> = None;
        for facet in self.facets.iter().filter(own) {
            let length = norm(&self.above(facet, x).0);
            if best.is_none_or(|(least, _)| length < least) {
                best = Some((length, facet));
            }
        }
        let (_, facet) = best.expect("a side has facets");
        let (arm, shares, is_beyond) = self.above(facet, x);
        let knots = std::array::from_fn(|k| (facet.knots[k], shares[k]));
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
        let corners = facet.knots.map(|knot| self.knots[knot]);
        let (shares, is_beyond) = closest(x, &corners);
        (minus(x, &combine(&corners, &shares)), shares, is_beyond)
    }
}

/// Knots along a side, as shares of its length: equally far apart, save for the first and the last space,
/// which are twice as wide.
fn shares_along(length: f64, spacing: f64) -> Vec<f64> {
    let parts = (length / spacing).round().max(1.0) as usize;
    let inner = (0..=parts).filter(|&part| parts < 4 || (part != 1 && part + 1 != parts));
    inner.map(|part| part as f64 / parts as f64).collect()
}

/// Shares of the corners of a facet in its place nearest to a point, and whether the point lies beyond
/// its edge.
fn closest<const D: usize>(x: &[f64; D], corners: &[[f64; D]; D]) -> ([f64; D], bool) {
    let mut shares = [0.0; D];
    match D {
        2 => {
            let along = minus(&corners[1], &corners[0]);
            let t = dot(&minus(x, &corners[0]), &along) / dot(&along, &along);
            let inside = t.clamp(0.0, 1.0);
            shares[0] = 1.0 - inside;
            shares[1] = inside;
            (shares, (t - inside).abs() > 1e-9)
        }
        3 => {
            let (a, b) = (
                minus(&corners[1], &corners[0]),
                minus(&corners[2], &corners[0]),
            );
            let p = minus(x, &corners[0]);
            let (aa, ab, bb) = (dot(&a, &a), dot(&a, &b), dot(&b, &b));
            let (pa, pb) = (dot(&p, &a), dot(&p, &b));
            let det = aa * bb - ab * ab;
            let (v, w) = ((bb * pa - ab * pb) / det, (aa * pb - ab * pa) / det);
            if v >= -1e-9 && w >= -1e-9 && v + w <= 1.0 + 1e-9 {
                let (v, w) = (v.max(0.0), w.max(0.0));
                shares[0] = (1.0 - v - w).max(0.0);
                shares[1] = v;
                shares[2] = w;
                return (shares, false);
            }
            let mut least = f64::INFINITY;
            for k in 0..3 {
                let (first, last) = (k, (k + 1) % 3);
                let along = minus(&corners[last], &corners[first]);
                let t = dot(&minus(x, &corners[first]), &along) / dot(&along, &along);
                let t = t.clamp(0.0, 1.0);
                let mut own = [0.0; D];
                own[first] = 1.0 - t;
                own[last] = t;
                let length = norm(&minus(x, &combine(corners, &own)));
                if length < least {
                    least = length;
                    shares = own;
                }
            }
            (shares, true)
        }
        _ => unreachable!("bodies stand in the plane or in space"),
    }
}

fn positive(what: &'static str, value: f64) -> Result<(), SurfaceError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(SurfaceError::NotPositive { what, value })
    }
}

/// Refuses more knots than a surface may have; so does a length that is no number.
fn countable(length: f64, spacing: f64) -> Result<(), SurfaceError> {
    if length <= f64::from(MOST_KNOTS) * spacing {
        Ok(())
    } else {
        Err(SurfaceError::TooLong { length, spacing })
    }
}

fn combine<const D: usize>(corners: &[[f64; D]; D], shares: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| (0..D).map(|k| shares[k] * corners[k][axis]).sum())
}

/// The difference of two vectors.
pub(crate) fn minus<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// The scalar product.
pub(crate) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|axis| a[axis] * b[axis]).sum()
}

/// The length of a vector.
pub(crate) fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}

/// The vector product in space.
pub(crate) fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        a[l] * b[m] - a[m] * b[l]
    })
}

/// The area of the parallelogram of two vectors.
fn cross_size<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (dot(a, a) * dot(b, b) - dot(a, b).powi(2)).max(0.0).sqrt()
}
