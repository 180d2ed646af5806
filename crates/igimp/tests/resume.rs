//! GOAL: a stage that is run again ends with the same tables to the byte, and a checkpoint is taken
//! up for its own case only.
//! CASE: a coarse slope under gravity, its factor of safety, and its run-out.
//! ORACLE: the tables of the same run left alone.

mod run_support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use run_support::{Folder, differing};

#[test]
fn a_stage_run_again_ends_with_the_same_tables() {
    let folder = Folder::new("from-stage");
    let (code, printed) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{printed}");
    let expected = folder.tables("out");
    for stage in ["run-out", "factor of safety"] {
        let (code, printed) = folder.end("out", &["--from-stage", stage]);
        assert_eq!(code, Some(0), "{stage}: {printed}");
        assert_eq!(
            differing(&expected, &folder.tables("out")),
            Vec::<PathBuf>::new()
        );
    }
}

#[test]
fn a_checkpoint_of_another_case_is_refused() {
    let folder = Folder::new("other-case");
    let (code, printed) = folder.end("out", &[]);
    assert_eq!(code, Some(0), "{printed}");
    let other = ["--resume", "--set", "materials.clay.cohesion=21 kPa"];
    let (code, printed) = folder.end("out", &other);
    assert_eq!(code, Some(2), "{printed}");
    assert!(
        printed.contains("belongs to another case or to other input"),
        "{printed}"
    );
    let other = [
        "--from-stage",
        "run-out",
        "--set",
        "materials.clay.cohesion=21 kPa",
    ];
    let (code, printed) = folder.end("out", &other);
    assert_eq!(code, Some(2), "{printed}");
    // Settings that do not concern the stages before may change.
    let other = [
        "--from-stage",
        "run-out",
        "--set",
        "stages.run-out.steps=50",
    ];
    let (code, printed) = folder.end("out", &other);
    assert_eq!(code, Some(0), "{printed}");
}

/// GOAL: rigid bodies go on where they stood, with the marks of contact, on soil whose strength and stiffness
/// vary: from any step of their stages the run ends with the same files.
#[test]
fn rigid_bodies_are_taken_up_where_they_stood() {
    let folder = Folder::new("two-bodies");
    let case = include_str!("../../igimp-cases/tests/data/two_bodies.toml");
    let varied = [
        (
            "cu = \"20 kPa\"",
            "cu = { at_top = \"18 kPa\", gradient = \"3 kPa/m\" }",
        ),
        (
            "young = \"6 MPa\"",
            "young = { levels = [\"0 m\", \"2 m\"], values = [\"7 MPa\", \"5 MPa\"] }",
        ),
    ];
    let case = varied.iter().fold(case.to_owned(), |case, (from, to)| {
        assert!(case.contains(from), "{from}");
        case.replacen(from, to, 1)
    });
    fs::write(folder.0.join("two_bodies.toml"), case).unwrap();
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(["run", "two_bodies.toml", "--out", "out", "--quiet"]);
        let output = command.args(more).current_dir(&folder.0).output().unwrap();
        let printed = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{printed}");
    };
    run(&[]);
    let expected = folder.everything("out");
    assert!(expected.contains_key(Path::new("rigid/footing.csv")));
    let checkpoints = folder.0.join("out/checkpoint");
    for last in [4, 6, 7, 10, 13] {
        for found in fs::read_dir(&checkpoints).unwrap() {
            let path = found.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            let step = name.strip_prefix("step-").map(str::parse::<i32>);
            let is_later = match step {
                Some(step) => step.unwrap() > last,
                None => name == "stage-03-end" || (name == "stage-02-end" && last < 6),
            };
            if is_later {
                fs::remove_dir_all(&path).unwrap();
            }
        }
        run(&["--resume"]);
        let found = folder.everything("out");
        assert_eq!(
            differing(&expected, &found),
            Vec::<PathBuf>::new(),
            "{last}"
        );
    }
    for stage in ["seat", "load"] {
        run(&["--from-stage", stage]);
        let found = folder.everything("out");
        assert_eq!(
            differing(&expected, &found),
            Vec::<PathBuf>::new(),
            "{stage}"
        );
    }
}

