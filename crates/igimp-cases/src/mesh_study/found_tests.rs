use igimp_model::Case;
use igimp_model::check::{Band, Check};
use igimp_results::ending::{EndReason, PathEnd};
use igimp_results::mesh_study::{Convergence, Order};
use igimp_results::summary::{
    CheckRow, PathPoint, PathSummary, SafetySummary, StageOutcome, StageSummary, Standing, Summary,
};

use super::{check_rows, remarks, study};

/// A shipped case on two meshes.
fn case(name: &str, settings: &[&str]) -> Case<2> {
    let settings = settings.iter().copied().chain(["mesh_study.meshes=2"]);
    let settings: Vec<String> = settings.map(str::to_owned).collect();
    let shipped = igimp_input::shipped::find(name).unwrap();
    shipped.case_file(settings).unwrap().into_case()
}

/// A run whose last of two stages ended like that at a share of its way.
fn run(reached: f64, change: impl Fn(&mut StageSummary)) -> Summary {
    let first = StageSummary {
        reached: 1.0,
        ..StageSummary::default()
    };
    let mut last = StageSummary {
        outcome: StageOutcome::Stopped,
        reached,
        ..StageSummary::default()
    };
    change(&mut last);
    Summary {
        stages: vec![first, last],
        ..Summary::default()
    }
}

/// A path that ended like that at a factor.
fn path(end: PathEnd, factor: f64) -> PathSummary {
    let point = PathPoint {
        factor,
        ..PathPoint::default()
    };
    PathSummary {
        end,
        limit: (end != PathEnd::Lost).then_some(point),
        points: vec![point],
        ..PathSummary::default()
    }
}

/// GOAL: a load at which the march or its path was given up is told and not extrapolated; a limit is.
/// CASE: a vertical cut under a growing multiple of gravity.
#[test]
fn loads_that_ended_early_are_not_extrapolated() {
    let case = case("vertical_cut", &["checks=[]"]);
    let of = |end| {
        move |stage: &mut StageSummary| {
            stage.path = Some(path(end, 0.95));
            stage.lost = end == PathEnd::Lost;
        }
    };
    let limit = run(0.5, of(PathEnd::Limit));
    let lost = run(0.4, of(PathEnd::Lost));
    let results = study(&case, &[Some(&limit), Some(&limit)]);
    assert!(results[0].estimate.is_some() && remarks(&case, &results).is_empty());
    for early in [
        lost,
        run(0.4, |stage| stage.lost = true),
        run(1.0, |stage| stage.outcome = StageOutcome::Completed),
        run(0.4, |stage| stage.outcome = StageOutcome::NotConverged),
    ] {
        let results = study(&case, &[Some(&limit), Some(&early)]);
        assert!(results[0].ended_early(1) && !results[0].ended_early(0));
        assert_eq!(results[0].estimate, None);
        assert_eq!(
            results[0].finest(),
            results[0].values[0].map(|value| (0, value))
        );
        let warnings = remarks(&case, &results);
        assert_eq!(warnings.len(), 1);
        assert!(warnings[0].contains("on the mesh h/2"), "{}", warnings[0]);
    }
}

/// GOAL: so is a check whose stage was given up.
#[test]
fn a_check_of_a_stage_that_was_given_up_is_not_extrapolated() {
    let check = "checks=[{ name = \"N\", of = \"largest_displacement\", divide_by = [\"1 m\"], expected = 7.1, tolerance = 0.1, source = \"s\" }]";
    let case = case("vertical_cut", &[check]);
    let with_check = |measured: f64, outcome| {
        let mut run = run(0.4, |stage| stage.outcome = outcome);
        run.checks.push(CheckRow {
            check: Check {
                case: String::new(),
                variant: String::new(),
                quantity: "N".into(),
                expected: 7.1,
                source: String::new(),
                band: Band::Relative(0.1),
                measured,
                unit: None,
            },
            pass: false,
            standing: Standing::Held,
        });
        run
    };
    let of_check = |outcome| {
        let runs = [5.0, 4.8].map(|measured| with_check(measured, outcome));
        let results = study(&case, &[Some(&runs[0]), Some(&runs[1])]);
        results
            .into_iter()
            .find(|result| result.name == "N")
            .unwrap()
    };
    assert!(of_check(StageOutcome::Stopped).estimate.is_some());
    let early = of_check(StageOutcome::NotConverged);
    assert!(early.estimate.is_none() && early.values == [Some(5.0), Some(4.8)]);
}

/// A row of a check that is to be met within a tenth.
fn row(quantity: &str, expected: f64, measured: f64) -> CheckRow {
    let check = Check {
        case: String::new(),
        variant: String::new(),
        quantity: quantity.into(),
        expected,
        source: String::new(),
        band: Band::Relative(0.1),
        measured,
        unit: None,
    };
    CheckRow::held(check)
}

/// A run of the stages of a case, all but one of which came to their ends.
fn with_stage(case: &Case<2>, number: usize, stage: StageSummary) -> Summary {
    let done = StageSummary {
        reached: 1.0,
        ..StageSummary::default()
    };
    let mut stages = vec![done; case.stages.len()];
    stages[number] = stage;
    Summary {
        stages,
        ..Summary::default()
    }
}

