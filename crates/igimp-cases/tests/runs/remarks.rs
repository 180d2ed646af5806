//! GOAL: misleading results have remarks: a slope that does not stand has its factor all the same, tension that carries, memory
//! that decides, a run-out whose last step is in its tables; each once, and with its stage.
//! CASE: slopes of some hundred particles, run in memory.
//! ORACLE: F of strengths times k is k times F; a cut-off takes away what tension carried; the state that a run ends with.

use igimp_cases::run::{Run, in_memory};
use igimp_input::CaseFile;
use igimp_results::ending::Ending;
use igimp_results::summary::{SafetySummary, StageOutcome};

/// A slope of 10 m at two to one above its toe, at strengths c [kPa] and tan φ, with overrides.
fn slope(cohesion: f64, tan_friction: f64, set: &[&str]) -> Run<2> {
    staged(cohesion, tan_friction, ["", ""], set)
}

/// The same with text before the search and behind it.
fn staged(cohesion: f64, tan_friction: f64, [between, behind]: [&str; 2], set: &[&str]) -> Run<2> {
    let friction = tan_friction.atan().to_degrees();
    let text = format!(
        r#"
igimp = 1
[case]
title = "slope"
gravity = "10 m/s2"
[grid]
cell = "1 m"
domain = {{ x = ["0 m", "40 m"], y = ["0 m", "16 m"] }}
[materials.soil]
model = "mohr-coulomb"
unit_weight = "20 kN/m3"
young = "100 MPa"
poisson = 0.3
cohesion = "{cohesion} kPa"
friction = "{friction} deg"
dilation = "0 deg"
[[bodies]]
name = "slope"
material = "soil"
points_per_cell = 4
polygon = [["0 m", "0 m"], ["40 m", "0 m"], ["40 m", "5 m"], ["25 m", "5 m"], ["20 m", "15 m"], ["0 m", "15 m"]]
[boundaries]
left = "roller"
right = "roller"
bottom = "fixed"
[[stages]]
name = "weight"
type = "gravity"
steps = 5
{between}
[[stages]]
name = "safety"
type = "strength-reduction"
{behind}
"#
    );
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    let file = CaseFile::parse("slope.toml", &text, &set).unwrap_or_else(|error| panic!("{error}"));
    in_memory(file.case()).unwrap()
}

fn safety(run: &Run<2>) -> &SafetySummary {
    let mut found = (run.summary.stages.iter()).filter_map(|stage| stage.safety.as_ref());
    found.next().unwrap()
}

/// Middle of the interval of a factor of safety.
fn factor(run: &Run<2>) -> f64 {
    let found = safety(run);
    0.5 * (found.stable.unwrap() + found.failed.unwrap())
}

fn warnings_with<'r>(run: &'r Run<2>, words: &str) -> Vec<&'r String> {
    let all = run.summary.warnings.iter();
    all.filter(|text| text.contains(words)).collect()
}

#[test]
fn a_slope_that_does_not_stand_has_its_factor_all_the_same() {
    let tan = 20.0_f64.to_radians().tan();
    let stands = slope(20.0, 2.0 * tan, &[]);
    assert_eq!(stands.summary.stages[0].outcome, StageOutcome::Completed);
    let falls = slope(10.0, tan, &[]);
    let weight = &falls.summary.stages[0];
    assert_eq!(
        (weight.outcome, &weight.code[..]),
        (StageOutcome::Stopped, "no-equilibrium")
    );
    assert!(falls.failure.is_none());
    assert_eq!(falls.summary.ending(), Ending::Done);
    // The one by reducing the strength of what stands, the other by raising gravity on what does not.
    let (half, whole) = (factor(&falls), factor(&stands));
    assert!(half < 1.0 && whole > 1.0);
    assert!((2.0 * half / whole - 1.0).abs() < 0.02, "{half} {whole}");
    let warnings = warnings_with(&falls, "does not stand under its weight");
    assert_eq!(warnings.len(), 1);
    assert!(
        warnings[0].starts_with("stage \"weight\": "),
        "{warnings:?}"
    );
    assert!(warnings_with(&stands, "does not stand").is_empty());
}

