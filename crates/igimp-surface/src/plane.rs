//! Surfaces in the plane: polygons and circles.

use crate::vectors::{dot, norm};
use crate::{
    Facet, LEAST_AROUND, MOST_KNOTS, QUARTERS, Surface, SurfaceError, extent_of, parts_of,
    positive, shares_along,
};

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

    /// A circle about the origin of the body's frame, with knots about `spacing` apart \[length\]: as many in each quarter, so that it is
    /// its own image along both axes.
    ///
    /// # Errors
    /// [`SurfaceError::NotPositive`], [`SurfaceError::TooLong`].
    pub fn circle(radius: f64, spacing: f64) -> Result<Self, SurfaceError> {
        positive("the radius", radius)?;
        positive("the distance of knots", spacing)?;
        let around = std::f64::consts::TAU;
        countable(around * radius, spacing)?;
        let quarters = parts_of(around * radius / QUARTERS as f64, spacing);
        let parts = (QUARTERS * quarters).max(LEAST_AROUND);
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

#[cfg(test)]
mod tests {
    use crate::{Surface, parts_of};

    // GOAL: a circle is its own mirror image, so that what presses it from below does not push it sideways.
    // CASE: circles of 8 to 200 knots.
    // ORACLE: the image of every knot in both axes is a knot.
    #[test]
    fn a_circle_is_its_own_image() {
        for k in 1..120 {
            let surface = Surface::circle(0.5, 0.5 / (0.3 * f64::from(k))).unwrap();
            let knots = surface.knots();
            for ([x, y], _) in &knots {
                for image in [[-x, *y], [*x, -y]] {
                    let is_there = |knot: &([f64; 2], usize)| {
                        (knot.0[0] - image[0]).hypot(knot.0[1] - image[1]) < 1e-12
                    };
                    assert!(knots.iter().any(is_there), "{k}: {image:?}");
                }
            }
        }
    }

    // GOAL: a body has the same knots wherever the origin is.
    // CASE: sides of n and a half spacings, drawn at places up to 10 km away.
    // ORACLE: the number at the origin, with halves up.
    #[test]
    fn knots_do_not_depend_on_the_origin() {
        for n in 1..40_u32 {
            for at in [0.0, 0.1, 33.3, 1e2 + 0.7, -7e3 - 0.1, 1e4 / 3.0] {
                let length = 0.3 * (f64::from(n) + 0.5);
                let drawn = (at + length) - at;
                assert_eq!(parts_of(drawn, 0.3), n as usize + 1, "{n} {at}");
            }
        }
    }
}
