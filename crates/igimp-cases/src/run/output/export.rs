//! A linear system of every stage, written for other solvers (`igimp run --export-matrix`).
//!
//! Of the last accepted step of a stage, the second system is written: the first one with the
//! consistent tangent. A step with one correction has its only system written, and a step that was
//! in equilibrium from the start has none, so that the step before it counts.

use std::path::{Path, PathBuf};

use igimp_assembly::StepConditions;
use igimp_linear::{LinearSolver, Record};
use igimp_results::atomic::at;
use igimp_results::folder::claim;
use igimp_results::folder::overwrite_guard::refuse_link;
use igimp_results::linear_system::{About, LinearSystem, remove};
use igimp_results::summary::{StageSummary, Summary};

use crate::error::CaseError;

/// The correction whose system is written.
const CORRECTION: usize = 2;

/// The folder for linear systems, and the one that is written if the stage ends now.
#[derive(Debug)]
pub(crate) struct Export {
    folder: PathBuf,
    record: Record,
    last: Option<LinearSystem>,
}

impl Export {
    /// Makes the folder; systems of stages from `first` on that an earlier run left are removed.
    pub(crate) fn open(folder: &Path, first: usize) -> Result<Self, CaseError> {
        claim(folder)?;
        for entry in std::fs::read_dir(folder).map_err(at(folder))? {
            let path = entry.map_err(at(folder))?.path();
            let Some(stage) = stage_of(&path) else {
                continue;
            };
            refuse_link(&path)?;
            if stage >= first {
                remove(&path)?;
            }
        }
        Ok(Self {
            folder: folder.to_owned(),
            record: Record::of_system(CORRECTION),
            last: None,
        })
    }

    /// The solver of a march, watched.
    pub(crate) fn watch(&self, solver: Box<dyn LinearSolver>) -> Box<dyn LinearSolver> {
        self.record.around(solver)
    }

    /// A step was accepted: its system is the last one of the stage so far.
    pub(crate) fn accepted<const D: usize>(
        &mut self,
        conditions: &StepConditions<D>,
        run: &Summary,
        stage: &StageSummary,
    ) {
        if let Some(solved) = self.record.take() {
            let about = About {
                program: run.program.clone(),
                case: run.title.clone(),
                stage: stage.name.clone(),
                stage_number: run.stages.len() + 1,
                step: stage.steps,
                ..About::default()
            };
            let (grid, constraints) = (&conditions.grid, &conditions.constraints);
            self.last = Some(LinearSystem::of(solved, grid, constraints, about));
        }
    }

    /// A step was not accepted: its systems do not count.
    pub(crate) fn not_accepted(&mut self) {
        self.record.take();
    }

    /// Writes the last system of a stage, numbered from 0.
    pub(crate) fn end_of_stage(&mut self, number: usize) -> Result<(), CaseError> {
        match self.last.take() {
            Some(system) => Ok(system.write(&self.folder.join(name(number)))?),
            None => Ok(()),
        }
    }
}

/// The folder of a stage, numbered from 0.
fn name(stage: usize) -> String {
    format!("stage-{:02}", stage + 1)
}

/// The stage whose folder this is.
fn stage_of(path: &Path) -> Option<usize> {
    let folder = path.file_name()?.to_str()?;
    let stage = folder.strip_prefix("stage-")?.parse().ok();
    let stage = stage.and_then(|number: usize| number.checked_sub(1))?;
    (folder == name(stage)).then_some(stage)
}
