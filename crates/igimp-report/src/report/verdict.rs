//! The outcome of a run in a few sentences.

use std::fmt::Write as _;

use igimp_results::ending::EndReason;
use igimp_results::summary::{
    CheckRow, Kinematic, NEEDLESS, PathPoint, PathSummary, SafetySummary, StageOutcome,
    StageSummary, StrengthShares, Summary,
};
use igimp_text::short;
use serde::Serialize;

use crate::report::numbers::{interval, percent};

/// The first thing that a reader sees.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Verdict {
    /// `good`, `fair` or `bad`.
    pub(super) class: &'static str,
    pub(super) word: &'static str,
    pub text: String,
}

/// The verdict on a run: its ending, its checks, and the factor of safety.
pub(super) fn verdict(summary: &Summary) -> Verdict {
    let missed: Vec<&CheckRow> = summary.checks.iter().filter(|row| !row.pass).collect();
    let failed = |stage: &&StageSummary| stage.outcome == StageOutcome::NotConverged;
    let (class, word) = if summary.stages.iter().any(|stage| failed(&stage)) {
        ("bad", "Not converged")
    } else if is_interrupted(summary) {
        ("fair", "Interrupted")
    } else if !missed.is_empty() {
        ("bad", "Reference missed")
    } else if summary.stages.is_empty() {
        ("fair", "Nothing ran")
    } else if summary.stages.iter().any(still_moves) {
        ("fair", "Still moving")
    } else {
        ("good", "Done")
    };
    let mut sentences = vec![ending(summary)];
    sentences.extend(on_checks(summary, &missed));
    let searches = || summary.stages.iter().filter(|stage| stage.safety.is_some());
    for stage in searches() {
        if let Some(safety) = &stage.safety {
            let mut lines = on_safety(safety);
            if let (Some(first), true) = (lines.first_mut(), searches().count() > 1) {
                *first = format!("Stage “{}”: {first}", stage.name);
            }
            sentences.extend(lines);
        }
    }
    Verdict {
        class,
        word,
        text: sentences.join(" "),
    }
}

/// Whether a run-out did not come to rest within its steps.
fn still_moves(stage: &StageSummary) -> bool {
    let steps = stage.steps;
    stage.code == EndReason::StillMoving { steps }.code()
}

fn is_interrupted(summary: &Summary) -> bool {
    let interrupted = |stage: &StageSummary| stage.outcome == StageOutcome::Interrupted;
    summary.interrupted || summary.stages.iter().any(interrupted)
}

/// How the stages ended.
fn ending(summary: &Summary) -> String {
    let with = |outcome| summary.stages.iter().find(|stage| stage.outcome == outcome);
    if let Some(stage) = with(StageOutcome::NotConverged) {
        return format!(
            "Stage “{}” found no equilibrium beyond {} of its way{}. What was computed until then \
             is kept.",
            stage.name,
            percent(stage.reached),
            because(&stage.reason)
        );
    }
    if let Some(stage) = with(StageOutcome::Interrupted) {
        return format!(
            "The run was interrupted in stage “{}” at {} of its way; it can be resumed.",
            stage.name,
            percent(stage.reached)
        );
    }
    if summary.interrupted {
        let after = match summary.stages.last() {
            Some(stage) => format!(" after stage “{}”", stage.name),
            None => String::new(),
        };
        return format!("The run has not come to its end{after}; it can be resumed.");
    }
    let whole = match summary.stages.len() {
        0 => return "No stage was run.".to_owned(),
        1 => format!("Stage “{}” was completed.", summary.stages[0].name),
        count => format!("All {count} stages were completed."),
    };
    if let Some(stage) = summary.stages.iter().find(|stage| still_moves(stage)) {
        return format!(
            "Stage “{}” did not come to rest{}. More steps tell where it does.",
            stage.name,
            because(&stage.reason)
        );
    }
    match with(StageOutcome::Stopped) {
        None => whole,
        Some(stage) => format!(
            "{whole} Stage “{}” was ended by its own condition at {} of its way{}.",
            stage.name,
            percent(stage.reached),
            because(&stage.reason)
        ),
    }
}

