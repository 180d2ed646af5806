//! Computed seepage as a source of pore pressure: the same as water that is given where nothing flows, factors of safety, files
//! and refusals.

use std::sync::atomic::AtomicBool;

use crate::resuming::{assert_done, assert_equal, everything, folder, run_into};
use igimp_cases::run::{Nobody, Run, Start, Target, in_memory, run};
use igimp_input::CaseFile;
use igimp_model::PoreSource;

const SLOPE: &str = r#"
igimp = 1

[case]
title = "Slope with seepage"

[grid]
cell = "1 m"
domain = { x = ["0 m", "30 m"], y = ["0 m", "12 m"] }

[materials.sand]
model = "mohr-coulomb"
unit_weight = "18 kN/m3"
saturated_unit_weight = "20 kN/m3"
young = "20 MPa"
poisson = 0.3
cohesion = "5 kPa"
friction = "30 deg"
permeability = { horizontal = "1e-5 m/s", vertical = "5e-6 m/s" }

[[bodies]]
name = "ground"
material = "sand"
polygon = [["0 m", "0 m"], ["30 m", "0 m"], ["30 m", "4.3 m"], ["20 m", "4.3 m"], ["9 m", "10 m"], ["0 m", "10 m"]]

[[water]]
name = "steady"
seepage = { faces = [{ name = "left", from = ["0 m", "0 m"], to = ["0 m", "10 m"], head = "9 m" }] }

[[stages]]
name = "weight"
type = "gravity"
steps = 1
"#;

/// The slope with texts replaced.
fn edited(edits: &[(&str, &str)]) -> String {
    edits.iter().fold(SLOPE.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

fn ran(edits: &[(&str, &str)]) -> Run<2> {
    let file = CaseFile::parse("seepage.toml", &edited(edits), &[]);
    in_memory(file.unwrap_or_else(|error| panic!("{error}")).case()).unwrap()
}

/// The message of a refusal.
fn refused(from: &str, to: &str) -> String {
    match CaseFile::parse("seepage.toml", &edited(&[(from, to)]), &[]) {
        Ok(_) => panic!("{to} was taken"),
        Err(error) => error.to_string(),
    }
}

const FORM: &str = "seepage = { faces = [{ name = \"left\", from = [\"0 m\", \"0 m\"], to = [\"0 m\", \"10 m\"], head = \"9 m\" }] }";

/// GOAL: where no water flows, computed pressure is that of a level, under a pond too. ORACLE: the level.
#[test]
fn water_at_rest_is_a_level() {
    let still = "seepage = { free_water = [[\"0 m\", \"6.5 m\"]] }";
    let [computed, given] =
        [still, "level = \"6.5 m\""].map(|form| ran(&[(FORM, form)]).body.particles);
    let greatest = given.pore_pressure.iter().copied().fold(0.0, f64::max);
    for (a, b) in std::iter::zip(&computed.pore_pressure, &given.pore_pressure) {
        assert!((a - b).abs() < 2e-4 * greatest, "{a} {b}");
    }
    for (a, b) in std::iter::zip(&computed.displacement, &given.displacement) {
        assert!((a[1] - b[1]).abs() < 1e-3 * 0.02, "{a:?} {b:?}");
    }
}

/// GOAL: the free surface falls towards the toe, the pressure is that of the flow, and threads change no bit.
#[test]
fn a_slope_drains_to_its_toe() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| ran(&[]))
    };
    let [one, two] = [1, 2].map(on);
    assert_eq!(
        one.body.particles.pore_pressure,
        two.body.particles.pore_pressure
    );
    let bits = |run: &Run<2>| {
        run.body
            .particles
            .x
            .iter()
            .map(|x| x.map(f64::to_bits))
            .collect::<Vec<_>>()
    };
    assert_eq!(bits(&one), bits(&two));
    let wet = |x: f64| {
        let particles = &one.body.particles;
        let there = std::iter::zip(&particles.x, &particles.pore_pressure);
        let there = there.filter(|(at, u)| (at[0] - x).abs() < 0.6 && **u > 0.0);
        there.map(|(at, _)| at[1]).fold(0.0, f64::max)
    };
    assert!(
        (wet(0.5) - 9.0).abs() < 0.8 && wet(8.0) < wet(0.5) - 0.5,
        "{}",
        wet(8.0)
    );
    assert!(wet(25.0) < 4.4);
    let rows = &one.summary.setup;
    let rows = rows
        .iter()
        .find(|table| table.title == "Seepage: discharges")
        .unwrap();
    let all = rows.rows.iter().find(|row| row[1] == "all").unwrap();
    assert_eq!(all[2], all[3]);
}

