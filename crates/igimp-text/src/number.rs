//! Numbers as a reader wants them.

/// A number with four significant digits, plain where that is readable.
pub fn short(value: f64) -> String {
    let magnitude = value.abs();
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    if (0.01..10_000.0).contains(&magnitude) {
        let decimals = (3.0 - magnitude.log10().floor()).max(0.0);
        let text = format!("{value:.*}", decimals as usize);
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.3e}")
    }
}

/// Two numbers with three decimals, or with as many more as tell them apart.
pub fn told_apart(low: f64, high: f64) -> [String; 2] {
    let mut decimals = 3;
    loop {
        let both = [low, high].map(|value| format!("{value:.decimals$}"));
        if both[0] != both[1] || decimals == MOST_DECIMALS {
            return both;
        }
        decimals += 1;
    }
}

/// Decimals of numbers that nothing tells apart.
const MOST_DECIMALS: usize = 7;

/// A count with thin gaps between thousands, as in `1 310`.
pub fn count(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(4.3571e-4), "4.357e-4");
        assert_eq!(short(5.141_592), "5.142");
        assert_eq!(short(1.4), "1.4");
        assert_eq!(short(1234.6), "1235");
        assert_eq!(short(0.0), "0");
    }

    /// GOAL: the ends of an interval are told apart, and three decimals are kept where they do. ORACLE: by hand.
    #[test]
    fn ends_of_intervals_are_told_apart() {
        assert_eq!(told_apart(1.3, 1.302), ["1.300", "1.302"]);
        assert_eq!(told_apart(1.31792, 1.31826), ["1.3179", "1.3183"]);
        assert_eq!(told_apart(0.438_112, 0.438_124), ["0.43811", "0.43812"]);
        assert_eq!(told_apart(1.0, 1.0), ["1.0000000"; 2]);
    }

    #[test]
    fn thousands_are_set_apart() {
        assert_eq!(count(7), "7");
        assert_eq!(count(1310), "1 310");
        assert_eq!(count(1_234_567), "1 234 567");
    }
}
