//! Corners of rigid bodies that are narrower than two cells: soil on both sides of them shares nodes of the grid.

use igimp_geometry::polygon::area_and_centroid;
use igimp_schema::diagnostic::Problems;
use igimp_schema::source::Place;
use igimp_schema::text::{number, point};

/// A corner is reported that is narrower than two cells over more than so many of them \[-\].
const LONG: f64 = 1.5;

/// Warns of the narrowest corner of a polygon, in cells of a size \[m\], that meets soil on both of its sides.
pub(super) fn warn(
    (name, place): (&str, Place),
    corners: &[[f64; 2]],
    (cell, meets_soil): (f64, impl Fn(&[f64; 2]) -> bool),
    problems: &mut Problems,
) {
    let narrowest = (0..corners.len())
        .filter(|&k| meets_soil(&corners[k]))
        .map(|k| (corners[k], inner_angle(corners, k)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((corner, angle)) = narrowest else {
        return;
    };
    let over = cell / (0.5 * angle).tan();
    if over <= LONG * cell {
        return;
    }
    problems
        .warning(
            place,
            format!(
                "the rigid body `{name}` is narrower than two cells over {} m behind its corner at {}",
                number(over),
                point(corner)
            ),
        )
        .help(
            "soil on both sides of it shares nodes of the grid there, and sticks together through it: eight cells deep a wedge of 30° \
             carries 70 to 90 % too much, one of 60° 10 to 15 %",
        )
        .help("half of it on a plane of symmetry, smaller cells there, or a blunter body");
}

/// The angle within a polygon at a corner \[rad\].
fn inner_angle(corners: &[[f64; 2]], k: usize) -> f64 {
    let n = corners.len();
    let way = |to: usize| [0, 1].map(|d| corners[to][d] - corners[k][d]);
    let (next, last) = (way((k + 1) % n), way((k + n - 1) % n));
    let turn = area_and_centroid(corners).0.signum();
    let cross = turn * (next[0] * last[1] - next[1] * last[0]);
    let along = next[0] * last[0] + next[1] * last[1];
    cross.atan2(along).rem_euclid(2.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: the angle lies within the body, whichever way round its corners go.
    /// CASE: a square with a notch down to its middle.
    /// ORACLE: right angles below, 45° beside the notch, 270° in it.
    #[test]
    fn angles_lie_within() {
        let mut notched = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 1.0], [0.0, 2.0]];
        let mut expected = [90.0, 90.0, 45.0, 270.0, 45.0];
        for _ in 0..2 {
            for (k, known) in expected.iter().enumerate() {
                let angle = inner_angle(&notched, k).to_degrees();
                assert!((angle - known).abs() < 1e-9, "{angle} for {known}");
            }
            notched.reverse();
            expected.reverse();
        }
    }
}
