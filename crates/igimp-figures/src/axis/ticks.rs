//! Places of the ticks of an axis, and their labels.
//!
//! Linear axes step by 1, 2 or 5 times a power of ten; very large or small numbers share one factor
//! that is written at the end of the axis. Logarithmic axes mark decades, or 1-2-5 within them when
//! the range is short.

/// The ticks of one axis.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ticks {
    /// Labelled ticks: value on the axis and text.
    pub(crate) major: Vec<(f64, String)>,
    /// Short ticks without a label.
    pub(crate) minor: Vec<f64>,
    /// A factor common to all labels, such as "×10^{6}".
    pub(crate) factor: Option<String>,
}

/// Ticks of a linear axis over `low < high` with at most about `count` intervals.
pub(crate) fn linear(low: f64, high: f64, count: usize) -> Ticks {
    let step = nice_step((high - low) / count.max(1) as f64);
    let mut values = Vec::new();
    let mut index = (low / step - 1e-9).ceil();
    while index * step <= high + 1e-9 * step && values.len() <= 2 * count {
        values.push(index * step);
        index += 1.0;
    }
    let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let exponent = if largest >= 1e5 || (largest > 0.0 && largest < 1e-3) {
        (largest.log10() + 1e-9).floor()
    } else {
        0.0
    };
    let unit = 10.0_f64.powf(exponent);
    let decimals = decimals_of(step / unit);
    let major = values
        .into_iter()
        .map(|v| (v, number(v / unit, decimals)))
        .collect();
    let factor = (exponent != 0.0).then(|| format!("×{}", power_of_ten(exponent)));
    Ticks {
        major,
        minor: Vec::new(),
        factor,
    }
}

/// Ticks of a logarithmic axis over `0 < low < high` with at most about `count` intervals.
pub(crate) fn logarithmic(low: f64, high: f64, count: usize) -> Ticks {
    let (first, last) = (low.log10() - 1e-9, high.log10() + 1e-9);
    let inside = |v: &f64| (first..=last).contains(&v.log10());
    let decades: Vec<f64> = counted(first.floor(), last.floor()).collect();
    let within = |digits: &'static [f64]| {
        decades
            .iter()
            .flat_map(move |k| digits.iter().map(move |d| d * 10.0_f64.powf(*k)))
    };
    let minor: Vec<f64> = within(&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0])
        .filter(inside)
        .collect();
    if last - first < 2.0 {
        let values: Vec<f64> = within(&[1.0, 2.0, 5.0]).filter(inside).collect();
        if values.len() < 2 {
            return Ticks {
                minor,
                ..linear(low, high, count)
            };
        }
        if values.len() <= count + 1 {
            let major = values.into_iter().map(|v| (v, short(v))).collect();
            return Ticks {
                major,
                minor,
                factor: None,
            };
        }
    }
    let exponents: Vec<f64> = counted(first.ceil(), last.floor()).collect();
    let stride = exponents.len().div_ceil(count.max(1) + 1).max(1);
    let major = exponents
        .iter()
        .step_by(stride)
        .map(|&k| (10.0_f64.powf(k), power_of_ten(k)))
        .collect();
    // Over many decades the ticks within each would merge into a bar.
    let whole = || exponents.iter().map(|&k| 10.0_f64.powf(k)).collect();
    let minor = if exponents.len() > 8 { whole() } else { minor };
    Ticks {
        major,
        minor,
        factor: None,
    }
}

/// The whole numbers from `first` to `last`.
fn counted(first: f64, last: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(first), |k| Some(k + 1.0)).take_while(move |&k| k <= last)
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `raw` (> 0).
fn nice_step(raw: f64) -> f64 {
    let unit = 10.0_f64.powf(raw.log10().floor());
    let digit = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|d| d * unit >= raw * (1.0 - 1e-9));
    digit.unwrap_or(10.0) * unit
}

/// Digits behind the point that tell multiples of `step` apart.
fn decimals_of(step: f64) -> usize {
    let mut decimals = 0;
    let mut digit = step;
    while digit < 1.0 - 1e-6 && decimals < 15 {
        digit *= 10.0;
        decimals += 1;
    }
    decimals
}

/// A number with a proper minus sign; zero is just "0".
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if text.bytes().all(|c| matches!(c, b'0' | b'.' | b'-')) {
        return "0".to_owned();
    }
    text.replace('-', "−")
}

/// A positive 1-2-5 number: plain where that is short, as digit times a power of ten elsewhere.
fn short(value: f64) -> String {
    let exponent = (value.log10() + 1e-9).floor();
    if (-3.0..5.0).contains(&exponent) {
        return number(value, decimals_of(value));
    }
    let digit = value / 10.0_f64.powf(exponent);
    if digit < 1.5 {
        power_of_ten(exponent)
    } else {
        format!("{digit:.0}·{}", power_of_ten(exponent))
    }
}

/// "10" with a whole number as its power, in the markup of the labels.
fn power_of_ten(exponent: f64) -> String {
    format!("10^{{{}}}", number(exponent, 0))
}

/// A count with thin spaces between thousands, such as "20 000".
pub(crate) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks
            .major
            .iter()
            .map(|(_, label)| label.as_str())
            .collect()
    }

    #[test]
    fn linear_ticks_step_by_one_two_five() {
        assert_eq!(
            labels(&linear(0.0, 10.0, 5)),
            ["0", "2", "4", "6", "8", "10"]
        );
        assert_eq!(labels(&linear(-0.13, 0.27, 4)), ["−0.1", "0", "0.1", "0.2"]);
        assert_eq!(
            labels(&linear(0.0, 2.4, 5)),
            ["0", "0.5", "1.0", "1.5", "2.0"]
        );
        assert_eq!(
            labels(&linear(17.0, 23.0, 6)),
            ["17", "18", "19", "20", "21", "22", "23"]
        );
    }

    #[test]
    fn large_and_small_numbers_share_a_factor() {
        let ticks = linear(0.0, 1.0e6, 5);
        assert_eq!(labels(&ticks), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(ticks.factor.as_deref(), Some("×10^{6}"));
        let ticks = linear(-4e-5, 4e-5, 4);
        assert_eq!(labels(&ticks), ["−4", "−2", "0", "2", "4"]);
        assert_eq!(ticks.factor.as_deref(), Some("×10^{−5}"));
        assert!(linear(0.0, 0.004, 4).factor.is_none());
    }

    #[test]
    fn long_log_axes_mark_decades() {
        let ticks = logarithmic(3e-4, 20.0, 8);
        assert_eq!(
            labels(&ticks),
            ["10^{−3}", "10^{−2}", "10^{−1}", "10^{0}", "10^{1}"]
        );
        assert!(ticks.minor.iter().any(|v| (v - 0.05).abs() < 1e-12));
        assert_eq!(labels(&logarithmic(1e-12, 1.0, 6)).len(), 7);
    }

    #[test]
    fn short_log_axes_mark_one_two_five() {
        assert_eq!(
            labels(&logarithmic(0.05, 0.5, 6)),
            ["0.05", "0.1", "0.2", "0.5"]
        );
        assert_eq!(
            labels(&logarithmic(1.5e-6, 1.2e-5, 6)),
            ["2·10^{−6}", "5·10^{−6}", "10^{−5}"]
        );
        assert_eq!(
            labels(&logarithmic(2.1, 2.9, 5)),
            ["2.2", "2.4", "2.6", "2.8"]
        );
    }

    #[test]
    fn counts_are_grouped() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(20_000), "20\u{2009}000");
        assert_eq!(grouped(1_234_567), "1\u{2009}234\u{2009}567");
    }
}
