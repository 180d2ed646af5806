//! GOAL: a run that begins with a later stage has no value that was read at another place.
//! CASE: level elastic ground under its weight, and then under a strip of pressure.
//! ORACLE: the case as it is changed, run from its beginning.

use std::fs;
use std::path::Path;

use igimp_cases::run::{Run, Start};
use igimp_input::CaseFile;
use igimp_results::summary::{CheckRow, Standing};

use crate::resuming::{assert_equal, everything, folder, run_into};

const GROUND: &str = r#"
igimp = 1
[case]
title = "ground"
[grid]
cell = "1 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "5 m"] }
[materials.clay]
model = "elastic"
unit_weight = "19 kN/m3"
young = "23 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "clay"
polygon = [["0 m","0 m"], ["6 m","0 m"], ["6 m","4 m"], ["0 m","4 m"]]
[[loads]]
name = "strip"
type = "pressure"
from = ["1 m","4 m"]
to = ["3 m","4 m"]
pressure = "40 kPa"
[[stages]]
name = "weight"
type = "gravity"
steps = 2
[[stages]]
name = "load"
type = "load"
load = "strip"
steps = 2
[[monitors]]
name = "m"
point = ["1.5 m","3.9 m"]
record = ["displacement_y", "sigma_yy"]
[[curves]]
name = "c"
x = { of = "step" }
y = { of = "m.displacement_y" }
reference = { y = 1.0, at = 1.0, label = "by hand", tolerance = 5.0 }
[[sections]]
name = "s"
from = ["1 m","1 m"]
to = ["5 m","1 m"]
points = 3
record = ["sigma_yy"]
[[sections]]
name = "kept"
from = ["1 m","2 m"]
to = ["5 m","2 m"]
points = 3
record = ["sigma_yy"]
[[checks]]
name = "before"
of = "m.sigma_yy"
stage = "weight"
between = ["0 kPa", "200 kPa"]
source = "by hand"
[[checks]]
name = "after"
of = "m.sigma_yy"
between = ["0 kPa", "200 kPa"]
source = "by hand"
[output]
figures = ["sigma_yy"]
report = false
paraview = { every = "never" }
"#;
const MOVED: [&str; 2] = ["[\"1.5 m\",\"3.9 m\"]", "[\"4.6 m\",\"0.7 m\"]"];

fn parsed(changes: &[[&str; 2]]) -> CaseFile {
    let text = changes.iter().fold(GROUND.to_owned(), |text, [old, new]| {
        assert!(text.contains(old));
        text.replace(old, new)
    });
    CaseFile::parse("ground.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn ran(file: &CaseFile, folder: &Path, start: Start) -> Run<2> {
    run_into((file, file.case()), folder, start, None)
}

/// The rows of a table of a results folder.
fn rows(folder: &Path, table: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.join(table)).unwrap();
    text.lines().skip(1).map(str::to_owned).collect()
}

fn check<'r>(run: &'r Run<2>, name: &str) -> &'r CheckRow {
    let mut rows = run.summary.checks.iter();
    rows.find(|row| row.check.quantity == name).unwrap()
}

#[track_caller]
fn warns(run: &Run<2>, of: &[&str]) {
    let warnings = &run.summary.warnings;
    let found = warnings
        .iter()
        .any(|text| of.iter().all(|part| text.contains(part)));
    assert!(found, "{of:?}: {warnings:#?}");
}

