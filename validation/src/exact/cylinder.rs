//! A thick cylinder of incompressible elastic-plastic soil that is expanded from within, at any
//! strain, in plane strain.

/// Terms of the dilogarithm; its argument stays below 0.95.
const TERMS: i32 = 700;

/// A hollow cylinder and its soil.
///
/// Volume is kept: a ring of initial radius R is found at r with r² − R² = a² − a₀² = Δ. Its Hencky
/// strain is ln(r/R) around and −ln(r/R) along the radius, so σ_θ − σ_r = min(4G ln(r/R), 2 s_u), and
/// equilibrium makes the pressure within
///
/// `p = ∫_a^b (σ_θ − σ_r) dr/r = 2 s_u ln(r_p/a) + G [Li₂(Δ/r_p²) − Li₂(Δ/b²)]`
///
/// with `Li₂` the dilogarithm and r_p the radius up to which the soil yields,
/// `Δ/r_p² = 1 − exp(−s_u/G)`, cut off at a and b.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ThickCylinder {
    /// Initial inner radius a₀ \[length\].
    pub(crate) inner: f64,
    /// Initial outer radius b₀ \[length\].
    pub(crate) outer: f64,
    /// Shear modulus G \[force/length²\].
    pub(crate) shear: f64,
    /// Undrained strength s_u \[force/length²\].
    pub(crate) strength: f64,
}

impl ThickCylinder {
    /// Outer radius at the inner radius `a` \[length\].
    pub(crate) fn outer_at(&self, a: f64) -> f64 {
        (self.outer.powi(2) + a.powi(2) - self.inner.powi(2)).sqrt()
    }

    /// Δ/r_p², at most 1 \[-\].
    fn at_yield(&self) -> f64 {
        -(-self.strength / self.shear).exp_m1()
    }

    /// Pressure within at the inner radius `a`, none acting outside \[force/length²\].
    pub(crate) fn pressure(&self, a: f64) -> f64 {
        self.pressure_between(a, self.outer_at(a))
    }

    /// The part of the pressure at `a` that soil beyond the outer radius would add if it went on
    /// without end \[force/length²\].
    pub(crate) fn beyond(&self, a: f64) -> f64 {
        let added = a.powi(2) - self.inner.powi(2);
        let b = self.outer_at(a);
        let edge = (added / self.at_yield()).sqrt().max(b);
        2.0 * self.strength * (edge / b).ln() + self.shear * dilogarithm(added / edge.powi(2))
    }

    /// The pressure that a cavity in soil without end approaches as it is expanded for ever
    /// \[force/length²\].
    pub(crate) fn limit_pressure(&self) -> f64 {
        let share = self.at_yield();
        -self.strength * share.ln() + self.shear * dilogarithm(share)
    }

    fn pressure_between(&self, a: f64, b: f64) -> f64 {
        let added = a.powi(2) - self.inner.powi(2);
        let edge = (added / self.at_yield()).sqrt().clamp(a, b);
        let elastic = |r: f64| dilogarithm(added / r.powi(2));
        2.0 * self.strength * (edge / a).ln() + self.shear * (elastic(edge) - elastic(b))
    }
}

/// The dilogarithm Li₂(x) = Σ x^k/k² for 0 ≤ x ≤ 0.95.
pub(super) fn dilogarithm(x: f64) -> f64 {
    (1..TERMS).rev().map(|k| x.powi(k) / f64::from(k * k)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cylinder(shear: f64) -> ThickCylinder {
        ThickCylinder {
            inner: 1.0,
            outer: 2.0,
            shear,
            strength: 1.0,
        }
    }

    /// ∫_a^b min(4G ln(r/R), 2 s_u) dr/r by the midpoint rule.
    fn by_quadrature(cylinder: &ThickCylinder, a: f64) -> f64 {
        let b = cylinder.outer_at(a);
        let parts = 200_000;
        let width = (b - a) / f64::from(parts);
        let added = a * a - cylinder.inner * cylinder.inner;
        (0..parts)
            .map(|k| {
                let r = a + (f64::from(k) + 0.5) * width;
                let stretch = r / (r * r - added).sqrt();
                let difference = (4.0 * cylinder.shear * stretch.ln()).min(2.0 * cylinder.strength);
                difference / r * width
            })
            .sum()
    }

    #[test]
    fn pressure_by_quadrature() {
        for shear in [3.0, 33.33, 1000.0] {
            for a in [1.0001, 1.01, 1.1, 1.5] {
                let cylinder = cylinder(shear);
                let difference = cylinder.pressure(a) - by_quadrature(&cylinder, a);
                assert!(
                    difference.abs() < 1e-6,
                    "G = {shear}, a = {a}: {difference}"
                );
            }
        }
    }

    /// 2 s_u ln(b/a) when all of it yields.
    #[test]
    fn rigid_plastic_values() {
        let stiff = cylinder(1e4);
        assert!((stiff.pressure(1.1) - 1.246_84).abs() < 5e-6);
        assert!((stiff.pressure(1.5) - 0.847_30).abs() < 5e-6);
    }

    /// p = s_u [1 + ln(G/s_u)] when strains are small (Gibson and Anderson 1961), and the known
    /// values with finite strain.
    #[test]
    fn limit_in_soil_without_end() {
        assert!((cylinder(33.333_333).limit_pressure() - 4.514_04).abs() < 2e-5);
        assert!((cylinder(100.0).limit_pressure() - 5.607_67).abs() < 2e-5);
        let stiff = cylinder(1e6);
        assert!((stiff.limit_pressure() - (1.0 + 1e6_f64.ln())).abs() < 1e-5);
        let wide = ThickCylinder {
            outer: 10.0,
            ..cylinder(33.333_333)
        };
        let far = wide.pressure(60.0) + wide.beyond(60.0);
        assert!((far - wide.limit_pressure()).abs() < 1e-3, "{far}");
    }
}
