//! The verification matrix of the book: written from the checks' statements and values, and
//! compared with them in every run, so that the page agrees with the code.

use std::fmt::Write as _;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_results::ResultsError;
use igimp_text::short;

use crate::harness::oracle::OracleKind;
use crate::harness::snapshot::within;
use crate::harness::study::{Level, Row, Study};

/// Where the matrix stands in the book, and its marks.
const PAGE: &str = "docs/src/verification.md";
const BEGIN: &str = "<!-- matrix:begin -->";
const END: &str = "<!-- matrix:end -->";
/// Relative difference of two values that tell a reader the same \[-\]. Curves are held closer by
/// snapshots; a search may end in the next interval on another computer.
const SAME: f64 = 1e-2;
/// Factor between two measured values that are held by one limit only, such as a constant of
/// convergence, which hangs on the last digits of a residual \[-\].
const SAME_SIZE: f64 = 2.0;
/// Measured values below this are round-off: errors that are zero by theory.
const ROUND_OFF: f64 = 1e-9;

/// How a negative control begins.
const CONTROL: &str = "**control**: ";
const HEADER: &str = "| variant | quantity | oracle | expected | band | measured |\n\
                      |---|---|---|---|---|---|\n";

/// The cells of a row of the matrix, its oracle as a number in brackets.
fn cells(row: &Row, number: usize) -> [String; 6] {
    let check = &row.check;
    let control = if row.control { CONTROL } else { "" };
    [
        check.variant.clone(),
        check.quantity.clone(),
        format!("{control}{} [{number}]", row.oracle),
        short(check.expected),
        check.band.to_string(),
        measured(check.measured),
    ]
    .map(|cell| cell.replace('|', "\\|"))
}

/// A measured value; of one that is round-off no digit is printed, since it differs between computers.
fn measured(value: f64) -> String {
    if value != 0.0 && value.abs() < ROUND_OFF {
        format!("< {ROUND_OFF:e}")
    } else {
        short(value)
    }
}

/// Source and locator.
fn source(row: &Row) -> String {
    format!("{}: {}", row.check.source, row.locator)
}

/// The sources of a study in the order of its checks, each once.
fn sources(study: &Study) -> Vec<String> {
    let mut sources = Vec::new();
    for source in study.rows.iter().map(source) {
        if !sources.contains(&source) {
            sources.push(source);
        }
    }
    sources
}

/// The rows of a study as the page has them: the cells of the table, and the text of the source.
fn rows(study: &Study) -> Vec<Printed> {
    let sources = sources(study);
    let number = |row: &Row| {
        let place = sources.iter().position(|known| *known == source(row));
        place.map_or(0, |place| place + 1)
    };
    let rows = study.rows.iter().map(|row| Printed {
        case: study.case.to_owned(),
        cells: cells(row, number(row)).to_vec(),
        source: source(row),
    });
    rows.collect()
}

/// How many checks a page has, by kind of oracle.
fn count(rows: &[Printed]) -> String {
    let kinds = [
        OracleKind::Exact,
        OracleKind::LimitAnalysis,
        OracleKind::Theory,
        OracleKind::Published,
        OracleKind::IndependentProgram,
    ];
    let kinds: Vec<String> = kinds
        .iter()
        .map(|kind| {
            let of_kind = |row: &&Printed| row.kind() == kind.to_string();
            format!("{} {kind}", rows.iter().filter(of_kind).count())
        })
        .collect();
    format!(
        "{} checks: {}; of them {} are negative controls.",
        rows.len(),
        kinds.join(", "),
        rows.iter().filter(|row| row.is_control()).count(),
    )
}

/// The checks of a study as a Markdown table under its name.
fn section(study: &Study) -> String {
    let mut text = format!("### {}\n\n{}\n\n{HEADER}", study.case, study.about);
    for row in rows(study) {
        let _ = writeln!(text, "| {} |", row.cells.join(" | "));
    }
    text.push('\n');
    for (index, source) in sources(study).iter().enumerate() {
        let _ = writeln!(text, "- [{}] {source}", index + 1);
    }
    text.push('\n');
    text
}

