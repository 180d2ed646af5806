//! GOAL: a footing that is pushed deep carries what it did a step before, in space as in the plane, and across lines of the grid.
//! CASE: a rough base, eight cells wide, pushed 1.2 cells into clay in steps of a twenty-fifth of a cell, with the settings of a case file.
//! ORACLE: a slice between smooth sides is the plane; the resistance of clay grows with depth. With ties below 1e-3 the slice fell to a third,
//! and with faces that end at once single steps lost five sixths.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

const CASE: &str = r#"
igimp = 1
[case]
title = "A footing that goes deep"
ANALYSIS
[grid]
cell = "0.25 m"
domain = DOMAIN
[materials.clay]
model = "tresca"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.45
cu = "20 kPa"
[[bodies]]
name = "ground"
material = "clay"
GROUND
[[rigid]]
name = "footing"
FOOTING
interface = "rough"
[[stages]]
name = "weight"
type = "gravity"
steps = 2
geometry = "moving"
[[stages]]
name = "push"
type = "rigid"
bodies = [{ body = "footing", UP = "-0.3 m" }]
steps = 30
[[curves]]
name = "resistance"
x = { of = "rigid.footing.settlement" }
y = { of = "rigid.footing.resistance" }
[output]
figures = []
report = false
"#;

const PLANE: [(&str, &str); 5] = [
    ("ANALYSIS", ""),
    (
        "DOMAIN",
        "{ x = [\"0 m\", \"8 m\"], y = [\"0 m\", \"4 m\"] }\nfit = \"none\"",
    ),
    (
        "GROUND",
        r#"polygon = [["0 m", "0 m"], ["8 m", "0 m"], ["8 m", "2 m"], ["0 m", "2 m"]]"#,
    ),
    (
        "FOOTING",
        "type = \"rectangle\"\nfrom = [\"3 m\", \"2 m\"]\nto = [\"5 m\", \"3 m\"]",
    ),
    ("UP", "y"),
];

const SLICE: [(&str, &str); 5] = [
    ("ANALYSIS", "analysis = \"3d\""),
    (
        "DOMAIN",
        r#"{ x = ["0 m", "8 m"], y = ["0 m", "0.25 m"], z = ["0 m", "4 m"] }"#,
    ),
    (
        "GROUND",
        r#"box = { from = ["0 m", "0 m", "0 m"], to = ["8 m", "0.25 m", "2 m"] }"#,
    ),
    (
        "FOOTING",
        "type = \"box\"\nfrom = [\"3 m\", \"-0.5 m\", \"2 m\"]\nto = [\"5 m\", \"1 m\", \"3 m\"]",
    ),
    ("UP", "z"),
];

fn text(edits: &[(&str, &str)]) -> CaseFile {
    let edited = |text: String, (from, to): &(&str, &str)| text.replace(from, to);
    let text = edits.iter().fold(CASE.to_owned(), edited);
    CaseFile::parse("footing.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn resistance_holds_across_lines_of_the_grid() {
    let plane = in_memory(text(&PLANE).case()).unwrap().curves[0].points(0, 1);
    let slice = in_memory(text(&SLICE).case_in_space()).unwrap().curves[0].points(0, 1);
    let (last, steps) = (plane[plane.len() - 1][1], plane.len());
    for (name, curve, thickness) in [("plane", &plane, 1.0), ("slice", &slice, 0.25)] {
        assert_eq!(curve.len(), steps, "{name}");
        let mut most = 0.0_f64;
        for [_, resistance] in curve.iter().copied() {
            let carried = resistance / thickness;
            assert!(
                most - carried < 0.04 * last,
                "{name}: {carried} after {most}"
            );
            most = most.max(carried);
        }
        let off = curve[steps - 1][1] / thickness / last - 1.0;
        assert!(off.abs() < 0.02, "{name}: {off}");
    }
}
