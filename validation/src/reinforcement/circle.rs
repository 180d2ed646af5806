//! The upper bound by a block that turns on a circle through nails: their forces where the circle
//! crosses them work against the weight.

use crate::limit_equilibrium::search::least;

/// Chords that a circle is divided into.
const PARTS: usize = 180;

/// A nail.
pub(super) struct Nail {
    pub(super) head: [f64; 2],
    pub(super) end: [f64; 2],
    /// Tension at most, of the nail and of its head \[kN/m\].
    pub(super) capacity: f64,
    pub(super) plate: f64,
    /// Bond per length \[kN/m²\].
    pub(super) bond: f64,
}

/// A vertical cut in undrained soil on rock at the level of its toe.
pub(super) struct Cut {
    /// Place of its face, and height \[m\].
    pub(super) face: f64,
    pub(super) height: f64,
    /// Unit weight \[kN/m³\] and undrained strength \[kPa\].
    pub(super) unit_weight: f64,
    pub(super) strength: f64,
    pub(super) nails: Vec<Nail>,
}

impl Cut {
    /// The least factor on the strength of the soil at which any block that turns on a circle, from the
    /// surface to the face, is in equilibrium; the nails keep their forces.
    pub(super) fn upper_bound(&self) -> f64 {
        let upper = [self.face - 1e-3, 0.9 * self.height, 3.0];
        least(|of| self.factor(of), [0.0, 0.0, 0.02], upper).0
    }

    /// That of the circle from a place on the surface to a level of the face over an angle \[rad\].
    fn factor(&self, [from, level, angle]: [f64; 3]) -> f64 {
        let (a, b) = ([from, self.height], [self.face, level]);
        let (sin, cos) = angle.sin_cos();
        // The arm z from centre to a turns into that to b: b − a = z (exp(i angle) − 1).
        let (re, im) = (cos - 1.0, sin);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let square = re * re + im * im;
        let arm = [(dx * re + dy * im) / square, (dy * re - dx * im) / square];
        let centre = [a[0] - arm[0], a[1] - arm[1]];
        let points: Vec<[f64; 2]> = (0..=PARTS)
            .map(|k| {
                let (sin, cos) = (angle * k as f64 / PARTS as f64).sin_cos();
                [
                    centre[0] + arm[0] * cos - arm[1] * sin,
                    centre[1] + arm[1] * cos + arm[0] * sin,
                ]
            })
            .collect();
        let inside = |x: &[f64; 2]| {
            x[0] >= 0.0 && x[0] <= self.face + 1e-9 && x[1] >= -1e-9 && x[1] <= self.height + 1e-9
        };
        if !points.iter().all(inside) || points.windows(2).any(|pair| pair[1][0] < pair[0][0]) {
            return f64::INFINITY;
        }
        let mut outline = points.clone();
        outline.push([self.face, self.height]);
        let mut moment = 0.0;
        for (k, p) in outline.iter().enumerate() {
            let q = outline[(k + 1) % outline.len()];
            let (px, qx) = (p[0] - centre[0], q[0] - centre[0]);
            moment += (px * q[1] - qx * p[1]) * (px + qx) / 6.0;
        }
        let drive = -self.unit_weight * moment;
        let pull: f64 = self
            .nails
            .iter()
            .map(|nail| nail.power(&points, centre))
            .sum();
        let soil = self.strength * (arm[0] * arm[0] + arm[1] * arm[1]) * angle;
        if drive - pull <= 0.0 {
            f64::INFINITY
        } else {
            soil / (drive - pull)
        }
    }
}

impl Nail {
    /// The power that it takes when the block beyond the slip line turns about a centre at rate one \[kN m/m\].
    fn power(&self, line: &[[f64; 2]], centre: [f64; 2]) -> f64 {
        let along = [0, 1].map(|axis| self.end[axis] - self.head[axis]);
        let length = along[0].hypot(along[1]);
        let t = along.map(|x| x / length);
        // How far along it and beside it a point is.
        let seen = |x: &[f64; 2]| {
            let d = [x[0] - self.head[0], x[1] - self.head[1]];
            [d[0] * t[0] + d[1] * t[1], d[1] * t[0] - d[0] * t[1]]
        };
        for pair in line.windows(2) {
            let (p, q) = (seen(&pair[0]), seen(&pair[1]));
            if p[1] * q[1] >= 0.0 {
                continue;
            }
            let share = p[1] / (p[1] - q[1]);
            let at = p[0] + share * (q[0] - p[0]);
            if !(0.0..=length).contains(&at) {
                continue;
            }
            let x = [0, 1].map(|axis| pair[0][axis] + share * (pair[1][axis] - pair[0][axis]));
            let velocity = [-(x[1] - centre[1]), x[0] - centre[0]];
            let rate = -(velocity[0] * t[0] + velocity[1] * t[1]);
            let limit = self.capacity.min(self.plate + self.bond * at);
            return limit.min(self.bond * (length - at)) * rate.max(0.0);
        }
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: without nails the circle through the toe of a vertical cut. ORACLE: 3.83 (Fellenius 1927).
    #[test]
    fn the_vertical_cut_has_its_number() {
        let cut = Cut {
            face: 10.0,
            height: 5.0,
            unit_weight: 20.0,
            strength: 100.0 / 3.83,
            nails: Vec::new(),
        };
        let factor = cut.upper_bound();
        assert!((factor - 1.0).abs() < 4e-3, "{factor}");
    }
}
