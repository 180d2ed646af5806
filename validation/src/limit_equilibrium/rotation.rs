//! The upper bound by a block that turns on a logarithmic spiral (Chen 1975, chapter 9).
//!
//! The radius grows by r = r₀ exp(θ tan φ_F) from the crest to the toe, with tan φ_F = tan φ / F. The
//! power of the weight is −γ ∫ (x − x_c) dA and the dissipation ∫ (c/F) r² dθ, both for a rotation
//! of rate one; F is where they are equal. In undrained soil the spiral is a circle, and c may change
//! along it. A pseudo-static force of k times the weight adds the power k γ ∫ (y_c − y) dA (Chang, Chen and Yao 1984).

use std::f64::consts::PI;

use super::search::least;
use crate::limit_equilibrium::section::Section;

/// Parts that a slip line is divided into.
const PARTS: usize = 60;
/// Factors between which an equilibrium is looked for \[-\].
const FACTORS: [f64; 2] = [0.05, 20.0];

/// A spiral from a point on the surface to another one.
pub(super) struct Spiral {
    /// The centre of rotation.
    pub(super) centre: [f64; 2],
    /// Points from the crest to the toe, equal angles apart.
    pub(super) points: Vec<[f64; 2]>,
    /// The angle between neighbouring points \[rad\].
    pub(super) step: f64,
}

impl Spiral {
    /// The spiral from `a` to `b` over an angle \[rad\] whose radius grows with `growth` = tan φ_F.
    pub(super) fn new([a, b]: [[f64; 2]; 2], angle: f64, growth: f64) -> Self {
        // In complex numbers: b − a = z (exp((growth + i) angle) − 1), with z from the centre to a.
        let (radius, turn) = ((growth * angle).exp(), angle.sin_cos());
        let (re, im) = (radius * turn.1 - 1.0, radius * turn.0);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let square = re * re + im * im;
        let z = [(dx * re + dy * im) / square, (dy * re - dx * im) / square];
        let centre = [a[0] - z[0], a[1] - z[1]];
        let step = angle / PARTS as f64;
        let (radius, (sin, cos)) = ((growth * step).exp(), step.sin_cos());
        let (re, im) = (radius * cos, radius * sin);
        let mut arm = z;
        let mut points = Vec::with_capacity(PARTS + 1);
        for _ in 0..=PARTS {
            points.push([centre[0] + arm[0], centre[1] + arm[1]]);
            arm = [arm[0] * re - arm[1] * im, arm[1] * re + arm[0] * im];
        }
        Self {
            centre,
            points,
            step,
        }
    }

    /// Whether the slip line runs through soil, from left to right.
    pub(super) fn is_within(&self, section: &Section) -> bool {
        let slack = 1e-9 * section.height;
        let inner = &self.points[1..PARTS];
        let [left, right] = section.sides();
        self.points.windows(2).all(|pair| pair[0][0] < pair[1][0])
            && inner.iter().all(|&[x, y]| {
                left <= x
                    && x <= right
                    && section.base - slack <= y
                    && y <= section.level(x) + slack
            })
    }

    /// ∫ (x − x_c + k (y − y_c)) dA over the block between slip line and surface \[m³/m\]; negative where its
    /// weight and the pseudo-static force drive it.
    fn area_moment(&self, section: &Section) -> f64 {
        let [from, to] = [self.points[0][0], self.points[PARTS][0]];
        let surface = section.surface.iter().rev();
        let above = surface.filter(|p| from < p[0] && p[0] < to);
        let mut outline = self.points.clone();
        outline.extend(above);
        let mut moment = 0.0;
        for (k, p) in outline.iter().enumerate() {
            let q = outline[(k + 1) % outline.len()];
            let (px, qx) = (p[0] - self.centre[0], q[0] - self.centre[0]);
            let (py, qy) = (p[1] - self.centre[1], q[1] - self.centre[1]);
            let arms = px + qx + section.horizontal * (py + qy);
            moment += (px * qy - qx * py) * arms / 6.0;
        }
        moment
    }

    /// ∫ c r² dθ \[kN m/m\], with c times what `work` makes of the angle by which the slip line falls \[rad\].
    fn dissipation(&self, section: &Section, work: impl Fn(f64) -> f64) -> f64 {
        let uniform = section.layers.len() == 1;
        let parts = self.points.windows(2).map(|pair| {
            let middle = [0, 1].map(|axis| 0.5 * (pair[0][axis] + pair[1][axis]));
            let layer = if uniform {
                &section.layers[0]
            } else {
                section.layer_at(middle)
            };
            let square =
                (middle[0] - self.centre[0]).powi(2) + (middle[1] - self.centre[1]).powi(2);
            let fall = (pair[0][1] - pair[1][1]).atan2(pair[1][0] - pair[0][0]);
            layer.cohesion * work(fall) * square * self.step
        });
        parts.sum()
    }
}