/// GOAL: a factor of safety with computed seepage. ORACLE: Duncan and Wright, fig. 6.37: 1.138 to 1.142, ± 1.5 %.
#[test]
fn a_slope_of_duncan_and_wright() {
    let text = r#"
igimp = 1
case = { title = "Seepage and stability", water_unit_weight = "62.4 pcf" }
grid = { cell = { x = "5 ft", y = "4 ft" }, domain = { x = ["0 ft", "440 ft"], y = ["0 ft", "84 ft"] } }
[materials.soil]
model = "mohr-coulomb"
unit_weight = "125 pcf"
saturated_unit_weight = "125 pcf"
young = "2000 ksf"
poisson = 0.3
cohesion = "200 psf"
friction = "20 deg"
dilation = "20 deg"
permeability = "1e-6 m/s"
[[bodies]]
name = "slope"
material = "soil"
polygon = [["0 ft", "0 ft"], ["440 ft", "0 ft"], ["440 ft", "80 ft"], ["200 ft", "80 ft"], ["120 ft", "40 ft"], ["0 ft", "40 ft"]]
[[water]]
name = "steady"
[water.seepage]
faces = [
    { name = "left", from = ["0 ft", "0 ft"], to = ["0 ft", "40 ft"], head = "40 ft" },
    { name = "right", from = ["440 ft", "0 ft"], to = ["440 ft", "80 ft"], head = "75 ft" },
]
[[stages]]
name = "weight"
type = "gravity"
steps = 2
[[stages]]
name = "safety"
type = "strength-reduction"
"#;
    let file = CaseFile::parse("slope.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let found = in_memory(file.case()).unwrap();
    let safety = found.summary.stages[1].safety.as_ref().unwrap();
    let factor = 0.5 * (safety.stable.unwrap() + safety.failed.unwrap());
    println!("factor of safety {factor:.4} of 1.138 to 1.142");
    assert!(
        (1.138 / 1.015..=1.142 * 1.015).contains(&factor),
        "{factor}"
    );
}

/// GOAL: seepage in space, from the case file on. ORACLE: the discharge of the same slope in the plane times its width.
#[test]
fn a_slope_in_space_lets_through_what_it_does_in_the_plane() {
    let all = |setup: &[igimp_results::summary::SetupTable]| -> f64 {
        let table = setup
            .iter()
            .find(|table| table.title == "Seepage: discharges");
        let rows = &table.unwrap().rows;
        let all = rows.iter().find(|row| row[1] == "all").unwrap();
        all[2].parse().unwrap()
    };
    let plane = all(&ran(&[]).summary.setup);
    let space = edited(&[
        ("title = ", "analysis = \"3d\"\ntitle = "),
        (
            "y = [\"0 m\", \"12 m\"]",
            "y = [\"0 m\", \"2 m\"], z = [\"0 m\", \"12 m\"]",
        ),
        ("[[water]]", "across = [\"0 m\", \"2 m\"]\n\n[[water]]"),
        (
            "from = [\"0 m\", \"0 m\"], to = [\"0 m\", \"10 m\"]",
            "from = [\"0 m\", \"0 m\", \"0 m\"], to = [\"0 m\", \"2 m\", \"10 m\"]",
        ),
    ]);
    let file = CaseFile::parse("space.toml", &space, &[]).unwrap_or_else(|error| panic!("{error}"));
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("seepage-space");
    let target = Target::of(&file, &folder);
    let done = AtomicBool::new(false);
    let case = file.case_in_space();
    let found = run(case, Some(&target), Start::Afresh, &mut Nobody, &done).unwrap();
    let cuts = [
        "figures/seepage-steady-x.svg",
        "figures/seepage-steady-y.svg",
    ];
    for name in cuts.into_iter().chain(["sections/seepage-steady.csv"]) {
        assert!(folder.join(name).is_file(), "{name}");
    }
    let space = all(&found.summary.setup);
    println!("plane {plane:.4e}, space {space:.4e} over 2 m");
    assert!(
        (space / (2.0 * plane) - 1.0).abs() < 0.01,
        "{space} {plane}"
    );
    assert!(found.body.particles.pore_pressure.iter().any(|u| *u > 5e4));
}

/// GOAL: the results folder has the flow for ParaView, the free surface and a picture.
#[test]
fn a_flow_is_written_and_drawn() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("seepage");
    let text = SLOPE.replacen("igimp = 1", "igimp = 1\noutput.figures = [\"u\"]", 1);
    let file =
        CaseFile::parse("seepage.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let target = Target::of(&file, &folder);
    let done = AtomicBool::new(false);
    let found = run(
        file.case(),
        Some(&target),
        Start::Afresh,
        &mut Nobody,
        &done,
    )
    .unwrap();
    let names = found
        .summary
        .figures
        .iter()
        .map(|figure| figure.file.as_str());
    assert!({ names }.any(|name| name == "figures/seepage-steady"));
    for name in [
        "figures/seepage-steady.svg",
        "sections/seepage-steady.csv",
        "paraview/seepage-steady.vtu",
    ] {
        assert!(folder.join(name).is_file(), "{name}");
    }
}

/// A dam with upright faces, of the height 10 m and as long, between water of 10 m and of 2 m.
const DAM: &str = r#"
igimp = 1
mesh_study.meshes = 3

[case]
title = "Dam with upright faces"

[grid]
cell = "1 m"
domain = { x = ["0 m", "10 m"], y = ["0 m", "11 m"] }

[materials.sand]
model = "elastic"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.3
permeability = "1e-5 m/s"

[[bodies]]
name = "dam"
material = "sand"
polygon = [["0 m", "0 m"], ["10 m", "0 m"], ["10 m", "10 m"], ["0 m", "10 m"]]

[[water]]
name = "steady"

[water.seepage]
sections = [{ name = "middle", from = ["5.5 m", "0 m"], to = ["5.5 m", "10 m"] }]
faces = [
    { name = "upstream", from = ["0 m", "0 m"], to = ["0 m", "10 m"], head = "10 m" },
    { name = "downstream", from = ["10 m", "0 m"], to = ["10 m", "10 m"], open = true },
    { name = "low water", from = ["10 m", "0 m"], to = ["10 m", "2 m"], head = "2 m" },
]

[[stages]]
name = "weight"
type = "gravity"
steps = 1

[[checks]]
name = "discharge"
of = "seepage.steady.outflow"
expected = "4.8e-5 m2/s"
tolerance = 0.005
source = "Charny (1951): k (h1^2 - h2^2) / (2 L)"

[[checks]]
name = "through the middle"
of = "seepage.steady.section.middle"
expected = "4.8e-5 m2/s"
tolerance = 0.005
source = "Charny (1951)"

[output]
figures = []
"#;

/// GOAL: discharges are quantities of checks and of mesh studies. ORACLE: the exact discharge of Charny; on 10, 20 and 40 cells it
/// is approached at an order that is observed, the extrapolated value is closer than the finest, and the exact one is within.
#[test]
fn discharges_are_checked_on_meshes() {
    let file = CaseFile::parse("dam.toml", DAM, &[]).unwrap_or_else(|error| panic!("{error}"));
    let run = in_memory::<2>(file.case()).unwrap();
    assert!(run.summary.checks.len() == 2 && run.summary.checks.iter().all(|row| row.pass));
    let study = run.summary.mesh_study.as_ref().unwrap();
    for name in ["discharge", "through the middle"] {
        let result = study
            .results
            .iter()
            .find(|result| result.name.starts_with(name));
        let result = result.unwrap_or_else(|| panic!("{:?}", study.results));
        let values: Vec<f64> = result.values.iter().flatten().copied().collect();
        let estimate = result.estimate.as_ref().unwrap();
        println!("{name}: {values:?} -> {estimate:?}");
        assert!(values[0] < values[1] && values[1] < values[2]);
        assert!((estimate.value - 4.8e-5).abs() < (values[2] - 4.8e-5).abs());
        assert!((estimate.value - 4.8e-5).abs() < estimate.uncertainty);
    }
    let text = DAM.replace("seepage.steady.outflow", "seepage.steady.inflow");
    let error = CaseFile::parse("dam.toml", &text, &[]).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("there is no quantity `seepage.steady.inflow`"),
        "{message}"
    );
    assert!(
        message.contains("did you mean `seepage.steady.outflow`"),
        "{message}"
    );
}

