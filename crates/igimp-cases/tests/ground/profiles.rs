//! Materials whose strength, stiffness and weight vary with the level: refusals with reasons, and
//! values of particles.

use std::fmt::Write;

use igimp_cases::run::Model;
use igimp_cases::run::in_memory;
use igimp_input::CaseFile;
use igimp_model::{Case, Field, Variation};
use igimp_report::setup;
use igimp_results::fields;

use crate::edits::{Edits, edited};

const TEXT: &str = r#"
igimp = 1

[case]
title = "Ground that grows stronger with depth"

[grid]
cell = "0.5 m"
domain = { x = ["0 m", "2 m"], y = ["0 m", "5 m"] }

[boundaries]
left = "roller"
right = "roller"
bottom = "fixed"

[materials.clay]
model = "mohr-coulomb"
friction = "20 deg"
cohesion = { at_top = "0 kPa", gradient = "2 kPa/m" }
unit_weight = { levels = ["5 m", "3 m", "0 m"], values = ["16 kN/m3", "18 kN/m3", "18 kN/m3"] }
young = { at_top = "6 MPa", gradient = "1.5 MPa/m", from = "4 m" }
poisson = 0.3
k0 = 0.5

[[bodies]]
name = "ground"
material = "clay"
polygon = [["0 m", "0 m"], ["2 m", "0 m"], ["2 m", "5 m"], ["0 m", "5 m"]]

[[stages]]
name = "rest"
type = "k0"
steps = 1
"#;

const COHESION: &str = "{ at_top = \"0 kPa\", gradient = \"2 kPa/m\" }";

/// The same ground of Tresca soil of one unit weight.
fn undrained(cu: &str) -> String {
    let weight = "{ levels = [\"5 m\", \"3 m\", \"0 m\"], values = [\"16 kN/m3\", \"18 kN/m3\", \"18 kN/m3\"] }";
    edited(
        TEXT,
        &[
            ("mohr-coulomb", "tresca"),
            ("friction = \"20 deg\"\n", ""),
            (&format!("cohesion = {COHESION}"), &format!("cu = {cu}")),
            (weight, "\"18 kN/m3\""),
        ],
    )
}

fn case(edits: Edits<'_>) -> Case<2> {
    CaseFile::parse("ground.toml", &edited(TEXT, edits), &[])
        .unwrap_or_else(|error| panic!("{error}"))
        .case()
        .clone()
}

/// Profiles of the cohesion that make no sense.
const COHESIONS: [&str; 27] = [
    "{ at_top = \"8 kPa\", gradient = \"-2 kPa/m\" }",
    "{ at_top = \"0 kPa\", gradient = \"0 kPa/m\" }",
    "{ at_top = \"8 kPa\", gradient = \"2 kPa\" }",
    "{ at_top = \"8 kPa\", gradient = 2 }",
    "{ at_top = \"8 kPa\", gradient = \"2 kN/m3\" }",
    "{ at_top = \"-8 kPa\", gradient = \"2 kPa/m\" }",
    "{ at_top = \"8 kPa\" }",
    "{ gradient = \"2 kPa/m\" }",
    "{ levels = [\"5 m\", \"0 m\"] }",
    "{ }",
    "{ at_top = \"8 kPa\", levels = [\"5 m\", \"0 m\"], values = [\"1 kPa\", \"2 kPa\"] }",
    "{ levels = [\"5 m\", \"2 m\", \"3 m\"], values = [\"1 kPa\", \"2 kPa\", \"3 kPa\"] }",
    "{ levels = [\"5 m\", \"5 m\"], values = [\"1 kPa\", \"2 kPa\"] }",
    "{ levels = [\"5 m\", \"2 m\", \"0 m\"], values = [\"1 kPa\", \"2 kPa\"] }",
    "{ levels = [\"5 m\", \"0 m\"], values = [\"1 kPa\", \"-2 kPa\"] }",
    "{ levels = [\"5 m\"], values = [\"1 kPa\"] }",
    "{ depth = \"5 m\" }",
    "{ at_surface = \"8 kPa\", gradient = \"-2 kPa/m\" }",
    "{ at_surface = \"8 kPa\", gradient = \"2 kPa/m\", from = \"4 m\" }",
    "{ at_surface = \"8 kPa\" }",
    "{ at_top = \"8 kPa\", at_surface = \"8 kPa\", gradient = \"2 kPa/m\" }",
    "{ depths = [\"0 m\", \"-2 m\"], values = [\"1 kPa\", \"2 kPa\"] }",
    "{ depths = [\"0 m\", \"2 m\", \"1 m\"], values = [\"1 kPa\", \"2 kPa\", \"2 kPa\"] }",
    "{ depths = [\"1 m\", \"2 m\"] }",
    "{ values = [\"1 kPa\", \"2 kPa\"] }",
    "{ ratio = 0.2 }",
    "[\"1 kPa\", \"2 kPa\"]",
];

