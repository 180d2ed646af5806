//! A number over the plane, by points on the lines of a grid.

/// Values where upright and level lines cross; between them it is linear along both, and beyond the outermost lines
/// constant (theory, eq. 19c).
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

    /// The integral along an upright line from one level up to another.
    pub fn integral(&self, x: f64, lower: f64, upper: f64) -> f64 {
        if upper < lower {
            return -self.integral(x, upper, lower);
        }
        let within = self.y.iter().copied();
        let mut ends: Vec<f64> = within.filter(|y| lower < *y && *y < upper).collect();
        ends.insert(0, lower);
        ends.push(upper);
        ends.windows(2)
            .map(|pair| (pair[1] - pair[0]) * 0.5 * (self.at([x, pair[0]]) + self.at([x, pair[1]])))
            .sum()
    }

    /// The places of the least and of the greatest value in a box.
    pub fn extremes(&self, lower: [f64; 2], upper: [f64; 2]) -> [[f64; 2]; 2] {
        let lines = |all: &[f64], k: usize| -> Vec<f64> {
            let within = all.iter().copied();
            let within = within.filter(|at| lower[k] < *at && *at < upper[k]);
            within.chain([lower[k], upper[k]]).collect()
        };
        // Within a cell of the raster both extremes are at its corners.
        let (xs, ys) = (lines(&self.x, 0), lines(&self.y, 1));
        let places = || ys.iter().flat_map(|&y| xs.iter().map(move |&x| [x, y]));
        let by_value = |a: &[f64; 2], b: &[f64; 2]| self.at(*a).total_cmp(&self.at(*b));
        [
            places().min_by(by_value).unwrap_or(lower),
            places().max_by(by_value).unwrap_or(upper),
        ]
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
            assert!((raster.at(at) - exact(at[0], at[1])).abs() < 1e-14, "{at:?}");
        }
        assert!((raster.at([-1.0, 7.0]) - exact(0.0, 1.0)).abs() < 1e-14);
        assert!((raster.at([9.0, -7.0]) - exact(4.0, -2.0)).abs() < 1e-14);
        let sum = raster.integral(2.0, -1.0, 0.8);
        assert!((sum - (7.0 * 1.8)).abs() < 1e-12, "{sum}");
        assert!((raster.integral(2.0, 0.8, -1.0) + sum).abs() < 1e-15);
        let [least, most] = raster.extremes([0.5, -1.0], [3.0, 0.9]);
        assert!((raster.at(least) - exact(0.5, 0.9)).abs() < 1e-12, "{least:?}");
        assert!((raster.at(most) - exact(3.0, 0.9)).abs() < 1e-12, "{most:?}");
    }
}
