//! Problems found in a case file, collected and printed together in the order of the file.

use std::borrow::Cow;
use std::fmt::Write;
use std::ops::Range;

use igimp_text::on_a_line;

use super::source::{Place, Source};
use super::text::plural;

/// Whether the case can be run all the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// It cannot.
    Error,
    /// It can.
    Warning,
}

/// One problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    severity: Severity,
    message: String,
    place: Option<Place>,
    help: Vec<String>,
}

impl Problem {
    /// Adds a line of help.
    pub fn help(&mut self, text: impl Into<String>) -> &mut Self {
        self.help.push(printable(text.into()));
        self
    }
}

/// A problem of a case file, in one place of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Whether the case cannot be run; a warning otherwise.
    pub is_error: bool,
    /// The problem, in the words of the file.
    pub message: String,
    /// Where; none for what concerns the whole file, such as a missing table.
    pub place: Option<DiagnosticPlace>,
    /// Remedies, a line each.
    pub help: Vec<String>,
}

/// A stretch of a case file or of an override.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DiagnosticPlace {
    /// The override by its number from 0; none: the file.
    pub override_number: Option<usize>,
    /// Bytes of its text.
    pub bytes: Range<usize>,
}

impl From<&Problem> for Diagnostic {
    fn from(problem: &Problem) -> Self {
        Self {
            is_error: problem.severity == Severity::Error,
            message: problem.message.clone(),
            place: problem.place.map(|place| DiagnosticPlace {
                override_number: place.source.checked_sub(1),
                bytes: place.start..place.end,
            }),
            help: problem.help.clone(),
        }
    }
}

/// Problems in the order in which they were found.
#[derive(Clone, Debug, Default)]
pub struct Problems {
    list: Vec<Problem>,
    errors: usize,
    warnings: usize,
    /// Takes the help of a problem that is not kept.
    spare: Option<Problem>,
}

/// Problems that are printed.
const MOST: usize = 50;
/// Problems that are kept.
const KEPT: usize = 1000;

impl Problems {
    /// Reports an error.
    pub fn error(
        &mut self,
        place: impl Into<Option<Place>>,
        message: impl Into<String>,
    ) -> &mut Problem {
        self.add(Severity::Error, place.into(), message.into())
    }

    /// Reports a warning.
    pub fn warning(
        &mut self,
        place: impl Into<Option<Place>>,
        message: impl Into<String>,
    ) -> &mut Problem {
        self.add(Severity::Warning, place.into(), message.into())
    }

    fn add(&mut self, severity: Severity, place: Option<Place>, message: String) -> &mut Problem {
        let message = printable(message);
        let problem = Problem {
            severity,
            message,
            place,
            help: Vec::new(),
        };
        let is_same = |other: &Problem| other.place == place && other.message == problem.message;
        if self.list.iter().take(KEPT).any(is_same) {
            return self.spare.insert(problem);
        }
        match severity {
            Severity::Error => self.errors += 1,
            Severity::Warning => self.warnings += 1,
        }
        if self.list.len() >= KEPT {
            return self.spare.insert(problem);
        }
        let at = self.list.len();
        self.list.push(problem);
        &mut self.list[at]
    }

    /// Number of errors.
    pub fn errors(&self) -> usize {
        self.errors
    }

    /// Whether there are so many that help with another one is not worth its while.
    pub fn are_many(&self) -> bool {
        self.list.len() >= 2 * MOST
    }

    /// The problems that are kept, in the order in which they were found.
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        self.list.iter().map(Diagnostic::from).collect()
    }

    /// All problems and a line that counts them; empty when there are none.
    pub fn render(&self, sources: &[Source]) -> String {
        if self.list.is_empty() {
            return String::new();
        }
        let mut list: Vec<&Problem> = self.list.iter().collect();
        // Problems of the whole file come last, like those of a missing table.
        list.sort_by_key(|problem| (problem.place.is_none(), problem.place, problem.severity));
        let mut out = String::new();
        for problem in list.iter().take(MOST) {
            problem.render(sources, &mut out);
            out.push('\n');
        }
        if list.len() > MOST {
            out.push_str("further problems are not shown\n");
        }
        let count = match (self.errors, self.warnings) {
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

/// A text of a file in a message, without what a terminal would obey.
fn printable(text: String) -> String {
    let clean = match on_a_line(&text) {
        Cow::Borrowed(_) => None,
        Cow::Owned(clean) => Some(clean),
    };
    clean.unwrap_or(text)
}

impl Problem {
    fn render(&self, sources: &[Source], out: &mut String) {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let _ = writeln!(out, "{severity}: {}", self.message);
        let mut gutter = String::new();
        let place = self
            .place
            .and_then(|place| Some((place, sources.get(place.source)?)));
        if let Some((place, source)) = place {
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
            let text = snippet.text.trim_end();
            let _ = writeln!(out, "{gutter}--> {head}");
            let _ = writeln!(out, "{gutter} |");
            let _ = writeln!(out, "{number:width$} | {prefix}{text}");
            let _ = writeln!(out, "{gutter} | {indent}{marks}");
        } else {
            let file = sources.first().map_or("", |source| &source.name);
            gutter.push(' ');
            let _ = writeln!(out, "{gutter}--> {file}");
        }
        for line in &self.help {
            let _ = writeln!(out, "{gutter} = help: {line}");
        }
    }
}
