//! Times and ratios over rounds.

use std::time::Instant;

/// The time of a piece of work \[ns\].
pub(crate) fn timed<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<f64, E> {
    let clock = Instant::now();
    let result = work()?;
    let time = clock.elapsed().as_secs_f64() * 1e9;
    drop(result);
    Ok(time)
}

/// What one quantity came to, round by round.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Rounds(pub(crate) Vec<f64>);

impl Rounds {
    pub(crate) fn push(&mut self, value: f64) {
        self.0.push(value);
    }

    /// The median; not a number when there are no rounds.
    pub(crate) fn median(&self) -> f64 {
        self.quantile(0.5)
    }

    /// The quartiles: half of the rounds lie between them.
    pub(crate) fn quartiles(&self) -> [f64; 2] {
        [self.quantile(0.25), self.quantile(0.75)]
    }

    fn quantile(&self, share: f64) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        let Some(last) = sorted.len().checked_sub(1) else {
            return f64::NAN;
        };
        let place = share * last as f64;
        let below = sorted[place.floor() as usize];
        let above = sorted[place.ceil() as usize];
        below + place.fract() * (above - below)
    }

    /// A quantity made of two, round by round.
    pub(crate) fn with(&self, other: &Self, make: impl Fn(f64, f64) -> f64) -> Self {
        Self(
            std::iter::zip(&self.0, &other.0)
                .map(|(a, b)| make(*a, *b))
                .collect(),
        )
    }

    /// This quantity over another, round by round.
    pub(crate) fn over(&self, other: &Self) -> Self {
        self.with(other, |a, b| a / b)
    }

    /// A quantity made of this one, round by round.
    pub(crate) fn map(&self, make: impl Fn(f64) -> f64) -> Self {
        Self(self.0.iter().map(|value| make(*value)).collect())
    }
}

/// The exponent p of y ∝ x^p that fits points best: least squares in the logarithms.
pub(crate) fn exponent(points: &[[f64; 2]]) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
    let count = logs.len() as f64;
    let mean = |axis: usize| logs.iter().map(|point| point[axis]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let (mut across, mut along) = (0.0, 0.0);
    for point in &logs {
        across += (point[0] - x) * (point[1] - y);
        along += (point[0] - x).powi(2);
    }
    across / along
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_the_rounds() {
        let rounds = Rounds(vec![4.0, 1.0, 3.0, 2.0, 10.0]);
        assert_eq!((rounds.median(), rounds.quartiles()), (3.0, [2.0, 4.0]));
        assert_eq!(Rounds(vec![1.0, 2.0]).median().to_bits(), 1.5_f64.to_bits());
        assert!(Rounds::default().median().is_nan());
    }

    #[test]
    fn ratios_are_taken_within_a_round() {
        // A machine that is ten times slower in the second round changes no ratio.
        let (a, b) = (Rounds(vec![2.0, 20.0, 2.0]), Rounds(vec![1.0, 10.0, 1.0]));
        assert_eq!(a.over(&b), Rounds(vec![2.0; 3]));
    }

    #[test]
    fn the_exponent_of_a_power_is_found() {
        let points = [1.0, 3.0, 20.0].map(|x: f64| [x, 7.0 * x.powf(1.5)]);
        assert!((exponent(&points) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn failures_pass_through() {
        assert_eq!(timed(|| Err::<(), _>("no")), Err("no"));
        assert!(timed(|| Ok::<_, ()>(1)).unwrap() >= 0.0);
    }
}
