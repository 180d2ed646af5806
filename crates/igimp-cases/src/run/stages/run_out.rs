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
use igimp_solver::MarchSettings;
use igimp_text::short;

use super::loading::{begin, reason_to_stop};
use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::output::moment::AcceptedStep;
use crate::run::resume::Resumption;
use crate::run::session::{Session, StageEnd, StagePath, march_path};
use crate::run::state::{Controls, State};

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
    let stage = &model.case.stages[number];
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
    let creep = Creep::new(model, number, run_out, to)?;
    let mut left = resumption.cloned();
    loop {
        let mut last = None;
        let ended = creep.go_on(session, state, summary, (left.as_ref(), &mut last))?;
        let StageEnd::Stopped(EndReason::AtRest {
            steps, drag_share, ..
        }) = ended
        else {
            return Ok(ended);
        };
        let at = last.or(left);
        let rest = |is_in_equilibrium| EndReason::AtRest {
            steps,
            drag_share,
            is_in_equilibrium: Some(is_in_equilibrium),
        };
        match creep.stand(session, state, summary)? {
            StageEnd::NotConverged(_) => {}
            StageEnd::Completed(_) => return Ok(StageEnd::Completed(rest(true))),
            other => return Ok(other),
        }
        // What does not stand yet creeps on, as far as steps go.
        if let Some(at) = at.filter(|at| at.march.at < 1.0) {
            left = Some(Resumption { end: None, ..at });
        } else {
            session.warn_of_stage(
                number,
                "the slope all but rests, but no equilibrium without drag was found",
            );
            return Ok(StageEnd::Stopped(rest(false)));
        }
    }
}

/// The motion of a stage against drag.
struct Creep<'a> {
    number: usize,
    run_out: &'a RunOut,
    /// Controls of the stage.
    to: Controls,
    /// Number of steps when none is cut.
    steps: usize,
    /// Nodes of the grid.
    nodes: usize,
    /// The way of a node in a step that is aimed at \[m\].
    target: f64,
    /// The drag of the first step \[1/s²\].
    largest: f64,
}

impl<'a> Creep<'a> {
    fn new<const D: usize>(
        model: &Model<'_, D>,
        number: usize,
        run_out: &'a RunOut,
        to: Controls,
    ) -> Result<Self, CaseError> {
        let case = model.case;
        let cell = case.grid.smallest_cell();
        let target = run_out.move_per_step * cell.into_iter().fold(f64::INFINITY, f64::min);
        Ok(Self {
            number,
            run_out,
            steps: case.stages[number].steps,
            nodes: model.grid(model.lowered(&to))?.node_count(),
            to,
            target,
            // The whole weight would move the body by the target.
            largest: case.gravity / target,
        })
    }

    /// Creeps on from where the march was left, if it was, until the slope all but rests; `last` is where the march stands then.
    fn go_on<const D: usize>(
        &self,
        session: &mut Session<'_, D>,
        state: &mut State<D>,
        summary: &mut StageSummary,
        (left, last): (Option<&Resumption>, &mut Option<Resumption>),
    ) -> Result<StageEnd, CaseError> {
        let model = session.model;
        let (to, steps) = (&self.to, self.steps);
        let drag = Cell::new(left.map_or(self.largest, |left| left.drag));
        let path = StagePath {
            drag: &|from, to| drag.get() / ((to - from) * steps as f64),
            left,
            ..StagePath::of_equilibria((to, to), flowing(model), marching(model, steps))
        };
        let ended = march_path(
            session,
            state,
            &path,
            summary,
            &mut |session, summary, taken| {
                drag.set(self.drag_after(drag.get(), taken));
                let resumption = self.after_step(session, summary, taken, drag.get())?;
                Ok(last.insert(resumption).end.clone())
            },
        )?;
        let StageEnd::Completed(_) = ended else {
            return Ok(ended);
        };
        session.warn_of_stage(
            self.number,
            &format!("the slope still moves after {steps} steps of run-out"),
        );
        Ok(StageEnd::Stopped(EndReason::StillMoving { steps }))
    }

    /// The drag of the step after one with a drag \[1/s²\] (theory, eq. 39).
    fn drag_after<const D: usize>(&self, drag: f64, taken: &AcceptedStep<'_, D>) -> f64 {
        let moved = largest_motion(&taken.accepted.forces.u, self.nodes);
        let report = taken.accepted.report;
        let share = (report.to - report.from) * self.steps as f64;
        (drag * change_of_drag(moved / self.target, share)).clamp(1e-9 * self.largest, self.largest)
    }

