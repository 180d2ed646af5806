//! Median, quantile and largest of a few numbers.

/// The smallest number that at least a share of all do not exceed; not a number if there is none.
pub(crate) fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (share * sorted.len() as f64).ceil() as usize;
    let place = rank.saturating_sub(1);
    sorted.get(place).copied().unwrap_or(f64::NAN)
}

/// Median, 90 % quantile and largest.
pub(crate) fn spread(values: &[f64]) -> [f64; 3] {
    [0.5, 0.9, 1.0].map(|share| quantile(values, share))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: quantiles of few numbers.
    /// ORACLE: by hand.
    #[test]
    fn quantiles_are_members() {
        let values: Vec<f64> = (1..=10).rev().map(f64::from).collect();
        assert_eq!(
            spread(&values).map(f64::to_bits),
            [5.0, 9.0, 10.0].map(f64::to_bits)
        );
        assert_eq!(quantile(&[3.0], 0.5).to_bits(), 3.0_f64.to_bits());
        assert!(quantile(&[], 0.5).is_nan());
    }
}
