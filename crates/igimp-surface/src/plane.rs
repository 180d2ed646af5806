//! Surfaces in the plane: polygons and circles.

use crate::vectors::{dot, norm};
use crate::{Facet, MOST_KNOTS, Surface, SurfaceError, extent_of, positive, shares_along};

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
            points: Vec::new(),
            bounds: ([0.0; 2], [0.0; 2]),
            facets: Vec::new(),
            rounding,
            radius: None,
            sides: n,
            side_of: Vec::new(),
            space: None,
        };
        for k in 0..n {
            let (a, b) = (core(k), core(k + 1));
            let along = [b[0] - a[0], b[1] - a[1]];
            if dot(&along, &side(k)) <= 0.0 {
                return Err(SurfaceError::RoundedAway { side: k, rounding });
            }
            let shares = shares_along(norm(&along), spacing);
            let parts = shares.len() - 1;
            let first = surface.points.len();
            for share in shares {
                surface
                    .points
                    .push([0, 1].map(|axis| a[axis] + share * along[axis]));
                surface.side_of.push(k);
            }
            surface.facets.extend((0..parts).map(|part| Facet {
                corners: [first + part, first + part + 1],
                side: k,
                normal: outward(k),
            }));
        }
        surface.bounds = extent_of(&surface.points, rounding);
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
        let points: Vec<[f64; 2]> = (0..parts)
            .map(|part| at(part as f64).map(|x| radius * x))
            .collect();
        Ok(Self {
            bounds: extent_of(&points, 0.0),
            points,
            facets: (0..parts)
                .map(|part| Facet {
                    corners: [part, (part + 1) % parts],
                    side: 0,
                    normal: at(part as f64 + 0.5),
                })
                .collect(),
            rounding: 0.0,
            radius: Some(radius),
            sides: 1,
            side_of: vec![0; parts],
            space: None,
        })
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