    /// Records a step; where the march stands with it, and why it ends there, if it does.
    fn after_step<const D: usize>(
        &self,
        session: &mut Session<'_, D>,
        summary: &StageSummary,
        taken: &AcceptedStep<'_, D>,
        drag: f64,
    ) -> Result<Resumption, CaseError> {
        let (model, number) = (session.model, self.number);
        session.record(&taken.moment(number, summary.steps))?;
        let share = taken.accepted.report.drag_share;
        let at_rest = (share < self.run_out.at_rest).then_some(EndReason::AtRest {
            steps: summary.steps,
            drag_share: share,
            is_in_equilibrium: None,
        });
        let stage = &model.case.stages[number];
        let resumption = Resumption {
            resistance: taken.resistance,
            drag,
            end: at_rest.or_else(|| reason_to_stop(session, stage, 0.0, taken)),
            ..Resumption::of(&self.to, *taken.accepted.state)
        };
        if let Some(output) = &mut session.output {
            let run = &session.summary;
            output.after_step(number, model, summary, taken, &resumption, run)?;
        }
        Ok(resumption)
    }

    /// The last step, without drag: the slope has to be in equilibrium where it rests. All of it acts already, so no cut helps.
    fn stand<const D: usize>(
        &self,
        session: &mut Session<'_, D>,
        state: &mut State<D>,
        summary: &mut StageSummary,
    ) -> Result<StageEnd, CaseError> {
        let (model, number) = (session.model, self.number);
        let settings = MarchSettings {
            cuts: 0,
            ..marching(model, 1)
        };
        let last = StagePath::of_equilibria((&self.to, &self.to), flowing(model), settings);
        march_path(
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
        )
    }
}

/// The drag of the next step over that of one whose longest motion was `moved` of the aim: a cut step of a share of a whole one
/// is to go that share of the way \[-\].
fn change_of_drag(moved: f64, share_of_step: f64) -> f64 {
    let is_cut = share_of_step < 1.0 - 1e-6;
    let aimed = if is_cut { share_of_step } else { 1.0 };
    (moved / aimed).clamp(CHANGE[0], CHANGE[1])
}

/// The march of a body that flows: a step that finds no equilibrium is tried with guarded corrections before it is cut, save beside rigid
/// bodies, where corrections are shortened in another way (theory, eq. 25f).
fn marching<const D: usize>(model: &Model<'_, D>, steps: usize) -> MarchSettings {
    MarchSettings {
        guards_again: model.case.rigid.is_empty(),
        ..model.march_settings(steps)
    }
}

/// The divisor of strength; none where the factor of safety that it refers to was not found.
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

/// The divisor of strength in a stage, and the search that it is a multiple of, for the verdict; none where the case states it.
pub(crate) fn remark<const D: usize>(session: &Session<'_, D>, number: usize) -> Option<String> {
    let stages = &session.model.case.stages;
    let times = match &stages[number].kind {
        StageKind::RunOut(run_out) => run_out.reduction,
        StageKind::Dynamic(dynamic) => dynamic.reduction.as_ref()?.1,
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

/// The longest step displacement of the nodes of the grid \[m\]; nodes of rigid bodies behind them do not count.
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
    if let DomainUpdate::DiagonalU | DomainUpdate::ScaledMoments = method.domain_update {
        method.domain_update = DomainUpdate::Moments;
    }
    method
}

#[cfg(test)]
mod tests {
    use super::{change_of_drag, largest_motion};

    /// GOAL: in space the vertical component counts, and the rotation of a rigid body does not.
    #[test]
    fn motion_has_all_components_of_the_grid_alone() {
        let u = [[0.0, 0.0, -3.0], [1.0, 2.0, 2.0], [0.0, 0.0, 50.0]];
        assert!((largest_motion(&u, 2) - 3.0).abs() < 1e-12);
        let plane = [[3.0, 4.0], [0.0, 6.0]];
        assert!((largest_motion(&plane, 1) - 5.0).abs() < 1e-12);
    }

    /// GOAL: drag follows the way of whole steps, so that a cut stays a cut: a half step that went half the way keeps it.
    /// ORACLE: theory, eq. 39 by hand; with the way of the half step itself drag would be halved, and the next step as long as the one
    /// that failed.
    #[test]
    fn a_cut_step_keeps_its_drag() {
        let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12);
        near(change_of_drag(1.2, 1.0), 1.2);
        near(change_of_drag(0.5, 0.5), 1.0);
        near(change_of_drag(0.3, 0.25), 1.2);
        near(change_of_drag(1e-3, 0.5), 0.25);
        near(change_of_drag(3.0, 0.5), 4.0);
    }
}