/// Edits of other values to profiles.
const EDITS: [(&str, &str); 3] = [
    ("gradient = \"1.5 MPa/m\"", "gradient = \"-1.5 MPa/m\""),
    (
        "friction = \"20 deg\"",
        "friction = \"20 deg\"\ntension_cutoff = \"1 kPa\"",
    ),
    (
        "\"16 kN/m3\", \"18 kN/m3\", \"18 kN/m3\"",
        "\"16 kPa\", \"18 kN/m3\", \"18 kN/m3\"",
    ),
];

/// Profiles of the friction that make no sense, with the text beside them.
const FRICTIONS: [(&str, &str); 5] = [
    ("{ at_top = \"20 deg\", gradient = \"1 kPa/m\" }", ""),
    (
        "{ depths = [\"0 m\", \"2 m\"], values = [\"20 deg\", \"95 deg\"] }",
        "",
    ),
    (
        "{ levels = [\"5 m\", \"0 m\"], values = [\"20 deg\", \"30 deg\"] }",
        "dilation = \"31 deg\"",
    ),
    (
        "{ levels = [\"5 m\", \"0 m\"], values = [\"20 deg\", \"30 deg\"] }",
        "k0 = \"jaky\"",
    ),
    ("{ }", ""),
];

/// Undrained strengths as shares of the stress that make no sense.
const SHARES: [&str; 6] = [
    "{ ratio = 0.22, at_top = \"8 kPa\" }",
    "{ ocr = 2 }",
    "{ ratio = 0 }",
    "{ ratio = 0.22, ocr = { levels = [\"5 m\", \"0 m\"], values = [2] } }",
    "{ ratio = 0.22, ocr = { levels = [\"5 m\", \"0 m\"], values = [2, 0] } }",
    "{ ratio = 0.22, water_level = \"5 kPa\" }",
];

#[test]
fn profiles_that_make_no_sense() {
    let mut out = String::new();
    let mut refused = |title: &str, text: &str| {
        let error = CaseFile::parse("ground.toml", text, &[]).unwrap_err();
        let _ = writeln!(out, "## {title}\n{error}");
    };
    for cohesion in COHESIONS {
        let text = edited(TEXT, &[(COHESION, cohesion)]);
        refused(&format!("cohesion = {cohesion}"), &text);
    }
    for (from, to) in EDITS {
        refused(&format!("{from:?} -> {to:?}"), &edited(TEXT, &[(from, to)]));
    }
    for (friction, others) in FRICTIONS {
        let k0 = if others.contains("k0") {
            ""
        } else {
            "k0 = 0.5"
        };
        let varied = format!("friction = {friction}\n{others}");
        let text = edited(
            TEXT,
            &[("friction = \"20 deg\"", &varied), ("k0 = 0.5", k0)],
        );
        refused(&format!("friction = {friction} {others}"), &text);
    }
    for cu in SHARES {
        refused(&format!("cu = {cu}"), &undrained(cu));
    }
    let weightless = undrained("{ ratio = 0.22 }").replace("\"18 kN/m3\"", "\"0 kN/m3\"");
    refused("cu = a share of no stress", &weightless);
    insta::assert_snapshot!(out);
}