/// GOAL: a footing that stopped on its way has no resistance: it is not extrapolated, and no check is held on it, however
/// well its value would meet the band.
/// CASE: a footing pushed by one width; on the finer mesh, or on both, the march ends at a tenth of it.
#[test]
fn a_push_that_stopped_on_its_way_is_held_in_no_check() {
    const CHECK: &str = "resistance N at one width";
    let case = case("footing_bonded", &["curves=[]"]);
    let push = |reached: f64, resistance: f64, outcome: StageOutcome, lost: bool| {
        let stage = StageSummary {
            outcome,
            lost,
            reached,
            peak_resistance: Some(1e3 * resistance),
            ..StageSummary::default()
        };
        let mut run = with_stage(&case, 0, stage);
        run.checks = vec![row(CHECK, 7.0, resistance)];
        run
    };
    let is_near = |a: f64, b: f64| (a - b).abs() < 1e-12;
    let whole = |resistance| push(1.0, resistance, StageOutcome::Completed, false);
    let held = |runs: [&Summary; 2]| {
        let results = study(&case, &runs.map(Some));
        let rows = check_rows(&case, runs[0], &results);
        let estimates = results.iter().filter(|r| r.estimate.is_some()).count();
        (estimates, rows[0].clone(), remarks(&case, &results).len())
    };
    let (estimates, held_on_fine, remarks) = held([&whole(7.4), &whole(7.2)]);
    assert_eq!((estimates, remarks), (2, 0));
    assert!(held_on_fine.pass && is_near(held_on_fine.check.measured, 7.2));
    assert_eq!(held_on_fine.check.variant, "");
    for early in [
        push(0.1, 7.0, StageOutcome::NotConverged, false),
        push(0.1, 7.0, StageOutcome::Stopped, true),
        push(0.1, 7.0, StageOutcome::Interrupted, false),
    ] {
        let (estimates, on_coarse, remarks) = held([&whole(7.4), &early]);
        assert_eq!((estimates, remarks), (0, 2));
        assert!(on_coarse.pass && is_near(on_coarse.check.measured, 7.4));
        assert_eq!(on_coarse.check.variant, "on the mesh h");
        let (estimates, on_none, remarks) = held([&early, &early]);
        assert_eq!((estimates, remarks), (0, 4));
        assert!(!on_none.pass && on_none.check.measured.is_nan());
    }
}

/// GOAL: a search that was given up leaves no interval, however narrow, and a run-out that still moves no place.
/// CASE: a slope whose weight, search or run-out goes wrong on the finer mesh.
#[test]
fn stages_that_were_given_up_and_those_that_stand_on_them_have_no_result() {
    let case = case("slope", &["curves=[]"]);
    let searched = StageSummary {
        safety: Some(SafetySummary {
            stable: Some(1.3),
            failed: Some(1.4),
            ..SafetySummary::default()
        }),
        ..StageSummary::default()
    };
    let run = |number: usize, change: &dyn Fn(&mut StageSummary)| {
        let mut run = with_stage(&case, 1, searched.clone());
        change(&mut run.stages[number]);
        run.checks = vec![row("factor of safety", 1.3, 1.35)];
        run
    };
    let whole = run(1, &|_| {});
    let is_extrapolated = |fine: &Summary| {
        let results = study(&case, &[Some(&whole), Some(fine)]);
        assert_eq!(results.len(), 2);
        let [search, check] = [0, 1].map(|number| results[number].estimate.is_some());
        assert_eq!(search, check);
        search
    };
    assert!(is_extrapolated(&whole));
    let unsolved = |stage: &mut StageSummary| stage.outcome = StageOutcome::NotConverged;
    assert!(!is_extrapolated(&run(1, &unsolved)));
    // The search begins with the weight; the run-out comes after it.
    assert!(!is_extrapolated(&run(0, &|stage| stage.lost = true)));
    // A body that fell under its weight has its factor from gravity raised anew.
    let fell = |stage: &mut StageSummary| {
        let cause = String::new();
        let beyond = Some(0.7);
        let reason = EndReason::NoEquilibrium { beyond, cause };
        (stage.outcome, stage.lost) = (StageOutcome::Stopped, true);
        reason.code().clone_into(&mut stage.code);
    };
    assert!(is_extrapolated(&run(0, &fell)));
    // What the search and its check tell alike is said once.
    let early = run(1, &unsolved);
    let mut same = early.clone();
    same.checks[0].check.measured = 1.3;
    let results = study(&case, &[Some(&whole), Some(&early)]);
    assert_eq!(remarks(&case, &results).len(), 2);
    let mut whole = whole.clone();
    whole.checks[0].check.measured = 1.35;
    let results = study(&case, &[Some(&whole), Some(&same)]);
    assert_eq!(remarks(&case, &results).len(), 1);
    let moving = EndReason::StillMoving { steps: 9 };
    let moves = |stage: &mut StageSummary| {
        stage.outcome = StageOutcome::Stopped;
        moving.code().clone_into(&mut stage.code);
    };
    assert!(is_extrapolated(&run(2, &moves)));
    let of_run_out = |change: &dyn Fn(&mut StageSummary)| {
        let mut run = run(2, change);
        run.checks = vec![row("run-out, end", 30.0, 29.0)];
        let results = study(&case, &[Some(&run), Some(&run)]);
        results[1].estimate.is_some()
    };
    assert!(of_run_out(&|_| {}) && !of_run_out(&moves));
}

/// GOAL: the case decides which orders are allowed for.
#[test]
fn the_case_decides_on_orders() {
    let slowest = |name: &str| {
        let case = case(name, &[]);
        let stage = case.stages.len() - 1;
        igimp_results::mesh_study::known::of_stage(&case, stage)
            .unwrap()
            .2
    };
    assert_eq!(slowest("vertical_cut"), Convergence::SOIL);
    assert_eq!(slowest("nailed_cut"), Convergence::CONTACT);
    assert_eq!(slowest("footing_bonded"), Convergence::FOOTING);
    assert!(Order::Rising.remark().is_some());
}
