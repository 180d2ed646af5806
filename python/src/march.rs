//! A run in a thread of its own, which waits for Python after every event.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use igimp_cases::run::{self as engine, Start, Target};
use igimp_cases::{CaseError, chain};
use igimp_estimate::Expectation;
use igimp_estimate::room::refuse_beyond;
use igimp_estimate::watch::lacks_memory;
use igimp_model::{AnyCase, Case, in_any_dimension};
use igimp_results::ResultsError;
use igimp_results::folder::overwrite_guard::Replace;
use igimp_results::tables::table::Table;
use igimp_study::narration::lines::Lines;
use igimp_study::narration::progress::Whole;
use igimp_study::threads::refusal;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, Arrays};
use crate::case::CaseFile;
use crate::law::{Trouble, give};
use crate::raised::{self, Raised};
use crate::relay::{Relay, Seen, Stage};

/// Bytes of the stack of a run, as much as that of a program.
const STACK: usize = 16 << 20;

/// A run that is under way.
#[pyclass(frozen, module = "igimp._igimp")]
#[derive(Debug)]
pub(crate) struct March {
    interrupt: Arc<AtomicBool>,
    trouble: Trouble,
    ends: Mutex<Ends>,
}

/// What Python holds of a run.
#[derive(Debug)]
struct Ends {
    events: Option<Receiver<Seen>>,
    go_on: Sender<()>,
    /// Whether the run waits for the word to go on.
    waits: bool,
    thread: Option<JoinHandle<Result<Found, Raised>>>,
}

/// What a run found.
#[derive(Debug)]
struct Found {
    summary: String,
    /// Messages of what failed: the step without equilibrium, and meshes that could not be run.
    failure: Option<String>,
    lost: Vec<String>,
    curves: Vec<Table>,
    monitors: Vec<Table>,
    sections: Vec<Table>,
    body: Arrays,
    code: u8,
}

/// What a run needs beside its case.
struct Order {
    target: Option<Target>,
    start: Start,
    threads: Option<usize>,
    interrupt: Arc<AtomicBool>,
}

#[pymethods]
impl March {
    /// Begins a run. `laws` are laws of materials by name that are written in Python.
    #[new]
    #[pyo3(signature = (case, out, start, threads, overwrite, date, with_body, laws))]
    #[allow(clippy::too_many_arguments, reason = "the package alone calls it")]
    fn new(
        py: Python<'_>,
        case: &CaseFile,
        out: Option<PathBuf>,
        start: (&str, usize),
        threads: Option<usize>,
        overwrite: bool,
        date: Option<String>,
        with_body: bool,
        laws: Vec<(String, Py<PyAny>)>,
    ) -> PyResult<Self> {
        if let Some(text) = threads.and_then(refusal) {
            return Err(Raised::bad_input(format!("error: {text}")).exception(py));
        }
        let interrupt = Arc::new(AtomicBool::new(false));
        let trouble = Trouble::new(Arc::clone(&interrupt));
        let mut any = case.file.any_case().clone();
        for (material, law) in laws {
            in_any_dimension!(&mut any, case => give(py, case, (&material, law), &trouble))?;
        }
        let target = out.map(|folder| {
            any.output_mut().folder.clone_from(&folder);
            Target {
                date,
                replace: if overwrite {
                    Replace::Everything
                } else {
                    Replace::Finished
                },
                ..Target::of(&case.file, folder)
            }
        });
        let order = Order {
            target,
            start: match start {
                ("resume", _) => Start::Resume,
                ("stage", stage) => Start::FromStage(stage),
                _ => Start::Afresh,
            },
            threads,
            interrupt: Arc::clone(&interrupt),
        };
        let (events, hears) = channel();
        let (go_on, waits) = channel();
        let relay = Relay {
            events,
            go_on: waits,
            lines: Lines::default(),
            whole: Whole::of(&any),
            with_body,
            stage: Stage::default(),
            body: None,
        };
        let thread = std::thread::Builder::new()
            .name("igimp".into())
            .stack_size(STACK)
            .spawn(move || in_pool(&any, order, relay))?;
        Ok(Self {
            interrupt,
            trouble,
            ends: Mutex::new(Ends {
                events: Some(hears),
                go_on,
                waits: false,
                thread: Some(thread),
            }),
        })
    }

