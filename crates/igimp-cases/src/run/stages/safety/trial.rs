//! One trial of a search: its controls at its end, its steps, and its remarks.

use igimp_model::ReductionPath;
use igimp_results::ending::EndReason;
use igimp_solver::{MarchSettings, StepError};
use igimp_text::short;

use super::Trials;
use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::output::moment::Moment;
use crate::run::session::Session;
use crate::run::state::{Controls, State};

impl<const D: usize> Trials<'_, D> {
    /// The controls at the end of a trial: those found with strength reduced, and gravity in full
    /// where none acted yet.
    pub(super) fn end(&self, srf: f64) -> Controls {
        let mut end = self.found.controls.clone();
        if self.reduction.path == ReductionPath::Gravity && end.gravity == 0.0 {
            end.gravity = 1.0;
        }
        end.drained = self.stage.drained;
        for &material in &self.reduction.materials {
            end.srf[material] = srf;
        }
        end
    }

    /// Steps of a trial: by gravity those of the stage; of a reduction, one on the way to the lower end of
    /// the bracket, where equilibrium is expected, and beyond it in strides of which the stage has so many
    /// from full strength to the upper end. A reduction is cut until its step is no wider than the tolerance, and once more.
    pub(super) fn settings(
        &self,
        model: &Model<'_, D>,
        from: &Controls,
        srf: f64,
    ) -> MarchSettings {
        let [low, high] = self.reduction.bracket;
        if self.reduction.path == ReductionPath::Gravity {
            return model.march_settings(self.stage.steps);
        }
        let way = (srf - from.srf[self.reduction.materials[0]]).abs();
        let stride = (high - low).max(high - 1.0) / self.stage.steps as f64;
        let steps = if srf <= low {
            1
        } else {
            ((way / stride).ceil() as usize).max(1)
        };
        let mut settings = model.march_settings(steps);
        let wide = way / steps as f64 / self.reduction.tolerance;
        let halvings = (wide.max(1.0).ln() / -settings.cut_factor.ln()).ceil();
        settings.cuts = settings.cuts.max(halvings as u32 + 1);
        settings
    }

    pub(super) fn exceeded(&self, session: &Session<'_, D>) -> EndReason {
        let limit = self.limit.unwrap_or(f64::INFINITY);
        let whose = session.whose_displacement(self.reduction.monitor);
        EndReason::DisplacementExceeded { whose, limit }
    }

    pub(super) fn no_equilibrium(&self, state: &State<D>, cause: &StepError) -> String {
        let failure = &cause.failure;
        match self.reduction.path {
            ReductionPath::Gravity => {
                let reached = short(cause.from);
                format!("no equilibrium beyond {reached} of the load: {failure}")
            }
            ReductionPath::Reduce => {
                let reached = state.controls.srf[self.reduction.materials[0]];
                format!("no equilibrium beyond SRF {reached:.4}: {failure}")
            }
        }
    }

    /// Adds the row of a listed factor to the curves.
    pub(super) fn record(
        &self,
        session: &mut Session<'_, D>,
        state: &State<D>,
        plastic_share: f64,
    ) -> Result<(), CaseError> {
        let grid = session.model.grid(session.model.lowered(&state.controls))?;
        session.record(&Moment {
            stage: self.number,
            number: self.made.len(),
            progress: 1.0,
            grid: &grid,
            particles: &state.body.particles,
            rigid: &state.body.rigid,
            reinforcement: &state.body.reinforcement,
            controls: &state.controls,
            resistance: 0.0,
            plastic_share,
            energy: None,
        })
    }
}
