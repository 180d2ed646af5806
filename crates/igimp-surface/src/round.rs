//! Surfaces in space that are round about an axis: cylinders, cones, any profile that is turned, and spheres.

use std::f64::consts::TAU;

use crate::draft::{Draft, countable};
use crate::vectors::{dot, norm};
use crate::{LEAST_AROUND, QUARTERS, Surface, SurfaceError, parts_of, positive, shares_along};

/// A ring with a smaller radius than this share of the spacing of knots is a point \[-\].
const POINT: f64 = 1e-6;

impl Surface<3> {
    /// A cylinder about a coordinate axis, its ends at half of its length \[length\] before and behind the
    /// origin. Its sides are the lower end, the shaft, the upper end. As in the plane its edges are rounded by a
    /// radius \[length\] and carry nothing there, and knots are about `spacing` apart \[length\].
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn cylinder(
        axis: usize,
        radius: f64,
        half_length: f64,
        rounding: f64,
        spacing: f64,
    ) -> Result<Self, SurfaceError> {
        positive("the radius", radius)?;
        positive("half of the length", half_length)?;
        let profile = [
            [0.0, -half_length],
            [radius, -half_length],
            [radius, half_length],
            [0.0, half_length],
        ];
        Self::revolved(axis, &profile, rounding, spacing)
    }

    /// A cone with its tip at the origin that widens up a coordinate axis to a radius at a height, and goes on
    /// as a shaft of some length \[length\]; without a shaft that length is 0. Its sides are the face of the
    /// tip, the shaft if there is one, and the end.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn cone(
        axis: usize,
        [radius, height, shaft]: [f64; 3],
        rounding: f64,
        spacing: f64,
    ) -> Result<Self, SurfaceError> {
        positive("the radius", radius)?;
        positive("the height", height)?;
        let mut profile = vec![[0.0, 0.0], [radius, height]];
        if shaft != 0.0 {
            positive("the length of the shaft", shaft)?;
            profile.push([radius, height + shaft]);
        }
        profile.push([0.0, profile[profile.len() - 1][1]]);
        Self::revolved(axis, &profile, rounding, spacing)
    }

    /// A profile that is turned about a coordinate axis: corners as distance from the axis and place along
    /// it \[length\], from the axis to the axis. Its sides are numbered by the corner that they begin with. Around the
    /// axis the surface is a polygon with as much area as the circle.
    ///
    /// # Errors
    /// [`SurfaceError`].
    pub fn revolved(
        axis: usize,
        profile: &[[f64; 2]],
        rounding: f64,
        spacing: f64,
    ) -> Result<Self, SurfaceError> {
        positive("the distance of knots", spacing)?;
        if profile.len() < 3 {
            return Err(SurfaceError::TooFewCorners);
        }
        let last = profile.len() - 1;
        for (corner, at) in profile.iter().enumerate() {
            let is_end = corner == 0 || corner == last;
            if at.iter().any(|x| !x.is_finite()) || is_end != (at[0] == 0.0) || at[0] < 0.0 {
                let radius = at[0];
                return Err(SurfaceError::OffAxis { corner, radius });
            }
        }
        let area: f64 = profile
            .windows(2)
            .map(|ab| ab[0][0] * ab[1][1] - ab[1][0] * ab[0][1])
            .sum();
        let along = |k: usize| [0, 1].map(|a| profile[k + 1][a] - profile[k][a]);
        if (0..last).any(|k| norm(&along(k)) <= 0.0) {
            return Err(SurfaceError::TooFewCorners);
        }
        let outward = |k: usize| {
            let [r, z] = along(k);
            [z, -r].map(|x| x / (area.signum() * r.hypot(z)))
        };
        countable(
            (0..last)
                .map(|k| 0.5 * TAU * (profile[k][0] + profile[k + 1][0]) * norm(&along(k)))
                .sum(),
            spacing,
        )?;
        let core = |k: usize| {
            let mirrored = |[r, z]: [f64; 2]| [-r, z];
            let before = if k > 0 {
                outward(k - 1)
            } else {
                mirrored(outward(0))
            };
            let after = if k < last {
                outward(k)
            } else {
                mirrored(outward(last - 1))
            };
            let share = rounding / (1.0 + dot(&before, &after));
            [0, 1].map(|a| profile[k][a] - share * (before[a] + after[a]))
        };
        let mut draft = Draft::default();
        for side in 0..last {
            let (a, b, n) = (core(side), core(side + 1), outward(side));
            let way = [b[0] - a[0], b[1] - a[1]];
            if dot(&way, &along(side)) <= 0.0 {
                return Err(SurfaceError::RoundedAway { side, rounding });
            }
            let ends = [a[0], b[0]].map(|r| r <= POINT * spacing);
            let mut before: Option<Ring> = None;
            for share in shares_between(norm(&way), spacing, ends) {
                let at = [0, 1].map(|k| a[k] + share * way[k]);
                let ring = Ring::new(&mut draft, axis, (at, n), rounding, (spacing, side));
                if let Some(before) = before {
                    before.stitch(&ring, &mut draft, axis, (n, side));
                }
                before = Some(ring);
            }
        }
        draft.finish(last, rounding, None)
    }

    /// A sphere about the origin, with knots about `spacing` apart \[length\].
    ///
    /// # Errors
    /// [`SurfaceError::NotPositive`], [`SurfaceError::TooLarge`].
    pub fn sphere(radius: f64, spacing: f64) -> Result<Self, SurfaceError> {
        positive("the radius", radius)?;
        positive("the distance of knots", spacing)?;
        countable(2.0 * TAU * radius * radius, spacing)?;
        let parts = parts_of(0.5 * TAU * radius, spacing).max(6);
        let mut draft = Draft::default();
        let mut before: Option<(Ring, [f64; 2])> = None;
        for part in 0..=parts {
            let angle = 0.5 * TAU * part as f64 / parts as f64;
            let n = [angle.sin(), -angle.cos()];
            let at = n.map(|x| radius * x);
            let ring = Ring::new(&mut draft, 2, (at, n), 0.0, (spacing, 0));
            if let Some((before, normal)) = before {
                let mean = [0, 1].map(|k| 0.5 * (normal[k] + n[k]));
                before.stitch(&ring, &mut draft, 2, (mean, 0));
            }
            before = Some((ring, n));
        }
        draft.finish(1, 0.0, Some(radius))
    }
}

