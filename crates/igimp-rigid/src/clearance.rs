//! How close particles may come to rigid bodies (theory, after eq. 50): contact holds the mean around a
//! knot, and single particles creep across a surface.

use thiserror::Error;

use igimp_surface::vectors::{minus, norm};

use crate::{Face, RigidBody};

/// The centre of a particle stands at least so far off a body, in half-lengths as seeded \[-\]. A choice: an undeformed domain
/// then reaches no further into the body than a quarter of its width, and a particle at rest on a side, one half-length off,
/// is left alone until half of that has crept away.
const LEAST_HEIGHT: f64 = 0.5;

/// A step carries a centre at most so far into a body, in half-lengths as seeded \[-\]. A choice: beyond that the whole domain lies
/// within the body, and the way back could lead through its other side.
const MOST_DEPTH: f64 = 1.0;

/// Soil that a body did not see as a step began comes no nearer than this in it, in half-lengths as seeded, or in half of its
/// thickness where it is flatter \[-\]: nearer its domain would lie within the body before contact has acted.
const UNSEEN_HEIGHT: f64 = 1.0;

/// In a notch, or between two bodies, the way off one side leads to another: the sides are looked at so often.
const MOST_PASSES: usize = 20;

/// The round-off of the least height after the first pass, as a share of it \[-\].
const ROUND_OFF: f64 = 1e-9;

/// A particle would be carried into a rigid body, through it, or up to it from where the body did not see it.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("particle {particle} {} the rigid body \"{body}\" on its way to {position:?} m", way(*depth))]
pub struct Penetration {
    /// Number of the particle, from 0.
    pub particle: usize,
    /// Name of the body.
    pub body: String,
    /// How deep, in half-lengths of the particle as seeded; below zero outside of the body \[-\].
    pub depth: f64,
    /// Where its centre would be in the end \[length\], axes beyond the dimension 0.
    pub position: [f64; 3],
}

/// The domains of particles beside bodies.
#[derive(Clone, Copy)]
pub struct Domains<'a, const D: usize> {
    /// Centres \[length\].
    pub x: &'a [[f64; D]],
    /// Half-lengths \[length\].
    pub half_length: &'a [[f64; D]],
    /// Half-lengths as seeded \[length\].
    pub half_length0: &'a [[f64; D]],
}

/// How a particle comes to a body, by its depth there.
fn way(depth: f64) -> String {
    if depth > 0.0 {
        format!("would be carried {depth:.2} of its half-length into")
    } else {
        let off = -depth;
        format!("would come, unseen as the step began, within {off:.2} of its half-length of")
    }
}

/// A body with its extent in its own frame \[length\].
struct Extent<'a, const D: usize> {
    body: &'a RigidBody<D>,
    lower: [f64; D],
    upper: [f64; D],
}

impl<'a, const D: usize> Extent<'a, D> {
    fn all(bodies: &'a [RigidBody<D>]) -> Vec<Self> {
        let of = |body: &'a RigidBody<D>| {
            let (lower, upper) = body.surface.extent();
            Self { body, lower, upper }
        };
        bodies.iter().map(of).collect()
    }

    /// Whether a way between two points in the frame of the body may lead nearer to it than a distance.
    fn may_reach(&self, from: &[f64; D], to: &[f64; D], within: f64) -> bool {
        (0..D).all(|axis| {
            from[axis].max(to[axis]) >= self.lower[axis] - within
                && from[axis].min(to[axis]) <= self.upper[axis] + within
        })
    }

    /// Where a straight `way` from a point in the frame of the body may be nearer to it than a distance: from one share of it to another
    /// \[-\].
    fn within(&self, from: &[f64; D], way: &[f64; D], distance: f64) -> [f64; 2] {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for axis in (0..D).filter(|&axis| way[axis].abs() > f64::MIN_POSITIVE) {
            let at = |place: f64| (place - from[axis]) / way[axis];
            let (a, b) = (
                at(self.lower[axis] - distance),
                at(self.upper[axis] + distance),
            );
            enters = enters.max(a.min(b));
            leaves = leaves.min(a.max(b));
        }
        [enters, leaves]
    }
}

/// Particles that stand too close to a body, with the way off it \[length\].
pub type WaysOff<const D: usize> = Vec<(usize, [f64; D])>;

