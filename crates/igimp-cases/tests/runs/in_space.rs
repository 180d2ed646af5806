//! GOAL: a case in space does what one in the plane does: stages, restart, threads, records, frames, messages.
//! CASE: a ledge of ground that is at rest, pressed and pulled, filled on and dug at; a small slope that loses its strength.
//! ORACLE: stresses of level ground; forces in equilibrium; the same run left alone.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use crate::edits::{Edits, edited};
use crate::resuming::{assert_done, assert_equal, everything, run_into};
use igimp_cases::run::{Event, Run, Start, in_memory, run};
use igimp_input::CaseFile;
use igimp_model::Case;
use igimp_results::ending::PathEnd;
use igimp_results::summary::{SafetySummary, StageOutcome};

/// Ground of 3 m by 1.5 m by 1.5 m, at rest with K0 = 0.5; a cube of fill comes, and a slice of the ground goes.
const LEDGE: &str = r#"
igimp = 1
[case]
title = "a ledge in space"
analysis = "3d"
gravity = "10 m/s2"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "3 m"], y = ["0 m", "1.5 m"], z = ["0 m", "2.5 m"] }
[materials.clay]
model = "mohr-coulomb"
unit_weight = "20 kN/m3"
young = "10 MPa"
poisson = 0.3
cohesion = "20 kPa"
friction = "25 deg"
k0 = 0.5
[[bodies]]
name = "fill"
material = "clay"
box = { from = ["0 m", "0 m", "1.5 m"], to = ["1 m", "1 m", "2 m"] }
[[bodies]]
name = "ground"
material = "clay"
polygon = [["0 m", "0 m"], ["3 m", "0 m"], ["3 m", "1 m"], ["2 m", "1 m"], ["2 m", "1.5 m"], ["0 m", "1.5 m"]]
across = ["0 m", "1.5 m"]
[[bodies]]
name = "slice"
material = "clay"
box = { from = ["2 m", "0 m", "1 m"], to = ["3 m", "1.5 m", "1.5 m"] }
[[loads]]
name = "patch"
type = "pressure"
from = ["1 m", "0 m", "1.5 m"]
to = ["2 m", "1 m", "1.5 m"]
pressure = "8 kPa"
[[loads]]
name = "pull"
type = "point"
at = ["1.25 m", "1.25 m", "1.375 m"]
force = ["1 kN", "-0.5 kN", "0.25 kN"]
[[stages]]
name = "rest"
type = "k0"
steps = 1
[[stages]]
name = "press"
type = "load"
loads = ["patch", "pull"]
steps = 2
[[stages]]
name = "fill"
type = "construction"
place = ["fill"]
steps = 2
[[stages]]
name = "dig"
type = "construction"
remove = ["slice"]
steps = 2
[[monitors]]
name = "top"
point = ["0.4 m", "0.4 m", "1.4 m"]
record = ["displacement_z", "sigma_zz", "tau_yz"]
[[monitors]]
name = "filled"
point = ["0.4 m", "0.4 m", "1.9 m"]
record = ["sigma_zz"]
[[sections]]
name = "upright"
from = ["0.375 m", "0.375 m", "0 m"]
to = ["0.375 m", "0.375 m", "1.5 m"]
points = 6
record = ["sigma_xx", "sigma_yy", "sigma_zz", "displacement_y"]
[[curves]]
name = "patch"
x = { of = "top.displacement_z", label = "u_z [m]" }
y = { of = "patch.factor", label = "factor [-]" }
[output]
figures = []
paraview = { every = 1 }
checkpoint = { every = 1, keep = 2 }
"#;

/// A slope of 2 m between walls.
const SLOPE: &str = r#"
igimp = 1
[case]
title = "a slope in space"
analysis = "3d"
[grid]
cell = "1 m"
domain = { x = ["0 m", "7 m"], y = ["0 m", "2 m"], z = ["0 m", "4 m"] }
[materials.clay]
model = "tresca"
unit_weight = "20 kN/m3"
young = "5 MPa"
poisson = 0.49
cu = "12 kPa"
[[bodies]]
name = "slope"
material = "clay"
polygon = [["0 m", "0 m"], ["7 m", "0 m"], ["7 m", "1 m"], ["5 m", "1 m"], ["3 m", "3 m"], ["0 m", "3 m"]]
across = ["0 m", "2 m"]
[[stages]]
name = "weight"
type = "gravity"
steps = 2
[[stages]]
name = "safety"
type = "strength-reduction"
bracket = [1.0, 3.0]
tolerance = 0.25
steps = 4
[[stages]]
name = "run-out"
type = "run-out"
reduction = { times_fos = 1.02 }
at_rest = 0.01
[output]
figures = []
checkpoint = { every = 1, keep = 2 }
"#;

