//! Runs a case: stage by stage, step by step, with its records and checks.

mod engine;
mod failure;
pub(crate) mod footing;
mod model;
mod output;
mod reinforcement;
mod resume;
mod rigid;
mod session;
pub(crate) mod stages;
mod start;
mod state;
mod study;
mod water;

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use igimp_input::CaseFile;
use igimp_linear::LinearSolverError;
use igimp_model::{AnyCase, Case};
use igimp_results::folder::overwrite_guard::Replace;
use igimp_results::folder::provenance::{Claim, Origin};
use igimp_results::model_size::ModelSize;
use igimp_results::summary::{PathPoint, StageSummary, Summary, TrialSummary};
use igimp_results::tables::table::Table;
use igimp_solver::{Accepted, Body, StepError, StepFailure, StepReport};

use crate::error::CaseError;
use igimp_estimate::Expectation;

pub(crate) use crate::run::start::run_entered;
pub use crate::run::start::{in_memory, run};
pub use failure::message::worst_node;
pub use model::Model;
pub use output::entry::Entered;
pub use output::entry::can_go_on;
pub use rigid::outlines as rigid_outlines;
pub use state::{Controls, ReinforcementControls, RigidControls, RigidTrack, State};

/// A moment of a run, as it happens.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a, const D: usize> {
    /// The model is made; the first step follows.
    Prepared {
        /// Its size.
        size: &'a ModelSize,
    },
    /// A stage begins.
    StageStarted {
        /// Its number, from 0.
        stage: usize,
        /// How many stages there are.
        of: usize,
        /// Its name.
        name: &'a str,
        /// Its kind, such as `gravity`.
        kind: &'static str,
        /// Load steps when none is cut; of each trial in a strength reduction.
        steps: usize,
    },
    /// A step found equilibrium; its [`Event::Step`] follows when it is recorded. For those who
    /// look at body and nodal forces themselves. An interruption now ends the run at this step.
    Equilibrium {
        /// Number of the step in its stage, from 1.
        number: usize,
        /// The body in its new state, conditions, forces and report of the step.
        accepted: &'a Accepted<'a, D>,
    },
    /// A step was accepted.
    Step {
        /// Number of the step in its stage, from 1.
        number: usize,
        /// Share of the stage (of the trial, in a strength reduction) that is done \[-\].
        progress: f64,
        /// How it went.
        report: &'a StepReport,
    },
    /// A step was not accepted and is tried again with a smaller one.
    Cut {
        /// Its failure.
        error: &'a StepError,
    },
    /// A trial of a strength reduction by trials ended; a search along the path of equilibria tells [`Event::Path`].
    Trial {
        /// Its result.
        trial: &'a TrialSummary,
        /// Its last equilibrium.
        state: &'a State<D>,
    },
    /// A search along a path of equilibria reached the next one.
    Path {
        /// The point.
        point: &'a PathPoint,
    },
    /// A stage ended.
    StageEnded {
        /// How it went.
        summary: &'a StageSummary,
    },
    /// Something that the user should know.
    Warning {
        /// In a sentence.
        text: &'a str,
    },
    /// Something happens on a mesh of a study of the mesh error; meshes run side by side.
    OfMesh {
        /// Into how many parts the mesh cuts the cells of the case.
        parts: usize,
        /// The event.
        event: &'a Event<'a, D>,
    },
}

