//! A task that a scheduler may begin several times, at several places and at once: it is computed once, goes on
//! where it was stopped, and is never computed by two at a time.
//!
//! The lock of the task's folder tells them apart, and the state of the task is asked for again once
//! the lock is held. A task that was killed leaves no lock: the system lets go of it.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use igimp_cases::CaseError;
use igimp_cases::run::{Account, AnyListener};
use igimp_results::ResultsError;
use igimp_results::ending::Ending;
use igimp_results::folder::overwrite_guard::Replace;

use super::{Sweep, SweepError, Task};

/// How long to wait before a folder is tried again.
const PAUSE: Duration = Duration::from_millis(500);

/// The outcome of a task that was claimed.
#[derive(Debug)]
pub enum TaskLock {
    /// It was done already, with the case and settings that it has now.
    Done(Ending),
    /// It was run, from its beginning or from where it was stopped.
    Ran(Box<Account>, Ending),
    /// Another program still ran it when the wait was interrupted.
    Elsewhere,
}

impl Sweep {
    /// Takes up a task where it stands: one that is done is left alone, one that was stopped goes on, and one that
    /// another program runs is waited for. `waits` is called once, with the folder, when a wait begins.
    ///
    /// # Errors
    /// As [`Sweep::run_task`], but never that the folder is in use.
    pub fn take_up(
        &self,
        task: &Task,
        listener: &mut dyn AnyListener,
        interrupt: &AtomicBool,
        waits: impl FnOnce(&Path),
    ) -> Result<TaskLock, SweepError> {
        let mut waits = Some(waits);
        loop {
            match self.take_up_once(task, listener, interrupt) {
                Ok(Some(turn)) => return Ok(turn),
                Ok(None) => {}
                Err(SweepError::Case(CaseError::Results(ResultsError::InUse { path }))) => {
                    if interrupt.load(Ordering::SeqCst) {
                        return Ok(TaskLock::Elsewhere);
                    }
                    if let Some(waits) = waits.take() {
                        waits(&path);
                    }
                    std::thread::sleep(PAUSE);
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// Nothing if the task changed its state before its folder was entered.
    fn take_up_once(
        &self,
        task: &Task,
        listener: &mut dyn AnyListener,
        interrupt: &AtomicBool,
    ) -> Result<Option<TaskLock>, SweepError> {
        if let Some(ending) = self.done(task)? {
            return Ok(Some(TaskLock::Done(ending)));
        }
        let _shared = self.enter(false, Replace::Finished)?;
        let start = self.start_of(task)?;
        let ready = self.make_ready(task, start, Replace::Finished)?;
        if self.done(task)?.is_some() || self.start_of(task)? != start {
            return Ok(None);
        }
        let (run, ending) = self.run_ready(task, &ready, listener, interrupt)?;
        Ok(Some(TaskLock::Ran(Box::new(run), ending)))
    }
}
