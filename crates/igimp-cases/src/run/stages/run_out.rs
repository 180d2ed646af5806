//! Run-out: a slope whose strength is reduced beyond its factor of safety moves until it rests.
//!
//! Beyond collapse there is no equilibrium nearby to step to. Here every step balances the weight
//! with a drag proportional to the step's displacement (theory, eq. 38), so that the slope creeps
//! down the way that its strength allows and gains no speed. The drag is adapted so that the largest
//! displacement of a step stays about the same (eq. 39). The share of the external force that the
//! drag carries (eq. 40) tells how far from equilibrium the slope is; when it has all but vanished, a
//! last step without any drag has to find equilibrium. This is a mode for run-out alone, never for a
//! factor of safety.

use std::cell::Cell;

use igimp_assembly::{DomainUpdate, Geometry, Locking, Method};
use igimp_model::{Reduction, RunOut, StageKind, search_of};
use igimp_results::ending::EndReason;
use igimp_results::fields::length;
use igimp_results::summary::StageSummary;
use igimp_text::short;

use super::loading::{begin, reason_to_stop};
use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::resume::Resumption;
use crate::run::session::{Session, StageEnd, StagePath, march_path};
use crate::run::state::State;

/// Bounds of the change of drag from step to step \[-\].
const CHANGE: [f64; 2] = [0.25, 4.0];

/// Moves a state to rest, or as far as the steps of its stage allow.
pub(crate) fn run_out<const D: usize>(
    session: &mut Session<'_, D>,
    state: &mut State<D>,
    number: usize,
    run_out: &RunOut,
    summary: &mut StageSummary,
    resumption: Option<&Resumption>,
) -> Result<StageEnd, CaseError> {
    let model = session.model;
    let (case, stage) = (model.case, &model.case.stages[number]);
    let mut to = state.controls.clone();
    to.drained = stage.drained;
    let Some(factor) = divisor(session, number, &run_out.reduction) else {
        return Ok(StageEnd::Stopped(EndReason::NoFactorOfSafety));
    };
    for &material in &run_out.materials {
        to.srf[material] = factor;
    }
    if resumption.is_none() {
        begin(session, state, number)?;
    }
    let steps = stage.steps;
    let cell = case.grid.smallest_cell();
    let target = run_out.move_per_step * cell.into_iter().fold(f64::INFINITY, f64::min);
    // The whole weight would move the body by the target.
    let largest = case.gravity / target;
    let nodes = model.grid(model.lowered(&to))?.node_count();
    let drag = Cell::new(resumption.map_or(largest, |left| left.drag));
    let settings = model.march_settings(steps);
    let path = StagePath {
        drag: &|from, to| drag.get() / ((to - from) * steps as f64),
        left: resumption,
        ..StagePath::of_equilibria((&to, &to), flowing(model), settings)
    };
    let ended = march_path(
        session,
        state,
        &path,
        summary,
        &mut |session, summary, taken| {
            session.record(&taken.moment(number, summary.steps))?;
            let moved = largest_motion(&taken.accepted.forces.u, nodes);
            let change = (moved / target).clamp(CHANGE[0], CHANGE[1]);
            drag.set((drag.get() * change).clamp(1e-9 * largest, largest));
            let share = taken.accepted.report.drag_share;
            let at_rest = (share < run_out.at_rest).then_some(EndReason::AtRest {
                steps: summary.steps,
                drag_share: share,
                is_in_equilibrium: None,
            });
            let resumption = Resumption {
                resistance: taken.resistance,
                drag: drag.get(),
                end: at_rest.or_else(|| reason_to_stop(session, stage, 0.0, taken)),
                ..Resumption::of(&to, *taken.accepted.state)
            };
            if let Some(output) = &mut session.output {
                let run = &session.summary;
                output.after_step(number, model, summary, taken, &resumption, run)?;
            }
            Ok(resumption.end)
        },
    )?;
    match ended {
        StageEnd::Stopped(EndReason::AtRest {
            steps, drag_share, ..
        }) => stand(
            session,
            (number, state),
            &path,
            summary,
            (steps, drag_share),
        ),
        StageEnd::Completed(_) => {
            session.warn_of_stage(
                number,
                &format!("the slope still moves after {steps} steps of run-out"),
            );
            Ok(StageEnd::Stopped(EndReason::StillMoving { steps }))
        }
        other => Ok(other),
    }
}

