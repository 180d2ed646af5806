use igimp_model::Case;
use igimp_model::check::{Band, Check};
use igimp_results::ending::PathEnd;
use igimp_results::mesh_study::{Convergence, Order};
use igimp_results::summary::{
    CheckRow, PathPoint, PathSummary, StageOutcome, StageSummary, Summary,
};

use super::{remarks, study};

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
fn what_ended_early_is_not_extrapolated() {
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
        assert_eq!(results[0].finest(), results[0].values[0]);
        let told = remarks(&case, &results);
        assert_eq!(told.len(), 1);
        assert!(told[0].contains("on the mesh h/2"), "{}", told[0]);
    }
}

/// GOAL: so is a check whose stage was given up.
#[test]
fn a_check_of_a_stage_that_was_given_up_is_not_extrapolated() {
    let check = "checks=[{ name = \"N\", of = \"largest_displacement\", expected = 7.1, tolerance = 0.1, source = \"s\" }]";
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
            },
            pass: false,
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

/// GOAL: what is in the case decides which orders are allowed for.
#[test]
fn what_is_in_the_case_decides() {
    let slowest = |name: &str| {
        let case = case(name, &[]);
        let stage = case.stages.len() - 1;
        super::known::of_stage(&case, stage).unwrap().2
    };
    assert_eq!(slowest("vertical_cut"), Convergence::SOIL);
    assert_eq!(slowest("nailed_cut"), Convergence::CONTACT);
    assert_eq!(slowest("footing_bonded"), Convergence::FOOTING);
    assert!(Order::Rising.remark().is_some());
}
