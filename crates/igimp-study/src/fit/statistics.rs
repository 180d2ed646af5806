//! How well parameters are known: linear theory about the least sum of squares (theory, eqs. 117 to 119).

use nalgebra::{DMatrix, DVector};

use super::parameter::{Parameter, Range};

/// A combination of parameters whose effect is less than this share of the largest one is not determined \[-\]: ten times what
/// differences and the tolerance of a step leave.
const NO_EFFECT: f64 = 1e-5;

/// Residuals that change by less, for a change of a parameter by its own size, do not depend on it \[-\].
const UNTOUCHED: f64 = 1e-7;

/// A parameter with more than this share in a combination belongs to it \[-\].
const SHARE: f64 = 0.01;

/// How well a parameter is known.
#[derive(Clone, Debug, PartialEq)]
pub enum Known {
    /// By its standard error and the interval that holds it with 95 %, in the unit of its value.
    Well {
        /// Standard error.
        error: f64,
        /// Lower and upper end.
        interval: [f64; 2],
    },
    /// It is at a bound, which decides on it and not the data.
    AtBound {
        /// Whether at the upper one.
        upper: bool,
    },
    /// It is at a wall: the last value with which, beside the others, its law and the tests are not refused. The wall decides on it
    /// and not the data.
    AtWall {
        /// Whether at the greatest value.
        upper: bool,
    },
    /// The data do not determine it: alone where the others, by their places, are none.
    NotDetermined {
        /// The parameters that it can be traded for.
        with: Vec<usize>,
    },
}

/// Knowledge of the parameters at the end of a search.
pub(super) struct Statistics {
    pub(super) known: Vec<Known>,
    /// Correlation of each pair by their places; not a number where one of the two has no error.
    pub(super) correlation: Vec<Vec<f64>>,
    /// Standard deviation of a residual \[-\].
    pub(super) deviation: f64,
    /// The correction that is left, in the search.
    pub(super) step: Vec<f64>,
}

/// From residuals and their derivative, a column a parameter.
pub(super) fn statistics(
    (parameters, ranges): (&[Parameter], &[Range]),
    at: &[f64],
    residuals: &[f64],
    jacobian: &[Vec<f64>],
) -> Statistics {
    let rows = residuals.len();
    let norms: Vec<f64> = jacobian.iter().map(|column| norm(column)).collect();
    let (known, free) = held(ranges, at, &norms, rows);
    let mut statistics = Statistics {
        known,
        correlation: vec![vec![f64::NAN; at.len()]; at.len()],
        deviation: norm(residuals) / (rows as f64).sqrt(),
        step: vec![0.0; at.len()],
    };
    if free.is_empty() {
        return statistics;
    }
    let scaled = DMatrix::from_fn(rows, free.len(), |row, k| {
        jacobian[free[k]][row] / norms[free[k]]
    });
    let svd = scaled.svd(true, true);
    let (Some(u), Some(v)) = (&svd.u, &svd.v_t) else {
        return statistics;
    };
    let most = svd.singular_values.max();
    let is_seen = |k: usize| svd.singular_values[k] > NO_EFFECT * most;
    let seen: Vec<usize> = (0..free.len()).filter(|&k| is_seen(k)).collect();
    let squares = norm(residuals).powi(2);
    statistics.deviation = (squares / (rows - seen.len()) as f64).sqrt();
    let along = u.tr_mul(&DVector::from_column_slice(residuals));
    let mut covariance = DMatrix::<f64>::zeros(free.len(), free.len());
    for &k in &seen {
        let value = svd.singular_values[k];
        for i in 0..free.len() {
            statistics.step[free[i]] -= v[(k, i)] * along[k] / value / norms[free[i]];
            for j in 0..free.len() {
                covariance[(i, j)] += v[(k, i)] * v[(k, j)] / (value * value);
            }
        }
    }
    let combined: Vec<Vec<usize>> = (0..free.len())
        .filter(|&k| !is_seen(k))
        .map(|k| {
            (0..free.len())
                .filter(|&i| v[(k, i)].abs() > SHARE)
                .collect()
        })
        .collect();
    let factor = student(rows - seen.len()) * statistics.deviation;
    for (i, &place) in free.iter().enumerate() {
        let others = combined.iter().filter(|set| set.contains(&i)).flatten();
        let mut with: Vec<usize> = others.filter(|&&k| k != i).map(|&k| free[k]).collect();
        with.sort_unstable();
        with.dedup();
        if combined.iter().any(|set| set.contains(&i)) {
            statistics.known[place] = Known::NotDetermined { with };
            continue;
        }
        let slope = parameters[place].slope(at[place]);
        let share = slope.abs() * covariance[(i, i)].sqrt() / norms[place];
        let value = parameters[place].value(at[place]);
        statistics.known[place] = Known::Well {
            error: share * statistics.deviation,
            interval: [value - factor * share, value + factor * share],
        };
    }
    correlate(&mut statistics, &free, &covariance);
    statistics
}

