//! The mode in which a solid cylinder breathes that is held along its axis: u = J₁(β r/R), with the root β of its free rim.

/// Roots of the modes of cylinders lie apart by more than this \[-\].
const STEP: f64 = 0.1;

/// The first mode.
pub(crate) struct Breathing {
    /// β = ω R/c, with the speed of compression waves c \[-\].
    pub(crate) root: f64,
}

impl Breathing {
    /// That of elastic material with Poisson's ratio ν: no stress at the rim, β J₀(β) = (1 − 2ν)/(1 − ν) J₁(β).
    pub(crate) fn of(poisson: f64) -> Self {
        let ratio = (1.0 - 2.0 * poisson) / (1.0 - poisson);
        let stress = |x: f64| x * bessel(0, x) - ratio * bessel(1, x);
        let mut lower = STEP;
        while stress(lower) * stress(lower + STEP) > 0.0 {
            lower += STEP;
        }
        let mut upper = lower + STEP;
        for _ in 0..60 {
            let middle = 0.5 * (lower + upper);
            if stress(lower) * stress(middle) > 0.0 {
                lower = middle;
            } else {
                upper = middle;
            }
        }
        Self { root: lower }
    }

    /// Radial displacement at a share of the radius \[-\].
    pub(crate) fn shape(&self, share: f64) -> f64 {
        bessel(1, self.root * share)
    }
}

/// The Bessel function of the first kind by its series, for orders 0 and 1 and small x.
fn bessel(order: i32, x: f64) -> f64 {
    let half = 0.5 * x;
    let mut term = half.powi(order);
    let mut sum = term;
    for k in 1..40 {
        let k = f64::from(k);
        term *= -half * half / (k * (k + f64::from(order)));
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    // ORACLE: tabulated values, and the first zero of J₀, at which a cylinder with ν = ½ breathes.
    #[test]
    fn functions_and_roots_are_those_of_tables() {
        assert!((bessel(0, 1.0) - 0.765_197_686_557_966_6).abs() < 1e-14);
        assert!((bessel(1, 1.0) - 0.440_050_585_744_933_5).abs() < 1e-14);
        assert!((Breathing::of(0.5).root - 2.404_825_557_695_773).abs() < 1e-12);
    }
}
