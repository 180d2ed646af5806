//! Hencky elasticity by power series, with derivatives carried along: the stress of a given
//! deformation and the body force that keeps it in equilibrium.
//!
//! Nothing here is shared with the code under test, which works with principal values:
//! `ln b = 2 artanh Z = 2 (Z + Z³/3 + Z⁵/5 + …)` with `Z = (b − I)(b + I)⁻¹` needs none.

use super::field::{Field, Matrix};

/// Terms of the series smaller than this are round-off \[-\].
const NEGLIGIBLE: f64 = 1e-18;
/// Most terms; at stretches of 2 the ratio of terms is 0.36.
const TERMS: usize = 60;

/// Bulk and shear modulus \[force/length²\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moduli {
    /// K.
    pub(crate) bulk: f64,
    /// G.
    pub(crate) shear: f64,
}

/// A matrix with its derivative along one direction: forward differentiation by hand.
#[derive(Clone, Copy, Debug)]
struct Jet<const D: usize> {
    value: Matrix<D>,
    slope: Matrix<D>,
}

impl<const D: usize> Jet<D> {
    fn times(&self, other: &Self) -> Self {
        let first = multiply(&self.slope, &other.value);
        let second = multiply(&self.value, &other.slope);
        Self {
            value: multiply(&self.value, &other.value),
            slope: combine(&first, 1.0, &second),
        }
    }

    fn plus(&self, share: f64, other: &Self) -> Self {
        Self {
            value: combine(&self.value, share, &other.value),
            slope: combine(&self.slope, share, &other.slope),
        }
    }

    fn transposed(&self) -> Self {
        Self {
            value: transpose(&self.value),
            slope: transpose(&self.slope),
        }
    }

    /// (A⁻¹)' = −A⁻¹ A' A⁻¹.
    fn inverse(&self) -> Self {
        let value = inverse(&self.value);
        let slope = multiply(&multiply(&value, &self.slope), &value);
        Self {
            value,
            slope: slope.map(|row| row.map(|entry| -entry)),
        }
    }

    fn constant(value: Matrix<D>) -> Self {
        Self {
            value,
            slope: [[0.0; D]; D],
        }
    }
}

/// Kirchhoff stress τ = 2G ε + (K − 2G/3) tr ε I with ε = ½ ln(F Fᵀ).
fn kirchhoff<const D: usize>(f: &Jet<D>, moduli: Moduli) -> Jet<D> {
    let identity = Jet::constant(identity());
    let b = f.times(&f.transposed());
    let z = b
        .plus(-1.0, &identity)
        .times(&b.plus(1.0, &identity).inverse());
    let square = z.times(&z);
    let (mut strain, mut power) = (z, z);
    for k in 1..TERMS {
        power = power.times(&square);
        strain = strain.plus(1.0 / (2.0 * k as f64 + 1.0), &power);
        let entries = power.value.iter().chain(&power.slope).flatten();
        if entries.fold(0.0_f64, |most, entry| most.max(entry.abs())) < NEGLIGIBLE {
            break;
        }
    }
    let lame = moduli.bulk - 2.0 * moduli.shear / 3.0;
    let pressure = Jet {
        value: scale(lame * trace(&strain.value), &identity.value),
        slope: scale(lame * trace(&strain.slope), &identity.value),
    };
    pressure.plus(2.0 * moduli.shear, &strain)
}

impl<const D: usize> Field<D> {
    /// Cauchy stress at X, its components within the D directions \[force/length²\].
    pub(crate) fn cauchy(&self, x: &[f64; D], moduli: Moduli) -> Matrix<D> {
        let f = self.def_grad(x);
        let tau = kirchhoff(&Jet::constant(f), moduli).value;
        scale(determinant(&f).recip(), &tau)
    }

    /// First Piola–Kirchhoff stress P = τ F⁻ᵀ and its derivative along X_k.
    fn first_piola(&self, x: &[f64; D], moduli: Moduli, k: usize) -> Jet<D> {
        let f = Jet {
            value: self.def_grad(x),
            slope: self.def_grad_slope(x, k),
        };
        kirchhoff(&f, moduli).times(&f.inverse().transposed())
    }

    /// The body force that keeps the field in equilibrium, −Div P \[force/length³ of the undeformed
    /// body\].
    pub(crate) fn body_force(&self, x: &[f64; D], moduli: Moduli) -> [f64; D] {
        let mut force = [0.0; D];
        for k in 0..D {
            let slope = self.first_piola(x, moduli, k).slope;
            for i in 0..D {
                force[i] -= slope[i][k];
            }
        }
        force
    }
}

