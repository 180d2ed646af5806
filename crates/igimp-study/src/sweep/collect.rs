//! One table of all tasks: their settings, their ends and what was asked for.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use igimp_results::atomic::write_whole;
use igimp_results::summary::Summary;
use igimp_results::tables::cells::cell;
use igimp_text::{on_a_line, short};

use super::columns::{Column, column};
use super::{Record, Sweep, SweepError, Task};

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
    /// Names asked for that no task has.
    pub unknown: Vec<String>,
}

/// Reads what the tasks of a study found, as far as they ran.
pub fn collect(sweep: &Sweep) -> Collected {
    let found: Vec<Option<Vec<(String, f64)>>> = sweep
        .tasks
        .iter()
        .map(|task| results(task, &sweep.collect))
        .collect();
    let mut columns: Vec<String> = Vec::new();
    for (name, _) in found.iter().flatten().flatten() {
        if !columns.contains(name) {
            columns.push(name.clone());
        }
    }
    let unknown = sweep
        .collect
        .iter()
        .filter(|&name| found.iter().any(Option::is_some) && !columns.iter().any(|c| is(c, name)))
        .cloned()
        .collect();
    let parameters: Vec<Column> = std::iter::zip(&sweep.keys, 0..)
        .map(|(key, k)| {
            let values = sweep.tasks.iter().map(|task| task.values[k].as_str());
            column(key, &values.collect::<Vec<_>>())
        })
        .collect();
    let rows = sweep
        .tasks
        .iter()
        .zip(&found)
        .enumerate()
        .map(|(place, (task, found))| row(place, task, &parameters, found.as_deref(), &columns))
        .collect();
    let missing = sweep
        .tasks
        .iter()
        .zip(&found)
        .filter(|(_, found)| found.is_none())
        .map(|(task, _)| task.number)
        .collect();
    let mut header = vec!["task".to_owned()];
    header.extend(parameters.iter().map(|one| one.header.clone()));
    header.push("end".to_owned());
    header.extend(columns);
    header.push("message".to_owned());
    Collected {
        header,
        rows,
        numbers: parameters.into_iter().map(|one| one.numbers).collect(),
        missing,
        unknown,
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
    place: usize,
    task: &Task,
    parameters: &[Column],
    found: Option<&[(String, f64)]>,
    columns: &[String],
) -> Vec<String> {
    let record = Record::read(&task.folder);
    let (end, message) = record.map_or_else(
        || ("missing".to_owned(), String::new()),
        |record| (record.ending.to_string(), record.message),
    );
    let mut row = vec![task.number.to_string()];
    row.extend(parameters.iter().map(|one| one.cells[place].clone()));
    row.push(end);
    row.extend(columns.iter().map(|column| {
        found
            .and_then(|found| found.iter().find(|(name, _)| name == column))
            .map_or_else(String::new, |(_, value)| value.to_string())
    }));
    row.push(message);
    row
}

/// Named results of a task; `None` without a readable summary.
fn results(task: &Task, wanted: &[String]) -> Option<Vec<(String, f64)>> {
    let text = std::fs::read_to_string(task.folder.join("summary.json")).ok()?;
    let summary: Summary = serde_json::from_str(&text).ok()?;
    let mut found = safety(&summary);
    for row in &summary.checks {
        found.push((row.check.quantity.clone(), row.check.measured));
    }
    found.extend(curve_ends(&task.folder.join("curves")));
    found.retain(|(name, _)| wanted.is_empty() || wanted.iter().any(|wanted| is(name, wanted)));
    Some(found)
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
