//! The theory and the code: every equation has a number, once and in order, every number that the code
//! cites is there, every equation is cited by the code or its tests, and the names that the table of
//! symbols gives are names of the code.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use super::sources::rust_files;
use crate::failure::Failure;
use crate::metadata::Metadata;

const THEORY: &str = "docs/src/theory.md";

/// Number of an equation: `24`, or `17a` for one that stands between 17 and 18.
type Number = (usize, String);

/// Problems with the numbers and their citations.
pub(super) fn check(metadata: &Metadata, root: &Path) -> Result<Vec<String>, Failure> {
    let theory = read(&root.join(THEORY))?;
    let mut cited: BTreeMap<Number, String> = BTreeMap::new();
    let mut words = BTreeSet::new();
    for member in metadata.members().filter(|member| member.name != "xtask") {
        let mut files = Vec::new();
        rust_files(&member.folder, &mut files)?;
        files.sort();
        for file in files {
            let shown = file
                .strip_prefix(root)
                .unwrap_or(&file)
                .display()
                .to_string();
            let source = read(&file)?;
            for number in citations(&source) {
                cited.entry(number).or_insert_with(|| shown.clone());
            }
            words.extend(source.split(is_no_word).map(str::to_owned));
        }
    }
    let mut problems = problems(&numbers(&theory), &cited);
    let unknown = names(&theory)
        .into_iter()
        .filter(|name| !words.contains(name));
    problems.extend(unknown.map(|name| format!("{THEORY}: there is no `{name}` in the code")));
    Ok(problems)
}

fn is_no_word(c: char) -> bool {
    !c.is_alphanumeric() && c != '_'
}

/// The names in the second column of the table of symbols.
fn names(page: &str) -> Vec<String> {
    let section = page
        .split("\n## ")
        .find(|part| part.starts_with("Symbols\n"));
    let rows = section
        .unwrap_or("")
        .lines()
        .filter(|line| line.starts_with("| $"));
    rows.filter_map(|row| row.split(" | ").nth(1))
        .flat_map(|column| column.split('`').skip(1).step_by(2))
        .flat_map(|name| name.split("::"))
        .map(str::to_owned)
        .collect()
}

fn read(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path)
        .map_err(|error| Failure::input_output(format!("cannot read {}", path.display()), error))
}

/// Problems, from the numbers of the theory and those cited, with a place for each.
fn problems(numbered: &[Number], cited: &BTreeMap<Number, String>) -> Vec<String> {
    let shown = |(number, letter): &Number| format!("{number}{letter}");
    let mut problems = Vec::new();
    for pair in numbered.windows(2) {
        if pair[0] >= pair[1] || pair[1].0 > pair[0].0 + 1 {
            let (before, after) = (shown(&pair[0]), shown(&pair[1]));
            problems.push(format!("{THEORY}: eq. {after} stands after eq. {before}"));
        }
    }
    let known: BTreeSet<&Number> = numbered.iter().collect();
    for (number, place) in cited.iter().filter(|(number, _)| !known.contains(number)) {
        problems.push(format!(
            "{place}: there is no eq. {} in {THEORY}",
            shown(number)
        ));
    }
    for number in numbered.iter().filter(|number| !cited.contains_key(number)) {
        let number = shown(number);
        problems.push(format!(
            "{THEORY}: eq. {number} is cited nowhere in the code or its tests"
        ));
    }
    problems
}

/// The numbers that a page gives with `\tag{...}`.
fn numbers(page: &str) -> Vec<Number> {
    page.split("\\tag{")
        .skip(1)
        .filter_map(|rest| number(rest).map(|(found, _)| found))
        .collect()
}