fn parsed(text: &str, settings: &[&str]) -> CaseFile {
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    CaseFile::parse("space.toml", text, &settings).unwrap_or_else(|error| panic!("{error}"))
}

fn case(text: &str, settings: &[&str]) -> Case<3> {
    parsed(text, settings).case_in_space().clone()
}

fn folder(name: &str) -> PathBuf {
    crate::resuming::folder(&format!("space-{name}"))
}

/// Runs into a folder; with a number of steps until it is interrupted.
fn written(file: &CaseFile, folder: &Path, start: Start, steps: Option<usize>) -> Run<3> {
    run_into((file, file.case_in_space()), folder, start, steps)
}

#[track_caller]
fn assert_same_files(whole: &Path, found: &Path, why: &str) {
    assert_equal(&everything(whole), &everything(found), why);
}

/// GOAL: a run that is taken up at any checkpoint, or begun again at any stage, ends with the same files.
#[test]
fn a_run_is_taken_up_anywhere() {
    let file = parsed(LEDGE, &[]);
    let whole = folder("whole");
    assert_done(&written(&file, &whole, Start::Afresh, None).summary);
    let stopped = folder("stopped");
    for steps in [1, 3, 4, 6] {
        let part = written(&file, &stopped, Start::Afresh, Some(steps));
        assert!(part.summary.interrupted, "{steps}");
        let end = written(&file, &stopped, Start::Resume, None);
        assert_done(&end.summary);
        assert_same_files(&whole, &stopped, &format!("after {steps} steps"));
    }
    for stage in 1..4 {
        written(&file, &stopped, Start::FromStage(stage), None);
        assert_same_files(&whole, &stopped, &format!("from stage {stage}"));
    }
    let frame = fs::read_to_string(whole.join("paraview/particles_0001.vtu")).unwrap();
    // What is written in blocks is not for reading here; a hexahedron has eight corners.
    let count = |name: &str| -> usize {
        let from = frame.split(&format!("{name}=\"")).nth(1).unwrap();
        from.split('"').next().unwrap().parse().unwrap()
    };
    assert_eq!(count("NumberOfPoints"), 8 * count("NumberOfCells"));
    for name in ["sigma", "displacement"] {
        assert!(frame.contains(&format!("Name=\"{name} [")), "{name}");
    }
}

/// GOAL: the numbers do not depend on how many threads there are.
#[test]
fn the_bits_are_the_same_on_any_number_of_threads() {
    let case = case(LEDGE, &[]);
    let ran = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let run = pool.build().unwrap().install(|| in_memory(&case).unwrap());
        run.body.particles
    };
    let one = ran(1);
    for threads in [2, 7] {
        assert!(ran(threads) == one, "{threads} threads");
    }
}

/// GOAL: level ground is at rest with the stresses that it is given.
/// ORACLE: the weight above, and half of it sideways.
#[test]
fn level_ground_is_at_rest() {
    let mut case = case(LEDGE, &[]);
    case.stages.truncate(1);
    let run = in_memory(&case).unwrap();
    assert_done(&run.summary);
    let particles = &run.body.particles;
    for (x, sigma) in std::iter::zip(&particles.x, &particles.sigma) {
        let above = 20e3 * (1.5 - x[2]);
        for axis in 0..3 {
            let expected = -above * [0.5, 0.5, 1.0][axis];
            assert!(
                (sigma[axis][axis] - expected).abs() < 1e-6 * 30e3,
                "{x:?} {sigma:?}"
            );
        }
    }
    // x, y and z of the section, distance and number aside: its last columns are the fields.
    let [upright] = &run.sections[..] else {
        panic!("one section")
    };
    assert_eq!(upright.rows.len(), 6);
    let columns = upright.rows[0].len();
    for row in &upright.rows[1..5] {
        let [xx, yy, zz, u_y] = row[columns - 4..] else {
            panic!()
        };
        assert!((xx - yy).abs() < 1e-3 && (xx - 0.5 * zz).abs() < 1e-3 && u_y.abs() < 1e-8);
        assert!(zz > 0.0, "{row:?}");
    }
}