/// The least upper bound on the factor of safety over all blocks that turn \[-\].
///
/// # Panics
/// If layers have different friction: no spiral fits them.
pub(crate) fn upper_bound(section: &Section) -> f64 {
    let friction = section.layers[0].friction;
    assert!(
        section
            .layers
            .iter()
            .all(|layer| (layer.friction - friction).abs() < 1e-9),
        "a spiral needs one angle of friction"
    );
    let [left, right] = section.sides();
    let tan = friction.to_radians().tan();
    let value = |[from, to, angle]: [f64; 3]| factor(section, tan, [from, to], angle);
    least(value, [left, left, 0.05], [right, right, PI]).0
}

/// The least factor over all circles through undrained soil whose slip lines dissipate c times what `work` makes of the angle by
/// which they fall \[rad\].
pub(super) fn least_circle(section: &Section, work: &dyn Fn(f64) -> f64) -> f64 {
    let [left, right] = section.sides();
    let value = |[from, to, angle]: [f64; 3]| {
        ends(section, [from, to]).map_or(f64::INFINITY, |ends| circular(section, ends, angle, work))
    };
    least(value, [left, left, 0.05], [right, right, PI]).0
}

/// Where a slip line meets the surface; none where it is hardly a line, or does not fall.
fn ends(section: &Section, [from, to]: [f64; 2]) -> Option<[[f64; 2]; 2]> {
    let ends = [from, to].map(|x| [x, section.level(x)]);
    let small = 0.02 * section.height;
    (to - from >= small && ends[0][1] - ends[1][1] >= small).then_some(ends)
}

/// The factor of one circle, which does not change with it: the resistance is in proportion to 1/F. Infinite where it is not driven.
fn circular(section: &Section, ends: [[f64; 2]; 2], angle: f64, work: impl Fn(f64) -> f64) -> f64 {
    let circle = Spiral::new(ends, angle, 0.0);
    let drive = -section.unit_weight * circle.area_moment(section);
    if drive <= 0.0 || !circle.is_within(section) {
        f64::INFINITY
    } else {
        circle.dissipation(section, work) / drive
    }
}

/// The factor at which a block from x to x is in equilibrium; infinite where there is none.
fn factor(section: &Section, tan: f64, from_to: [f64; 2], angle: f64) -> f64 {
    let Some(ends) = ends(section, from_to) else {
        return f64::INFINITY;
    };
    let same = |_fall: f64| 1.0;
    let surplus = |f: f64| {
        let spiral = Spiral::new(ends, angle, tan / f);
        spiral.dissipation(section, same) / f + section.unit_weight * spiral.area_moment(section)
    };
    let [mut low, mut high] = FACTORS;
    if tan == 0.0 {
        return circular(section, ends, angle, same);
    }
    if surplus(high) > 0.0 {
        return f64::INFINITY;
    }
    for _ in 0..30 {
        let middle = (low * high).sqrt();
        if surplus(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    if Spiral::new(ends, angle, tan / high).is_within(section) {
        high
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: the stability factors γH/c of Chen (1975), tables 9.1 and 9.2, slip lines through the
    /// toe. ORACLE: 3.83 at 90° and φ = 0; 16.16 (Michalowski 1995 prints 16.18) at 45° and φ = 20°;
    /// 5.51 at 90° and φ = 20°. All are classical; the first is 3.83 in Taylor (1937) too.
    #[test]
    fn chens_stability_factors_are_found() {
        for (run, friction, number) in [(1e-3, 0.0, 3.83), (1.0, 20.0, 16.17), (1e-3, 20.0, 5.51)] {
            let cohesion = 20.0 * 10.0 / number;
            let slope = Section::homogeneous("", (run, 1.0), (cohesion, friction), [15.0, 0.0]);
            let factor = upper_bound(&slope);
            assert!((factor - 1.0).abs() < 4e-3, "{number}: {factor}");
        }
    }

    /// GOAL: a pseudo-static force. ORACLE: Loukidis, Bandini and Salgado (2003), homogeneous 3:1 slope of 25 m with
    /// c = 25 kPa, φ = 30°, γ = 20 kN/m³: Spencer's method on logarithmic spirals gives F = 1.000 at k_c = 0.432.
    #[test]
    fn the_critical_acceleration_of_loukidis_is_found() {
        let mut slope = Section::cut("", [25.0, 3.0, 25.0], 20.0, (25.0, 30.0), [75.0, 50.0]);
        slope.horizontal = 0.432;
        let factor = upper_bound(&slope);
        assert!((factor - 1.0).abs() < 3e-3, "{factor}");
    }

    /// GOAL: undrained circles. ORACLE: Taylor's (1937) number for 26.57°, D = 2, as Griffiths and
    /// Lane (1999) quote it: F = 1.47 for c/(γH) = 0.25.
    #[test]
    fn taylors_base_circle_is_found() {
        let slope = Section::homogeneous("", (2.0, 2.0), (50.0, 0.0), [20.0, 20.0]);
        let factor = upper_bound(&slope);
        assert!((factor - 1.47).abs() < 0.01, "{factor}");
    }
}
