//! `cargo xtask bench`: runs the benches and gathers what criterion measured in one table.

mod estimate;
mod table;

use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread::available_parallelism;
use std::time::{Duration, SystemTime};

use crate::failure::{BAD_INPUT, Failure};
use crate::process::{cargo, output, root, status};
use estimate::Measurement;

/// Criterion's flags for a first impression.
const QUICK: [&str; 6] = [
    "--warm-up-time",
    "0.1",
    "--measurement-time",
    "0.3",
    "--sample-size",
    "10",
];

/// What to measure, and how.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Only benches whose name `group/bench/size` matches this regular expression.
    filter: Option<String>,
    /// Short measurements: for a first impression, not for comparisons.
    #[arg(long)]
    quick: bool,
    /// Threads to use; all cores when not given.
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
}

/// Runs the benches, prints the table and writes it.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    // Time stamps of files may lag behind the clock.
    let start = SystemTime::now() - Duration::from_secs(1);
    let threads = arguments.threads.or(available_parallelism().ok());
    let threads = threads.map_or(1, NonZeroUsize::get);
    let mut bench = cargo();
    bench
        .args(["bench", "--package", "igimp-benchmarks", "--"])
        .env("RAYON_NUM_THREADS", threads.to_string());
    if arguments.quick {
        bench.args(QUICK);
    }
    bench.args(&arguments.filter);
    let code = status(&mut bench)?;
    if code != 0 {
        return Ok(code);
    }

    let target = target_directory()?;
    let mut measurements = Vec::new();
    gather(&target.join("criterion"), start, &mut measurements)?;
    if measurements.is_empty() {
        return Err(Failure::new(BAD_INPUT, "no bench has such a name"));
    }
    measurements.sort_by(|a, b| (&a.group, &a.bench, a.size).cmp(&(&b.group, &b.bench, b.size)));

    println!("\n{}", table::text(&measurements));
    let length = if arguments.quick { "short" } else { "full" };
    let note = format!(
        "Time: median of one pass, with its 95 % confidence interval. Cost: time divided by size. \
         Threads: {threads}. Measurement: {length}."
    );
    let markdown = format!("# Benches\n\n{note}\n\n{}", table::markdown(&measurements));
    let folder = target.join("bench");
    write(&folder, "bench.md", &markdown)?;
    write(&folder, "bench.csv", &table::csv(&measurements))?;
    let shown = folder.strip_prefix(root()).unwrap_or(&folder);
    println!(
        "{note}\nWritten to bench.md and bench.csv in {}.",
        shown.display()
    );
    Ok(0)
}

/// Where cargo, and so criterion, puts its files.
fn target_directory() -> Result<PathBuf, Failure> {
    let metadata = output(cargo().args(["metadata", "--no-deps", "--format-version", "1"]))?;
    serde_json::from_str::<serde_json::Value>(&metadata)
        .ok()
        .and_then(|metadata| metadata["target_directory"].as_str().map(PathBuf::from))
        .ok_or_else(|| Failure::input_output("cargo metadata", "names no target directory"))
}

/// Collects the measurements below a folder that were made since `start`.
fn gather(folder: &Path, start: SystemTime, found: &mut Vec<Measurement>) -> Result<(), Failure> {
    let failure = |error| Failure::input_output(format!("cannot read {}", folder.display()), error);
    for entry in fs::read_dir(folder).map_err(failure)? {
        let path = entry.map_err(failure)?.path();
        if !path.is_dir() {
            continue;
        }
        let estimates = path.join("estimates.json");
        let is_new = path.file_name().is_some_and(|name| name == "new");
        if is_new && modified_since(&estimates, start) {
            found.push(Measurement::read(&path.join("benchmark.json"), &estimates)?);
        } else if !is_new {
            gather(&path, start, found)?;
        }
    }
    Ok(())
}

fn modified_since(path: &Path, start: SystemTime) -> bool {
    fs::metadata(path)
        .and_then(|metadata| metadata.modified())
        .is_ok_and(|modified| modified >= start)
}

fn write(folder: &Path, name: &str, content: &str) -> Result<(), Failure> {
    let path = folder.join(name);
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(&path, content))
        .map_err(|error| Failure::input_output(format!("cannot write {}", path.display()), error))
}
