//! Materials whose strength, stiffness and weight vary with the level: what is refused and why, and what
//! particles are given.

use std::fmt::Write;

use igimp_cases::case::{Case, Profile};
use igimp_cases::input::CaseFile;
use igimp_cases::results::setup;
use igimp_cases::run::Model;
use igimp_cases::run::in_memory;

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

fn edited(edits: &[(&str, &str)]) -> String {
    edits.iter().fold(TEXT.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "`{from}` is not in the file");
        text.replacen(from, to, 1)
    })
}

fn case(edits: &[(&str, &str)]) -> Case {
    CaseFile::parse("ground.toml", &edited(edits), &[])
        .unwrap_or_else(|error| panic!("{error}"))
        .case()
        .clone()
}

#[test]
fn profiles_that_make_no_sense() {
    let mut out = String::new();
    for cohesion in [
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
        "[\"1 kPa\", \"2 kPa\"]",
    ] {
        let _ = writeln!(out, "## cohesion = {cohesion}");
        let text = edited(&[(COHESION, cohesion)]);
        let _ = writeln!(
            out,
            "{}",
            CaseFile::parse("ground.toml", &text, &[]).unwrap_err()
        );
    }
    for edit in [
        ("gradient = \"1.5 MPa/m\"", "gradient = \"-1.5 MPa/m\""),
        (
            "friction = \"20 deg\"",
            "friction = \"20 deg\"\ntension_cutoff = \"1 kPa\"",
        ),
        (
            "\"16 kN/m3\", \"18 kN/m3\", \"18 kN/m3\"",
            "\"16 kPa\", \"18 kN/m3\", \"18 kN/m3\"",
        ),
    ] {
        let _ = writeln!(out, "## {:?} -> {:?}", edit.0, edit.1);
        let text = edited(&[edit]);
        let _ = writeln!(
            out,
            "{}",
            CaseFile::parse("ground.toml", &text, &[]).unwrap_err()
        );
    }
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
    let weight = Profile::Table(vec![[0.0, 18e3], [3.0, 18e3], [5.0, 16e3]]);
    for particle in 0..particles.len() {
        let above = weight.integral(particles.x[particle], 5.0);
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
