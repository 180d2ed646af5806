//! Runs into folders that are interrupted and taken up, and whether they leave the same files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use igimp_cases::run::{Event, Run, Start, Target, run};
use igimp_input::CaseFile;
use igimp_model::Case;
use igimp_results::folder::overwrite_guard::Replace;
use igimp_results::summary::{StageOutcome, Summary};
use serde_json::Value;

/// A folder that is not there yet.
pub(crate) fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    path
}

/// Runs a case into a folder; with a number of steps until it is interrupted.
pub(crate) fn run_into<const D: usize>(
    (file, case): (&CaseFile, &Case<D>),
    folder: &Path,
    start: Start,
    steps: Option<usize>,
) -> Run<D> {
    let target = Target {
        replace: Replace::Everything,
        ..Target::of(file, folder)
    };
    let interrupt = AtomicBool::new(false);
    let mut taken = 0;
    let mut listener = |event: &Event<'_, D>| {
        if matches!(event, Event::Equilibrium { .. }) {
            taken += 1;
            if Some(taken) == steps {
                interrupt.store(true, Ordering::Relaxed);
            }
        }
    };
    run(case, Some(&target), start, &mut listener, &interrupt).unwrap()
}

#[track_caller]
pub(crate) fn assert_done(summary: &Summary) {
    for stage in &summary.stages {
        let (name, reason) = (&stage.name, &stage.reason);
        assert_eq!(stage.outcome, StageOutcome::Completed, "{name}: {reason}");
    }
}

/// Every file that does not depend on the hour, and the arrays of the ends of stages.
pub(crate) fn everything(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(root, &path, files);
            } else {
                let name = path.strip_prefix(root).unwrap().to_path_buf();
                files.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    let mut files = BTreeMap::new();
    collect(root, root, &mut files);
    files.retain(|path, _| {
        let text = path.to_string_lossy();
        let depends = ["checkpoint/step-", "meta.json", "report.html", ".igimp"];
        !depends.iter().any(|part| text.contains(part))
    });
    if let Some(bytes) = files.get_mut(Path::new("summary.json")) {
        let mut summary: Value = serde_json::from_slice(bytes).unwrap();
        let whole = summary.as_object_mut().unwrap();
        whole.retain(|key, _| {
            !key.contains("seconds") && !key.contains("memory") && key != "estimate"
        });
        for stage in whole["stages"].as_array_mut().unwrap() {
            let row = stage.as_object_mut().unwrap();
            row.retain(|key, _| key != "seconds" && key != "phases");
        }
        *bytes = summary.to_string().into_bytes();
    }
    files
}

#[track_caller]
pub(crate) fn assert_equal(
    expected: &BTreeMap<PathBuf, Vec<u8>>,
    found: &BTreeMap<PathBuf, Vec<u8>>,
    why: &str,
) {
    let names: Vec<_> = expected.keys().chain(found.keys()).collect();
    for name in names {
        assert!(
            expected.get(name) == found.get(name),
            "{why}: {} differs",
            name.display()
        );
    }
}
