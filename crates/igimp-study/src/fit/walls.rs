//! Walls: values beyond which a law or a test is refused, or residuals leap: the sum of squares ends there, and has no derivative.

use super::parameter::{AT_END, Parameter, Range};
use super::problem::{DIFFERENCE, Problem};

/// Halvings of the step that leads across a wall.
const HALVINGS: usize = 30;

impl Problem<'_> {
    /// The ranges of the parameters as a search that ended within some of them finds them: with the walls next to it, and without those that
    /// are none any more.
    pub(super) fn ranges_beside(
        &self,
        (at, here): (&[f64], &[f64]),
        within: &[Range],
    ) -> Vec<Range> {
        let beside = |(place, (parameter, known)): (usize, (&Parameter, &Range))| {
            let stated = Range::stated(parameter);
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