/// GOAL: permeability that varies with the level, and with the depth. ORACLE: for k = k₁ + (k₀ - k₁) d / H in series
/// q = Δh (k₁ - k₀) / (H ln(k₁ / k₀)) by area, by hand; its mean is the control.
#[test]
fn permeability_varies_with_the_depth() {
    let column = DAM
        .replace("meshes = 3", "meshes = 1")
        .replace("[water.seepage]", "[water.seepage]\nconfined = true")
        .replace(
            "from = [\"10 m\", \"0 m\"], to = [\"10 m\", \"10 m\"], open = true",
            "from = [\"0 m\", \"0 m\"], to = [\"10 m\", \"0 m\"], head = \"4 m\"",
        )
        .replace(
            "from = [\"10 m\", \"0 m\"], to = [\"10 m\", \"2 m\"], head = \"2 m\"",
            "from = [\"0 m\", \"10 m\"], to = [\"10 m\", \"10 m\"], head = \"9 m\"",
        )
        .replace(
            "from = [\"0 m\", \"0 m\"], to = [\"0 m\", \"10 m\"], head = \"10 m\"",
            "from = [\"0 m\", \"0 m\"], to = [\"0 m\", \"10 m\"], closed = true",
        )
        .replace("4.8e-5 m2/s", "1.95433e-5 m2/s")
        .replace("[\"5.5 m\", \"0 m\"]", "[\"0 m\", \"5.5 m\"]")
        .replace("[\"5.5 m\", \"10 m\"]", "[\"10 m\", \"5.5 m\"]");
    let exact = 10.0 * 5.0 * 9e-6 / (10.0 * 10.0_f64.ln());
    for rows in [
        "levels = [\"0 m\", \"10 m\"], values = [\"1e-6 m/s\", \"1e-5 m/s\"]",
        "depths = [\"0 m\", \"10 m\"], values = [\"1e-5 m/s\", \"1e-6 m/s\"]",
    ] {
        let varied = format!("permeability = {{ horizontal = {{ {rows} }} }}");
        let text = column.replace("permeability = \"1e-5 m/s\"", &varied);
        let file = CaseFile::parse("column.toml", &text, &[]);
        let file = file.unwrap_or_else(|error| panic!("{error}"));
        let run = in_memory::<2>(file.case()).unwrap();
        let measured: Vec<f64> = (run.summary.checks.iter())
            .map(|row| row.check.measured)
            .collect();
        println!("{measured:?} of {exact:.6e}");
        assert!((measured[0] / exact - 1.0).abs() < 1e-6);
        assert!((-measured[1] / exact - 1.0).abs() < 1e-6);
        assert!(5.5e-6 * 5.0 > 1.4 * exact);
    }
}

