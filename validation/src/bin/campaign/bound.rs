//! The collapse load of a slope by limit analysis: rigid rotation on a logarithmic spiral through
//! the toe (Chen 1975, Limit Analysis and Soil Plasticity, chapter 9), an upper bound for associated
//! flow and small displacements.

use std::f64::consts::{FRAC_PI_2, PI};

/// Places tried for each end of the spiral in each refinement.
const PLACES: usize = 60;
/// Refinements around the best pair so far.
const REFINEMENTS: usize = 5;

/// γH/c at collapse of a slope of inclination `beta` \[rad\] in soil of friction angle `phi`
/// \[rad\] with a level crest. On a hard base at the level of the toe the spiral stays above it.
pub(crate) fn stability_number(beta: f64, phi: f64, hard_base: bool) -> f64 {
    // The circle of φ = 0 is the limit of spirals.
    let phi = phi.max(1e-4);
    let last = if hard_base { FRAC_PI_2 + phi } else { PI };
    let (mut first_range, mut last_range) = ([0.0, PI], [0.0, last]);
    let mut best = (f64::INFINITY, 0.0, 0.0);
    for _ in 0..REFINEMENTS {
        for i in 0..=PLACES {
            for j in 0..=PLACES {
                let place =
                    |[low, high]: [f64; 2], k: usize| low + (high - low) * k as f64 / PLACES as f64;
                let (first, last) = (place(first_range, i), place(last_range, j));
                let number = of_spiral(beta, phi, first, last);
                if number < best.0 {
                    best = (number, first, last);
                }
            }
        }
        let narrowed = |[low, high]: [f64; 2], about: f64| {
            let half = 2.0 * (high - low) / PLACES as f64;
            [about - half, about + half]
        };
        first_range = narrowed(first_range, best.1);
        last_range = narrowed(last_range, best.2);
        last_range[1] = last_range[1].min(last);
    }
    best.0
}

/// γH/c of one spiral, between the angles of its ends at the crest and at the toe, measured
/// downwards from the horizontal through its pole; infinite for one that makes no mechanism.
fn of_spiral(beta: f64, phi: f64, first: f64, last: f64) -> f64 {
    let t = phi.tan();
    let growth = ((last - first) * t).exp();
    // In units of the radius at the crest.
    let height = growth * last.sin() - first.sin();
    let length = first.cos() - growth * last.cos() - height / beta.tan();
    if last <= first || height <= 0.0 || length <= 0.0 {
        return f64::INFINITY;
    }
    // Moments of the weight: of the whole sector, and of the two triangles that are no soil.
    let sector = ((3.0 * t * last.cos() + last.sin()) * growth.powi(3)
        - 3.0 * t * first.cos()
        - first.sin())
        / (3.0 * (1.0 + 9.0 * t * t));
    let behind = length * (2.0 * first.cos() - length) * first.sin() / 6.0;
    let before = growth
        * ((last - first).sin() - length * last.sin())
        * (first.cos() - length + last.cos() * growth)
        / 6.0;
    let weight = sector - behind - before;
    if weight <= 0.0 {
        return f64::INFINITY;
    }
    height * (growth * growth - 1.0) / (2.0 * t * weight)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: the bound is that of limit analysis.
    /// ORACLE: vertical cut, 3.83 (Fellenius 1927); toe circles in undrained soil, 5.25 at 60° and
    /// 5.86 at 45°; c-φ soil, 10.39 at 60° and 16.18 at 45° with φ = 20° (Chen 1975, table 9.1).
    #[test]
    fn the_bound_is_the_published_one() {
        for (beta, phi, expected) in [
            (90.0, 0.0, 3.83),
            (60.0, 0.0, 5.25),
            (45.0, 0.0, 5.86),
            (60.0, 20.0, 10.39),
            (45.0, 20.0, 16.18),
        ] {
            let number = stability_number(f64::to_radians(beta), f64::to_radians(phi), false);
            assert!(
                (number / expected - 1.0).abs() < 0.004,
                "{beta}, {phi}: {number}"
            );
        }
    }

    /// GOAL: a hard base at the toe can only help.
    /// ORACLE: the circle of a 30° slope goes below its toe.
    #[test]
    fn a_hard_base_carries_more() {
        let beta = f64::to_radians(30.0);
        let deep = stability_number(beta, 0.0, false);
        assert!(stability_number(beta, 0.0, true) > 1.02 * deep);
    }
}
