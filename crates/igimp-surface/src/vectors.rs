//! Vectors as plain arrays.

/// The difference of two vectors.
pub fn minus<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// The scalar product.
pub fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|axis| a[axis] * b[axis]).sum()
}

/// The length of a vector.
pub fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}

/// The vector product in space.
pub fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        a[l] * b[m] - a[m] * b[l]
    })
}

/// The area of the parallelogram of two vectors.
pub fn cross_size<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (dot(a, a) * dot(b, b) - dot(a, b).powi(2)).max(0.0).sqrt()
}