/// Knots between two ends, as shares of the way: as along a side of the plane, save that an end on the axis
/// is none.
fn shares_between(length: f64, spacing: f64, on_axis: [bool; 2]) -> Vec<f64> {
    if on_axis[0] == on_axis[1] {
        return shares_along(length, spacing);
    }
    let parts = parts_of(length, spacing);
    let inner = (0..=parts).filter(|&part| parts < 2 || part + 1 != parts);
    let shares = inner.map(|part| part as f64 / parts as f64);
    if on_axis[0] {
        shares.collect()
    } else {
        shares.rev().map(|share| 1.0 - share).collect()
    }
}

/// Points around the axis, or one on it.
struct Ring {
    points: Vec<usize>,
}

impl Ring {
    /// A ring about an axis through a place of the profile with a normal there.
    fn new(
        draft: &mut Draft,
        axis: usize,
        (at, normal): ([f64; 2], [f64; 2]),
        rounding: f64,
        (spacing, side): (f64, usize),
    ) -> Self {
        let outer = [0, 1].map(|k| at[k] + rounding * normal[k]);
        // Where two sides meet, the core tells both of them how many there are.
        let radius = if at[0] > POINT * spacing {
            at[0]
        } else {
            outer[0]
        };
        if radius <= POINT * spacing {
            let place = |x: [f64; 2]| in_space(axis, 0.0, 0.0, x[1]);
            return Self {
                points: vec![draft.knot(place(at), place(outer), side)],
            };
        }
        let quarters = parts_of(TAU * radius / QUARTERS as f64, spacing);
        let count = (QUARTERS * quarters).max(LEAST_AROUND);
        let part = TAU / count as f64;
        // The polygon has the area of the circle (theory, eq. 45c).
        let wider = (part / part.sin()).sqrt();
        let points = (0..count)
            .map(|k| {
                let angle = part * k as f64;
                let core = if at[0] > POINT * spacing {
                    wider * at[0]
                } else {
                    0.0
                };
                draft.knot(
                    in_space(axis, core, angle, at[1]),
                    in_space(axis, core + rounding * normal[0], angle, outer[1]),
                    side,
                )
            })
            .collect();
        Self { points }
    }

    /// Facets between this ring and the next.
    fn stitch(
        &self,
        next: &Self,
        draft: &mut Draft,
        axis: usize,
        (normal, side): ([f64; 2], usize),
    ) {
        let (a, b) = (&self.points, &next.points);
        let outward = |turn: f64| in_space(axis, normal[0], TAU * turn, normal[1]);
        if a.len() == b.len() && a.len() > 1 {
            for k in 0..a.len() {
                let l = (k + 1) % a.len();
                let facing = outward((k as f64 + 0.5) / a.len() as f64);
                draft.quad([a[k], a[l], b[l], b[k]], side, &facing);
            }
            return;
        }
        // The ring whose next knot comes first goes on.
        let turn = |k: usize, ring: &[usize]| k as f64 / ring.len() as f64;
        let (mut i, mut j) = (0, 0);
        let open = |k: usize, ring: &[usize]| ring.len() > 1 && k < ring.len();
        while open(i, a) || open(j, b) {
            let first =
                open(i, a) && (!open(j, b) || (2 * i + 1) * b.len() <= (2 * j + 1) * a.len());
            let (from_a, from_b) = (a[i % a.len()], b[j % b.len()]);
            if first {
                let facing = outward(turn(i, a) + 0.5 / a.len() as f64);
                draft.facet([from_a, a[(i + 1) % a.len()], from_b], side, &facing);
                i += 1;
            } else {
                let facing = outward(turn(j, b) + 0.5 / b.len() as f64);
                draft.facet([from_a, b[(j + 1) % b.len()], from_b], side, &facing);
                j += 1;
            }
        }
    }
}

/// A point at a distance from an axis, at an angle about it, and so far along it.
fn in_space(axis: usize, radius: f64, angle: f64, along: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let mut out = [0.0; 3];
    out[axis] = along;
    out[(axis + 1) % 3] = radius * cos;
    out[(axis + 2) % 3] = radius * sin;
    out
}