/// GOAL: a particle has the strength, the stiffness and the density of the level that its centre starts at.
#[test]
fn particles_are_given_what_their_level_has() {
    let case = case(&[]);
    let material = &case.materials[0];
    assert!((material.cohesive() - 10e3).abs() < 1e-9);
    assert!((material.young - 12e6).abs() < 1e-6);
    let (model, state) = Model::new(&case).unwrap();
    let particles = &state.body.particles;
    for particle in 0..particles.len() {
        let y = particles.x[particle][1];
        let cohesion = material.cohesive() * particles.ratios[particle].strength;
        assert!(
            (cohesion - 2e3 * (5.0 - y)).abs() < 1e-9,
            "{cohesion} at {y}"
        );
        let young = 6e6 + 1.5e6 * (4.0 - y).max(0.0);
        assert!((particles.young(particle, &model.laws) - young).abs() < 1e-6);
        let weight = 18e3 - 1e3 * (y - 3.0).max(0.0);
        let density = particles.mass[particle] / particles.volume0[particle];
        assert!((density * case.gravity - weight).abs() < 1e-9);
    }
}

/// GOAL: a constant and a profile that is the same everywhere make the same run, to the last bit.
#[test]
fn a_profile_without_change_is_a_constant() {
    let run = |cohesion: &str| {
        let case = case(&[(COHESION, cohesion)]);
        in_memory(&case).unwrap().body.particles.sigma.clone()
    };
    let constant = run("\"10 kPa\"");
    assert_eq!(
        constant,
        run("{ at_top = \"10 kPa\", gradient = \"0 kPa/m\" }")
    );
    let table = "{ levels = [\"0 m\", \"5 m\"], values = [\"10 kPa\", \"10 kPa\"] }";
    assert_eq!(constant, run(table));
}

/// GOAL: level ground whose unit weight varies carries the weight above, and K₀ times it sideways.
/// ORACLE: the integral of the unit weight.
/// BAND: 1e-3 of the pressure at the base, the change by the weight of particles that is not level by level.
#[test]
fn ground_at_rest_carries_a_weight_that_varies() {
    let case = case(&[]);
    let run = in_memory(&case).unwrap();
    let particles = &run.body.particles;
    let weight = Variation::Table(vec![[0.0, 18e3], [3.0, 18e3], [5.0, 16e3]]);
    for particle in 0..particles.len() {
        let above = weight.integral(particles.x[particle][1], 5.0);
        let sigma = &particles.sigma[particle];
        assert!(
            (sigma[1][1] + above).abs() < 1e-3 * 88e3,
            "{} for {above}",
            sigma[1][1]
        );
        assert!((sigma[0][0] + 0.5 * above).abs() < 1e-3 * 88e3);
    }
}

#[test]
fn overrides_reach_into_a_profile() {
    let set = ["materials.clay.cohesion.gradient=\"4 kPa/m\"".to_owned()];
    let file = CaseFile::parse("ground.toml", TEXT, &set).unwrap();
    assert!((file.case().materials[0].cohesive() - 20e3).abs() < 1e-9);
    let set = ["materials.clay.cohesion=\"7 kPa\"".to_owned()];
    let file = CaseFile::parse("ground.toml", TEXT, &set).unwrap();
    assert_eq!(file.case().materials[0].profiles.strength, None);
}

#[test]
fn profiles_are_told_in_words() {
    let tables = setup::tables(&case(&[]));
    let materials = tables
        .iter()
        .find(|table| table.title == "Materials")
        .unwrap();
    assert_eq!(
        materials.rows[0].join(" | "),
        "clay | Mohr–Coulomb | 16 at y = 5 m, 18 at y = 3 m, 18 at y = 0 m | 6 down to y = 4 m, 1.5 per metre more below | \
         0.3 | c = 0 kPa down to y = 5 m, 2 kPa per metre more below, φ = 20°, ψ = 0° | 0.5"
    );
}

