//! The criterion benches: running them, and gathering their files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::estimate;
use super::row::Row;
use crate::failure::Failure;
use crate::process::status;
use crate::released::cargo_for_released;

/// The programs of the benches, and the groups that each of them measures.
const PROGRAMS: [(&str, &[&str]); 5] = [
    ("assembly", &["assembly", "set_up", "linearise", "space"]),
    ("basis", &["basis"]),
    ("factorisation", &["factorisation"]),
    ("return_map", &["return_map", "lift_small", "lift_finite"]),
    ("whole_step", &["whole_step"]),
];

/// Where criterion keeps the newest measurement of a bench.
const ESTIMATES: &str = "new/estimates.json";

/// Criterion's flags for a first impression.
const QUICK: [&str; 6] = [
    "--warm-up-time",
    "0.1",
    "--measurement-time",
    "0.3",
    "--sample-size",
    "10",
];

/// The programs that a filter needs: of the group that its part before the first slash names, or all where
/// that is another regular expression.
fn programs(filter: Option<&str>) -> Vec<&'static str> {
    let group = filter.and_then(|filter| filter.split('/').next());
    let of = |group: &str| PROGRAMS.iter().find(|(_, groups)| groups.contains(&group));
    match group.and_then(of) {
        Some((program, _)) => vec![program],
        None => PROGRAMS.iter().map(|(program, _)| *program).collect(),
    }
}

/// Runs the benches and returns their rows in the order of their names, or the exit code of a run
/// that failed.
pub(crate) fn run(
    filter: Option<&str>,
    quick: bool,
    threads: usize,
    target: &Path,
) -> Result<Result<Vec<Row>, u8>, Failure> {
    let folder = target.join("criterion");
    let before = stamps(&folder);
    let mut bench = cargo_for_released("bench");
    for program in programs(filter) {
        bench.args(["--bench", program]);
    }
    bench
        .arg("--")
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
    gather(&folder, &before, &mut rows)?;
    rows.sort_by(|a, b| (&a.group, &a.bench, a.size).cmp(&(&b.group, &b.bench, b.size)));
    Ok(Ok(rows))
}

/// Time stamps of the measurements below a folder. They are told apart and never ordered, so that a
/// clock that jumps does no harm.
fn stamps(folder: &Path) -> BTreeMap<PathBuf, SystemTime> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(stamps(&path));
        } else if path.ends_with(ESTIMATES)
            && let Ok(modified) = entry.metadata().and_then(|metadata| metadata.modified())
        {
            found.insert(path, modified);
        }
    }
    found
}

/// Collects the measurements below a folder whose time stamps are not those of `before`.
fn gather(
    folder: &Path,
    before: &BTreeMap<PathBuf, SystemTime>,
    found: &mut Vec<Row>,
) -> Result<(), Failure> {
    for (estimates, modified) in stamps(folder) {
        if before.get(&estimates) != Some(&modified) {
            let path = estimates.parent().unwrap_or(folder);
            found.push(estimate::read(&path.join("benchmark.json"), &estimates)?);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::root;

    /// GOAL: only the program of a group is built and run, and every program where the filter is no group.
    /// ORACLE: the names of files and groups in the sources of the benches.
    #[test]
    fn the_programs_are_those_of_the_benches() {
        let mut files = Vec::new();
        for entry in fs::read_dir(root().join("benchmarks/benches")).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let text = fs::read_to_string(&path).unwrap();
            let (_, groups) = PROGRAMS.iter().find(|of| of.0 == name).unwrap();
            for group in *groups {
                assert!(text.contains(&format!("\"{group}\"")), "{name}: {group}");
            }
            for (place, call) in text.match_indices("benchmark_group(\"") {
                let rest = &text[place + call.len()..];
                let group = rest.split('"').next().unwrap();
                assert!(groups.contains(&group), "{name}: {group}");
            }
            files.push(name);
        }
        files.sort();
        assert_eq!(programs(None), files);
        assert_eq!(programs(Some("set_up/stencils")), ["assembly"]);
        assert_eq!(programs(Some("von-mises|tresca")), files);
    }

    /// GOAL: a bench that ran while the clock went back is found, one that did not run is not.
    #[test]
    fn a_measurement_is_new_whatever_its_time_is() {
        let root = std::env::temp_dir().join(format!("igimp-stamps-{}", std::process::id()));
        for bench in ["a", "b/c"] {
            let folder = root.join(bench).join("new");
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join("estimates.json"), "{}").unwrap();
            fs::write(folder.join("sample.json"), "{}").unwrap();
        }
        let before = stamps(&root);
        assert_eq!(before.len(), 2);
        let ran = root.join("b/c/new/estimates.json");
        let file = fs::File::options().write(true).open(&ran).unwrap();
        file.set_modified(SystemTime::UNIX_EPOCH).unwrap();
        let after = stamps(&root);
        let new = after
            .iter()
            .filter(|(path, time)| before.get(*path) != Some(*time));
        assert_eq!(new.map(|(path, _)| path).collect::<Vec<_>>(), [&ran]);
        fs::remove_dir_all(&root).unwrap();
    }
}
