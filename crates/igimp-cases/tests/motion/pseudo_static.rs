//! Pseudo-static acceleration in case files: a bar pushed along itself is a column under its own weight, and the push stays
//! from stage to stage.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;
use igimp_model::StageKind;

/// A bar of 8 m by 1 m between `sides`, held at the left or at the bottom.
fn bar(size: [f64; 2], boundaries: &str, stages: &str) -> Run<2> {
    let [width, height] = size;
    let text = format!(
        r#"
igimp = 1
[case]
title = "bar"
[grid]
cell = "0.5 m"
domain = {{ x = ["0 m", "{width} m"], y = ["0 m", "{height} m"] }}
[boundaries]
{boundaries}
[materials.soft]
model = "elastic"
unit_weight = "18 kN/m3"
young = "1 MPa"
poisson = 0.3
[[bodies]]
name = "bar"
material = "soft"
polygon = [["0 m", "0 m"], ["{width} m", "0 m"], ["{width} m", "{height} m"], ["0 m", "{height} m"]]
{stages}
"#
    );
    let file = CaseFile::parse("bar.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    in_memory(file.case()).unwrap()
}

/// GOAL: weight along −x instead of −y turns a column by a quarter. BCs: one end held, smooth sides. ORACLE: the column
/// itself, to round-off.
#[test]
fn a_bar_pushed_along_itself_is_a_column() {
    let column = bar(
        [1.0, 8.0],
        "bottom = \"fixed\"",
        "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 4",
    );
    let lying = bar(
        [8.0, 1.0],
        "left = \"fixed\"\nright = \"free\"\nbottom = \"roller\"\ntop = \"roller\"",
        "[[stages]]\nname = \"push\"\ntype = \"gravity\"\nhorizontal = -1\nvertical = 1\nsteps = 4",
    );
    let (column, lying) = (&column.body.particles, &lying.body.particles);
    assert_eq!(column.len(), lying.len());
    for particle in 0..column.len() {
        let x = column.x[particle];
        let near = |other: &&usize| {
            let y = lying.x[**other];
            (x[0] - y[1]).abs() + (x[1] - y[0]).abs() < 1e-8
        };
        let all: Vec<usize> = (0..lying.len()).collect();
        let other = *all.iter().find(near).expect("there is a particle across");
        let (a, b) = (column.sigma[particle], lying.sigma[other]);
        for (stress, turned) in [(a[0][0], b[1][1]), (a[1][1], b[0][0]), (a[2][2], b[2][2])] {
            assert!(
                (stress - turned).abs() < 1e-9 * 18e3 * 8.0,
                "{stress} {turned}"
            );
        }
    }
}

/// GOAL: controls that are not stated stay.
#[test]
fn the_push_stays_until_it_is_stated_anew() {
    let stages = r#"
[[stages]]
name = "weight"
type = "gravity"
steps = 1
[[stages]]
name = "push"
type = "gravity"
horizontal = 0.2
vertical = 0.1
steps = 1
[[stages]]
name = "load"
type = "load"
load = "cap"
steps = 1
[[stages]]
name = "heavier"
type = "gravity"
factor = 1.1
steps = 1
[[stages]]
name = "back"
type = "gravity"
horizontal = -0.1
steps = 2
[[loads]]
name = "cap"
type = "point"
at = ["0.5 m", "2 m"]
force = ["0 kN/m", "-1 kN/m"]
[[curves]]
name = "push"
x = { of = "step" }
y = { of = "horizontal_factor" }
"#;
    let run = bar([2.0, 2.0], "bottom = \"fixed\"", stages);
    let found: Vec<f64> = run.curves[0].points(0, 1).iter().map(|p| p[1]).collect();
    let steps = [0.0, 0.2, 0.2, 0.2, 0.05, -0.1];
    let last: Vec<f64> = found.iter().copied().filter(|k| *k != 0.0).collect();
    assert!(
        steps[1..]
            .iter()
            .all(|k| last.iter().any(|value| (value - k).abs() < 1e-12)),
        "{found:?}"
    );
    assert!((found[found.len() - 1] + 0.1).abs() < 1e-12);
    let weights = found.iter().filter(|k| (**k - 0.2).abs() < 1e-12).count();
    assert!(weights >= 3, "{found:?}");
}

#[test]
fn a_push_is_a_number_of_a_stage_of_gravity() {
    let text = |stage: &str| {
        format!(
            "igimp = 1\n[case]\ntitle = \"t\"\n[grid]\ncell = \"1 m\"\ndomain = {{ x = [\"0 m\", \"2 m\"], y = [\"0 m\", \"2 m\"] }}\n\
             [materials.a]\nmodel = \"elastic\"\nunit_weight = \"18 kN/m3\"\nyoung = \"1 MPa\"\npoisson = 0.3\n\
             [[bodies]]\nname = \"b\"\nmaterial = \"a\"\npolygon = [[\"0 m\", \"0 m\"], [\"2 m\", \"0 m\"], [\"2 m\", \"2 m\"], [\"0 m\", \"2 m\"]]\n\
             [[stages]]\nname = \"s\"\n{stage}\n"
        )
    };
    let read = |stage: &str| CaseFile::parse("t.toml", &text(stage), &[]);
    let file = read("type = \"gravity\"\nhorizontal = 0.1").unwrap();
    assert_eq!(
        file.case().stages[0].kind,
        StageKind::Gravity {
            factor: 1.0,
            horizontal: Some(0.1),
            across: None,
            vertical: None
        }
    );
    let error = read("type = \"gravity\"\nhorizontal = \"0.1 m/s2\"").unwrap_err();
    assert!(
        error.to_string().contains("a number without a unit"),
        "{error}"
    );
    let error = read("type = \"k0\"\nhorizontal = 0.1").unwrap_err();
    assert!(
        error
            .to_string()
            .contains("`horizontal` is a field of type = \"gravity\""),
        "{error}"
    );
}
