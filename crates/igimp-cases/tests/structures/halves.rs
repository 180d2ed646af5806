//! GOAL: half and quarter of a body whose sides slant to the planes of symmetry carry what the whole does.
//! CASE: a smooth sphere that is pushed into an elastic block by a fifth of its radius, its middle on the planes.
//! ORACLE: the whole sphere in the whole block, with the same cells (theory, eq. 45h).

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

/// The force on the whole sphere, of which so much is in the grid: from x and y on \[m\].
fn pushed_in([x, y]: [f64; 2]) -> f64 {
    let parts = [x, y].map(|own| if own < 0.0 { 1 } else { 2 });
    let text = format!(
        r#"
igimp = 1
[case]
title = "A sphere"
gravity = "0 m/s2"
analysis = "3d"
[grid]
cell = "0.25 m"
domain = {{ x = ["{x} m", "1.5 m"], y = ["{y} m", "1.5 m"], z = ["0 m", "1.5 m"] }}
[materials.soil]
model = "elastic"
unit_weight = "18 kN/m3"
young = "5 MPa"
poisson = 0.4
[[bodies]]
name = "ground"
material = "soil"
box = {{ from = ["{x} m", "{y} m", "0 m"], to = ["1.5 m", "1.5 m", "1 m"] }}
[[rigid]]
name = "sphere"
type = "sphere"
centre = ["0 m", "0 m", "1.6 m"]
radius = "0.55 m"
interface = "smooth"
force_factor = {}
most_penetration = 0.5
[[stages]]
name = "push"
type = "rigid"
steps = 10
bodies = [{{ body = "sphere", z = "-0.12 m" }}]
[[curves]]
name = "force"
x = {{ of = "rigid.sphere.z" }}
y = {{ of = "rigid.sphere.resistance" }}
[output]
figures = []
report = false
"#,
        parts[0] * parts[1]
    );
    let file = CaseFile::parse("sphere.toml", &text, &[]).unwrap();
    let case = file.case_in_space();
    let run = in_memory(case).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let curve = run.curves.iter().find(|own| own.name == "force").unwrap();
    let all = curve.points(0, 1);
    all[all.len() - 1][1]
}

#[test]
fn half_of_a_sphere_carries_half() {
    let whole = pushed_in([-1.5, -1.5]);
    let half = pushed_in([0.0, -1.5]);
    let quarter = pushed_in([0.0, 0.0]);
    println!("{whole} {half} {quarter}");
    for own in [half, quarter] {
        assert!((own / whole - 1.0).abs() < 1e-6, "{own} {whole}");
    }
}