/// The numbers that comments cite: `eq. 3`, `eqs. 3 and 5`, `eq. 12–15`, `eqs. 31 to 34`. In comments
/// `eq.` is the theory's; those of papers are spelled out.
fn citations(source: &str) -> Vec<Number> {
    let comments: Vec<&str> = source
        .lines()
        .filter_map(|line| line.split_once("//"))
        .map(|(_, comment)| comment.trim_start_matches(['/', '!']).trim())
        .collect();
    let text = comments.join(" ");
    let mut found = Vec::new();
    for mark in ["eq. ", "eqs. "] {
        for (place, _) in text.match_indices(mark) {
            let begins_a_word = !text[..place].ends_with(|c: char| c.is_alphanumeric());
            if begins_a_word {
                found.extend(list(&text[place + mark.len()..]));
            }
        }
    }
    found
}

/// The numbers that a text begins with, ranges filled.
fn list(text: &str) -> Vec<Number> {
    let mut found: Vec<Number> = Vec::new();
    let (mut rest, mut to) = (text, false);
    while let Some((next, after)) = number(rest) {
        if let Some((last, _)) = found.last().filter(|_| to) {
            found.extend((last + 1..next.0).map(|between| (between, String::new())));
        }
        found.push(next);
        let separators = [
            (", ", false),
            (" and ", false),
            (" or ", false),
            (" to ", true),
            ("–", true),
        ];
        let follows = |&&(separator, _): &&(&str, bool)| after.starts_with(separator);
        let Some((separator, is_range)) = separators.iter().find(follows) else {
            break;
        };
        (rest, to) = (&after[separator.len()..], *is_range);
    }
    found
}

/// The number that a text begins with, and what follows it.
fn number(text: &str) -> Option<(Number, &str)> {
    let end = text
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(text.len());
    let (digits, rest) = text.split_at(end);
    let number = digits.parse().ok()?;
    let mut letters = rest.chars();
    let letter = letters.next().filter(char::is_ascii_lowercase);
    match letter {
        Some(letter) if !letters.next().is_some_and(char::is_alphanumeric) => {
            Some(((number, letter.to_string()), &rest[1..]))
        }
        _ => Some(((number, String::new()), rest)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(numbers: &[Number]) -> Vec<String> {
        numbers
            .iter()
            .map(|(number, letter)| format!("{number}{letter}"))
            .collect()
    }

    #[test]
    fn numbers_of_the_theory_are_found() {
        let page = "```math\na = b\n\\tag{1}\n```\nText (1).\n```math\nc\n\\tag{1a}\n```\n\\tag{2}";
        assert_eq!(shown(&numbers(page)), ["1", "1a", "2"]);
    }

    #[test]
    fn names_of_symbols_are_found() {
        let page = "# T\n## Symbols\n\n| symbol | name |\n|---|---|\n\
                    | $`x_p`$ | `x`, `Loads::force` | length |\n## Sources\n| $`y`$ | `no` |\n";
        assert_eq!(names(page), ["x", "Loads", "force"]);
    }

    #[test]
    fn citations_are_found_in_comments_and_across_lines() {
        let source = "//! A force (theory, eqs. 2,\n//! 36 and 38), B-bar (eq. 12–14).\n\
                      let a = \"eq. 5\"; // eq. 17a. Not freq. 7 nor eq. x.\n/// eqs. 31 to 33";
        let mut found = citations(source);
        found.sort();
        assert_eq!(
            shown(&found),
            ["2", "12", "13", "14", "17a", "31", "32", "33", "36", "38"]
        );
    }

    #[test]
    fn gaps_and_unknown_and_idle_numbers_are_reported() {
        let number = |number: usize| (number, String::new());
        let cited = |numbers: &[usize]| -> BTreeMap<Number, String> {
            numbers
                .iter()
                .map(|&n| (number(n), "a.rs".to_owned()))
                .collect()
        };
        let theory = [number(1), number(2)];
        assert_eq!(problems(&theory, &cited(&[1, 2])), [""; 0]);
        assert_eq!(problems(&theory, &cited(&[1])).len(), 1);
        assert_eq!(problems(&theory, &cited(&[1, 2, 3])).len(), 1);
        assert_eq!(problems(&[number(1), number(3)], &cited(&[1, 3])).len(), 1);
        assert_eq!(problems(&[number(2), number(1)], &cited(&[1, 2])).len(), 1);
    }
}
