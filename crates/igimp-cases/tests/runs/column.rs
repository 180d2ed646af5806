//! GOAL: the shipped column in memory. A senseless case is refused with its reason, a run that
//! finds no equilibrium is a result and not an error, and the exact solution is met. So is that of a block under
//! pressure on its faces, wherever in a cell they lie.

use std::error::Error;

use igimp_assembly::Remedy;
use igimp_cases::exact;
use igimp_cases::run::in_memory;
use igimp_input::CaseFile;
use igimp_input::shipped::find;
use igimp_model::{Case, GridSpec, LoadKind, Strength};
use igimp_results::summary::StageOutcome;

/// The error and all its causes on one line.
fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(next) = cause {
        text = format!("{text}: {next}");
        cause = next.source();
    }
    text
}

/// A shipped case with overrides.
fn shipped(name: &str, overrides: &[&str]) -> Case<2> {
    let file = find(name).unwrap().case_file(overrides.iter().copied());
    file.unwrap().into_case()
}

/// The shipped column with so many cells over its height.
fn column(cells: u32, overrides: &[&str]) -> Case<2> {
    let cell = format!("grid.cell={{ x = '50/64 m', y = '50/{cells} m' }}");
    let top = format!("grid.domain.y=['0 m', '{}/{cells} m']", 50 * (cells + 1));
    shipped("column", &[&[&*cell, &*top], overrides].concat())
}

fn exact_solution(case: &Case<2>) -> exact::Column {
    exact::Column {
        height: 50.0,
        density: 80.0,
        gravity: 10.0,
        young: case.materials[0].young,
    }
}

/// A case may be made without a file, and then nothing has looked at it before.
#[test]
fn nonsense_is_refused_with_its_reason() {
    let refused = |name: &str, change: &dyn Fn(&mut Case<2>)| {
        let mut case = shipped(name, &[]);
        change(&mut case);
        chain(&in_memory(&case).unwrap_err())
    };
    let young = refused("column", &|case| case.materials[0].young = -5.0);
    assert!(
        young.starts_with("the material cannot be made: ") && young.contains("young"),
        "{young}"
    );
    let poisson = refused("von_mises_slope", &|case| case.materials[0].poisson = 0.5);
    assert!(
        poisson.contains("poisson") && poisson.contains("0.5"),
        "{poisson}"
    );
    let cell = refused("column", &|case| {
        case.grid = GridSpec::equal([0.0; 2], [1.0, 0.0], case.grid.cells());
    });
    assert!(cell.starts_with("the grid cannot be made: "), "{cell}");
    let outside = refused("column", &|case| {
        case.grid = GridSpec::equal([0.0; 2], case.grid.smallest_cell(), [1, 3]);
    });
    assert!(outside.ends_with("outside the grid domain"), "{outside}");
    let dilation = refused("mohr_coulomb_slope", &|case| {
        if let Strength::MohrCoulomb { dilation_angle, .. } = &mut case.materials[0].strength {
            *dilation_angle = 0.6;
        }
    });
    assert!(dilation.contains("dilation_angle"), "{dilation}");
    let off = refused("footing_bonded", &|case| {
        if let LoadKind::RigidFooting { from, .. } = &mut case.loads[0].kind {
            from[1] = 4.95;
        }
    });
    assert!(off.contains("not on a line of the grid"), "{off}");
    let stages = refused("column", &|case| case.stages.clear());
    assert_eq!(stages, "the case has no stage: there is nothing to run");
}

/// A column a million times too soft for one step: no equilibrium, and the reason is kept.
#[test]
fn a_run_that_stops_is_a_result() {
    let soft = [
        "materials.soft.young = 0.01 Pa",
        "stages.own weight.steps = 1",
    ];
    let result = in_memory(&column(8, &soft)).unwrap();
    let stage = &result.summary.stages[0];
    assert_eq!(stage.outcome, StageOutcome::NotConverged);
    assert!(stage.reached < 1.0);
    assert!(stage.cuts >= 6, "one attempt and five cuts");
    let failure = result.failure.unwrap();
    assert!(!failure.error.failure.to_string().is_empty());
    assert!(!failure.suggestions.is_empty());
    assert_eq!(result.body.particles.len(), 32, "what was computed is kept");
}

/// The coarse column of the benchmark, against the exact solution.
#[test]
fn a_coarse_column_is_close_to_the_exact_solution() {
    let case = column(16, &[]);
    let result = in_memory(&case).unwrap();
    let exact = exact_solution(&case);
    let error = exact.stress_error(&result.body.particles);
    assert!(error < 4e-3, "{error}");
    let top = 50.0 * result.curves[0].rows.last().unwrap()[1];
    assert!((top / exact.position(50.0) - 1.0).abs() < 5e-3, "{top}");
    assert_eq!(result.summary.stages[0].outcome, StageOutcome::Completed);
}

