//! GOAL: bodies that come and go leave results that belong together, whatever is written and wherever a run is taken up.
//! CASE: two lifts on undrained ground under water, then a slice of the ground is taken away and the water lowered. The
//! lifts stand first in the case, so that particles are not numbered in the order in which they come.
//! ORACLE: the weight of the bodies; hydrostatic pressure; the same run left alone.

use std::fs;
use std::path::{Path, PathBuf};

use crate::resuming::{assert_done, assert_equal, everything, run_into};
use igimp_assembly::{Kinematics, Particles};
use igimp_cases::run::{Run, Start, in_memory};
use igimp_input::CaseFile;
use igimp_model::{
    Case, Construction, Drainage, Material, PoreSource, ReductionPath, ReinforcementKind,
    ReinforcementPart, SearchMethod, Stage, StageKind, StrengthReduction, WaterCondition,
};
use igimp_results::checkpoint;

const TEXT: &str = r#"
igimp = 1
[case]
title = "lifts and a slice"
gravity = "10 m/s2"
[grid]
cell = "0.5 m"
domain = { x = ["0 m", "6 m"], y = ["0 m", "4 m"] }
[materials.fill]
model = "mohr-coulomb"
unit_weight = "18 kN/m3"
young = "10 MPa"
poisson = 0.3
cohesion = "10 kPa"
friction = "30 deg"
k0 = 0.5
[materials.clay]
model = "mohr-coulomb"
unit_weight = "20 kN/m3"
young = "6 MPa"
poisson = 0.3
cohesion = "20 kPa"
friction = "25 deg"
k0 = 0.6
[[bodies]]
name = "upper lift"
material = "fill"
points_per_cell = 4
polygon = [["0 m","2.5 m"], ["2.5 m","2.5 m"], ["2 m","3 m"], ["0 m","3 m"]]
[[bodies]]
name = "ground"
material = "clay"
points_per_cell = 4
polygon = [["0 m","0 m"], ["6 m","0 m"], ["6 m","1 m"], ["4 m","1 m"], ["4 m","2 m"], ["0 m","2 m"]]
[[bodies]]
name = "lower lift"
material = "fill"
points_per_cell = 4
polygon = [["0 m","2 m"], ["3 m","2 m"], ["2.5 m","2.5 m"], ["0 m","2.5 m"]]
[[bodies]]
name = "slice"
material = "clay"
points_per_cell = 4
polygon = [["4 m","1 m"], ["6 m","1 m"], ["6 m","2 m"], ["4 m","2 m"]]
[boundaries]
left = "roller"
right = "roller"
bottom = "fixed"
[[stages]]
name = "rest"
type = "gravity"
steps = 1
[[monitors]]
name = "crest"
point = ["1 m", "2.8 m"]
record = ["displacement_y", "sigma_yy"]
[[monitors]]
name = "cut"
point = ["5 m", "1.6 m"]
record = ["sigma_yy", "u"]
[[monitors]]
name = "deep"
point = ["1 m", "0.6 m"]
record = ["sigma_yy", "sigma_eff_yy", "u", "u_excess", "p", "p_eff"]
[[sections]]
name = "upright"
from = ["1 m", "0 m"]
to = ["1 m", "3 m"]
points = 6
record = ["sigma_yy", "sigma_eff_yy", "u"]
[[curves]]
name = "crest"
x = { of = "step", label = "step" }
y = { of = "crest.displacement_y", label = "u_y" }
[output]
figures = ["displacement", "sigma_yy", "sigma_eff_yy", "u", "u_excess"]
report = true
paraview = { every = 1 }
checkpoint = { every = 1, keep = 2 }
"#;

const UPPER: usize = 0;
const LOWER: usize = 2;
const SLICE: usize = 3;

