//! GOAL: soil whose stiffness grows with stress has it in its results, and water in its pores that is as much stiffer as the soil.
//! CASE: a column of Cam-clay or Hardening Soil at rest under 100 or 1000 kPa, ten times the reference pressure, undrained, loaded by a
//! hundredth of that. Cam-clay is pressed from stresses that are all alike, where it has no coupling of volume and shear; Hardening Soil is
//! relieved, which is elastic.
//! ORACLE: E = 3 (1 − 2ν) p/κ*, E = E_ur σ₃/p_ref; of a load on elastic soil water takes K_w/(K_w + M), M = K + 4/3 G, where K_w follows from
//! undrained_poisson at any stiffness.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

const CAM_CLAY: &str = r#"
model = "modified-cam-clay"
lambda = 0.1
kappa = 0.02
critical_ratio = 1.0
poisson = 0.25
"#;
const HARDENING_SOIL: &str = r#"
model = "hardening-soil"
cohesion = "0 kPa"
friction = "33 deg"
e50 = "18 MPa"
eur = "60 MPa"
eoed = "17 MPa"
power = 1.0
poisson = 0.2
"#;

/// Effective stress along x and y, excess pressure and Young's modulus \[kPa\] under a load \[kPa\] on soil that lies under a hundred
/// times as much.
fn loaded(soil: &str, load: f64) -> [f64; 4] {
    let (k0, factor) = if soil == CAM_CLAY {
        (1.0, 1)
    } else {
        (0.7, -1)
    };
    let text = format!(
        r#"
igimp = 1
[case]
title = "column"
gravity = "9.81 m/s2"
[grid]
cell = "0.1 m"
domain = {{ x = ["0 m", "0.1 m"], y = ["0 m", "0.5 m"] }}
[materials.cap]
model = "elastic"
unit_weight = "{weight} kN/m3"
young = "100 MPa"
poisson = 0.0
k0 = 0.5
[materials.soil]
{soil}
unit_weight = "0 kN/m3"
ocr = 2
k0 = {k0}
drainage = "undrained"
undrained_poisson = 0.495
[[bodies]]
name = "soil"
material = "soil"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["0.1 m", "0 m"], ["0.1 m", "0.2 m"], ["0 m", "0.2 m"]]
[[bodies]]
name = "cap"
material = "cap"
points_per_cell = 4
polygon = [["0 m", "0.2 m"], ["0.1 m", "0.2 m"], ["0.1 m", "0.3 m"], ["0 m", "0.3 m"]]
[boundaries]
left = "roller"
right = "roller"
bottom = "fixed"
[[loads]]
name = "p"
type = "pressure"
from = ["0 m", "0.3 m"]
to = ["0.1 m", "0.3 m"]
pressure = "{load} kPa"
[[stages]]
name = "rest"
type = "k0"
steps = 1
[[stages]]
name = "load"
type = "load"
load = "p"
factor = {factor}
steps = 4
geometry = "given"
[[monitors]]
name = "soil"
point = ["0.025 m", "0.025 m"]
record = ["sigma_eff_xx", "sigma_eff_yy", "u_excess", "young"]
[output]
report = false
figures = []
"#,
        weight = 1000.0 * load,
    );
    let file = CaseFile::parse("column.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let row = run.monitors[0].rows.last().unwrap();
    std::array::from_fn(|k| row[row.len() - 4 + k] / 1e3)
}

#[test]
fn stiffness_of_soil_and_of_its_water_go_with_stress() {
    for (soil, poisson) in [(CAM_CLAY, 0.25), (HARDENING_SOIL, 0.2)] {
        let bulk = 1.0 / (3.0 * (1.0 - 2.0 * poisson));
        let shear = 1.0 / (2.0 * (1.0 + poisson));
        let water = 2.0 * shear * 1.495 / (3.0 * 0.01) - bulk;
        let share = water / (water + bulk + 4.0 / 3.0 * shear);
        for load in [1.0, 10.0] {
            let [side, axial, excess, young] = loaded(soil, load);
            let expected = if soil == CAM_CLAY {
                3.0 * (1.0 - 2.0 * poisson) * (2.0 * side + axial) / 3.0 / 0.02
            } else {
                60e3 * side / 100.0
            };
            assert!(
                (young / expected - 1.0).abs() < 1e-3,
                "{young} for {expected}"
            );
            let found = excess.abs() / load;
            assert!((found / share - 1.0).abs() < 2e-3, "{found} for {share}");
        }
    }
}
