//! Outlines of rigid bodies as the theory states them, without the code of contact: a core polygon and
//! all points as far from it as its corners are rounded.

use igimp_assembly::Pose;
use igimp_model::{RigidPart, RigidShape};

/// An outline in the frame of its body: a core, and a radius around it. The core of a circle is its centre.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    /// Corners in order, anticlockwise \[m\].
    core: Vec<[f64; 2]>,
    /// Radius of the corners \[m\].
    radius: f64,
}

impl Outline {
    /// The outline of a body of a case about its reference point, its corners rounded by cells of a size.
    pub(crate) fn of(part: &RigidPart<2>, cell: f64) -> Self {
        match part.shape.in_plane() {
            None => Self {
                core: Vec::new(),
                radius: 0.0,
            },
            Some(RigidShape::Circle { radius, .. }) => Self {
                core: vec![[0.0; 2]],
                radius: *radius,
            },
            Some(RigidShape::Polygon(corners)) => {
                let [x, y] = part.reference;
                let rel: Vec<[f64; 2]> = corners.iter().map(|at| [at[0] - x, at[1] - y]).collect();
                let radius = part.rounding * cell;
                Self {
                    core: inset(&anticlockwise(rel), radius),
                    radius,
                }
            }
        }
    }

    /// Distance of a point of space from the outline of a body that stands in a pose, negative within it \[m\].
    pub(crate) fn distance(&self, pose: &Pose<2>, x: [f64; 2]) -> f64 {
        self.distance_within(in_frame(pose, x))
    }

    /// The same for a point in the frame of the body.
    pub(crate) fn distance_within(&self, x: [f64; 2]) -> f64 {
        if let [centre] = self.core[..] {
            return (x[0] - centre[0]).hypot(x[1] - centre[1]) - self.radius;
        }
        let mut nearest = f64::INFINITY;
        let mut is_within = false;
        for (a, b) in edges(&self.core) {
            nearest = nearest.min(to_segment(x, a, b));
            if (a[1] > x[1]) != (b[1] > x[1]) {
                let at = a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                is_within ^= x[0] < at;
            }
        }
        if is_within {
            -nearest - self.radius
        } else {
            nearest - self.radius
        }
    }
}

/// A point of space in the frame of a body.
pub(crate) fn in_frame(pose: &Pose<2>, x: [f64; 2]) -> [f64; 2] {
    let arm = [x[0] - pose.origin[0], x[1] - pose.origin[1]];
    [0, 1].map(|k| pose.turn[0][k] * arm[0] + pose.turn[1][k] * arm[1])
}

/// The edges of a polygon.
pub(crate) fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().copied().zip(next.copied())
}

/// Twice the area of a polygon, positive if its corners run anticlockwise.
fn twice_area(corners: &[[f64; 2]]) -> f64 {
    edges(corners).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

/// The same polygon with its corners anticlockwise.
pub(crate) fn anticlockwise(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    if twice_area(&corners) < 0.0 {
        corners.reverse();
    }
    corners
}

/// The polygon whose sides lie a distance inside those of another, where these meet.
pub(crate) fn inset(corners: &[[f64; 2]], by: f64) -> Vec<[f64; 2]> {
    // Each side as normal out of the polygon, and the distance of its line from the origin.
    let lines: Vec<([f64; 2], f64)> = edges(corners)
        .map(|(a, b)| {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = dx.hypot(dy);
            let normal = [dy / length, -dx / length];
            (normal, normal[0] * a[0] + normal[1] * a[1] - by)
        })
        .collect();
    let count = lines.len();
    (0..count)
        .map(|k| {
            let (n, d) = lines[(k + count - 1) % count];
            let (m, e) = lines[k];
            let det = n[0] * m[1] - n[1] * m[0];
            if det.abs() < 1e-9 {
                let corner = corners[k];
                return [corner[0] - by * n[0], corner[1] - by * n[1]];
            }
            [(d * m[1] - e * n[1]) / det, (n[0] * e - m[0] * d) / det]
        })
        .collect()
}

/// Distance of a point from a segment.
fn to_segment(x: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let share = ((x[0] - a[0]) * dx + (x[1] - a[1]) * dy) / (dx * dx + dy * dy);
    let share = share.clamp(0.0, 1.0);
    (x[0] - a[0] - share * dx).hypot(x[1] - a[1] - share * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: distances to a rounded square and to its corner.
    /// ORACLE: by hand.
    #[test]
    fn distances_are_those_by_hand() {
        let square = vec![[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
        let core = inset(&anticlockwise(square), 0.5);
        let outline = Outline { core, radius: 0.5 };
        let diagonal = 0.5 * f64::sqrt(2.0) - 0.5;
        for (x, expected) in [
            ([0.0, 1.25], 0.25),
            ([0.0, 0.75], -0.25),
            ([1.0, 1.0], diagonal),
            ([0.0, 0.0], -1.0),
        ] {
            let found = outline.distance_within(x);
            assert!((found - expected).abs() < 1e-12, "{x:?}: {found}");
        }
        let turned =
            Pose::at([3.0, 0.0]).moved(&[0.0, 1.0], &[std::f64::consts::FRAC_PI_4, 0.0, 0.0]);
        let found = outline.distance(&turned, [3.0, 1.0 + f64::sqrt(2.0)]);
        assert!((found - diagonal).abs() < 1e-12, "{found}");
    }
}
