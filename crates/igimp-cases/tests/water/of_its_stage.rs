//! GOAL: loads, water and bodies that come back are those of the stage that asks for them.
//! CASE: layers of elastic ground between rollers, dug, filled and loaded over their whole width.
//! ORACLE: one-dimensional compression: the vertical stress below is the weight and the load above.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;

const TEXT: &str = r#"
igimp = 1
[case]
title = "layers"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "4 m"] }
[materials.light]
model = "elastic"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.3
[materials.heavy]
model = "elastic"
unit_weight = "27 kN/m3"
young = "20 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "light"
polygon = [["0 m","0 m"], ["6 m","0 m"], ["6 m","2 m"], ["0 m","2 m"]]
[[bodies]]
name = "layer"
material = "light"
polygon = [["0 m","2 m"], ["6 m","2 m"], ["6 m","3 m"], ["0 m","3 m"]]
[[stages]]
name = "weight"
type = "gravity"
steps = 1
"#;
const DIG: &str = "[[stages]]\nname = \"dig\"\ntype = \"construction\"\nremove = [\"layer\"]\n";
const FILL: &str = "[[stages]]\nname = \"fill\"\ntype = \"construction\"\nplace = [\"layer\"]\n";
const LOAD: &str = "[[loads]]\nname = \"surcharge\"\ntype = \"pressure\"\nfrom = [\"0 m\", \"2 m\"]\nto = [\"6 m\", \"2 m\"]\npressure = \"10 kPa\"\n\
    [[stages]]\nname = \"load\"\ntype = \"load\"\nload = \"surcharge\"\nsteps = 1\n";
const CHANGE: &str = "[[stages]]\nname = \"change\"\ntype = \"construction\"\nmaterials = [{ body = \"layer\", material = \"heavy\" }]\n";

fn run(stages: &[&str]) -> Run<2> {
    let text = [&[TEXT], stages].concat().concat();
    let file = CaseFile::parse("layers.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory(file.case()).unwrap();
    assert!(run.failure.is_none());
    run
}

fn refused(stages: &[&str]) -> String {
    let text = [&[TEXT], stages].concat().concat();
    let file = CaseFile::parse("layers.toml", &text, &[]);
    file.map(|file| file.warnings()).unwrap_err().to_string()
}

/// Mean vertical stress of the lowest particles, compression positive, carried down to the base \[kPa\].
fn at_base(run: &Run<2>) -> f64 {
    let particles = &run.body.particles;
    let low: Vec<usize> = (0..particles.len())
        .filter(|&k| particles.x[k][1] < 0.5)
        .collect();
    let sum: f64 = low.iter().map(|&k| -1e-3 * particles.sigma[k][1][1]).sum();
    let level: f64 = low.iter().map(|&k| particles.x[k][1]).sum();
    let count = low.len() as f64;
    sum / count + 18.0 * level / count
}

#[track_caller]
fn assert_carries(run: &Run<2>, expected: f64) {
    let found = at_base(run);
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
}

#[test]
fn loads_act_on_what_is_bare_in_their_stage() {
    // On the floor of a pit: two metres of ground and the load.
    assert_carries(&run(&[DIG, LOAD]), 2.0 * 18.0 + 10.0);
    // A surcharge that a fill covers later stays.
    assert_carries(&run(&[LOAD, FILL]), 3.0 * 18.0 + 10.0);
    // While the layer is there the load lies inside the soil.
    let inside = refused(&[LOAD, DIG]);
    assert!(
        inside.contains("lies inside the soil, not on its surface"),
        "{inside}"
    );
    let covered = refused(&[FILL, LOAD]);
    assert!(
        covered.contains("lies inside the soil, not on its surface"),
        "{covered}"
    );
}

#[test]
fn a_body_that_comes_back_consists_of_what_it_was_changed_to() {
    let again = FILL.replace("\"fill\"", "\"again\"");
    let back = run(&[FILL, CHANGE, DIG, &again]);
    assert_carries(&back, 2.0 * 18.0 + 27.0);
    // The stage that places it may say otherwise, and another branch says nothing.
    let light = "materials = [{ body = \"layer\", material = \"light\" }]\nplace";
    let stated = again.replace("place", light);
    assert_carries(&run(&[FILL, CHANGE, DIG, &stated]), 3.0 * 18.0);
    let branch = DIG.replace("remove", "start_from = \"fill\"\nremove");
    assert_carries(&run(&[FILL, CHANGE, &branch, &again]), 3.0 * 18.0);
}

// GOAL: water that flows through the ground of one stage is not taken for that of another.
// ORACLE: by hand: the ground differs by the layer.
#[test]
fn water_that_flows_has_one_ground() {
    let text = TEXT.replace(
        "[[stages]]",
        "[[water]]\nname = \"dry\"\ndry = true\n[[water]]\nname = \"drawdown\"\ninside = \"1.5 m\"\noutside = \"1.2 m\"\n[[stages]]",
    );
    let call = |name: &str, from: &str| {
        format!(
            "[[stages]]\nname = \"{name}\"\ntype = \"construction\"\nwater = \"drawdown\"\nstart_from = \"{from}\"\n"
        )
    };
    let printed = |last: &str| {
        let stages = [DIG, &call("first", "dig"), last].concat();
        CaseFile::parse("layers.toml", &format!("{text}{stages}"), &[])
    };
    let error = printed(&call("other", "weight"))
        .map(|file| file.warnings())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("flows through the ground in which it is called first"),
        "{error}"
    );
    assert!(printed(&call("same", "dig")).is_ok());
    // A level is no flow.
    let level = text.replace(
        "inside = \"1.5 m\"\noutside = \"1.2 m\"",
        "level = \"1.5 m\"",
    );
    let stages = [DIG, &call("first", "dig"), &call("other", "weight")].concat();
    assert!(CaseFile::parse("layers.toml", &format!("{level}{stages}"), &[]).is_ok());
}
