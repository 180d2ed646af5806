//! The reader of case files: everything that `igimp check` does short of seeding.
//!
//! What must hold, beside that nothing panics:
//!
//! - a file is accepted or refused with at least one error, each with a message;
//! - the place of a message lies within the text that it speaks of, and on whole characters;
//! - messages reach a terminal without control characters;
//! - an accepted case makes its laws;
//! - `igimp explain` prints the same case, and once more the same text.

use igimp_input::{CaseFile, InputError};
use igimp_schema::Diagnostic;

use super::{Verdict, holds};

/// Name of the file in messages.
const NAME: &str = "fuzz.toml";

/// A line of a file that begins so is an override, as `--set` gives it; TOML takes it as a comment.
const OVERRIDE: &str = "#set ";

/// Reads a case file.
///
/// # Errors
/// What does not hold.
pub fn check(bytes: &[u8]) -> Result<Verdict, String> {
    let text = String::from_utf8_lossy(bytes);
    let set = text.lines().filter_map(|line| line.strip_prefix(OVERRIDE));
    let overrides: Vec<String> = set.take(8).map(str::to_owned).collect();
    match CaseFile::from_bytes(NAME, bytes.to_vec(), &overrides) {
        Ok(file) => {
            said_well(file.diagnostics(), &file.warnings(), &text, &overrides)?;
            holds(
                !file.diagnostics().iter().any(|found| found.is_error),
                || "accepted in spite of an error".to_owned(),
            )?;
            for material in &file.case().materials {
                let law = material.law();
                law.map_err(|error| format!("the law of an accepted case: {error}"))?;
            }
            explained(&file)?;
            Ok(Verdict::Accepted)
        }
        Err(InputError::Invalid {
            text: printed,
            errors,
            diagnostics,
        }) => {
            let counted = diagnostics.iter().filter(|found| found.is_error).count();
            holds(
                errors > 0 && (counted == errors || diagnostics.len() == 1000),
                || format!("{errors} errors, of which {counted} are told"),
            )?;
            said_well(&diagnostics, &printed, &text, &overrides)?;
            Ok(Verdict::Refused)
        }
        Err(error @ InputError::File { .. }) => Err(format!("a text in memory: {error}")),
    }
}

/// Messages have words and a place that is there.
fn said_well(
    diagnostics: &[Diagnostic],
    printed: &str,
    file: &str,
    overrides: &[String],
) -> Result<(), String> {
    for found in diagnostics {
        let lines = std::iter::once(&found.message).chain(&found.help);
        for line in lines {
            holds(!line.is_empty() && !line.contains(char::is_control), || {
                format!("a message is empty or holds a control character: {line:?}")
            })?;
        }
        let Some(place) = &found.place else { continue };
        let text = match place.override_number {
            None => Some(file),
            Some(number) => overrides.get(number).map(String::as_str),
        };
        holds(
            text.is_some_and(|text| text.get(place.bytes.clone()).is_some()),
            || {
                format!(
                    "the place {place:?} of `{}` is not in the text",
                    found.message
                )
            },
        )?;
    }
    let is_fine = |c: char| c == '\n' || !c.is_control();
    holds(printed.chars().all(is_fine), || {
        "printed with control characters".to_owned()
    })?;
    let lines = file.lines().count().max(1);
    for place in printed
        .lines()
        .filter_map(|line| line.trim_start().strip_prefix("--> fuzz.toml:"))
    {
        let mut numbers = place
            .split(':')
            .map(|number| number.parse::<usize>().unwrap_or(0));
        let line = numbers.next().unwrap_or(0);
        let column = numbers.next().unwrap_or(0);
        // The end of a text that ends with a line break is at the beginning of the next line.
        holds((1..=lines + 1).contains(&line) && column >= 1, || {
            format!("no such place: {place}")
        })?;
    }
    Ok(())
}

/// The completed file states the same case, and prints the same again.
fn explained(file: &CaseFile) -> Result<(), String> {
    let read = |text: &str| {
        CaseFile::parse(NAME, text, &[])
            .map_err(|error| format!("the explained file is refused: {error}\n{text}"))
    };
    let once = read(&file.explain())?;
    let (before, after) = (format!("{:?}", file.case()), format!("{:?}", once.case()));
    holds(before == after, || {
        format!("explained, another case: {}", difference(&before, &after))
    })?;
    let twice = once.explain();
    let thrice = read(&twice)?.explain();
    holds(twice == thrice, || {
        format!(
            "explained again, another text: {}",
            difference(&twice, &thrice)
        )
    })
}

/// Where two texts part.
fn difference(a: &str, b: &str) -> String {
    let same = std::iter::zip(a.chars(), b.chars())
        .take_while(|(a, b)| a == b)
        .count();
    let around = |text: &str| -> String {
        text.chars()
            .skip(same.saturating_sub(60))
            .take(120)
            .collect()
    };
    format!("{:?} and {:?}", around(a), around(b))
}