/// What strength is divided by; none where the factor of safety that it refers to was not found.
pub(super) fn divisor<const D: usize>(
    session: &Session<'_, D>,
    number: usize,
    reduction: &Reduction,
) -> Option<f64> {
    match reduction {
        Reduction::Factor(factor) => Some(*factor),
        Reduction::TimesFos(times) => Some(times * factor_found(session, number)?.1),
    }
}

/// The search that a stage refers to, by number, and the middle of its interval.
fn factor_found<const D: usize>(session: &Session<'_, D>, number: usize) -> Option<(usize, f64)> {
    let stages = &session.model.case.stages;
    let is_search = |stage: usize| matches!(stages[stage].kind, StageKind::StrengthReduction(_));
    let search = search_of(number, &|stage| stages[stage].start_from, &is_search)?;
    let safety = session.summary.stages.get(search)?.safety.as_ref()?;
    Some((search, 0.5 * (safety.stable? + safety.failed?)))
}

/// By how much strength is divided in a stage, of what search it is a multiple, for the verdict; none where the case states it.
pub(crate) fn told<const D: usize>(session: &Session<'_, D>, number: usize) -> Option<String> {
    let stages = &session.model.case.stages;
    let times = match &stages[number].kind {
        StageKind::RunOut(own) => own.reduction,
        StageKind::Dynamic(own) => own.reduction.as_ref()?.1,
        _ => return None,
    };
    let (search, factor) = factor_found(session, number)?;
    match times {
        Reduction::Factor(_) => None,
        Reduction::TimesFos(times) => Some(format!(
            "strength over {}, {} times the {} of stage \"{}\"",
            short(times * factor),
            short(times),
            short(factor),
            stages[search].name
        )),
    }
}

/// The longest step displacement of the nodes of the grid \[m\]; what stands behind them for rigid bodies is none of it.
fn largest_motion<const D: usize>(u: &[[f64; D]], nodes: usize) -> f64 {
    let lengths = u.iter().take(nodes).map(length);
    lengths.fold(0.0, f64::max)
}

/// The method of a body that flows. On its way cells are filled in part, and modes that a shared strain does not see add up from
/// step to step: there B-bar serves better. Soil is sheared many times its height over a floor, and domains by U would grow across
/// the shear: they have the second moments of the deformed ones (theory, eq. 29).
pub(crate) fn flowing<const D: usize>(model: &Model<'_, D>) -> Method {
    let mut method = model.method(Geometry::Moving);
    if method.locking == Locking::SharedStrain {
        method.locking = Locking::BBar;
    }
    if method.domain_update == DomainUpdate::DiagonalU {
        method.domain_update = DomainUpdate::Moments;
    }
    method
}

/// The last step, without drag: the slope has to be in equilibrium where it rests.
fn stand<const D: usize>(
    session: &mut Session<'_, D>,
    (number, state): (usize, &mut State<D>),
    path: &StagePath<'_, D>,
    summary: &mut StageSummary,
    (steps, drag_share): (usize, f64),
) -> Result<StageEnd, CaseError> {
    let rest = |is_in_equilibrium| EndReason::AtRest {
        steps,
        drag_share,
        is_in_equilibrium: Some(is_in_equilibrium),
    };
    let model = session.model;
    let controls = (path.from, path.to);
    let last = StagePath::of_equilibria(controls, flowing(model), model.march_settings(1));
    let ended = march_path(
        session,
        state,
        &last,
        summary,
        &mut |session, summary, taken| {
            session.record(&taken.moment(number, summary.steps))?;
            if let Some(output) = &mut session.output {
                output.frame_of_step(number, model, summary, taken)?;
            }
            Ok(None)
        },
    )?;
    Ok(match ended {
        StageEnd::NotConverged(_) => {
            session.warn_of_stage(
                number,
                "the slope all but rests, but no equilibrium without drag was found",
            );
            StageEnd::Stopped(rest(false))
        }
        StageEnd::Completed(_) => StageEnd::Completed(rest(true)),
        other => other,
    })
}

#[cfg(test)]
mod tests {
    use super::largest_motion;

    /// GOAL: in space the vertical component counts, and the rotation of a rigid body does not.
    #[test]
    fn motion_has_all_components_of_the_grid_alone() {
        let u = [[0.0, 0.0, -3.0], [1.0, 2.0, 2.0], [0.0, 0.0, 50.0]];
        assert!((largest_motion(&u, 2) - 3.0).abs() < 1e-12);
        let plane = [[3.0, 4.0], [0.0, 6.0]];
        assert!((largest_motion(&plane, 1) - 5.0).abs() < 1e-12);
    }
}
