//! Whether a step carried soil into or through a rigid body, and whether the traction at its knots is one
//! that its sides can carry.

use igimp_assembly::{Particles, RigidBody, Shear, Tension};
use igimp_model::Case;

use super::outline::{Outline, in_frame};

/// Nearest that a centre may come to an outline, in half-lengths as seeded \[-\] (theory, after eq. 50).
const LEAST_HEIGHT: f64 = 0.5;
/// Round-off of distances, in half-lengths \[-\].
const ROUND_OFF: f64 = 1e-6;
/// Round-off of traction, relative \[-\].
const NOISE: f64 = 1e-9;
/// Places that are looked at along the way of a particle in the frame of a body.
const PLACES: u32 = 16;

/// The outline of each rigid body of a case, about its reference point.
pub(crate) fn outlines(case: &Case<2>) -> Vec<Outline> {
    let [x, y] = case.grid.smallest_cell();
    let parts = case.rigid.iter();
    parts.map(|part| Outline::of(part, x.min(y))).collect()
}

/// Particles near rigid bodies after a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reach {
    /// The smallest distance of a centre from an outline, in half-lengths as seeded \[-\].
    pub(crate) nearest: Option<f64>,
    /// Violations, in words.
    pub(crate) violations: Vec<String>,
}

/// Looks at all particles after a step. `outlines` are those of `after`, the bodies as the step left them;
/// `before` is the body as the step began, where it is known.
pub(crate) fn reach(
    outlines: &[&Outline],
    before: Option<(&Particles<2>, &[RigidBody<2>])>,
    (particles, after): (&Particles<2>, &[RigidBody<2>]),
) -> Reach {
    let mut found = Reach::default();
    for (slot, (outline, body)) in std::iter::zip(outlines, after).enumerate() {
        for particle in 0..particles.len() {
            let seeded = particles.half_length0[particle];
            let half = seeded[0].min(seeded[1]);
            let x = particles.x[particle];
            let distance = outline.distance(&body.pose, x) / half;
            found.nearest = Some(found.nearest.map_or(distance, |least| least.min(distance)));
            let is_clear = distance >= LEAST_HEIGHT - ROUND_OFF;
            if !is_clear {
                found.violations.push(format!(
                    "particle {particle} at ({:.4}, {:.4}) m stands {distance:.3} half-lengths off body {slot}",
                    x[0], x[1]
                ));
            }
            let Some((old, bodies)) = before else {
                continue;
            };
            let (from, to) = (
                in_frame(&bodies[slot].pose, old.x[particle]),
                in_frame(&body.pose, x),
            );
            let deepest = (1..PLACES)
                .map(|k| {
                    let share = f64::from(k) / f64::from(PLACES);
                    let at = [0, 1].map(|a| from[a] + share * (to[a] - from[a]));
                    outline.distance_within(at) / half
                })
                .fold(f64::INFINITY, f64::min);
            if deepest < -1.0 {
                found.violations.push(format!(
                    "particle {particle} came to ({:.4}, {:.4}) m through body {slot}, {:.3} half-lengths deep",
                    x[0], x[1], -deepest
                ));
            }
        }
    }
    found
}

/// Traction that a side cannot carry, in words.
pub(crate) fn wrong_traction(bodies: &[RigidBody<2>]) -> Vec<String> {
    let mut out = Vec::new();
    for (slot, body) in bodies.iter().enumerate() {
        for (knot, (_, side)) in std::iter::zip(&body.contact.knots, body.surface.knots()) {
            let interface = &body.interfaces[side];
            let least = match interface.tension {
                Tension::None => 0.0,
                Tension::Limit(limit) => -limit * (1.0 + NOISE),
                Tension::Bonded => f64::NEG_INFINITY,
            };
            let most = match &interface.shear {
                Shear::Smooth => 0.0,
                Shear::Rough => f64::INFINITY,
                Shear::Limited {
                    adhesion, friction, ..
                } => {
                    let adhesion = adhesion.iter().copied().fold(0.0, f64::max);
                    adhesion + friction * knot.pressure.max(0.0)
                }
            };
            let holds = knot.pressure >= least && knot.shear[0].abs() <= most * (1.0 + NOISE);
            if !holds {
                out.push(format!(
                    "body {slot}, side {}: pressure {:.4e} Pa and shear {:.4e} Pa are beyond what it carries",
                    side + 1,
                    knot.pressure,
                    knot.shear[0]
                ));
            }
        }
    }
    out
}
