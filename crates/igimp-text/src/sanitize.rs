//! Texts of files on a terminal: titles, names and sources may hold anything.

use std::borrow::Cow;

const REPLACEMENT: char = char::REPLACEMENT_CHARACTER;

/// A text on one line: what a terminal would obey, or what would put its letters in another order, is
/// replaced, and so are ends of lines.
pub fn on_a_line(text: &str) -> Cow<'_, str> {
    replaced(text, is_odd)
}

/// A text on many lines, as [`on_a_line`]; line feeds and tabs stay.
pub fn on_lines(text: &str) -> Cow<'_, str> {
    replaced(text, |c| is_odd(c) && c != '\n' && c != '\t')
}

/// Whether a terminal would obey a character (control), or show others in another order or on another
/// line because of it (marks, embeddings, overrides and isolates of direction; separators).
pub fn is_odd(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{61c}'
                | '\u{200e}'
                | '\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2066}'..='\u{2069}'
        )
}

fn replaced(text: &str, is_odd: impl Fn(char) -> bool + Copy) -> Cow<'_, str> {
    if text.contains(is_odd) {
        Cow::Owned(text.replace(is_odd, REPLACEMENT.encode_utf8(&mut [0; 4])))
    } else {
        Cow::Borrowed(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_all_languages_stay_and_commands_go() {
        let plain = "Böschung, наклон, 斜面, منحدر, γ = 18 kN/m³";
        assert!(matches!(on_a_line(plain), Cow::Borrowed(text) if text == plain));
        let odd = "a\u{1b}[31mb\u{7}c\u{9b}d\u{202e}e\u{2066}f\u{200f}g\u{2028}h\ri\nj\tk";
        assert_eq!(
            on_a_line(odd),
            "a\u{fffd}[31mb\u{fffd}c\u{fffd}d\u{fffd}e\u{fffd}f\u{fffd}g\u{fffd}h\u{fffd}i\u{fffd}j\u{fffd}k"
        );
        assert!(on_lines(odd).ends_with("h\u{fffd}i\nj\tk"));
    }
}
