//! `igimp-mpi`: `igimp run` with its linear systems solved by PETSc on several ranks.
//!
//! Rank 0 runs the case in a thread as `igimp` does: particles, assembly, files. Its main thread and those of all other ranks hold
//! the linear systems and call MPI and PETSc. Ranks without work wait for the next command.

mod foreign;
mod layout;
mod method;
mod phases;
mod server;
mod solver;

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::mpsc;
use std::time::Instant;

use igimp_model::GivenSolver;

use crate::foreign::{ForeignError, World};
use crate::method::Method;
use crate::server::Server;
use crate::solver::{PetscSolver, Ranks};

/// Exit codes, as those of igimp.
const BAD_INPUT: u8 = 2;
const FAILED: u8 = 4;

const HELP: &str = "\
Run a case with its linear systems solved by PETSc on several ranks.

Usage: mpirun -n N --bind-to none igimp-mpi run CASE [OPTIONS]

Words after `run` are those of `igimp run`, which lists them with --help. PETSc's own options are read from
PETSC_OPTIONS: -pc_type and those beside it replace all methods, -mumps_... and -gamg_... tune the two that
are taken without.";

fn main() -> ExitCode {
    let world = match World::start() {
        Ok(world) => world,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(FAILED);
        }
    };
    let done = if world.rank == 0 {
        lead(&world)
    } else {
        follow(&world)
    };
    match done.and_then(|code| world.finish().map(|()| code)) {
        Ok(code) => code,
        Err(error) => {
            eprintln!(
                "error: {error}\n  help: what was computed is kept; --resume goes on from the last checkpoint"
            );
            // Others may wait for this rank for ever.
            foreign::abort(i32::from(FAILED));
            ExitCode::from(FAILED)
        }
    }
}

/// Any rank but the first: signals are for rank 0, which ends all.
fn follow(world: &World) -> Result<ExitCode, ForeignError> {
    if let Err(error) = ctrlc::set_handler(|| {}) {
        eprintln!(
            "warning: rank {} ends at the first signal: {error}",
            world.rank
        );
    }
    machines(world)?;
    Method::defaults(world)?;
    Server::new(world).follow()?;
    Ok(ExitCode::SUCCESS)
}

/// Rank 0: the run in a thread, and the ranks served from here.
fn lead(world: &World) -> Result<ExitCode, ForeignError> {
    let begin = Instant::now();
    let machines = machines(world)?;
    Method::defaults(world)?;
    let words: Vec<OsString> = std::env::args_os().skip(1).collect();
    let is_quiet = words.iter().any(|word| word == "--quiet" || word == "-q");
    // A part waits while the one before it is sent, so that the values are not all in memory twice.
    let (requests, asked) = mpsc::sync_channel(1);
    let (answers, replies) = mpsc::channel();
    let by_options = world.has_option("-pc_type")?;
    let ranks = Ranks::new(world.size, machines, by_options, (requests, replies));
    let run = std::thread::Builder::new()
        .name("run".to_owned())
        .spawn(move || run(&words, ranks));
    let (phases, reports) = Server::new(world).serve(&asked, &answers)?;
    let Ok(code) = run.map(std::thread::JoinHandle::join) else {
        return Err(ForeignError::amid("no thread for the run"));
    };
    if !is_quiet && phases.is_used() {
        print!("{}", phases::tables(&phases, &reports, begin.elapsed()));
    }
    // The panic has told of itself.
    Ok(code.unwrap_or(ExitCode::from(FAILED)))
}

/// How many computers the ranks are on; all of them have to ask, and rank 0 is told.
fn machines(world: &World) -> Result<usize, ForeignError> {
    let mut names = vec![world.machine()?.into_bytes()];
    if world.rank > 0 {
        world.send_list(0, &names[0])?;
        return Ok(1);
    }
    for rank in 1..world.size {
        names.push(world.receive_list(rank)?);
    }
    names.sort_unstable();
    names.dedup();
    Ok(names.len())
}

/// The run, with a solver that asks the ranks.
fn run(words: &[OsString], ranks: Ranks) -> ExitCode {
    match words.first().and_then(|word| word.to_str()) {
        Some("run") => {}
        Some("--version" | "-V") => {
            println!("igimp-mpi {}", env!("CARGO_PKG_VERSION"));
            return ExitCode::SUCCESS;
        }
        Some("--help" | "-h") => {
            println!("{HELP}");
            return ExitCode::SUCCESS;
        }
        _ => {
            eprintln!(
                "error: igimp-mpi knows `run` alone\n  help: igimp has the other commands\n\n{HELP}"
            );
            return ExitCode::from(BAD_INPUT);
        }
    }
    let ranks = Arc::new(ranks);
    let given = GivenSolver {
        name: "petsc",
        make: Arc::new(move |case| Box::new(PetscSolver::new(&ranks, case))),
    };
    igimp::program(
        [OsString::from("igimp")]
            .into_iter()
            .chain(words.iter().cloned()),
        Some(&given),
    )
}
