//! Bodies that do not stand under their weight, and the searches that answer it: F < 1.

use igimp_model::{Case, Stage, StageKind};
use igimp_results::ending::EndReason;
use igimp_results::summary::{StageOutcome, StageSummary};

/// Whether a stage raises gravity and a search comes back to its body, so that want of equilibrium in it is an answer: F < 1.
/// Rigid bodies and reinforcement stand elsewhere on undeformed bodies: with them nothing is raised anew.
pub(crate) fn is_answered<const D: usize>(case: &Case<D>, number: usize) -> bool {
    let stages = &case.stages;
    let is_search = |stage: &Stage| matches!(stage.kind, StageKind::StrengthReduction(_));
    // Where a limit is sought, other stages begin with the body at its limit.
    let is_sought = stages[number].stop_when.no_equilibrium;
    matches!(stages[number].kind, StageKind::Gravity { .. })
        && (!is_sought || stages[number + 1..].iter().all(is_search))
        && case.rigid.is_empty()
        && stages.iter().all(|stage| stage.install.is_empty())
        && (number + 1..stages.len()).any(|other| asks(case, number, other))
}

/// Whether a stage is a search for a body that another stage began, with what stages between add to its controls alone.
pub(crate) fn asks<const D: usize>(case: &Case<D>, of: usize, number: usize) -> bool {
    let is_search = matches!(case.stages[number].kind, StageKind::StrengthReduction(_));
    is_search && leads_back(case, of, number)
}

fn leads_back<const D: usize>(case: &Case<D>, of: usize, number: usize) -> bool {
    let adds_controls = |stage: usize| match &case.stages[stage].kind {
        StageKind::Load { .. } | StageKind::Gravity { .. } | StageKind::StrengthReduction(_) => {
            true
        }
        StageKind::Construction(works) => {
            works.place.is_empty() && works.remove.is_empty() && works.materials.is_empty()
        }
        _ => false,
    };
    let from = case.stages[number].start_from;
    from.is_some_and(|from| {
        from == of || from > of && adds_controls(from) && leads_back(case, of, from)
    })
}

/// Whether a stage begins, in the end, with the body of another one.
pub(crate) fn stands_on<const D: usize>(case: &Case<D>, of: usize, number: usize) -> bool {
    let from = case.stages[number].start_from;
    from.is_some_and(|from| from == of || from > of && stands_on(case, of, from))
}

/// The stage before whose body did not stand, and whose answer a search is.
pub(crate) fn answered<const D: usize>(
    case: &Case<D>,
    stages: &[StageSummary],
    number: usize,
) -> Option<usize> {
    (0..number.min(stages.len())).find(|&of| has_fallen(case, stages, of) && asks(case, of, number))
}

/// Whether a stage ended as its body did not stand, and searches answer that.
pub(crate) fn has_fallen<const D: usize>(
    case: &Case<D>,
    stages: &[StageSummary],
    number: usize,
) -> bool {
    let fell = EndReason::NoEquilibrium {
        beyond: None,
        cause: String::new(),
    };
    let is_stopped =
        |stage: &StageSummary| stage.outcome == StageOutcome::Stopped && stage.code == fell.code();
    stages.get(number).is_some_and(is_stopped) && is_answered(case, number)
}
