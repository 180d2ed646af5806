//! A slope that does not stand under its weight. Where nothing but searches follow, its factor of safety is still asked for: they
//! raise gravity anew on undeformed bodies, at strengths that hold them (theory, eqs. 31 to 34).

use igimp_model::{Case, ReductionPath, StageKind, StrengthReduction};
use igimp_results::ending::EndReason;
use igimp_results::summary::{SafetySummary, StageOutcome, StageSummary};
use igimp_text::short;

use super::loading::target;
use crate::run::session::Session;
use crate::run::state::State;

/// Whether a stage raises gravity and searches alone follow, so that want of equilibrium in it is an answer: F < 1.
/// Rigid bodies and reinforcement stand elsewhere on undeformed bodies: with them nothing is raised anew.
pub(crate) fn is_answered<const D: usize>(case: &Case<D>, number: usize) -> bool {
    let stages = &case.stages;
    let searches = |kind: &StageKind| matches!(kind, StageKind::StrengthReduction(_));
    matches!(stages[number].kind, StageKind::Gravity { .. })
        && case.rigid.is_empty()
        && stages.iter().all(|stage| stage.install.is_empty())
        && number + 1 < stages.len()
        && stages[number + 1..]
            .iter()
            .all(|stage| searches(&stage.kind))
}

/// What is said of it.
pub(crate) fn remark(summary: &StageSummary) -> String {
    format!(
        "the body does not stand under its weight: no equilibrium was found beyond {} % of the stage, and so F < 1 unless steps or \
         cells are too coarse; the factor of safety is searched for by raising gravity on undeformed bodies (path = \"gravity\")",
        short(100.0 * summary.reached)
    )
}

/// The search of a stage and the state that it begins with, where the stage before it fell.
pub(crate) fn anew<const D: usize>(
    session: &Session<'_, D>,
    number: usize,
    reduction: &StrengthReduction,
    state: &State<D>,
) -> Option<(StrengthReduction, State<D>)> {
    let case = session.model.case;
    let from = case.stages[number].start_from?;
    let before = session.summary.stages.get(from)?;
    let cause = String::new();
    let fell = EndReason::NoEquilibrium {
        beyond: None,
        cause,
    };
    let has_fallen = before.outcome == StageOutcome::Stopped && before.code == fell.code();
    (has_fallen && is_answered(case, from)).then(|| {
        let reduction = StrengthReduction {
            path: ReductionPath::Gravity,
            ..reduction.clone()
        };
        let controls = target(case, &case.stages[from], &state.controls);
        let body = state.body.clone();
        (reduction, State { body, controls })
    })
}

/// A remark where the search finds that the body stands after all.
pub(crate) fn stands_after_all(safety: &SafetySummary) -> Option<String> {
    let stable = safety.stable.filter(|&stable| stable >= 1.0)?;
    Some(format!(
        "with gravity raised anew the body stands at SRF {stable:.4}: the stage before failed for another reason than want of \
         strength, and more steps in it may find its equilibrium"
    ))
}