/// A load between the weight and the search is raised with gravity anew; other stages on the body that fell are not run.
#[test]
fn a_factor_below_one_is_found_whatever_stands_around() {
    let load = "[[loads]]\nname = \"q\"\ntype = \"pressure\"\nfrom = [\"5 m\", \"15 m\"]\nto = [\"15 m\", \"15 m\"]\n\
                pressure = \"10 kPa\"\n[[stages]]\nname = \"q\"\ntype = \"load\"\nload = \"q\"\n";
    let shaken = "[[stages]]\nname = \"shaken\"\ntype = \"gravity\"\nhorizontal = 0.05\n";
    let wet = "[[water]]\nname = \"dry\"\ndry = true\n[[water]]\nname = \"wet\"\nr_u = 0.1\n\
               [[stages]]\nname = \"wet\"\ntype = \"construction\"\nwater = \"wet\"\n";
    let tan = 20.0_f64.to_radians().tan();
    for between in [load, shaken, wet] {
        let falls = staged(10.0, tan, [between, ""], &[]);
        let stands = staged(25.0, 2.5 * tan, [between, ""], &[]);
        assert!(stands.failure.is_none() && stands.summary.ending() == Ending::Done);
        let (low, high) = (factor(&falls), factor(&stands));
        assert!(low < 1.0, "{low}");
        assert!(
            (2.5 * low / high - 1.0).abs() < 0.02,
            "{between}: {low} {high}"
        );
        let outcomes: Vec<_> = falls
            .summary
            .stages
            .iter()
            .map(|stage| stage.outcome)
            .collect();
        let expected = [
            StageOutcome::Stopped,
            StageOutcome::NotConverged,
            StageOutcome::Completed,
        ];
        assert_eq!(outcomes, expected);
        assert_eq!(falls.summary.ending(), Ending::NotConverged);
    }
    let run_out = "[[stages]]\nname = \"run-out\"\ntype = \"run-out\"\nstart_from = \"weight\"\nreduction = { factor = 1.5 }\n\
                   [[checks]]\nname = \"F\"\nof = \"factor_of_safety\"\nstage = \"safety\"\nat_least = 0.5\nsource = \"none\"\n";
    let run = staged(10.0, tan, ["", run_out], &[]);
    let check = &run.summary.checks[0];
    assert!(check.pass && (check.check.measured - factor(&run)).abs() < 1e-12);
    assert_eq!(run.summary.ending(), Ending::NotConverged);
    let last = &run.summary.stages[2];
    assert!(
        last.reason
            .contains("the body of stage \"weight\" does not stand under its weight"),
        "{}",
        last.reason
    );
    let message = run.summary.failure.as_ref().unwrap();
    assert!(
        message.starts_with("stage \"run-out\": no equilibrium"),
        "{message}"
    );
}

#[test]
fn a_slope_that_falls_before_other_stages_ends_the_run() {
    let load = "stages.safety.type=run-out";
    let more = ["stages.safety.reduction.factor=1.5", load];
    let falls = slope(10.0, 20.0_f64.to_radians().tan(), &[load, more[0]]);
    assert_eq!(falls.summary.ending(), Ending::NotConverged);
    assert!(falls.failure.is_some());
}

#[test]
fn tension_that_carries_has_a_remark() {
    let tan = 20.0_f64.to_radians().tan();
    let pulled = slope(60.0, tan, &[]);
    let cracked = slope(60.0, tan, &["materials.soil.tension_cutoff=0 kPa"]);
    let (with, without) = (factor(&pulled), factor(&cracked));
    assert!(with > 1.02 * without, "{with} {without}");
    let warnings = warnings_with(&pulled, "carries tension");
    assert_eq!(warnings.len(), 1, "{:?}", pulled.summary.warnings);
    assert!(
        warnings[0].starts_with("stage \"safety\": "),
        "{warnings:?}"
    );
    assert!(warnings_with(&cracked, "carries tension").is_empty());
}

#[test]
fn remarks_name_their_stage_and_stand_once() {
    let tan = 20.0_f64.to_radians().tan();
    for search in ["continuation", "trials"] {
        let run = slope(10.0, tan, &[&format!("stages.safety.search={search}")]);
        let all = &run.summary.warnings;
        assert!(all.len() > 1);
        for (number, text) in all.iter().enumerate() {
            assert!(text.starts_with("stage \""), "{text}");
            assert!(!all[..number].contains(text), "twice: {text}");
        }
        assert!(safety(&run).moving_mass.is_some_and(|share| share > 0.0));
    }
}

// CASE: the shipped block that slumps, on cells of half a metre.
// ORACLE: as many rows as steps, and one for the undeformed state; the last one has the height that the check reads in the end.
#[test]
fn a_run_out_records_its_last_step() {
    let shipped = igimp_input::shipped::find("block").unwrap();
    let file = shipped
        .case_file(["grid.cell=0.5 m", "bodies.block.points_per_cell=4"])
        .unwrap();
    let run = in_memory(file.case()).unwrap();
    let slump = &run.summary.stages[1];
    assert!(
        slump.reason.contains("equilibrium without drag"),
        "{}",
        slump.reason
    );
    let steps: usize = run.summary.stages.iter().map(|stage| stage.steps).sum();
    let top = &run.monitors[0];
    assert_eq!(top.rows.len(), steps + 1, "{:?}", top.header);
    let column = top
        .header
        .iter()
        .position(|name| name.starts_with("y_"))
        .unwrap();
    let recorded = top.rows[top.rows.len() - 1][column];
    let at_rest = run.summary.checks[0].check.measured;
    assert!((recorded - at_rest).abs() < 1e-12, "{recorded} {at_rest}");
}

