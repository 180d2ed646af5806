//! Where a run was left, as checkpoints tell it.

pub(crate) mod fingerprint;
pub(crate) mod free_field;
pub(crate) mod last_step;
pub(crate) mod readings;
pub(crate) mod reinforcement;
pub(crate) mod rigid;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use igimp_model::Calm;
use igimp_results::checkpoint::{CheckpointError, Meta};
use igimp_results::ending::EndReason;
use igimp_results::paraview::film::Film;
use igimp_results::summary::{CheckRow, FigureNote, StageSummary, TrialSummary};
use igimp_solver::{Body, MarchState};
use serde::{Deserialize, Serialize};

use super::state::{Controls, State};
use free_field::SavedFreeField;
use last_step::SavedStep;
use readings::Readings;
use reinforcement::SavedMember;
use rigid::SavedBody;

/// Where a march was left: with the body, all that it needs to go on.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Resumption {
    /// Controls at the beginning of the stage.
    pub(crate) from: Controls,
    /// Load factor reached, size of the next step, successes in a row.
    #[serde(with = "march_state", rename = "standing")]
    pub(crate) march: MarchState,
    /// Resistance of the footing in the last step \[N/m\].
    pub(crate) resistance: f64,
    /// Drag of the next step \[1/s²\].
    pub(crate) drag: f64,
    /// How calm motion has become.
    pub(crate) calm: Option<Calm>,
    /// Why the march ended with its last step, if its stage said so.
    pub(crate) end: Option<EndReason>,
    /// Its last step, of a stage that goes on along its path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) last_step: Option<SavedStep>,
}

impl Resumption {
    /// A march without drag, resistance or end, from the controls at the beginning of its stage.
    pub(crate) fn of(from: &Controls, march: MarchState) -> Self {
        Self {
            from: from.clone(),
            march,
            resistance: 0.0,
            drag: 0.0,
            calm: None,
            end: None,
            last_step: None,
        }
    }
}

/// Where a search for the factor of safety was left.
#[derive(Clone, Debug)]
pub(crate) struct Search<const D: usize> {
    /// Trials made.
    pub(crate) trials: Vec<TrialSummary>,
    /// Largest stable factor and its state.
    pub(crate) stable: Option<End<D>>,
    /// Smallest failed factor and its last equilibrium.
    pub(crate) failed: Option<End<D>>,
}

impl<const D: usize> Default for Search<D> {
    fn default() -> Self {
        Self {
            trials: Vec::new(),
            stable: None,
            failed: None,
        }
    }
}

/// An end of the interval of a search.
#[derive(Clone, Debug)]
pub(crate) struct End<const D: usize> {
    /// Strength reduction factor \[-\].
    pub(crate) srf: f64,
    /// Its last equilibrium.
    pub(crate) state: State<D>,
    /// The equilibrium before that, for the way in which the body moves.
    pub(crate) before: Option<Arc<Body<D>>>,
}

/// Where a run was left.
#[derive(Clone, Debug)]
pub(crate) struct ResumePoint<const D: usize> {
    /// Stages that are done.
    pub(crate) stages: Vec<StageSummary>,
    /// Checks made.
    pub(crate) checks: Vec<CheckRow>,
    /// Warnings given.
    pub(crate) warnings: Vec<String>,
    /// Most unknowns of a step.
    pub(crate) unknowns: usize,
    /// The stage that was not done, so far.
    pub(crate) stage: Option<StageSummary>,
    /// The state.
    pub(crate) state: State<D>,
    /// Where its march was left.
    pub(crate) resumption: Option<Resumption>,
    /// Where its search was left.
    pub(crate) search: Option<Search<D>>,
}

/// A checkpoint's own words, beside its bodies.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Notes {
    /// Fingerprint of all that the stages so far depend on.
    pub(crate) history: String,
    pub(crate) stages: Vec<StageSummary>,
    pub(crate) checks: Vec<CheckRow>,
    /// The sources of tables, sections and checks.
    #[serde(default)]
    pub(crate) readings: Readings,
    pub(crate) warnings: Vec<String>,
    pub(crate) unknowns: usize,
    pub(crate) figures: Vec<FigureNote>,
    pub(crate) factor_of_safety: Option<f64>,
    /// By check: the peak so far.
    #[serde(default)]
    pub(crate) peaks: Vec<Option<f64>>,
    pub(crate) curve_rows: Vec<usize>,
    pub(crate) monitor_rows: Vec<usize>,
    pub(crate) rigid_rows: Vec<usize>,
    #[serde(default)]
    pub(crate) energy_rows: usize,
    /// The rigid bodies of each state, by its name.
    pub(crate) rigid: BTreeMap<String, Vec<SavedBody>>,
    /// The reinforcement of each state, by its name.
    pub(crate) reinforcement: BTreeMap<String, Vec<SavedMember>>,
    /// Columns in free field beside the current state.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) free_fields: Vec<SavedFreeField>,
    pub(crate) convergence_rows: usize,
    pub(crate) frames: usize,
    /// Where the film of the stage stands.
    #[serde(default)]
    pub(crate) film: Film,
    pub(crate) steps: usize,
    pub(crate) stage: Option<StageSummary>,
    pub(crate) controls: Controls,
    pub(crate) resumption: Option<Resumption>,
    pub(crate) trials: Option<Vec<TrialSummary>>,
    pub(crate) stable: Option<(f64, Controls)>,
    pub(crate) failed: Option<(f64, Controls)>,
}

/// Name of the checkpoint at the end of a stage.
pub(crate) fn end_of_stage(number: usize) -> String {
    format!("stage-{:02}-end", number + 1)
}

/// The words of a checkpoint.
pub(crate) fn notes_of(path: &Path, meta: &Meta) -> Result<Notes, CheckpointError> {
    serde_json::from_value(meta.data.clone()).map_err(|error| CheckpointError::Damaged {
        path: path.to_path_buf(),
        file: "meta.json".to_owned(),
        why: error.to_string(),
    })
}

/// The state of a march as three numbers.
mod march_state {
    use igimp_solver::MarchState;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(crate) fn serialize<S: Serializer>(of: &MarchState, to: S) -> Result<S::Ok, S::Error> {
        (of.at, of.size, of.successes).serialize(to)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<MarchState, D::Error> {
        let (at, size, successes) = Deserialize::deserialize(from)?;
        Ok(MarchState {
            at,
            size,
            successes,
        })
    }
}
