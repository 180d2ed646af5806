//! Numbers and lists as messages print them.

/// A number with at most ten significant digits, without idle zeros.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value + 0.0);
    }
    let magnitude = value.abs();
    if !(1e-4..1e9).contains(&magnitude) {
        let text = format!("{value:.9e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trimmed(mantissa));
    }
    let decimals = (9.0 - magnitude.log10().floor()).max(0.0) as usize;
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

/// A point as messages print it.
pub fn point<const D: usize>(point: [f64; D]) -> String {
    format!("({})", point.map(|x| format!("{} m", number(x))).join(", "))
}

/// A whole number in groups of three digits.
pub fn count(value: f64) -> String {
    if !value.is_finite() {
        return "infinitely many".to_owned();
    }
    if value >= 1e15 {
        return number(value);
    }
    let digits = format!("{value:.0}");
    let mut out = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}

/// A text with at most so many characters; the rest is an ellipsis.
pub fn clip(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        text.to_owned()
    } else {
        let head: String = text.chars().take(most.saturating_sub(1)).collect();
        format!("{head}…")
    }
}

/// `1 error`, `2 errors`.
pub fn plural(count: usize, noun: &str) -> String {
    if count == 1 {
        format!("1 {noun}")
    } else {
        format!("{count} {noun}s")
    }
}

/// Names in a row, for messages; a long row is cut.
pub fn row<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<_> = names.into_iter().map(|name| clip(name, 40)).collect();
    match names.len() {
        0 => "none".to_owned(),
        1..=12 => names.join(", "),
        count => format!("{} and {} more", names[..12].join(", "), count - 12),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_plain() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (19.62, "19.62"),
            (24.0, "24"),
            (2.0 / 17.0, "0.1176470588"),
            (1e10, "1e10"),
            (-2.5e-7, "-2.5e-7"),
            (0.1 + 0.2, "0.3"),
            (123_456_789.0, "123456789"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!(count(1_234_567.0), "1 234 567");
    }
}
