//! The survey: a program of its own that measures what no single bench can say.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::row::{self, Row};
use crate::failure::Failure;
use crate::process::status;
use crate::released::released;

/// The parts of the survey.
const PARTS: [&str; 7] = [
    "survey/step",
    "survey/motion",
    "survey/cost",
    "survey/factorisation",
    "survey/growth",
    "survey/memory",
    "survey/space",
];

/// The results of a survey.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Survey {
    /// Its tables, in Markdown.
    pub(crate) tables: String,
    /// Its rows.
    pub(crate) rows: Vec<Row>,
    /// Whether it drew the growth of times with size.
    pub(crate) has_plot: bool,
}

/// Whether a filter asks for a part of the survey.
pub(crate) fn is_asked_for(filter: Option<&str>) -> bool {
    filter.is_none_or(|filter| PARTS.iter().any(|part| part.contains(filter)))
}

/// Builds the survey as the benches are, so that what does not compile shows before minutes of measurement; the program, or the exit
/// code of a build that failed.
pub(crate) fn build() -> Result<Result<Command, u8>, Failure> {
    released("bench", "survey")
}

/// Runs the survey with a folder for its files, or returns the exit code of a run that failed.
pub(crate) fn run(
    survey: &mut Command,
    filter: Option<&str>,
    quick: bool,
    threads: usize,
    folder: &Path,
) -> Result<Result<Survey, u8>, Failure> {
    let plot = folder.join("growth.svg");
    if plot.exists() {
        fs::remove_file(&plot).map_err(|error| {
            Failure::input_output(format!("cannot remove {}", plot.display()), error)
        })?;
    }
    survey
        .args(["--filter", filter.unwrap_or(""), "--folder"])
        .arg(folder)
        .env("RAYON_NUM_THREADS", threads.to_string());
    if quick {
        survey.arg("--quick");
    }
    let code = status(survey)?;
    if code != 0 {
        return Ok(Err(code));
    }
    let text = |name: &str| {
        let path = folder.join(name);
        fs::read_to_string(&path).map_err(|error| {
            Failure::input_output(format!("cannot read {}", path.display()), error)
        })
    };
    let rows = row::parse(&text("rows.csv")?)
        .map_err(|error| Failure::input_output("the rows of the survey", error))?;
    Ok(Ok(Survey {
        tables: text("tables.md")?,
        rows,
        has_plot: plot.exists(),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::root;

    /// GOAL: the survey is built and run where one of its parts is asked for, and else left alone.
    /// ORACLE: the names of the parts in its source.
    #[test]
    fn the_parts_are_those_of_the_survey() {
        let source = root().join("benchmarks/src/bin/survey/main.rs");
        let text = fs::read_to_string(source).unwrap();
        let named = text.match_indices("(\"survey/").map(|(place, _)| {
            let rest = &text[place + 2..];
            rest.split('"').next().unwrap()
        });
        assert_eq!(named.collect::<Vec<_>>(), PARTS);
        assert!(
            is_asked_for(None) && is_asked_for(Some("survey/cost")) && is_asked_for(Some("space"))
        );
        assert!(!is_asked_for(Some("assembly")) && !is_asked_for(Some("von-mises")));
    }
}