/// Listens to a run: a progress bar, a log. Closures are listeners to runs of one dimension.
pub trait Listener<const D: usize>: Send {
    /// Called as it happens.
    fn on_event(&mut self, event: &Event<'_, D>);
}

impl<F: FnMut(&Event<'_, D>) + Send, const D: usize> Listener<D> for F {
    fn on_event(&mut self, event: &Event<'_, D>) {
        self(event);
    }
}

/// A listener to runs of any dimension.
pub trait AnyListener: Listener<2> + Listener<3> {}

impl<L: Listener<2> + Listener<3>> AnyListener for L {}

/// A listener that does not care.
#[derive(Clone, Copy, Debug)]
pub struct Nobody;

impl<const D: usize> Listener<D> for Nobody {
    fn on_event(&mut self, _: &Event<'_, D>) {}
}

/// Runs a case of any dimension, as [`run`](fn@run) does; what is left of the run without its body.
///
/// # Errors
/// As [`run`](fn@run).
pub fn run_any(
    case: &AnyCase,
    target: Option<&Target>,
    start: Start,
    listener: &mut dyn AnyListener,
    interrupt: &AtomicBool,
) -> Result<Account, CaseError> {
    Ok(match case {
        AnyCase::Plane(case) => run(case, target, start, listener, interrupt)?.into(),
        AnyCase::Space(case) => run(case, target, start, listener, interrupt)?.into(),
    })
}

/// The same in a results folder that was entered.
///
/// # Errors
/// As [`run`](fn@run).
pub fn run_any_entered(
    case: &AnyCase,
    target: Option<&Target>,
    start: Start,
    listener: &mut dyn AnyListener,
    interrupt: &AtomicBool,
) -> Result<Account, CaseError> {
    Ok(match case {
        AnyCase::Plane(case) => run_entered(case, target, start, listener, interrupt)?.into(),
        AnyCase::Space(case) => run_entered(case, target, start, listener, interrupt)?.into(),
    })
}

impl Failure {
    /// Whether the step failed because the system gave no more memory.
    pub fn is_want_of_memory(&self) -> bool {
        let failure = &*self.error.failure;
        matches!(
            failure,
            StepFailure::Linear(LinearSolverError::OutOfMemory { .. })
        )
    }
}

/// Where a run begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// At the beginning; earlier results in the folder are replaced, as far as [`Target::replace`] allows.
    #[default]
    Afresh,
    /// At the newest checkpoint of the results folder.
    Resume,
    /// At a stage, from the saved end of the one that it starts from.
    FromStage(usize),
}

/// A results folder to write into, with the texts that are kept beside the results.
#[derive(Clone, Debug)]
pub struct Target {
    /// The folder; it is made.
    pub folder: PathBuf,
    /// The case file as given, kept as `case.toml`.
    pub source: String,
    /// The case with every default, kept as `case.completed.toml`.
    pub completed: String,
    /// Folder for a linear system of every stage ([`linear_system`]), if they are wanted.
    ///
    /// [`linear_system`]: igimp_results::linear_system
    pub systems: Option<PathBuf>,
    /// Day and time of the run, for its report, stated by the caller. The library reads no time of day.
    pub date: Option<String>,
    /// The expected cost of the run, kept beside its actual cost.
    pub expectation: Option<Expectation>,
    /// Of a study of the mesh error: the completed case of each mesh.
    pub meshes: Vec<String>,
    /// Where the case comes from: results of another one are not replaced unasked.
    pub origin: Origin,
    /// The replaceable files of its folder.
    pub replace: Replace,
    /// Warnings of the case file, in a sentence each: its summary and its report have them, and listeners are not told.
    pub warnings: Vec<String>,
}

impl Target {
    /// The results folder of a case file.
    pub fn of(file: &CaseFile, folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
            source: file.source().to_owned(),
            completed: file.explain(),
            systems: None,
            date: None,
            expectation: None,
            meshes: file.explain_meshes(),
            origin: file.origin().clone(),
            replace: Replace::default(),
            warnings: file.warning_sentences(),
        }
    }
}

impl Target {
    /// The claim of a run of a case on this folder.
    fn claim<const D: usize>(&self, case: &Case<D>) -> Claim {
        Claim {
            origin: self.origin.clone(),
            title: case.title.clone(),
            input: resume::fingerprint::of_case(case),
        }
    }
}

/// The result of a run.
#[derive(Debug)]
pub struct Run<const D: usize> {
    /// As in `summary.json`.
    pub summary: Summary,
    /// Curves, named as in the case.
    pub curves: Vec<Table>,
    /// Histories at monitors.
    pub monitors: Vec<Table>,
    /// Fields along sections, named `SECTION__STAGE`.
    pub sections: Vec<Table>,
    /// The state at the end.
    pub body: Body<D>,
    /// The step that ended the run for want of equilibrium, if one did.
    pub failure: Option<Failure>,
    /// Why meshes of a study could not be run, or their results not be written; the others are there.
    pub lost: Vec<CaseError>,
}

/// The result of a run, in any dimension.
#[derive(Debug)]
pub struct Account {
    /// As in `summary.json`.
    pub summary: Summary,
    /// The step that ended the run for want of equilibrium, if one did.
    pub failure: Option<Failure>,
    /// Why meshes of a study could not be run, or their results not be written; the others are there.
    pub lost: Vec<CaseError>,
}

impl<const D: usize> From<Run<D>> for Account {
    fn from(run: Run<D>) -> Self {
        Self {
            summary: run.summary,
            failure: run.failure,
            lost: run.lost,
        }
    }
}

/// Particles within a cell of the node with the largest out-of-balance force, in the last equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NearWorst {
    /// How many there are.
    pub points: usize,
    /// How many of them yield.
    pub yielding: usize,
    /// How many of those returned to an apex or to a corner in tension.
    pub apex: usize,
    /// How many carry nine tenths of their shear strength or more.
    pub at_strength: usize,
}

impl NearWorst {
    /// Whether most of them are close to failure, or yield.
    pub fn is_at_strength(&self) -> bool {
        2 * self.at_strength.max(self.yielding) >= self.points.max(1)
    }
}

/// A step that found no equilibrium where the case wanted one.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Name of the stage.
    pub stage: String,
    /// Number of the step that failed, from 1.
    pub step: usize,
    /// Steps of the stage when none is cut.
    pub steps: usize,
    /// How often it was cut.
    pub cuts: u32,
    /// The smallest step tried, as a share of a full one \[-\].
    pub smallest: f64,
    /// Most corrections allowed.
    pub max_iterations: usize,
    /// The error.
    pub error: StepError,
    /// Particles within a cell of the worst node.
    pub near_worst: Option<NearWorst>,
    /// Material of most particles there.
    pub material: Option<String>,
    /// Remedies, most promising first; in the words of the case file.
    pub suggestions: Vec<String>,
    /// Files and folders with results.
    pub saved: Vec<PathBuf>,
}

impl Failure {
    /// Whether the linear system could not be solved because soil came to its strength.
    pub fn is_collapse(&self) -> bool {
        failure::is_loss_of_strength(&self.error, self.near_worst.as_ref())
    }
}