/// GOAL: conditions of a flow are read as they are stated.
#[test]
fn conditions_are_read() {
    let form = r#"
[water.seepage]
of_water = "level"
floor = 0.01
faces = [{ name = "rain", from = ["0 m", "10 m"], to = ["9 m", "10 m"], recharge = "800 mm/a" }]
regions = [
    { name = "well", from = ["3 m", "1 m"], to = ["5 m", "3 m"], discharge = "0.2 m2/d" },
    { name = "wall", from = ["10 m", "0 m"], to = ["11 m", "4 m"], permeability = "1e-9 m/s" },
]
[[water]]
name = "level"
level = "6 m"
"#;
    let file = CaseFile::parse("seepage.toml", &edited(&[(FORM, form)]), &[]);
    let file = file.unwrap_or_else(|error| panic!("{error}"));
    let case = file.case();
    let PoreSource::Seepage(flow) = &case.water[0].source else {
        panic!("{:?}", case.water[0]);
    };
    assert_eq!(flow.free_water, Some(case.water[1].source.clone()));
    let stated = format!("{:?}", flow.conditions);
    for text in ["Recharge(2.5", "Inflow(-2.3148", "Soil(0)", "along: 1e-9"] {
        assert!(stated.contains(text), "{text} in {stated}");
    }
    let soil = case.materials[0].permeability.unwrap();
    assert!((soil.along / soil.across - 2.0).abs() < 1e-12);
}

