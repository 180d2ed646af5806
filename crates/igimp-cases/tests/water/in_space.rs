//! GOAL: water, stages of construction, reinforcement and patches of pressure in case files of space.
//! CASE: columns, a slope in a pond, blocks; each with an exact answer, or with the answer of another way to say it.
//! ORACLE: hydrostatics; buoyancy; equal runs; equilibrium; messages.

use std::fmt::Write as _;
use std::path::Path;

use crate::resuming::{assert_done, assert_equal, everything, folder, run_into};
use igimp_cases::run::{Run, Start, in_memory};
use igimp_input::CaseFile;
use igimp_model::Case;

fn parsed(text: &str) -> CaseFile {
    CaseFile::parse("ground.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn done(text: &str) -> (Case<3>, Run<3>) {
    let case = parsed(text).case_in_space().clone();
    let run = in_memory(&case).unwrap();
    assert_done(&run.summary);
    (case, run)
}

/// A block of elastic ground, 2 m by 1 m, so high, with more after it.
fn block(height: f64, water: &str, more: &str) -> String {
    format!(
        r#"igimp = 1
[case]
title = "a block in space"
analysis = "3d"
gravity = "10 m/s2"
water_unit_weight = "10 kN/m3"
[grid]
cell = "0.5 m"
domain = {{ x = ["0 m", "2 m"], y = ["0 m", "1 m"], z = ["0 m", "{} m"] }}
[materials.sand]
model = "elastic"
unit_weight = "18 kN/m3"
saturated_unit_weight = "20 kN/m3"
young = "200 MPa"
poisson = 0.25
[[bodies]]
name = "ground"
material = "sand"
box = {{ from = ["0 m", "0 m", "0 m"], to = ["2 m", "1 m", "{height} m"] }}
{water}
{more}
[output]
figures = []
paraview = {{ every = "never" }}
report = false
"#,
        height + 1.0
    )
}

const WEIGHT: &str =
    "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 1\ngeometry = \"given\"";

/// GOAL: under a level pond pressure is hydrostatic at every particle, and the grains carry the buoyant weight.
#[test]
fn a_column_below_a_pond_is_hydrostatic() {
    let water = "[[water]]\nname = \"pond\"\nlevel = \"2.5 m\"";
    let (_, run) = done(&block(2.0, water, WEIGHT));
    let particles = &run.body.particles;
    for k in 0..particles.len() {
        let depth = 2.0 - particles.x[k][2];
        let pressure = 10e3 * (2.5 - particles.x[k][2]);
        let found = particles.pore_pressure[k];
        assert!(
            (found - pressure).abs() < 1e-9 * pressure,
            "{found} {pressure}"
        );
        // B-bar: that of the middle of the cell.
        let middle = 0.5 * (depth / 0.5).floor() + 0.25;
        let effective = particles.sigma[k][2][2];
        assert!(
            (effective + 10e3 * middle).abs() < 1e-6 * 10e3,
            "{effective} {middle}"
        );
    }
}

/// A slope in a deep pond, its table said in several ways.
fn slope_in_pond(water: &str) -> String {
    format!(
        r#"igimp = 1
[case]
title = "a slope in a pond"
analysis = "3d"
gravity = "10 m/s2"
water_unit_weight = "10 kN/m3"
[grid]
cell = "1 m"
domain = {{ x = ["0 m", "7 m"], y = ["0 m", "3 m"], z = ["0 m", "4 m"] }}
[materials.sand]
model = "mohr-coulomb"
unit_weight = "20 kN/m3"
saturated_unit_weight = "20 kN/m3"
young = "20 MPa"
poisson = 0.3
cohesion = "5 kPa"
friction = "30 deg"
[[bodies]]
name = "slope"
material = "sand"
polygon = [["0 m", "0 m"], ["7 m", "0 m"], ["7 m", "1 m"], ["5 m", "1 m"], ["3 m", "3 m"], ["0 m", "3 m"]]
across = ["0 m", "3 m"]
[boundaries]
back = "fixed"
{water}
[[stages]]
name = "weight"
type = "gravity"
steps = 2
[solver]
tolerance = 1e-11
[output]
figures = []
paraview = {{ every = "never" }}
report = false
"#
    )
}

fn largest_difference(a: &Run<3>, b: &Run<3>) -> [f64; 2] {
    let (mut largest, mut worst) = ([0.0_f64; 2], [0.0_f64; 2]);
    let (a, b) = (&a.body.particles, &b.body.particles);
    assert_eq!(a.len(), b.len());
    for k in 0..a.len() {
        for i in 0..3 {
            largest[0] = largest[0].max(a.displacement[k][i].abs());
            worst[0] = worst[0].max((a.displacement[k][i] - b.displacement[k][i]).abs());
            for j in 0..3 {
                largest[1] = largest[1].max(a.sigma[k][i][j].abs());
                worst[1] = worst[1].max((a.sigma[k][i][j] - b.sigma[k][i][j]).abs());
            }
        }
    }
    [worst[0] / largest[0], worst[1] / largest[1]]
}

/// GOAL: how deep a pond is over a slope makes no difference to the grains, and water that drowns soil makes it as heavy as
/// buoyancy says.
#[test]
fn a_drowned_slope_feels_buoyancy_alone() {
    let pond = |level: &str| format!("[[water]]\nname = \"pond\"\nlevel = \"{level}\"");
    let (_, low) = done(&slope_in_pond(&pond("3.5 m")));
    let (_, high) = done(&slope_in_pond(&pond("20 m")));
    let dry = slope_in_pond("").replace("weight = \"20 kN/m3\"", "weight = \"10 kN/m3\"");
    let (_, dry) = done(&dry);
    for (name, other) in [("pond", &high), ("buoyant", &dry)] {
        let [displacement, stress] = largest_difference(&low, other);
        assert!(displacement < 1e-9, "{name}: {displacement}");
        assert!(stress < 1e-9, "{name}: {stress}");
    }
}

/// GOAL: a table is the same as a line, as a surface on lines, and as a surface through points; drawdown without a drop is a level.
#[test]
fn a_water_table_can_be_said_in_several_ways() {
    let line = "line = [[\"-1 m\", \"3.3 m\"], [\"9 m\", \"-1.7 m\"]]";
    let lines = "surface = { x = [\"-1 m\", \"9 m\"], y = [\"0 m\", \"3 m\"], rows = [[\"3.3 m\", \"-1.7 m\"], [\"3.3 m\", \"-1.7 m\"]] }";
    let points = "surface = { points = [[\"-1 m\", \"-1 m\", \"3.3 m\"], [\"9 m\", \"-1 m\", \"-1.7 m\"], [\"9 m\", \"5 m\", \"-1.7 m\"], [\"-1 m\", \"4 m\", \"3.3 m\"]] }";
    // Soil that does not yield: equal to round-off, and not to what Newton's method leaves.
    let of = |water: &str| {
        let text = slope_in_pond(&format!("[[water]]\nname = \"table\"\n{water}"));
        done(&text.replace("\"5 kPa\"", "\"60 kPa\"")).1
    };
    let line = of(line);
    assert!(line.body.particles.pore_pressure.iter().any(|u| *u > 0.0));
    for (name, other) in [("lines", of(lines)), ("points", of(points))] {
        let [displacement, stress] = largest_difference(&line, &other);
        assert!(displacement < 1e-9, "{name}: {displacement}");
        assert!(stress < 1e-9, "{name}: {stress}");
    }
    let level = of("level = \"2 m\"");
    let drained = of("inside = \"2 m\"\noutside = \"2 m\"");
    assert!(
        largest_difference(&level, &drained)
            .iter()
            .all(|apart| *apart < 1e-12)
    );
    // Where the ground lies between the levels, the table is its surface.
    let drawn = of("inside = \"2.5 m\"\noutside = \"1.5 m\"");
    let along = of("pond = true\nline = [[\"3.5 m\", \"2.5 m\"], [\"4.5 m\", \"1.5 m\"]]");
    assert!(
        largest_difference(&drawn, &along)
            .iter()
            .all(|apart| *apart < 1e-9)
    );
}

/// An excavation before an anchored face, with water that is lowered and a circular load.
const PIT: &str = r#"igimp = 1
[case]
title = "a pit in space"
analysis = "3d"
gravity = "10 m/s2"
[grid]
cell = "1 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "4 m"], z = ["0 m", "5 m"] }
[materials.clay]
model = "mohr-coulomb"
unit_weight = "19 kN/m3"
saturated_unit_weight = "20 kN/m3"
young = "20 MPa"
poisson = 0.3
cohesion = "25 kPa"
friction = "25 deg"
k0 = 0.5
drainage = "undrained"
[materials.treated]
model = "elastic"
unit_weight = "20 kN/m3"
young = "50 MPa"
poisson = 0.3
[[bodies]]
name = "ground"
material = "clay"
box = { from = ["0 m", "0 m", "0 m"], to = ["6 m", "4 m", "4 m"] }
minus = [{ box = { from = ["4 m", "2 m", "2 m"], to = ["6 m", "4 m", "4 m"] } }]
[[bodies]]
name = "pit"
material = "clay"
box = { from = ["4 m", "2 m", "2 m"], to = ["6 m", "4 m", "4 m"] }
[[bodies]]
name = "fill"
material = "clay"
box = { from = ["0 m", "0 m", "4 m"], to = ["1 m", "1 m", "4.5 m"] }
[[water]]
name = "high"
level = "3 m"
[[water]]
name = "low"
surface = { x = ["0 m", "3 m", "6 m"], y = ["0 m", "1.5 m", "4 m"], rows = [["3 m", "3 m", "3 m"], ["3 m", "1.8 m", "1.8 m"], ["3 m", "1.8 m", "1.8 m"]] }
[[reinforcement]]
name = "anchor"
type = "anchor"
head = ["4 m", "3 m", "3 m"]
end = ["1 m", "2 m", "2 m"]
bonded_length = "2 m"
stiffness = "20 MN"
capacity = "200 kN"
bond = "60 kN/m"
prestress = "20 kN"
plate = "1 m"
[[loads]]
name = "tank"
type = "patch"
circle = { centre = ["2 m", "0 m"], radius = "1 m" }
level = "4 m"
pressure = "30 kPa"
[[stages]]
name = "rest"
type = "k0"
steps = 1
[[stages]]
name = "dig"
type = "construction"
remove = ["pit"]
water = "low"
install = ["anchor"]
steps = 2
[[stages]]
name = "fill"
type = "construction"
place = ["fill"]
materials = [{ body = "ground", material = "treated" }]
dissipate = true
steps = 1
[[stages]]
name = "tank"
type = "load"
load = "tank"
steps = 1
[[curves]]
name = "head"
x = { of = "tank.factor" }
y = { of = "reinforcement.anchor.head_force" }
[output]
figures = ["displacement"]
cuts = [{ across = "y", at = "3.2 m" }]
paraview = { every = 1 }
report = false
checkpoint = { every = 1, keep = 2 }
"#;

/// GOAL: bodies, water and anchors come, go and change in space; the load is the circle's; a resumed run ends with the same
/// bytes.
#[test]
fn a_pit_is_dug_and_its_run_resumed() {
    let file = parsed(PIT);
    let [whole, cut] = ["pit-whole", "pit-cut"].map(folder);
    let written = |folder: &Path, start: Start, steps: Option<usize>| {
        run_into((&file, file.case_in_space()), folder, start, steps)
    };
    let run = written(&whole, Start::Afresh, None);
    assert_done(&run.summary);
    let member = run.summary.stages[1].reinforcement[0].clone();
    assert!(
        (member.head_force - 20e3).abs() < 1e-6 * 20e3,
        "{}",
        member.head_force
    );
    let [least, most] = run.summary.stages[1]
        .pore_water
        .as_ref()
        .unwrap()
        .excess
        .unwrap();
    assert!(least < -100.0, "digging sucks: {least} {most}");
    assert!(
        run.summary.stages[2]
            .pore_water
            .as_ref()
            .unwrap()
            .excess
            .is_none()
    );
    written(&cut, Start::Afresh, Some(2));
    written(&cut, Start::Resume, None);
    let expected = everything(&whole);
    assert_equal(&expected, &everything(&cut), "taken up");
    for file in [
        "reinforcement/anchor__2-dig.csv",
        "sections/cut-y-3.2__2-dig.csv",
        "figures/cut-y-2-dig-displacement.svg",
    ] {
        let names: Vec<_> = expected.keys().collect();
        assert!(expected.contains_key(Path::new(file)), "{file}: {names:?}");
    }
}

/// GOAL: the supports carry the pressure times the area of half a circle.
#[test]
fn half_a_circle_beside_a_plane_of_symmetry_presses_with_half_its_force() {
    let patch = |shape: &str| {
        format!(
            "[[loads]]\nname = \"tank\"\ntype = \"patch\"\n{shape}\nlevel = \"2 m\"\npressure = \"40 kPa\"\n[[stages]]\nname = \"load\"\ntype = \"load\"\nload = \"tank\"\nsteps = 1\ngeometry = \"given\""
        )
    };
    let circle = patch("circle = { centre = [\"1 m\", \"0 m\"], radius = \"0.6 m\" }");
    let square = patch(
        "plan = [[\"0.5 m\", \"0 m\"], [\"1.5 m\", \"0 m\"], [\"1.5 m\", \"1 m\"], [\"0.5 m\", \"1 m\"]]",
    );
    let rectangle = "[[loads]]\nname = \"tank\"\ntype = \"pressure\"\nfrom = [\"0.5 m\", \"0 m\", \"2 m\"]\nto = [\"1.5 m\", \"1 m\", \"2 m\"]\npressure = \"40 kPa\"\n[[stages]]\nname = \"load\"\ntype = \"load\"\nload = \"tank\"\nsteps = 1\ngeometry = \"given\"";
    let force = |run: &Run<3>| {
        // In equilibrium the mean upright stress over the volume is that of the force from top to bottom.
        let particles = &run.body.particles;
        let sum = (0..particles.len()).map(|k| particles.sigma[k][2][2] * particles.volume0[k]);
        -sum.sum::<f64>() / 2.0
    };
    let (_, run) = done(&block(2.0, "", &circle));
    let exact = 40e3 * 0.5 * std::f64::consts::PI * 0.36;
    assert!(
        (force(&run) / exact - 1.0).abs() < 1e-3,
        "{} {exact}",
        force(&run)
    );
    let (_, square) = done(&block(2.0, "", &square));
    let (_, rectangle) = done(&block(2.0, "", rectangle));
    assert!(
        largest_difference(&square, &rectangle)
            .iter()
            .all(|apart| *apart < 1e-9)
    );
}

/// Water that cannot be.
const WATER: [(&str, &str); 6] = [
    (
        "a surface that ends too soon",
        "surface = { points = [[\"0 m\", \"0 m\", \"1 m\"], [\"1 m\", \"0 m\", \"1 m\"], [\"0 m\", \"1 m\", \"1 m\"]] }",
    ),
    (
        "a line above the ground",
        "line = [[\"0 m\", \"2.5 m\"], [\"2 m\", \"2.5 m\"]]",
    ),
    (
        "a pond that is not level",
        "line = [[\"0 m\", \"2.5 m\"], [\"2 m\", \"2.8 m\"]]\npond = true",
    ),
    ("two sources", "level = \"1 m\"\nr_u = 0.2"),
    ("a table below the ground", "level = \"-1 m\""),
    (
        "pressures that end too soon",
        "u = { x = [\"0 m\", \"1 m\"], y = [\"0 m\", \"2 m\"], rows = [[\"10 kPa\", \"10 kPa\"], [\"0 kPa\", \"0 kPa\"]] }",
    ),
];

/// Members that cannot be.
const MEMBERS: [(&str, &str); 4] = [
    (
        "a sheet",
        "type = \"geotextile\"\npoints = [[\"0 m\", \"0 m\", \"1 m\"], [\"2 m\", \"0 m\", \"1 m\"]]",
    ),
    (
        "a nail in the air",
        "type = \"nail\"\nhead = [\"1 m\", \"0.5 m\", \"2 m\"]\nend = [\"1 m\", \"0.5 m\", \"2.6 m\"]",
    ),
    (
        "a plate",
        "type = \"nail\"\nhead = [\"1 m\", \"0.5 m\", \"2 m\"]\nend = [\"1 m\", \"0.5 m\", \"1 m\"]\nplate = \"0.5 m\"",
    ),
    (
        "forces per metre",
        "type = \"nail\"\nhead = [\"1 m\", \"0.5 m\", \"2 m\"]\nend = [\"1 m\", \"0.5 m\", \"1 m\"]\nhead_capacity = \"20 kN/m\"",
    ),
];

/// Patches that cannot be.
const PATCHES: [(&str, &str); 3] = [
    (
        "a patch in the soil",
        "circle = { centre = [\"1 m\", \"0.5 m\"], radius = \"0.3 m\" }\nlevel = \"1 m\"",
    ),
    ("a patch without a shape", "level = \"2 m\""),
    (
        "a patch without area",
        "plan = [[\"0 m\", \"0 m\"], [\"1 m\", \"0 m\"], [\"2 m\", \"0 m\"]]\nlevel = \"2 m\"",
    ),
];

/// GOAL: the impossible is refused with its place and a remedy.
#[test]
fn what_makes_no_sense_is_refused() {
    let mut out = String::new();
    let mut problem = |title: &str, text: &str| {
        let printed = match CaseFile::parse("ground.toml", text, &[]) {
            Ok(file) => file.warnings(),
            Err(error) => error.to_string(),
        };
        let _ = writeln!(out, "## {title}\n{printed}");
    };
    let water = |keys: &str| format!("[[water]]\nname = \"w\"\n{keys}");
    for (title, keys) in WATER {
        problem(title, &block(2.0, &water(keys), WEIGHT));
    }
    let upright = block(
        2.0,
        &water("inside = \"1.5 m\"\noutside = \"0.5 m\""),
        WEIGHT,
    )
    .replace(
        "to = [\"2 m\", \"1 m\", \"2 m\"]",
        "to = [\"1 m\", \"1 m\", \"2 m\"]",
    );
    problem("drawdown behind an upright face", &upright);
    for (title, keys) in MEMBERS {
        let member = format!(
            "[[reinforcement]]\nname = \"r\"\nstiffness = \"20 MN\"\ncapacity = \"100 kN\"\nbond = \"40 kN/m\"\n{keys}"
        );
        problem(title, &block(2.0, "", &format!("{member}\n{WEIGHT}")));
    }
    for (title, keys) in PATCHES {
        let patch = format!(
            "[[loads]]\nname = \"p\"\ntype = \"patch\"\npressure = \"10 kPa\"\n{keys}\n{WEIGHT}"
        );
        problem(title, &block(2.0, "", &patch));
    }
    insta::assert_snapshot!(out);
}