/// GOAL: loads and weight go into the supports, and bodies that come and go take theirs with them.
/// ORACLE: forces in equilibrium along each axis.
#[test]
fn reactions_carry_loads_and_weight() {
    let case = case(LEDGE, &[]);
    let mut sums: Vec<(usize, [f64; 3])> = Vec::new();
    let mut stage_now = 0;
    let mut listener = |event: &Event<'_, 3>| match event {
        Event::StageStarted { stage, .. } => stage_now = *stage,
        Event::Equilibrium { accepted, .. } => {
            let all = accepted.forces.reactions.iter();
            let sum = all.fold([0.0; 3], |sum, force| {
                std::array::from_fn(|axis| sum[axis] + force[axis])
            });
            sums.push((stage_now, sum));
        }
        _ => {}
    };
    let interrupt = AtomicBool::new(false);
    let run = run(&case, None, Start::Afresh, &mut listener, &interrupt).unwrap();
    assert_done(&run.summary);
    let ground = 20e3 * 3.0 * 1.5 * 1.5;
    let (fill, slice, patch) = (20e3 * 0.5, 20e3 * 1.5 * 0.5, 8e3);
    let pull = [1e3, -500.0, 250.0];
    let upwards = [
        ground,
        ground + patch - pull[2],
        ground + patch - pull[2] + fill,
        ground + patch - pull[2] + fill - slice,
    ];
    for (stage, expected) in upwards.into_iter().enumerate() {
        let (_, sum) = sums.iter().rfind(|(at, _)| *at == stage).unwrap();
        let sideways = if stage == 0 { [0.0; 2] } else { [-1e3, 500.0] };
        let expected = [sideways[0], sideways[1], expected];
        for axis in 0..3 {
            // The tolerance of equilibrium, as a share of the weight.
            assert!(
                (sum[axis] - expected[axis]).abs() < 1e-5 * ground,
                "{stage} {sum:?} {expected:?}"
            );
        }
    }
    let [top, filled] = &run.monitors[..] else {
        panic!("two monitors")
    };
    assert_eq!(top.rows.len(), 1 + 1 + 2 + 2 + 2);
    for row in &filled.rows {
        assert_eq!(row.last().unwrap().is_nan(), row[0] < 2.5, "{row:?}");
    }
    assert_eq!(run.curves[0].rows.len(), 8);
}

/// GOAL: whatever solves the linear systems, a run ends in the same state, is the same on any number of threads, and can be taken up.
/// ORACLE: factors in double precision.
#[test]
fn every_linear_solver_serves_a_run() {
    let of = |kind: &str| {
        let linear = format!("solver.linear=\"{kind}\"");
        parsed(
            LEDGE,
            &[
                linear.as_str(),
                "solver.tolerance=1e-10",
                "grid.cell=0.25 m",
            ],
        )
    };
    let on_threads = |threads: usize, run: &(dyn Fn() -> Run<3> + Sync)| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(run)
    };
    let particles = |file: &CaseFile| {
        let run = on_threads(1, &|| in_memory(file.case_in_space()).unwrap());
        run.body.particles
    };
    let expected = particles(&of("auto"));
    let largest = |values: &[[f64; 3]]| {
        values
            .as_flattened()
            .iter()
            .fold(0.0, |most: f64, u| most.max(u.abs()))
    };
    for kind in ["single", "multigrid"] {
        let file = of(kind);
        let one = particles(&file);
        let pairs = std::iter::zip(&one.displacement, &expected.displacement);
        let apart: Vec<_> = pairs.map(|(a, b)| [0, 1, 2].map(|k| a[k] - b[k])).collect();
        let (apart, most) = (largest(&apart), largest(&expected.displacement));
        assert!(apart < 1e-8 * most, "{kind}: {apart} of {most}");
        let [whole, stopped] = ["whole", "stopped"].map(|end| folder(&format!("{kind}-{end}")));
        let run = on_threads(2, &|| written(&file, &whole, Start::Afresh, None));
        assert_done(&run.summary);
        assert!(run.body.particles == one, "{kind}: bits");
        let mut efforts = run
            .summary
            .stages
            .iter()
            .filter_map(|stage| stage.linear.as_ref());
        let linear = efforts.next().unwrap();
        assert!(linear.method.starts_with(kind), "{}", linear.sentence());
        assert!(linear.iterations > 0, "{}", linear.sentence());
        written(&file, &stopped, Start::Afresh, Some(3));
        written(&file, &stopped, Start::Resume, None);
        assert_same_files(&whole, &stopped, kind);
    }
}

