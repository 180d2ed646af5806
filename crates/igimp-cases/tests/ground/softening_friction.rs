//! Friction that softens and varies from place to place.

use igimp_cases::run::in_memory;
use igimp_input::CaseFile;
use igimp_report::setup;

/// A block of one cell, so that no band forms, that is pushed together between smooth plates; soil of the same material that nothing moves lies higher.
const TEXT: &str = r#"
igimp = 1

[case]
title = "Block of sand that softens"
gravity = "0 m/s2"

[grid]
cell = "1 m"
domain = { x = ["0 m", "4 m"], y = ["0 m", "4 m"] }

[boundaries]
left = "roller"
right = "roller"
bottom = "roller"

[materials.sand]
model = "mohr-coulomb"
friction = FRICTION
cohesion = "20 kPa"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.3
softening = { friction = { residual = "RESIDUAL deg", strain = 0.02 } }

[materials.rock]
model = "elastic"
unit_weight = "18 kN/m3"
young = "100 MPa"
poisson = 0.3

[[bodies]]
name = "block"
material = "sand"
polygon = [["0 m", "0 m"], ["1 m", "0 m"], ["1 m", "1 m"], ["0 m", "1 m"]]

[[bodies]]
name = "base"
material = "rock"
polygon = [["3 m", "0 m"], ["4 m", "0 m"], ["4 m", "2 m"], ["3 m", "2 m"]]

[[bodies]]
name = "top"
material = "sand"
polygon = [["3 m", "2 m"], ["4 m", "2 m"], ["4 m", "3 m"], ["3 m", "3 m"]]

[[loads]]
name = "plate"
type = "rigid-footing"
from = ["0 m", "1 m"]
to = ["1 m", "1 m"]
interface = "smooth"

[[stages]]
name = "push"
type = "displacement"
load = "plate"
settlement = "0.04 m"
steps = 8

[output]
folder = "results"
"#;

const PROFILE: &str = "{ levels = [\"1 m\", \"2 m\"], values = [\"20 deg\", \"35 deg\"] }";

fn parsed(friction: &str, residual: f64, overrides: &[&str]) -> Result<CaseFile, String> {
    let text = TEXT
        .replace("FRICTION", friction)
        .replace("RESIDUAL", &residual.to_string());
    let overrides: Vec<String> = overrides.iter().map(|&entry| entry.to_owned()).collect();
    CaseFile::parse("block.toml", &text, &overrides).map_err(|error| error.to_string())
}

/// Stresses in the block \[Pa\], and the largest softening strain there.
fn pushed(friction: &str, residual: f64) -> (Vec<[[f64; 3]; 3]>, f64) {
    let file = parsed(friction, residual, &[]).unwrap();
    let run = in_memory(file.case()).unwrap();
    let particles = &run.body.particles;
    let in_block = |p: &usize| particles.x[*p][0] < 2.0;
    let block: Vec<usize> = (0..particles.sigma.len()).filter(in_block).collect();
    let most = block.iter().map(|p| particles.internal[*p][0]);
    (
        block.iter().map(|p| particles.sigma[*p]).collect(),
        most.fold(0.0, f64::max),
    )
}

/// GOAL: soil whose friction varies softens with the initial and the residual friction of its place, in one proportion by their
/// tangents. ORACLE: the same block of soil of one friction with those two angles. BAND: 1e-9 of the stress, with ψ = 0,
/// for cells share strain by ψ/φ of the material and not of the place. Control: with another
/// residual friction the block ends on other stresses.
#[test]
fn friction_softens_from_that_of_its_place() {
    let tan = |angle: f64| angle.to_radians().tan();
    let of_place = (tan(24.0) * tan(20.0) / tan(35.0)).atan().to_degrees();
    let (varied, kappa) = pushed(PROFILE, 24.0);
    let (constant, _) = pushed("\"20 deg\"", of_place);
    let (control, _) = pushed("\"20 deg\"", 19.0);
    assert!(kappa > 0.02, "it was sheared far: {kappa}");
    let apart = |one: &[[[f64; 3]; 3]], other: &[[[f64; 3]; 3]]| {
        let pairs = one.as_flattened().as_flattened().iter();
        let pairs = pairs.zip(other.as_flattened().as_flattened());
        pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    };
    let size = constant[0][1][1].abs();
    println!(
        "{of_place} deg, {kappa}, {size} Pa: {:e}",
        apart(&varied, &constant)
    );
    assert!(apart(&varied, &constant) < 1e-9 * size);
    assert!(apart(&varied, &control) > 0.01 * size);
}

/// GOAL: the report says which friction is left where; a curve that snaps back at a friction within the profile is refused with that
/// friction.
/// ORACLE: with ψ = 0 stress snaps back along the edge of triaxial compression where −dc/dκ 2 cos φ/(3 − sin φ) reaches G, the most at
/// sin φ = 1/3, which is 19.5°: there a strain is refused that 35° and a profile from 32° on allow.
#[test]
fn friction_that_softens_and_varies_is_told() {
    let file = parsed(PROFILE, 24.0, &[]).unwrap();
    let words = setup::tables(file.case())[0].rows[0].join(" | ");
    let expected =
        "φ to 24° exponentially over a plastic strain of 0.02, φ in the end where it is greatest";
    assert!(words.contains(expected), "{words}");
    let brittle = |angle: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        2.0 * cos / (3.0 - sin)
    };
    let shear = 10e6 / 2.6;
    let strain = 0.9 * 20e3 * 0.5 * (brittle(19.47) + brittle(32.0)) / (0.99 * shear);
    let steep = format!(
        "materials.sand.softening={{ cohesion = {{ residual = 0.1, strain = {strain}, curve = \"linear\" }} }}"
    );
    let refused = |friction: &str| parsed(friction, 24.0, &[&steep]).err();
    let from = |angle: f64| {
        format!("{{ levels = [\"1 m\", \"2 m\"], values = [\"{angle} deg\", \"35 deg\"] }}")
    };
    assert_eq!(refused("\"35 deg\""), None);
    assert_eq!(refused(&from(32.0)), None);
    let message = refused(&from(0.0)).unwrap();
    let (_, rest) = message
        .split_once("is not possible where its friction is ")
        .unwrap();
    let angle: f64 = rest.split(' ').next().unwrap().parse().unwrap();
    assert!(
        (5.0..30.0).contains(&angle) && rest.contains("stress snaps back"),
        "{message}"
    );
}