fn identity<const D: usize>() -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }))
}

fn multiply<const D: usize>(a: &Matrix<D>, b: &Matrix<D>) -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..D).map(|k| a[i][k] * b[k][j]).sum()))
}

fn transpose<const D: usize>(a: &Matrix<D>) -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// a + share · b.
fn combine<const D: usize>(a: &Matrix<D>, share: f64, b: &Matrix<D>) -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + share * b[i][j]))
}

fn scale<const D: usize>(factor: f64, a: &Matrix<D>) -> Matrix<D> {
    a.map(|row| row.map(|entry| factor * entry))
}

fn trace<const D: usize>(a: &Matrix<D>) -> f64 {
    (0..D).map(|i| a[i][i]).sum()
}

/// Determinant and inverse by Gauss–Jordan elimination with row exchange.
fn eliminate<const D: usize>(a: &Matrix<D>) -> (f64, Matrix<D>) {
    let (mut left, mut right) = (*a, identity::<D>());
    let mut determinant = 1.0;
    for column in 0..D {
        let pivot = (column..D)
            .max_by(|&i, &j| left[i][column].abs().total_cmp(&left[j][column].abs()))
            .expect("a column has rows");
        if pivot != column {
            left.swap(pivot, column);
            right.swap(pivot, column);
            determinant = -determinant;
        }
        let head = left[column][column];
        determinant *= head;
        left[column] = left[column].map(|entry| entry / head);
        right[column] = right[column].map(|entry| entry / head);
        for row in 0..D {
            let share = left[row][column];
            if row != column {
                for j in 0..D {
                    left[row][j] -= share * left[column][j];
                    right[row][j] -= share * right[column][j];
                }
            }
        }
    }
    (determinant, right)
}

fn determinant<const D: usize>(a: &Matrix<D>) -> f64 {
    eliminate(a).0
}

fn inverse<const D: usize>(a: &Matrix<D>) -> Matrix<D> {
    eliminate(a).1
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODULI: Moduli = Moduli {
        bulk: 2.0,
        shear: 0.7,
    };

    /// Simple extension and shear by closed forms: τ_a = (K − 2G/3) ln J + 2G ln λ_a.
    #[test]
    fn stress_of_known_stretches() {
        let tau = kirchhoff(&Jet::constant([[1.3, 0.0], [0.0, 0.7]]), MODULI).value;
        let lame = MODULI.bulk - 2.0 * MODULI.shear / 3.0;
        let volume = (1.3_f64 * 0.7).ln();
        for (a, stretch) in [(0, 1.3_f64), (1, 0.7)] {
            let exact = lame * volume + 2.0 * MODULI.shear * stretch.ln();
            assert!((tau[a][a] - exact).abs() < 1e-14, "{}", tau[a][a] - exact);
        }
        // Simple shear γ: principal stretches e^{±asinh(γ/2)} at half the angle atan(2/γ).
        let gamma = 0.6_f64;
        let tau = kirchhoff(&Jet::constant([[1.0, gamma], [0.0, 1.0]]), MODULI).value;
        let strain = (0.5 * gamma).asinh();
        let angle = (2.0 / gamma).atan();
        assert!((tau[0][1] - 2.0 * MODULI.shear * strain * angle.sin()).abs() < 1e-14);
        assert!((tau[0][0] - 2.0 * MODULI.shear * strain * angle.cos()).abs() < 1e-14);
    }

    /// The body force against central differences of P.
    fn force_is_a_difference<const D: usize>(field: &Field<D>, x: [f64; D]) {
        let d = 1e-5;
        let mut expected = [0.0; D];
        for k in 0..D {
            for side in [1.0, -1.0] {
                let mut at = x;
                at[k] += side * d;
                let stress = field.first_piola(&at, MODULI, k).value;
                for i in 0..D {
                    expected[i] -= side * stress[i][k] / (2.0 * d);
                }
            }
        }
        let force = field.body_force(&x, MODULI);
        for i in 0..D {
            assert!((force[i] - expected[i]).abs() < 1e-8, "{}", field.name);
        }
    }

    #[test]
    fn body_force_balances_the_stress() {
        force_is_a_difference(&Field::aligned(0.1), [0.31, 0.77]);
        force_is_a_difference(&Field::swirls(0.05), [0.31, 0.77]);
        force_is_a_difference(&Field::aligned(0.1), [0.31, 0.77, 0.12]);
        force_is_a_difference(&Field::swirls(0.05), [0.31, 0.77, 0.12]);
    }
}
