//! The verification matrix of the book: written from what the checks declare and measure, and
//! compared with them in every run, so that the page cannot say what the code does not.

use std::fmt::Write as _;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_cases::check::short;

use crate::snapshot::within;
use crate::study::{Level, Row, Study};

/// Where the matrix stands in the book, and its marks.
const PAGE: &str = "docs/src/verification.md";
const BEGIN: &str = "<!-- matrix:begin -->";
const END: &str = "<!-- matrix:end -->";
/// Relative difference of two measured values that print the same matrix: the page has four digits,
/// the last of which may flip \[-\].
const PRINTED: f64 = 2e-3;

const HEADER: &str = "| variant | quantity | oracle | source and locator | expected | band | measured |\n\
                      |---|---|---|---|---|---|---|\n";

/// The cells of a row of the matrix.
fn cells(row: &Row) -> [String; 7] {
    let check = &row.check;
    let oracle = if row.control {
        format!("**control**: {}", row.oracle)
    } else {
        row.oracle.to_string()
    };
    [
        check.variant.clone(),
        check.quantity.clone(),
        oracle,
        format!("{}: {}", check.source, row.locator),
        short(check.expected),
        check.band.to_string(),
        short(check.measured),
    ]
    .map(|cell| cell.replace('|', "\\|"))
}

/// The checks of each study as a Markdown table under its name.
fn text(studies: &[Study]) -> String {
    let mut text = String::new();
    for study in studies.iter().filter(|study| !study.rows.is_empty()) {
        let _ = write!(text, "### {}\n\n{}\n\n{HEADER}", study.case, study.about);
        for row in &study.rows {
            let _ = writeln!(text, "| {} |", cells(row).join(" | "));
        }
        text.push('\n');
    }
    text
}

/// A row as the page has it: its case and its cells.
type Printed = (String, Vec<String>);

/// The rows between the marks.
fn printed(page: &str) -> Vec<Printed> {
    let mut case = String::new();
    let mut rows = Vec::new();
    for line in page.lines() {
        if let Some(name) = line.strip_prefix("### ") {
            name.clone_into(&mut case);
        } else if let Some(inner) = line
            .strip_prefix("| ")
            .and_then(|rest| rest.strip_suffix(" |"))
            && !line.starts_with("| variant |")
        {
            rows.push((
                case.clone(),
                inner.split(" | ").map(str::to_owned).collect(),
            ));
        }
    }
    rows
}

/// Everything between the marks of a page.
fn between(page: &str) -> Option<&str> {
    let begin = page.find(BEGIN)? + BEGIN.len();
    let end = page.find(END)?;
    page.get(begin..end)
}

/// What the page says otherwise than the studies, a line each. Only when all was run is a row
/// missed that no study has.
pub(crate) fn drift(
    studies: &[Study],
    level: Level,
    all_cases: bool,
) -> Result<Vec<String>, CaseError> {
    let path = Path::new(PAGE);
    let page = std::fs::read_to_string(path).map_err(|source| CaseError::File {
        path: path.to_owned(),
        source,
    })?;
    let on_page = printed(between(&page).unwrap_or_default());
    let complete = level == Level::Full && all_cases;
    Ok(differences(&on_page, studies, complete))
}

fn differences(on_page: &[Printed], studies: &[Study], complete: bool) -> Vec<String> {
    let mut lines = Vec::new();
    let mut found = vec![false; on_page.len()];
    for study in studies {
        for row in &study.rows {
            let cells = cells(row);
            let place = on_page
                .iter()
                .position(|(case, printed)| case == study.case && printed[..2] == cells[..2]);
            let name = format!("{}, {}: {}", study.case, cells[0], cells[1]);
            let Some(place) = place else {
                lines.push(format!("{name} is not on the page"));
                continue;
            };
            found[place] = true;
            let printed = &on_page[place].1;
            if printed.len() != cells.len()
                || !within(&printed.join(" "), &cells.join(" "), PRINTED)
            {
                lines.push(format!(
                    "{name}: the page has `{}`, the check has `{}`",
                    printed[2..].join(" | "),
                    cells[2..].join(" | "),
                ));
            }
        }
    }
    if complete {
        for ((case, printed), _) in on_page.iter().zip(found).filter(|(_, found)| !found) {
            lines.push(format!(
                "{case}, {}: {} is on the page and not checked",
                printed[0], printed[1]
            ));
        }
    }
    lines
}

/// Writes the matrix between its marks.
pub(crate) fn write(studies: &[Study]) -> Result<(), CaseError> {
    let path = Path::new(PAGE);
    let file = |source| CaseError::File {
        path: path.to_owned(),
        source,
    };
    let page = std::fs::read_to_string(path).map_err(file)?;
    let Some(old) = between(&page) else {
        let missing = format!("no marks {BEGIN} and {END}");
        return Err(file(std::io::Error::new(
            std::io::ErrorKind::InvalidData,
            missing,
        )));
    };
    let page = page.replacen(old, &format!("\n\n{}", text(studies)), 1);
    std::fs::write(path, page).map_err(file)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use igimp_cases::check::Band;
    use igimp_solver::{MarchReport, Outcome};

    use super::*;
    use crate::oracle::{Oracle, OracleKind};
    use crate::study::Run;

    const ORACLE: Oracle = Oracle {
        kind: OracleKind::Exact,
        source: "somebody",
        locator: "eq. 1",
    };

    fn study(measured: f64) -> Study {
        let folder = std::env::temp_dir().join("igimp-matrix-test");
        let mut study = Study::new("case", "About it.", &folder).unwrap();
        let report = MarchReport {
            outcome: Outcome::Completed,
            steps: Vec::new(),
            failures: Vec::new(),
        };
        let run = study.run(Run::new("h = 1 m", &report, Duration::ZERO));
        study.check(
            run,
            "N [-]",
            ORACLE.says(5.0),
            Band::Relative(0.1),
            measured,
        );
        study.control(run, "M | N", ORACLE.says(5.0), Band::AtLeast(6.0), 7.0);
        study
    }

    #[test]
    fn a_page_that_was_written_is_not_adrift() {
        let studies = [study(5.1)];
        let on_page = printed(&text(&studies));
        assert_eq!(on_page.len(), 2);
        assert!(differences(&on_page, &studies, true).is_empty());
        // A digit that flips is no drift.
        assert!(differences(&on_page, &[study(5.1001)], true).is_empty());
    }

    #[test]
    fn a_page_that_says_otherwise_is_adrift() {
        let on_page = printed(&text(&[study(5.1)]));
        let changed = differences(&on_page, &[study(5.2)], true);
        assert_eq!(changed.len(), 1, "{changed:?}");
        assert!(changed[0].contains("5.2"), "{changed:?}");
        let gone = differences(&on_page, &[], true);
        assert_eq!(gone.len(), 2, "{gone:?}");
        assert!(differences(&on_page, &[], false).is_empty());
        let new = differences(&[], &[study(5.1)], false);
        assert!(new[0].contains("not on the page"), "{new:?}");
    }
}