/// GOAL: impossible flows are refused where they stand.
#[test]
fn impossible_flows_are_refused() {
    for (from, to, message) in [
        (
            "permeability = { horizontal = \"1e-5 m/s\", vertical = \"5e-6 m/s\" }",
            "",
            "flows through `sand`, which has no permeability",
        ),
        (
            "head = \"9 m\"",
            "head = \"9 m\", open = true",
            "says several things: head, open",
        ),
        (", head = \"9 m\"", "", "does not say what holds there"),
        (
            "from = [\"0 m\", \"0 m\"]",
            "from = [\"0 m\", \"0 m\", \"0 m\"]",
            "a corner has 2 coordinates here, and not 3",
        ),
        ("head = \"9 m\"", "head = \"9 kPa\"", "expected a length"),
        (
            "vertical = \"5e-6 m/s\"",
            "gardner = \"1 m\", van_genuchten = { height = \"1 m\", n = 2.0 }",
            "both `gardner` and `van_genuchten`",
        ),
        (
            "vertical = \"5e-6 m/s\"",
            "van_genuchten = { height = \"1 m\", n = 1.0 }",
            "has to be above 1",
        ),
        (
            "seepage = {",
            "carried = true\nseepage = {",
            "cannot be carried along",
        ),
        (
            "seepage = {",
            "level = \"3 m\"\nseepage = {",
            "several sources of pressure: level, seepage",
        ),
        (
            "seepage = {",
            "seepage = { of_water = \"steady\",",
            "has no table that free water could stand at",
        ),
        (
            "seepage = {",
            "seepage = { sections = [{ name = \"a\", from = [\"0 m\", \"0 m\"], to = [\"2 m\", \"2 m\"] }],",
            "lies across no axis: it measures 2 by 2 m",
        ),
        (
            "from = [\"0 m\", \"0 m\"], to = [\"0 m\", \"10 m\"]",
            "from = [\"-2 m\", \"0 m\"], to = [\"-1 m\", \"10 m\"]",
            "the face `left` meets no body",
        ),
        (
            "seepage = {",
            "seepage = { regions = [{ name = \"well\", from = [\"28 m\", \"8 m\"], to = [\"29 m\", \"9 m\"], drain = true }],",
            "the region `well` meets no body",
        ),
    ] {
        let found = refused(from, to);
        assert!(found.contains(message), "{message}: {found}");
    }
}

/// GOAL: faults found as a flow begins are refused too, with their cause.
#[test]
fn a_face_within_the_ground_is_refused() {
    let nowhere = edited(&[
        ("[\"0 m\", \"10 m\"], head", "[\"6 m\", \"3 m\"], head"),
        ("from = [\"0 m\", \"0 m\"]", "from = [\"5 m\", \"2 m\"]"),
    ]);
    let file =
        CaseFile::parse("seepage.toml", &nowhere, &[]).unwrap_or_else(|error| panic!("{error}"));
    let error = in_memory(file.case()).unwrap_err();
    let cause = std::error::Error::source(&error).unwrap().to_string();
    assert_eq!(
        error.to_string(),
        "the seepage of the water `steady` cannot be computed"
    );
    assert!(
        cause.starts_with("`left` holds no face of the ground"),
        "{cause}"
    );
}

