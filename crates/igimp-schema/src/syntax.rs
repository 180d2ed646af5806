//! Parses TOML; says in our words what is wrong with it.

pub mod toml_text;

use toml::de::{DeTable, Error};

use super::diagnostic::Problems;
use super::quantity::Quantity;
use super::source::{Place, Source};
use super::text::clip;
use super::tree::{Node, from_document};

/// The tree of a file; reports what is not TOML.
pub fn parse(source: &Source, problems: &mut Problems) -> Node {
    let (document, errors) = DeTable::parse_recoverable(&source.text);
    let mut errors: Vec<&Error> = errors.iter().collect();
    errors.sort_by_key(|error| error.span().map_or(usize::MAX, |span| span.start));
    for error in errors {
        report(source, error, problems);
        // Others upset what follows.
        let is_harmless =
            error.message().starts_with(DUPLICATE) || is_unquoted(error) && !is_key(source, error);
        if !is_harmless {
            break;
        }
    }
    from_document(&document, 0)
}

const UNQUOTED: &str = "string values must be quoted";
const DUPLICATE: &str = "duplicate key";

fn is_unquoted(error: &Error) -> bool {
    error.message().starts_with(UNQUOTED)
}

/// Whether an unquoted text is a key, where a list was not closed.
fn is_key(source: &Source, error: &Error) -> bool {
    let end = error.span().map_or(0, |span| span.end);
    let after = source.text.get(end..).unwrap_or("");
    after.trim_start_matches([' ', '\t']).starts_with('=') || after.starts_with(']')
}

fn report(source: &Source, error: &Error, problems: &mut Problems) {
    let place = error.span().map(|span| Place::new(0, &span));
    let written = place.map_or("", |place| source.slice(place)).trim();
    let shown = clip(written, 40);
    if is_unquoted(error) && is_key(source, error) {
        problems
            .error(place, format!("expected a value, found `{shown}`"))
            .help("is a bracket or a quote missing before it?");
    } else if is_unquoted(error) {
        let problem = problems.error(place, format!("`{shown}` needs quotes"));
        match written {
            "True" | "False" => problem.help(format!("write {}", written.to_lowercase())),
            _ => problem.help(format!("write \"{shown}\"")),
        };
        if Quantity::parse(written).is_err() && written.contains(',') {
            problem.help("numbers have a decimal point, not a comma");
        }
    } else if error.message().starts_with(DUPLICATE) {
        let is_header = place.is_some_and(|place| {
            let line = source.text[..place.start.min(source.text.len())]
                .rsplit('\n')
                .next();
            line.is_some_and(|before| before.trim_start().starts_with('['))
        });
        let problem = problems.error(place, format!("`{shown}` is given twice"));
        if is_header {
            problem.help(format!(
                "join the tables; a list item is written [[{shown}]]"
            ));
        } else {
            problem.help("keep one of them");
        }
    } else {
        let (reason, expected) = match error.message().split_once(", expected ") {
            Some((reason, expected)) => (reason, Some(expected)),
            None => (error.message(), None),
        };
        let problem = problems.error(place, format!("this is not TOML: {reason}"));
        if let Some(expected) = expected.filter(|expected| *expected != "nothing") {
            problem.help(format!("expected {expected}"));
        }
    }
}
