//! A number over the plane, by points on the lines of a grid.

use igimp_geometry::polygon::contains;

/// Values where upright and level lines cross; between them it is linear along both, and beyond the outermost lines
/// constant (theory, eq. 19e).
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Upright lines, ascending \[m\].
    pub x: Vec<f64>,
    /// Level lines, ascending \[m\].
    pub y: Vec<f64>,
    /// Values by level line, then by upright line.
    pub values: Vec<Vec<f64>>,
}

impl Raster {
    /// The value at a place.
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let (left, across) = between(&self.x, x);
        let (below, up) = between(&self.y, y);
        let along = |row: &[f64]| {
            let right = (left + 1).min(row.len() - 1);
            row[left] + across * (row[right] - row[left])
        };
        let above = (below + 1).min(self.values.len() - 1);
        let [lower, upper] = [below, above].map(|row| along(&self.values[row]));
        lower + up * (upper - lower)
    }

    /// The integral from a place straight up to a level.
    pub(crate) fn integral(&self, [x, lower]: [f64; 2], upper: f64) -> f64 {
        if upper < lower {
            return -self.integral([x, upper], lower);
        }
        let mut ends = vec![lower];
        ends.extend(
            self.y
                .iter()
                .filter(|level| lower < **level && **level < upper),
        );
        ends.push(upper);
        ends.windows(2)
            .map(|pair| (pair[1] - pair[0]) * 0.5 * (self.at([x, pair[0]]) + self.at([x, pair[1]])))
            .sum()
    }

    /// Places within a polygon among which the least and the greatest value are: crossings of lines, corners, and where
    /// lines cross edges.
    pub fn places_in(&self, polygon: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut places = polygon.to_vec();
        for (k, p) in polygon.iter().enumerate() {
            let q = polygon[(k + 1) % polygon.len()];
            for (axis, lines) in [&self.x, &self.y].into_iter().enumerate() {
                let way = q[axis] - p[axis];
                let shares = lines.iter().map(|line| (line - p[axis]) / way);
                let within = shares.filter(|t| *t > 0.0 && *t < 1.0);
                places.extend(within.map(|t| [0, 1].map(|axis| p[axis] + t * (q[axis] - p[axis]))));
            }
        }
        let crossings = self
            .y
            .iter()
            .flat_map(|&y| self.x.iter().map(move |&x| [x, y]));
        places.extend(crossings.filter(|at| contains(polygon, *at)));
        places
    }

    /// How far a place lies beyond the outermost lines, in spacings of the lines there \[-\].
    pub fn beyond(&self, place: [f64; 2]) -> f64 {
        let along = |lines: &[f64], at: f64| {
            let count = lines.len();
            if count < 2 {
                return 0.0;
            }
            let before = (lines[0] - at) / (lines[1] - lines[0]);
            let after = (at - lines[count - 1]) / (lines[count - 1] - lines[count - 2]);
            before.max(after)
        };
        along(&self.x, place[0])
            .max(along(&self.y, place[1]))
            .max(0.0)
    }
}

/// The line before a place, and the share of the way to the next one \[-\].
fn between(lines: &[f64], at: f64) -> (usize, f64) {
    let before = lines.partition_point(|line| *line <= at);
    match (before.checked_sub(1), lines.get(before)) {
        (Some(before), Some(next)) => {
            let line = lines[before];
            (before, (at - line) / (next - line))
        }
        (Some(last), None) => (last, 0.0),
        (None, _) => (0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::Raster;

    /// GOAL: a bilinear function is met everywhere, and the raster is constant beyond its lines.
    #[test]
    fn a_raster_is_bilinear_and_constant_beyond() {
        let exact = |x: f64, y: f64| 3.0 + 2.0 * x - y + 0.5 * x * y;
        let (x, y) = (vec![0.0, 1.0, 4.0], vec![-2.0, 0.5, 1.0]);
        let values = y
            .iter()
            .map(|&y| x.iter().map(|&x| exact(x, y)).collect())
            .collect();
        let raster = Raster { x, y, values };
        for at in [[0.0, -2.0], [0.3, -1.0], [1.0, 0.5], [3.9, 0.7], [4.0, 1.0]] {
            assert!(
                (raster.at(at) - exact(at[0], at[1])).abs() < 1e-14,
                "{at:?}"
            );
        }
        assert!((raster.at([-1.0, 7.0]) - exact(0.0, 1.0)).abs() < 1e-14);
        assert!((raster.at([9.0, -7.0]) - exact(4.0, -2.0)).abs() < 1e-14);
        let ring = [[0.5, -1.0], [3.0, -1.0], [3.0, 0.9], [0.5, 0.9]];
        let values = raster.places_in(&ring).into_iter().map(|at| raster.at(at));
        let (least, most) = values.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
        assert!((least - exact(0.5, 0.9)).abs() < 1e-12, "{least}");
        assert!((most - exact(3.0, 0.9)).abs() < 1e-12, "{most}");
        assert!(raster.beyond([2.0, 0.0]) <= 0.0);
        assert!((raster.beyond([5.5, 0.0]) - 0.5).abs() < 1e-15);
        assert!((raster.beyond([0.0, -4.5]) - 1.0).abs() < 1e-15);
    }
}
