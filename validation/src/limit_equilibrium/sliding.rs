//! The upper bound by three blocks that slide along a thin layer of undrained soil: down with it,
//! level, and up again.
//!
//! Velocities are parallel to the slip line and to the joints between blocks, since undrained soil
//! keeps its volume. F is dissipation over the power of the weight.

use igimp_geometry::polygon::area_and_centroid;

use super::search::least;
use crate::limit_equilibrium::section::Section;

/// Parts over which the strength along a line is summed.
const PARTS: usize = 100;

/// The least upper bound over slip lines between two edges of the layer, and over joints from the
/// bends of the slip line to the surface \[-\].
///
/// The edges run from the crest to the ground before the toe; their two bends are those of the slip
/// line.
pub(crate) fn upper_bound(section: &Section, edges: [[[f64; 2]; 4]; 2]) -> f64 {
    let [left, right] = section.sides();
    let value = |[share, first, second]: [f64; 3]| {
        let slip = std::array::from_fn(|k| {
            std::array::from_fn(|axis| {
                edges[0][k][axis] + share * (edges[1][k][axis] - edges[0][k][axis])
            })
        });
        factor(
            section,
            &slip,
            [first, second].map(|x| [x, section.level(x)]),
        )
    };
    least(value, [0.0, left, left], [1.0, right, right]).0
}

/// The factor for one slip line and the upper ends of its joints; infinite where blocks do not move.
fn factor(section: &Section, slip: &[[f64; 2]; 4], tops: [[f64; 2]; 2]) -> f64 {
    if tops[0][0] <= slip[0][0] || tops[1][0] <= tops[0][0] || slip[3][0] <= tops[1][0] {
        return f64::INFINITY;
    }
    let ends = [slip[0], tops[0], tops[1], slip[3]];
    let (mut velocity, mut last) = (1.0, [0.0; 2]);
    let (mut power, mut dissipation) = (0.0, 0.0);
    for k in 0..3 {
        let along = direction(slip[k], slip[k + 1]);
        if k > 0 {
            // No gap opens at the joint.
            let joint = direction(slip[k], tops[k - 1]);
            let normal = [joint[1], -joint[0]];
            velocity = dot(last, normal) / dot(along, normal);
            let jump = [0, 1].map(|axis| last[axis] - velocity * along[axis]);
            dissipation += strength(section, slip[k], tops[k - 1]) * dot(jump, joint).abs();
        }
        if velocity <= 0.0 {
            return f64::INFINITY;
        }
        last = along.map(|component| velocity * component);
        dissipation += strength(section, slip[k], slip[k + 1]) * velocity;
        let mut block = vec![slip[k + 1], slip[k], ends[k]];
        let between = |p: &&[f64; 2]| ends[k][0] < p[0] && p[0] < ends[k + 1][0];
        block.extend(section.surface.iter().filter(between));
        block.push(ends[k + 1]);
        power -= section.unit_weight * area_and_centroid(&block).0.abs() * last[1];
    }
    if power > 0.0 {
        dissipation / power
    } else {
        f64::INFINITY
    }
}

/// ∫ c ds along a straight line \[kN/m\].
fn strength(section: &Section, from: [f64; 2], to: [f64; 2]) -> f64 {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    let parts = (0..PARTS).map(|k| {
        let t = (k as f64 + 0.5) / PARTS as f64;
        let at = [0, 1].map(|axis| from[axis] + t * (to[axis] - from[axis]));
        section.layer_at(at).cohesion
    });
    parts.sum::<f64>() * length / PARTS as f64
}

fn direction(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    let length = (to[0] - from[0]).hypot(to[1] - from[1]);
    [(to[0] - from[0]) / length, (to[1] - from[1]) / length]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slopes::problems::{weak_layer, weak_layer_edges};

    /// GOAL: a weightless joint-free slide. ORACLE: where joints are as weak as the slip line and
    /// the slip line is straight, F = c L / (W sin β).
    #[test]
    fn a_straight_slide_has_its_closed_form() {
        let slope = Section::homogeneous("", (1.0, 1.0), (20.0, 0.0), [10.0, 0.0]);
        let slip = [[0.0, 10.0], [5.0, 7.5], [15.0, 2.5], [20.0, 0.0]];
        let found = factor(&slope, &slip, [[8.0, 10.0], [16.0, 4.0]]);
        let (length, area) = (20.0_f64.hypot(10.0), 50.0);
        let expected = 20.0 * length / (20.0 * area * (10.0 / length));
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }

    /// GOAL: the slide along the weak layer of Griffiths and Lane (1999), example 3, at a strength
    /// ratio of 0.2. ORACLE: an upper bound lies above 0.60 by finite elements, read off their figure
    /// 7 to 0.05, and above 0.45 to 0.50 by Janbu's method, which has no strength in the joints.
    #[test]
    fn the_weak_layer_carries_the_slide() {
        let found = upper_bound(&weak_layer(0.2), weak_layer_edges());
        assert!(0.55 < found && found < 0.70, "{found}");
    }
}
