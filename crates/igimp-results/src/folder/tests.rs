//! GOAL: a folder is laid out and cleared of what igimp wrote, and of nothing else.

use super::*;
use crate::checkpoint::tests::{body, meta};
use crate::folder::provenance::Origin;
use crate::scratch::Scratch;

pub(crate) fn claim_of(case: &str) -> Claim {
    Claim {
        origin: Origin::Text(case.into()),
        title: format!("The case {case}"),
        input: format!("input of {case}"),
    }
}

pub(crate) fn everything(folder: &Folder) {
    for path in [
        folder.summary(),
        folder.report(),
        folder.case(),
        folder.completed_case(),
        folder.convergence(),
        folder.curves().join("a.csv"),
        folder.monitors().join("b.csv"),
        folder.monitors().join(".b.csv.tmp"),
        folder.sections().join("c.csv"),
        folder.rigid().join("footing__1-push.csv"),
        folder.reinforcement().join("nail__1-weight.csv"),
        folder.figures().join("d.svg"),
        folder.figures().join("d.png"),
        folder.paraview().join("particles.pvd"),
        folder.paraview().join("particles_0001.vtu"),
        folder.paraview().join(".particles_0002.vtu.tmp"),
        folder.paraview().join("grid.pvd"),
        folder.paraview().join("grid_12345.vtu"),
        folder.paraview().join("rigid.pvd"),
        folder.paraview().join("rigid_0001.vtu"),
        folder.paraview().join("reinforcement.pvd"),
        folder.paraview().join("reinforcement_0001.vtu"),
        folder
            .paraview()
            .join("stage-02-last-stable-reinforcement.vtu"),
        folder.paraview().join("stage-02-last-stable.vtu"),
        folder.paraview().join("stage-02-last-stable-rigid.vtu"),
        folder.paraview().join("stage-02-first-unstable.vtu"),
    ] {
        fs::write(path, "x").unwrap();
    }
    let states = [("current", &body(3))];
    checkpoint::write(&folder.checkpoint(), "load-1", &states, &meta(), 1).unwrap();
    checkpoint::write(folder.root(), LAST_CONVERGED, &states, &meta(), 1).unwrap();
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn a_new_folder_is_laid_out() {
    let scratch = Scratch::new();
    let root = scratch.path().join("deep/results");
    let folder = Folder::afresh(&root, &claim_of("a.toml")).unwrap();
    assert_eq!(
        scratch.names("deep/results"),
        [
            ".igimp",
            "checkpoint",
            "curves",
            "figures",
            "monitors",
            "paraview",
            "reinforcement",
            "rigid",
            "sections",
            "slip_lines"
        ]
    );
    assert_eq!(folder.root(), root);
    assert!(Folder::open(&root).is_ok());
}

/// GOAL: a further run removes what the one before wrote and nothing of the user's.
#[test]
fn only_our_files_are_cleared() {
    let scratch = Scratch::new();
    let root = scratch.path().join("results");
    let folder = Folder::afresh(&root, &claim_of("a.toml")).unwrap();
    everything(&folder);
    let notes = [
        folder.root().join("notes.txt"),
        folder.root().join("data/a.csv"),
        folder.curves().join("plot.py"),
        folder.figures().join("paper.pdf"),
        folder.paraview().join("view.pvsm"),
        folder.paraview().join("particles_mine.vtu"),
        folder.paraview().join("other.pvd"),
        folder.checkpoint().join("mine/x.npy"),
    ];
    for path in &notes {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "the user's").unwrap();
    }
    assert_eq!(Folder::afresh(&root, &claim_of("a.toml")).unwrap(), folder);
    let mut expected = notes.to_vec();
    expected.extend([folder.root().join(MARKER), folder.case()]);
    expected.sort();
    assert_eq!(files(&root), expected);
}

#[test]
fn a_resumed_run_finds_everything() {
    let scratch = Scratch::new();
    let folder = Folder::afresh(scratch.path(), &claim_of("a.toml")).unwrap();
    everything(&folder);
    let before = files(scratch.path());
    assert_eq!(Folder::open(scratch.path()).unwrap(), folder);
    assert_eq!(files(scratch.path()), before);
}

#[test]
fn the_folder_of_somebody_else_is_refused() {
    let scratch = Scratch::new();
    fs::write(scratch.path().join("case.toml"), "the user's").unwrap();
    fs::write(scratch.path().join("summary.json"), r#"{"program": "x"}"#).unwrap();
    let error = Folder::afresh(scratch.path(), &claim_of("a.toml")).unwrap_err();
    insta::assert_snapshot!(
        scratch.hide(&error),
        @"DIR is not empty and was not written by igimp; choose another folder for the results"
    );
    let error = Folder::open(scratch.path()).unwrap_err();
    insta::assert_snapshot!(scratch.hide(&error), @"DIR holds no results of igimp");
    assert_eq!(scratch.names(""), ["case.toml", "summary.json"]);
    let file = scratch.path().join("case.toml");
    let error = Folder::afresh(&file, &claim_of("a.toml")).unwrap_err();
    insta::assert_snapshot!(scratch.hide(&error), @"cannot access DIR/case.toml");
}

/// A run killed while it wrote the marker leaves a folder that the next run takes.
#[test]
fn a_folder_with_half_a_marker_is_ours() {
    let scratch = Scratch::new();
    let root = scratch.path().join("results");
    fs::create_dir(&root).unwrap();
    fs::write(temporary_name(&root.join(MARKER)), "igimp wri").unwrap();
    Folder::open(&root).unwrap();
    Folder::afresh(&root, &claim_of("a.toml")).unwrap();
    assert!(!temporary_name(&root.join(MARKER)).exists());
}

#[test]
fn a_claimed_folder_may_hold_a_file_before_its_run() {
    let scratch = Scratch::new();
    let root = scratch.path().join("task-0001");
    claim(&root).unwrap();
    fs::write(root.join("task.json"), "{}").unwrap();
    claim(&root).unwrap();
    Folder::afresh(&root, &claim_of("a.toml")).unwrap();
    assert!(root.join("task.json").exists());
    let foreign = scratch.path().join("mine");
    fs::create_dir(&foreign).unwrap();
    fs::write(foreign.join("notes.txt"), "the user's").unwrap();
    assert!(matches!(
        claim(&foreign),
        Err(ResultsError::ForeignFolder { .. })
    ));
}

#[test]
fn results_without_a_marker_are_known_by_summary_or_checkpoint() {
    let scratch = Scratch::new();
    let states = [("current", &body(2))];
    checkpoint::write(
        &scratch.path().join("a/checkpoint"),
        "k0",
        &states,
        &meta(),
        1,
    )
    .unwrap();
    fs::create_dir(scratch.path().join("b")).unwrap();
    fs::write(
        scratch.path().join("b/summary.json"),
        r#"{"program": "igimp 0.1.0"}"#,
    )
    .unwrap();
    for name in ["a", "b"] {
        Folder::afresh(&scratch.path().join(name), &claim_of("a.toml")).unwrap();
        assert!(scratch.names(&format!("{name}/checkpoint")).is_empty());
    }
}
