//! Plane polygons: area, centroid, and their parts within a box.

/// A polygon by its corners, in order; the last is joined to the first.
pub type Polygon = Vec<[f64; 2]>;

/// Signed area (positive counter-clockwise) and centroid of a polygon \[length², length\].
///
/// The centroid of a polygon without area is its first corner.
pub fn area_and_centroid(polygon: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let Some(&origin) = polygon.first() else {
        return (0.0, [0.0; 2]);
    };
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        let (px, py) = (p[0] - origin[0], p[1] - origin[1]);
        let (qx, qy) = (q[0] - origin[0], q[1] - origin[1]);
        let cross = px * qy - qx * py;
        area += 0.5 * cross;
        moment[0] += cross * (px + qx) / 6.0;
        moment[1] += cross * (py + qy) / 6.0;
    }
    if area == 0.0 {
        return (0.0, origin);
    }
    (
        area,
        [origin[0] + moment[0] / area, origin[1] + moment[1] / area],
    )
}

/// Edges of a polygon.
pub fn edges(polygon: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().copied().zip(next.copied())
}

/// Whether a point lies inside a polygon; on its edge either may be said.
pub fn contains(polygon: &[[f64; 2]], point: [f64; 2]) -> bool {
    let crossings = edges(polygon).filter(|(p, q)| {
        (p[1] > point[1]) != (q[1] > point[1])
            && point[0] < p[0] + (point[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0])
    });
    crossings.count() % 2 == 1
}

/// The part of a polygon within the box from `lower` to `upper` (Sutherland and Hodgman 1974).
///
/// Parts of a polygon that is not convex may come out joined along the sides of the box; area and
/// centroid are exact all the same.
pub fn clip_to_box(polygon: &[[f64; 2]], lower: [f64; 2], upper: [f64; 2]) -> Polygon {
    let column = clip_to_strip(polygon, 0, lower[0], upper[0]);
    clip_to_strip(&column, 1, lower[1], upper[1])
}

/// The part of a polygon between two lines across an axis; [`clip_to_box`] is one after the other.
pub(crate) fn clip_to_strip(polygon: &[[f64; 2]], axis: usize, lower: f64, upper: f64) -> Polygon {
    let above = clip(polygon, axis, |x| x >= lower, lower);
    clip(&above, axis, |x| x <= upper, upper)
}

fn clip(polygon: &[[f64; 2]], axis: usize, inside: impl Fn(f64) -> bool, limit: f64) -> Polygon {
    let mut out = Vec::with_capacity(polygon.len() + 2);
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        if inside(p[axis]) {
            out.push(*p);
        }
        if inside(p[axis]) != inside(q[axis]) {
            let t = (limit - p[axis]) / (q[axis] - p[axis]);
            let mut crossing = [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])];
            crossing[axis] = limit;
            out.push(crossing);
        }
    }
    out
}

/// The smallest box around a polygon: lower and upper corner \[length\].
pub fn bounding_box(polygon: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    let mut lower = [f64::INFINITY; 2];
    let mut upper = [f64::NEG_INFINITY; 2];
    for corner in polygon {
        for axis in 0..2 {
            lower[axis] = lower[axis].min(corner[axis]);
            upper[axis] = upper[axis].max(corner[axis]);
        }
    }
    (lower, upper)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipped_parts_of_a_concave_polygon_add_up() {
        let polygon = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 0.7], [0.0, 3.0]];
        let (whole, centroid) = area_and_centroid(&polygon);
        let (mut area, mut moment) = (0.0, [0.0; 2]);
        for i in 0..8 {
            for j in 0..6 {
                let lower = [0.5 * f64::from(i), 0.5 * f64::from(j)];
                let part = clip_to_box(&polygon, lower, [lower[0] + 0.5, lower[1] + 0.5]);
                let (a, c) = area_and_centroid(&part);
                area += a;
                moment[0] += a * c[0];
                moment[1] += a * c[1];
            }
        }
        assert!((area - whole).abs() < 1e-13);
        assert!((moment[0] / area - centroid[0]).abs() < 1e-13);
        assert!((moment[1] / area - centroid[1]).abs() < 1e-13);
    }

    #[test]
    fn a_box_beside_the_polygon_is_empty() {
        let triangle = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(clip_to_box(&triangle, [2.0, 2.0], [3.0, 3.0]).is_empty());
    }
}
