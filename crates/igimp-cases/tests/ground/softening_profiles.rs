//! GOAL: the strain that a softening curve states is that of the particle, whatever strength and stiffness other soil of its material has,
//! and the strength that is told is the one that is left.
//! CASE: a block of one cell that is pushed together; soil of the same material, stronger or stiffer, stands apart from it.
//! ORACLE: the line that the file states, 10 kPa to half of it over κ = 0.1; the block of soil that does not vary.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;

fn parsed(strength: &str, young: &str, strain: &str) -> Result<CaseFile, String> {
    let text = format!(
        r#"
igimp = 1
[case]
title = "block"
gravity = "0 m/s2"
[grid]
cell = "0.5 m"
domain = {{ x = ["0 m", "4 m"], y = ["0 m", "2.5 m"] }}
[materials.clay]
model = "von-mises"
unit_weight = "20 kN/m3"
poisson = 0.49
young = {young}
cu = {strength}
softening = {{ cu = {{ residual = 0.5, strain = {strain}, curve = "linear" }} }}
[[bodies]]
name = "block"
material = "clay"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["1 m", "0 m"], ["1 m", "1 m"], ["0 m", "1 m"]]
[[bodies]]
name = "apart"
material = "clay"
points_per_cell = 4
polygon = [["3 m", "0 m"], ["4 m", "0 m"], ["4 m", "2 m"], ["3 m", "2 m"]]
[boundaries]
left = "roller"
right = "roller"
bottom = "roller"
[[loads]]
name = "plate"
type = "rigid-footing"
interface = "smooth"
from = ["0 m", "1 m"]
to = ["1 m", "1 m"]
[[stages]]
name = "push"
type = "displacement"
load = "plate"
settlement = "0.05 m"
steps = 20
geometry = "given"
[[monitors]]
name = "middle"
point = ["0.5 m", "0.5 m"]
record = ["sigma_xx", "sigma_yy", "plastic_strain", "strength"]
[output]
report = false
figures = []
"#
    );
    CaseFile::parse("block.toml", &text, &[]).map_err(|error| error.to_string())
}

/// A value in the block, and twice or nine times as much in soil beyond the block, by the level.
fn above(low: &str, high: &str) -> String {
    format!(
        "{{ levels = [\"0 m\", \"1 m\", \"1.1 m\", \"2 m\"], values = [\"{low}\", \"{low}\", \"{high}\", \"{high}\"] }}"
    )
}

#[test]
fn soil_apart_changes_no_softening_curve() {
    let constant = ["\"10 kPa\"".to_owned(), "\"20 MPa\"".to_owned()];
    let stronger = [above("10 kPa", "90 kPa"), constant[1].clone()];
    let stiffer = [constant[0].clone(), above("20 MPa", "200 MPa")];
    let pushed = |[strength, young]: &[String; 2]| {
        let run = in_memory(parsed(strength, young, "0.1").unwrap().case()).unwrap();
        assert!(run.failure.is_none(), "{:?}", run.failure);
        let row = run.monitors[0].rows.last().unwrap();
        let [xx, yy, kappa, strength] = row[row.len() - 4..] else {
            unreachable!()
        };
        (0.5 * (yy - xx), kappa, strength)
    };
    let (first, ..) = pushed(&constant);
    for soil in [&constant, &stronger, &stiffer] {
        let (shear, kappa, strength) = pushed(soil);
        let left = 1e4 * (1.0 - 0.5 * kappa / 0.1);
        assert!(kappa > 0.04 && kappa < 0.1, "{kappa}");
        assert!((shear / left - 1.0).abs() < 1e-6, "{shear} for {left}");
        assert!(
            (strength / left - 1.0).abs() < 1e-9,
            "{strength} for {left}"
        );
        assert!((shear / first - 1.0).abs() < 1e-6, "{shear} {first}");
    }
}

/// Where 200 kPa have 2 MPa the slope of c_u over κ, 100 kPa over 0.1, is beyond √3 G; where they have 200 MPa it is far from it.
#[test]
fn snap_back_is_refused_where_soil_is_soft_beside_its_strength() {
    let young = above("1 MPa", "200 MPa");
    let refused = parsed("\"200 kPa\"", &young, "0.1").unwrap_err();
    assert!(refused.contains("snaps back within the point"), "{refused}");
    parsed("\"200 kPa\"", "\"200 MPa\"", "0.1").unwrap();
    parsed("\"200 kPa\"", &young, "0.3").unwrap();
}