fn file() -> CaseFile {
    CaseFile::parse("lifts.toml", TEXT, &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn stage(like: &Stage, name: &str, from: usize, construction: Construction) -> Stage {
    Stage {
        name: name.to_owned(),
        kind: StageKind::Construction(construction),
        steps: 2,
        start_from: Some(from),
        drained: false,
        consolidation: None,
        ..like.clone()
    }
}

/// The case without water.
fn dry() -> Case<2> {
    let mut case = file().case().clone();
    for body in [UPPER, LOWER] {
        case.bodies[body].from_start = false;
    }
    case.stages[0].kind = StageKind::K0;
    let rest = case.stages[0].clone();
    let placing = |body| Construction {
        place: vec![body],
        ..Construction::default()
    };
    let removal = Construction {
        remove: vec![SLICE],
        ..Construction::default()
    };
    case.stages.extend([
        stage(&rest, "lower lift", 0, placing(LOWER)),
        stage(&rest, "upper lift", 1, placing(UPPER)),
        stage(&rest, "slice away", 2, removal),
    ]);
    case
}

fn wet() -> Case<2> {
    let mut case = dry();
    case.water = [("high", 1.8), ("low", 0.9)]
        .map(|(name, level)| WaterCondition {
            name: name.to_owned(),
            source: PoreSource::Table(vec![[0.0, level]]),
            bodies: Vec::new(),
            carried: false,
        })
        .to_vec();
    case.water_unit_weight = 10e3;
    case.materials[1].drainage = Drainage::Undrained {
        stiffness: 50e6.into(),
        flows: false,
    };
    case.stages[0].drained = true;
    if let StageKind::Construction(works) = &mut case.stages[3].kind {
        works.water = Some(1);
    }
    case
}

fn folder(name: &str) -> PathBuf {
    crate::resuming::folder(&format!("construction-{name}"))
}

/// Runs into a folder; with a number of steps until it is interrupted.
fn written(case: &Case<2>, folder: &Path, start: Start, steps: Option<usize>) -> Run<2> {
    run_into((&file(), case), folder, start, steps)
}

/// GOAL: each stage has the soil that is there, and that soil carries its own weight.
/// ORACLE: volumes of the polygons; the weight above the middle of the fill, half a lift wide of its edge.
#[test]
fn lifts_are_placed_and_a_slice_is_gone() {
    let run = in_memory(&dry()).unwrap();
    assert_done(&run.summary);
    let volume: f64 = run.body.particles.volume0.iter().sum();
    assert!(
        (volume - (12.0 - 2.0 + 1.375 + 1.125)).abs() < 1e-9,
        "{volume}"
    );
    let particles = &run.body.particles;
    assert_eq!(run.summary.size.particles, particles.len() + 2 * 16);
    let [crest, cut, deep] = &run.monitors[..] else {
        panic!()
    };
    // A row for the first moment and for every step; nothing where the body is not there.
    assert_eq!(crest.rows.len(), 1 + 1 + 2 + 2 + 2);
    for row in &crest.rows {
        assert_eq!(row[3].is_nan(), row[0] < 2.5, "{row:?}");
    }
    for row in &cut.rows {
        assert_eq!(row[3].is_nan(), row[0] > 3.5, "{row:?}");
    }
    let at = |stage: f64| deep.rows.iter().rfind(|row| row[0] < stage + 0.5).unwrap()[3];
    // The monitor stands in the particle whose centre is a quarter of a cell from lines of the grid.
    let (first, filled) = (at(1.0), at(3.0));
    assert!((first / (20e3 * 1.375) - 1.0).abs() < 0.02, "{first}");
    let added = (filled - first) / 18e3;
    assert!((0.7..1.0).contains(&added), "{added}");
    assert_eq!(run.curves[0].rows.len(), 8);
}

/// GOAL: fields name total and effective stress, pore pressure and the excess by soil.
/// ORACLE: hydrostatic pressure below the level; total stress is effective stress and pore pressure.
#[test]
fn fields_name_total_and_effective_stress() {
    let run = in_memory(&wet()).unwrap();
    assert_done(&run.summary);
    let deep = &run.monitors[2].rows;
    let (mut made, y) = (false, 0.625);
    for row in deep {
        let [sigma, effective, u, excess, p, p_eff] = row[3..] else {
            panic!()
        };
        let level = if row[0] > 3.5 { 0.9 } else { 1.8 };
        let given = 10e3 * f64::max(level - y, 0.0);
        // A level that lies within a domain acts on a part of it.
        assert!(
            (u - excess - given).abs() < 0.03 * 11.75e3,
            "{row:?} {given}"
        );
        assert!((sigma - effective - u).abs() < 1e-6, "{row:?}");
        assert!((p - p_eff - u).abs() < 1e-6, "{row:?}");
        made |= excess > 1e3;
        if row[0] < 1.5 {
            assert_eq!(excess.to_bits(), 0.0_f64.to_bits());
        }
    }
    assert!(
        made,
        "undrained ground under a fill has excess pore pressure"
    );
    let pores: Vec<_> = run
        .summary
        .stages
        .iter()
        .map(|stage| stage.pore_water)
        .collect();
    assert!(pores.iter().all(Option::is_some));
    assert_eq!(pores[0].unwrap().excess, None);
    assert!(pores[2].unwrap().excess.unwrap()[1] > 1e3);
    let section = &run.sections[3];
    assert_eq!(section.name, "upright__4-slice-away");
    for row in &section.rows {
        assert!((row[3] - row[4] - row[5]).abs() < 1e-6, "{row:?}");
    }
    // Without water there is nothing to tell of.
    let dry = in_memory(&dry()).unwrap();
    assert!(
        dry.summary
            .stages
            .iter()
            .all(|stage| stage.pore_water.is_none())
    );
    assert!(
        dry.monitors[2]
            .rows
            .iter()
            .all(|row| row[3].to_bits() == row[4].to_bits())
    );
}

/// GOAL: the numbers do not depend on how many threads there are.
#[test]
fn bodies_that_come_and_go_are_the_same_on_any_number_of_threads() {
    let case = wet();
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

/// GOAL: a run that is taken up within any stage, or begun again at one, ends with the same files; they show the bodies.
#[test]
fn a_run_is_taken_up_within_a_construction_stage() {
    let case = wet();
    let whole = folder("whole");
    let run = written(&case, &whole, Start::Afresh, None);
    assert_done(&run.summary);
    let expected = everything(&whole);
    let stopped = folder("stopped");
    for steps in [2, 4, 6] {
        let stage = written(&case, &stopped, Start::Afresh, Some(steps));
        assert!(stage.summary.interrupted, "{steps}");
        let end = written(&case, &stopped, Start::Resume, None);
        assert_done(&end.summary);
        assert_equal(
            &expected,
            &everything(&stopped),
            &format!("after {steps} steps"),
        );
    }
    written(&case, &stopped, Start::FromStage(3), None);
    assert_equal(&expected, &everything(&stopped), "from the last stage");
    assert_shows_bodies(&whole);
}

fn assert_shows_bodies(folder: &Path) {
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    // Frames: one a step, and one at the end of each stage.
    let cells = |frame: usize| {
        let text = read(&format!("paraview/particles_{frame:04}.vtu"));
        let from = text.split("NumberOfCells=\"").nth(1).unwrap();
        from.split('"').next().unwrap().parse::<usize>().unwrap()
    };
    let frames = read("paraview/particles.pvd").matches("<DataSet").count();
    let counts: Vec<usize> = (1..)
        .map_while(|k| {
            let path = folder.join(format!("paraview/particles_{k:04}.vtu"));
            path.exists().then(|| cells(k))
        })
        .collect();
    assert_eq!(counts.len(), frames);
    let end = |stage: usize| {
        let path = folder.join(format!("checkpoint/stage-{stage:02}-end"));
        checkpoint::read::<2>(&path, None).unwrap().states[0]
            .1
            .particles
            .len()
    };
    let mut different = counts.clone();
    different.dedup();
    assert_eq!(different, [end(1), end(2), end(3), end(4)]);
    let last = read(&format!("paraview/particles_{frames:04}.vtu"));
    for name in ["sigma", "sigma_eff"] {
        assert!(
            last.contains(&format!("Name=\"{name} [Pa], tension +\"")),
            "{name}"
        );
    }
    for name in ["u", "u_excess", "p", "p_eff"] {
        assert!(
            last.contains(&format!("Name=\"{name} [Pa], compression +\"")),
            "{name}"
        );
    }
    // Pictures show the water table, and of each stage the bodies that are there: edges now and before.
    let water = "#005ce6";
    for (stage, name) in [
        (1, "rest"),
        (2, "lower-lift"),
        (3, "upper-lift"),
        (4, "slice-away"),
    ] {
        for field in ["displacement", "sigma_yy", "sigma_eff_yy", "u", "u_excess"] {
            let picture = read(&format!("figures/field-{stage}-{name}-{field}.svg"));
            assert!(picture.contains(water), "{name} {field}");
        }
    }
    let summary = read("summary.json");
    assert!(summary.contains("lower lift placed"), "{summary}");
    assert!(
        summary.contains("slice taken away; water: low"),
        "{summary}"
    );
    let report = read("report.html");
    for line in [
        "Largest pore pressure",
        "Excess pore pressure",
        "Total vertical stress",
    ] {
        assert!(report.contains(line), "{line}");
    }
    let table = read("monitors/crest.csv");
    assert!(
        table.lines().nth(1).unwrap().ends_with("NaN,NaN"),
        "{table}"
    );
}

/// GOAL: a stage that only goes on needs nothing but its own checkpoint.
/// CASE: gravity is raised in three steps and stopped after two; the end of the stage before is gone.
#[test]
fn an_ordinary_stage_is_taken_up_without_the_state_that_it_began_with() {
    let mut case = dry();
    case.stages.truncate(1);
    let mut raised = case.stages[0].clone();
    raised.name = "heavier".to_owned();
    raised.kind = StageKind::Gravity {
        factor: 1.2,
        horizontal: None,
        across: None,
        vertical: None,
    };
    (raised.steps, raised.start_from) = (3, Some(0));
    case.stages.push(raised);
    let whole = in_memory(&case).unwrap();
    assert_done(&whole.summary);
    let stopped = folder("without-start");
    assert!(
        written(&case, &stopped, Start::Afresh, Some(3))
            .summary
            .interrupted
    );
    fs::remove_dir_all(stopped.join("checkpoint/stage-01-end")).unwrap();
    let end = written(&case, &stopped, Start::Resume, None);
    assert_done(&end.summary);
    assert!(end.body.particles == whole.body.particles);
}

/// GOAL: a nail that a stage installs as it digs holds back the face that it digs, wherever the run is taken up.
/// ORACLE: the same pit without the nail; the same run left alone.
#[test]
fn a_nail_is_installed_in_the_stage_that_digs() {
    let mut case = dry();
    case.stages.truncate(1);
    let removal = Construction {
        remove: vec![SLICE],
        ..Construction::default()
    };
    case.stages
        .push(stage(&case.stages[0], "slice away", 0, removal));
    case.materials[1].young = 1e6;
    let bare = in_memory(&case).unwrap();
    case.reinforcement.push(ReinforcementPart {
        name: "nail".to_owned(),
        kind: ReinforcementKind::Nail,
        line: vec![[4.0, 1.6], [1.5, 1.4]],
        stiffness: 20e6,
        capacity: 100e3,
        bond: 30e3,
        fastened: [20e3, 0.0],
        free_length: 0.0,
        plate: None,
        prestress: None,
        reduces_bond: false,
        from_start: false,
    });
    case.stages[1].install.push(0);
    let whole = folder("nailed");
    let nailed = written(&case, &whole, Start::Afresh, None);
    assert_done(&nailed.summary);
    let forces = |run: &Run<2>| -> Vec<f64> {
        let bars = run.body.reinforcement[0].segments.iter();
        bars.map(|bar| bar.state.force).collect()
    };
    assert!(forces(&nailed).iter().all(|force| *force >= 0.0));
    assert!(forces(&nailed).iter().any(|force| *force > 1e3));
    let outwards = |run: &Run<2>| {
        let moved = run.body.particles.displacement.iter().map(|u| u[0]);
        moved.fold(0.0, f64::max)
    };
    let [held, free] = [&nailed, &bare].map(outwards);
    assert!(0.0 < held && held < 0.9 * free, "{held} {free}");
    let stopped = folder("nailed-stopped");
    written(&case, &stopped, Start::Afresh, Some(2));
    let end = written(&case, &stopped, Start::Resume, None);
    assert_eq!(forces(&end), forces(&nailed));
    assert_equal(
        &everything(&whole),
        &everything(&stopped),
        "within the stage",
    );
}

/// Particles at the end of one more stage that gives all of the ground another material, or changes nothing.
fn after(case: &Case<2>, material: Option<usize>) -> Particles<2> {
    let mut case = case.clone();
    let last = case.stages.len() - 1;
    let change = Construction {
        materials: material.map_or_else(Vec::new, |new| vec![(1, new), (SLICE, new)]),
        ..Construction::default()
    };
    case.stages
        .push(stage(&case.stages[last], "change", last, change));
    let run = in_memory(&case).unwrap();
    assert_done(&run.summary);
    run.body.particles
}

/// Places \[m\] and total stresses \[Pa\] differ by no more.
fn assert_same(expected: &Particles<2>, found: &Particles<2>, [length, pressure]: [f64; 2]) {
    for particle in 0..expected.len() {
        let [a, b] = [expected, found].map(|soil| soil.x[particle]);
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < length, "{a:?} {b:?}");
        let [stress, other] = [expected, found].map(|soil| soil.total_stress(particle));
        for (a, b) in std::iter::zip(stress.as_flattened(), other.as_flattened()) {
            assert!((a - b).abs() < pressure, "{stress:?} {other:?}");
        }
    }
}

/// GOAL: the stress of soil that gets another material of the same stiffness stays.
/// CASE: soft ground that its weight has compressed by a tenth, in both measures of strain.
/// ORACLE: a stage that changes nothing.
#[test]
fn compressed_soil_of_the_same_stiffness_stays_as_it_is() {
    let mut case = dry();
    case.stages.truncate(1);
    case.stages[0].kind = StageKind::Gravity {
        factor: 1.0,
        horizontal: None,
        across: None,
        vertical: None,
    };
    case.stages[0].steps = 4;
    case.materials[1].young = 0.3e6;
    case.materials.push(case.materials[1].clone());
    for kinematics in [Kinematics::FiniteStrain, Kinematics::SmallStrain] {
        case.method.kinematics = kinematics;
        let unchanged = after(&case, None);
        let [[a, b], [c, d]] = unchanged.def_grad[0];
        assert!(a * d - b * c < 0.95);
        assert_same(&unchanged, &after(&case, Some(2)), [1e-8, 1.0]);
    }
}

/// GOAL: the total stress stays when a material of another drainage comes, and nothing moves; only pressure that drains goes.
/// ORACLE: a stage that changes nothing; undrained soil that drains from now on settles as where excess pressure dissipates.
#[test]
fn total_stress_stays_whatever_a_law_speaks_of() {
    // The grid of a new step is out of balance by a little, which stiff water bears in another way.
    const NEAR: [f64; 2] = [1e-6, 40.0];
    let mut case = wet();
    case.stages.truncate(2);
    let clay = case.materials[1].clone();
    for drainage in [Drainage::Total, Drainage::Drained] {
        case.materials.push(Material {
            drainage,
            ..clay.clone()
        });
    }
    let (total, drained) = (2, 3);
    let undrained = after(&case, None);
    assert!(undrained.excess.iter().any(|excess| *excess > 1e3));
    let by_total = after(&case, Some(total));
    assert_same(&undrained, &by_total, NEAR);
    let pores = |k: usize| by_total.pore_pressure[k].abs() + by_total.excess[k].abs();
    let ground = (0..by_total.len()).filter(|&k| by_total.law[k] == total);
    assert_eq!(ground.map(pores).fold(0.0, f64::max).to_bits(), 0);
    let mut back = case.clone();
    let change = Construction {
        materials: vec![(1, total), (SLICE, total)],
        ..Construction::default()
    };
    back.stages
        .push(stage(&back.stages[1], "by total stress", 1, change));
    let back = after(&back, Some(1));
    assert_same(&undrained, &back, NEAR);
    for (a, b) in std::iter::zip(&undrained.pore_pressure, &back.pore_pressure) {
        assert!((a - b).abs() < 0.1, "{a} {b}");
    }
    let drains = after(&case, Some(drained));
    assert!(drains.excess.iter().all(|excess| *excess == 0.0));
    let dissipation = Construction {
        dissipate: true,
        ..Construction::default()
    };
    case.stages
        .push(stage(&case.stages[1], "time passes", 1, dissipation));
    let dissipated = in_memory(&case).unwrap().body.particles;
    assert_same(&dissipated, &drains, [1e-10, 1e-3]);
    let settled = |k: usize| undrained.x[k][1] - drains.x[k][1];
    assert!((0..drains.len()).map(settled).fold(0.0, f64::max) > 1e-4);
}

/// GOAL: a search that raises gravity anew does so on the bodies that are there.
/// ORACLE: the same search on a case that has them from the start.
#[test]
fn a_search_by_gravity_sees_what_was_built() {
    let search = |case: &Case<2>, from: usize| Stage {
        name: "safety".to_owned(),
        kind: StageKind::StrengthReduction(StrengthReduction {
            materials: vec![0, 1],
            factors: vec![],
            bracket: [1.0, 6.0],
            tolerance: 1.0,
            path: ReductionPath::Gravity,
            failure_displacement: Some(1.0),
            monitor: None,
            search: SearchMethod::Trials,
        }),
        steps: 2,
        start_from: Some(from),
        ..case.stages[0].clone()
    };
    let mut built = dry();
    // The order in which the bodies come.
    built.bodies = [1, LOWER, UPPER].map(|k| built.bodies[k].clone()).to_vec();
    built.stages.truncate(3);
    for (stage, body) in [(1, 1), (2, 2)] {
        built.stages[stage].kind = StageKind::Construction(Construction {
            place: vec![body],
            ..Construction::default()
        });
    }
    built.monitors.clear();
    built.curves.clear();
    let mut whole = built.clone();
    built.stages.push(search(&built, 2));
    for body in &mut whole.bodies {
        body.from_start = true;
    }
    whole.stages[0].kind = StageKind::Gravity {
        factor: 1.0,
        horizontal: None,
        across: None,
        vertical: None,
    };
    whole.stages.truncate(1);
    whole.stages.push(search(&whole, 0));
    let [built, whole] = [built, whole].map(|case| {
        let run = in_memory(&case).unwrap();
        let safety = run.summary.stages.last().unwrap().safety.clone().unwrap();
        safety.trials
    });
    assert_eq!(built, whole);
}

/// GOAL: a monitor where ground meets a dug slice follows the ground, wherever the corner lies in its cell.
/// CASE: the crest of a cut is a corner of the ground and of the slice that is dug.
/// ORACLE: it has a displacement to the end, that of a particle of the ground.
#[test]
fn a_monitor_at_a_corner_follows_what_stays() {
    for face in [6.0, 6.05, 6.1, 6.125, 6.2] {
        let text = format!(
            r#"
igimp = 1
[case]
title = "a cut"
[grid]
cell = "0.25 m"
domain = {{ x = ["4 m", "8 m"], y = ["0 m", "5 m"] }}
[materials.soil]
model = "elastic"
young = "20 MPa"
poisson = 0.3
unit_weight = "20 kN/m3"
[[bodies]]
name = "slice"
material = "soil"
polygon = [["{face} m","3 m"],["8 m","3 m"],["8 m","4 m"],["{face} m","4 m"]]
[[bodies]]
name = "ground"
material = "soil"
polygon = [["4 m","0 m"],["8 m","0 m"],["8 m","3 m"],["{face} m","3 m"],["{face} m","4 m"],["4 m","4 m"]]
[[stages]]
name = "rest"
type = "gravity"
steps = 1
[[stages]]
name = "dig"
type = "construction"
remove = ["slice"]
steps = 1
[[monitors]]
name = "crest"
point = ["{face} m", "4 m"]
record = ["displacement_y"]
[output]
figures = []
report = false
"#
        );
        let file = CaseFile::parse("cut.toml", &text, &[]).unwrap();
        let run = in_memory(file.case()).unwrap();
        let row = run.monitors[0].rows.last().unwrap();
        let crest = row[row.len() - 1];
        println!("face at {face}: {crest:e} m");
        assert!(crest.is_finite(), "{face}");
    }
}
