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

use igimp_assembly::{Geometry, Locking, Method};
use igimp_model::{Reduction, RunOut};
use igimp_results::summary::StageSummary;
use igimp_text::short;

use super::loading::begin;
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
    let case = model.case;
    let mut to = state.controls.clone();
    to.drained = case.stages[number].drained;
    let factor = match run_out.reduction {
        Reduction::Factor(factor) => factor,
        Reduction::TimesFos(times) => {
            let found = session.records.factor_of_safety;
            if !found.is_finite() {
                return Ok(StageEnd::Stopped(
                    "the factor of safety that the reduction refers to was not found".to_owned(),
                ));
            }
            times * found
        }
    };
    for &material in &run_out.materials {
        to.srf[material] = factor;
    }
    if resumption.is_none() {
        begin(session, state, number)?;
    }
    let steps = case.stages[number].steps;
    let cell = case.grid.smallest_cell();
    let target = run_out.move_per_step * cell.into_iter().fold(f64::INFINITY, f64::min);
    // The whole weight would move the body by the target.
    let largest = case.gravity / target;
    let drag = Cell::new(resumption.map_or(largest, |left| left.drag));
    let path = StagePath {
        from: &to,
        to: &to,
        drag: &|from, to| drag.get() / ((to - from) * steps as f64),
        method: flowing(session.model),
        settings: session.model.march_settings(steps),
        held: None,
        left: resumption,
    };
    let ended = march_path(
        session,
        state,
        &path,
        summary,
        &mut |session, summary, taken| {
            session.record(&taken.moment(number, summary.steps))?;
            let moved = taken
                .accepted
                .forces
                .u
                .iter()
                .map(|u| u.iter().fold(0.0_f64, |length, own| length.hypot(*own)))
                .fold(0.0, f64::max);
            let change = (moved / target).clamp(CHANGE[0], CHANGE[1]);
            drag.set((drag.get() * change).clamp(1e-9 * largest, largest));
            let share = taken.accepted.report.drag_share;
            let resumption = Resumption {
                from: to.clone(),
                march: *taken.accepted.state,
                resistance: taken.resistance,
                drag: drag.get(),
                end: (share < run_out.at_rest).then(|| at_rest(summary.steps, share)),
            };
            if let Some(output) = &mut session.output {
                let run = &session.summary;
                output.after_step(number, model, summary, taken, &resumption, run)?;
            }
            Ok(resumption.end)
        },
    )?;
    match ended {
        StageEnd::Stopped(rest) => stand(session, state, &path, summary, &rest),
        StageEnd::Completed(_) => {
            session.warn(format!(
                "the slope still moves after {steps} steps of run-out"
            ));
            Ok(StageEnd::Stopped(format!(
                "still moving after {steps} steps"
            )))
        }
        other => Ok(other),
    }
}

/// In words, when the slope came to rest.
fn at_rest(steps: usize, share: f64) -> String {
    let share = short(100.0 * share);
    format!("at rest after {steps} steps, when drag carried {share} % of the load")
}

/// The method of a body that flows: on its way cells are filled in part, and modes that a shared strain
/// does not see add up from step to step. There B-bar serves better.
fn flowing<const D: usize>(model: &Model<'_, D>) -> Method {
    let mut method = model.method(Geometry::Moving);
    if method.locking == Locking::SharedStrain {
        method.locking = Locking::BBar;
    }
    method
}

/// The last step, without drag: the slope has to be in equilibrium where it rests.
fn stand<const D: usize>(
    session: &mut Session<'_, D>,
    state: &mut State<D>,
    path: &StagePath<'_, D>,
    summary: &mut StageSummary,
    rest: &str,
) -> Result<StageEnd, CaseError> {
    let last = StagePath {
        drag: &|_, _| 0.0,
        method: flowing(session.model),
        settings: session.model.march_settings(1),
        held: None,
        left: None,
        ..*path
    };
    Ok(
        match march_path(session, state, &last, summary, &mut |_, _, _| Ok(None))? {
            StageEnd::NotConverged(_) => {
                session.warn(
                    "the slope all but rests, but no equilibrium without drag was found".into(),
                );
                StageEnd::Stopped(format!("{rest}; not in equilibrium without drag"))
            }
            StageEnd::Completed(_) => {
                StageEnd::Completed(format!("{rest}; then in equilibrium without drag"))
            }
            other => other,
        },
    )
}
