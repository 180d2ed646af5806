//! Additions for stages that move in time: frames with times, and the picture of their energy.

use igimp_model::{Case, Every, StageKind};
use igimp_report::pictures::{self, Shown};
use igimp_results::paraview::frames::Scene;
use igimp_results::summary::FigureNote;

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

/// The title of pictures at the end of a stage: of a motion with its time.
pub(super) fn shown<const D: usize>(case: &Case<D>, number: usize, state: &State<D>) -> Shown {
    let shown = Shown::end_of_stage(case, number);
    match case.stages[number].kind {
        StageKind::Dynamic(_) => shown.at_time(state.controls.time),
        _ => shown,
    }
}
