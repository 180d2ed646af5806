//! Parameter studies: one case, many settings, one results folder a task.
//!
//! ```toml
//! igimp_sweep = 1
//! case = "slope.toml"            # relative to this file
//! combine = "grid"               # grid: every combination | zip: first with first, …
//! collect = ["factor_of_safety"] # factor of safety, names of checks, names of curves
//! [parameters]                   # keys and values as for --set
//! materials.clay.cohesion = ["8 kPa", "10 kPa", "12 kPa"]
//! materials.clay.friction = ["20 deg", "25 deg"]
//! [output]
//! folder = "results/sweep"       # relative to where the program runs, as in a case
//! ```
//!
//! Tasks are numbered from 1; task 1 writes into `results/sweep/task-0001/`, with its settings and
//! its end in `task.json`. A task is done when it ran to a verdict with the case and settings that
//! it has now, and its summary is there. One that was stopped goes on where it was.

mod chart;
mod collect;
mod columns;
mod file;
mod record;
mod resources;
mod scripts;
mod task_lock;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use igimp_cases::run::{self, Account, AnyListener, Entered, Start, Target, run_any_entered};
use igimp_cases::{CaseError, on_one_line};
use igimp_estimate::room;
use igimp_files::bytes;
use igimp_input::{CaseFile, InputError};
use igimp_model::{AnyCase, GivenSolver};
use igimp_report::ReportError;
use igimp_results::ending::Ending;
use igimp_results::folder::lock::Lock;
use igimp_results::folder::overwrite_guard::{Replace, refuse_link};
use igimp_results::folder::provenance::{Claim, Origin, Owner};
use igimp_results::{ResultsError, folder};
use thiserror::Error;

pub use collect::{Collected, aligned, collect};
pub use record::Record;
pub use resources::{Largest, Resources};
pub use scripts::{Script, Words, numbers};
pub use task_lock::TaskLock;

/// Most bytes of a sweep file.
const LARGEST: u64 = 8 << 20;
/// Says whose tasks a folder holds.
const MARKER: &str = ".igimp-sweep";

/// A parameter study that was read, with every task's case checked.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The sweep file.
    pub file: PathBuf,
    /// The case file.
    pub case: PathBuf,
    /// Folder of all tasks.
    pub folder: PathBuf,
    /// Names of the results to collect; empty: all.
    pub collect: Vec<String>,
    /// Keys of the parameters, in the order of the file.
    pub keys: Vec<String>,
    /// Tasks in order; the first parameter changes slowest.
    pub tasks: Vec<Task>,
    /// Date and time for the reports of its tasks, as given by the caller.
    pub date: Option<String>,
    /// A linear solver for all tasks, as given by the caller.
    pub given_solver: Option<GivenSolver>,
}

/// One run of a study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Task {
    /// Number, from 1.
    pub number: usize,
    /// Values of the parameters, as TOML, in the order of the keys.
    pub values: Vec<String>,
    /// Settings `KEY=VALUE`, as for `--set`.
    pub settings: Vec<String>,
    /// Results folder.
    pub folder: PathBuf,
}

impl Task {
    /// The settings in a line.
    pub fn label(&self) -> String {
        self.settings.join(", ")
    }
}

/// Why a study cannot be run.
#[derive(Debug, Error)]
pub enum SweepError {
    /// A file cannot be read or written.
    #[error("cannot access {}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        #[source]
        source: std::io::Error,
    },
    /// The sweep file says something that makes no sense.
    #[error("{text}")]
    Invalid {
        /// The complete message.
        text: String,
    },
    /// The settings of a task do not fit the case.
    #[error("task {task} ({settings}) of the sweep makes no valid case\n{source}")]
    Task {
        /// Number of the task.
        task: usize,
        /// Its settings.
        settings: String,
        /// The cause; its message is part of this one.
        source: InputError,
    },
    /// There is no such task.
    #[error("there is no task {task}; tasks are numbered 1 to {tasks}")]
    NoTask {
        /// The number given.
        task: usize,
        /// How many there are.
        tasks: usize,
    },
    /// A task's case cannot be set up, or its results cannot be written.
    #[error("the task cannot be run")]
    Case(#[from] CaseError),
    /// A table cannot be written.
    #[error("cannot write the table {}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// The error of the writer.
        #[source]
        source: csv::Error,
    },
}

impl From<ResultsError> for SweepError {
    fn from(error: ResultsError) -> Self {
        Self::Case(error.into())
    }
}

