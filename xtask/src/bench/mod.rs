//! `cargo xtask bench`: runs benches and survey, and writes one report.

mod compare;
mod criterion;
mod estimate;
mod machine;
mod report;
mod row;
mod survey;
mod table;

use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread::available_parallelism;

use crate::failure::{BAD_INPUT, Failure};
use crate::process::{cargo, output, root};
use compare::{Comparison, is_name};
use report::Report;
use row::Row;
use survey::Survey;

/// The start of the names of all that the survey measures.
const SURVEY: &str = "survey";

/// What to measure, and how.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Only benches whose name `group/bench/size` matches this regular expression, and parts of the
    /// survey, such as `survey/cost`, whose name contains it.
    ///
    /// A name of a group, by itself or before a slash, builds and runs the program of that group only.
    filter: Option<String>,
    /// Short measurements and small sizes: for a first impression, not for comparisons.
    #[arg(long)]
    quick: bool,
    /// Threads to compare with one; two when not given, or one where there is but one core.
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    /// Keep the results under this name, for `--against`.
    #[arg(long, value_name = "NAME", value_parser = name)]
    save: Option<String>,
    /// Compare with the results that were kept under this name.
    #[arg(long, value_name = "NAME", value_parser = name)]
    against: Option<String>,
}

/// A name that a file can have.
fn name(text: &str) -> Result<String, String> {
    if is_name(text) {
        Ok(text.to_owned())
    } else {
        Err("a name is made of letters, digits, `-`, `_` and `.`".to_owned())
    }
}

/// Runs benches and survey, prints the tables and writes the report.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let target = target_directory()?;
    let folder = target.join("bench");
    let saved = folder.join("saved");
    // Asked for before the measurement, which takes minutes.
    let against = arguments.against.as_ref();
    let earlier = against.map(|name| read_saved(&saved, name)).transpose()?;

    let cores = available_parallelism().map_or(1, NonZeroUsize::get);
    let threads = arguments.threads.map_or(cores.min(2), NonZeroUsize::get);
    let (filter, quick) = (arguments.filter.as_deref(), arguments.quick);
    let mut surveys = None;
    if survey::is_asked_for(filter) {
        match survey::build()? {
            Ok(program) => surveys = Some(program),
            Err(code) => return Ok(code),
        }
    }
    let mut rows = Vec::new();
    if !filter.is_some_and(|filter| filter.starts_with(SURVEY)) {
        match criterion::run(filter, quick, threads, &target)? {
            Ok(found) => rows = found,
            Err(code) => return Ok(code),
        }
    }
    let mut survey = Survey::default();
    if let Some(program) = &mut surveys {
        match survey::run(program, filter, quick, threads, &folder.join(SURVEY))? {
            Ok(found) => survey = found,
            Err(code) => return Ok(code),
        }
    }
    rows.extend_from_slice(&survey.rows);
    if rows.is_empty() {
        return Err(Failure::new(BAD_INPUT, "no bench has such a name"));
    }

    let comparison = std::iter::zip(against, earlier)
        .map(|(name, earlier)| Comparison::new(name, &rows, &earlier))
        .next();
    let side_by_side = fs::read_to_string(folder.join("compare.md")).ok();
    let report = Report {
        machine: &machine::line(),
        note: &note(arguments, threads),
        survey: &survey,
        side_by_side: side_by_side.as_deref(),
        rows: &rows,
        against: comparison.as_ref(),
    };
    print(&report);
    write(&folder, "bench.md", &report.markdown())?;
    let ratios = comparison.as_ref().map(|comparison| &*comparison.ratios);
    write(&folder, "bench.csv", &row::csv(&rows, ratios))?;
    if let Some(name) = &arguments.save {
        write(&saved, &format!("{name}.csv"), &row::csv(&rows, None))?;
    }
    let shown = folder.strip_prefix(root()).unwrap_or(&folder);
    println!("Written to bench.md and bench.csv in {}.", shown.display());
    Ok(0)
}

/// How it was measured.
fn note(arguments: &Arguments, threads: usize) -> String {
    let threads = match threads {
        1 => "1".to_owned(),
        several => format!("1 and {several}"),
    };
    let length = if arguments.quick { "short" } else { "full" };
    let filter = arguments.filter.as_ref();
    let filter = filter.map_or(String::new(), |filter| format!(" Filter: `{filter}`."));
    format!("Threads: {threads}. Measurement: {length}.{filter}")
}

/// The report for a terminal.
fn print(report: &Report<'_>) {
    println!("\n{}\n{}\n", report.machine, report.note);
    print!("{}", report.survey.tables);
    println!("{}", table::text(report.rows, report.against));
    if let Some(comparison) = report.against {
        println!("{}", comparison.verdict(report.rows));
    }
}

/// The rows that were kept under a name.
fn read_saved(saved: &Path, name: &str) -> Result<Vec<Row>, Failure> {
    let path = saved.join(format!("{name}.csv"));
    let text = fs::read_to_string(&path).map_err(|error| {
        let action = format!("cannot read {} (`--save {name}` writes it)", path.display());
        Failure::input_output(action, error)
    })?;
    row::parse(&text).map_err(|error| Failure::input_output(path.display(), error))
}

/// Where cargo, and so criterion, puts its files.
fn target_directory() -> Result<PathBuf, Failure> {
    let metadata = output(cargo().args(["metadata", "--no-deps", "--format-version", "1"]))?;
    serde_json::from_str::<serde_json::Value>(&metadata)
        .ok()
        .and_then(|metadata| metadata["target_directory"].as_str().map(PathBuf::from))
        .ok_or_else(|| Failure::input_output("cargo metadata", "names no target directory"))
}

fn write(folder: &Path, name: &str, content: &str) -> Result<(), Failure> {
    let path = folder.join(name);
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(&path, content))
        .map_err(|error| Failure::input_output(format!("cannot write {}", path.display()), error))
}