/// The matrix with sections of studies in place of those that it has under their names. A study that it does not have yet
/// comes behind the one that was run before it, or first.
fn with_sections(matrix: &str, studies: &[Study]) -> String {
    let parts = matrix.split("### ").skip(1);
    let mut sections: Vec<String> = parts.map(|part| format!("### {part}")).collect();
    let place_of = |sections: &[String], case: &str| {
        let title = format!("### {case}\n");
        sections.iter().position(|text| text.starts_with(&title))
    };
    let mut behind = None;
    for study in studies.iter().filter(|study| !study.rows.is_empty()) {
        let text = section(study);
        let place = if let Some(place) = place_of(&sections, study.case) {
            sections[place] = text;
            place
        } else {
            let place = behind.map_or(0, |last: usize| last + 1);
            sections.insert(place, text);
            place
        };
        behind = Some(place);
    }
    let sections = sections.concat();
    format!("{}\n\n{sections}", count(&printed(&sections)))
}

/// A row as the page has it.
#[derive(Debug, PartialEq)]
struct Printed {
    case: String,
    cells: Vec<String>,
    source: String,
}

impl Printed {
    /// The text between brackets in the cell of the oracle.
    fn number(&self) -> Option<&str> {
        let (_, number) = self.cells.get(2)?.rsplit_once('[')?;
        number.strip_suffix(']')
    }

    /// The kind of its oracle.
    fn kind(&self) -> &str {
        let (kind, _) = self.cell(2).rsplit_once(" [").unwrap_or_default();
        kind.strip_prefix(CONTROL).unwrap_or(kind)
    }

    fn is_control(&self) -> bool {
        self.cell(2).starts_with(CONTROL)
    }

    fn cell(&self, number: usize) -> &str {
        self.cells.get(number).map_or("", |cell| cell)
    }

    /// The check's declaration: all but the measured value, and but the number of the source, which is
    /// its place in a list.
    fn declares(&self) -> String {
        let kind = self.cell(2).rsplit_once(" [");
        let rest = [self.cell(3), self.cell(4)].join(" | ");
        format!(
            "{} | {rest} | {}",
            kind.map_or("", |(kind, _)| kind),
            self.source
        )
    }

    /// Whether two rows tell a reader that the same was measured.
    fn measures_like(&self, other: &Self) -> bool {
        // Zero is round-off on some computers.
        let cells = [self, other].map(|row| match row.cell(5) {
            "< 1e-9" => "0",
            cell => cell,
        });
        let has_one_limit = self.cell(4).starts_with(['≤', '≥']);
        match cells.map(str::parse::<f64>) {
            _ if cells[0] == cells[1] => true,
            [Ok(a), Ok(b)] if has_one_limit => (1.0 / SAME_SIZE..=SAME_SIZE).contains(&(a / b)),
            [Ok(_), Ok(_)] => within(cells[0], cells[1], SAME),
            _ => false,
        }
    }
}