/// The particles that a step leaves too close to bodies, with the way back. The step carries a particle to
/// `place` and bodies from `before` to `after`; contact `acts` on a body near a point in its frame.
///
/// # Errors
/// [`Penetration`] for the first particle that it would carry into a body or through it, or close to it, without contact on its way,
/// from where the body did not see it as the step began.
pub fn push_out<const D: usize>(
    (before, after): (&[RigidBody<D>], &[RigidBody<D>]),
    particles: Domains<'_, D>,
    place: impl Fn(usize) -> [f64; D],
    acts: impl Fn(usize, &[f64; D]) -> bool,
) -> Result<WaysOff<D>, Penetration> {
    let mut out = Vec::new();
    if after.is_empty() {
        return Ok(out);
    }
    let extents = Extent::all(after);
    for particle in 0..particles.x.len() {
        let x = place(particle);
        let half = smallest(&particles.half_length0[particle]);
        for (body, (extent, old)) in extents.iter().zip(before).enumerate() {
            let from = old.pose.into_body(&particles.x[particle]);
            let depth = deepest(extent, &from, &x, half);
            let is_unseen = || {
                let to = extent.body.pose.into_body(&x);
                depth > -UNSEEN_HEIGHT * thickness(extent.body, particles, particle).min(half)
                    && !is_seen(old, particles, particle)
                    && !acts(body, &to)
            };
            let is_too_near = depth > -UNSEEN_HEIGHT * half && is_unseen();
            if is_too_near || depth > MOST_DEPTH * half {
                return Err(Penetration {
                    particle,
                    body: extent.body.name.clone(),
                    depth: depth / half,
                    position: std::array::from_fn(|axis| x.get(axis).copied().unwrap_or(0.0)),
                });
            }
        }
        out.extend(way_off(&extents, &x, half).map(|way| (particle, way)));
    }
    Ok(out)
}

/// Half of the thickness of a particle towards a body \[length\].
fn thickness<const D: usize>(
    body: &RigidBody<D>,
    particles: Domains<'_, D>,
    particle: usize,
) -> f64 {
    let normal = body.nearest(&particles.x[particle]).1;
    let half = &particles.half_length[particle];
    (0..D).map(|axis| half[axis] * normal[axis].abs()).sum()
}

/// Whether a particle turns a face to a body (theory, eq. 45b), or is in it.
fn is_seen<const D: usize>(
    body: &RigidBody<D>,
    particles: Domains<'_, D>,
    particle: usize,
) -> bool {
    let (x, half) = (&particles.x[particle], &particles.half_length[particle]);
    let mut sides = 0..body.surface.side_count();
    body.distance(x) <= 0.0 || sides.any(|side| Face::of(body, side, x, half).is_some())
}

/// Particles that stand too close to bodies, or within them by no more than their domains reach, with the way
/// off: soil is seeded in the middle of parts of a cell, which the side of a body may cut.
pub fn seeded_too_close<const D: usize>(
    bodies: &[RigidBody<D>],
    particles: Domains<'_, D>,
) -> WaysOff<D> {
    let extents = Extent::all(bodies);
    let of = |particle: usize| {
        let (x, seeded) = (&particles.x[particle], &particles.half_length0[particle]);
        let is_cut = bodies.iter().all(|body| {
            let (distance, normal) = body.nearest(x);
            let reach: f64 = (0..D).map(|axis| seeded[axis] * normal[axis].abs()).sum();
            distance > -reach
        });
        let way = is_cut.then(|| way_off(&extents, x, smallest(seeded)));
        way.flatten().map(|way| (particle, way))
    };
    (0..particles.x.len()).filter_map(of).collect()
}

fn smallest<const D: usize>(half_length: &[f64; D]) -> f64 {
    half_length.iter().copied().fold(f64::INFINITY, f64::min)
}

