//! Developer commands, run as `cargo xtask COMMAND`. Depends on no crate of the project, so that it
//! builds in seconds and works when they do not.

mod bench;
mod book;
mod campaign;
#[cfg(test)]
mod commands_are_run;
#[cfg(test)]
mod commands_on_pages;
mod failure;
mod film;
mod fuzz;
mod mdbook;
mod metadata;
mod mpi;
mod pages;
mod process;
mod python;
mod released;
mod tidy;
mod validate;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Developer commands of the igimp workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Run the cases and hold them against references and snapshots.
    ///
    /// All arguments go to the validation program, and its exit code is passed on: 0 references
    /// met, 1 reference or snapshot missed, 2 bad input, 3 not converged, 4 input or output.
    #[command(disable_help_flag = true)]
    Validate {
        /// Arguments of the validation program; `--help` lists them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Run random slopes to collapse and footings deep, and watch how they end.
    ///
    /// All arguments go to the campaign program, and its exit code is passed on: 0 every run kept
    /// to what is asked, 1 one did not, 2 bad input, 4 input or output.
    #[command(disable_help_flag = true)]
    Campaign {
        /// Arguments of the campaign program; `--help` lists them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Measure speed and memory, and write one report.
    ///
    /// Benches of the kernels, and a survey: cost per particle and iteration, time by phase, rates
    /// against the machine's own, growth with size, memory. The report is `target/bench/bench.md`,
    /// the same numbers are in `target/bench/bench.csv`.
    Bench(bench::Arguments),
    /// Feed damaged inputs to the readers of case files, checkpoints and quantities.
    ///
    /// All arguments go to the fuzzing program (`--target`, `--executions`, `--seed`, …), and its
    /// exit code is passed on: 0 nothing found, 1 something found, 4 input or output. Inputs that
    /// fail are written to `fuzz/found`.
    #[command(disable_help_flag = true)]
    Fuzz {
        /// Arguments of the fuzzing program; `--help` lists them.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Check what the compiler does not: layers, printing, leftovers, licences, links, equations.
    Tidy,
    /// Build the Python package, install it into a virtual environment and run its tests.
    ///
    /// Tools come from the package registry into `target/python`. Without Python 3.10, and where the
    /// registry cannot be reached, this says so and is done.
    Python(python::Arguments),
    /// Build the program for several ranks and run its tests.
    ///
    /// Where PETSc and Open MPI are; elsewhere this says so and is done.
    Mpi,
    /// Build the book in `docs/`, set its mathematics and check its links.
    ///
    /// mdBook is installed into `target/tools` unless it is there.
    Book {
        /// Show it in the browser.
        #[arg(long)]
        open: bool,
    },
    /// Draw the film of the pages anew: it runs a case, which takes seconds, and writes into `docs/`.
    Film,
    /// Build the pages of the crates and set their mathematics.
    Doc {
        /// Show them in the browser.
        #[arg(long)]
        open: bool,
    },
}

fn main() -> ExitCode {
    let result = match Arguments::parse().task {
        Task::Validate { arguments } => validate::run(&arguments),
        Task::Fuzz { arguments } => fuzz::run(&arguments),
        Task::Campaign { arguments } => campaign::run(&arguments),
        Task::Bench(arguments) => bench::run(&arguments),
        Task::Python(arguments) => python::run(&arguments),
        Task::Mpi => mpi::run(),
        Task::Tidy => tidy::run(),
        Task::Film => film::run(),
        Task::Book { open } => book::book(open),
        Task::Doc { open } => book::crates(open),
    };
    match result {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(failure.code)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn validate_takes_any_argument() {
        let given = ["cargo xtask", "validate", "--case", "footing", "--help"];
        let Task::Validate { arguments } = Arguments::try_parse_from(given).unwrap().task else {
            panic!("another task");
        };
        assert_eq!(arguments, given[2..]);
    }
}
