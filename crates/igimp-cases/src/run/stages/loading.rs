//! Stages that move the controls from where they are to where the case wants them: gravity, loads,
//! settlement, level ground.

use std::sync::Arc;

use igimp_model::{Case, Dynamic, RigidDrive, Stage, StageKind};
use igimp_results::ending::EndReason;
use igimp_results::summary::StageSummary;
use igimp_solver::LastStep;

use super::{limit_load, rigid_begin};
use crate::error::CaseError;
use crate::run::output::moment::{AcceptedStep, Moment};
use crate::run::reinforcement;
use crate::run::resume::Resumption;
use crate::run::resume::last_step::SavedStep;
use crate::run::session::{Session, StageEnd, StagePath, march_path};
use crate::run::state::{Controls, State};
use crate::run::water::flow;

/// The controls at the end of a stage that begins with `start`.
pub(crate) fn target<const D: usize>(case: &Case<D>, stage: &Stage, start: &Controls) -> Controls {
    let mut end = start.clone();
    for &member in &stage.install {
        end.reinforcement[member].jack = case.reinforcement[member].prestress;
    }
    match &stage.kind {
        StageKind::Gravity {
            factor,
            horizontal,
            across,
            vertical,
        } => {
            end.gravity = *factor;
            let stated = [horizontal, across, vertical];
            for (value, stated) in end.acceleration.iter_mut().zip(stated) {
                *value = stated.unwrap_or(*value);
            }
        }
        StageKind::Load { loads, factor } => {
            for &load in loads {
                end.factors[load] = *factor;
            }
        }
        StageKind::Displacement { settlement, .. } => end.settlement += settlement,
        StageKind::Rigid(moves) | StageKind::Dynamic(Dynamic { bodies: moves, .. }) => {
            for motion in moves {
                let body = &mut end.rigid[motion.body];
                for (k, drive) in motion.drives.iter().enumerate() {
                    match drive {
                        Some(RigidDrive::By(by)) => body.moved[k] += by,
                        Some(RigidDrive::Force(force)) => body.loaded[k] = Some(*force),
                        None => {}
                    }
                }
            }
        }
        StageKind::Construction(works) => end.water = works.water.or(end.water),
        _ => {}
    }
    end.time += stage.consolidation.as_ref().map_or(0.0, |c| c.duration);
    end.drained =
        stage.drained || matches!(&stage.kind, StageKind::Construction(works) if works.dissipate);
    end
}

/// Marches a state to the end of a loading stage, or on from where an earlier run left it.
pub(crate) fn load<const D: usize>(
    session: &mut Session<'_, D>,
    state: &mut State<D>,
    number: usize,
    summary: &mut StageSummary,
    resumption: Option<&Resumption>,
) -> Result<StageEnd, CaseError> {
    release(session, state, (number, None), summary, resumption)
}

/// The same with forces by node that hold the body at first and are let go on the way \[N/m\].
pub(crate) fn release<const D: usize>(
    session: &mut Session<'_, D>,
    state: &mut State<D>,
    (number, held): (usize, Option<Arc<Vec<[f64; D]>>>),
    summary: &mut StageSummary,
    resumption: Option<&Resumption>,
) -> Result<StageEnd, CaseError> {
    let model = session.model;
    let stage = &model.case.stages[number];
    if let (StageKind::Rigid(moves), None) = (&stage.kind, resumption) {
        for text in rigid_begin::begin(model, state, stage, moves)? {
            session.warn(text);
        }
    }
    if resumption.is_none() {
        reinforcement::begin(model.case, state, stage);
        // What came before it may have changed the pressures at once.
        state.controls.last_step = 0.0;
    }
    let consolidation = stage.consolidation.as_ref();
    let from = resumption.map_or_else(|| state.controls.clone(), |left| left.from.clone());
    let to = target(model.case, stage, &from);
    let mut resistance = resumption.map_or(0.0, |left| left.resistance);
    if resumption.is_none() {
        begin(session, state, number)?;
    }
    let mut settings = model.march_settings(stage.steps);
    if let Some(consolidation) = consolidation {
        settings = flow::steps(model.case, consolidation, settings, model.smallest_side()?);
    }
    let seeks_limit = limit_load::is_sought(stage);
    // With water in its pores the work of loads is not that of effective stress.
    settings.is_short_of_mechanism = seeks_limit && !model.case.has_pore_water();
    let left_step = resumption.and_then(|left| left.last_step.as_ref());
    let mut last = left_step.map(SavedStep::step);
    let path = StagePath {
        flow: consolidation,
        held,
        left: resumption,
        ..StagePath::of_equilibria((&from, &to), model.method(stage.geometry), settings)
    };
    let ended = march_path(
        session,
        state,
        &path,
        summary,
        &mut |session, summary, taken| {
            session.record(&taken.moment(number, summary.steps))?;
            if seeks_limit {
                last = LastStep::of(taken.accepted.report, taken.accepted.forces);
            }
            let end = reason_to_stop(session, stage, resistance, taken);
            resistance = taken.resistance;
            let resumption = Resumption {
                resistance,
                end,
                last_step: last.as_ref().map(SavedStep::of),
                ..Resumption::of(&from, *taken.accepted.state)
            };
            if let Some(output) = &mut session.output {
                let run = &session.summary;
                output.after_step(number, model, summary, taken, &resumption, run)?;
            }
            Ok(resumption.end)
        },
    )?;
    match &ended {
        StageEnd::NotConverged(error) if seeks_limit && limit_load::begins(summary, error) => {
            limit_load::follow_on(session, state, (number, &from, &to), last, summary)
        }
        _ => Ok(ended),
    }
}

/// Records the state before a stage.
pub(crate) fn begin<const D: usize>(
    session: &mut Session<'_, D>,
    state: &State<D>,
    number: usize,
) -> Result<(), CaseError> {
    let grid = session.model.grid(session.model.lowered(&state.controls))?;
    session.record(&Moment {
        stage: number,
        number: 0,
        progress: 0.0,
        grid: &grid,
        particles: &state.body.particles,
        rigid: &state.body.rigid,
        reinforcement: &state.body.reinforcement,
        controls: &state.controls,
        resistance: 0.0,
        plastic_share: 0.0,
        energy: None,
    })
}

/// The condition of the case that ends the stage after a step, if one does.
pub(super) fn reason_to_stop<const D: usize>(
    session: &Session<'_, D>,
    stage: &Stage,
    resistance_before: f64,
    taken: &AcceptedStep<'_, D>,
) -> Option<EndReason> {
    let stop = &stage.stop_when;
    let particles = &taken.accepted.body.particles;
    if let Some(limit) = stop.displacement
        && session.displacement(stop.monitor, particles) > limit
    {
        let whose = session.whose_displacement(stop.monitor);
        return Some(EndReason::DisplacementExceeded { whose, limit });
    }
    if let Some(limit) = stop.load_grows_less_than {
        // A step that was cut may grow by its share of the limit.
        let report = taken.accepted.report;
        let share = (report.to - report.from) * stage.steps as f64;
        let growth = taken.resistance - resistance_before;
        if resistance_before > 0.0 && growth < limit * share * resistance_before {
            return Some(EndReason::ResistanceLevelsOff { growth: limit });
        }
    }
    None
}
