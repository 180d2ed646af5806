//! A thick sphere of incompressible elastic-plastic soil that is expanded from within, at any strain.

use super::cylinder::dilogarithm;

/// A hollow sphere and its soil.
///
/// Volume is kept: a shell of initial radius R is found at r with r³ − R³ = a³ − a₀³ = Δ. Its Hencky strain is
/// ln(r/R) around and twice that, shortening, along the radius, so σ_θ − σ_r = min(6G ln(r/R), 2 s_u) for Tresca and
/// von Mises alike, and equilibrium makes the pressure within
///
/// `p = ∫_a^b 2 (σ_θ − σ_r) dr/r = 4 s_u ln(r_p/a) + 4/3 G [Li₂(Δ/r_p³) − Li₂(Δ/b³)]`
///
/// with `Li₂` the dilogarithm and r_p the radius up to which the soil yields, `Δ/r_p³ = 1 − exp(−s_u/G)`, cut off at
/// a and b.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ThickSphere {
    /// Initial inner radius a₀ \[length\].
    pub(crate) inner: f64,
    /// Initial outer radius b₀ \[length\].
    pub(crate) outer: f64,
    /// Shear modulus G \[force/length²\].
    pub(crate) shear: f64,
    /// Undrained strength s_u, half the strength in triaxial compression \[force/length²\].
    pub(crate) strength: f64,
}

impl ThickSphere {
    /// Outer radius at the inner radius `a` \[length\].
    pub(crate) fn outer_at(&self, a: f64) -> f64 {
        (self.outer.powi(3) + a.powi(3) - self.inner.powi(3)).cbrt()
    }

    /// Pressure within at the inner radius `a`, none acting outside \[force/length²\].
    pub(crate) fn pressure(&self, a: f64) -> f64 {
        let added = a.powi(3) - self.inner.powi(3);
        let front = self.yields_to(a);
        let elastic = |r: f64| dilogarithm(added / r.powi(3));
        4.0 * self.strength * (front / a).ln()
            + 4.0 / 3.0 * self.shear * (elastic(front) - elastic(self.outer_at(a)))
    }

    /// Radius up to which it yields at the inner radius `a`, at most the outer one \[length\].
    pub(crate) fn yields_to(&self, a: f64) -> f64 {
        let added = a.powi(3) - self.inner.powi(3);
        // Δ/r_p³
        let at_yield = -(-self.strength / self.shear).exp_m1();
        (added / at_yield).cbrt().clamp(a, self.outer_at(a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere(outer: f64, shear: f64) -> ThickSphere {
        ThickSphere {
            inner: 1.0,
            outer,
            shear,
            strength: 1.0,
        }
    }

    /// Against direct integration elsewhere, to the digits kept.
    #[test]
    fn known_values() {
        let thick = sphere(2.0, 100.0);
        let known = [
            (1.001, 0.349_46),
            (1.005, 1.613_10),
            (1.01, 2.271_40),
            (1.02, 2.658_73),
            (1.05, 2.603_44),
            (1.1, 2.445_40),
            (1.5, 1.497_34),
        ];
        for (a, expected) in known {
            let found = thick.pressure(a);
            assert!((found - expected).abs() < 2e-5, "{a}: {found}");
        }
    }
}
