//! The printed table of checks, and the summary as JSON.

use std::fmt::Write as _;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_results::ResultsError;
use igimp_text::short;

use crate::harness::review::Difference;
use crate::harness::study::{Row, Study};

/// The checks of all studies as aligned text, a table under the name of each study, and the sources
/// that their numbers in brackets stand for.
pub(crate) fn checks(studies: &[Study]) -> String {
    let header = [
        "variant", "quantity", "expected", "band", "measured", "verdict", "steps", "iter.",
        "time [s]",
    ];
    let mut text = String::new();
    let mut sources: Vec<String> = Vec::new();
    for study in studies.iter().filter(|study| !study.rows.is_empty()) {
        let mut rows: Vec<Vec<String>> = vec![header.iter().map(|&text| text.to_owned()).collect()];
        for row in &study.rows {
            let (check, run) = (&row.check, &study.runs[row.run]);
            let source = format!("{}: {} ({})", check.source, row.locator, row.oracle);
            let known = sources.iter().position(|known| *known == source);
            let number = known.unwrap_or_else(|| {
                sources.push(source);
                sources.len() - 1
            }) + 1;
            rows.push(vec![
                check.variant.clone(),
                check.quantity.clone(),
                format!("{} [{number}]", short(check.expected)),
                check.band.to_string(),
                short(check.measured),
                verdict(row).to_owned(),
                run.steps.to_string(),
                run.iterations.to_string(),
                format!("{:.1}", run.seconds),
            ]);
        }
        let passed = study.rows.iter().filter(|row| row.pass).count();
        let _ = writeln!(
            text,
            "{}: {passed} of {} met\n{}",
            study.case,
            study.rows.len(),
            aligned(&rows)
        );
    }
    text.push_str("sources\n");
    for (index, source) in sources.iter().enumerate() {
        let _ = writeln!(text, "  [{}] {source}", index + 1);
    }
    text
}

/// The outcome of a check; a negative control says so.
fn verdict(row: &Row) -> &'static str {
    match (row.pass, row.control) {
        (true, false) => "ok",
        (true, true) => "ok, control",
        (false, _) => "MISSED",
    }
}

/// Columns of equal width; numbers are not told apart from words.
fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let widths: Vec<usize> = (0..columns)
        .map(|k| {
            rows.iter()
                .map(|row| row[k].chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut text = String::new();
    for (index, row) in rows.iter().enumerate() {
        let line: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(entry, &width)| format!("{entry:<width$}"))
            .collect();
        text.push_str(line.join("  ").trim_end());
        text.push('\n');
        if index == 0 {
            text.push_str(&"-".repeat(widths.iter().sum::<usize>() + 2 * (columns - 1)));
            text.push('\n');
        }
    }
    text
}

/// Writes `summary.json`: every check and run.
pub(crate) fn write_summary(
    studies: &[Study],
    missed_snapshots: &[Difference],
    out: &Path,
) -> Result<(), CaseError> {
    let cases: Vec<serde_json::Value> = studies
        .iter()
        .map(|study| {
            serde_json::json!({
                "case": study.case,
                "checks": study.rows,
                "runs": study.runs,
            })
        })
        .collect();
    let summary = serde_json::json!({
        "program": "igimp-validation",
        "version": env!("CARGO_PKG_VERSION"),
        "cases": cases,
        "missed_snapshots": missed_snapshots.iter().map(ToString::to_string).collect::<Vec<_>>(),
    });
    let path = out.join("summary.json");
    let text = format!("{summary:#}\n");
    Ok(std::fs::write(&path, text).map_err(|source| ResultsError::File { path, source })?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let rows = [["a", "γH/c_u", "1"], ["bcd", "x", "23"]].map(|row| {
            row.iter()
                .map(|&entry| entry.to_owned())
                .collect::<Vec<_>>()
        });
        assert_eq!(
            aligned(&rows),
            "a    γH/c_u  1\n---------------\nbcd  x       23\n"
        );
    }
}