    /// Lets the run go on to its next event, and waits for it so many seconds.
    ///
    /// Returns the event as JSON and the arrays of the body, if they were asked for; an empty text when
    /// nothing happened in that time; None when the run ended.
    fn next<'py>(
        &self,
        py: Python<'py>,
        seconds: f64,
    ) -> PyResult<Option<(String, Option<Bound<'py, PyDict>>)>> {
        let event = py.detach(|| {
            let mut ends = self.ends.lock().unwrap_or_else(PoisonError::into_inner);
            if std::mem::take(&mut ends.waits) {
                // A run that ended waits for no word.
                let _ = ends.go_on.send(());
            }
            let patience = Duration::from_secs_f64(seconds.clamp(0.0, 3600.0));
            let event = (ends.events.as_ref()).map(|events| events.recv_timeout(patience));
            ends.waits = matches!(event, Some(Ok(_)));
            event
        });
        match event {
            Some(Ok(Seen { text, body })) => {
                let body = body.map(|arrays| arrays.into_dict(py)).transpose()?;
                Ok(Some((text, body)))
            }
            Some(Err(RecvTimeoutError::Timeout)) => Ok(Some((String::new(), None))),
            Some(Err(RecvTimeoutError::Disconnected)) | None => Ok(None),
        }
    }

    /// Ends the run after its step, with everything saved.
    fn stop(&self) {
        self.interrupt.store(true, Ordering::SeqCst);
    }

    /// Tells no more events: the run goes on without a word.
    fn leave(&self) {
        let mut ends = self.ends.lock().unwrap_or_else(PoisonError::into_inner);
        ends.events = None;
        let _ = ends.go_on.send(());
    }

    /// Whether this is the thread of the run, in which a law in Python is asked: it cannot wait for its own end.
    fn is_own_thread(&self) -> bool {
        let ends = self.ends.lock().unwrap_or_else(PoisonError::into_inner);
        let id = ends.thread.as_ref().map(|run| run.thread().id());
        id == Some(std::thread::current().id())
    }

    /// Waits for the end of the run and hands over what it found, once.
    fn found<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let ended = py.detach(|| {
            let mut ends = self.ends.lock().unwrap_or_else(PoisonError::into_inner);
            ends.events = None;
            let _ = ends.go_on.send(());
            let thread = ends.thread.take();
            drop(ends);
            thread.map(JoinHandle::join)
        });
        if let Some(error) = self.trouble.take() {
            return Err(error);
        }
        let found = match ended {
            Some(Ok(found)) => found,
            Some(Err(_)) => Err(Raised::internal(
                "error: the run ended by an error of igimp itself; what it wrote before is kept",
            )),
            None => Err(Raised::internal(
                "error: what the run found was taken before",
            )),
        };
        let found = found.map_err(|raised| raised.exception(py))?;
        let dict = PyDict::new(py);
        dict.set_item("summary", found.summary)?;
        dict.set_item("failure", found.failure)?;
        dict.set_item("lost", found.lost)?;
        dict.set_item("exit_code", found.code)?;
        dict.set_item("curves", arrays::tables(py, found.curves)?)?;
        dict.set_item("monitors", arrays::tables(py, found.monitors)?)?;
        dict.set_item("sections", arrays::tables(py, found.sections)?)?;
        dict.set_item("body", found.body.into_dict(py)?)?;
        Ok(dict)
    }
}

impl Drop for March {
    /// Whoever drops a run wants no more of it: it ends after its step.
    fn drop(&mut self) {
        self.interrupt.store(true, Ordering::SeqCst);
    }
}

/// The run on threads of its own number, or on those of everybody.
fn in_pool(any: &AnyCase, order: Order, mut relay: Relay) -> Result<Found, Raised> {
    let mut whole = || in_any_dimension!(any, case => run(case, &order, &mut relay));
    match order.threads {
        None => whole(),
        Some(threads) => {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .stack_size(STACK)
                .build();
            let pool = pool.map_err(|error| Raised::internal(format!("error: {error}")))?;
            pool.install(whole)
        }
    }
}

/// The same steps as `igimp run` takes.
fn run<const D: usize>(case: &Case<D>, order: &Order, relay: &mut Relay) -> Result<Found, Raised>
where
    Relay: engine::Listener<D>,
{
    refuse_beyond(case).map_err(CaseError::from)?;
    let mut target = order.target.clone();
    if let Some(target) = &mut target {
        std::fs::create_dir_all(&target.folder).map_err(|source| ResultsError::File {
            path: target.folder.clone(),
            source,
        })?;
        // A run that goes on makes a part of the steps only.
        if order.start == Start::Afresh {
            target.expectation = Expectation::of(case).ok();
        }
        let cost = target.expectation.as_ref();
        if let Some(text) = cost.and_then(|cost| lacks_memory(cost.bytes, cost.most_bytes)) {
            let event = engine::Event::Warning { text: &text };
            engine::Listener::<D>::on_event(relay, &event);
        }
    }
    let run = engine::run(case, target.as_ref(), order.start, relay, &order.interrupt)?;
    let lost = run.lost.iter();
    Ok(Found {
        summary: serde_json::to_string(&run.summary)
            .map_err(|error| Raised::internal(format!("error: {error}")))?,
        code: code(&run),
        failure: run.failure.as_ref().map(ToString::to_string),
        lost: lost.map(|error| chain(error)).collect(),
        curves: run.curves,
        monitors: run.monitors,
        sections: run.sections,
        body: Arrays::of(run.body.particles.into_fields()),
    })
}

/// The exit code that the program would end with.
fn code<const D: usize>(run: &engine::Run<D>) -> u8 {
    let code = match &run.failure {
        Some(failure) if failure.is_want_of_memory() => 4,
        Some(_) => 3,
        None => raised::code(run.summary.ending()),
    };
    let of_lost = |error: &CaseError| {
        if igimp_cases::is_of_the_system(error) {
            4
        } else {
            2
        }
    };
    run.lost.iter().map(of_lost).fold(code, u8::max)
}
