//! GOAL: a body without hold is named by its motion, and a node that the soil of a corner cannot hold is no want of equilibrium.
//! CASE: a block whose friction is used up; elastic wedges with an acute corner at a free upright side.
//! ORACLE: the block slides along x; a wedge settles as it does with B-bar, whose means hold every node.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

fn ran(text: &str, set: &[&str]) -> Run<2> {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    let file = CaseFile::parse("case.toml", text, &set).unwrap_or_else(|error| panic!("{error}"));
    in_memory(file.case()).unwrap()
}

/// A block that rests on level ground by its weight, pushed by a share of it.
const BLOCK: &str = r#"
igimp = 1
[case]
title = "A block slides"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "2.5 m"] }
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "200 MPa"
poisson = 0.3
[[bodies]]
name = "soil"
material = "soil"
points_per_cell = 9
polygon = [["0 m", "0 m"], ["6 m", "0 m"], ["6 m", "1 m"], ["0 m", "1 m"]]
[[rigid]]
name = "block"
type = "rectangle"
from = ["1.13 m", "1 m"]
to = ["2.73 m", "1.8 m"]
interface = { friction = 0.2 }
weight = "25 kN/m"
[[stages]]
name = "g"
type = "gravity"
steps = 1
[[stages]]
name = "place"
type = "rigid"
steps = 2
bodies = [{ body = "block", y = "-0.2 mm" }]
[[stages]]
name = "settle"
type = "rigid"
steps = 3
bodies = [{ body = "block", force_y = "0 kN/m", x = "0 m", rotation = "0 deg" }]
[[stages]]
name = "free"
type = "rigid"
steps = 3
bodies = [{ body = "block", free = ["x", "y", "rotation"] }]
[[stages]]
name = "push"
type = "gravity"
horizontal = 0.3
steps = 7
[output]
report = false
figures = []
paraview = { every = "never" }
"#;

/// GOAL: a block that slides is told to slide, with what helps, at any friction. ORACLE: it goes along x at μ of its weight.
#[test]
fn a_block_that_slides_is_said_to() {
    for friction in [0.2, 0.23, 0.28, 0.29] {
        let run = ran(BLOCK, &[&format!("rigid.0.interface.friction={friction}")]);
        let pushed = 0.3 * run.failure.as_ref().unwrap().error.from;
        assert!((pushed / friction - 1.0).abs() < 0.01, "{pushed}");
        let failure = run.failure.unwrap();
        let message = failure.error.failure.to_string();
        let expected = "nothing holds the rigid body \"block\" in its displacement in x";
        assert!(message.starts_with(expected), "{message}");
        let first = &failure.suggestions[0];
        assert!(
            first.contains("friction") && first.contains("slides"),
            "{first}"
        );
        assert!(failure.suggestions[1].starts_with("x = \"0 m\""));
    }
}

/// GOAL: ground that nothing holds has no limit load, and is no planned end. CASE: a block on a roller, pressed, free to slide.
/// ORACLE: the stage fails where it began.
#[test]
fn ground_that_nothing_holds_has_no_limit_load() {
    let text = r#"
igimp = 1
[case]
title = "a block without a hold"
gravity = "0 m/s2"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "3 m"], y = ["0 m", "2 m"] }
[materials.clay]
model = "tresca"
unit_weight = "0 kN/m3"
young = "10 MPa"
poisson = 0.3
cu = "10 kPa"
[[bodies]]
name = "block"
material = "clay"
polygon = [["1 m", "0 m"], ["2 m", "0 m"], ["2 m", "1 m"], ["1 m", "1 m"]]
[boundaries]
left = "free"
right = "free"
bottom = "roller"
[[loads]]
name = "q"
type = "pressure"
from = ["1 m", "1 m"]
to = ["2 m", "1 m"]
pressure = "1 kPa"
[[stages]]
name = "load"
type = "load"
load = "q"
steps = 4
geometry = "given"
stop_when = { no_equilibrium = true }
[output]
report = false
figures = []
"#;
    let run = ran(text, &[]);
    assert!(run.failure.is_some(), "{}", run.summary.stages[0].reason);
}

/// An elastic wedge between free upright sides, on a given geometry.
const WEDGE: &str = r#"
igimp = 1
[case]
title = "A wedge under its weight"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "8 m"], y = ["0 m", "8 m"] }
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "50 MPa"
poisson = 0.3
[[bodies]]
name = "soil"
material = "soil"
points_per_cell = 4
polygon = [["1 m", "0 m"], ["7 m", "0 m"], ["7 m", "LOW m"], ["1 m", "HIGH m"]]
[boundaries]
left = "free"
right = "free"
[[stages]]
name = "weight"
type = "gravity"
geometry = "given"
steps = 2
[output]
report = false
figures = []
paraview = { every = "never" }
"#;

/// GOAL: the acute corner of an elastic body may lie anywhere in its cell: nodes that it cannot hold are tied.
/// ORACLE: settlements with B-bar, within 1 %. Without the tie the first step was singular.
#[test]
fn an_acute_corner_may_lie_anywhere() {
    let mut tied = 0;
    for (low, high) in [(1.57, 4.57), (2.1, 4.3), (1.62, 7.62), (1.6, 4.6)] {
        let wedge = WEDGE.replace("LOW", &low.to_string());
        let wedge = wedge.replace("HIGH", &high.to_string());
        let [plain, with_means] = [&[][..], &["grid.locking=b-bar"]].map(|set| {
            let run = ran(&wedge, set);
            assert!(run.failure.is_none(), "{low}: {:?}", run.failure);
            let stage = &run.summary.stages[0];
            tied += stage.ghost_steps;
            stage.largest_displacement
        });
        println!("{low} {high}: {plain} {with_means}");
        assert!(
            (plain / with_means - 1.0).abs() < 0.01,
            "{low}: {plain} {with_means}"
        );
    }
    assert!(tied >= 6, "{tied}");
}
