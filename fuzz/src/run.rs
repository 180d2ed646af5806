//! A run: many executions of a target on several threads.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};
use std::{fs, io, thread};

use crate::input::Input;
use crate::minimise::minimise;
use crate::targets::outcome::{catch_words, outcome};
use crate::targets::{Material, Target, Verdict};
use crate::watch::{LONGEST, MOST_MEMORY, Worker, memory};

/// Executions that a worker takes at a time.
const BLOCK: u64 = 64;
/// Kinds of failure after which a run stops.
const MOST_FINDINGS: usize = 20;
/// Time beyond which an input is worth a note.
const SLOW: Duration = Duration::from_secs(1);

/// What to do.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The reader.
    pub target: Target,
    /// Decides every input together with the number of its execution.
    pub seed: u64,
    /// Number of the first execution; those of the corpus are the first of all.
    pub first: u64,
    /// How many executions.
    pub executions: u64,
    /// On how many threads.
    pub threads: usize,
}

/// An input that a reader does not deal with as it should.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Number of the execution that met it first.
    pub execution: u64,
    /// What does not hold, or with what words the reader panicked.
    pub what: String,
    /// The input, made small.
    pub input: Input,
}

/// What came of a run.
#[derive(Clone, Debug)]
pub struct Report {
    /// The reader.
    pub target: Target,
    /// Executions made.
    pub executions: u64,
    /// Those whose input was accepted.
    pub accepted: u64,
    /// Failures, one of each kind.
    pub findings: Vec<Finding>,
    /// Executions that took more than a second, with the time of a second try.
    pub slow: Vec<(u64, Duration)>,
    /// Time of the run.
    pub elapsed: Duration,
    /// Largest memory of this process so far \[bytes\]; none where the system does not say.
    pub memory: Option<u64>,
}

/// What workers share.
struct Shared<'a> {
    plan: &'a Plan,
    material: &'a Material,
    next: AtomicU64,
    accepted: AtomicU64,
    made: AtomicU64,
    is_over: AtomicBool,
    findings: Mutex<Vec<Finding>>,
    slow: Mutex<Vec<(u64, Duration)>>,
    workers: Vec<Worker>,
}

/// Runs a plan.
///
/// An input that hangs, or memory without bounds, cannot be stopped from within: the run then
/// writes the input to `found`, says so, and ends the program.
pub fn run(plan: &Plan, material: &Material, found: &Path) -> Report {
    catch_words();
    let start = Instant::now();
    let shared = Shared {
        plan,
        material,
        next: AtomicU64::new(plan.first),
        accepted: AtomicU64::new(0),
        made: AtomicU64::new(0),
        is_over: AtomicBool::new(false),
        findings: Mutex::default(),
        slow: Mutex::default(),
        workers: (0..plan.threads.max(1)).map(|_| Worker::new()).collect(),
    };
    thread::scope(|scope| {
        let workers: Vec<_> = shared
            .workers
            .iter()
            .map(|worker| {
                let work = || work(&shared, worker);
                // Readers may recurse as deep as on the main thread of the program.
                thread::Builder::new()
                    .stack_size(8 << 20)
                    .spawn_scoped(scope, work)
            })
            .collect();
        let watch = scope.spawn(|| watch(&shared, found));
        for worker in workers.into_iter().flatten() {
            let _ = worker.join();
        }
        shared.is_over.store(true, Ordering::Release);
        watch.thread().unpark();
    });
    let mut findings = shared.findings.into_inner().unwrap_or_default();
    findings.sort_by_key(|finding| finding.execution);
    Report {
        target: plan.target,
        executions: shared.made.into_inner(),
        accepted: shared.accepted.into_inner(),
        findings,
        slow: shared.slow.into_inner().unwrap_or_default(),
        elapsed: start.elapsed(),
        memory: memory().map(|[_, most]| most),
    }
}

