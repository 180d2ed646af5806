//! The face that a particle turns to a side of a rigid body, as points of integration.

use igimp_shape::Grid;

use crate::{Image, RigidBody};
use igimp_surface::vectors::{dot, minus, norm};

/// Abscissa of the two-point rule of Gauss on (−1, 1).
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// A side whose normal has so much of an axis of the grid is along the grid, within some 6°: domains of particles end along it, and
/// in steps beside others \[-\].
pub const ALONG_THE_GRID: f64 = 0.995;

/// Height of the centre of a particle at which it counts no more before a side along the grid, over that at which it counts in full, in the
/// plane and in space \[-\]. A choice: the next layer of particles stands at one and a half. In the plane a wider one makes coarse grids
/// too stiff, in space a narrower one loses single steps.
const FADED: [f64; 2] = [1.04, 1.2];

/// A particle hides what begins before it ends, by no more than this share of its thickness \[-\]. A choice: soil that is strained does not
/// keep its domains end to end, and of those that are disordered each is to face the body.
const OVERLAP: f64 = 0.1;

/// A particle that was drawn thinner than this share of one behind it is the rest of a row that an outline cuts \[-\]. A choice: rows
/// that an outline does not cut are alike, and one that is hidden stands behind half of its own thickness at most.
const CUT: f64 = 0.75;

/// The face of a particle, parallel to a side of the body.
pub struct Face<const D: usize> {
    /// Its middle \[length\].
    pub middle: [f64; D],
    /// The side of the body.
    pub side: usize,
    /// The normal of the side in space.
    pub normal: [f64; D],
    /// The same in the frame of the body.
    pub(crate) facing: [f64; D],
    /// The directions in which it is laid out: one in the plane, two in space.
    pub(crate) along: [[f64; D]; 2],
    /// Half of its length in these directions \[length\].
    half: [f64; 2],
    /// Half of the particle's thickness along the normal, now and as it was drawn \[length\].
    thickness: f64,
    drawn: f64,
    /// From the surface to the face \[length\].
    pub gap: f64,
    /// Share by which it counts: less than 1 where its particle stands nearly too far off \[-\].
    pub(crate) share: f64,
    /// Whether its particle stands further off than one that counts in full.
    is_far: bool,
    /// Centre and half-lengths of the domain of its particle \[length\].
    domain: [[f64; D]; 2],
}

/// A point of integration on a face.
pub struct FacePoint<const D: usize> {
    /// Its place in space \[length\].
    pub x: [f64; D],
    /// Area that it stands for \[length^(D-1)\].
    pub area: f64,
    /// Knots of the surface, with their shares.
    pub knots: [(usize, f64); D],
}

impl<const D: usize> Face<D> {
    /// The face of the particle with centre and half-lengths \[length\] that looks at a side of a body;
    /// none if its centre stands below the side or further off than the particle is thick (theory, eq. 45b).
    pub fn of(
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
        // In space centres within this height cover the side once, whatever the direction.
        let most = if D == 3 {
            let volume: f64 = half_length.iter().product();
            let seen = (0..D).map(|a| normal[a].abs() * volume / half_length[a]);
            2.0 * volume / seen.sum::<f64>()
        } else {
            f64::INFINITY
        };
        let is_far = gap > thickness || nearest.height > most;
        let fades =
            body.surface.radius().is_none() && normal.iter().any(|x| x.abs() >= ALONG_THE_GRID);
        let share = match (is_far, fades) {
            (false, _) => 1.0,
            (true, true) => {
                let (most, faded) = (most.min(2.0 * thickness), FADED[D - 2]);
                ((faded * most - nearest.height) / ((faded - 1.0) * most)).min(1.0)
            }
            (true, false) => 0.0,
        };
        if nearest.height <= 0.0 || share <= 0.0 {
            return None;
        }
        let along = tangents(&normal);
        Some(Self {
            middle: std::array::from_fn(|a| centre[a] - thickness * normal[a]),
            gap,
            share,
            is_far,
            domain: [*centre, *half_length],
            half: along.map(|tangent| reach(&tangent)),
            thickness,
            drawn: thickness,
            along,
            side,
            normal,
            facing: nearest.normal,
        })
    }

    /// The same of a particle whose soil reaches `beyond` its domain \[length\]: towards the side the face is that of the soil (theory, eq. 45i).
    #[must_use]
    pub fn grown(mut self, beyond: &[f64; D]) -> Self {
        self.gap -= (-dot(beyond, &self.normal)).max(0.0);
        self
    }

    /// The same of a particle that was drawn with these half-lengths \[length\].
    #[must_use]
    pub fn drawn_with(mut self, half_length: &[f64; D]) -> Self {
        self.drawn = (0..D).map(|a| half_length[a] * self.normal[a].abs()).sum();
        self
    }

    /// Whether its particle stands further off than one that counts in full: behind another it does not count.
    pub fn is_far(&self) -> bool {
        self.is_far
    }