impl From<ReportError> for SweepError {
    fn from(error: ReportError) -> Self {
        Self::Case(error.into())
    }
}

impl Sweep {
    /// Reads a sweep file, and the case once for every task.
    ///
    /// # Errors
    /// [`SweepError`].
    pub fn read(path: &Path) -> Result<Self, SweepError> {
        let sweep = Self::read_unchecked(path)?;
        for task in &sweep.tasks {
            sweep.case_of(task)?;
        }
        Ok(sweep)
    }

    /// Reads a sweep file alone.
    ///
    /// # Errors
    /// [`SweepError::File`] and [`SweepError::Invalid`].
    pub fn read_unchecked(path: &Path) -> Result<Self, SweepError> {
        let text = text_of(path).map_err(|source| SweepError::File {
            path: path.to_owned(),
            source,
        })?;
        let base = path.parent().unwrap_or(Path::new(""));
        let sweep = file::parse(&path.display().to_string(), &text, base)?;
        Ok(Self {
            file: path.to_owned(),
            ..sweep
        })
    }

    /// A task by its number, from 1.
    ///
    /// # Errors
    /// [`SweepError::NoTask`].
    pub fn task(&self, number: usize) -> Result<&Task, SweepError> {
        number
            .checked_sub(1)
            .and_then(|index| self.tasks.get(index))
            .ok_or(SweepError::NoTask {
                task: number,
                tasks: self.tasks.len(),
            })
    }

    /// The case of a task: with frames along its stages where the case or the sweep asks for them.
    ///
    /// # Errors
    /// [`SweepError::Task`].
    pub fn case_of(&self, task: &Task) -> Result<CaseFile, SweepError> {
        let file = CaseFile::read(&self.case, &task.settings);
        file.map(CaseFile::with_few_frames)
            .map_err(|source| SweepError::Task {
                task: task.number,
                settings: task.label(),
                source,
            })
    }

    /// Enters the folder of all tasks: alone, for all of them, or together with those who run one each.
    ///
    /// # Errors
    /// [`ResultsError::InUse`] when another program runs tasks there; [`ResultsError::OtherStudy`] when they
    /// are those of another sweep file and not to be replaced, or where a run has its results; [`ResultsError::Link`],
    /// [`ResultsError::File`].
    pub fn enter(&self, alone: bool, replace: Replace) -> Result<Lock, CaseError> {
        let root = &self.folder;
        // A run and tasks in one folder would pass for one study.
        if folder::holds_results(root) {
            let (case, title) = folder::owner(root)
                .map_or_else(Default::default, |found| (found.case, found.title));
            return Err(ResultsError::OtherStudy {
                path: root.clone(),
                case,
                title,
                are_tasks: false,
            }
            .into());
        }
        let lock = if alone { Lock::alone } else { Lock::shared }(root)?;
        let claim = Claim {
            origin: Origin::File(self.file.clone()),
            title: String::new(),
            input: String::new(),
        };
        let (marker, owner) = (root.join(MARKER), Owner::of(&claim, root, false));
        match Owner::read(&marker) {
            // Many tasks begin at once: a marker that is there is not written again.
            Some(found) if found == owner => Ok(lock),
            Some(found)
                if found.case != owner.case
                    && replace != Replace::Everything
                    && self.holds_tasks() =>
            {
                Err(ResultsError::OtherStudy {
                    path: root.clone(),
                    case: found.case,
                    title: String::new(),
                    are_tasks: true,
                }
                .into())
            }
            _ => sign(&owner, &marker).map(|()| lock),
        }
    }

    fn holds_tasks(&self) -> bool {
        let mut tasks = self.tasks.iter();
        tasks.any(|task| Record::read(&task.folder).is_some())
    }

    /// Where a task that was not done begins: where it was stopped, if it can go on from there.
    ///
    /// # Errors
    /// [`SweepError::Task`].
    pub fn start_of(&self, task: &Task) -> Result<Start, SweepError> {
        let file = self.case_of(task)?;
        let goes_on = igimp_model::in_any_dimension!(file.any_case(), case => run::can_go_on(case, &task.folder));
        Ok(if goes_on {
            Start::Resume
        } else {
            Start::Afresh
        })
    }

