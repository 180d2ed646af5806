//! Prose of the pages: short sentences, and lines that a review can show.

use std::path::Path;

use super::links;
use crate::failure::Failure;

/// Most words of a sentence.
const WORDS: usize = 25;

/// Most characters of a line outside tables.
const CHARACTERS: usize = 140;

/// Sentences and lines of the pages that are too long.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Failure> {
    let mut problems = Vec::new();
    for page in links::documents(root)?.concat() {
        let shown = links::shown(&page, root);
        let found = long(&links::read(&page)?);
        problems.extend(
            found
                .into_iter()
                .map(|(line, problem)| format!("{shown}:{line}: {problem}")),
        );
    }
    Ok(problems)
}

/// The lines of a page with a sentence or a line that is too long. Code, formulas, tables, headings and generated text do not count.
fn long(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let (mut in_code, mut is_generated) = (false, false);
    let (mut paragraph, mut first) = (String::new(), 1);
    for (number, line) in (1..).zip(text.lines().chain([""])) {
        let trimmed = line.trim();
        let is_mark = trimmed.starts_with("<!--");
        if is_mark {
            let begins = trimmed.contains("begin") || trimmed.contains("generated: ");
            is_generated = begins && !trimmed.contains("end -->");
        }
        let is_fence = trimmed.starts_with("```");
        let is_other = in_code
            || is_fence
            || is_generated
            || trimmed.starts_with(['|', '#', '<'])
            || trimmed.starts_with("![");
        in_code ^= is_fence;
        if is_other || trimmed.is_empty() || begins_item(trimmed) {
            let sentences = long_sentences(&paragraph).into_iter();
            found.extend(sentences.map(|(words, begin)| {
                (
                    first,
                    format!("{words} words in the sentence \"{begin} ...\""),
                )
            }));
            paragraph.clear();
        }
        if !is_other {
            if line.chars().count() > CHARACTERS {
                found.push((
                    number,
                    format!("a line of more than {CHARACTERS} characters"),
                ));
            }
            if paragraph.is_empty() {
                first = number;
            }
            paragraph.push(' ');
            paragraph.push_str(trimmed);
        }
    }
    found
}

/// Whether a line begins an item of a list.
fn begins_item(line: &str) -> bool {
    let number = line.trim_start_matches(|c: char| c.is_ascii_digit());
    line.starts_with("- ")
        || line.starts_with("* ")
        || number.len() < line.len() && number.starts_with(". ")
}

/// Number of words and beginning of the sentences of a paragraph with too many words. A piece of code or a formula is a word, the
/// address of a link is none.
fn long_sentences(paragraph: &str) -> Vec<(usize, String)> {
    let plain = without_addresses(&without_code(paragraph));
    let mut found = Vec::new();
    let mut sentence: Vec<&str> = Vec::new();
    let mut tokens = plain.split_whitespace().peekable();
    while let Some(token) = tokens.next() {
        sentence.push(token);
        let ends = token
            .trim_end_matches(['*', '"', ')'])
            .ends_with(['.', '!', '?', ':']);
        let begins = (tokens.peek()).is_none_or(|next| !next.starts_with(char::is_lowercase));
        let is_last = tokens.peek().is_none();
        if is_last || ends && begins && !is_abbreviation(token) {
            let is_word = |token: &&&str| token.chars().any(char::is_alphanumeric);
            let words = sentence.iter().filter(is_word).count();
            if words > WORDS {
                found.push((words, sentence[..6].join(" ")));
            }
            sentence.clear();
        }
    }
    found
}

/// Whether a word ends with the point of an abbreviation.
fn is_abbreviation(word: &str) -> bool {
    let word = word.trim_start_matches(['(', '[']);
    [
        "eq.", "eqs.", "fig.", "no.", "vol.", "p.", "pp.", "e.g.", "i.e.", "al.",
    ]
    .contains(&word)
}

/// A text with each piece of code, formulas among them, replaced by a word.
fn without_code(text: &str) -> String {
    let pieces = text.split('`').enumerate();
    pieces
        .map(|(index, piece)| {
            if index % 2 == 0 {
                piece.trim_matches('$')
            } else {
                "X"
            }
        })
        .collect()
}

/// A text with the names of links alone.
fn without_addresses(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("](") {
        plain.push_str(before);
        rest = after.split_once(')').map_or("", |(_, behind)| behind);
    }
    plain + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    // GOAL: sentences are counted as a reader counts them.
    // ORACLE: by hand.
    #[test]
    fn long_sentences_and_lines_are_found() {
        let words = |count: usize| vec!["word"; count].join(" ");
        let sentence = |count: usize| format!("{}.", words(count));
        for (text, found) in [
            (sentence(WORDS), false),
            (sentence(WORDS + 1), true),
            (
                format!("{} A{}", sentence(WORDS), sentence(WORDS - 1)),
                false,
            ),
            (format!("{}\n\n{}", words(20), words(20)), false),
            (format!("{}\n{}", words(20), words(20)), true),
            (format!("- {}\n- {}", words(20), words(20)), false),
            (format!("| {} |", words(40)), false),
            (format!("```text\n{}\n```", words(40)), false),
            (
                format!("<!-- a:begin -->\n{}\n<!-- a:end -->", words(40)),
                false,
            ),
            (format!("{} (eq. 7) {}.", words(20), words(6)), true),
            (
                format!("{} $`a + b = c`$ [the page](a b c d.md).", words(22)),
                false,
            ),
        ] {
            let long: Vec<String> = long(&text)
                .into_iter()
                .map(|(_, problem)| problem)
                .collect();
            let sentences = long.iter().filter(|note| note.contains("words")).count();
            assert_eq!(sentences, usize::from(found), "{text}: {long:?}");
        }
        assert!(long(&"x".repeat(CHARACTERS)).is_empty());
        assert_eq!(long(&format!("\n{}", "x".repeat(CHARACTERS + 1)))[0].0, 2);
        assert!(long(&format!("|{}|", "x".repeat(CHARACTERS))).is_empty());
    }
}
