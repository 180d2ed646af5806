//! Places in D dimensions: the first axis points right, the last one up.

/// A place as it is seen from the front: its first coordinate and its level \[m\]. In the plane, the place itself.
pub fn front<const D: usize>(place: &[f64; D]) -> [f64; 2] {
    [place[0], place[D - 1]]
}

/// A point with zeros for the coordinates that it does not have \[m\].
pub fn in_space<const D: usize>(point: &[f64; D]) -> [f64; 3] {
    std::array::from_fn(|axis| point.get(axis).copied().unwrap_or(0.0))
}