/// The rows between the marks.
fn printed(page: &str) -> Vec<Printed> {
    let mut rows: Vec<Printed> = Vec::new();
    let mut case = String::new();
    for line in page.lines() {
        let row = line
            .strip_prefix("| ")
            .and_then(|rest| rest.strip_suffix(" |"));
        let listed = line
            .strip_prefix("- [")
            .and_then(|rest| rest.split_once("] "));
        if let Some(name) = line.strip_prefix("### ") {
            name.clone_into(&mut case);
        } else if let Some((number, source)) = listed {
            let of_source = |row: &&mut Printed| row.case == case && row.number() == Some(number);
            for row in rows.iter_mut().filter(of_source) {
                source.clone_into(&mut row.source);
            }
        } else if let Some(row) = row.filter(|row| !row.starts_with("variant |")) {
            rows.push(Printed {
                case: case.clone(),
                cells: row.split(" | ").map(str::to_owned).collect(),
                source: String::new(),
            });
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

/// Differences of the page from the studies, a line each. Only when all was run is a row
/// missed that no study has.
pub(crate) fn drift(
    studies: &[Study],
    level: Level,
    all_cases: bool,
) -> Result<Vec<String>, CaseError> {
    let path = Path::new(PAGE);
    let page = std::fs::read_to_string(path).map_err(|source| ResultsError::File {
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
    for row in studies.iter().flat_map(rows) {
        let name = format!("{}, {}: {}", row.case, row.cells[0], row.cells[1]);
        let same = |printed: &Printed| {
            printed.case == row.case && printed.cells.get(..2) == row.cells.get(..2)
        };
        let Some(place) = on_page.iter().position(same) else {
            lines.push(format!("{name} is not on the page"));
            continue;
        };
        found[place] = true;
        let page = &on_page[place];
        if !within(&page.declares(), &row.declares(), SAME) {
            let (page, check) = (page.declares(), row.declares());
            lines.push(format!(
                "{name}: the page declares `{page}`, the check `{check}`"
            ));
        }
        if !page.measures_like(&row) {
            let (page, check) = (page.cell(5), row.cell(5));
            lines.push(format!("{name}: the page has {page}, measured is {check}"));
        }
    }
    if complete {
        for (row, _) in on_page.iter().zip(found).filter(|(_, found)| !found) {
            lines.push(format!(
                "{}, {}: {} is on the page and not checked",
                row.case,
                row.cell(0),
                row.cell(1)
            ));
        }
    }
    lines
}

/// Writes the matrix between its marks: all of it, or the sections of the studies that were run.
pub(crate) fn write(studies: &[Study], all_cases: bool) -> Result<(), CaseError> {
    let path = Path::new(PAGE);
    let file = |source| ResultsError::File {
        path: path.to_owned(),
        source,
    };
    let page = std::fs::read_to_string(path).map_err(file)?;
    let Some(old) = between(&page) else {
        let missing = format!("no marks {BEGIN} and {END}");
        return Err(file(std::io::Error::new(
            std::io::ErrorKind::InvalidData,
            missing,
        ))
        .into());
    };
    let kept = if all_cases { "" } else { old };
    let matrix = with_sections(kept, studies);
    let page = page.replacen(old, &format!("\n\n{matrix}"), 1);
    Ok(std::fs::write(path, page).map_err(file)?)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use igimp_model::check::Band;
    use igimp_solver::{MarchReport, Outcome};

    use super::*;
    use crate::harness::oracle::Oracle;
    use crate::harness::study::RunRecord;

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
        let run = study.run(RunRecord::new("h = 1 m", &report, Duration::ZERO));
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
        let on_page = printed(&with_sections("", &studies));
        assert_eq!(on_page.len(), 2);
        assert!(differences(&on_page, &studies, true).is_empty());
        // Another interval of a search is no drift.
        assert!(differences(&on_page, &[study(5.12)], true).is_empty());
    }

    #[test]
    fn a_study_that_is_run_alone_takes_the_place_of_its_section() {
        let others = "1 checks\n\n### before\n\nAbout.\n\n| a | q | theory [1] | 1 | ≤ 2 | 1.5 |\n\n- [1] x\n\n\
                      ### case\n\nOld.\n\n### behind\n\nAbout.\n\n| b | q | exact [1] | 1 | ≤ 2 | 1.5 |\n\n- [1] y\n\n";
        let matrix = with_sections(others, &[study(5.1)]);
        let names: Vec<&str> = matrix
            .lines()
            .filter(|line| line.starts_with("### "))
            .collect();
        assert_eq!(names, ["### before", "### case", "### behind"]);
        assert!(!matrix.contains("Old.") && matrix.contains("About it."));
        let counted = "4 checks: 3 exact, 0 limit analysis, 1 theory, 0 published, 0 independent program; of them 1 are";
        assert!(matrix.starts_with(counted), "{matrix}");
        assert_eq!(with_sections(&matrix, &[study(5.1)]), matrix);
    }

    #[test]
    fn values_with_one_limit_are_held_to_their_size() {
        let row = |measured: &str| Printed {
            case: "case".into(),
            cells: ["", "", "theory [1]", "1", "≤ 100", measured]
                .map(str::to_owned)
                .to_vec(),
            source: String::new(),
        };
        assert!(row("5.1").measures_like(&row("7.9")));
        assert!(!row("5.1").measures_like(&row("15")));
        assert!(!row("5.1").measures_like(&row("-5.1")));
        assert!(row("inf").measures_like(&row("inf")));
        assert!(row("< 1e-9").measures_like(&row("0")));
        assert!(!row("< 1e-9").measures_like(&row("0.1")));
    }

    #[test]
    fn a_page_that_says_otherwise_is_adrift() {
        let on_page = printed(&with_sections("", &[study(5.1)]));
        let changed = differences(&on_page, &[study(5.2)], true);
        assert_eq!(changed.len(), 1, "{changed:?}");
        assert!(changed[0].contains("5.2"), "{changed:?}");
        let gone = differences(&on_page, &[], true);
        assert_eq!(gone.len(), 2, "{gone:?}");
        assert!(differences(&on_page, &[], false).is_empty());
        let new = differences(&[], &[study(5.1)], false);
        assert!(new[0].contains("not on the page"), "{new:?}");
        let other = with_sections("", &[study(5.1)]).replace("eq. 1", "eq. 2");
        let moved = differences(&printed(&other), &[study(5.1)], true);
        assert_eq!(moved.len(), 2, "{moved:?}");
    }
}
