//! A slope that does not stand under its weight. Searches that follow still ask for its factor of safety: they raise gravity
//! anew on undeformed bodies, at strengths that hold them (theory, eqs. 31 to 34), with the loads, the water and the shares of
//! gravity of stages between. Other stages have no body to begin with.

use igimp_model::{Case, ReductionPath, StrengthReduction};
use igimp_results::ending::EndReason;
use igimp_results::summary::{SafetySummary, StageOutcome, StageSummary};
use igimp_text::short;

use super::loading::target;
use crate::fallen::{answered, asks, has_fallen, stands_on};
use crate::run::session::Session;
use crate::run::state::{Controls, State};

/// The summary of a stage that has no body to begin with, as that of a stage before did not stand.
pub(crate) fn passed_over<const D: usize>(
    session: &Session<'_, D>,
    number: usize,
) -> Option<StageSummary> {
    let (case, stages) = (session.model.case, &session.summary.stages);
    let fell =
        (0..number).find(|&of| has_fallen(case, stages, of) && stands_on(case, of, number))?;
    if asks(case, fell, number) {
        return None;
    }
    let cause = format!(
        "the body of stage \"{}\" does not stand under its weight",
        case.stages[fell].name
    );
    let beyond = None;
    let reason = EndReason::NoEquilibrium { beyond, cause };
    Some(StageSummary {
        name: case.stages[number].name.clone(),
        kind: case.stages[number].kind.name().to_owned(),
        outcome: StageOutcome::NotConverged,
        code: reason.code().to_owned(),
        reason: reason.to_string(),
        ..StageSummary::default()
    })
}

/// The remark on it.
pub(crate) fn remark(summary: &StageSummary) -> String {
    format!(
        "the body does not stand under its weight: no equilibrium was found beyond {} % of the stage, and so F < 1 unless steps or \
         cells are too coarse; the factor of safety is searched for by raising gravity on undeformed bodies (path = \"gravity\")",
        short(100.0 * summary.reached)
    )
}

/// The search of a stage and the state that it begins with, where the body that it asks for fell.
pub(crate) fn anew<const D: usize>(
    session: &Session<'_, D>,
    number: usize,
    reduction: &StrengthReduction,
    state: &State<D>,
) -> Option<(StrengthReduction, State<D>)> {
    let case = session.model.case;
    let of = answered(case, &session.summary.stages, number)?;
    let reduction = StrengthReduction {
        path: ReductionPath::Gravity,
        ..reduction.clone()
    };
    let controls = controls(case, of, case.stages[number].start_from?, &state.controls);
    let body = state.body.clone();
    Some((reduction, State { body, controls }))
}

/// The controls at the end of a stage that goes back to a body that fell, from those with which it did.
fn controls<const D: usize>(
    case: &Case<D>,
    of: usize,
    number: usize,
    fallen: &Controls,
) -> Controls {
    let stage = &case.stages[number];
    match stage.start_from {
        Some(from) if number > of => target(case, stage, &controls(case, of, from, fallen)),
        _ => target(case, stage, fallen),
    }
}

/// A remark where the search finds that the body stands after all.
pub(crate) fn stands_after_all(safety: &SafetySummary) -> Option<String> {
    let stable = safety.stable.filter(|&stable| stable >= 1.0)?;
    Some(format!(
        "with gravity raised anew the body stands at SRF {stable:.4}: the stage before failed for another reason than want of \
         strength, and more steps in it may find its equilibrium"
    ))
}
