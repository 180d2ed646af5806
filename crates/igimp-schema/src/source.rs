//! Text of a case file or of an override, and where a byte of it stands.

use std::ops::Range;

use igimp_text::is_odd;

/// A text with its name.
#[derive(Clone, Debug)]
pub struct Source {
    /// File name, or the override as given.
    pub name: String,
    /// The text.
    pub text: String,
    /// Whether it is an override from the command line.
    pub is_override: bool,
    line_starts: Vec<usize>,
}

/// A stretch of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Index of the source: 0 is the file, overrides follow.
    pub source: usize,
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Place {
    /// A stretch of a source.
    pub fn new(source: usize, span: &Range<usize>) -> Self {
        Self {
            source,
            start: span.start,
            end: span.end,
        }
    }

    /// The same stretch moved to the right.
    #[must_use]
    pub fn shifted(self, by: usize) -> Self {
        Self {
            start: self.start + by,
            end: self.end + by,
            ..self
        }
    }
}

/// A line as it is shown, and the stretch of it that is marked.
#[derive(Debug, PartialEq, Eq)]
pub struct Snippet {
    /// Line number from 1.
    pub line: usize,
    /// Column in characters from 1.
    pub column: usize,
    /// The line, tabs expanded, cut when it is long.
    pub text: String,
    /// Characters of `text` before the marks.
    pub indent: usize,
    /// Number of marks.
    pub marks: usize,
}

/// Characters of a line that are shown.
const WIDTH: usize = 120;
/// Spaces shown for a tab.
const TAB: usize = 4;

impl Source {
    /// A source of this name.
    pub fn new(name: &str, text: &str, is_override: bool) -> Self {
        let line_starts = std::iter::once(0)
            .chain(text.match_indices('\n').map(|(at, _)| at + 1))
            .collect();
        Self {
            name: name.to_owned(),
            text: text.to_owned(),
            is_override,
            line_starts,
        }
    }

    /// The text of a stretch; empty when it is not of this text.
    pub fn slice(&self, place: Place) -> &str {
        self.text.get(place.start..place.end).unwrap_or("")
    }

    /// Where a stretch stands and what to show of it.
    pub fn snippet(&self, place: Place) -> Snippet {
        let start = self.boundary(place.start);
        let row = self.line_starts.partition_point(|&at| at <= start) - 1;
        let from = self.line_starts[row];
        let to = self
            .line_starts
            .get(row + 1)
            .map_or(self.text.len(), |&next| next - 1);
        let bom = if row == 0 && self.text.starts_with('\u{feff}') {
            3
        } else {
            0
        };
        let from = from + bom;
        let line = self.text[from..to.max(from)].trim_end_matches('\r');
        let before_bytes = start.saturating_sub(from).min(line.len());
        let end_bytes = self
            .boundary(place.end)
            .saturating_sub(from)
            .min(line.len());
        let before = &line[..before_bytes];
        let marked = &line[before_bytes..end_bytes.max(before_bytes)];
        let column = before.chars().count() + 1;
        let (indent, marks) = (
            shown(before).count(),
            shown(marked.trim_end()).count().max(1),
        );
        let characters: Vec<char> = shown(line).collect();
        let (text, indent) = window(&characters, indent);
        let marks = marks.min(text.chars().count().saturating_sub(indent).max(1));
        Snippet {
            line: row + 1,
            column,
            text,
            indent,
            marks,
        }
    }

    /// The nearest character boundary at or before a byte.
    fn boundary(&self, byte: usize) -> usize {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        byte
    }
}

/// Characters as they are shown: tabs expanded, control characters replaced.
fn shown(text: &str) -> impl Iterator<Item = char> {
    text.chars().flat_map(|c| {
        let (c, times) = match c {
            '\t' => (' ', TAB),
            c if is_odd(c) => ('\u{fffd}', 1),
            c => (c, 1),
        };
        std::iter::repeat_n(c, times)
    })
}

/// The part of a line around a character, with ellipses, and the character's place in it.
fn window(line: &[char], at: usize) -> (String, usize) {
    if line.len() <= WIDTH {
        return (line.iter().collect(), at);
    }
    let first = at.saturating_sub(WIDTH / 2).min(line.len() - WIDTH);
    let last = (first + WIDTH).min(line.len());
    let mut text: String = line[first..last].iter().collect();
    let mut at = at - first;
    if first > 0 {
        text.insert_str(0, "… ");
        at += 2;
    }
    if last < line.len() {
        text.push('…');
    }
    (text, at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, part: &str) -> Snippet {
        let start = text.find(part).unwrap();
        Source::new("a", text, false).snippet(Place::new(0, &(start..start + part.len())))
    }

    #[test]
    fn columns_count_characters_and_tabs_are_expanded() {
        let snippet = at("é = 1\r\n\tφ = \"ünï\" # x\r\n", "\"ünï\"");
        assert_eq!((snippet.line, snippet.column), (2, 6));
        assert_eq!(snippet.text, "    φ = \"ünï\" # x");
        assert_eq!((snippet.indent, snippet.marks), (8, 5));
    }

    #[test]
    fn a_byte_order_mark_takes_no_column() {
        assert_eq!(at("\u{feff}igimp = 1", "igimp").column, 1);
    }

    #[test]
    fn long_lines_are_cut_around_the_mark() {
        let text = format!("{}HERE{}", "a".repeat(500), "b".repeat(500));
        let snippet = at(&text, "HERE");
        assert_eq!(snippet.column, 501);
        let marked: String = snippet.text.chars().skip(snippet.indent).take(4).collect();
        assert_eq!(marked, "HERE");
        assert!(snippet.text.chars().count() < 130);
    }

    #[test]
    fn places_beyond_the_text_do_not_panic() {
        let source = Source::new("a", "é\n", false);
        for (start, end) in [(0, 1), (1, 1), (3, 3), (9, 99), (2, 0)] {
            source.snippet(Place {
                source: 0,
                start,
                end,
            });
        }
    }
}
