//! Walls: values beyond which a law or a test is refused, or residuals leap: the sum of squares ends there, and has no derivative.

use super::parameter::Parameter;
use super::problem::{DIFFERENCE, Problem};

/// A place in the search as near to an end is at it.
pub(super) const AT_END: f64 = 1e-9;

/// Halvings of the step that leads across a wall.
const HALVINGS: usize = 30;

/// Between which places a parameter is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    /// The lower and the upper end; infinite where there is none.
    pub(super) ends: [f64; 2],
    /// Which of the ends are walls that the search met; the others are bounds that were stated.
    pub(super) is_wall: [bool; 2],
}

impl Range {
    /// The bounds that were stated.
    pub(super) fn stated(own: &Parameter) -> Self {
        Self {
            ends: own.limits().unwrap_or([f64::NEG_INFINITY, f64::INFINITY]),
            is_wall: [false; 2],
        }
    }

    /// The end that a place is at: 0 the lower one, 1 the upper one.
    pub(super) fn end_at(&self, x: f64) -> Option<usize> {
        let [low, high] = self.ends;
        if x <= low + AT_END {
            Some(0)
        } else if x >= high - AT_END {
            Some(1)
        } else {
            None
        }
    }
}

impl Problem<'_> {
    /// The ranges of the parameters as a search that ended within some of them finds them: with the walls next to it, and without those that
    /// are none any more.
    pub(super) fn ranges_beside(
        &self,
        (at, here): (&[f64], &[f64]),
        within: &[Range],
    ) -> Vec<Range> {
        let beside = |(place, (own, known)): (usize, (&Parameter, &Range))| {
            let stated = Range::stated(own);
            let mut range = stated;
            for (end, direction) in [-1.0, 1.0].into_iter().enumerate() {
                let room = (direction * (stated.ends[end] - at[place])).min(DIFFERENCE);
                let is_accepted = |by: f64| {
                    let mut moved = at.to_vec();
                    moved[place] += direction * by;
                    self.beside(&moved, here).is_some()
                };
                if room <= AT_END || is_accepted(room) {
                    continue;
                }
                let is_known = known.is_wall[end] && known.end_at(at[place]) == Some(end);
                range.is_wall[end] = true;
                range.ends[end] = if is_known {
                    known.ends[end]
                } else {
                    at[place] + direction * furthest(room, is_accepted)
                };
            }
            range
        };
        let all = self.parameters().iter().zip(within).enumerate();
        all.map(beside).collect()
    }
}

/// The furthest that is accepted of a way whose end is not.
fn furthest(way: f64, is_accepted: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, way);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_accepted(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
