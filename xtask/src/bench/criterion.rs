//! The criterion benches: running them, and gathering what they left behind.

use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use super::estimate;
use super::row::Row;
use crate::failure::Failure;
use crate::process::{cargo, status};

/// Criterion's flags for a first impression.
const QUICK: [&str; 6] = [
    "--warm-up-time",
    "0.1",
    "--measurement-time",
    "0.3",
    "--sample-size",
    "10",
];

/// Runs the benches and returns their rows in the order of their names, or the exit code of a run
/// that failed.
pub(crate) fn run(
    filter: Option<&str>,
    quick: bool,
    threads: usize,
    target: &Path,
) -> Result<Result<Vec<Row>, u8>, Failure> {
    // Time stamps of files may lag behind the clock.
    let start = SystemTime::now() - Duration::from_secs(1);
    let mut bench = cargo();
    bench
        .args(["bench", "--package", "igimp-benchmarks", "--"])
        .env("RAYON_NUM_THREADS", threads.to_string());
    if quick {
        bench.args(QUICK).env("IGIMP_BENCH_SET", "short");
    }
    bench.args(filter);
    let code = status(&mut bench)?;
    if code != 0 {
        return Ok(Err(code));
    }
    let mut rows = Vec::new();
    let folder = target.join("criterion");
    if folder.is_dir() {
        gather(&folder, start, &mut rows)?;
    }
    rows.sort_by(|a, b| (&a.group, &a.bench, a.size).cmp(&(&b.group, &b.bench, b.size)));
    Ok(Ok(rows))
}

/// Collects the measurements below a folder that were made since `start`.
fn gather(folder: &Path, start: SystemTime, found: &mut Vec<Row>) -> Result<(), Failure> {
    let failure = |error| Failure::input_output(format!("cannot read {}", folder.display()), error);
    for entry in fs::read_dir(folder).map_err(failure)? {
        let path = entry.map_err(failure)?.path();
        if !path.is_dir() {
            continue;
        }
        let estimates = path.join("estimates.json");
        let is_new = path.file_name().is_some_and(|name| name == "new");
        if is_new && modified_since(&estimates, start) {
            found.push(estimate::read(&path.join("benchmark.json"), &estimates)?);
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