/// The treatment of small cuts shows in the column at E = 1 MPa with 128 cells: tying a node to
/// its neighbour keeps the accuracy of doing nothing, dropping it doubles the error.
#[test]
fn tying_small_cuts_costs_no_accuracy_and_dropping_them_does() {
    let error = |below, remedy| {
        let mut case = column(128, &["materials.soft.young = 1 MPa"]);
        case.method.small_cuts.below = below;
        case.method.small_cuts.remedy = remedy;
        let result = in_memory(&case).unwrap();
        exact_solution(&case).stress_error(&result.body.particles)
    };
    let (nothing, tied, dropped) = (
        error(0.0, Remedy::Tie),
        error(1e-4, Remedy::Tie),
        error(1e-4, Remedy::Drop),
    );
    for (measured, stated) in [(nothing, 2.32e-4), (tied, 2.29e-4), (dropped, 4.53e-4)] {
        assert!(
            (measured / stated - 1.0).abs() < 0.01,
            "{measured:e}, stated {stated:e}"
        );
    }
}

/// Every step reports its iterations, and checks look at the points that a curve recorded.
#[test]
fn a_factor_listed_is_tried_and_recorded() {
    let coarse = [
        "grid.cell = 2 m",
        "grid.domain.y = ['0 m', '12 m']",
        "stages.strength reduction.factors = [0.8, 1.0]",
        "stages.strength reduction.tolerance = 0.3",
    ];
    let result = in_memory(&shipped("mohr_coulomb_slope", &coarse)).unwrap();
    let safety = result.summary.stages[0].safety.as_ref().unwrap();
    let tried: Vec<f64> = safety.trials.iter().map(|trial| trial.srf).collect();
    assert_eq!(tried, [0.8, 1.0, 1.6, 1.3]);
    let curve = result.curves[0].points(0, 1);
    assert_eq!(curve.len(), 2, "{curve:?}");
    assert!((curve[0][1] - 0.379).abs() < 0.01, "{curve:?}");
}

/// A weightless block of four cells and a share more, on smooth supports at its left and below, of c = 5 kPa and φ = 30°. Both
/// free faces are pressed by 10 kPa, then the upper one by more until the block fails or has settled by 5 mm; or
/// up to 28 kPa, and strength is reduced.
fn block(more: [f64; 2], locking: &str, dilation: u32, stage: &str) -> Case<2> {
    let [width, height] = more.map(|more| 4.0 + more);
    let text = format!(
        r#"
igimp = 1
[case]
title = "block under pressure"
gravity = "0 m/s2"
[grid]
cell = "1 m"
domain = {{ x = ["0 m", "6 m"], y = ["0 m", "6 m"] }}
locking = "{locking}"
[materials.soil]
model = "mohr-coulomb"
unit_weight = "18 kN/m3"
young = "200 MPa"
poisson = 0.3
cohesion = "5 kPa"
friction = "30 deg"
dilation = "{dilation} deg"
[[bodies]]
name = "block"
material = "soil"
points_per_cell = 9
polygon = [["0 m", "0 m"], ["{width} m", "0 m"], ["{width} m", "{height} m"], ["0 m", "{height} m"]]
[boundaries]
left = "roller"
right = "free"
bottom = "roller"
[[loads]]
name = "top"
type = "pressure"
from = ["0 m", "{height} m"]
to = ["{width} m", "{height} m"]
pressure = "10 kPa"
[[loads]]
name = "side"
type = "pressure"
from = ["{width} m", "0 m"]
to = ["{width} m", "{height} m"]
pressure = "10 kPa"
[[stages]]
name = "pressure all around"
type = "load"
loads = ["side", "top"]
factor = 1
steps = 4
{stage}
[[monitors]]
name = "top of the block"
point = ["{} m", "{height} m"]
record = ["displacement_y"]
[[curves]]
name = "settlement"
x = {{ of = "top of the block.displacement_y" }}
y = {{ of = "top.factor" }}
"#,
        0.5 * width
    );
    let file = CaseFile::parse("block.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    file.into_case()
}

/// Where the faces of a block lie: shares of a cell beyond the last whole one.
const PLACES: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [0.02, 0.02],
    [0.1, 0.0],
    [0.25, 0.0],
    [0.0, 0.5],
    [0.5, 0.5],
    [0.75, 0.0],
    [0.9, 0.0],
];

/// A biaxial test fails at q = K_p p + 2 c √K_p, whatever the dilation and wherever its pressed faces lie in a cell.
#[test]
fn a_biaxial_block_carries_its_exact_load_anywhere_in_a_cell() {
    let exact = 3.0 + 3.0_f64.sqrt();
    for (locking, dilation) in [
        ("shared-strain", 0),
        ("shared-strain", 30),
        ("b-bar", 0),
        ("b-bar", 30),
    ] {
        for place in PLACES {
            let stage = "[[stages]]\nname = \"load\"\ntype = \"load\"\nload = \"top\"\nfactor = 4.6\nsteps = 6\n\
                         [[stages]]\nname = \"limit\"\ntype = \"load\"\nload = \"top\"\nfactor = 5.2\nsteps = 12\n\
                         stop_when = { no_equilibrium = true, displacement = \"8 mm\" }";
            let run = in_memory(&block(place, locking, dilation, stage)).unwrap();
            let rows = run.curves[0].points(0, 1);
            let settled = rows.iter().find(|[settlement, _]| *settlement <= -0.005);
            let carried = settled.or(rows.last()).unwrap()[1];
            println!("{locking}, ψ = {dilation}°, {place:?}: {carried:.3} of {exact:.3}");
            assert!(
                (carried / exact - 1.0).abs() < 0.015,
                "{locking}, {dilation}, {place:?}: {carried}"
            );
        }
    }
}

