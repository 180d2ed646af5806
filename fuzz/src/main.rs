//! `cargo xtask fuzz`: runs the targets, writes what is found, prints what was done.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::thread;

use clap::Parser;
use igimp_fuzz::run::{Plan, Report, keep, run};
use igimp_fuzz::targets::Target;

/// Feeds damaged inputs to the readers of case files, checkpoints and quantities.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask fuzz", bin_name = "cargo xtask fuzz")]
struct Arguments {
    /// Reader: case, checkpoint or quantity; without it all three.
    #[arg(long, value_parser = target)]
    target: Option<Target>,
    /// Executions of each target.
    #[arg(long, default_value_t = 100_000)]
    executions: u64,
    /// Decides all inputs together with the number of the execution.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of the first execution, to meet a failure again.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Threads; all processors without it. Inputs do not depend on it.
    #[arg(long)]
    threads: Option<usize>,
    /// Folder for inputs that fail.
    #[arg(long, default_value = "fuzz/found")]
    found: PathBuf,
}

fn target(name: &str) -> Result<Target, String> {
    let found = Target::ALL.into_iter().find(|target| target.name() == name);
    found.ok_or_else(|| "targets are case, checkpoint and quantity".to_owned())
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let targets = arguments
        .target
        .map_or(Target::ALL.to_vec(), |target| vec![target]);
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let mut is_fine = true;
    println!("target     seed executions accepted   per s   peak found slow");
    for target in targets {
        let material = match target.material(&corpus) {
            Ok(material) => material,
            Err(error) => {
                eprintln!("error: cannot read the corpus: {error}");
                return ExitCode::from(4);
            }
        };
        let plan = Plan {
            target,
            seed: arguments.seed,
            first: arguments.first,
            executions: arguments.executions,
            threads: arguments
                .threads
                .unwrap_or_else(|| thread::available_parallelism().map_or(1, usize::from)),
        };
        let report = run(&plan, &material, &arguments.found);
        print(&report, &plan);
        for finding in &report.findings {
            is_fine = false;
            println!("  execution {}: {}", finding.execution, finding.what);
            if let Err(error) = keep(finding, &plan, &arguments.found) {
                eprintln!(
                    "error: cannot write to {}: {error}",
                    arguments.found.display()
                );
                return ExitCode::from(4);
            }
        }
        for (execution, time) in &report.slow {
            println!("  execution {execution} takes {:.1} s", time.as_secs_f64());
        }
    }
    if is_fine {
        ExitCode::SUCCESS
    } else {
        println!("inputs that fail are in {}", arguments.found.display());
        ExitCode::from(1)
    }
}

/// A line of the table.
fn print(report: &Report, plan: &Plan) {
    let rate = report.executions as f64 / report.elapsed.as_secs_f64();
    let memory = report
        .memory
        .map_or("-".to_owned(), |bytes| format!("{} M", bytes >> 20));
    println!(
        "{:10} {:4} {:10} {:8} {rate:7.0} {memory:>6} {:5} {:4}",
        report.target.name(),
        plan.seed,
        report.executions,
        report.accepted,
        report.findings.len(),
        report.slow.len(),
    );
}
