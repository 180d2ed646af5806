//! GOAL: rigid bodies that are held or moved in time have the forces that hold and move them, by every scheme.
//! CASE: elastic soil that lies on a rigid base, between smooth walls.
//! ORACLE: the weight of the soil.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

/// Soil 2 m wide and 2 m high, which nothing else holds from below.
const ON_BASE: &str = r#"
igimp = 1
[case]
title = "Soil on a rigid base"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "2 m"], y = ["0 m", "4 m"] }
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.3
[[bodies]]
name = "soil"
material = "soil"
points_per_cell = 4
polygon = [["0 m", "1 m"], ["2 m", "1 m"], ["2 m", "3 m"], ["0 m", "3 m"]]
[boundaries]
left = "roller"
right = "roller"
[[rigid]]
name = "base"
type = "rectangle"
from = ["0 m", "0 m"]
to = ["2 m", "1 m"]
interface = "smooth"
rounding = 0
from_start = true
[[stages]]
name = "weight"
type = "gravity"
steps = 2
[[stages]]
name = "still"
type = "dynamic"
duration = "0.05 s"
steps = 2
[[curves]]
name = "force"
x = { of = "time" }
y = { of = "rigid.base.force_y" }
"#;

/// GOAL: statics begins with soil that lies on a body, and motion at rest holds the body by the weight of the soil.
#[test]
fn a_base_is_held_by_the_weight_of_what_lies_on_it() {
    for scheme in ["backward-euler", "newmark", "generalised-alpha"] {
        let change = format!("stages.still.scheme = {scheme}");
        let file = CaseFile::parse("base.toml", ON_BASE, &[change]).unwrap();
        assert!(file.warnings().is_empty(), "{:?}", file.warnings());
        let run = in_memory(file.case()).unwrap();
        let curve = run.curves.iter().find(|curve| curve.name == "force");
        let points = curve.unwrap().points(0, 1);
        let last = points[points.len() - 1];
        assert!((last[0] - 0.05).abs() < 1e-12, "{last:?}");
        let weight = 18e3 * 4.0;
        assert!(
            (last[1] - weight).abs() < 2e-3 * weight,
            "{scheme} {last:?}"
        );
    }
}

/// Soil at rest, and a bar that hangs aside from a pin which it turns about, without touching anything.
const PENDULUM: &str = r#"
igimp = 1
[case]
title = "A bar on a pin"
gravity = "10 m/s2"
[grid]
cell = "0.25 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "6 m"] }
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.3
[[bodies]]
name = "soil"
material = "soil"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["6 m", "0 m"], ["6 m", "1 m"], ["0 m", "1 m"]]
[[rigid]]
name = "bar"
type = "rectangle"
from = ["3 m", "3.75 m"]
to = ["5 m", "4.25 m"]
reference = ["3 m", "4 m"]
weight = "10 kN/m"
[[stages]]
name = "weight"
type = "gravity"
steps = 2
[[stages]]
name = "swing"
type = "dynamic"
duration = "1.5 s"
steps = 100
bodies = [{ body = "bar", free = ["rotation"] }]
[[curves]]
name = "force"
stage = "swing"
x = { of = "rigid.bar.rotation" }
y = { of = "rigid.bar.force_y" }
[output]
figures = []
"#;

fn swung(changes: &[&str]) -> Run<2> {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    let file = CaseFile::parse("pendulum.toml", PENDULUM, &changes).unwrap();
    assert!(file.warnings().is_empty(), "{:?}", file.warnings());
    in_memory(file.case()).unwrap()
}

/// GOAL: a body turns by the weight at its centroid about a pin, and the pin has the force that holds it on its way.
/// ORACLE: a bar of mass m, length 2 and height ½ about its end, from level: ω² = 2 m g sin φ / I with I = m (1 + (4 + ¼) / 12), upward force
/// m g + m (ω² sin φ − α cos φ) with α = m g cos φ / I; at its lowest m g (1 + 2 m / I).
#[test]
fn the_pin_of_a_bar_has_the_force_of_its_turn() {
    let run = swung(&[]);
    let curve = run
        .curves
        .iter()
        .find(|curve| curve.name == "force")
        .unwrap();
    let inertia = 1.0 + 4.25 / 12.0;
    let (mut seen, mut most) = (0, 0.0_f64);
    // By the generalised-alpha method forces are those of a moment within the step: where the bar turns fast, they are held at its lowest.
    for [rotation, force] in curve.points(0, 1).into_iter().skip(2) {
        let (sin, cos) = (-rotation).sin_cos();
        let (squared, rate) = (20.0 * sin / inertia, 10.0 * cos / inertia);
        let exact = 1e3 * (10.0 + squared * sin - rate * cos);
        most = most.max(force);
        if sin > 0.05 && cos > 0.0 {
            assert!(
                (force / exact - 1.0).abs() < 0.05,
                "{rotation}: {force} {exact}"
            );
            seen += 1;
        }
    }
    let lowest = 1e4 * (1.0 + 2.0 / inertia);
    assert!(
        (most / lowest - 1.0).abs() < 2e-3 && seen > 20,
        "{most} {lowest} {seen}"
    );
}

/// GOAL: a stage of motion ends where its displacement is reached, and does not rest where a body turns back.
/// ORACLE: the bar swings without end, and stands still 0.7 s after it was let go, its kinetic energy then none.
#[test]
fn a_motion_ends_as_its_case_says() {
    let run = swung(&["stages.swing.at_rest=1e-3", "stages.swing.duration=\"3 s\""]);
    let stage = run.summary.stages.last().unwrap();
    assert!((stage.reached - 1.0).abs() < 1e-12, "{}", stage.reason);
}
