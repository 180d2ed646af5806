//! Circles through undrained soil whose strength goes with direction (Lo 1965): upper bounds by theory, eqs. 123a and 123b.
//!
//! Soil above a slip line that falls by δ moves along it and keeps its volume. Its strain is pure shear, so that the major
//! compression stands at 45° to the line and at α = |45° − δ| to the vertical: active where δ = 45°, simple shear where the line is
//! level or upright, passive where it rises by 45°. A slip of one dissipates the support of the ellipse of strengths if soil flows normal to it,
//! and its radius if it flows along the stress. The first is never less, and bounds every flow: no admissible stress does
//! more work on the mechanism.

use crate::limit_equilibrium::section::Section;

/// Strengths of simple shear and passive loading, over the active one \[-\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shares {
    pub(crate) simple_shear: f64,
    pub(crate) passive: f64,
}

impl Shares {
    /// One strength in all directions.
    #[cfg(test)]
    pub(crate) const ALIKE: Self = Self {
        simple_shear: 1.0,
        passive: 1.0,
    };

    /// Centre and half axes of the ellipse, over the active strength \[-\].
    fn ellipse(self) -> [f64; 3] {
        let level = 0.5 * (1.0 + self.passive);
        let shear = self.simple_shear * level / self.passive.sqrt();
        [0.5 * (1.0 - self.passive), level, shear]
    }

    /// The most work that an admissible stress does on a slip of one along a line that falls by an angle \[rad\], over the
    /// active strength \[-\]: the support of the ellipse.
    pub(crate) fn support(self, fall: f64) -> f64 {
        let [centre, level, shear] = self.ellipse();
        let (sin, cos) = (2.0 * fall).sin_cos();
        centre * sin + (level * sin).hypot(shear * cos)
    }

    /// The strength of that direction, over the active one \[-\]: the radius of the ellipse, the greater root of its equation.
    pub(crate) fn radius(self, fall: f64) -> f64 {
        let [centre, level, shear] = self.ellipse();
        let (sin, cos) = (2.0 * fall).sin_cos();
        let square = (sin / level).powi(2) + (cos / shear).powi(2);
        let half = sin * centre / (level * level);
        let rest = 1.0 - (centre / level).powi(2);
        (half + (half * half + square * rest).sqrt()) / square
    }
}

/// Bounds by circles on the factor of safety of a slope.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circles {
    /// The least upper bound, whatever the flow \[-\].
    pub(crate) bound: f64,
    /// The least where the strength of the direction is dissipated, as by slices \[-\].
    pub(crate) along_stress: f64,
}

/// The weakest circles of a slope whose layer has the active strength as its cohesion.
pub(crate) fn circles(section: &Section, shares: Shares) -> Circles {
    let least = |work: &dyn Fn(f64) -> f64| super::rotation::least_circle(section, work);
    Circles {
        bound: least(&|fall| shares.support(fall)),
        along_stress: least(&|fall| shares.radius(fall)),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    use super::*;

    const SHARES: [Shares; 3] = [
        Shares {
            simple_shear: 0.75,
            passive: 0.5,
        },
        Shares {
            simple_shear: 1.5,
            passive: 2.0,
        },
        Shares {
            simple_shear: 0.6,
            passive: 0.9,
        },
    ];

    fn number(angle: f64, depth: f64, shares: Shares) -> f64 {
        let run = angle.to_radians().tan().recip().max(1e-3);
        let margins = [12.0 + 14.0 * depth, 12.0 + 14.0 * depth];
        let slope = Section::homogeneous("", (run, depth), (1.0, 0.0), margins);
        200.0 * circles(&slope, shares).bound
    }

    /// GOAL: one strength in all directions has the stability numbers γH/c_u of circles. ORACLE: Taylor (1937), c/(γH) = 0.261 at 90°,
    /// 0.219 at 75° and 0.191 at 60° by circles through the toe, where the section ends; 0.181 at 45° above a base far below. BAND: his three digits.
    #[test]
    fn one_strength_has_taylors_numbers() {
        for (angle, depth, taylor) in [
            (90.0, 1.0, 0.261),
            (75.0, 1.0, 0.219),
            (60.0, 1.0, 0.191),
            (45.0, 6.0, 0.181),
        ] {
            let found = number(angle, depth, Shares::ALIKE).recip();
            println!("{angle}: {found:.4}");
            assert!((found - taylor).abs() < 1.1e-3, "{angle}: {found}");
        }
    }

    /// GOAL: the three strengths stand where the module says. ORACLE: eq. 121 passes through them; the support is that of the
    /// farthest point of the ellipse, over ten thousand points.
    #[test]
    fn lines_of_slip_have_their_strengths() {
        for shares in SHARES {
            for (fall, strength) in [
                (FRAC_PI_4, 1.0),
                (0.0, shares.simple_shear),
                (FRAC_PI_2, shares.simple_shear),
                (-FRAC_PI_4, shares.passive),
            ] {
                assert!((shares.radius(fall) - strength).abs() < 1e-12, "{shares:?}");
            }
            let [centre, level, shear] = shares.ellipse();
            for k in 0..40 {
                let fall = 0.08 * f64::from(k) - 1.6;
                let (sin, cos) = (2.0 * fall).sin_cos();
                let farthest = (0..10_000)
                    .map(|k| {
                        let (up, along) = (f64::from(k) * std::f64::consts::TAU / 1e4).sin_cos();
                        (centre + level * along) * sin + shear * up * cos
                    })
                    .fold(f64::NEG_INFINITY, f64::max);
                let support = shares.support(fall);
                assert!((support - farthest).abs() < 1e-6, "{shares:?} {fall}");
                assert!(support >= shares.radius(fall) - 1e-12, "{shares:?} {fall}");
            }
        }
    }

    /// GOAL: circles follow the strengths. ORACLE: all three times two are twice the number; a weaker passive and simple shear are
    /// less than one strength and more than the weakest.
    #[test]
    fn weaker_directions_make_weaker_slopes() {
        let alike = number(45.0, 1.5, Shares::ALIKE);
        let weaker = number(45.0, 1.5, SHARES[0]);
        let stronger = number(45.0, 1.5, SHARES[1]);
        assert!(
            0.5 * alike < weaker && weaker < alike && alike < stronger && stronger < 2.0 * alike
        );
    }
}
