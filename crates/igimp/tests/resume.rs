//! GOAL: a stage that is run again ends with the same tables to the byte, and a checkpoint is taken
//! up for its own case only.
//! CASE: a coarse slope under gravity, its factor of safety, and its run-out.
//! ORACLE: the tables of the same run left alone.

mod run_support;

use std::path::PathBuf;

use run_support::{Folder, differing};

#[test]
fn a_stage_run_again_ends_with_the_same_tables() {
    let folder = Folder::new("from-stage");
    let (code, said) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{said}");
    let expected = folder.tables("out");
    for stage in ["run-out", "factor of safety"] {
        let (code, said) = folder.end("out", &["--from-stage", stage]);
        assert_eq!(code, Some(0), "{stage}: {said}");
        assert_eq!(
            differing(&expected, &folder.tables("out")),
            Vec::<PathBuf>::new()
        );
    }
}

#[test]
fn a_checkpoint_of_another_case_is_refused() {
    let folder = Folder::new("other-case");
    let (code, said) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{said}");
    let other = ["--resume", "--set", "materials.clay.cohesion=21 kPa"];
    let (code, said) = folder.end("out", &other);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("belongs to another case or to other input"),
        "{said}"
    );
    let other = [
        "--from-stage",
        "run-out",
        "--set",
        "materials.clay.cohesion=21 kPa",
    ];
    let (code, said) = folder.end("out", &other);
    assert_eq!(code, Some(2), "{said}");
    // What does not concern the stages before may change.
    let other = [
        "--from-stage",
        "run-out",
        "--set",
        "stages.run-out.steps=50",
    ];
    let (code, said) = folder.end("out", &other);
    assert_eq!(code, Some(0), "{said}");
}
