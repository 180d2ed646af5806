//! `igimp sweep --to`.

use std::path::Path;

use igimp_estimate::speed::Speed;
use igimp_estimate::{readable, time, watch};
use igimp_results::folder::overwrite_guard::Replace;
use igimp_study::sweep::{Resources, Sweep, Words, numbers};

use crate::arguments::{Scheduler, SweepArguments};
use crate::error::{Exit, ProgramError};
use crate::output::{self, quoted};

/// Writes the script of a scheduler for the tasks that are not done, and how it is submitted.
pub(crate) fn to(
    scheduler: Scheduler,
    sweep: &Sweep,
    arguments: &SweepArguments,
) -> Result<Exit, ProgramError> {
    if arguments.ranks > 1 && scheduler != Scheduler::Slurm {
        return Err(ProgramError::usage(
            "only Slurm starts tasks of several ranks",
            "--to slurm, or no --ranks",
        ));
    }
    let left = sweep.left()?;
    let threads = arguments.threads.unwrap_or(1);
    let Some(demand) = sweep.demand(&left, (threads, arguments.ranks), Speed::measured()?)? else {
        output::print(&format!(
            "all {} tasks are done; igimp collect {} gathers them",
            sweep.tasks.len(),
            quoted(&arguments.file.display().to_string())
        ))?;
        return Ok(Exit::Done);
    };
    let all = sweep.tasks.len();
    output::print(&format!(
        "{} of {all} tasks are not done: {}\neach is given {}",
        left.len(),
        numbers(&left),
        given(&demand)
    ))?;
    if scheduler == Scheduler::Local {
        return local(&demand, left.len(), arguments);
    }
    // Whose the folder is stands there before many tasks begin at once.
    let _shared = sweep.enter(false, Replace::Finished)?;
    let words = words(&arguments.file, arguments.ranks)?;
    let (script, program) = match scheduler {
        Scheduler::Hyperqueue => (sweep.write_hyperqueue(&left, &demand, &words)?, "hq"),
        _ => (sweep.write_slurm(&left, &demand, &words)?, "sbatch"),
    };
    let path = script.path.display().to_string();
    output::print(&format!("written: {path}\nsubmit it with"))?;
    for [before, behind] in &script.submit {
        output::print(&format!("  {before} {}{behind}", quoted(&path)))?;
    }
    if !is_found(program) {
        output::print_message(&format!(
            "note: {program} is not on this computer; submit where it is, in the same folder"
        ));
    }
    Ok(Exit::Done)
}

/// The resources of a task, and the reason.
fn given(demand: &Resources) -> String {
    let plural = if demand.threads == 1 { "" } else { "s" };
    let ranks = match demand.ranks {
        1 => String::new(),
        ranks => format!("{ranks} ranks of "),
    };
    format!(
        "{}{} thread{plural}, {} MiB and {} min (1.5 times the memory of task {}, about {}; 3 times the time of \
         task {}, about {} here, and 5 min)",
        ranks,
        demand.threads,
        demand.mebibytes(),
        demand.minutes(),
        demand.memory.task,
        readable(demand.memory.estimate),
        demand.time.task,
        time::readable(demand.time.estimate),
    )
}

/// On this computer nothing needs to be written: `--jobs` does it, with as many jobs as have room.
fn local(
    demand: &Resources,
    left: usize,
    arguments: &SweepArguments,
) -> Result<Exit, ProgramError> {
    let cores = rayon::current_num_threads();
    let by_memory = watch::available().map_or(left, |free| {
        (free / (1_048_576.0 * demand.mebibytes() as f64)) as usize
    });
    let jobs = (cores / demand.threads).min(by_memory).min(left).max(1);
    output::print(&format!(
        "nothing is written; run them with\n  igimp sweep {} --jobs {jobs} --threads {}",
        quoted(&arguments.file.display().to_string()),
        jobs * demand.threads
    ))?;
    Ok(Exit::Done)
}

/// The words of a task's command, from the folder where the program runs.
fn words(file: &Path, ranks: usize) -> Result<Words, ProgramError> {
    let here = |source| ProgramError::File {
        path: ".".into(),
        source,
    };
    let mut program = std::env::current_exe().map_err(here)?;
    if ranks > 1 {
        let beside = program.with_file_name("igimp-mpi");
        program = if beside.is_file() {
            beside
        } else {
            "igimp-mpi".into()
        };
    }
    Ok(Words {
        program: quoted(&program.display().to_string()),
        sweep: quoted(&file.display().to_string()),
        folder: std::env::current_dir().map_err(here)?,
        ranks,
    })
}

/// Whether a program stands in one of the folders of `PATH`.
fn is_found(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}
