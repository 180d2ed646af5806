//! The simplified method of slices on circles (Bishop 1955), without water.
//!
//! F = Σ (c b + W tan φ) / m / Σ W sin α with m = cos α + sin α tan φ / F, over slices of width b and
//! weight W whose base falls by α.

use std::f64::consts::PI;

use super::rotation::Spiral;
use super::search::least;
use crate::limit_equilibrium::section::Section;

/// Slices are left out of the search when a base is steeper than this: m loses its meaning \[-\].
const LEAST_M: f64 = 0.2;

/// The least factor of safety over all circles \[-\].
pub(crate) fn factor_of_safety(section: &Section) -> f64 {
    let [left, right] = section.sides();
    let value = |[from, to, angle]: [f64; 3]| {
        let ends = [from, to].map(|x| [x, section.level(x)]);
        let small = 0.02 * section.height;
        if to - from < small || ends[0][1] - ends[1][1] < small {
            return f64::INFINITY;
        }
        let circle = Spiral::new(ends, angle, 0.0);
        if circle.is_within(section) {
            on_circle(section, &circle)
        } else {
            f64::INFINITY
        }
    };
    least(value, [left, left, 0.05], [right, right, PI]).0
}

/// The factor of safety on one circle \[-\]; infinite where it is not driven.
fn on_circle(section: &Section, circle: &Spiral) -> f64 {
    let slices: Vec<Slice> = circle
        .points
        .windows(2)
        .map(|pair| Slice::new(section, pair))
        .collect();
    let driving: f64 = slices.iter().map(|slice| slice.weight * slice.sin).sum();
    if driving <= 0.0 {
        return f64::INFINITY;
    }
    let mut factor = 1.0;
    for _ in 0..60 {
        let mut resisting = 0.0;
        for slice in &slices {
            let m = slice.cos + slice.sin * slice.tan / factor;
            if m < LEAST_M {
                return f64::INFINITY;
            }
            resisting += (slice.cohesion * slice.width + slice.weight * slice.tan) / m;
        }
        let next = resisting / driving;
        if (next - factor).abs() < 1e-9 {
            return next;
        }
        factor = next;
    }
    factor
}

/// One slice.
struct Slice {
    width: f64,
    weight: f64,
    cohesion: f64,
    tan: f64,
    sin: f64,
    cos: f64,
}

impl Slice {
    fn new(section: &Section, base: &[[f64; 2]]) -> Self {
        let [from, to] = [base[0], base[1]];
        let (width, fall) = (to[0] - from[0], from[1] - to[1]);
        let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
        let layer = section.layer_at(middle);
        let length = width.hypot(fall);
        Self {
            width,
            weight: section.unit_weight * width * (section.level(middle[0]) - middle[1]),
            cohesion: layer.cohesion,
            tan: layer.friction.to_radians().tan(),
            sin: fall / length,
            cos: width / length,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slopes::problems::{acads_1a, acads_1c};

    /// GOAL: one circle. ORACLE: Fredlund and Krahn (1977), case 1, dry: 2.080 by Bishop's method on
    /// the circle about (120 ft, 90 ft) with a radius of 80 ft. Their slices are few: with twenty
    /// this method gives 2.0785, with a thousand 2.0756.
    #[test]
    fn fredlund_and_krahns_circle_has_its_factor() {
        let mut slope = Section::homogeneous("", (2.0, 1.5), (600.0, 20.0), [60.0, 40.0]);
        slope.surface = vec![[0.0, 60.0], [60.0, 60.0], [140.0, 20.0], [180.0, 20.0]];
        slope.unit_weight = 120.0;
        slope.layers[0].polygon = vec![
            [0.0, 0.0],
            [180.0, 0.0],
            [180.0, 20.0],
            [140.0, 20.0],
            [60.0, 60.0],
            [0.0, 60.0],
        ];
        let half = (80.0_f64 * 80.0 - 30.0 * 30.0).sqrt();
        let toe = (80.0_f64 * 80.0 - 70.0 * 70.0).sqrt();
        let ends = [[120.0 - half, 60.0], [120.0 + toe, 20.0]];
        let angle = (half / 80.0).asin() + (toe / 80.0).asin();
        let circle = Spiral::new(ends, angle, 0.0);
        assert!((circle.centre[0] - 120.0).abs() < 1e-9 && (circle.centre[1] - 90.0).abs() < 1e-9);
        let factor = on_circle(&slope, &circle);
        assert!((factor - 2.080).abs() < 0.006, "{factor}");
    }

    /// GOAL: the search over circles, homogeneous and layered. ORACLE: the published results of two
    /// programs for ACADS 1(a), 0.987, and 1(c), 1.405 and 1.414.
    #[test]
    fn the_acads_slopes_have_their_factors() {
        let simple = factor_of_safety(&acads_1a());
        assert!((simple - 0.987).abs() < 0.005, "{simple}");
        let layered = factor_of_safety(&acads_1c());
        assert!((layered - 1.405).abs() < 0.01, "{layered}");
    }
}
