//! GOAL: slopes that fall short of strength come to rest, however stiff their soil, and as far down however finely their way is divided.
//! CASE: a slope of 8 m, 1:2, in soil of c and φ that does not dilate, on cells of 1 m and half a metre, with its strength divided by 2.5,
//! 1.2 times F. Its weight comes on the geometry that is given, so that it is 8 m high however soft it is.
//! ORACLE: equilibrium without drag at the end, which the last step finds; the way goes by strength and weight alone, so that neither
//! stiffness nor the motion aimed at in a step may change it, and the cell hardly.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

/// The largest displacement of the slope \[m\] that comes to rest, with Young's modulus \[MPa\], motion of a step \[cells\] and cell \[m\].
fn way(young: f64, move_per_step: f64, cell: f64) -> f64 {
    let text = format!(
        r#"
igimp = 1
[case]
title = "slope"
[grid]
cell = "{cell} m"
domain = {{ x = ["0 m", "36 m"], y = ["0 m", "14 m"] }}
[materials.clay]
model = "mohr-coulomb"
unit_weight = "20 kN/m3"
young = "{young} MPa"
poisson = 0.3
cohesion = "12.4 kPa"
friction = "28.1 deg"
dilation = "0 deg"
[[bodies]]
name = "slope"
material = "clay"
polygon = [["0 m","0 m"], ["36 m","0 m"], ["36 m","4 m"], ["28 m","4 m"], ["12 m","12 m"], ["0 m","12 m"]]
[[stages]]
name = "weight"
type = "gravity"
geometry = "given"
steps = 10
reset_displacements = true
[[stages]]
name = "run-out"
type = "run-out"
reduction = {{ factor = 2.5 }}
steps = 400
move_per_step = {move_per_step}
[output]
report = false
figures = []
"#
    );
    let file = CaseFile::parse("slope.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    assert!(run.failure.is_none(), "{young} {:?}", run.failure);
    let stage = &run.summary.stages[1];
    let stands = stage.reason.contains("then in equilibrium without drag");
    assert!(stands, "{young} {}", stage.reason);
    stage.largest_displacement
}

#[test]
fn slopes_of_stiff_soil_come_to_rest() {
    let ways = [
        (10.0, 0.1, 1.0),
        (20.0, 0.1, 1.0),
        (50.0, 0.05, 1.0),
        (150.0, 0.1, 1.0),
        (10.0, 0.1, 0.5),
    ]
    .map(|(young, step, cell)| way(young, step, cell));
    let longest = ways.iter().fold(0.0_f64, |a, b| a.max(*b));
    let shortest = ways.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    assert!(longest > 1.2 && longest / shortest < 1.04, "{ways:?}");
}