/// GOAL: a slope in space has a factor of safety, and comes to rest when its strength is a little less; both can be
/// taken up.
/// ORACLE: a slope in plane strain of the same strength, γH/c = 3.33, is safe by 5.379 / 3.33 at least on deep clay.
#[test]
fn a_slope_loses_its_strength() {
    let file = parsed(SLOPE, &[]);
    let whole = folder("slope");
    let ran = written(&file, &whole, Start::Afresh, None);
    let safety = ran.summary.stages[1].safety.as_ref().unwrap();
    let (stable, failed) = (safety.stable.unwrap(), safety.failed.unwrap());
    assert!(
        1.5 < stable && stable < failed && failed < 2.6,
        "{stable} {failed}"
    );
    assert!(failed - stable <= 0.25 + 1e-12);
    let run_out = &ran.summary.stages[2];
    assert_eq!(
        run_out.outcome,
        StageOutcome::Completed,
        "{}",
        run_out.reason
    );
    assert!(run_out.largest_displacement > 0.01);
    let stopped = folder("slope-stopped");
    for steps in [3, 8] {
        let part = written(&file, &stopped, Start::Afresh, Some(steps));
        assert!(part.summary.interrupted, "{steps}");
        written(&file, &stopped, Start::Resume, None);
        assert_same_files(&whole, &stopped, &format!("after {steps} steps"));
    }
}

/// GOAL: whatever solves the linear systems, a path of equilibria comes to the same limit and says the same of what decides it: an
/// iteration takes the load factor along, a factorisation eliminates it. The bits are the same on any number of threads.
/// ORACLE: factors in double precision.
#[test]
fn every_linear_solver_follows_a_path() {
    const CELL: &str = "grid.cell={ x = '0.5 m', y = '1 m', z = '0.5 m' }";
    let frictional = SLOPE
        .replace("\"tresca\"", "\"mohr-coulomb\"")
        .replace("poisson = 0.49", "poisson = 0.3")
        .replace(
            "cu = \"12 kPa\"",
            "cohesion = \"5 kPa\"\nfriction = \"25 deg\"",
        );
    for text in [SLOPE, &frictional] {
        let safety = |kind: &str, threads: usize| {
            let linear = format!("solver.linear=\"{kind}\"");
            let mut case = case(text, &[CELL, &linear]);
            case.stages.truncate(2);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let run = pool.build().unwrap().install(|| in_memory(&case).unwrap());
            let stage = run.summary.stages[1].clone();
            let linear = stage.linear.unwrap();
            assert!(
                kind == "auto" || linear.iterations > 0,
                "{}",
                linear.sentence()
            );
            stage.safety.unwrap()
        };
        let expected = safety("auto", 1);
        let path = expected.path.as_ref().unwrap();
        assert_ne!(path.end, PathEnd::Lost);
        for kind in ["multigrid", "single"] {
            let found = safety(kind, 1);
            assert_eq!(found, safety(kind, 2), "{kind}: bits");
            let off = found.stable.unwrap() / expected.stable.unwrap() - 1.0;
            assert!(off.abs() < 5e-4, "{kind}: {off}");
            let shares = |of: &SafetySummary| of.path.clone().unwrap().shares.unwrap().materials;
            let [share] = &shares(&found)[..] else {
                panic!("{kind}: one material")
            };
            let other = &shares(&expected)[0];
            let friction = share.friction.unwrap_or(0.0) - other.friction.unwrap_or(0.0);
            let apart = friction.abs().max((share.cohesion - other.cohesion).abs());
            assert!(apart < 0.02, "{kind}: {share:?} and {other:?}");
        }
    }
}

