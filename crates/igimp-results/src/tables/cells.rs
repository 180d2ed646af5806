//! Text in the cells of CSV files, so that a spreadsheet shows it and does not compute it.

use std::borrow::Cow;

/// A text as a cell: an apostrophe goes before one that a spreadsheet would take for a formula.
/// Numbers stay as they are.
pub fn cell(text: &str) -> Cow<'_, str> {
    if begins_a_formula(text) && text.parse::<f64>().is_err() {
        Cow::Owned(format!("'{text}"))
    } else {
        Cow::Borrowed(text)
    }
}

/// The text of a [`cell`].
pub fn text_of(cell: &str) -> &str {
    match cell.strip_prefix('\'') {
        Some(text) if begins_a_formula(text) => text,
        _ => cell,
    }
}

fn begins_a_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r'])
}

/// A number in a column: ten digits, of times all that there are, for steps may be short beside the time that has passed.
pub(crate) fn number(column: &str, value: f64) -> String {
    if column.starts_with("time") {
        format!("{value:e}")
    } else {
        format!("{value:.9e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_become_text_and_numbers_stay() {
        for (text, written) in [
            ("=HYPERLINK(\"x\")", "'=HYPERLINK(\"x\")"),
            ("+1 lift", "'+1 lift"),
            ("-5 kPa", "'-5 kPa"),
            ("@sum", "'@sum"),
            ("\t=1", "'\t=1"),
            ("-5.000000000e0", "-5.000000000e0"),
            ("+1", "+1"),
            ("-inf", "-inf"),
            ("settlement [m], down +", "settlement [m], down +"),
            ("'quoted'", "'quoted'"),
            ("", ""),
        ] {
            assert_eq!(cell(text), written);
            assert_eq!(text_of(&cell(text)), text);
        }
    }
}
