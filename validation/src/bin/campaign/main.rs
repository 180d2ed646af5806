//! Hard numerics: random slopes run to collapse, footings pushed one width deep, and random rigid bodies in
//! soil. Every run has to end with a reason, without a panic, in time, without a step that was accepted above
//! the tolerance and is not at round-off, and without soil in a rigid body. `cargo xtask campaign` calls this
//! program.

mod bodies;
mod bound;
mod distribution;
mod effort;
mod footing;
mod page;
mod random;
mod recheck;
mod slope;
mod tables;
#[cfg(test)]
mod tests;
mod watch;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::{Parser, ValueEnum};
use igimp_cases::{CaseError, chain, is_of_the_system};
use igimp_input::CaseFile;
use igimp_results::ResultsError;

use crate::bodies::Scene;
use crate::footing::Footing;
use crate::slope::Slope;
use crate::watch::{Budget, End, Watched, watch};

/// Exit codes; part of the contract with callers.
const BROKEN: u8 = 1;
const BAD_INPUT: u8 = 2;
const INPUT_OUTPUT: u8 = 4;

/// The budget of any run of the campaign.
const BUDGET: Budget = Budget {
    corrections: 20_000,
    time: Duration::from_secs(900),
    grace: Duration::from_secs(120),
};

/// The budget of a run of random bodies.
const SMALL_BUDGET: Budget = Budget {
    corrections: 5_000,
    time: Duration::from_secs(120),
    grace: Duration::from_secs(60),
};

/// Runs random slopes to collapse, pushes footings deep and random bodies about, and watches how they end.
///
/// Exit codes: 0 every run kept to what is asked; 1 one did not; 2 bad input; 4 a file could not
/// be written.
#[derive(Debug, Parser)]
#[command(name = "campaign", version)]
struct Arguments {
    /// What to run; all when not given.
    #[arg(value_enum)]
    part: Option<Part>,
    /// Number of random slopes.
    #[arg(long, value_name = "N", default_value_t = 100)]
    runs: u64,
    /// Number of scenes with random bodies.
    #[arg(long, value_name = "N", default_value_t = 50)]
    scenes: u64,
    /// Seed of the random slopes and bodies.
    #[arg(long, value_name = "S", default_value_t = 2026)]
    seed: u64,
    /// Run this slope or scene only and print its case file.
    #[arg(long, value_name = "NUMBER")]
    only: Option<u64>,
    /// Cells per width of the footing, odd.
    #[arg(long, value_name = "CELLS", default_value_t = 9)]
    cells: u32,
    /// Write the tables into the book.
    #[arg(long)]
    write: bool,
    /// Folder for the tables.
    #[arg(long, value_name = "DIR", default_value = "target/campaign")]
    out: PathBuf,
    /// Threads that a run uses.
    #[arg(long, value_name = "N", default_value_t = 1)]
    threads: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Random slopes to collapse.
    Slopes,
    /// Footings to one width.
    Footings,
    /// Random rigid bodies in soil.
    Bodies,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match campaign(&arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("{}", chain(&error));
            ExitCode::from(if is_of_the_system(&error) {
                INPUT_OUTPUT
            } else {
                BAD_INPUT
            })
        }
    }
}

fn campaign(arguments: &Arguments) -> Result<u8, CaseError> {
    // Fails only if the pool exists already, which it does not at the start.
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(arguments.threads)
        .build_global();
    std::fs::create_dir_all(&arguments.out).map_err(|source| ResultsError::File {
        path: arguments.out.clone(),
        source,
    })?;
    let runs_part = |part| arguments.part.is_none_or(|only| only == part);
    let mut sound = true;
    if runs_part(Part::Slopes) {
        sound &= slopes(arguments)?;
    }
    if runs_part(Part::Footings) {
        sound &= footings(arguments)?;
    }
    if runs_part(Part::Bodies) {
        sound &= scenes(arguments)?;
    }
    Ok(if sound { 0 } else { BROKEN })
}

