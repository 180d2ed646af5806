//! GOAL: soil around an axis has the strength of the direction of its major compression, which may go around that axis.
//! CASE: thick cylinders between rollers, pressed from outside or from within.
//! ORACLE: a Tresca cylinder at collapse carries p = 2 s ln(b/a). Pressed from outside its major compression goes around the axis, from
//! within along the radius: both are level, so that s is the passive strength.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

/// The factor of safety of a cylinder from 1 to 2 m under 50 kPa, of clay with a strength of 100 kPa and half of it where the major
/// compression is level.
fn factor_of_cylinder(from_outside: bool) -> f64 {
    let radius = if from_outside { 2 } else { 1 };
    let text = format!(
        r#"
igimp = 1
[case]
title = "thick cylinder"
analysis = "axisymmetric"
gravity = "0 m/s2"
[grid]
cell = "0.125 m"
domain = {{ x = ["0.75 m", "2.25 m"], y = ["0 m", "0.25 m"] }}
[materials.clay]
model = "tresca"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.45
cu = "100 kPa"
anisotropy = {{ simple_shear = 0.75, passive = 0.5 }}
[[bodies]]
name = "cylinder"
material = "clay"
points_per_cell = 4
polygon = [["1 m", "0 m"], ["2 m", "0 m"], ["2 m", "0.25 m"], ["1 m", "0.25 m"]]
[boundaries]
left = "free"
right = "free"
bottom = "roller"
top = "roller"
[[loads]]
name = "p"
type = "pressure"
from = ["{radius} m", "0 m"]
to = ["{radius} m", "0.25 m"]
pressure = "50 kPa"
[[stages]]
name = "load"
type = "load"
load = "p"
factor = 1
steps = 5
geometry = "given"
[[stages]]
name = "safety"
type = "strength-reduction"
geometry = "given"
[output]
report = false
figures = []
"#
    );
    let file =
        CaseFile::parse("cylinder.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let found = run.summary.stages[1].safety.as_ref().unwrap();
    let stable = found.stable.unwrap();
    0.5 * (stable + found.failed.unwrap_or(stable))
}

#[test]
fn cylinders_of_clay_have_the_strength_of_level_compression() {
    let exact = 2.0 * 50.0 * 2.0_f64.ln() / 50.0;
    for from_outside in [true, false] {
        let found = factor_of_cylinder(from_outside);
        assert!((found / exact - 1.0).abs() < 0.01, "{found} for {exact}");
    }
}
