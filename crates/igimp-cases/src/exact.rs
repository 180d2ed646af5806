//! Exact solutions that the cases are held against.

use igimp_assembly::Particles;

/// A column of Hencky material τ = E ln λ (Poisson's ratio 0) under its own weight, at any strain.
///
/// With s = S (1 − Y/l₀) and S = ρ₀ g l₀ / E, equilibrium of the Kirchhoff stress of the stretch λ
/// gives λ = W(s)/s, W being Lambert's function, and the Cauchy stress −ρ₀ g (l₀ − Y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Initial height l₀ \[length\].
    pub height: f64,
    /// Initial density ρ₀ \[mass/length³\].
    pub density: f64,
    /// Gravity g \[length/time²\], positive downwards.
    pub gravity: f64,
    /// Young's modulus E \[force/length²\].
    pub young: f64,
}

impl Column {
    /// The load number S = ρ₀ g l₀ / E \[-\].
    pub fn load_number(&self) -> f64 {
        self.density * self.gravity * self.height / self.young
    }

    /// Vertical Cauchy stress at initial height `y0` \[force/length²\], tension positive.
    pub fn sigma_yy(&self, y0: f64) -> f64 {
        -self.density * self.gravity * (self.height - y0)
    }

    /// Height in equilibrium of the point that was at `y0` \[length\].
    pub fn position(&self, y0: f64) -> f64 {
        let load = self.load_number();
        let primitive = |w: f64| w + 0.5 * w * w;
        let at = |s: f64| primitive(lambert_w(s));
        self.height * (at(load) - at(load * (1.0 - y0 / self.height))) / load
    }

    /// Mean error of the vertical stress, `Σ|σ_yy − σ_exact| V₀ / (ρ₀ g l₀ ΣV₀)` \[-\], of particles
    /// whose displacements count from the unloaded column.
    pub fn stress_error(&self, particles: &Particles<2>) -> f64 {
        let base = self.density * self.gravity * self.height;
        let (mut sum, mut volume) = (0.0, 0.0);
        for particle in 0..particles.len() {
            let y0 = particles.x[particle][1] - particles.displacement[particle][1];
            let sigma = particles.sigma[particle][1][1];
            sum += (sigma - self.sigma_yy(y0)).abs() * particles.volume0[particle];
            volume += particles.volume0[particle];
        }
        sum / (base * volume)
    }
}

/// The principal branch of Lambert's function, W e^W = x, for x ≥ 0, by Halley's iteration.
pub fn lambert_w(x: f64) -> f64 {
    let mut w = (1.0 + x).ln();
    for _ in 0..20 {
        let e = w.exp();
        let f = w * e - x;
        let step = f / (e * (w + 1.0) - 0.5 * (w + 2.0) * f / (w + 1.0));
        w -= step;
        if step.abs() <= 1e-16 * (1.0 + w.abs()) {
            break;
        }
    }
    w
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lambert_inverts_w_exp_w() {
        for w in [0.0_f64, 1e-9, 0.1, 0.567_143_290_409_783_8, 1.0, 3.0, 10.0] {
            assert!((lambert_w(w * w.exp()) - w).abs() <= 4e-15 * (1.0 + w));
        }
    }

    /// Heights in closed form, to all digits of the published table.
    #[test]
    fn height_of_the_column() {
        let table = [
            (0.01, 0.995_049_34),
            (0.1, 0.954_422_29),
            (0.4, 0.853_305_22),
            (1.0, 0.727_969_05),
            (2.0, 0.608_036_79),
            (4.0, 0.481_192_92),
        ];
        for (load, height) in table {
            let column = Column {
                height: 1.0,
                density: load,
                gravity: 1.0,
                young: 1.0,
            };
            assert!((column.position(1.0) - height).abs() < 5e-9, "S = {load}");
        }
    }

    /// dy/dY = λ and the equilibrium of Kirchhoff stress, E ln λ = λ σ.
    #[test]
    fn stretch_and_stress_agree() {
        let column = Column {
            height: 50.0,
            density: 80.0,
            gravity: 10.0,
            young: 1e4,
        };
        for y0 in [0.5, 10.0, 25.0, 49.0] {
            let d = 1e-4;
            let stretch = (column.position(y0 + d) - column.position(y0 - d)) / (2.0 * d);
            let tau = column.young * stretch.ln();
            assert!((tau - stretch * column.sigma_yy(y0)).abs() < 1e-4 * column.young);
        }
    }
}
