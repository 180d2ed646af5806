//! Smooth displacement fields on the unit box that leave its walls where they are.

/// A square matrix.
pub(crate) type Matrix<const D: usize> = [[f64; D]; D];

/// A factor of a displacement in one direction.
#[derive(Clone, Copy, Debug)]
enum Wave {
    /// 1.
    One,
    /// sin(kπX).
    Sine(f64),
    /// sin²(πX).
    SineSquared,
}

impl Wave {
    /// Value, slope and curvature at `x`.
    fn at(self, x: f64) -> [f64; 3] {
        use std::f64::consts::PI;
        match self {
            Self::One => [1.0, 0.0, 0.0],
            Self::Sine(k) => {
                let (sine, cosine) = (k * PI * x).sin_cos();
                [sine, k * PI * cosine, -(k * PI).powi(2) * sine]
            }
            Self::SineSquared => {
                let (sine, cosine) = (2.0 * PI * x).sin_cos();
                [0.5 - 0.5 * cosine, PI * sine, 2.0 * PI * PI * cosine]
            }
        }
    }
}

/// A displacement `u_i(X) = A s_i Π_d f_id(X_d)` that vanishes, or its normal part, on the walls of
/// the unit box.
#[derive(Clone, Debug)]
pub(crate) struct Field<const D: usize> {
    /// Name for variants.
    pub(crate) name: &'static str,
    /// Amplitude A \[length\].
    amplitude: f64,
    /// Whether tangential motion on the walls is free, its traction being zero.
    pub(crate) rollers: bool,
    signs: [f64; D],
    waves: [[Wave; D]; D],
}

impl<const D: usize> Field<D> {
    /// u_i = A sin(πX_i): F stays diagonal, and so does the stress.
    pub(crate) fn aligned(amplitude: f64) -> Self {
        let wave = |i: usize, d: usize| if i == d { Wave::Sine(1.0) } else { Wave::One };
        Self {
            name: "axis-aligned",
            amplitude,
            rollers: true,
            signs: [1.0; D],
            waves: std::array::from_fn(|i| std::array::from_fn(|d| wave(i, d))),
        }
    }

    /// u_i = ±A sin²(πX_i) sin(2πX_i+1) \[sin(πX_i+2)\]: counter-rotating swirls, all walls at
    /// rest. In the plane the sign turns with i, and div u = 0.
    pub(crate) fn swirls(amplitude: f64) -> Self {
        let wave = |i: usize, d: usize| match (d + D - i) % D {
            0 => Wave::SineSquared,
            1 => Wave::Sine(2.0),
            _ => Wave::Sine(1.0),
        };
        Self {
            name: "swirls",
            amplitude,
            rollers: false,
            signs: std::array::from_fn(|i| if D == 2 && i == 1 { -1.0 } else { 1.0 }),
            waves: std::array::from_fn(|i| std::array::from_fn(|d| wave(i, d))),
        }
    }

    /// The same field with another amplitude.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self {
            amplitude: factor * self.amplitude,
            ..self.clone()
        }
    }

    /// The product of the derivatives of order `orders[d]` along each direction, times A s_i.
    fn product(&self, i: usize, x: &[f64; D], orders: [usize; D]) -> f64 {
        let factors = (0..D).map(|d| self.waves[i][d].at(x[d])[orders[d]]);
        self.amplitude * self.signs[i] * factors.product::<f64>()
    }

    /// Displacement at X \[length\].
    pub(crate) fn displacement(&self, x: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|i| self.product(i, x, [0; D]))
    }

    /// Deformation gradient F = I + ∂u/∂X.
    pub(crate) fn def_grad(&self, x: &[f64; D]) -> Matrix<D> {
        let entry =
            |i: usize, j: usize| self.product(i, x, std::array::from_fn(|d| usize::from(d == j)));
        std::array::from_fn(|i| {
            std::array::from_fn(|j| entry(i, j) + if i == j { 1.0 } else { 0.0 })
        })
    }

    /// ∂F/∂X_k \[1/length\].
    pub(crate) fn def_grad_slope(&self, x: &[f64; D], k: usize) -> Matrix<D> {
        let orders = |j: usize| std::array::from_fn(|d| usize::from(d == j) + usize::from(d == k));
        std::array::from_fn(|i| std::array::from_fn(|j| self.product(i, x, orders(j))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gradients and second derivatives against central differences.
    fn derivatives_are_differences<const D: usize>(field: &Field<D>, x: [f64; D]) {
        let d = 1e-5;
        for k in 0..D {
            let at = |side: f64| {
                let mut x = x;
                x[k] += side * d;
                x
            };
            let (after, before) = (at(1.0), at(-1.0));
            let (u_after, u_before) = (field.displacement(&after), field.displacement(&before));
            let (f_after, f_before) = (field.def_grad(&after), field.def_grad(&before));
            for i in 0..D {
                let slope = (u_after[i] - u_before[i]) / (2.0 * d);
                let unit = if i == k { 1.0 } else { 0.0 };
                assert!((field.def_grad(&x)[i][k] - unit - slope).abs() < 1e-9);
                for j in 0..D {
                    let slope = (f_after[i][j] - f_before[i][j]) / (2.0 * d);
                    assert!((field.def_grad_slope(&x, k)[i][j] - slope).abs() < 1e-8);
                }
            }
        }
    }

    #[test]
    fn derivatives() {
        derivatives_are_differences(&Field::aligned(0.1), [0.31, 0.77]);
        derivatives_are_differences(&Field::swirls(0.05), [0.31, 0.77]);
        derivatives_are_differences(&Field::aligned(0.1), [0.31, 0.77, 0.12]);
        derivatives_are_differences(&Field::swirls(0.05), [0.31, 0.77, 0.12]);
    }

    #[test]
    fn walls_stay() {
        for wall in [0.0, 1.0] {
            let aligned = Field::<2>::aligned(0.1).displacement(&[wall, 0.3]);
            assert!(aligned[0].abs() < 1e-15, "normal to the wall");
            let swirls = Field::<3>::swirls(0.1);
            for x in [[wall, 0.3, 0.4], [0.3, wall, 0.4], [0.3, 0.4, wall]] {
                assert!(swirls.displacement(&x).iter().all(|u| u.abs() < 1e-15));
            }
        }
        let plane = Field::<2>::swirls(0.1).def_grad(&[0.2, 0.6]);
        assert!((plane[0][0] + plane[1][1] - 2.0).abs() < 1e-15, "div u = 0");
    }
}