    /// Whether its particle ends before a face at a gap begins, or hardly behind it.
    pub fn may_hide(&self, gap: f64) -> bool {
        self.gap + (1.0 - OVERLAP) * 2.0 * self.thickness <= gap
    }

    /// Whether its particle lies between the side and the middle of another face of that side (theory, eq. 45f).
    pub fn hides(&self, other: &Self) -> bool {
        let arm = minus(&other.middle, &self.middle);
        let mut tangents = std::iter::zip(&self.along, self.half).take(D - 1);
        self.may_hide(other.gap) && tangents.all(|(tangent, half)| dot(&arm, tangent).abs() < half)
    }

    /// Whether its particle is the rest of a row that an outline cuts, as seen from another face.
    pub fn is_cut_before(&self, other: &Self) -> bool {
        self.drawn < CUT * other.drawn
    }

    /// The directions in which the soil behind it slips along the image of a knot: those that its own mirror image has there, seen
    /// in the mirror (theory, eqs. 45a and 45h).
    pub fn tangents_at(&self, body: &RigidBody<D>, image: Image<D>) -> [[f64; D]; 2] {
        let Some(space) = body.surface.space() else {
            let tangents = tangents(&image.mirrored(&self.normal));
            return tangents.map(|tangent| image.mirrored(&tangent));
        };
        let (pose, knot) = (&body.pose, image.knot);
        let facing = if image == Image::alone(knot) {
            self.facing
        } else {
            pose.direction_in_body(&image.mirrored(&self.normal))
        };
        let tangents = space.tangents_at(knot, &facing);
        tangents.map(|tangent| image.mirrored(&pose.direction(&tangent)))
    }

    /// A point of its plane in space.
    pub fn at(&self, place: &[f64; 2]) -> [f64; D] {
        let [s, t] = place;
        std::array::from_fn(|a| self.middle[a] + s * self.along[0][a] + t * self.along[1][a])
    }

    /// From a body that is round with this radius to the side of the domain that looks at it, along the line from its middle through a
    /// point of the face, or to the place of that side that is nearest to the line \[length\] (theory, eq. 45e). A face that is along no
    /// side of the domain touches it at a corner; the soil behind it stands further off.
    pub fn gap_along(&self, middle: &[f64; D], radius: f64, x: &[f64; D]) -> f64 {
        let [centre, half] = &self.domain;
        let across = (0..D).fold(0, |most, axis| {
            if self.normal[axis].abs() > self.normal[most].abs() {
                axis
            } else {
                most
            }
        });
        let side = centre[across] - self.normal[across].signum() * half[across];
        let arm = minus(x, middle);
        // A body smaller than the domain has its middle beside it: the side itself is as near.
        let reach = (side - middle[across]) / arm[across];
        let meets = reach > 0.0 && reach.is_finite();
        let place: [f64; D] = std::array::from_fn(|axis| {
            let along = if meets {
                middle[axis] + reach * arm[axis]
            } else {
                x[axis]
            };
            if axis == across {
                side
            } else {
                along.clamp(centre[axis] - half[axis], centre[axis] + half[axis])
            }
        });
        norm(&minus(&place, middle)) - radius
    }

    /// Its points of integration in the plane: two between any two lines of the grid and knots of the surface that
    /// cut it. Beyond the end of a side there are none. `knots` are those of the surface in space \[length\].
    pub fn points(
        &self,
        body: &RigidBody<D>,
        knots: &[[f64; D]],
        grid: &Grid<D>,
    ) -> Vec<FacePoint<D>> {
        let (surface, pose) = (&*body.surface, &body.pose);
        let (tangent, half) = (self.along[0], self.half[0]);
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
        let mut points = Vec::new();
        for pair in cuts.windows(2) {
            let (middle, reach) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            if reach <= 1e-9 * half {
                continue;
            }
            for place in [-GAUSS, GAUSS] {
                let x = self.at(&[middle + place * reach, 0.0]);
                let nearest = surface.nearest(&pose.into_body(&x), self.side);
                if !nearest.is_beyond {
                    points.push(FacePoint {
                        x,
                        area: self.share * reach,
                        knots: nearest.knots,
                    });
                }
            }
        }
        points
    }
}

