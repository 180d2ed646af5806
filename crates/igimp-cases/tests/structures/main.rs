//! GOAL: rigid bodies and reinforcement, from case file to results.

#[path = "../common/edits.rs"]
mod edits;
#[path = "../common/messages.rs"]
mod messages;

mod active_wall;
mod closing;
mod deep_push;
mod held_wall;
mod reinforcement;
mod rigid;
mod rigid_results;
mod rigid_room;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use igimp_cases::run::{Nobody, Run, Start, Target, run};
use igimp_input::CaseFile;

use crate::edits::{Edits, edited};

/// Messages on a file, its name and its text, after each edit on its own.
fn messages_of_each(file: (&str, &str), edits: Edits<'_>) -> String {
    let each: Vec<Edits<'_>> = edits.chunks(1).collect();
    messages::messages(file, &each)
}

/// A case, its name and its text, run into a folder of the build with pictures and a report.
fn with_report((name, text): (&str, &str), folder: &str) -> (PathBuf, Run<2>) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    let _ = fs::remove_dir_all(&folder);
    let edits = [
        ("figures = []", "figures = [\"displacement\"]"),
        ("report = false", "report = true"),
    ];
    let file = CaseFile::parse(name, &edited(text, &edits), &[]).unwrap();
    let target = Target::of(&file, &folder);
    let goes_on = AtomicBool::new(false);
    let run = run(
        file.case(),
        Some(&target),
        Start::Afresh,
        &mut Nobody,
        &goes_on,
    )
    .unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    (folder, run)
}
