//! The face that a particle turns to a side of a rigid body, as points of integration.

use igimp_shape::Grid;

use super::RigidBody;
use super::surface::dot;
use crate::small::identity;

/// Abscissa of the two-point rule of Gauss on (−1, 1).
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// The face of a particle, parallel to a side of the body.
pub(crate) struct Face<const D: usize> {
    /// Its middle \[length\].
    pub(crate) middle: [f64; D],
    /// The side, and its normal in space.
    side: usize,
    pub(crate) normal: [f64; D],
    /// Tangents in space; one in the plane, two in space.
    pub(crate) tangents: [[f64; D]; 2],
    /// The directions in which it is laid out, those of the particle's domain as far as they lie in the
    /// surface, and half of its extent along each \[length\].
    along: [[f64; D]; 2],
    half: [f64; 2],
    /// From the surface to the face \[length\].
    pub(crate) gap: f64,
}

/// A point of integration on a face.
pub(crate) struct FacePoint<const D: usize> {
    pub(crate) x: [f64; D],
    /// Area that it stands for \[length^(D-1)\].
    pub(crate) area: f64,
    /// Knots of the surface, with their shares.
    pub(crate) knots: [(usize, f64); D],
}

impl<const D: usize> Face<D> {
    /// The face of the particle with centre and half-lengths \[length\] that looks at a side of a body;
    /// none if its centre stands below the side or further off than the particle is thick.
    pub(crate) fn of(
        body: &RigidBody<D>,
        side: usize,
        centre: &[f64; D],
        half_length: &[f64; D],
    ) -> Option<Self> {
        let pose = &body.pose;
        let nearest = body.surface.nearest(&pose.into_body(centre), side);
        let normal = pose.direction(&nearest.normal);
        let reach = |direction: &[f64; D]| -> f64 {
            (0..D).map(|a| half_length[a] * direction[a].abs()).sum()
        };
        let thickness = reach(&normal);
        let gap = nearest.height - thickness;
        if nearest.height <= 0.0 || gap > thickness {
            return None;
        }
        let along = tangents(&normal, &identity());
        let half = along.map(|along| reach(&along));
        // In space the domain seen along the normal is a hexagon, as large as its sides seen so.
        let seen: f64 = (0..D)
            .map(|a| {
                let others = (0..D).filter(|&b| b != a).map(|b| half_length[b]);
                normal[a].abs() * others.product::<f64>()
            })
            .sum();
        let share = if D == 3 {
            (seen / (half[0] * half[1])).sqrt()
        } else {
            1.0
        };
        Some(Self {
            middle: std::array::from_fn(|a| centre[a] - thickness * normal[a]),
            gap,
            along,
            half: half.map(|half| share * half),
            side,
            normal,
            tangents: tangents(&normal, &pose.turn),
        })
    }

    /// Its points of integration: two between any two lines of the grid and knots of the surface that
    /// cut it. Beyond the end of a side there are none. `knots` are those of the surface in space \[length\].
    pub(crate) fn points(
        &self,
        body: &RigidBody<D>,
        knots: &[[f64; D]],
        grid: &Grid<D>,
    ) -> Vec<FacePoint<D>> {
        let (surface, pose) = (&*body.surface, &body.pose);
        let mut rules = [vec![(0.0, 1.0)], vec![(0.0, 1.0)]];
        for (k, rule) in rules.iter_mut().enumerate().take(D - 1) {
            let (tangent, half) = (self.along[k], self.half[k]);
            let mut cuts = vec![-half, half];
            for axis in (0..D).filter(|&axis| tangent[axis].abs() > 1e-6) {
                let lines = grid.axes[axis].nodes().iter();
                cuts.extend(lines.map(|line| (line - self.middle[axis]) / tangent[axis]));
            }
            cuts.extend(knots.iter().map(|place| {
                let arm: [f64; D] = std::array::from_fn(|a| place[a] - self.middle[a]);
                dot(&arm, &tangent)
            }));
            cuts.retain(|cut| cut.abs() <= half);
            cuts.sort_by(f64::total_cmp);
            rule.clear();
            for pair in cuts.windows(2) {
                let (middle, own) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
                if own > 1e-9 * half {
                    rule.extend([-GAUSS, GAUSS].map(|place| (middle + place * own, own)));
                }
            }
        }
        let mut points = Vec::with_capacity(rules[0].len() * rules[1].len());
        for &(s, along) in &rules[0] {
            for &(t, across) in &rules[1] {
                let x: [f64; D] = std::array::from_fn(|a| {
                    self.middle[a] + s * self.along[0][a] + t * self.along[1][a]
                });
                let own = surface.nearest(&pose.into_body(&x), self.side);
                if !own.is_beyond {
                    points.push(FacePoint {
                        x,
                        area: along * across,
                        knots: own.knots,
                    });
                }
            }
        }
        points
    }
}

/// Tangents of a surface: in the plane the normal turned by a right angle, anticlockwise; in space two
/// that turn with a frame.
fn tangents<const D: usize>(normal: &[f64; D], turn: &[[f64; D]; D]) -> [[f64; D]; 2] {
    let mut out = [[0.0; D]; 2];
    if D == 2 {
        out[0][0] = -normal[1];
        out[0][1] = normal[0];
    } else {
        let column = |k: usize| -> [f64; D] { std::array::from_fn(|a| turn[a][k]) };
        let least = (0..D)
            .min_by(|&a, &b| {
                let along = |k: usize| dot(&column(k), normal).abs();
                along(a).total_cmp(&along(b))
            })
            .unwrap_or(0);
        let axis = column(least);
        let share = dot(&axis, normal);
        let flat: [f64; D] = std::array::from_fn(|a| axis[a] - share * normal[a]);
        let size = dot(&flat, &flat).sqrt();
        out[0] = flat.map(|a| a / size);
        for a in 0..D {
            let (b, c) = ((a + 1) % D, (a + 2) % D);
            out[1][a] = normal[b] * out[0][c] - normal[c] * out[0][b];
        }
    }
    out
}
