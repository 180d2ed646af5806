//! A real server of HyperQueue with two workers, one of them killed.

use std::path::Path;
use std::process::Command;

use crate::study::{Study, printed};

/// A Python that has HyperQueue.
fn python() -> Option<String> {
    let named = std::env::var("IGIMP_HYPERQUEUE").ok();
    let python = named.unwrap_or_else(|| "python3".to_owned());
    let found = Command::new(&python)
        .args(["-c", "import hyperqueue, tomllib"])
        .output();
    found
        .is_ok_and(|output| output.status.success())
        .then_some(python)
}

#[test]
fn a_killed_worker_of_hyperqueue_loses_nothing() {
    let Some(python) = python() else {
        println!(
            "skipped: python3 cannot import hyperqueue (pip install hyperqueue, and IGIMP_HYPERQUEUE names a Python)"
        );
        return;
    };
    let steps = [800, 2500, 400, 400];
    let reference = Study::left_alone("hq-alone", steps);
    let study = Study::new("hq", steps);
    let output = study.igimp(&["sweep", "study.toml", "--to", "hyperqueue"]);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/schedulers/killed_worker.py");
    let output = Command::new(python)
        .arg(script)
        .args(["out/hyperqueue.toml", "2"])
        .current_dir(&study.folder.0)
        .output()
        .unwrap();
    let text = printed(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("killed the worker of task 2"), "{text}");
    // The output of the second begin stands in the task's own log: it replaced that of the first.
    let log = std::fs::read_to_string(study.path("out/hyperqueue-2.out")).unwrap();
    assert!(log.contains("push"), "{log}");
    let output = study.igimp(&["sweep", "study.toml", "--to", "hyperqueue"]);
    assert!(printed(&output).starts_with("all 4 tasks are done"));
    study.is_as(&reference);
}