/// The numbers of random runs.
fn numbers(arguments: &Arguments, runs: u64) -> std::ops::RangeInclusive<u64> {
    match arguments.only {
        Some(number) => number..=number,
        None => 1..=runs,
    }
}

fn slopes(arguments: &Arguments) -> Result<bool, CaseError> {
    let runs: Vec<(Slope, Watched)> = numbers(arguments, arguments.runs)
        .map(|number| {
            let slope = Slope::random(arguments.seed, number);
            if arguments.only.is_some() {
                println!("{}", slope.case_file());
            }
            let name = format!("slope-{number}.toml");
            let watched = run_text(&name, &slope.case_file(), BUDGET);
            eprintln!("slope {number}: {}", line(&watched));
            (slope, watched)
        })
        .collect();
    let csv = tables::slopes_csv(&runs);
    let markdown = tables::slopes(&runs, arguments.seed);
    report(arguments, "slopes", &csv, &markdown)?;
    Ok(runs.iter().all(|(_, watched)| watched.is_sound()))
}

fn footings(arguments: &Arguments) -> Result<bool, CaseError> {
    let runs: Vec<(Footing, Watched)> = Footing::all(arguments.cells)
        .into_iter()
        .map(|footing| {
            let watched = match footing.case() {
                Ok(case) => watch(case, BUDGET),
                Err(error) => Watched::refused(&error),
            };
            let Footing {
                stiffness, poisson, ..
            } = footing;
            eprintln!(
                "footing E/s_u {stiffness}, nu {poisson}: {}",
                line(&watched)
            );
            (footing, watched)
        })
        .collect();
    let csv = tables::footings_csv(&runs);
    let markdown = tables::footings(&runs);
    report(arguments, "footings", &csv, &markdown)?;
    Ok(runs.iter().all(|(_, watched)| watched.is_sound()))
}

fn scenes(arguments: &Arguments) -> Result<bool, CaseError> {
    let runs: Vec<(Scene, Watched)> = numbers(arguments, arguments.scenes)
        .map(|number| {
            let scene = Scene::random(arguments.seed, number);
            if arguments.only.is_some() {
                println!("{}", scene.case_file());
            }
            let name = format!("bodies-{number}.toml");
            let watched = run_text(&name, scene.case_file(), SMALL_BUDGET);
            eprintln!("bodies {number}: {}", line(&watched));
            (scene, watched)
        })
        .collect();
    let csv = bodies::table::csv(&runs);
    let markdown = bodies::table::markdown(&runs, arguments.seed);
    report(arguments, "bodies", &csv, &markdown)?;
    Ok(runs.iter().all(|(_, watched)| watched.is_sound()))
}

/// Runs a case file under watch.
fn run_text(name: &str, text: &str, budget: Budget) -> Watched {
    match CaseFile::parse(name, text, &[]) {
        Ok(file) => watch(file.into_case(), budget),
        Err(error) => Watched::refused(&error),
    }
}

/// A run in a line, with its problems in lines below.
fn line(watched: &Watched) -> String {
    let effort = &watched.effort;
    let mut text = format!(
        "{} ({}), {} particles, {} steps, {} cuts, {} at round-off, {:.1} s",
        watched.end.label(),
        watched.reason,
        watched.particles,
        effort.corrections.len(),
        effort.cuts,
        effort.at_round_off,
        watched.seconds
    );
    if watched.end == End::Budget || !watched.end.is_orderly() {
        text.push_str("  <-- ended by the watch");
    }
    for violation in effort.violations.iter().chain(&effort.contact).take(3) {
        text.push_str("\n    ");
        text.push_str(violation);
    }
    text
}

/// Prints and writes the tables of a part.
fn report(arguments: &Arguments, name: &str, csv: &str, markdown: &str) -> Result<(), CaseError> {
    println!("{markdown}");
    let path = arguments.out.join(format!("{name}.csv"));
    page::write_file(&path, csv)?;
    println!("every run: {}", path.display());
    if arguments.write {
        page::fill(Path::new(page::PAGE), name, markdown)?;
    }
    Ok(())
}
