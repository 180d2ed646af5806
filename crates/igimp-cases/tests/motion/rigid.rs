//! GOAL: rigid bodies that are held or moved in time have the forces that hold and move them, by every scheme.
//! CASE: elastic soil that lies on a rigid base, between smooth walls.
//! ORACLE: the weight of the soil.

use igimp_cases::run::in_memory;
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
        let curve = run.curves.iter().find(|own| own.name == "force");
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
