//! GOAL: rigid bodies have room beside each other and beside fill, and stand on what carries them.
//! CASE: blocks on level ground, on cells of a quarter of a metre.
//! ORACLE: lengths by hand; a force that soil carries is the one that was stated.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

use crate::edits::{Edits, edited};

const TWO: &str = r#"
igimp = 1
[case]
title = "blocks"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "5 m"] }
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "soil"
polygon = [["0 m","0 m"], ["6 m","0 m"], ["6 m","2 m"], ["0 m","2 m"]]
[[rigid]]
name = "r"
type = "rectangle"
from = ["1 m", "2 m"]
to = ["2.5 m", "3 m"]
interface = "smooth"
[[rigid]]
name = "s"
type = "rectangle"
from = ["2.6 m", "2 m"]
to = ["4.1 m", "3 m"]
interface = "smooth"
[[stages]]
name = "weight"
type = "gravity"
steps = 1
[[stages]]
name = "press"
type = "rigid"
bodies = [{ body = "r", y = "-2 mm" }, { body = "s", y = "-2 mm" }]
steps = 2
[[stages]]
name = "push"
type = "rigid"
bodies = [{ body = "r", x = "200 mm" }]
steps = 4
"#;

fn parsed(text: &str, edits: Edits<'_>) -> Result<CaseFile, String> {
    CaseFile::parse("blocks.toml", &edited(text, edits), &[]).map_err(|error| error.to_string())
}

fn run(text: &str, edits: Edits<'_>) -> Run<2> {
    let file = parsed(text, edits).unwrap_or_else(|error| panic!("{error}"));
    in_memory(file.case()).unwrap()
}

fn warnings<'r>(run: &'r Run<2>, words: &str) -> Vec<&'r String> {
    let all = run.summary.warnings.iter();
    all.filter(|text| text.contains(words)).collect()
}

#[test]
fn bodies_that_overlap_as_drawn_are_refused() {
    let by = |x: &str| {
        parsed(
            TWO,
            &[("[\"2.6 m\", \"2 m\"]", &format!("[\"{x} m\", \"2 m\"]"))],
        )
    };
    let error = by("2.35").unwrap_err();
    assert!(
        error.contains("the rigid bodies `r` and `s` overlap by 0.15 m"),
        "{error}"
    );
    // They may touch, and stand in one place on two branches.
    assert!(by("2.5").is_ok());
    let branches = parsed(
        TWO,
        &[
            ("[\"2.6 m\", \"2 m\"]", "[\"2.35 m\", \"2 m\"]"),
            (", { body = \"s\", y = \"-2 mm\" }", ""),
            (
                "type = \"rigid\"\nbodies = [{ body = \"r\", x = \"200 mm\" }]",
                "type = \"rigid\"\nstart_from = \"weight\"\nbodies = [{ body = \"s\", y = \"-2 mm\" }]",
            ),
        ],
    );
    assert!(branches.is_ok(), "{branches:?}");
}

#[test]
fn bodies_that_meet_on_their_way_are_told_of_once() {
    // A gap of 100 mm, closed in steps of 50 mm: the third step brings them 50 mm into each other.
    let run = run(TWO, &[]);
    let found = warnings(&run, "have met");
    assert_eq!(found.len(), 1, "{:?}", run.summary.warnings);
    assert!(
        found[0].contains("\"r\" and \"s\"") && found[0].contains("overlap by 0.05 m"),
        "{found:?}"
    );
    let apart = self::run(TWO, &[("x = \"200 mm\"", "x = \"90 mm\"")]);
    assert!(warnings(&apart, "have met").is_empty());
}

const ONE: &str = r#"
igimp = 1
[case]
title = "one block"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "4 m"] }
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "soil"
polygon = [["0 m","0 m"], ["6 m","0 m"], ["6 m","2 m"], ["0 m","2 m"]]
[[bodies]]
name = "fill"
material = "soil"
polygon = [["3.9 m","2 m"], ["6 m","2 m"], ["6 m","3 m"], ["3.9 m","3 m"]]
[[loads]]
name = "beside"
type = "pressure"
from = ["4.2 m", "2 m"]
to = ["5.4 m", "2 m"]
pressure = "20 kPa"
[[rigid]]
name = "r"
type = "rectangle"
from = ["2.1 m", "2 m"]
to = ["3.9 m", "3.2 m"]
interface = "smooth"
weight = "40 kN/m"
[[stages]]
name = "weight"
type = "gravity"
steps = 2
[[stages]]
name = "before"
type = "load"
load = "beside"
steps = 2
[[stages]]
name = "carry"
type = "rigid"
bodies = [{ body = "r", force_y = "-12 kN/m" }]
steps = 3
[[stages]]
name = "aside"
type = "rigid"
bodies = [{ body = "r", x = "50 mm" }]
steps = 4
[[stages]]
name = "fill"
type = "construction"
place = ["fill"]
steps = 2
[[curves]]
name = "force"
x = { of = "step" }
y = { of = "rigid.r.force_y" }
stage = "carry"
"#;

#[test]
fn a_body_on_ground_that_settled_unevenly_is_held() {
    let case = run(ONE, &[]);
    assert!(
        case.failure.is_none(),
        "{:?}",
        case.failure.map(|failure| failure.error)
    );
    let force = case.curves[0].rows.last().unwrap()[1];
    assert!((force / -12e3 - 1.0).abs() < 1e-9, "{force}");
    // 50 mm are most of the half-length of a particle, 62.5 mm: soil would be moved there without strain.
    let found = warnings(&case, "without strain");
    assert_eq!(found.len(), 1, "{:?}", case.summary.warnings);
    let stays = run(ONE, &[("x = \"50 mm\"", "x = \"1 mm\"")]);
    assert!(warnings(&stays, "without strain").is_empty());
}
