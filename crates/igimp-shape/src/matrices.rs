//! Small dense matrices as plain arrays: the kinematics for D = 1, 2, 3.

/// The identity.
pub fn identity<const D: usize>() -> [[f64; D]; D] {
    let mut out = [[0.0; D]; D];
    for a in 0..D {
        out[a][a] = 1.0;
    }
    out
}

/// The product `a b`.
pub fn multiply<const D: usize>(a: &[[f64; D]; D], b: &[[f64; D]; D]) -> [[f64; D]; D] {
    let mut out = [[0.0; D]; D];
    for i in 0..D {
        for j in 0..D {
            for k in 0..D {
                out[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    out
}

/// The congruence `a b aᵀ`.
pub fn congruence<const D: usize>(a: &[[f64; D]; D], b: &[[f64; D]; D]) -> [[f64; D]; D] {
    multiply(&multiply(a, b), &transpose(a))
}

/// The transpose.
pub fn transpose<const D: usize>(a: &[[f64; D]; D]) -> [[f64; D]; D] {
    let mut out = [[0.0; D]; D];
    for i in 0..D {
        for j in 0..D {
            out[i][j] = a[j][i];
        }
    }
    out
}

/// The product `a v`.
#[inline]
pub fn apply<const D: usize>(a: &[[f64; D]; D], v: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|row| (0..D).map(|column| a[row][column] * v[column]).sum())
}

/// The product `aᵀ v`.
#[inline]
pub fn transpose_apply<const D: usize>(a: &[[f64; D]; D], v: &[f64; D]) -> [f64; D] {
    let mut out = [0.0; D];
    for i in 0..D {
        for j in 0..D {
            out[i] += a[j][i] * v[j];
        }
    }
    out
}

/// The determinant.
pub fn determinant<const D: usize>(a: &[[f64; D]; D]) -> f64 {
    match D {
        1 => a[0][0],
        2 => a[0][0] * a[1][1] - a[0][1] * a[1][0],
        3 => (0..3).map(|k| a[0][k] * cofactor3(a, 0, k)).sum(),
        _ => unreachable!("space has one to three dimensions"),
    }
}

/// The inverse, given the determinant.
pub fn inverse<const D: usize>(a: &[[f64; D]; D], determinant: f64) -> [[f64; D]; D] {
    let mut out = [[0.0; D]; D];
    match D {
        1 => out[0][0] = 1.0 / determinant,
        2 => {
            out[0][0] = a[1][1] / determinant;
            out[0][1] = -a[0][1] / determinant;
            out[1][0] = -a[1][0] / determinant;
            out[1][1] = a[0][0] / determinant;
        }
        3 => {
            for i in 0..3 {
                for j in 0..3 {
                    out[i][j] = cofactor3(a, j, i) / determinant;
                }
            }
        }
        _ => unreachable!("space has one to three dimensions"),
    }
    out
}

fn cofactor3<const D: usize>(a: &[[f64; D]; D], row: usize, column: usize) -> f64 {
    let (r1, r2) = ((row + 1) % 3, (row + 2) % 3);
    let (c1, c2) = ((column + 1) % 3, (column + 2) % 3);
    a[r1][c1] * a[r2][c2] - a[r1][c2] * a[r2][c1]
}

/// The rotation R of the polar decomposition F = R U, by Newton's iteration R ← (R + R⁻ᵀ)/2
/// (Higham 1986), which converges quadratically for det F > 0.
pub fn rotation<const D: usize>(f: &[[f64; D]; D]) -> [[f64; D]; D] {
    let mut r = *f;
    for _ in 0..60 {
        let inverse_transpose = transpose(&inverse(&r, determinant(&r)));
        let mut change = 0.0_f64;
        for i in 0..D {
            for j in 0..D {
                let next = 0.5 * (r[i][j] + inverse_transpose[i][j]);
                change = change.max((next - r[i][j]).abs());
                r[i][j] = next;
            }
        }
        if change < 1e-15 {
            break;
        }
    }
    r
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_and_rotation_in_three_dimensions() {
        let f = [[1.2, 0.3, -0.1], [-0.2, 0.9, 0.4], [0.05, -0.3, 1.1]];
        let product = multiply(&f, &inverse(&f, determinant(&f)));
        let r = rotation(&f);
        let orthogonal = multiply(&transpose(&r), &r);
        let stretch = multiply(&transpose(&r), &f);
        for i in 0..3 {
            for j in 0..3 {
                let delta = f64::from(u8::from(i == j));
                assert!((product[i][j] - delta).abs() < 1e-14);
                assert!((orthogonal[i][j] - delta).abs() < 1e-14);
                assert!((stretch[i][j] - stretch[j][i]).abs() < 1e-14);
            }
        }
        assert!((determinant(&r) - 1.0).abs() < 1e-14);
    }
}
