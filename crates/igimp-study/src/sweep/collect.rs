//! One table of all tasks: their settings, their ends and the columns asked for.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use igimp_results::atomic::write_whole;
use igimp_results::summary::Summary;
use igimp_results::tables::cells::cell;
use igimp_text::{on_a_line, short};

use super::columns::{Column, column};
use super::record::fingerprint;
use super::{Record, Sweep, SweepError, Task};

/// Message of a task whose results are outdated.
const OUTDATED: &str = "its results are those of another case or of other settings";

/// The table of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Collected {
    /// Column headers: task, parameters, end, results, message.
    pub header: Vec<String>,
    /// A row a task, as text; empty cells are not known.
    pub rows: Vec<Vec<String>>,
    /// Of each parameter the numbers of its rows, if its values are numbers or quantities.
    pub numbers: Vec<Option<Vec<f64>>>,
    /// Tasks without results.
    pub missing: Vec<usize>,
    /// Tasks whose results are those of another case or of other settings: their values are left out.
    pub outdated: Vec<usize>,
    /// Why results were not held against the case, where it cannot be read.
    pub unchecked: Option<String>,
    /// Names asked for that no task has.
    pub unknown: Vec<String>,
}

/// The state of a task.
struct Standing {
    /// How it ended, in a word.
    end: String,
    message: String,
    /// Named results; none without a readable summary, and none where they are outdated.
    found: Option<Vec<(String, f64)>>,
    /// Whether its results are those of another case or of other settings.
    is_outdated: bool,
}

/// Reads the results of the tasks of a study, as far as they ran with the case and settings that they have now.
pub fn collect(sweep: &Sweep) -> Collected {
    let mut unchecked = None;
    let standing: Vec<Standing> = sweep
        .tasks
        .iter()
        .map(|task| {
            let file = sweep.case_of(task);
            let print = file.map(|file| fingerprint(&file));
            let print = print.map_err(|error| unchecked.get_or_insert_with(|| error.to_string()));
            Standing::of(task, print.ok().as_deref(), &sweep.collect)
        })
        .collect();
    let mut columns: Vec<String> = Vec::new();
    for (name, _) in standing.iter().flat_map(|state| &state.found).flatten() {
        if !columns.contains(name) {
            columns.push(name.clone());
        }
    }
    let some = standing.iter().any(|state| state.found.is_some());
    let unknown = sweep
        .collect
        .iter()
        .filter(|&name| some && !columns.iter().any(|c| is(c, name)))
        .cloned()
        .collect();
    let parameters: Vec<Column> = std::iter::zip(&sweep.keys, 0..)
        .map(|(key, k)| {
            let values = sweep.tasks.iter().map(|task| task.values[k].as_str());
            column(key, &values.collect::<Vec<_>>())
        })
        .collect();
    let rows = std::iter::zip(&sweep.tasks, &standing)
        .enumerate()
        .map(|(place, (task, state))| row((place, task), &parameters, state, &columns))
        .collect();
    let numbers_where = |holds: fn(&Standing) -> bool| {
        let tasks = std::iter::zip(&sweep.tasks, &standing);
        let those = tasks.filter(|(_, state)| holds(state));
        those.map(|(task, _)| task.number).collect()
    };
    let mut header = vec!["task".to_owned()];
    header.extend(parameters.iter().map(|one| one.header.clone()));
    header.push("end".to_owned());
    header.extend(columns);
    header.push("message".to_owned());
    Collected {
        header,
        rows,
        numbers: parameters.into_iter().map(|one| one.numbers).collect(),
        missing: numbers_where(|state| state.found.is_none() && !state.is_outdated),
        outdated: numbers_where(|state| state.is_outdated),
        unchecked,
        unknown,
    }
}

impl Standing {
    /// That of a task; `print` is the fingerprint of its case as it is now, where it can be read.
    fn of(task: &Task, print: Option<&str>, wanted: &[String]) -> Self {
        let record = Record::read(&task.folder);
        let is_outdated = match (&record, print) {
            (Some(record), Some(print)) => record.fingerprint != print,
            _ => false,
        };
        let (end, message) = match record {
            _ if is_outdated => ("outdated".to_owned(), OUTDATED.to_owned()),
            None => ("missing".to_owned(), String::new()),
            Some(record) => (record.ending.to_string(), record.message),
        };
        let found = || results(task, wanted);
        Self {
            end,
            message,
            found: (!is_outdated).then(found).flatten(),
            is_outdated,
        }
    }
}

impl Collected {
    /// Writes `results.csv` into a folder, which is made.
    ///
    /// # Errors
    /// [`SweepError::File`] and [`SweepError::Table`].
    pub fn write(&self, folder: &Path) -> Result<PathBuf, SweepError> {
        std::fs::create_dir_all(folder).map_err(|source| SweepError::File {
            path: folder.to_owned(),
            source,
        })?;
        let path = folder.join("results.csv");
        let text = || -> Result<Vec<u8>, csv::Error> {
            let mut writer = csv::Writer::from_writer(Vec::new());
            for row in std::iter::once(&self.header).chain(&self.rows) {
                writer.write_record(row.iter().map(|text| cell(text).into_owned()))?;
            }
            let text = writer.into_inner();
            text.map_err(|error| error.into_error().into())
        };
        let text = text().map_err(|source| SweepError::Table {
            path: path.clone(),
            source,
        })?;
        write_whole(&path, text)?;
        Ok(path)
    }