    /// How a task ended, if it ran to a verdict with the case and settings that it has now, and its results are there.
    ///
    /// # Errors
    /// [`SweepError::Task`].
    pub fn done(&self, task: &Task) -> Result<Option<Ending>, SweepError> {
        let file = self.case_of(task)?;
        Ok(Record::read(&task.folder)
            .filter(|record| record.fingerprint == record::fingerprint(&file))
            .map(|record| record.ending)
            .filter(|ending| ending.is_verdict() && collect::summary(&task.folder).is_some()))
    }

    /// The tasks that are not done, in order.
    ///
    /// # Errors
    /// [`SweepError::Task`].
    pub fn left(&self) -> Result<Vec<&Task>, SweepError> {
        let mut left = Vec::new();
        for task in &self.tasks {
            if self.done(task)?.is_none() {
                left.push(task);
            }
        }
        Ok(left)
    }

    /// Runs a task and records its settings and its end in `task.json`.
    ///
    /// # Errors
    /// [`SweepError`]; the record says why, where it can be written.
    pub fn run_task(
        &self,
        task: &Task,
        start: Start,
        replace: Replace,
        listener: &mut dyn AnyListener,
        interrupt: &AtomicBool,
    ) -> Result<(Account, Ending), SweepError> {
        let ready = self.make_ready(task, start, replace)?;
        self.run_ready(task, &ready, listener, interrupt)
    }

    /// Enters the folder of a task.
    fn make_ready(&self, task: &Task, start: Start, replace: Replace) -> Result<Ready, SweepError> {
        let file = self.case_of(task)?;
        let mut case = file.any_case().clone();
        case.output_mut().folder.clone_from(&task.folder);
        case.give_solver(self.given_solver.as_ref());
        let target = Target {
            origin: Origin::Part(self.file.clone(), format!("task {}", task.number)),
            replace,
            date: self.date.clone(),
            ..Target::of(&file, &task.folder)
        };
        igimp_model::in_any_dimension!(&case, case => room::refuse_beyond(case))
            .map_err(CaseError::from)?;
        refuse_link(&task.folder)?;
        let entered =
            igimp_model::in_any_dimension!(&case, case => Entered::new(case, &target, start))?;
        Ok(Ready {
            file,
            case,
            target,
            start,
            _entered: entered,
        })
    }

    fn run_ready(
        &self,
        task: &Task,
        ready: &Ready,
        listener: &mut dyn AnyListener,
        interrupt: &AtomicBool,
    ) -> Result<(Account, Ending), SweepError> {
        folder::claim(&task.folder)?;
        let mut record = Record::new(self, task, &ready.file);
        record.write(&task.folder)?;
        let (target, start) = (Some(&ready.target), ready.start);
        match run_any_entered(&ready.case, target, start, listener, interrupt) {
            Ok(run) => {
                record.ending = run.summary.ending();
                record.message = record::message(&run);
                record.write(&task.folder)?;
                Ok((run, record.ending))
            }
            Err(error) => {
                record.ending = Ending::Failed;
                record.message = on_one_line(&error);
                // The error of the run matters more than one of its record.
                let _ = record.write(&task.folder);
                Err(error.into())
            }
        }
    }
}

/// A task whose folder is kept for it until this is dropped.
struct Ready {
    file: CaseFile,
    case: AnyCase,
    target: Target,
    start: Start,
    _entered: Entered,
}

/// Says whose tasks a folder holds; many may say so at once, and get into each other's way.
fn sign(owner: &Owner, marker: &Path) -> Result<(), CaseError> {
    let mut written = owner.write(marker);
    for _ in 0..20 {
        if written.is_ok() || Owner::read(marker).as_ref() == Some(owner) {
            return Ok(());
        }
        std::thread::sleep(Duration::from_millis(20));
        written = owner.write(marker);
    }
    Ok(written?)
}

/// Whether a file states a sweep, well or not.
pub fn is_sweep(path: &Path) -> bool {
    text_of(path).is_ok_and(|text| {
        let mut lines = text.lines().map(str::trim_start);
        lines.any(|line| line.starts_with("igimp_sweep"))
    })
}

/// The text of a sweep file.
fn text_of(path: &Path) -> std::io::Result<String> {
    let bytes = bytes::of_file(path, LARGEST)?;
    if bytes.len() as u64 > LARGEST {
        let text = format!("it has more than {} MB: is it a sweep file?", LARGEST >> 20);
        return Err(std::io::Error::other(text));
    }
    String::from_utf8(bytes).map_err(|_| std::io::Error::other("it is not UTF-8 text"))
}

#[cfg(test)]
mod tests;
