//! Principal values and axes of a symmetric tensor by Jacobi rotations.
//!
//! In plane strain one rotation is the closed form; in 3D cyclic sweeps converge quadratically.
//! Jacobi's method keeps small eigenvalues accurate and gives orthonormal axes also where
//! eigenvalues are equal (Golub & Van Loan, *Matrix Computations*, section 8.5).

use crate::spectral::principal::{Principal, Tensor};

/// More sweeps than any symmetric 3×3 tensor needs.
const SWEEPS: usize = 12;

/// Principal values of a symmetric tensor, in no particular order.
///
/// `D = 1` is uniaxial strain and reads xx, yy and zz; `D = 2` is plane strain and reads xy too;
/// `D = 3` reads the upper triangle.
pub fn principal_values<const D: usize>(tensor: &Tensor) -> Principal {
    principal_axes::<D>(tensor).0
}

/// Principal values and the axes: `frame[a]` is the unit vector of value `a`.
///
/// `D = 1` reads the components xx, yy and zz and keeps the spatial axes; `D = 2` reads xy too, and
/// the last axis is z; `D = 3` reads the upper triangle. The order is that of the spatial axes as far as there is one: a diagonal
/// tensor keeps its axes.
#[inline]
pub(crate) fn principal_axes<const D: usize>(tensor: &Tensor) -> (Principal, Tensor) {
    const { assert!(1 <= D && D <= 3, "uniaxial strain, plane strain or 3D") };
    let mut a = *tensor;
    let mut frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    if D == 2 {
        [a[0][2], a[1][2]] = [0.0; 2];
        rotate(&mut a, &mut frame, [0, 1, 2]);
    } else if D == 3 {
        for _ in 0..SWEEPS {
            // Sums, not maxima: they pass on a NaN.
            let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
            let size = a[0][0].abs() + a[1][1].abs() + a[2][2].abs();
            if off <= 1e-3 * f64::EPSILON * size {
                break;
            }
            for axes in [[0, 1, 2], [0, 2, 1], [1, 2, 0]] {
                rotate(&mut a, &mut frame, axes);
            }
        }
    }
    ([a[0][0], a[1][1], a[2][2]], frame)
}

/// Turns axes p and q, by at most 45°, so that the component pq vanishes; r is the third axis.
/// Only the upper triangle of `a` is kept.
#[inline]
fn rotate(a: &mut Tensor, frame: &mut Tensor, [p, q, r]: [usize; 3]) {
    let off = a[p][q];
    if off == 0.0 {
        return;
    }
    let ratio = 0.5 * (a[p][p] - a[q][q]) / off;
    let tangent = 1.0 / (ratio + (1.0 + ratio * ratio).sqrt().copysign(ratio));
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let sine = tangent * cosine;
    let turned = |x: f64, y: f64| (cosine * x + sine * y, cosine * y - sine * x);
    a[p][p] += tangent * off;
    a[q][q] -= tangent * off;
    a[p][q] = 0.0;
    let ([pr, rp], [qr, rq]) = ([p.min(r), p.max(r)], [q.min(r), q.max(r)]);
    (a[pr][rp], a[qr][rq]) = turned(a[pr][rp], a[qr][rq]);
    for i in 0..3 {
        (frame[p][i], frame[q][i]) = turned(frame[p][i], frame[q][i]);
    }
}

/// The tensor with the given principal values: $`\sum_a v_a\, n_a \otimes n_a`$.
#[inline]
pub(crate) fn compose<const D: usize>(values: &Principal, frame: &Tensor) -> Tensor {
    let mut tensor = [[0.0; 3]; 3];
    for a in 0..D {
        for i in 0..D {
            let scaled = values[a] * frame[a][i];
            for j in i..D {
                tensor[i][j] += scaled * frame[a][j];
            }
        }
    }
    for i in 0..D {
        for j in 0..i {
            tensor[i][j] = tensor[j][i];
        }
    }
    for a in D..3 {
        tensor[a][a] = values[a];
    }
    tensor
}