/// How deep a step carries a centre into a body, from a point in its frame to one of space, the places on
/// the way no more than a half-length apart \[length\].
fn deepest<const D: usize>(
    extent: &Extent<'_, D>,
    from: &[f64; D],
    x: &[f64; D],
    half: f64,
) -> f64 {
    let to = extent.body.pose.into_body(x);
    if !extent.may_reach(from, &to, UNSEEN_HEIGHT * half) {
        return f64::NEG_INFINITY;
    }
    let way = minus(&to, from);
    let places = (norm(&way) / half).ceil().max(1.0);
    let [enters, leaves] = extent.within(from, &way, UNSEEN_HEIGHT * half);
    // As many as the body has room for, however long the way is.
    let first = (enters * places).floor().max(1.0);
    let count = ((leaves * places).ceil().min(places) - first + 1.0).max(0.0) as usize;
    (0..count)
        .map(|k| {
            let share = (first + k as f64) / places;
            let at = std::array::from_fn(|axis| from[axis] + share * way[axis]);
            -extent.body.surface.distance(&at).0
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

/// The way of a centre off the bodies that it stands too close to \[length\].
fn way_off<const D: usize>(extents: &[Extent<'_, D>], x: &[f64; D], half: f64) -> Option<[f64; D]> {
    let least = LEAST_HEIGHT * half;
    let mut way = [0.0; D];
    let mut is_close = false;
    for pass in 0..MOST_PASSES {
        let enough = if pass == 0 {
            least
        } else {
            (1.0 - ROUND_OFF) * least
        };
        let mut is_clear = true;
        for extent in extents {
            let at = std::array::from_fn(|axis| x[axis] + way[axis]);
            let local = extent.body.pose.into_body(&at);
            if !extent.may_reach(&local, &local, least) {
                continue;
            }
            let (distance, normal) = extent.body.nearest(&at);
            if distance < enough {
                for axis in 0..D {
                    way[axis] += (least - distance) * normal[axis];
                }
                is_clear = false;
            }
        }
        is_close |= !is_clear;
        if is_clear {
            break;
        }
    }
    is_close.then_some(way)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Interface;
    use igimp_surface::Surface;

    // GOAL: a particle that has become flat comes on towards a body in steps, however small they are.
    // CASE: one that was seeded 0.25 thick and is 0.1 thick, 0.4 to 0.05 above a floor, in steps of any length.
    // ORACLE: its domain reaches the floor at a height of 0.1; the body sees it within 0.2, when it comes nearer with contact.
    #[test]
    fn flat_soil_comes_up_to_a_body() {
        let corners = [[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-2.0, 0.0]];
        let surface = Surface::polygon(&corners, 0.0, 0.5).unwrap();
        let body = [RigidBody::new(
            surface,
            vec![Interface::smooth(); 4],
            [0.0; 2],
        )];
        let comes = |from: f64, to: f64| {
            let particles = Domains {
                x: &[[0.0, from]],
                half_length: &[[0.4, 0.1]],
                half_length0: &[[0.25; 2]],
            };
            push_out((&body, &body), particles, |_| [0.0, to], |_, _| false)
        };
        for (from, to) in [(0.4, 0.24), (0.26, 0.201), (0.21, 0.199), (0.21, 0.13)] {
            assert!(comes(from, to).unwrap().is_empty(), "{from} {to}");
        }
        for (from, to) in [(0.4, 0.09), (0.21, 0.05)] {
            let depth = comes(from, to).unwrap_err().depth;
            assert!((depth + to / 0.25).abs() < 1e-12, "{from} {to}: {depth}");
        }
        // In sight of the body contact acts, and what has crept too close is moved off.
        let off = comes(0.19, 0.05).unwrap();
        assert!((off[0].1[1] - 0.075).abs() < 1e-12, "{off:?}");
    }

    // GOAL: a way of any length is looked at where the body is, and nowhere else.
    // CASE: a particle that a body passes over, ways of 4 to 1e15 body's lengths; one that it passes by.
    // ORACLE: the particle goes through the middle of the body, half of its width deep; beside the body there is no depth.
    #[test]
    fn long_ways_are_looked_at_where_the_body_is() {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let surface = Surface::polygon(&corners, 0.0, 0.5).unwrap();
        let body = RigidBody::new(surface, vec![Interface::smooth(); 4], [0.0; 2]);
        let bodies = [body];
        let extents = Extent::all(&bodies);
        for reach in [4.0, 1e3, 1e9, 1e15] {
            let through = deepest(&extents[0], &[-reach, 0.0], &[reach, 0.0], 0.1);
            // Places of ways as long as 1e15 are known to 0.1.
            assert!((through - 1.0).abs() < 0.15, "{reach}: {through}");
            let beside = deepest(&extents[0], &[-reach, 3.0], &[reach, 3.0], 0.1);
            assert!(beside < 0.0, "{reach}: {beside}");
        }
    }
}
