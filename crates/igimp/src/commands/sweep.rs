//! `igimp sweep` and `igimp collect`.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use igimp_cases::run::{Nobody, Start};
use igimp_results::ending::Ending;
use igimp_results::folder::overwrite_guard::Replace;
use igimp_study::narration::lines;
use igimp_study::sweep::{self, Task};

use crate::arguments::{Collect, SweepArguments};
use crate::commands::run::replace;
use crate::error::{Exit, ProgramError};
use crate::{clock, interrupt, output, scheduler};

pub(crate) fn sweep(arguments: &SweepArguments) -> Result<Exit, ProgramError> {
    let flag = interrupt::watch();
    let sweep = sweep::Sweep {
        date: clock::now()?,
        ..sweep::Sweep::read(&arguments.file)?
    };
    let width = sweep.tasks.len().to_string().len();
    let label = |task: &Task| format!("task {:>width$}/{}", task.number, sweep.tasks.len());
    if arguments.list {
        for task in &sweep.tasks {
            output::print(&format!("{}  {}", label(task), task.label()))?;
        }
        return Ok(Exit::Done);
    }
    if let Some(scheduler) = arguments.to {
        return scheduler::to(scheduler, &sweep, arguments);
    }
    let replace = replace(arguments.overwrite);
    let _alone = sweep.enter(true, replace)?;
    let mut worst = Exit::Done;
    let mut left = Vec::new();
    for task in &sweep.tasks {
        if let Some(ending) = sweep.done(task)? {
            worst = worst.max(ending.into());
        } else {
            left.push(task);
        }
    }
    let already = sweep.tasks.len() - left.len();
    if already > 0 {
        output::say(&format!(
            "{already} of {} tasks are done",
            sweep.tasks.len()
        ))?;
    }
    let ends = run_all(&sweep, &left, arguments, &flag, &label)?;
    let interrupted = flag.load(Ordering::SeqCst);
    if interrupted {
        output::print_message(&format!(
            "interrupted after {} of {} tasks; the same command goes on",
            already + ends.len(),
            sweep.tasks.len()
        ));
    }
    for (_, exit) in ends {
        worst = worst.max(exit);
    }
    let table = sweep::collect(&sweep);
    let path = table.write(&sweep.folder)?;
    table.draw(&sweep.folder)?;
    output::say(&format!("{}table in {}", table.to_text(), path.display()))?;
    warn_of_unknown(&table);
    Ok(if interrupted {
        worst.max(Exit::NotConverged)
    } else {
        worst
    })
}

/// Warns of names that are asked for and that no task has.
fn warn_of_unknown(table: &sweep::Collected) {
    for name in &table.unknown {
        output::print_message(&format!(
            "warning: `{name}` is neither a factor of safety nor a check nor a curve of any task"
        ));
    }
}

/// Runs tasks, some at a time, and says how each ended.
fn run_all(
    sweep: &sweep::Sweep,
    left: &[&Task],
    arguments: &SweepArguments,
    flag: &AtomicBool,
    label: &(impl Fn(&Task) -> String + Sync),
) -> Result<Vec<(usize, Exit)>, ProgramError> {
    let replace = replace(arguments.overwrite);
    let jobs = arguments.jobs.min(left.len()).max(1);
    let threads = arguments.threads.unwrap_or_else(rayon::current_num_threads);
    let pools: Vec<rayon::ThreadPool> = (0..jobs)
        .map(|_| {
            rayon::ThreadPoolBuilder::new()
                .num_threads((threads / jobs).max(1))
                .build()
                .map_err(|error| {
                    ProgramError::usage(format!("cannot start {threads} threads: {error}"), "")
                })
        })
        .collect::<Result<_, _>>()?;
    let next = AtomicUsize::new(0);
    let ends = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for pool in &pools {
            let (next, ends) = (&next, &ends);
            scope.spawn(move || {
                while !flag.load(Ordering::SeqCst) {
                    let Some(task) = left.get(next.fetch_add(1, Ordering::SeqCst)) else {
                        break;
                    };
                    let exit = pool.install(|| run_one(sweep, task, replace, flag, label));
                    if let Ok(mut ends) = ends.lock() {
                        ends.push((task.number, exit));
                    }
                }
            });
        }
    });
    Ok(ends.into_inner().unwrap_or_default())
}

/// Runs one task; a failure is reported and recorded, and does not affect the others.
fn run_one(
    sweep: &sweep::Sweep,
    task: &Task,
    replace: Replace,
    flag: &AtomicBool,
    label: &impl Fn(&Task) -> String,
) -> Exit {
    let start = match replace {
        Replace::Everything => Ok(Start::Afresh),
        _ => sweep.start_of(task),
    };
    let run = start.and_then(|start| sweep.run_task(task, start, replace, &mut Nobody, flag));
    let (end, exit) = match run {
        Ok((run, ending)) => {
            let found: Vec<String> = run
                .summary
                .stages
                .iter()
                .filter_map(|stage| stage.safety.as_ref().map(lines::interval))
                .collect();
            let found = found.join(", ");
            (format!("{ending}  {found}"), ending.into())
        }
        Err(error) => {
            let error = ProgramError::from(error);
            output::print_message(&format!("{}\n{}", label(task), error.render()));
            (Ending::Failed.to_string(), error.exit())
        }
    };
    // A log that cannot be written any more does not end the study.
    let line = format!("{}  {}  {end}", label(task), task.label());
    let _ = output::say(line.trim_end());
    exit
}

pub(crate) fn collect(arguments: &Collect) -> Result<Exit, ProgramError> {
    let sweep = sweep::Sweep::read_unchecked(&arguments.file)?;
    let table = sweep::collect(&sweep);
    let path = table.write(&sweep.folder)?;
    table.draw(&sweep.folder)?;
    output::print(&format!("{}table in {}", table.to_text(), path.display()))?;
    warn_of_unknown(&table);
    if let Some(why) = &table.unchecked {
        output::print_message(&format!(
            "warning: results are not held against the case as it is now, which cannot be read\n  because: {why}"
        ));
    }
    let of = sweep.tasks.len();
    let (numbers, file) = (
        |tasks: &[usize]| {
            let each: Vec<String> = tasks.iter().map(usize::to_string).collect();
            format!("{} of {of} tasks: {}", tasks.len(), each.join(", "))
        },
        arguments.file.display(),
    );
    if !table.missing.is_empty() {
        let tasks = numbers(&table.missing);
        output::print_message(&format!(
            "error: no results of {tasks}\n  help: igimp sweep {file} runs them"
        ));
    }
    if !table.outdated.is_empty() {
        let tasks = numbers(&table.outdated);
        output::print_message(&format!(
            "error: results of another case or of other settings of {tasks}\n  help: igimp sweep {file} runs them anew"
        ));
    }
    Ok(if table.missing.is_empty() && table.outdated.is_empty() {
        Exit::Done
    } else {
        Exit::InputOutput
    })
}
