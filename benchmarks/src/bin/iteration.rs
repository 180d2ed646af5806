//! `iteration` solves the tangents of cubes of soil by factorisation and by iteration with multigrid, and prints a table in
//! Markdown: unknowns, iterations and processor time by state, size and solver. Each row is measured in a process of its own, so
//! that its memory is its own.

use std::error::Error;
use std::fs;
use std::process::{Command, ExitCode};

use clap::Parser;
use igimp_benchmarks::BenchResult;
use igimp_benchmarks::block::{Block, Soil};
use igimp_benchmarks::pass::Pass;
use igimp_linear::SolverKind;
use igimp_material::TangentKind;

/// Relative residual that is asked for \[-\].
const ASKED: f64 = 1e-8;

/// The states: soil and Poisson's ratio.
const STATES: [(Soil, f64); 6] = [
    (Soil::HenckyElastic, 0.3),
    (Soil::HenckyElastic, 0.49),
    (Soil::VonMises, 0.3),
    (Soil::VonMises, 0.45),
    (Soil::VonMises, 0.49),
    (Soil::MohrCoulomb, 0.3),
];

/// Solves the tangents of cubes of soil.
#[derive(Debug, Parser)]
struct Arguments {
    /// Cells along a side.
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "12,20")]
    cells: Vec<usize>,
    /// Solvers by name: multigrid, direct, auto.
    #[arg(
        long,
        value_name = "NAME",
        value_delimiter = ',',
        default_value = "multigrid,direct"
    )]
    solver: Vec<String>,
    /// Share of the elastic tangent in that of soil that yields (theory, eq. 25e).
    #[arg(long, value_name = "SHARE", default_value = "0")]
    elastic: f64,
    /// Threads to use.
    #[arg(long, value_name = "N", default_value = "1")]
    threads: usize,
    /// Only the state with this number, from 0, and one size and solver: what a row starts.
    #[arg(long, hide = true)]
    row: Option<usize>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match arguments.row {
        Some(state) => row(&arguments, state),
        None => table(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Starts one process for each row.
fn table(arguments: &Arguments) -> BenchResult {
    println!(
        "| state | unknowns | method | iterations | set-up [s] | solution [s] | memory [GiB] |"
    );
    println!("|---|---:|---|---:|---:|---:|---:|");
    for state in 0..STATES.len() {
        for cells in &arguments.cells {
            for solver in &arguments.solver {
                let mut row = Command::new(std::env::current_exe()?);
                row.args(["--row", &state.to_string(), "--cells", &cells.to_string()]);
                row.args([
                    "--solver",
                    solver,
                    "--threads",
                    &arguments.threads.to_string(),
                    "--elastic",
                    &arguments.elastic.to_string(),
                ]);
                row.status()?;
            }
        }
    }
    Ok(())
}

/// Measures one row.
fn row(arguments: &Arguments, state: usize) -> BenchResult {
    let pool = rayon::ThreadPoolBuilder::new();
    pool.num_threads(arguments.threads).build_global()?;
    let (soil, poisson) = *STATES.get(state).ok_or("no such state")?;
    let cells = *arguments.cells.first().ok_or("no size")?;
    let mut solver = match arguments.solver.first().map(String::as_str) {
        Some("multigrid") => SolverKind::Multigrid.build(),
        Some("direct") if soil == Soil::MohrCoulomb => SolverKind::Multifrontal.build(),
        Some("direct") => SolverKind::MultifrontalCholesky.build(),
        Some("auto") => SolverKind::Auto.build(),
        _ => return Err("there are multigrid, direct and auto".into()),
    };
    let block: Block<3> = Block::with_poisson(soil, poisson, cells)?;
    let (matrix, rhs) = {
        let stencils = block.stencils()?;
        let elastic = arguments.elastic;
        let kind = TangentKind::Regularised { elastic };
        Pass::with_tangent(&block, &stencils, kind)?.equations()?
    };
    let held = status("VmRSS")?;
    solver.ask_for(ASKED);
    let start = processor_time()?;
    solver.factor(&matrix)?;
    let set_up = processor_time()?;
    let mut solution = vec![0.0; rhs.len()];
    let report = solver.solve(&matrix, &rhs, &mut solution)?;
    let end = processor_time()?;
    let effort = solver.effort();
    let lost = if effort.lost_iterations > 0 {
        format!(" ({} lost)", effort.lost_iterations)
    } else {
        String::new()
    };
    println!(
        "| {}, ν = {poisson} | {} | {}{lost} | {} | {:.2} | {:.2} | {:.2} |",
        soil.name(),
        rhs.len(),
        report.method,
        report.refinements,
        set_up - start,
        end - set_up,
        status("VmHWM")? - held,
    );
    Ok(())
}

/// Processor time of all threads of this process \[s\].
fn processor_time() -> BenchResult<f64> {
    let mut total = 0.0;
    for task in fs::read_dir("/proc/self/task")? {
        let text = fs::read_to_string(task?.path().join("schedstat"))?;
        let nanoseconds: f64 = text.split_whitespace().next().unwrap_or("0").parse()?;
        total += 1e-9 * nanoseconds;
    }
    Ok(total)
}

/// A figure of the status of this process \[GiB\].
fn status(key: &str) -> Result<f64, Box<dyn Error>> {
    let status = fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find(|line| line.starts_with(key));
    let number = line.and_then(|line| line.split_whitespace().nth(1));
    let kibibytes: f64 = number.ok_or("the system does not tell")?.parse()?;
    Ok(kibibytes / f64::from(1 << 20))
}