/// GOAL: keys of the fall of permeability that nothing asks for are named, and are quiet where something does. ORACLE: the words of
/// the messages.
#[test]
fn falls_without_effect_are_named() {
    let printed = |edits: &[(&str, &str)]| parsed(&edited(edits)).warnings();
    let fall = ("seepage = {", "seepage = { fall = \"3 m\",");
    let gardner = ("vertical = \"5e-6 m/s\"", "gardner = \"1 m\"");
    let confined = ("seepage = {", "seepage = { confined = true,");
    let has_none = "`fall` has no effect: every soil has a curve of its own";
    assert!(printed(&[fall, gardner]).contains(has_none));
    assert!(!printed(&[fall]).contains("no effect"));
    assert!(!printed(&[gardner]).contains("no effect"));
    assert!(printed(&[fall, confined]).contains("`fall` has no effect: all pores are full"));
    assert!(printed(&[gardner, confined]).contains("the curve of `sand` has no effect"));
    let angle = "`angle` has no effect";
    let turned = ("vertical = \"5e-6 m/s\"", "angle = \"10 deg\"");
    assert!(printed(&[turned]).contains(angle));
    let bedded = (
        "vertical = \"5e-6 m/s\"",
        "vertical = \"5e-6 m/s\", angle = \"10 deg\"",
    );
    assert!(!printed(&[bedded]).contains(angle));
}

const LATER: &str = r#"
[[water]]
name = "later"

[water.seepage]
start_from = "steady"
times = ["0.5 d", "20 d"]
faces = [{ name = "left", from = ["0 m", "0 m"], to = ["0 m", "10 m"], head = { time = ["0 d", "1 d"], values = ["9 m", "5 m"] } }]

[[stages]]
name = "weight"
"#;

const IN_TIME: &str = r#"
[[stages]]
name = "safety"
type = "strength-reduction"
in_time = "later"
tolerance = 0.05
bracket = [1.0, 1.5]
"#;

