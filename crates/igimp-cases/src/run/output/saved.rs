//! Checkpoints of a run: their content beside the particles, and when they are written.

use std::collections::BTreeMap;

use igimp_model::Case;
use igimp_results::ResultsError;
use igimp_results::checkpoint::{self, Meta};
use igimp_results::summary::Summary;
use igimp_results::tables::rows::{self, RowWriter};
use igimp_solver::Body;
use rayon::prelude::*;

use super::{Output, csv};
use crate::error::CaseError;
use crate::run::resume::{Notes, end_of_stage, fingerprint, free_field, reinforcement, rigid};
use crate::run::state::Controls;

impl<const D: usize> Output<D> {
    pub(super) fn notes(
        &self,
        case: &Case<D>,
        stage: usize,
        run: &Summary,
        controls: &Controls,
    ) -> Notes {
        Notes {
            history: fingerprint::of_history(case, stage + 1),
            stages: run.stages.clone(),
            checks: run.checks.clone(),
            warnings: run.warnings.clone(),
            readings: self.readings.clone(),
            unknowns: run.size.unknowns,
            figures: self.figures.clone(),
            factor_of_safety: self.factor_of_safety,
            peaks: self
                .peaks
                .iter()
                .map(|&peak| Some(peak).filter(|peak| peak.is_finite()))
                .collect(),
            curve_rows: self.curves.iter().map(RowWriter::len).collect(),
            monitor_rows: self.monitors.iter().map(RowWriter::len).collect(),
            rigid_rows: self.rigid.iter().map(RowWriter::len).collect(),
            energy_rows: self.energy.as_ref().map_or(0, RowWriter::len),
            rigid: BTreeMap::new(),
            reinforcement: BTreeMap::new(),
            free_fields: Vec::new(),
            convergence_rows: self.convergence.len(),
            frames: self.frames.len(),
            film: self.film,
            steps: self.steps,
            stage: None,
            controls: controls.clone(),
            resumption: None,
            trials: None,
            stable: None,
            failed: None,
        }
    }

    pub(super) fn meta(
        &self,
        notes: &Notes,
        states: &[(&str, &Body<D>)],
    ) -> Result<Meta, CaseError> {
        let with_bodies = states.iter().filter(|(_, body)| !body.rigid.is_empty());
        let saved = with_bodies.map(|(name, body)| ((*name).to_owned(), rigid::all(body)));
        let with_members = states
            .iter()
            .filter(|(_, body)| !body.reinforcement.is_empty());
        let members = with_members.map(|(name, body)| {
            let kept = reinforcement::all(body);
            ((*name).to_owned(), kept)
        });
        let notes = Notes {
            rigid: saved.collect(),
            reinforcement: members.collect(),
            free_fields: states
                .first()
                .map_or_else(Vec::new, |(_, body)| free_field::all(body)),
            ..notes.clone()
        };
        let data = serde_json::to_value(notes).map_err(|source| ResultsError::File {
            path: self.folder.checkpoint(),
            source: source.into(),
        })?;
        Ok(Meta::new(&self.claim.input, data))
    }

    /// Writes a checkpoint within a stage. It follows the rows that it counts on; data in the
    /// hands of the system outlasts a kill.
    pub(super) fn save(&self, states: &[(&str, &Body<D>)], notes: &Notes) -> Result<(), CaseError> {
        let name = format!("step-{:06}", self.steps);
        let (folder, meta) = (self.folder.checkpoint(), self.meta(notes, states)?);
        let columns = states
            .first()
            .map_or_else(Vec::new, |(_, body)| free_field::states(body));
        let states = with_columns(states, &columns);
        checkpoint::write_quickly(&folder, &name, &states, &meta, self.checkpoint_keep)?;
        Ok(())
    }

    /// Writes the checkpoint at the end of a stage, after its rows, to outlast a loss of power.
    pub(super) fn save_end(
        &mut self,
        stage: usize,
        body: &Body<D>,
        notes: &Notes,
    ) -> Result<(), CaseError> {
        let tables: Vec<&RowWriter> = self
            .curves
            .iter()
            .chain(&self.monitors)
            .chain(&self.rigid)
            .chain([&self.convergence])
            .collect();
        let (synced, frames) = rayon::join(
            || tables.par_iter().try_for_each(|table| table.sync()),
            || self.frames.sync(),
        );
        synced.and(frames)?;
        let mut notes = notes.clone();
        for (name, reading) in &mut notes.readings.tables {
            let path = self.folder.root().join(csv(name));
            let table = tables.iter().find(|table| table.path() == path);
            reading.rows = table.map_or(0, |table| table.len());
            reading.digest = rows::digest(&path, reading.rows)?.unwrap_or_default();
        }
        let states = [("current", body)];
        let (folder, meta) = (self.folder.checkpoint(), self.meta(&notes, &states)?);
        let columns = free_field::states(body);
        let states = with_columns(&states, &columns);
        checkpoint::write(&folder, &end_of_stage(stage), &states, &meta, 1)?;
        Ok(())
    }
}

/// States with those of the columns that move in free field behind them.
fn with_columns<'s, const D: usize>(
    states: &[(&'s str, &'s Body<D>)],
    columns: &'s [(String, Body<D>)],
) -> Vec<(&'s str, &'s Body<D>)> {
    let columns = columns.iter().map(|(name, body)| (name.as_str(), body));
    states.iter().copied().chain(columns).collect()
}