/// Knowledge before any inverse: parameters at bounds or walls, and those that no residual depends on; and the places of the others.
fn held(ranges: &[Range], at: &[f64], norms: &[f64], rows: usize) -> (Vec<Known>, Vec<usize>) {
    let mut known = vec![Known::NotDetermined { with: Vec::new() }; at.len()];
    let mut free = Vec::new();
    for (place, range) in ranges.iter().enumerate() {
        if let Some(end) = range.end_at(at[place]) {
            let upper = end == 1;
            known[place] = if range.is_wall[end] {
                Known::AtWall { upper }
            } else {
                Known::AtBound { upper }
            };
        } else if norms[place] > UNTOUCHED * (rows as f64).sqrt() {
            free.push(place);
        }
    }
    (known, free)
}

/// Correlations of the parameters that are known.
fn correlate(statistics: &mut Statistics, free: &[usize], covariance: &DMatrix<f64>) {
    let is_known = |k: &usize| matches!(statistics.known[free[*k]], Known::Well { .. });
    let known: Vec<usize> = (0..free.len()).filter(is_known).collect();
    for &i in &known {
        for &j in &known {
            let size = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
            statistics.correlation[free[i]][free[j]] = if i == j {
                1.0
            } else {
                covariance[(i, j)] / size
            };
        }
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The factor of the 95 % interval: Student's t that is exceeded by its size with 5 %, at so many degrees of freedom.
fn student(degrees: usize) -> f64 {
    let (mut low, mut high) = (1.0, 20.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if within(middle, degrees) < 0.95 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// The probability that t lies between -t and t: the finite series by θ = atan(t/√n) (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4).
fn within(t: f64, degrees: usize) -> f64 {
    let angle = (t / (degrees as f64).sqrt()).atan();
    let (sin, cos) = angle.sin_cos();
    let is_odd = degrees % 2 == 1;
    let (mut term, mut sum) = (if is_odd { cos } else { 1.0 }, 0.0);
    let mut k = usize::from(is_odd);
    while k + 2 <= degrees {
        sum += term;
        k += 2;
        term *= cos * cos * (k - 1) as f64 / k as f64;
    }
    if is_odd {
        std::f64::consts::FRAC_2_PI * (angle + sin * sum)
    } else {
        sin * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: Student's factor. ORACLE: the printed table of its 97.5 % quantiles (Abramowitz and Stegun 1964, table 26.10).
    #[test]
    fn intervals_take_the_factor_of_the_table() {
        for (degrees, expected) in [
            (1, 12.706),
            (2, 4.303),
            (3, 3.182),
            (4, 2.776),
            (9, 2.262),
            (10, 2.228),
            (30, 2.042),
            (120, 1.980),
        ] {
            let factor = student(degrees);
            assert!((factor - expected).abs() < 6e-4, "{degrees}: {factor}");
        }
    }
}
