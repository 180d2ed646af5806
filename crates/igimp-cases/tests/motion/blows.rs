//! GOAL: rigid bodies that fall on ground, and that slide to and fro on it, move as mechanics says by steps that are chosen.
//! CASE: a plate over a column of elastic soil with a matched base, a box over level ground, a block on a shaken layer.
//! ORACLE: a mass on a rod without end, v = v0 exp(−ρ c A t / m), which never comes off; steps of a millisecond; a sliding block.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

/// A smooth plate over a column 6 m high, whose dashpots below let all waves out.
const ROD: &str = r#"
igimp = 1
[case]
title = "A plate falls on a rod"
gravity = "10 m/s2"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "0.5 m"], y = ["0 m", "7 m"] }
[materials.soil]
model = "elastic"
unit_weight = "20 kN/m3"
young = "100 MPa"
poisson = 0.25
[[bodies]]
name = "rod"
material = "soil"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["0.5 m", "0 m"], ["0.5 m", "6 m"], ["0 m", "6 m"]]
[boundaries]
left = "roller"
right = "roller"
bottom = "roller"
[[rigid]]
name = "plate"
type = "rectangle"
from = ["-0.5 m", "FROM m"]
to = ["1 m", "7 m"]
weight = "15 kN/m"
interface = "smooth"
rounding = 0
[[stages]]
name = "weight"
type = "gravity"
steps = 1
reset_displacements = true
[[stages]]
name = "fall"
type = "dynamic"
duration = "0.25 s"
steps = 10
lumped_share = 0
absorbing = ["bottom"]
wall_springs = 0
bodies = [{ body = "plate", free = ["y"] }]
[[curves]]
name = "speed"
stage = "fall"
x = { of = "time" }
y = { of = "rigid.plate.velocity_y" }
[output]
report = false
figures = []
"#;

/// A box that falls by 0.2 m on elastic ground between dashpots.
const BOX: &str = r#"
igimp = 1
[case]
title = "A box falls on ground"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "8 m"], y = ["0 m", "5 m"] }
locking = "b-bar"
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "soil"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["8 m", "0 m"], ["8 m", "3 m"], ["0 m", "3 m"]]
[[rigid]]
name = "box"
type = "rectangle"
from = ["3.5 m", "3.2 m"]
to = ["4.5 m", "4.2 m"]
weight = "20 kN/m"
interface = { friction = 0.5 }
[[stages]]
name = "weight"
type = "gravity"
steps = 1
reset_displacements = true
[[stages]]
name = "fall"
type = "dynamic"
duration = "0.32 s"
steps = 8
absorbing = ["left", "right", "bottom"]
bodies = [{ body = "box", free = ["x", "y", "rotation"] }]
[[curves]]
name = "speed"
stage = "fall"
x = { of = "time" }
y = { of = "rigid.box.velocity_y" }
[output]
report = false
figures = []
"#;

/// A block that rests on a layer by friction and is left behind as the rock below moves.
const BLOCK: &str = r#"
igimp = 1
[case]
title = "A block slides to and fro"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "4 m"] }
[materials.soil]
model = "elastic"
unit_weight = "20 kN/m3"
young = "200 MPa"
poisson = 0.2
[[bodies]]
name = "layer"
material = "soil"
polygon = [["0 m", "0 m"], ["6 m", "0 m"], ["6 m", "1 m"], ["0 m", "1 m"]]
[boundaries]
left = "roller"
right = "roller"
bottom = "fixed"
[[rigid]]
name = "block"
type = "rectangle"
from = ["2 m", "1 m"]
to = ["4 m", "1.5 m"]
weight = "20 kN/m"
interface = { friction = 0.3 }
[[stages]]
name = "weight"
type = "gravity"
steps = 1
[[stages]]
name = "placed"
type = "rigid"
bodies = [{ body = "block", free = ["x", "y", "rotation"] }]
steps = 2
reset_displacements = true
[[stages]]
name = "shaken"
type = "dynamic"
duration = "1.2 s"
steps = 5
[stages.ground_motion]
unit = "m/s2"
time = ["0 s", "0.05 s", "0.25 s", "0.3 s", "0.5 s", "0.6 s", "0.9 s"]
values = [0, -5, -5, 4, 4, -3, 0]
[[curves]]
name = "way"
stage = "shaken"
x = { of = "time" }
y = { of = "rigid.block.x" }
[output]
report = false
figures = []
"#;

fn ran(text: &str, changes: &[&str]) -> Run<2> {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    let file = CaseFile::parse("blow.toml", text, &changes).unwrap();
    in_memory(file.case()).unwrap()
}

/// The values of the curve of a run.
fn values(run: &Run<2>) -> Vec<f64> {
    let points = run.curves[0].points(0, 1);
    points.into_iter().map(|[_, value]| value).collect()
}

/// The largest speed upwards after the largest one downwards, and that.
fn rebound(run: &Run<2>) -> [f64; 2] {
    let speeds = values(run);
    let met = (0..speeds.len()).fold(0, |k, i| if speeds[i] < speeds[k] { i } else { k });
    let up = speeds[met..].iter().copied().fold(f64::MIN, f64::max);
    [up, -speeds[met]]
}

/// GOAL: a plate that meets soil with its whole face does not come off a rod without end, whichever height it falls from and however
/// stiff the rod is, and contact takes or makes next to none of the energy of the blow.
#[test]
fn a_plate_does_not_come_off_a_rod_without_end() {
    for (gap, young, scheme, most) in [
        (0.04, "100 MPa", "generalised-alpha", 0.02),
        (0.06, "100 MPa", "generalised-alpha", 0.02),
        (0.05, "100 MPa", "newmark", 0.02),
        (0.05, "2000 MPa", "generalised-alpha", 0.03),
        (0.05, "100 MPa", "backward-euler", 0.06),
    ] {
        let text = ROD.replace("FROM", &(6.0 + gap).to_string());
        let changes = [
            format!("materials.soil.young = \"{young}\""),
            format!("stages.fall.scheme = \"{scheme}\""),
        ];
        let run = ran(&text, &changes.each_ref().map(String::as_str));
        let [up, met] = rebound(&run);
        let contact = run.summary.stages.last().unwrap().energy.unwrap().contact;
        let share = contact / (15e3 * gap);
        println!("{gap} {young} {scheme}: {up} after {met} m/s, contact {share}");
        assert!(up < 0.01 * met, "{gap} {young} {scheme}: {up} of {met}");
        assert!(share.abs() < most, "{gap} {young} {scheme}: {share}");
    }
}

/// GOAL: a box that falls on ground comes off as it does by short steps. ORACLE: 0.467 m/s of 1.981 m/s by steps of a millisecond.
#[test]
fn a_box_comes_off_ground_as_by_short_steps() {
    let run = ran(BOX, &[]);
    let [up, met] = rebound(&run);
    let contact = run.summary.stages.last().unwrap().energy.unwrap().contact;
    println!("{up} after {met} m/s, contact {contact}");
    assert!((up - 0.467).abs() < 0.03, "{up} of {met}");
    assert!((0.0..0.04 * 4000.0).contains(&contact), "{contact}");
}

/// GOAL: a block that friction stops on ground that moves is where a sliding block is. ORACLE: 49.6 mm, by two-sided friction on rigid
/// ground.
#[test]
fn a_block_that_turns_back_slides_as_far_as_friction_leaves() {
    let ways = values(&ran(BLOCK, &[]));
    let end = 1e3 * (ways[ways.len() - 1] - ways[0]);
    println!("{end} mm in {} steps", ways.len());
    assert!((end - 49.6).abs() < 2.0, "{end}");
}