/// A reason after a colon, without its full stop.
fn because(reason: &str) -> String {
    match reason.trim().trim_end_matches('.') {
        "" => String::new(),
        reason => format!(": {reason}"),
    }
}

fn on_checks(summary: &Summary, unmet: &[&CheckRow]) -> Option<String> {
    let count = summary.checks.len();
    let (missed, beyond): (Vec<&CheckRow>, Vec<&CheckRow>) =
        unmet.iter().partition(|row| row.is_reached());
    let (missed, beyond) = (on_missed(count, &missed), on_unreached(count, &beyond));
    let parts: Vec<String> = [missed, beyond].into_iter().flatten().collect();
    match (parts.is_empty(), count) {
        (false, _) => Some(parts.join(" ")),
        (true, 0) => None,
        (true, 1) => Some("The one check holds.".to_owned()),
        (true, _) => Some(format!("All {count} checks hold.")),
    }
}

/// The checks whose stages did not come to their end.
fn on_unreached(count: usize, rows: &[&CheckRow]) -> Option<String> {
    let first = &rows.first()?.check.quantity;
    let verb = if rows.len() == 1 { "was" } else { "were" };
    Some(format!(
        "{} of {count} checks {verb} not reached: {first}{}.",
        rows.len(),
        and_others(rows.len() - 1)
    ))
}

fn on_missed(count: usize, rows: &[&CheckRow]) -> Option<String> {
    let first = rows.first()?;
    let check = &first.check;
    Some(format!(
        "{} of {count} checks {}: {} is {}, expected {} ({}){}.",
        rows.len(),
        if rows.len() == 1 { "fails" } else { "fail" },
        check.quantity,
        first.measured(),
        check.printed(check.expected),
        check.printed_band(),
        and_others(rows.len() - 1)
    ))
}

fn and_others(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => ", and another one".to_owned(),
        more => format!(", and {more} others"),
    }
}

/// The factor of safety with its remarks.
pub(super) fn on_safety(safety: &SafetySummary) -> Vec<String> {
    if safety.needs_no_strength() {
        let words = "Nothing of this ground can fail: its strength is not needed";
        return vec![format!("{words}, and F is above {NEEDLESS}.")];
    }
    let mut sentences = vec![format!("{}.", interval(safety))];
    let criterion = safety.criterion.trim().trim_end_matches('.');
    if !criterion.is_empty() {
        sentences.push(format!("Counted as failure: {criterion}."));
    }
    if let Some(path) = &safety.path {
        sentences.extend(on_path(path));
    }
    if !safety.materials.is_empty() {
        let not = if safety.excluded.is_empty() {
            String::new()
        } else {
            format!(", not in {}", list(&safety.excluded))
        };
        let materials = list(&safety.materials);
        sentences.push(format!("Strength was reduced in {materials}{not}."));
    }
    if let Some(share) = safety.moving_mass {
        let local = if safety.may_be_local() {
            ": so little may be a local failure; exclude its material to find the global one"
        } else {
            ""
        };
        let state = if safety.path.is_some() {
            "By the end of the path"
        } else {
            "In the first unstable state"
        };
        sentences.push(format!(
            "{state} {} of the mass moves by more than a tenth of the largest displacement{local}.",
            percent(share)
        ));
    }
    sentences
}

/// Knee, mechanism and displacement scale of a path.
fn on_path(path: &PathSummary) -> Option<String> {
    let at = |point: &PathPoint| format!("{:.3} at {} m", point.factor, short(point.displacement));
    let (knee, mechanism) = (path.knee.as_ref()?, path.mechanism.as_ref()?);
    let scale = path.displacement_scale?;
    Some(format!(
        "The path of equilibria has its knee at {} and is a mechanism from {} on; it ended because {}. The displacement \
         scale γH²/E is {} m.{}",
        at(knee),
        at(mechanism),
        path.end.sentence(),
        short(scale),
        path.shares.as_ref().map_or_else(String::new, on_shares)
    ))
}