/// The slope whose water falls in time, with texts replaced.
fn in_time(edits: &[(&str, &str)]) -> String {
    let text = edited(&[
        ("[[stages]]\nname = \"weight\"\n", LATER.trim_start()),
        ("vertical = \"5e-6 m/s\"", "drainable = 0.1"),
    ]);
    let text = text + "drained = true\n" + IN_TIME;
    edits.iter().fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

fn parsed(text: &str) -> CaseFile {
    CaseFile::parse("in_time.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// GOAL: one run has the factor of safety at each time; it rises as the slope drains, up to that of the flow in the end. Threads and a
/// run that is stopped and taken up change no byte. ORACLE: the run of the steady flow in the end; the run left alone.
#[test]
fn a_slope_is_safer_as_it_drains() {
    let file = parsed(&in_time(&[]));
    let whole = folder("seepage_in_time_whole");
    let found = run_into((&file, file.case()), &whole, Start::Afresh, None);
    assert_done(&found.summary);
    let names: Vec<&str> = found
        .summary
        .stages
        .iter()
        .map(|stage| stage.name.as_str())
        .collect();
    let water = ["safety at 0_5 d (water)", "safety at 20 d (water)"];
    assert_eq!(
        names,
        [
            "weight",
            water[0],
            "safety at 0_5 d",
            water[1],
            "safety at 20 d"
        ]
    );
    let factor = |run: &Run<2>, stage: usize| {
        let search = run.summary.stages[stage].safety.as_ref().unwrap();
        0.5 * (search.stable.unwrap() + search.failed.unwrap())
    };
    let [early, late] = [2, 4].map(|stage| factor(&found, stage));
    // The end without time, on the way from the same start.
    let end = "seepage = { faces = [{ name = \"left\", from = [\"0 m\", \"0 m\"], to = [\"0 m\", \"10 m\"], head = \"5 m\" }] }";
    let steady = in_time(&[
        (
            "[[stages]]\nname = \"weight\"",
            &format!("[[water]]\nname = \"end\"\n{end}\n\n[[stages]]\nname = \"weight\""),
        ),
        (
            IN_TIME.trim_start(),
            "[[stages]]\nname = \"water\"\ntype = \"construction\"\nwater = \"end\"\ngeometry = \"given\"\ndrained = true\nsteps = 4\n\n[[stages]]\nname = \"safety\"\ntype = \"strength-reduction\"\ntolerance = 0.05\nbracket = [1.0, 1.5]\n",
        ),
    ]);
    let end = factor(&in_memory(parsed(&steady).case()).unwrap(), 2);
    println!("after half a day {early:.3}, after 20 days {late:.3}, in the end {end:.3}");
    assert!(
        early < late - 0.02 && late < end + 0.02,
        "{early} {late} {end}"
    );
    let table = std::fs::read_to_string(whole.join("curves/safety-in-time.csv")).unwrap();
    let times: Vec<f64> = (table.lines().skip(1))
        .map(|line| line.split(',').next().unwrap().parse().unwrap())
        .collect();
    assert_eq!(times, [43_200.0, 1_728_000.0]);
    for name in [
        "figures/curve-safety-in-time.svg",
        "figures/seepage-later-at-0_5-d.svg",
        "sections/seepage-balance-later-at-20-d.csv",
        "paraview/seepage-later-at-20-d.vtu",
    ] {
        assert!(whole.join(name).is_file(), "{name}");
    }
    let expected = everything(&whole);
    let stopped = folder("seepage_in_time_stopped");
    let part = run_into((&file, file.case()), &stopped, Start::Afresh, Some(3));
    assert!(part.summary.interrupted);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(3)
        .build()
        .unwrap();
    let end = pool.install(|| run_into((&file, file.case()), &stopped, Start::Resume, None));
    assert_done(&end.summary);
    assert_equal(
        &expected,
        &everything(&stopped),
        "taken up on three threads",
    );
}

/// GOAL: levels from a file are those of the case, and impossible histories are refused where they stand.
#[test]
fn histories_in_time_are_read() {
    let place = folder("seepage_histories");
    std::fs::create_dir_all(&place).unwrap();
    std::fs::write(
        place.join("pool.csv"),
        "time [d], value [cm]\n0, 900\n1, 500\n",
    )
    .unwrap();
    std::fs::write(place.join("bare.csv"), "time, value\n0, 9\n1, 5\n").unwrap();
    let inline = "{ time = [\"0 d\", \"1 d\"], values = [\"9 m\", \"5 m\"] }";
    let name = place.join("case.toml");
    let read = |text: &str| CaseFile::parse(name.to_str().unwrap(), text, &[]);
    let filed = read(&in_time(&[(inline, "{ file = \"pool.csv\" }")]));
    let filed = filed.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(filed.case().water, parsed(&in_time(&[])).case().water);
    for (from, to, message) in [
        ("drainable = 0.1", "drainable = 1.5", "drainable"),
        (
            ", drainable = 0.1",
            "",
            "nothing says how much water drains from `sand`",
        ),
        ("start_from = \"steady\"\n", "", "but its flow is steady"),
        (
            "times = [\"0.5 d\", \"20 d\"]\n",
            "",
            "has a start and no times",
        ),
        (
            "start_from = \"steady\"",
            "start_from = \"later at 20 d\"",
            "no steady seepage",
        ),
        (
            "in_time = \"later\"",
            "in_time = \"steady\"",
            "has no times to search at",
        ),
        (
            "values = [\"9 m\", \"5 m\"]",
            "values = [\"9 m\"]",
            "2 times and 1 values",
        ),
        (
            "\"0 d\", \"1 d\"",
            "\"2 d\", \"1 d\"",
            "not after the one before",
        ),
        (inline, "{ time = [\"0 d\"] }", "has no values in time"),
        (inline, "{ file = \"none.csv\" }", "none.csv"),
        (
            inline,
            "{ file = \"bare.csv\" }",
            "write it into the header of the column, as in `time [",
        ),
    ] {
        let found = read(&in_time(&[(from, to)]))
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(found.contains(message), "{message}: {found}");
        assert!(!found.contains("beside the file"), "{found}");
    }
}
