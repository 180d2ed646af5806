//! A run under watch: it cannot take the campaign along when it panics, and not hold it up when it
//! hangs.

use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use igimp_cases::chain;
use igimp_cases::run::{self, Event, Listener, Run, Start};
use igimp_model::Case;
use igimp_results::summary::{SafetySummary, StageOutcome};
use igimp_results::tables::table::Table;

use crate::effort::{Cut, Effort, Follower};

/// The budget of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    /// Corrections, those of steps that were not accepted included.
    pub(crate) corrections: usize,
    /// Wall-clock time after which the run is asked to end.
    pub(crate) time: Duration,
    /// Time after that in which it has to do so.
    pub(crate) grace: Duration,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum End {
    /// Found no equilibrium beyond its last one.
    NoEquilibrium,
    /// Moved as far as the case counts as collapse.
    Moved,
    /// Found no equilibrium before the end that was planned: on the way to full gravity, or before a
    /// footing was as deep as asked.
    Early,
    /// Failed for another reason than want of equilibrium, such as a particle that left the grid.
    OtherFailure,
    /// Reached its end.
    Completed,
    /// Used up its budget of corrections or time, and ended when it was asked to.
    Budget,
    /// Did not end when it was asked to.
    Hangs,
    /// Panicked.
    Panics,
    /// Could not be set up.
    Refused,
}

impl End {
    /// In tables.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::NoEquilibrium => "no equilibrium",
            Self::Moved => "displacement limit",
            Self::Early => "no equilibrium before the planned end",
            Self::OtherFailure => "other failure",
            Self::Completed => "reached its end",
            Self::Budget => "budget used up",
            Self::Hangs => "hangs",
            Self::Panics => "panics",
            Self::Refused => "refused",
        }
    }

    /// Whether a run may end like this.
    pub(crate) fn is_orderly(self) -> bool {
        !matches!(self, Self::Hangs | Self::Panics | Self::Refused)
    }
}

/// The record of a run when it is over.
#[derive(Clone, Debug)]
pub(crate) struct Watched {
    /// How it ended.
    pub(crate) end: End,
    /// In the words of the run.
    pub(crate) reason: String,
    /// Name of the last stage that began.
    pub(crate) stage: String,
    /// The step that decided the end, if it did so by not being accepted.
    pub(crate) cut: Option<Cut>,
    /// Steps and corrections.
    pub(crate) effort: Effort,
    /// Share of the last stage that was reached \[-\].
    pub(crate) reached: f64,
    /// The result of a strength reduction.
    pub(crate) safety: Option<SafetySummary>,
    /// Curves of the case.
    pub(crate) curves: Vec<Table>,
    /// Particles.
    pub(crate) particles: usize,
    /// Wall-clock time \[s\].
    pub(crate) seconds: f64,
}

impl Watched {
    fn disorderly(end: End, reason: String, seconds: f64) -> Self {
        Self {
            end,
            reason,
            stage: String::new(),
            cut: None,
            effort: Effort::default(),
            reached: 0.0,
            safety: None,
            curves: Vec::new(),
            particles: 0,
            seconds,
        }
    }

    /// A run that could not begin.
    pub(crate) fn refused(error: &dyn Error) -> Self {
        Self::disorderly(End::Refused, chain(error), 0.0)
    }

    /// Whether the run kept the rules of every run: it ended, with a reason, accepted no step above the
    /// tolerance that is not at round-off, and carried no soil into a rigid body.
    pub(crate) fn is_sound(&self) -> bool {
        self.end.is_orderly()
            && !self.reason.is_empty()
            && self.effort.violations.is_empty()
            && self.effort.contact.is_empty()
    }
}

/// Runs a case under watch.
pub(crate) fn watch(case: Case<2>, budget: Budget) -> Watched {
    let clock = Instant::now();
    let interrupt = Arc::new(AtomicBool::new(false));
    let (sender, receiver) = channel();
    let stop = Arc::clone(&interrupt);
    std::thread::spawn(move || {
        let run = catch_unwind(AssertUnwindSafe(|| follow(&case, budget, &stop)));
        // Nobody listens any more to a run that was given up.
        let _ = sender.send(run.map_err(|panic| message(&*panic)));
    });
    let mut answer = receiver.recv_timeout(budget.time);
    if matches!(answer, Err(RecvTimeoutError::Timeout)) {
        interrupt.store(true, Ordering::Relaxed);
        answer = receiver.recv_timeout(budget.grace);
    }
    let seconds = clock.elapsed().as_secs_f64();
    match answer {
        Ok(Ok(watched)) => watched,
        Ok(Err(panic)) => Watched::disorderly(End::Panics, panic, seconds),
        Err(_) => Watched::disorderly(End::Hangs, "did not end when told".to_owned(), seconds),
    }
}