/// A slope of the same material on a bench of another.
const SLOPE: &str = "[[bodies]]
name = \"slope\"
material = \"clay\"
polygon = [[\"0 m\", \"1 m\"], [\"2 m\", \"1 m\"], [\"2 m\", \"3 m\"], [\"0 m\", \"5 m\"]]

[[bodies]]
name = \"bench\"
material = \"clay\"
polygon = [[\"0 m\", \"0 m\"], [\"2 m\", \"0 m\"], [\"2 m\", \"1 m\"], [\"0 m\", \"1 m\"]]
";

fn on_a_slope(text: &str) -> Case<2> {
    let (head, tail) = text.split_once("[[bodies]]").unwrap();
    let (_, stages) = tail.split_once("[[stages]]").unwrap();
    let stages = stages.replace("k0", "gravity");
    let text = format!("{head}{SLOPE}\n[[stages]]{stages}");
    let file = CaseFile::parse("slope.toml", &text, &[]);
    file.unwrap_or_else(|error| panic!("{error}"))
        .case()
        .clone()
}

/// The strength that every particle carries, with its place.
fn carried(case: &Case<2>, field: Field) -> Vec<([f64; 2], f64)> {
    let (model, state) = Model::new(case).unwrap();
    let particles = &state.body.particles;
    let values = fields::values(field, particles, &model.laws);
    std::iter::zip(particles.x.iter().copied(), values).collect()
}

/// GOAL: depth is measured straight down from the highest soil of the case, whatever body a particle is of.
#[test]
fn depth_goes_down_from_the_surface() {
    let by_gradient = "{ at_surface = \"1 kPa\", gradient = \"2 kPa/m\" }";
    let by_table = "{ depths = [\"0 m\", \"9 m\"], values = [\"1 kPa\", \"19 kPa\"] }";
    for cohesion in [by_gradient, by_table] {
        let case = on_a_slope(&edited(TEXT, &[(COHESION, cohesion)]));
        for ([x, y], strength) in carried(&case, Field::Strength) {
            let expected = 1e3 + 2e3 * (5.0 - x - y);
            assert!(
                (strength - expected).abs() < 1e-6,
                "{strength} at ({x}, {y})"
            );
        }
        assert!((case.materials[0].cohesive() - 11e3).abs() < 1e-6);
    }
}

/// GOAL: friction that varies is carried by particles, linear in its tangent, and reduced with all strength.
#[test]
fn friction_varies_from_place_to_place() {
    let friction = "{ levels = [\"5 m\", \"0 m\"], values = [\"20 deg\", \"35 deg\"] }";
    let case = case(&[("\"20 deg\"", friction)]);
    let [top, base] = [20.0, 35.0].map(|angle: f64| angle.to_radians().tan());
    for ([_, y], angle) in carried(&case, Field::Friction) {
        let expected = base + (top - base) * y / 5.0;
        assert!((angle.tan() - expected).abs() < 1e-12);
    }
    let run = in_memory(&case).unwrap();
    assert!(
        run.body
            .particles
            .sigma
            .iter()
            .all(|sigma| sigma[1][1] < 0.0)
    );
}

/// GOAL: undrained strength is the stated share of the vertical effective stress.
/// ORACLE: s_u = S σ′_v0 OCR^m, σ′_v0 from the weight straight above less the water that stands in it.
#[test]
fn strength_may_be_a_share_of_the_effective_stress() {
    let share = "{ ratio = 0.22, ocr = { depths = [\"1 m\", \"3 m\"], values = [4, 2] }, exponent = 0.7, \
                 at_least = \"2 kPa\", water_level = \"3 m\" }";
    let case = on_a_slope(&undrained(share));
    for ([x, y], strength) in carried(&case, Field::Strength) {
        let depth = 5.0 - x - y;
        let ocr = 4.0 - (depth - 1.0).clamp(0.0, 2.0);
        let water = 9.81e3 * (f64::min(3.0, 5.0 - x) - y).max(0.0);
        let expected = 0.22 * (18e3 * depth - water) * ocr.powf(0.7);
        assert!(
            (strength - expected.max(2e3)).abs() < 1e-6,
            "{strength} for {expected} at ({x}, {y})"
        );
    }
    let of_table = setup::tables(&case);
    let materials = of_table.iter().find(|table| table.title == "Materials");
    assert_eq!(
        materials.unwrap().rows[0][5],
        "c_u = 0.22 σ′_v0 OCR^0.7, OCR = 4 at a depth of 1 m, 2 at a depth of 3 m, at least 2 kPa, water at rest to y = 3 m"
    );
}