/// The same block at q = 28 kPa has the factor at which its reduced strength carries that, on the given geometry.
#[test]
fn a_biaxial_block_has_its_exact_factor_anywhere_in_a_cell() {
    let carried = |factor: f64| {
        let slope = 30.0_f64.to_radians().tan() / factor;
        let root = slope + slope.hypot(1.0);
        10.0 * root * root + 2.0 * 5.0 / factor * root
    };
    let exact = (0..60).fold([1.0, 3.0], |[low, high], _| {
        let middle = f64::midpoint(low, high);
        if carried(middle) > 28.0 {
            [middle, high]
        } else {
            [low, middle]
        }
    })[0];
    for (dilation, places) in [(15, &PLACES[..]), (0, &PLACES[2..5]), (30, &PLACES[2..5])] {
        for &place in places {
            let stage = "[[stages]]\nname = \"load\"\ntype = \"load\"\nload = \"top\"\nfactor = 2.8\nsteps = 4\n\
                         [[stages]]\nname = \"safety\"\ntype = \"strength-reduction\"\ngeometry = \"given\"";
            let run = in_memory(&block(place, "shared-strain", dilation, stage)).unwrap();
            let safety = run.summary.stages[2].safety.as_ref().unwrap();
            let factor = safety.stable.expect("a factor is found");
            println!("ψ = {dilation}°, {place:?}: {factor:.3} of {exact:.3}");
            assert!(
                (factor / exact - 1.0).abs() < 0.02,
                "{dilation}, {place:?}: {factor}"
            );
        }
    }
}

/// GOAL: the cone of Drucker and Prager stands in for Mohr–Coulomb in the plane. BODY: the shipped slope on coarse cells. ORACLE: the factor
/// of Mohr–Coulomb with ψ = φ, within 1 %; the cone of triaxial compression is stronger, as plane strain asks for less.
#[test]
fn a_slope_of_a_cone_for_plane_strain_is_one_of_mohr_coulomb() {
    let factor = |model: &[&str]| {
        let coarse = ["grid.cell = 1 m", "materials.clay.dilation = 20 deg"];
        let mut case = shipped("slope", &[&coarse, model].concat());
        case.stages.truncate(2);
        case.checks.clear();
        let run = in_memory(&case).unwrap();
        let safety = run.summary.stages[1].safety.as_ref().unwrap();
        safety.stable.unwrap()
    };
    let cone = "materials.clay.model = drucker-prager";
    let pyramid = factor(&[]);
    let plane = factor(&[cone, "materials.clay.cone = plane-strain"]);
    let outer = factor(&[cone, "materials.clay.cone = compression"]);
    println!(
        "F {pyramid:.3} of Mohr–Coulomb, {plane:.3} of the cone for plane strain, {outer:.3} of the outer one"
    );
    assert!(
        (plane / pyramid - 1.0).abs() < 0.01,
        "{plane} for {pyramid}"
    );
    assert!(outer > 1.05 * pyramid, "{outer} for {pyramid}");
}

/// GOAL: level ground without gravity has no stress. ORACLE: a weight that is not there; stresses under gravity as control.
#[test]
fn ground_at_rest_without_gravity_has_no_stress() {
    let largest = |gravity: &str| {
        let text = format!(
            r#"
igimp = 1
[case]
title = "at rest"
gravity = "{gravity}"
[grid]
cell = "1 m"
domain = {{ x = ["0 m", "2 m"], y = ["0 m", "5 m"] }}
[materials.clay]
model = "elastic"
unit_weight = "17 kN/m3"
young = "20 MPa"
poisson = 0.25
[[bodies]]
name = "layer"
material = "clay"
polygon = [["0 m", "0 m"], ["2 m", "0 m"], ["2 m", "5 m"], ["0 m", "5 m"]]
[[stages]]
name = "rest"
type = "k0"
steps = 1
"#
        );
        let file = CaseFile::parse("rest.toml", &text, &[]).unwrap();
        let run = in_memory(file.case()).unwrap();
        assert_eq!(run.summary.stages[0].outcome, StageOutcome::Completed);
        let stress = run.body.particles.sigma.iter().flatten().flatten();
        stress.fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    assert_eq!(largest("0 m/s2").to_bits(), 0.0_f64.to_bits());
    let bottom = largest("9.81 m/s2");
    assert!((bottom / 85e3 - 1.0).abs() < 0.06, "{bottom}");
}