/// Tangents of a face: in the plane the normal turned by a right angle, anticlockwise; in space the axis that
/// is least along the normal, as far as it lies in the face, and the normal times it.
fn tangents<const D: usize>(normal: &[f64; D]) -> [[f64; D]; 2] {
    let mut out = [[0.0; D]; 2];
    if D == 2 {
        out[0][0] = -normal[1];
        out[0][1] = normal[0];
        return out;
    }
    let least = (0..D)
        .min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()))
        .unwrap_or(0);
    let mut flat = normal.map(|x| -normal[least] * x);
    flat[least] += 1.0;
    let size = dot(&flat, &flat).sqrt();
    out[0] = flat.map(|a| a / size);
    for a in 0..D {
        let (b, c) = ((a + 1) % D, (a + 2) % D);
        out[1][a] = normal[b] * out[0][c] - normal[c] * out[0][b];
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Interface;
    use igimp_surface::Surface;

    // GOAL: a body that rolls sees level ground where it is.
    // CASE: a circle of radius 1 that stands 0.02 above ground, and particles of the uppermost layer beside its lowest point.
    // ORACLE: along a line from its middle, at an angle θ to the vertical, ground is 1.02 / cos θ off; corners of faces are nearer.
    #[test]
    fn a_round_body_sees_level_ground_where_it_is() {
        let (radius, half) = (1.0, [0.1; 2]);
        let surface = Surface::circle(radius, 0.1).unwrap();
        let middle = [0.0, 1.02];
        let body = RigidBody::new(surface, vec![Interface::rough()], middle);
        for place in [0.0, 0.2, 0.4] {
            let face = Face::of(&body, 0, &[place, -half[1]], &half).unwrap();
            let x = face.at(&[0.0, 0.0]);
            let slope = x[0] / (middle[1] - x[1]);
            let expected = middle[1] * slope.hypot(1.0) - radius;
            let gap = face.gap_along(&middle, radius, &x);
            assert!((gap - expected).abs() < 1e-12, "{gap} {expected}");
            assert!(gap > face.gap - 1e-12, "{gap} {}", face.gap);
        }
    }

    // GOAL: soil behind other soil does not face a side.
    // CASE: level rows of particles below a straight side; the first is a slice of 0.2, 0.5 and 0.75 of the thickness of those behind.
    // ORACLE: the sketch: the row behind faces the side through slices up to half of its thickness, and is hidden below the slice alone.
    #[test]
    fn a_thin_particle_hides_what_is_behind_it() {
        let corners = [[-1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]];
        let surface = Surface::polygon(&corners, 0.0, 0.1).unwrap();
        let body = RigidBody::new(surface, vec![Interface::rough(); 4], [0.0; 2]);
        let half = 0.1;
        for (share, faces) in [(0.2, true), (0.5, true), (0.75, false)] {
            let slice = share * half;
            let front = [0.0, -slice];
            let front = Face::of(&body, 0, &front, &[half, slice]).unwrap();
            assert!(front.gap.abs() < 1e-15);
            let behind = Face::of(&body, 0, &[0.0, -2.0 * slice - half], &[half; 2]);
            assert_eq!(behind.is_some(), faces, "{share}");
            let Some(behind) = behind else { continue };
            assert!(front.may_hide(behind.gap) && !behind.may_hide(front.gap));
            let beside = [2.0 * half, -2.0 * slice - half];
            let beside = Face::of(&body, 0, &beside, &[half; 2]).unwrap();
            assert!(front.hides(&behind) && !front.hides(&beside));
            // A slice as it is drawn is the rest of a row that is cut; one that was pressed thin is not.
            assert!(front.is_cut_before(&behind) && !behind.is_cut_before(&front));
            let pressed = Face::of(&body, 0, &[0.0, -slice], &[half, slice]).unwrap();
            let pressed = pressed.drawn_with(&[half; 2]);
            assert!(pressed.hides(&behind) && !pressed.is_cut_before(&behind));
            // Soil is strained: the slice has come on by so much of its thickness.
            for (overlap, hides) in [(0.05, true), (0.15, false)] {
                let on = [0.0, -(1.0 + 2.0 * overlap) * slice];
                let on = Face::of(&body, 0, &on, &[half, slice]).unwrap();
                assert_eq!(on.hides(&behind), hides, "{share} {overlap}");
            }
        }
    }
    // GOAL: soil that moves off a side along the grid is lost by and by, that before a slanted one at once.
    // CASE: a particle below a straight side, at heights of its centre over its thickness.
    // ORACLE: by hand, eq. 45b.
    #[test]
    fn soil_that_moves_off_fades() {
        let share = |turn: f64, height: f64| {
            let corners = [[-1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]];
            let surface = Surface::polygon(&corners, 0.0, 0.1).unwrap();
            let mut body = RigidBody::new(surface, vec![Interface::rough(); 4], [0.0; 2]);
            body.pose = body.pose.moved(&[0.0; 2], &[turn, 0.0, 0.0]);
            let thickness = 0.1 * (turn.cos() + turn.sin());
            let centre = [turn.sin(), -turn.cos()].map(|x| x * 2.0 * height * thickness);
            Face::of(&body, 0, &centre, &[0.1; 2]).map(|face| face.share)
        };
        for (height, expected) in [
            (0.5, Some(1.0)),
            (0.99, Some(1.0)),
            (1.02, Some(0.5)),
            (1.05, None),
        ] {
            let found = share(0.0, height);
            assert_eq!(found.is_some(), expected.is_some(), "{height}");
            let off = found.unwrap_or(0.0) - expected.unwrap_or(0.0);
            assert!(off.abs() < 1e-12, "{height}: {off}");
        }
        assert_eq!(share(0.5, 0.99), Some(1.0));
        assert_eq!(share(0.5, 1.01), None);
    }
}
