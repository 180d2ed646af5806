//! Runs of the shipped case files, with the parts that studies need: the reports of all steps and
//! the states of trials, gathered from the events of a run.

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use igimp_assembly::Particles;
use igimp_cases::CaseError;
use igimp_cases::run::{self, Event, Listener, Start};
use igimp_input::shipped;
use igimp_model::Case;
use igimp_results::summary::{SafetySummary, TrialSummary};
use igimp_results::tables::table::Table;
use igimp_solver::{MarchReport, Outcome};

/// The shipped case of a name, changed by overrides such as `grid.locking=none`.
///
/// # Panics
/// If there is no such case: the cases are part of the program.
pub(crate) fn shipped_case(name: &str, overrides: Vec<String>) -> Result<Case<2>, CaseError> {
    let shipped = shipped::find(name).expect("the case is shipped");
    Ok(shipped.case_file(overrides)?.into_case())
}

/// Overrides for square cells of a size \[m\], on a grid from the origin to a corner \[m\].
pub(crate) fn mesh(cell: f64, upper: [f64; 2]) -> Vec<String> {
    let [x, y] = upper;
    vec![
        format!("grid.cell=\"{cell} m\""),
        format!("grid.domain={{ x = [\"0 m\", \"{x} m\"], y = [\"0 m\", \"{y} m\"] }}"),
    ]
}

/// Overrides for one of the four variants of the method.
pub(crate) fn method(basis: &str, bbar: bool) -> Vec<String> {
    vec![
        format!("grid.basis=\"{basis}\""),
        format!("grid.locking={}", if bbar { "b-bar" } else { "none" }),
    ]
}

/// A polygon as a case file writes it \[m\].
pub(crate) fn corners(polygon: &[[f64; 2]]) -> String {
    let corners: Vec<String> = polygon
        .iter()
        .map(|[x, y]| format!("[\"{x} m\", \"{y} m\"]"))
        .collect();
    format!("[{}]", corners.join(", "))
}

/// Overrides that leave out the watched quantities of a case at places of its own mesh or outline.
pub(crate) fn unwatched() -> [String; 3] {
    ["monitors=[]", "sections=[]", "checks=[]"].map(str::to_owned)
}

/// A case that was run.
#[derive(Debug)]
pub(crate) struct Computed<const D: usize> {
    /// The case.
    pub(crate) case: Case<D>,
    /// The run as the engine returns it.
    pub(crate) run: run::Run<D>,
    /// Every step, but those of trials.
    pub(crate) report: MarchReport,
    /// The trials of a strength reduction in the order they were made.
    pub(crate) trials: Vec<Trial<D>>,
    /// Wall-clock time.
    pub(crate) elapsed: Duration,
}

/// A trial of a strength reduction.
#[derive(Debug)]
pub(crate) struct Trial<const D: usize> {
    /// Factor and verdict.
    pub(crate) summary: TrialSummary,
    /// The particles at its last equilibrium.
    pub(crate) particles: Particles<D>,
    /// Its steps.
    pub(crate) report: MarchReport,
    /// Wall-clock time.
    pub(crate) elapsed: Duration,
}

impl<const D: usize> Computed<D> {
    /// Runs a case in memory.
    pub(crate) fn new(case: Case<D>) -> Result<Self, CaseError> {
        let clock = Instant::now();
        let mut recorder = Recorder::new();
        let never = AtomicBool::new(false);
        let run = run::run(&case, None, Start::Afresh, &mut recorder, &never)?;
        Ok(Self {
            case,
            run,
            report: recorder.report,
            trials: recorder.trials,
            elapsed: clock.elapsed(),
        })
    }

    /// The particles at the end.
    pub(crate) fn particles(&self) -> &Particles<D> {
        &self.run.body.particles
    }

    /// Variant of the method, as in `iGIMP + B-bar`.
    pub(crate) fn method(&self) -> String {
        self.case.method.label()
    }

    /// A curve of the case.
    ///
    /// # Panics
    /// If the case has no such curve: the cases are part of the program.
    pub(crate) fn curve(&self, name: &str) -> &Table {
        let mut curves = self.run.curves.iter();
        let found = curves.find(|curve| curve.name == name);
        found.expect("the case has the curve")
    }

    /// The factor of safety that the last stage found.
    pub(crate) fn safety(&self) -> Option<&SafetySummary> {
        self.run.summary.stages.last()?.safety.as_ref()
    }
}

/// Gathers the steps of a run, and its trials.
struct Recorder<const D: usize> {
    report: MarchReport,
    trials: Vec<Trial<D>>,
    clock: Instant,
}

impl<const D: usize> Recorder<D> {
    fn new() -> Self {
        Self {
            report: no_steps(),
            trials: Vec::new(),
            clock: Instant::now(),
        }
    }
}

impl<const D: usize> Listener<D> for Recorder<D> {
    fn on_event(&mut self, event: &Event<'_, D>) {
        match event {
            Event::Step { report, .. } => {
                self.report.outcome = if report.to < 1.0 {
                    Outcome::Stopped { at: report.to }
                } else {
                    Outcome::Completed
                };
                self.report.steps.push((*report).clone());
            }
            Event::Cut { error } => {
                self.report.outcome = Outcome::StepTooSmall {
                    last_converged: error.from,
                    cause: (*error).clone(),
                };
                self.report.failures.push((*error).clone());
            }
            Event::Trial { trial, state } => {
                self.trials.push(Trial {
                    summary: (*trial).clone(),
                    particles: state.body.particles.clone(),
                    report: std::mem::replace(&mut self.report, no_steps()),
                    elapsed: self.clock.elapsed(),
                });
                self.clock = Instant::now();
            }
            Event::StageStarted { .. } => self.clock = Instant::now(),
            _ => {}
        }
    }
}

/// The report of a march that has not begun.
fn no_steps() -> MarchReport {
    MarchReport {
        outcome: Outcome::Completed,
        steps: Vec::new(),
        failures: Vec::new(),
    }
}
