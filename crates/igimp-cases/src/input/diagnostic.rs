//! Problems found in a case file, collected and printed together in the order of the file.

use std::fmt::Write;

use super::source::{Place, Source};
use super::text::plural;

/// Whether the case can be run all the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Severity {
    /// It cannot.
    Error,
    /// It can.
    Warning,
}

/// One problem.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Problem {
    severity: Severity,
    message: String,
    place: Option<Place>,
    help: Vec<String>,
}

impl Problem {
    /// Adds a line of help.
    pub(super) fn help(&mut self, text: impl Into<String>) -> &mut Self {
        self.help.push(text.into());
        self
    }
}

/// Problems in the order in which they were found.
#[derive(Clone, Debug, Default)]
pub(super) struct Problems {
    list: Vec<Problem>,
}

/// Problems that are printed.
const MOST: usize = 50;

impl Problems {
    /// Reports an error.
    pub(super) fn error(
        &mut self,
        place: impl Into<Option<Place>>,
        message: impl Into<String>,
    ) -> &mut Problem {
        self.add(Severity::Error, place.into(), message.into())
    }

    /// Reports a warning.
    pub(super) fn warning(
        &mut self,
        place: impl Into<Option<Place>>,
        message: impl Into<String>,
    ) -> &mut Problem {
        self.add(Severity::Warning, place.into(), message.into())
    }

    fn add(&mut self, severity: Severity, place: Option<Place>, message: String) -> &mut Problem {
        let at = self.list.len();
        self.list.push(Problem {
            severity,
            message,
            place,
            help: Vec::new(),
        });
        &mut self.list[at]
    }

    /// Number of errors.
    pub(super) fn errors(&self) -> usize {
        self.list
            .iter()
            .filter(|problem| problem.severity == Severity::Error)
            .count()
    }

    /// All problems and a line that counts them; empty when there are none.
    pub(super) fn render(&self, sources: &[Source]) -> String {
        let mut list: Vec<&Problem> = Vec::with_capacity(self.list.len());
        for problem in &self.list {
            if !list.contains(&problem) {
                list.push(problem);
            }
            if list.len() > 20 * MOST {
                break;
            }
        }
        // Problems of the whole file come last, like those of a missing table.
        list.sort_by_key(|problem| (problem.place.is_none(), problem.place, problem.severity));
        if list.is_empty() {
            return String::new();
        }
        let mut out = String::new();
        for problem in list.iter().take(MOST) {
            problem.render(sources, &mut out);
            out.push('\n');
        }
        if list.len() > MOST {
            out.push_str("further problems are not shown\n");
        }
        let errors = self.errors();
        let warnings = self.list.len() - errors;
        let count = match (errors, warnings) {
            (0, warnings) => plural(warnings, "warning"),
            (errors, 0) => plural(errors, "error"),
            (errors, warnings) => format!(
                "{} and {}",
                plural(errors, "error"),
                plural(warnings, "warning")
            ),
        };
        let file = sources.first().map_or("", |source| &source.name);
        let _ = writeln!(out, "{count} in {file}");
        out
    }
}

impl Problem {
    fn render(&self, sources: &[Source], out: &mut String) {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let _ = writeln!(out, "{severity}: {}", self.message);
        let mut gutter = String::new();
        match self
            .place
            .and_then(|place| Some((place, sources.get(place.source)?)))
        {
            Some((place, source)) => {
                let snippet = source.snippet(place);
                let (head, number, prefix) = if source.is_override {
                    ("command line".to_owned(), String::new(), "--set ")
                } else {
                    let head = format!("{}:{}:{}", source.name, snippet.line, snippet.column);
                    (head, snippet.line.to_string(), "")
                };
                gutter = " ".repeat(number.len().max(1));
                let width = gutter.len();
                let marks = "^".repeat(snippet.marks);
                let indent = " ".repeat(snippet.indent + prefix.len());
                let _ = writeln!(out, "{gutter}--> {head}");
                let _ = writeln!(out, "{gutter} |");
                let _ = writeln!(out, "{number:width$} | {prefix}{}", snippet.text.trim_end());
                let _ = writeln!(out, "{gutter} | {indent}{marks}");
            }
            None => {
                let file = sources.first().map_or("", |source| &source.name);
                gutter.push(' ');
                let _ = writeln!(out, "{gutter}--> {file}");
            }
        }
        for line in &self.help {
            let _ = writeln!(out, "{gutter} = help: {line}");
        }
    }
}
