//! GOAL: how contact closes: gaps that a given geometry keeps, and the soft beginning of pressure.
//! CASE: a smooth plate above an elastic slab between smooth walls.
//! ORACLE: nothing touches across a gap; one-dimensional compression in series with eq. 46.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

/// The force under a plate that starts a gap above a slab 2 m high and goes down by a way \[m\], per metre run \[N/m\], and what was warned of.
fn pressed([gap, way]: [f64; 2], geometry: &str) -> (f64, String) {
    let text = format!(
        r#"
igimp = 1
[case]
title = "a plate above a slab"
gravity = "0 m/s2"
[grid]
cell = "0.25 m"
domain = {{ x = ["0 m", "1 m"], y = ["0 m", "3.5 m"] }}
[materials.slab]
model = "elastic"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.3
[[bodies]]
name = "slab"
material = "slab"
polygon = [["0 m", "0 m"], ["1 m", "0 m"], ["1 m", "2 m"], ["0 m", "2 m"]]
[[rigid]]
name = "plate"
type = "rectangle"
from = ["-1 m", "{base} m"]
to = ["2 m", "3 m"]
interface = "smooth"
rounding = 0
[[stages]]
name = "press"
type = "rigid"
bodies = [{{ body = "plate", y = "-{way} m" }}]
steps = 10
geometry = "{geometry}"
[[curves]]
name = "resistance"
x = {{ of = "step" }}
y = {{ of = "rigid.plate.resistance" }}
[output]
report = false
figures = []
"#,
        base = 2.0 + gap,
    );
    let file = CaseFile::parse("plate.toml", &text, &[]);
    let file = file.unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    let end = run.curves[0].rows.last().unwrap()[1];
    (end, run.summary.warnings.join("\n"))
}

/// GOAL: a body that no soil is near on a geometry that stays as it is drawn is told of, with the gap; one that is near, or moves, is not.
#[test]
fn a_gap_that_never_closes_is_told() {
    let told = "\"plate\" stands 0.2 m off all soil";
    let (force, warned) = pressed([0.2, 0.205], "given");
    assert!(
        force.abs() < 1e-6 && warned.contains(told),
        "{force} {warned}"
    );
    for (gap, geometry) in [(0.2, "moving"), (0.02, "given"), (0.0, "given")] {
        let (force, warned) = pressed([gap, gap + 0.005], geometry);
        assert!(
            force > 1e4 && !warned.contains("off all soil"),
            "{gap} {geometry}: {force} {warned}"
        );
    }
}

/// GOAL: small settlements find too little stiffness, by as much as soil goes into a body at its pressure.
/// ORACLE: with the modulus M of one-dimensional compression, p = M (way − w)/2 m and w = h √(0.04 p/(30 E)): 7 % less than M way/2 m
/// at 10 mm, 21 % at 1 mm.
#[test]
fn contact_closes_softly() {
    let (young, cell) = (10e6_f64, 0.25);
    let modulus = young * 0.7 / (1.3 * 0.4);
    for (way, less) in [(0.01, 0.072), (0.001, 0.21)] {
        let stiff = modulus * way / 2.0;
        let into = |p: f64| cell * (0.04 * p / (30.0 * young)).sqrt();
        let soft = (0..200).fold(stiff, |p, _| 0.5 * (p + modulus * (way - into(p)) / 2.0));
        let (force, _) = pressed([0.0, way], "given");
        println!("{way} m: {force} of {stiff} N/m");
        assert!((force / soft - 1.0).abs() < 1e-3, "{force} {soft}");
        assert!((1.0 - force / stiff - less).abs() < 0.01, "{force} {stiff}");
    }
}