/// The message of a panic.
fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("without a message")
        .to_owned()
}

/// Listens to a run, and ends it when its corrections are used up.
struct Watch<'c> {
    follower: Follower<'c>,
    corrections: usize,
    budget: Budget,
    interrupt: &'c AtomicBool,
    /// The cut that ended the last trial that failed for want of equilibrium.
    failed: Option<Cut>,
    /// Whether the last thing that happened to the march was a cut.
    ended_by_cut: bool,
}

impl Listener<2> for Watch<'_> {
    fn on_event(&mut self, event: &Event<'_, 2>) {
        self.follower.on_event(event);
        match event {
            Event::Equilibrium { accepted, .. } => {
                self.corrections += accepted.report.iterations;
                self.ended_by_cut = false;
            }
            Event::Cut { error } => {
                self.corrections += error.residuals.len().saturating_sub(1);
                self.ended_by_cut = true;
            }
            Event::Trial { trial, .. } if !trial.stable => {
                self.failed = self.follower.effort.last_cut.filter(|_| self.ended_by_cut);
            }
            _ => {}
        }
        if self.corrections > self.budget.corrections {
            self.interrupt.store(true, Ordering::Relaxed);
        }
    }
}

fn follow(case: &Case<2>, budget: Budget, interrupt: &AtomicBool) -> Watched {
    let clock = Instant::now();
    let mut watch = Watch {
        follower: Follower::new(case),
        corrections: 0,
        budget,
        interrupt,
        failed: None,
        ended_by_cut: false,
    };
    let result = run::run(case, None, Start::Afresh, &mut watch, interrupt);
    let seconds = clock.elapsed().as_secs_f64();
    let run = match result {
        Ok(run) => run,
        Err(error) => return Watched::disorderly(End::Refused, chain(&error), seconds),
    };
    let stage = run.summary.stages.last().cloned().unwrap_or_default();
    let of_march = watch
        .follower
        .effort
        .last_cut
        .filter(|_| watch.ended_by_cut);
    let (end, cut) = match (&stage.outcome, &stage.safety) {
        (StageOutcome::Interrupted, _) => (End::Budget, None),
        (StageOutcome::NotConverged, _) if !is_want_of_equilibrium(&run) => {
            (End::OtherFailure, of_march)
        }
        (_, Some(safety)) if safety.failed.is_none() => (End::Completed, None),
        (_, Some(_)) if watch.failed.is_some() => (End::NoEquilibrium, watch.failed),
        (StageOutcome::NotConverged, None) => (End::Early, of_march),
        (StageOutcome::Stopped, None) if of_march.is_some() => (End::NoEquilibrium, of_march),
        (StageOutcome::Stopped, None) | (_, Some(_)) => (End::Moved, None),
        (StageOutcome::Completed, None) => (End::Completed, None),
    };
    let name = stage.name;
    let safety = stage.safety;
    let reason = match &safety {
        Some(safety) if stage.outcome == StageOutcome::Completed => safety
            .trials
            .iter()
            .filter(|trial| !trial.stable)
            .min_by(|a, b| a.srf.total_cmp(&b.srf))
            .map_or(stage.reason, |trial| trial.reason.clone()),
        _ => stage.reason,
    };
    Watched {
        end,
        reason,
        stage: name,
        cut,
        effort: watch.follower.effort,
        reached: stage.reached,
        safety,
        curves: run.curves,
        particles: run.summary.size.particles,
        seconds,
    }
}

/// Whether the step that ended a run did so for want of equilibrium.
fn is_want_of_equilibrium(run: &Run<2>) -> bool {
    let failure = run.failure.as_ref();
    failure.is_some_and(|failure| failure.error.failure.is_want_of_equilibrium())
}