// GOAL: monitors, sections, curves and checks that are changed have what the stages that run record, and no row of another place.
#[test]
fn redefined_records_have_nothing_of_the_stages_before() {
    let [mixed, fresh] = ["from-stage-mixed", "from-stage-fresh"].map(folder);
    ran(&parsed(&[]), &mixed, Start::Afresh);
    let changed = parsed(&[MOVED, ["to = [\"5 m\",\"1 m\"]", "to = [\"5 m\",\"3 m\"]"]]);
    let run = ran(&changed, &mixed, Start::FromStage(1));
    let expected = ran(&changed, &fresh, Start::Afresh);
    for table in ["monitors/m.csv", "curves/c.csv"] {
        let (rest, whole) = (rows(&mixed, table), rows(&fresh, table));
        assert_eq!(whole.len(), 5, "{table}");
        assert_eq!(rest, whole[3..], "{table}");
    }
    assert!(!mixed.join("sections/s__1-weight.csv").exists());
    for table in ["s__2-load.csv", "kept__1-weight.csv", "kept__2-load.csv"] {
        let table = format!("sections/{table}");
        assert_eq!(rows(&mixed, &table), rows(&fresh, &table), "{table}");
    }
    assert_eq!(check(&run, "before").standing, Standing::NotReached);
    assert!(check(&run, "before").check.measured.is_nan());
    assert_eq!(check(&run, "after"), check(&expected, "after"));
    assert_eq!(check(&run, "c at 1").standing, Standing::NotReached);
    let figures = run.summary.figures.iter();
    let pictures = figures.filter(|figure| figure.caption.contains("along section"));
    assert_eq!(pictures.count(), 3);
    warns(
        &run,
        &["monitor \"m\"", "before \"load\"", "from its beginning"],
    );
    warns(
        &run,
        &["curve \"c\"", "before \"load\"", "from its beginning"],
    );
    warns(
        &run,
        &["section \"s\"", "stage \"weight\"", "from its beginning"],
    );
    warns(
        &run,
        &["check \"before\"", "stage \"weight\"", "from its beginning"],
    );
    // What the first stage recorded is gone: the case as it was begins with the later stage, too.
    let back = ran(&parsed(&[]), &mixed, Start::FromStage(1));
    assert_eq!(rows(&mixed, "monitors/m.csv").len(), 2);
    warns(&back, &["monitor \"m\""]);
    warns(&back, &["section \"s\""]);
    // The end of the first stage is that of the first run, and its check as well.
    assert!(check(&back, "before").pass);
}

// GOAL: other fields of a monitor are recorded from the stage on, and another band is held against the value that was read.
#[test]
fn other_fields_and_bands_are_taken_up() {
    let root = folder("from-stage-band");
    let first = ran(&parsed(&[]), &root, Start::Afresh);
    let fields = ["[\"displacement_y\", \"sigma_yy\"]", "[\"sigma_yy\"]"];
    let band = [
        "between = [\"0 kPa\", \"200 kPa\"]",
        "between = [\"90 kPa\", \"200 kPa\"]",
    ];
    let run = ran(&parsed(&[fields, band]), &root, Start::FromStage(1));
    assert_eq!(rows(&root, "monitors/m.csv").len(), 2);
    assert_eq!(rows(&root, "curves/c.csv").len(), 5);
    let [was, is] = [&first, &run].map(|run| check(run, "before"));
    assert_eq!(was.check.measured.to_bits(), is.check.measured.to_bits());
    assert!(was.pass && !is.pass && is.is_reached());
}

// GOAL: what is not changed is kept to the byte, and a call that is refused changes no byte.
#[test]
fn a_case_that_stays_or_is_refused_changes_nothing() {
    let root = folder("from-stage-same");
    ran(&parsed(&[]), &root, Start::Afresh);
    let before = everything(&root);
    ran(&parsed(&[]), &root, Start::FromStage(1));
    assert_equal(&before, &everything(&root), "from a stage on");
    let marker = fs::read(root.join(".igimp")).unwrap();
    for change in [
        ["23 MPa", "24 MPa"],
        ["steps = 2\n[[stages]]", "steps = 3\n[[stages]]"],
    ] {
        let changed = parsed(&[change, MOVED]);
        let target = igimp_cases::run::Target::of(&changed, &root);
        let never = std::sync::atomic::AtomicBool::new(false);
        let mut nobody = igimp_cases::run::Nobody;
        let start = Start::FromStage(1);
        let refused =
            igimp_cases::run::run(changed.case(), Some(&target), start, &mut nobody, &never);
        assert!(refused.is_err());
        assert_equal(&before, &everything(&root), "refused");
        assert_eq!(marker, fs::read(root.join(".igimp")).unwrap());
    }
}

// GOAL: a monitor that ends a stage before is part of what that stage depends on.
#[test]
fn a_monitor_that_ended_a_stage_is_not_moved() {
    let root = folder("from-stage-ending");
    let ends = [
        "steps = 2\n[[stages]]",
        "steps = 2\nstop_when = { displacement = \"1 m\", monitor = \"m\" }\n[[stages]]",
    ];
    ran(&parsed(&[ends]), &root, Start::Afresh);
    let file = parsed(&[ends, MOVED]);
    let target = igimp_cases::run::Target::of(&file, &root);
    let never = std::sync::atomic::AtomicBool::new(false);
    let mut nobody = igimp_cases::run::Nobody;
    let run = igimp_cases::run::run(
        file.case(),
        Some(&target),
        Start::FromStage(1),
        &mut nobody,
        &never,
    );
    assert!(run.is_err());
}
