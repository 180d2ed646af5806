//! A cantilever under a dead load across its end, bent as far as it will.

use std::f64::consts::FRAC_PI_2;

/// Steps of the integration along the beam.
const STEPS: usize = 2000;

/// A cantilever in units of its length L and its bending stiffness EI.
///
/// The section at s turns by θ and moves by `r' = (1 + N/EA) t + (V/κGA) n`, with the force P within
/// it split into N = P sin θ along the beam and V = P cos θ across (Reissner 1972). Balance of
/// moments is `EI θ'' = −P x'`, with θ = 0 where it is clamped and θ' = 0 at its end. Without
/// extension and shear it is the elastica.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cantilever {
    /// P L²/EI \[-\].
    pub(crate) load: f64,
    /// EI/(EA L²), 0 for a beam that does not stretch \[-\].
    pub(crate) extension: f64,
    /// EI/(κGA L²), 0 for a beam that does not shear \[-\].
    pub(crate) shear: f64,
}

impl Cantilever {
    /// Deflection of the end in the direction of the load, and its approach to the wall, over L \[-\].
    pub(crate) fn end(&self) -> [f64; 2] {
        let (mut low, mut high) = (0.0, self.load * FRAC_PI_2);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if self.shoot(middle)[1] > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let [_, _, x, w] = self.shoot(0.5 * (low + high));
        [w, 1.0 - x]
    }

    /// θ, θ', x and w at the end for a curvature where it is clamped, by Runge and Kutta.
    fn shoot(&self, curvature: f64) -> [f64; 4] {
        let width = 1.0 / STEPS as f64;
        let mut y = [0.0, curvature, 0.0, 0.0];
        for _ in 0..STEPS {
            let add = |y: &[f64; 4], share: f64, slope: &[f64; 4]| {
                std::array::from_fn(|k| y[k] + share * width * slope[k])
            };
            let k1 = self.slope(&y);
            let k2 = self.slope(&add(&y, 0.5, &k1));
            let k3 = self.slope(&add(&y, 0.5, &k2));
            let k4 = self.slope(&add(&y, 1.0, &k3));
            for k in 0..4 {
                y[k] += width / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]);
            }
        }
        y
    }

    fn slope(&self, [theta, curvature, ..]: &[f64; 4]) -> [f64; 4] {
        let (sine, cosine) = theta.sin_cos();
        let stretch = 1.0 + self.load * self.extension * sine;
        let shear = self.load * self.shear * cosine;
        let x = stretch * cosine - shear * sine;
        let w = stretch * sine + shear * cosine;
        [*curvature, -self.load * x, x, w]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(load: f64) -> [f64; 2] {
        Cantilever {
            load,
            extension: 0.0,
            shear: 0.0,
        }
        .end()
    }

    /// Elliptic integrals, as tabulated by Mattiasson (1981), table 1.
    #[test]
    fn elastica_by_elliptic_integrals() {
        let table = [
            (1.0, 0.301_72, 0.056_43),
            (2.0, 0.493_46, 0.160_64),
            (5.0, 0.713_79, 0.387_63),
            (10.0, 0.810_61, 0.555_00),
        ];
        for (load, deflection, approach) in table {
            let [w, u] = end(load);
            assert!((w - deflection).abs() < 6e-6, "{load}: {w}");
            assert!((u - approach).abs() < 6e-6, "{load}: {u}");
        }
    }

    /// P L³/(3 EI) + P L/(κGA) while it hardly bends.
    #[test]
    fn small_deflection_with_shear() {
        let load = 1e-4;
        let [w, _] = Cantilever {
            load,
            extension: 1.0 / 1200.0,
            shear: 2e-3,
        }
        .end();
        assert!((w / load - (1.0 / 3.0 + 2e-3)).abs() < 1e-8);
    }
}
