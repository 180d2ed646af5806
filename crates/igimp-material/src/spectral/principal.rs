//! Principal values as plain arrays: the few operations the laws need.

/// Principal values of a symmetric tensor, tension (extension) positive.
///
/// The order is the caller's: laws take any order and answer in the same.
pub type Principal = [f64; 3];

/// A full symmetric 3×3 tensor in spatial axes x, y, z; plane strain lies in x, y.
pub type Tensor = [[f64; 3]; 3];

/// The scalar product.
#[inline]
pub(crate) fn dot(a: &Principal, b: &Principal) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
pub(crate) fn cross(a: &Principal, b: &Principal) -> Principal {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The product of a matrix and a vector of principal values.
#[inline]
pub(crate) fn apply(matrix: &[[f64; 3]; 3], vector: &Principal) -> Principal {
    matrix.map(|row| dot(&row, vector))
}

/// A third of the sum.
#[inline]
pub(crate) fn mean(values: &Principal) -> f64 {
    (values[0] + values[1] + values[2]) / 3.0
}

/// The values less their mean.
#[inline]
pub(crate) fn deviator(values: &Principal) -> Principal {
    let mean = mean(values);
    values.map(|value| value - mean)
}

/// The norm $`q = \sqrt{3/2}\,\lVert s\rVert`$ of a stress deviator s.
#[inline]
pub(crate) fn deviator_norm(s: &Principal) -> f64 {
    (1.5 * dot(s, s)).sqrt()
}

/// The largest magnitude.
#[inline]
pub(crate) fn largest(values: &Principal) -> f64 {
    values[0].abs().max(values[1].abs()).max(values[2].abs())
}

/// Positions of the values in descending order: `values[order[0]]` is the largest.
#[inline]
pub(crate) fn descending(values: &Principal) -> [usize; 3] {
    let mut order = [0, 1, 2];
    for (left, right) in [(0, 1), (1, 2), (0, 1)] {
        if values[order[left]] < values[order[right]] {
            order.swap(left, right);
        }
    }
    order
}

/// The values taken in `order`.
#[inline]
pub(crate) fn sorted(values: &Principal, order: &[usize; 3]) -> Principal {
    order.map(|position| values[position])
}

/// Undoes [`sorted`].
#[inline]
pub(crate) fn unsorted(values: &Principal, order: &[usize; 3]) -> Principal {
    let mut out = [0.0; 3];
    for (value, &position) in values.iter().zip(order) {
        out[position] = *value;
    }
    out
}
