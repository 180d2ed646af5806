//! What stages that move in time have beside the others: frames with times, and the picture of their energy.

use igimp_model::{Case, Every, Stage, StageKind};
use igimp_report::pictures::{self, Shown};
use igimp_results::paraview::frames::Scene;
use igimp_results::summary::{FigureNote, StageSummary};

use super::moment::AcceptedStep;
use super::records::Records;
use super::{Output, outlines};
use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::state::State;

impl<const D: usize> Output<D> {
    /// The state that a motion begins with as its first frame, unless it is the last frame of the stage before it.
    pub(crate) fn begin_motion(
        &mut self,
        model: &Model<'_, D>,
        number: usize,
        state: &State<D>,
    ) -> Result<(), CaseError> {
        if self.every == Every::Never {
            return Ok(());
        }
        let case = model.case;
        let stage = &case.stages[number];
        let before = stage.start_from.map(|before| &case.stages[before]);
        let shown = before.filter(|before| !before.reset_displacements);
        let from = shown.map(|before| before.name.as_str());
        let seconds = state.controls.time;
        if self.frames.begin_motion(number, from, seconds)? {
            return Ok(());
        }
        // Between the frames before it and that of the first step.
        let between = if self.frames.is_empty() { 0.0 } else { 0.5 };
        let scene = Scene {
            particles: &state.body.particles,
            laws: &model.laws_reduced_by(&state.controls.srf)?,
            structures: &outlines::structures(case, &state.controls, &state.body),
        };
        let grid = model.grid(model.lowered(&state.controls))?;
        let time = (self.steps as f64 + between, seconds);
        Ok(self
            .frames
            .add(time, (number, &stage.name), &scene, &grid)?)
    }

    /// The pictures of the energy of stages that take time.
    pub(super) fn energy_pictures(
        &self,
        case: &Case<D>,
        records: &Records,
    ) -> Result<Vec<FigureNote>, CaseError> {
        let root = self.folder.root();
        Ok(pictures::energy_pictures(
            root,
            case,
            &records.energy.as_written(),
        )?)
    }
}

/// What the pictures of the end of a stage say of it: of a motion its time too.
pub(super) fn shown<const D: usize>(case: &Case<D>, number: usize, state: &State<D>) -> Shown {
    let shown = Shown::end_of_stage(case, number);
    match case.stages[number].kind {
        StageKind::Dynamic(_) => shown.at_time(state.controls.time),
        _ => shown,
    }
}

/// Whether an accepted step has a frame: of those that are counted, every so many, or as many as make a film.
pub(super) fn has_frame<const D: usize>(
    every: Every,
    stage: &Stage,
    summary: &StageSummary,
    taken: &AcceptedStep<'_, D>,
) -> bool {
    let report = &taken.accepted.report;
    let number = frame_number(stage, summary, taken);
    let most = stage.kind.film_frames();
    let is_every = |every: usize| number.is_some_and(|own| own.is_multiple_of(every.max(1)));
    match every {
        Every::Never | Every::Stage => false,
        Every::Steps(every) => is_every(every),
        Every::Film if report.energy.is_some() => is_every(stage.steps.div_ceil(most)),
        Every::Film => {
            let place = |share: f64| (most as f64 * share + 1e-6).floor();
            place(report.to) > place(report.from)
        }
    }
}

/// The number of an accepted step among those that frames are counted by: of a stage that takes time the parts of its duration
/// that steps land on, else all.
fn frame_number<const D: usize>(
    stage: &Stage,
    summary: &StageSummary,
    taken: &AcceptedStep<'_, D>,
) -> Option<usize> {
    let report = taken.accepted.report;
    if report.energy.is_none() {
        return Some(summary.steps);
    }
    let part = report.to * stage.steps as f64;
    let lands = (part - part.round()).abs() < 1e-6;
    lands.then_some(part.round() as usize)
}