const PUSHED: &str = r#"
igimp = 1
[case]
title = "slope from files, pushed"
[grid]
cell = "1 m"
domain = { x = ["0 m", "24 m"], y = ["0 m", "9 m"] }
[materials.clay]
model = "tresca"
cu = { raster = "cu.csv", unit = "psf", length_unit = "m" }
unit_weight = "115 pcf"
young = "10 MPa"
poisson = 0.4
[[bodies]]
name = "slope"
material = "clay"
polygon = { top = { file = "ground.csv" }, bottom = [["0 m", "0 m"], ["24 m", "0 m"]] }
[[stages]]
name = "weight"
type = "gravity"
steps = 3
[[stages]]
name = "push"
type = "gravity"
horizontal = 0.1
vertical = 0.02
steps = 4
[[stages]]
name = "factor"
type = "strength-reduction"
bracket = [1.0, 2.0]
tolerance = 0.05
[output]
figures = []
report = false
checkpoint = { every = 1, keep = 20 }
"#;

/// GOAL: a pushed slope whose outline and strength come from files goes on where it stood, on any number of threads, and not after
/// a file changed.
#[test]
fn a_pushed_slope_from_files_is_taken_up_while_its_files_stay() {
    let folder = Folder::new("pushed");
    let ground = "x [m],y [m]\n0,8\n6,8\n14,4\n24,4\n";
    let write = |name: &str, text: &str| fs::write(folder.0.join(name), text).unwrap();
    write("pushed.toml", PUSHED);
    write("ground.csv", ground);
    write("cu.csv", "x,y,cu\n0,0,900\n24,0,1000\n0,8,500\n24,8,600\n");
    let run = |out: &str, more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(["run", "pushed.toml", "--out", out, "--quiet"]);
        let output = command.args(more).current_dir(&folder.0).output().unwrap();
        let printed = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), printed)
    };
    let done = |(code, printed): (Option<i32>, String)| assert_eq!(code, Some(0), "{printed}");
    done(run("out", &[]));
    let expected = folder.everything("out");
    done(run("alone", &["--threads", "1"]));
    let tables = folder.tables("alone");
    assert_eq!(
        differing(&folder.tables("out"), &tables),
        Vec::<PathBuf>::new()
    );
    let checkpoints = folder.0.join("out/checkpoint");
    for last in [2, 5, 7] {
        for found in fs::read_dir(&checkpoints).unwrap() {
            let path = found.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            let step = name.strip_prefix("step-").map(str::parse::<i32>);
            let is_later = match step {
                Some(step) => step.unwrap() > last,
                None => name != "stage-01-end" || last < 3,
            };
            if is_later {
                fs::remove_dir_all(&path).unwrap();
            }
        }
        done(run("out", &["--resume"]));
        let found = folder.everything("out");
        assert_eq!(
            differing(&expected, &found),
            Vec::<PathBuf>::new(),
            "{last}"
        );
    }
    write("ground.csv", &ground.replace("14,4", "14,4.5"));
    let (code, printed) = run("out", &["--resume"]);
    assert_eq!(code, Some(2), "{printed}");
    assert!(
        printed.contains("belongs to another case or to other input"),
        "{printed}"
    );
}

/// GOAL: reinforcement goes on with the tension that it had, under a jack and locked off: from any step of its
/// stages the run ends with the same files.
#[test]
fn reinforcement_is_taken_up_with_its_tension() {
    let folder = Folder::new("tied-cut");
    let case = include_str!("../../igimp-cases/tests/data/tied_cut.toml");
    fs::write(folder.0.join("tied_cut.toml"), case).unwrap();
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(["run", "tied_cut.toml", "--out", "out", "--quiet"]);
        let output = command.args(more).current_dir(&folder.0).output().unwrap();
        let printed = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{printed}");
    };
    run(&[]);
    let expected = folder.everything("out");
    assert!(expected.contains_key(Path::new("reinforcement/mat__3-load.csv")));
    let checkpoints = folder.0.join("out/checkpoint");
    for last in [11, 9, 7, 5, 4, 2] {
        for found in fs::read_dir(&checkpoints).unwrap() {
            let path = found.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            let step = name.strip_prefix("step-").map(str::parse::<i32>);
            let is_later = match step {
                Some(step) => step.unwrap() > last,
                None => [
                    "stage-01-end",
                    "stage-02-end",
                    "stage-03-end",
                    "stage-04-end",
                ]
                .iter()
                .zip([3, 6, 10, 99])
                .any(|(end, at)| name == *end && last < at),
            };
            if is_later {
                fs::remove_dir_all(&path).unwrap();
            }
        }
        run(&["--resume"]);
        let found = folder.everything("out");
        assert_eq!(
            differing(&expected, &found),
            Vec::<PathBuf>::new(),
            "{last}"
        );
    }
    for stage in ["stress", "load", "safety"] {
        run(&["--from-stage", stage]);
        let found = folder.everything("out");
        assert_eq!(
            differing(&expected, &found),
            Vec::<PathBuf>::new(),
            "{stage}"
        );
    }
}
