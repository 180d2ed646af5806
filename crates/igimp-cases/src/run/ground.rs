//! The ground as the case draws it: the weight of what lies above a point.

use crate::case::{BodyPart, Case, Profile};

/// The bodies that are there from the start, as they are drawn.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    parts: Vec<Part>,
}

#[derive(Clone, Debug)]
struct Part {
    polygon: Vec<[f64; 2]>,
    unit_weight: f64,
    profile: Option<Profile>,
    /// By how much soil is heavier below the water table \[N/m³\].
    added: f64,
}

impl Ground {
    /// The ground of a case.
    pub(crate) fn of(case: &Case) -> Self {
        let part = |part: &BodyPart| {
            let material = &case.materials[part.material];
            Part {
                polygon: part.polygon.clone(),
                unit_weight: material.unit_weight,
                profile: material.profiles.unit_weight.clone(),
                added: material.added_by_water(),
            }
        };
        let from_start = case.bodies.iter().filter(|part| part.from_start);
        Self {
            parts: from_start.map(part).collect(),
        }
    }

    /// The surface above or below a place \[m\]; none where there is no ground.
    pub(crate) fn surface(&self, x: f64) -> Option<f64> {
        let tops = self.parts.iter().flat_map(|part| {
            let edges = edges(&part.polygon);
            edges.filter_map(move |[p, q]| {
                let [left, right] = [p[0].min(q[0]), p[0].max(q[0])];
                if x < left || x > right {
                    return None;
                }
                let t = if right > left {
                    (x - p[0]) / (q[0] - p[0])
                } else {
                    0.0
                };
                Some((p[1] + t * (q[1] - p[1])).max(if right > left {
                    f64::NEG_INFINITY
                } else {
                    q[1]
                }))
            })
        });
        tops.reduce(f64::max)
    }

    /// The weight of the ground above a point, without what water adds \[Pa\].
    pub(crate) fn weight_above(&self, x: &[f64; 2]) -> f64 {
        let weight = |part: &Part| match &part.profile {
            None => sum_above(&part.polygon, x, |level| level) * part.unit_weight,
            Some(own) => sum_above(&part.polygon, x, |level| own.integral(*x, level)),
        };
        self.parts.iter().map(weight).sum()
    }

    /// What a water table at a level adds to the weight above a point \[Pa\].
    pub(crate) fn added_above(&self, x: &[f64; 2], table: f64) -> f64 {
        let weight =
            |part: &Part| sum_above(&part.polygon, x, |level| level.min(table)) * part.added;
        self.parts.iter().map(weight).sum()
    }
}

fn edges(polygon: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
}

/// The growth of a quantity that rises with the level along the part of the vertical ray upwards from a point that
/// lies within a polygon: with the level itself, the length \[m\].
fn sum_above(polygon: &[[f64; 2]], x: &[f64; 2], quantity: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for [p, q] in edges(polygon) {
        if (p[0] <= x[0]) == (q[0] <= x[0]) {
            continue;
        }
        let t = (x[0] - p[0]) / (q[0] - p[0]);
        let crossing = quantity((p[1] + t * (q[1] - p[1])).max(x[1]));
        sum += if q[0] < p[0] { crossing } else { -crossing };
    }
    sum.abs()
}

#[cfg(test)]
mod tests {
    use super::sum_above;
    use crate::case::Profile;

    #[test]
    fn the_ray_counts_what_lies_above() {
        let length_above = |ring: &[[f64; 2]], x: &[f64; 2]| sum_above(ring, x, |level| level);
        let ring = [[0.0, 0.0], [4.0, 0.0], [4.0, 5.0], [0.0, 5.0]];
        assert!((length_above(&ring, &[1.0, 2.0]) - 3.0).abs() < 1e-15);
        assert!((length_above(&ring, &[1.0, -2.0]) - 5.0).abs() < 1e-15);
        assert!(length_above(&ring, &[1.0, 6.0]).abs() < 1e-15);
        let clockwise: Vec<[f64; 2]> = ring.iter().rev().copied().collect();
        assert!((length_above(&clockwise, &[1.0, 2.0]) - 3.0).abs() < 1e-15);
        let denser = Profile::Gradient {
            from: 4.0,
            at_top: 18.0,
            gradient: 0.5,
        };
        let weight = sum_above(&ring, &[1.0, 2.0], |level| {
            denser.integral([1.0, 2.0], level)
        });
        assert!((weight - (18.0 + 2.0 * 18.5)).abs() < 1e-12);
    }
}
