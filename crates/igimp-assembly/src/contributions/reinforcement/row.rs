//! One bar of a member over a step.

use super::{Segment, SegmentState};
use crate::conditions::reinforcement::ReinforcementControl;
use crate::contributions::nodal_forces::AddBlock;

/// A bar, with its shares of nodes frozen at the start of the step.
#[derive(Debug)]
pub(crate) struct Row<const D: usize> {
    pub(crate) segment: Segment,
    pub(crate) control: ReinforcementControl,
    /// Axial stiffness EA \[force\].
    pub(crate) stiffness: f64,
    /// From one station to the next, at the start of the step \[length\].
    pub(crate) along: [f64; D],
    /// Shares of nodes in the displacement of one station beyond the other's, ascending \[-\].
    pub(crate) relative: Vec<(usize, f64)>,
    /// Whether elongation is linear in the step's displacement, and the direction stays.
    pub(crate) is_small: bool,
}

/// A bar at a trial displacement.
pub(crate) struct Pull<const D: usize> {
    /// Its state.
    pub(crate) state: SegmentState,
    /// Direction of the tension on the one station, towards the other \[-\].
    direction: [f64; D],
    /// Change of tension with elongation \[force/length\].
    axial: f64,
    /// Change of force with turning \[force/length\].
    turning: f64,
}

impl<const D: usize> Row<D> {
    /// The bar at nodal step displacements `u` (theory, eqs. 56 to 58).
    pub(crate) fn pull(&self, u: &[[f64; D]]) -> Pull<D> {
        let mut by = [0.0; D];
        for &(node, share) in &self.relative {
            for axis in 0..D {
                by[axis] += share * u[node][axis];
            }
        }
        let before = length(&self.along);
        let (elongation, direction, now) = if self.is_small {
            let direction = self.along.map(|x| x / before);
            (dot(&direction, &by), direction, f64::INFINITY)
        } else {
            let chord: [f64; D] = std::array::from_fn(|axis| self.along[axis] + by[axis]);
            let now = length(&chord);
            // The difference of the lengths, without loss of digits.
            let elongation = (2.0 * dot(&self.along, &by) + dot(&by, &by)) / (now + before);
            (elongation, chord.map(|x| x / now), now)
        };
        let strain = self.segment.state.strain + elongation / self.segment.length;
        let limit = self.segment.limit(self.control.reduction);
        let (force, slack, is_stretched) = if let Some(jack) = self.control.jack {
            let force = jack.min(limit);
            (force, strain - force / self.stiffness, false)
        } else {
            let slack = self.segment.state.slack;
            let elastic = self.stiffness * (strain - slack);
            if elastic > limit * (1.0 + 1e-12) {
                (limit, strain - limit / self.stiffness, false)
            } else if elastic < 0.0 {
                (0.0, slack, false)
            } else {
                (elastic, slack, true)
            }
        };
        Pull {
            state: SegmentState {
                strain,
                slack,
                force,
                is_at_limit: force > 0.0 && force >= limit * (1.0 - 1e-9),
            },
            direction,
            axial: if is_stretched {
                self.stiffness / self.segment.length
            } else {
                0.0
            },
            turning: force / now,
        }
    }

    /// The work of the tension at the end of the step on its stretch, and the elastic part of that work
    /// \[force·length\].
    pub(crate) fn work(&self, u: &[[f64; D]]) -> [f64; 2] {
        let (before, after) = (self.segment.state, self.pull(u).state);
        let stretch = after.strain - before.strain;
        let of_length = after.force * self.segment.length;
        let slip = after.slack - before.slack;
        [of_length * stretch, of_length * (stretch - slip)]
    }

    /// Adds its force and, if asked for, its tangent (theory, eq. 59).
    pub(crate) fn add(
        &self,
        u: &[[f64; D]],
        f: &mut [[f64; D]],
        blocks: Option<&mut AddBlock<'_, D>>,
    ) {
        let pull = self.pull(u);
        let t = &pull.direction;
        for &(node, share) in &self.relative {
            for axis in 0..D {
                f[node][axis] += share * pull.state.force * t[axis];
            }
        }
        let Some(blocks) = blocks else {
            return;
        };
        if pull.axial == 0.0 && pull.turning == 0.0 {
            return;
        }
        for &(row, of_row) in &self.relative {
            for &(column, of_column) in &self.relative {
                let shares = of_row * of_column;
                let block = std::array::from_fn(|a| {
                    std::array::from_fn(|b| {
                        let unit = if a == b { 1.0 } else { 0.0 };
                        let along = t[a] * t[b];
                        shares * (pull.axial * along + pull.turning * (unit - along))
                    })
                });
                blocks(row, column, &block);
            }
        }
    }
}

fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    std::iter::zip(a, b).map(|(a, b)| a * b).sum()
}

/// Length of a vector \[length\].
pub(crate) fn length<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}