/// GOAL: the meshes of a study of a case in space are cut in all directions.
#[test]
fn a_study_of_meshes_halves_all_sides() {
    let mut case = case(LEDGE, &["mesh_study.meshes=2"]);
    case.stages.truncate(2);
    case.bodies.retain(|body| body.name != "fill");
    case.monitors.truncate(1);
    let run = in_memory(&case).unwrap();
    let study = run.summary.mesh_study.as_ref().unwrap();
    assert_eq!(study.meshes.len(), 2);
    assert_eq!(run.body.particles.len() % 8, 0);
}

fn messages(text: &str, cases: &[Edits<'_>]) -> String {
    let mut out = String::new();
    for edits in cases {
        for (from, to) in *edits {
            let _ = writeln!(out, "## {from:?} -> {to:?}");
        }
        let printed = match CaseFile::parse("space.toml", &edited(text, edits), &[]) {
            Ok(file) => format!("accepted\n{}", file.warnings()),
            Err(error) => error.to_string(),
        };
        let _ = writeln!(out, "{printed}");
    }
    out
}

#[test]
fn what_is_of_the_plane_is_refused_in_space() {
    insta::assert_snapshot!(messages(
        LEDGE,
        &[
            &[(
                "point = [\"0.4 m\", \"0.4 m\", \"1.4 m\"]",
                "point = [\"0.4 m\", \"1.4 m\"]"
            )],
            &[(
                "material = \"clay\"\nbox",
                "material = \"clay\"\npoints_per_cell = 4\nbox"
            )],
            &[("across = [\"0 m\", \"1.5 m\"]\n", "")],
            &[("remove = [\"slice\"]", "remove = [\"ledge\"]")],
            &[(", z = [\"0 m\", \"2.5 m\"]", "")],
            &[(
                "to = [\"2 m\", \"1 m\", \"1.5 m\"]",
                "to = [\"2 m\", \"1 m\", \"1.4 m\"]"
            )],
            &[(
                "from = [\"1 m\", \"0 m\", \"1.5 m\"]\nto = [\"2 m\", \"1 m\", \"1.5 m\"]",
                "from = [\"1 m\", \"0 m\", \"1 m\"]\nto = [\"2 m\", \"1 m\", \"1 m\"]"
            )],
            &[(
                "at = [\"1.25 m\", \"1.25 m\", \"1.375 m\"]",
                "at = [\"1.25 m\", \"1.25 m\", \"2.4 m\"]"
            )],
            &[(
                "force = [\"1 kN\", \"-0.5 kN\", \"0.25 kN\"]",
                "force = [\"1 kN/m\", \"-0.5 kN/m\", \"0.25 kN/m\"]"
            )],
            &[(
                "type = \"point\"\nat = [\"1.25 m\", \"1.25 m\", \"1.375 m\"]\nforce = [\"1 kN\", \"-0.5 kN\", \"0.25 kN\"]",
                "type = \"rigid-footing\"\nfrom = [\"0 m\", \"1.5 m\"]\nto = [\"1 m\", \"1.5 m\"]",
            )],
            // The ground alone has a ledge.
            &[("remove = [\"slice\"]", "place = [\"slice\"]")],
            &[(
                "box = { from = [\"2 m\", \"0 m\", \"1 m\"]",
                "box = { from = [\"1.5 m\", \"0 m\", \"1 m\"]"
            )],
            &[(
                "to = [\"1 m\", \"1 m\", \"2 m\"] }",
                "to = [\"1 m\", \"1 m\", \"3 m\"] }"
            )],
        ]
    ));
}

#[test]
fn what_is_of_space_is_refused_in_the_plane() {
    let plane = include_str!("../data/slope.toml");
    insta::assert_snapshot!(messages(
        plane,
        &[
            &[(
                "point = [\"15 m\", \"20 m\"]",
                "point = [\"15 m\", \"0 m\", \"20 m\"]"
            )],
            &[(
                "record = [\"displacement\", \"plastic_strain\"]",
                "record = [\"tau_yz\", \"plastic_strain\"]"
            )],
            &[("polygon = [", "across = [\"0 m\", \"1 m\"]\npolygon = [")],
            &[("plane-strain", "3d")],
        ]
    ));
}
