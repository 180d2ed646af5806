//! GOAL: each kind of stage does what it says, whatever came before it.
//! CASES: columns and blocks that have an exact answer.
//! ORACLE: the weight above, one-dimensional compression, and the balance of forces.

use std::sync::atomic::AtomicBool;

use igimp_cases::run::{Event, Run, Start, run};
use igimp_input::CaseFile;
use igimp_results::summary::StageOutcome;

/// Level ground, 4 m wide: 3 m of clay on 2 m of sand, and 1 m of free grid above.
const GROUND: &str = r#"
igimp = 1
[case]
title = "level ground"
gravity = "10 m/s2"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "4 m"], y = ["0 m", "6 m"] }
[materials.sand]
model = "mohr-coulomb"
unit_weight = "20 kN/m3"
young = "50 MPa"
poisson = 0.25
cohesion = "1 kPa"
friction = "35 deg"
k0 = "jaky"
[materials.clay]
model = "elastic"
unit_weight = "16 kN/m3"
young = "5 MPa"
poisson = 0.0
k0 = 0.7
[[bodies]]
name = "sand"
material = "sand"
points_per_cell = 4
polygon = [["0 m","0 m"], ["4 m","0 m"], ["4 m","2 m"], ["0 m","2 m"]]
[[bodies]]
name = "clay"
material = "clay"
points_per_cell = 4
polygon = [["0 m","2 m"], ["4 m","2 m"], ["4 m","5 m"], ["0 m","5 m"]]
[boundaries]
left = "roller"
right = "roller"
bottom = "fixed"
[[monitors]]
name = "surface"
point = ["2 m", "5 m"]
record = ["displacement_y", "sigma_yy"]
"#;