/// Takes executions until none is left.
fn work(shared: &Shared<'_>, worker: &Worker) {
    let Plan {
        target,
        seed,
        first,
        executions,
        ..
    } = *shared.plan;
    let end = first.saturating_add(executions);
    loop {
        let from = shared.next.fetch_add(BLOCK, Ordering::Relaxed);
        if from >= end || shared.is_over.load(Ordering::Relaxed) {
            return;
        }
        for execution in from..end.min(from + BLOCK) {
            let begin = Instant::now();
            worker.begin(execution, begin);
            let input = target.input(shared.material, seed, execution);
            match outcome(target, &input) {
                Ok(Verdict::Accepted) => {
                    shared.accepted.fetch_add(1, Ordering::Relaxed);
                }
                Ok(Verdict::Refused) => {}
                Err(what) => found(shared, execution, what, &input),
            }
            worker.end();
            shared.made.fetch_add(1, Ordering::Relaxed);
            if begin.elapsed() > SLOW {
                again(shared, execution, &input);
            }
        }
    }
}

/// Tries an input once more that took long: the machine may have been busy.
fn again(shared: &Shared<'_>, execution: u64, input: &Input) {
    let begin = Instant::now();
    let _ = outcome(shared.plan.target, input);
    let time = begin.elapsed();
    if let Ok(mut slow) = shared.slow.lock()
        && time > SLOW
    {
        slow.push((execution, time));
    }
}

/// Keeps the first failure of each kind, made small.
fn found(shared: &Shared<'_>, execution: u64, what: String, input: &Input) {
    let kind = kind(&what);
    let Ok(mut findings) = shared.findings.lock() else {
        return;
    };
    if findings
        .iter()
        .any(|finding| self::kind(&finding.what) == kind)
    {
        return;
    }
    let target = shared.plan.target;
    let fails = |input: &Input| outcome(target, input).is_err_and(|what| self::kind(&what) == kind);
    let input = minimise(input, fails);
    findings.push(Finding {
        execution,
        what,
        input,
    });
    if findings.len() >= MOST_FINDINGS {
        shared.is_over.store(true, Ordering::Relaxed);
    }
}

/// What a failure is called: its first words without numbers and quoted texts.
fn kind(what: &str) -> String {
    let head = what.split([':', '`', '"']).next().unwrap_or_default();
    head.chars()
        .filter(|c| !c.is_ascii_digit())
        .take(80)
        .collect()
}

/// Watches the workers, and ends the program when one hangs or memory runs out.
fn watch(shared: &Shared<'_>, found: &Path) {
    while !shared.is_over.load(Ordering::Acquire) {
        thread::park_timeout(Duration::from_millis(500));
        let hanging = shared.workers.iter().filter_map(Worker::hanging);
        let mut suspects: Vec<(u64, String)> = hanging
            .map(|execution| {
                (
                    execution,
                    format!("it takes more than {} s", LONGEST.as_secs()),
                )
            })
            .collect();
        if let Some([now, _]) = memory().filter(|[now, _]| *now > MOST_MEMORY) {
            let under_way = shared.workers.iter().filter_map(Worker::execution);
            let why = format!("memory has grown to {} MiB", now >> 20);
            suspects.extend(under_way.map(|execution| (execution, why.clone())));
        }
        if suspects.is_empty() {
            continue;
        }
        let Plan { target, seed, .. } = *shared.plan;
        for (execution, what) in suspects {
            let input = target.input(shared.material, seed, execution);
            let finding = Finding {
                execution,
                what,
                input,
            };
            eprintln!(
                "{}: execution {execution} of seed {seed}: {}",
                target.name(),
                finding.what
            );
            if let Err(error) = keep(&finding, shared.plan, found) {
                eprintln!("cannot write the input: {error}");
            }
        }
        std::process::exit(1);
    }
}

/// Writes the input of a finding to a folder, and beside it what is wrong with it.
///
/// # Errors
/// What the system says.
pub fn keep(finding: &Finding, plan: &Plan, folder: &Path) -> io::Result<()> {
    let name = format!("{}-{}-{}", plan.target.name(), plan.seed, finding.execution);
    fs::create_dir_all(folder)?;
    let mut about = String::new();
    let _ = writeln!(about, "target {}, seed {}", plan.target.name(), plan.seed);
    let _ = writeln!(about, "execution {}\n{}", finding.execution, finding.what);
    fs::write(folder.join(format!("{name}.txt")), about)?;
    finding.input.write(&folder.join(format!("{name}.input")))
}