/// GOAL: where factors have no room it is told how many computers have it, and nothing where they have.
/// ORACLE: by hand, the memory of several over what is allowed on one.
#[test]
fn computers_with_room_for_factors_are_counted() {
    let on_several = |memory: &str| {
        let set = [format!("solver.memory={memory}")];
        let file = igimp_input::shipped::find("landslide_3d").unwrap();
        let file = file.case_file(set).unwrap();
        igimp_estimate::estimate(file.case_in_space())
            .unwrap()
            .systems
            .on_several
    };
    assert_eq!(on_several("4 GiB"), None);
    let (bytes, computers) = on_several("1 MiB").unwrap();
    let exact = bytes / 1_048_576.0;
    assert!(exact > 2.0 && (exact..exact + 1.0).contains(&(computers as f64)));
}

// CASE: the weight of the shipped slope in space, with room for factors, with none by the case, and with none by the machine.
// ORACLE: equilibrium, which no solver changes beyond the tolerance; the choice of the solver as the record of its stage has it.
#[test]
fn memory_that_decides_on_the_solver_has_a_remark() {
    let run = |memory: &str| -> Run<3> {
        let set = [format!("solver.memory={memory}")];
        let file = igimp_input::shipped::find("landslide_3d")
            .unwrap()
            .case_file(set)
            .unwrap();
        let mut case = file.case_in_space().clone();
        case.stages.truncate(1);
        in_memory(&case).unwrap()
    };
    let [roomy, stated, of_machine] = ["4 GiB", "1 MiB", "0.001 %"].map(run);
    let reason = |run: &Run<3>| {
        run.summary.stages[0]
            .linear
            .as_ref()
            .unwrap()
            .reason
            .clone()
    };
    assert!(!reason(&roomy).contains("allowed"), "{}", reason(&roomy));
    assert!(
        reason(&stated).ends_with("are allowed (by solver.memory)"),
        "{}",
        reason(&stated)
    );
    assert!(
        reason(&of_machine).contains("(by solver.memory 0.001 % of "),
        "{}",
        reason(&of_machine)
    );
    let count = |run: &Run<3>| {
        let warnings = run.summary.warnings.iter();
        warnings
            .filter(|text| text.contains("the memory for factors"))
            .count()
    };
    assert_eq!(
        [count(&roomy), count(&stated), count(&of_machine)],
        [0, 0, 1]
    );
    let moved = |run: &Run<3>| run.summary.stages[0].largest_displacement;
    assert!(
        (moved(&stated) / moved(&roomy) - 1.0).abs() < 1e-4,
        "{} {}",
        moved(&stated),
        moved(&roomy)
    );
}

/// GOAL: a search along the path of equilibria says that hardly any of the mass moves. CASE: a step of 1 m in a wide field of clay.
/// ORACLE: the same of a field that is hardly wider than its step has no such remark.
#[test]
fn a_small_step_in_a_wide_field_may_fail_alone() {
    let is_local = |width: f64| {
        let text = format!(
            r#"
igimp = 1
[case]
title = "step"
[grid]
cell = "0.5 m"
domain = {{ x = ["0 m", "{width} m"], y = ["0 m", "5 m"] }}
[materials.clay]
model = "tresca"
unit_weight = "20 kN/m3"
young = "20 MPa"
poisson = 0.49
cu = "8 kPa"
[[bodies]]
name = "field"
material = "clay"
polygon = [["0 m", "0 m"], ["{width} m", "0 m"], ["{width} m", "3 m"], ["3 m", "3 m"], ["3 m", "4 m"], ["0 m", "4 m"]]
[[stages]]
name = "weight"
type = "gravity"
[[stages]]
name = "safety"
type = "strength-reduction"
"#
        );
        let file =
            CaseFile::parse("step.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let run = in_memory(file.case()).unwrap();
        let share = safety(&run).moving_mass.unwrap();
        let warned = !warnings_with(&run, "may be a local failure").is_empty();
        println!("{width} m: {share}, {warned}");
        assert_eq!(warned, share < 0.02);
        warned
    };
    assert!(is_local(80.0));
    assert!(!is_local(5.0));
}
