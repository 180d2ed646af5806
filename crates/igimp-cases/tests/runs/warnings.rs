//! GOAL: remarks on a case stand with its results, with the numbers of its soil: warnings of the file, the height of a slope in
//! cells, the scale of its displacements, a body without volume. CASE: a slope from 2.3 to 8.15 m on cells of a metre.
//! ORACLE: by hand: heights of 5.85 and 8.15 m, γH²/E of them; the warnings that the file is read with.

use igimp_cases::run::{Run, Start, in_memory};
use igimp_input::CaseFile;
use igimp_text::short;

use crate::resuming::{folder, run_into};

fn slope(cell: &str, more: &str) -> CaseFile {
    let text = format!(
        r#"
igimp = 1
[case]
title = "slope"
gravity = "10 m/s2"
[grid]
cell = "{cell}"
domain = {{ x = ["0 m", "21 m"], y = ["0 m", "9 m"] }}
[materials.clay]
model = "mohr-coulomb"
unit_weight = "20 kN/m3"
young = "23 MPa"
poisson = 0.3
cohesion = "12 kPa"
friction = "19 deg"
[[bodies]]
name = "slope"
material = "clay"
polygon = [["0 m","0 m"], ["21 m","0 m"], ["21 m","2.3 m"], ["12.4 m","2.3 m"], ["6.1 m","8.15 m"], ["0 m","8.15 m"]]
{more}
[[stages]]
name = "weight"
type = "gravity"
[[stages]]
name = "safety"
type = "strength-reduction"
[output]
figures = []
paraview = {{ every = "never" }}
"#
    );
    CaseFile::parse("slope.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn warning<'r>(run: &'r Run<2>, text: &str) -> &'r str {
    let mut warnings = run.summary.warnings.iter();
    let found = warnings.find(|warning| warning.contains(text));
    found.unwrap_or_else(|| panic!("{text}: {:#?}", run.summary.warnings))
}

/// GOAL: the height of a slope in cells is right with one point in a cell, and wide cells are told as low ones are.
/// ORACLE: by hand: 5.85 m of soil on cells of 1 m, and beside cells 3 m wide and 0.5 m high.
#[test]
fn cells_are_counted_in_both_directions() {
    let count = |run: &Run<2>, words: [&str; 2]| {
        let text = warning(run, words[1]);
        let cells = text.split(words[0]).nth(1).unwrap();
        cells.split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    let single = slope("1 m", "points_per_cell = 1");
    let run = in_memory::<2>(single.case()).unwrap();
    let cells = count(&run, ["the slope is ", " cells high"]);
    assert!((cells - 5.85).abs() < 0.1, "{cells}");
    let wide = ["grid.cell={ x = \"3 m\", y = \"0.5 m\" }".to_owned()];
    let wide = CaseFile::parse("slope.toml", &single.explain(), &wide).unwrap();
    let run = in_memory::<2>(wide.case()).unwrap();
    let cells = count(&run, ["the slope is as high as ", " cells are wide"]);
    assert!((cells - 5.85 / 3.0).abs() < 0.1, "{cells}");
}

#[test]
fn heights_are_those_of_the_soil() {
    let run = in_memory::<2>(slope("1 m", "").case()).unwrap();
    let text = warning(&run, " cells high");
    let cells = text.split("the slope is ").nth(1).unwrap();
    let cells: f64 = cells.split(' ').next().unwrap().parse().unwrap();
    // Weight moves the particles by some millimetres.
    assert!((cells - 5.85).abs() < 0.03, "{text}");
    let safety = run.summary.stages[1].safety.as_ref().unwrap();
    let exact = 20e3 * 8.15_f64.powi(2) / 23e6;
    let scale = safety.path.as_ref().unwrap().displacement_scale.unwrap();
    assert!(
        (scale / exact - 1.0).abs() < 5e-3,
        "{scale} {}",
        short(exact)
    );
}

#[test]
fn warnings_of_the_file_stand_in_the_summary_and_the_report() {
    let thin = "[[bodies]]\nname = \"sheet\"\nmaterial = \"clay\"\n\
                polygon = [[\"14 m\",\"4 m\"], [\"19 m\",\"4 m\"], [\"19 m\",\"5 m\"], [\"14 m\",\"5 m\"]]\n";
    let file = slope("1 m", thin);
    assert!(!file.warning_sentences().is_empty());
    let root = folder("told-warnings");
    let run = run_into((&file, file.case()), &root, Start::Afresh, None);
    for text in file.warning_sentences() {
        assert_eq!(warning(&run, &text), text);
    }
    warning(&run, "body `sheet` is 1 cells thick");
    let report = std::fs::read_to_string(root.join("report.html")).unwrap();
    assert!(report.contains("cells thick, where three are needed"));
}

#[test]
fn a_body_without_volume_is_named() {
    let film = "[[bodies]]\nname = \"film\"\nmaterial = \"clay\"\n\
                polygon = [[\"0 m\",\"8.15 m\"], [\"6.1 m\",\"8.15 m\"], [\"6.1 m\",\"8.1500001 m\"], [\"0 m\",\"8.1500001 m\"]]\n";
    let error = in_memory::<2>(slope("1 m", film).case()).unwrap_err();
    let error = error.to_string();
    assert_eq!(
        error,
        "the body `film` is empty: it has no volume on the grid"
    );
}