fn ran(text: &str) -> Run<2> {
    let file = CaseFile::parse("test.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut quiet = |_: &Event<'_, 2>| {};
    let interrupt = AtomicBool::new(false);
    run(file.case(), None, Start::Afresh, &mut quiet, &interrupt).unwrap()
}

fn with(stages: &str) -> String {
    format!("{GROUND}{stages}")
}

#[test]
fn level_ground_carries_the_weight_above_at_rest() {
    let run = ran(&with(
        "[[stages]]\nname = \"rest\"\ntype = \"k0\"\nsteps = 1\n",
    ));
    assert_eq!(run.summary.stages[0].outcome, StageOutcome::Completed);
    let particles = &run.body.particles;
    let jaky = 1.0 - 35.0_f64.to_radians().sin();
    for (x, sigma) in particles.x.iter().zip(&particles.sigma) {
        let (weight, k0) = if x[1] > 2.0 {
            (16e3 * (5.0 - x[1]), 0.7)
        } else {
            (48e3 + 20e3 * (2.0 - x[1]), jaky)
        };
        assert!(
            (sigma[1][1] + weight).abs() < 0.02 * 88e3,
            "{x:?} {sigma:?}"
        );
        assert!(
            (sigma[0][0] - k0 * sigma[1][1]).abs() < 0.01 * 88e3,
            "{x:?} {sigma:?}"
        );
        assert!(sigma[0][1].abs() < 1e-3);
    }
    // Gravity turned on would have settled the surface by 16 mm.
    assert!(run.summary.stages[0].largest_displacement < 2e-4);
}

#[test]
fn pressure_compresses_a_layer_as_in_one_dimension() {
    let run = ran(&with(
        r#"
[[loads]]
name = "fill"
type = "pressure"
from = ["0 m", "5 m"]
to = ["4 m", "5 m"]
pressure = "20 kPa"
[[stages]]
name = "rest"
type = "k0"
steps = 1
reset_displacements = true
[[stages]]
name = "half"
type = "load"
load = "fill"
factor = 0.5
steps = 2
[[stages]]
name = "whole"
type = "load"
load = "fill"
steps = 2
[[curves]]
name = "settlement"
x = { of = "fill.factor", label = "factor" }
y = { of = "surface.displacement_y", label = "u_y" }
"#,
    ));
    // p H/E in the clay, p H/E_oed in the sand; the monitor stands at the surface.
    let oedometric = 50e6 * 0.75 / (1.25 * 0.5);
    let expected = |pressure: f64| -pressure * (3.0 / 5e6 + 2.0 / oedometric);
    let curve = &run.curves[0].rows;
    assert_eq!(curve.len(), 1 + 1 + 2 + 2, "{curve:?}");
    let factors: Vec<f64> = curve.iter().map(|row| row[0]).collect();
    assert_eq!(factors, [0.0, 0.0, 0.25, 0.5, 0.75, 1.0]);
    for row in &curve[2..] {
        let expected = expected(20e3 * row[0]);
        assert!((row[1] / expected - 1.0).abs() < 0.02, "{row:?} {expected}");
    }
    let monitor = &run.monitors[0].rows;
    let pressure = monitor.last().unwrap()[4];
    assert!((pressure / 20e3 - 1.0).abs() < 0.02, "{pressure}");
}

#[test]
fn a_stage_may_start_from_an_earlier_one() {
    let load = |name: &str, from: &str| {
        format!(
            "[[stages]]\nname = \"{name}\"\ntype = \"gravity\"\nfactor = 1.0\nsteps = 2\n{from}"
        )
    };
    let text = with(&format!(
        "{}{}{}",
        load("first", ""),
        "[[stages]]\nname = \"more\"\ntype = \"gravity\"\nfactor = 1.5\nsteps = 2\n",
        load("back", "start_from = \"first\"\n"),
    ));
    let run = ran(&text);
    let settled: Vec<f64> = run
        .summary
        .stages
        .iter()
        .map(|stage| stage.largest_displacement)
        .collect();
    assert!(settled[1] > 1.4 * settled[0]);
    assert!((settled[2] / settled[0] - 1.0).abs() < 1e-4, "{settled:?}");
}

#[test]
fn a_stage_ends_where_the_case_wants() {
    let run = ran(&with(
        "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 20\n\
         stop_when = { displacement = \"12 mm\" }\n",
    ));
    let stage = &run.summary.stages[0];
    assert_eq!(stage.outcome, StageOutcome::Stopped);
    assert_eq!(stage.reason, "the largest displacement exceeds 0.012 m");
    assert!(stage.reached < 0.9 && stage.largest_displacement > 0.012);
}

/// Soil that flows off its grid tells nothing of the load that it carries: where want of equilibrium
/// is the planned end of a stage, this is not that end.
#[test]
fn soil_that_leaves_the_grid_is_no_collapse() {
    let bulging = GROUND
        .replace("x = [\"0 m\", \"4 m\"]", "x = [\"0 m\", \"4.5 m\"]")
        .replace("right = \"roller\"", "right = \"free\"")
        .replace("cohesion = \"1 kPa\"", "cohesion = \"1 MPa\"")
        .replace("young = \"5 MPa\"", "young = \"20 kPa\"")
        .replace("poisson = 0.0", "poisson = 0.45");
    let run = ran(&(bulging
        + "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 20\n\
           stop_when = { no_equilibrium = true }\n"));
    let stage = &run.summary.stages[0];
    assert_eq!(
        stage.outcome,
        StageOutcome::NotConverged,
        "{}",
        stage.reason
    );
    assert!(
        stage.reason.contains("would leave the background grid"),
        "{}",
        stage.reason
    );
    let failure = run.failure.expect("the step is described");
    assert!(!failure.error.failure.is_want_of_equilibrium());
}

/// A wall of soft clay, 4 m high, that stands or falls by its strength.
fn wall(strength: &str, young: &str, stages: &str) -> String {
    format!(
        r#"
igimp = 1
[case]
title = "wall"
gravity = "10 m/s2"
[grid]
cell = "1 m"
domain = {{ x = ["0 m", "24 m"], y = ["0 m", "6 m"] }}
[materials.clay]
model = "tresca"
unit_weight = "18 kN/m3"
young = "{young}"
poisson = 0.45
cu = "{strength}"
[[bodies]]
name = "wall"
material = "clay"
points_per_cell = 9
polygon = [["0 m","0 m"], ["8 m","0 m"], ["8 m","4 m"], ["0 m","4 m"]]
{stages}
"#
    )
}

#[test]
fn a_planned_collapse_is_an_end_and_another_one_a_failure() {
    let stage = |more: &str| {
        format!("[[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 5\n{more}")
    };
    let planned = ran(&wall(
        "8 kPa",
        "200 MPa",
        &stage("stop_when = { no_equilibrium = true }\n"),
    ));
    let end = &planned.summary.stages[0];
    assert!(planned.failure.is_none());
    assert_eq!(end.outcome, StageOutcome::Stopped);
    assert!(
        end.reason.starts_with("no equilibrium beyond 0."),
        "{}",
        end.reason
    );
    // γH/c of a vertical cut is 3.83 by Fellenius; four cells over the height overshoot.
    let height = end.reached * 18.0 * 4.0 / 8.0;
    assert!((3.6..5.0).contains(&height), "{height}");

    let unplanned = ran(&wall("8 kPa", "200 MPa", &stage("")));
    let failure = unplanned.failure.unwrap();
    assert_eq!(
        unplanned.summary.stages[0].outcome,
        StageOutcome::NotConverged
    );
    let reached = unplanned.summary.stages[0].reached;
    assert!(reached.total_cmp(&end.reached).is_eq());
    assert_eq!(unplanned.summary.failure, Some(failure.to_string()));
    assert!(!failure.suggestions.is_empty());
    assert!(failure.near_worst.is_some());
}

#[test]
fn a_wall_of_reduced_strength_slumps_and_comes_to_rest() {
    let run = ran(&wall(
        "20 kPa",
        "2 MPa",
        r#"
[[stages]]
name = "weight"
type = "gravity"
steps = 5
reset_displacements = true
[[stages]]
name = "run-out"
type = "run-out"
reduction = { factor = 1.6 }
steps = 300
"#,
    ));
    let stage = &run.summary.stages[1];
    assert_eq!(stage.outcome, StageOutcome::Completed, "{}", stage.reason);
    assert!(
        stage.reason.starts_with("at rest after"),
        "{}",
        stage.reason
    );
    assert!(
        stage.reason.ends_with("in equilibrium without drag"),
        "{}",
        stage.reason
    );
    assert!(
        stage.largest_displacement > 0.5,
        "{}",
        stage.largest_displacement
    );
    // Soil is nearly incompressible, and none of it is lost.
    let particles = &run.body.particles;
    let volume: f64 = (0..particles.len())
        .map(|particle| particles.volume(particle))
        .sum();
    assert!((volume / 32.0 - 1.0).abs() < 0.02, "{volume}");
    // τ is on the yield surface, and σ = τ/det F.
    let strength = 20e3 / 1.6;
    for (sigma, f) in particles.sigma.iter().zip(&particles.def_grad) {
        let det_f = f[0][0] * f[1][1] - f[0][1] * f[1][0];
        let radius = det_f * (0.5 * (sigma[0][0] - sigma[1][1])).hypot(sigma[0][1]);
        assert!(radius < strength * (1.0 + 1e-9), "{radius}");
    }
}

/// GOAL: means over cells know no sawtooth, and a section is held against what it should show.
/// ORACLE: the weight above, at the middle of the cells.
#[test]
fn sections_read_means_over_cells_and_are_held_against_references() {
    let section = |average: &str| {
        with(&format!(
            r#"
[[stages]]
name = "rest"
type = "k0"
steps = 1
[[sections]]
name = "down"
from = ["1.3 m", "5 m"]
to = ["1.3 m", "2 m"]
record = ["displacement", "sigma_yy"]
average = "{average}"
[[sections.references]]
of = "sigma_yy"
points = [[0.25, 4e3], [2.75, 44e3]]
label = "weight above"
tolerance = 0.001
[[sections.references]]
of = "sigma_yy"
y = 50e3
at = 1.0
label = "something else"
tolerance = 0.001
"#
        ))
    };
    let run = ran(&section("cell"));
    let table = &run.sections[0];
    assert_eq!(table.rows.len(), 6, "six cells of half a metre");
    for row in &table.rows {
        let [distance, x, weight] = [row[0], row[1], row[4]];
        assert!((x - 1.25).abs() < 0.01, "{row:?}");
        assert!((weight - 16e3 * distance).abs() < 2e-4 * 48e3, "{row:?}");
    }
    let checks: Vec<_> = run
        .summary
        .checks
        .iter()
        .map(|row| (row.check.quantity.as_str(), row.pass))
        .collect();
    assert_eq!(
        checks,
        [
            ("down, sigma_yy at 0.25", true),
            ("down, sigma_yy at 2.75", true),
            ("down, sigma_yy at 1", false)
        ]
    );
    let particles = ran(&section("none")).sections[0].rows.len();
    assert_eq!(particles, 12, "two particles to a cell");
}

/// GOAL: a check may look at the most of a stage, as well as at its end.
#[test]
fn a_check_looks_at_the_peak_of_its_stage() {
    let check = |name: &str, at: &str, band: &str| {
        format!(
            "[[checks]]\nname = \"{name}\"\nof = \"fill.factor\"\nstage = \"off\"\n\
             at = \"{at}\"\n{band}\nsource = \"the stages\"\n"
        )
    };
    let stages = format!(
        r#"
[[loads]]
name = "fill"
type = "pressure"
from = ["0 m", "5 m"]
to = ["4 m", "5 m"]
pressure = "20 kPa"
[[stages]]
name = "rest"
type = "k0"
steps = 1
[[stages]]
name = "on"
type = "load"
load = "fill"
factor = 0.8
steps = 2
[[stages]]
name = "off"
type = "load"
load = "fill"
factor = 0.2
steps = 3
{}{}"#,
        check("most", "peak", "expected = 0.8\ntolerance = 1e-9"),
        check("end", "end", "expected = 0.2\ntolerance = 1e-9")
    );
    let run = ran(&with(&stages));
    let found: Vec<_> = run
        .summary
        .checks
        .iter()
        .map(|row| (row.check.measured, row.pass))
        .collect();
    assert_eq!(found.len(), 2);
    assert!(found.iter().all(|&(_, pass)| pass), "{found:?}");
}