/// The shares that decide the factor: reinforcement, and the kinematic theorem.
fn on_shares(shares: &StrengthShares) -> String {
    let mut text = String::new();
    if shares.reinforcement > 0.0 {
        let share = percent(shares.reinforcement);
        let _ = write!(
            text,
            " Of the last step {share} is dissipated in reinforcement."
        );
    }
    if let Some(Kinematic { factor, missed }) = shares.kinematic {
        let _ = write!(
            text,
            " By the kinematic theorem its displacements give {factor:.4}, in doubt by {} for the volume that they miss.",
            percent(missed)
        );
    }
    text
}

/// "a", "a and b", "a, b and c".
fn list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [some @ .., last] => format!("{} and {last}", some.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use igimp_model::check::{Band, Check};

    use super::*;

    // GOAL: several factors of safety differ by their stages, and one alone needs no name.
    // ORACLE: by hand.
    #[test]
    fn several_factors_name_their_stages() {
        let stage = |name: &str, stable: f64| StageSummary {
            name: name.to_owned(),
            safety: Some(SafetySummary {
                stable: Some(stable),
                failed: Some(stable + 0.01),
                ..SafetySummary::default()
            }),
            ..StageSummary::default()
        };
        let text = |stages: Vec<StageSummary>| {
            let summary = Summary {
                stages,
                ..Summary::default()
            };
            verdict(&summary).text
        };
        let both = text(vec![stage("dry", 1.5), stage("full pool", 1.2)]);
        for (name, factor) in [("dry", "1.5"), ("full pool", "1.2")] {
            let expected = format!("Stage “{name}”: The factor of safety lies between {factor}");
            assert!(both.contains(&expected), "{both}");
        }
        let one = text(vec![stage("dry", 1.5)]);
        assert!(!one.contains("Stage “dry”: The"), "{one}");
        let level = text(vec![stage("level ground", 1.668e8)]);
        assert!(
            level.contains("its strength is not needed, and F is above 1000"),
            "{level}"
        );
    }

    // GOAL: a run-out that still moves is no run that is done, and the sentence says so. ORACLE: by hand.
    #[test]
    fn a_run_out_that_still_moves_is_not_done() {
        let reason = EndReason::StillMoving { steps: 2 };
        let stage = StageSummary {
            name: "run-out".to_owned(),
            outcome: StageOutcome::Stopped,
            code: reason.code().to_owned(),
            reason: reason.to_string(),
            reached: 1.0,
            steps: 2,
            ..StageSummary::default()
        };
        let found = verdict(&Summary {
            stages: vec![stage],
            ..Summary::default()
        });
        assert_eq!((found.class, found.word), ("fair", "Still moving"));
        let sentence = "Stage “run-out” did not come to rest: still moving after 2 steps.";
        assert!(found.text.starts_with(sentence), "{}", found.text);
    }

    // GOAL: a check that was not reached is named as that, and not as one that holds. ORACLE: by hand.
    #[test]
    fn a_check_that_was_not_reached_is_named() {
        let check = Check {
            case: String::new(),
            variant: String::new(),
            quantity: "settlement".to_owned(),
            expected: 0.06,
            source: String::new(),
            band: Band::AtMost(0.06),
            measured: 0.054,
            unit: None,
        };
        let found = verdict(&Summary {
            stages: vec![StageSummary::default()],
            checks: vec![CheckRow::held(check.clone()), CheckRow::not_reached(check)],
            ..Summary::default()
        });
        let sentence = "1 of 2 checks was not reached: settlement.";
        assert!(found.text.contains(sentence), "{}", found.text);
    }
}