    /// The table as aligned text, numbers with four digits; messages only if there are any.
    pub fn to_text(&self) -> String {
        let shown = |text: &String| {
            let number = text.parse::<f64>().ok().filter(|_| text.len() > 6);
            number.map_or_else(|| on_a_line(text).into_owned(), short)
        };
        let mut lines = vec![self.header.clone()];
        lines.extend(self.rows.iter().map(|row| row.iter().map(shown).collect()));
        if self
            .rows
            .iter()
            .all(|row| row.last().is_some_and(String::is_empty))
        {
            for line in &mut lines {
                line.pop();
            }
        }
        aligned(&lines)
    }
}

/// Rows as aligned columns, two blanks apart.
pub fn aligned(lines: &[Vec<String>]) -> String {
    let columns = lines.iter().map(Vec::len).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns)
        .map(|column| {
            let cells = lines.iter().filter_map(|line| line.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        })
        .collect();
    let mut text = String::new();
    for line in lines {
        for (cell, width) in line.iter().zip(&widths) {
            let _ = write!(text, "{cell:<width$}  ");
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
    }
    text
}

fn row(
    (place, task): (usize, &Task),
    parameters: &[Column],
    state: &Standing,
    columns: &[String],
) -> Vec<String> {
    let mut row = vec![task.number.to_string()];
    row.extend(parameters.iter().map(|one| one.cells[place].clone()));
    row.push(state.end.clone());
    row.extend(columns.iter().map(|column| {
        let mut found = state.found.iter().flatten();
        found
            .find(|(name, _)| name == column)
            .map_or_else(String::new, |(_, value)| value.to_string())
    }));
    row.push(state.message.clone());
    row
}

/// Named results of a task; `None` without a readable summary.
fn results(task: &Task, wanted: &[String]) -> Option<Vec<(String, f64)>> {
    let summary = summary(&task.folder)?;
    let mut found = safety(&summary);
    for row in summary.checks.iter().filter(|row| row.is_reached()) {
        let name = row.check.quantity.clone();
        found.push(match &row.check.unit {
            Some(unit) => (
                format!("{name} [{}]", unit.name),
                row.check.measured / unit.in_si,
            ),
            None => (name, row.check.measured),
        });
    }
    found.extend(curve_ends(&task.folder.join("curves")));
    found.retain(|(name, _)| wanted.is_empty() || wanted.iter().any(|wanted| is(name, wanted)));
    Some(found)
}

/// The summary in a folder, if there is a readable one.
pub(super) fn summary(folder: &Path) -> Option<Summary> {
    let text = std::fs::read_to_string(folder.join("summary.json")).ok()?;
    serde_json::from_str(&text).ok()
}

/// Middle and ends of the interval of each factor of safety; the stage is named when there are
/// several.
fn safety(summary: &Summary) -> Vec<(String, f64)> {
    let stages: Vec<_> = summary
        .stages
        .iter()
        .filter_map(|stage| Some((&stage.name, stage.safety.as_ref()?)))
        .collect();
    let mut found = Vec::new();
    for (name, safety) in &stages {
        let prefix = if stages.len() > 1 {
            format!("factor_of_safety ({name})")
        } else {
            "factor_of_safety".to_owned()
        };
        if let (Some(stable), Some(failed)) = (safety.stable, safety.failed) {
            found.push((prefix.clone(), 0.5 * (stable + failed)));
        }
        for (end, value) in [("stable", safety.stable), ("failed", safety.failed)] {
            if let Some(value) = value {
                found.push((format!("{prefix}: {end}"), value));
            }
        }
    }
    found
}

/// The last ordinate of each curve; its last column is the ordinate.
fn curve_ends(folder: &Path) -> Vec<(String, f64)> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|end| end == "csv"))
        .collect();
    files.sort();
    files.iter().filter_map(|path| curve_end(path)).collect()
}

fn curve_end(path: &Path) -> Option<(String, f64)> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_path(path)
        .ok()?;
    let name = path.file_stem()?.to_string_lossy();
    let column = reader.headers().ok()?.iter().next_back()?.to_owned();
    let last = reader.records().filter_map(Result::ok).last()?;
    let value = last.iter().next_back()?.trim().parse().ok()?;
    Some((format!("{name}: {column}"), value))
}

/// Whether a column belongs to a name asked for: the name itself, or its part before a colon or a
/// bracket.
fn is(column: &str, wanted: &str) -> bool {
    column.strip_prefix(wanted).is_some_and(|rest| {
        rest.is_empty()
            || [": ", " (", " ["]
                .iter()
                .any(|start| rest.starts_with(start))
    })
}
