//! What no single bench can say: cost of a Newton iteration with everything in it, time by phase of
//! whole steps, factorisation against the machine's own peak, traffic against its own bandwidth,
//! growth with size, memory. `cargo xtask bench` runs it and puts its tables into the report.
//!
//! The machine may be shared and its clock may drift. What is compared is therefore measured in
//! turn, round after round, and the figure is the median over the rounds of the ratio within one.

mod cost;
mod factorisation;
mod growth;
mod memory;
mod motion;
mod plot;
mod report;
mod rounds;
mod scope;
mod space;
mod step;
mod yardstick;

use std::path::PathBuf;

use clap::Parser;
use igimp_benchmarks::BenchResult;
use scope::Scope;

/// Measures the workspace as a whole and writes tables, rows and a plot.
#[derive(Debug, Parser)]
struct Arguments {
    /// Folder for `tables.md`, `rows.csv` and the plot; it is made.
    #[arg(long)]
    folder: Option<PathBuf>,
    /// Few rounds and small sizes: for a first impression.
    #[arg(long)]
    quick: bool,
    /// Only sections whose name, such as `survey/cost`, contains this.
    #[arg(long, default_value = "")]
    filter: String,
    /// Prints the memory that a block needs, and does nothing else.
    #[arg(
        long,
        value_name = "METHOD CELLS",
        num_args = 2,
        conflicts_with = "folder"
    )]
    memory_of: Option<Vec<String>>,
}

/// A part of the survey.
type Section = fn(&mut Scope) -> BenchResult;

/// The parts by name, in the order of the report.
const SECTIONS: [(&str, Section); 7] = [
    ("survey/step", step::run),
    ("survey/motion", motion::run),
    ("survey/cost", cost::run),
    ("survey/factorisation", factorisation::run),
    ("survey/growth", growth::run),
    ("survey/memory", memory::run),
    ("survey/space", space::run),
];

fn main() -> BenchResult {
    let arguments = Arguments::parse();
    if let Some(of) = &arguments.memory_of {
        return memory::print(of);
    }
    let mut scope = Scope::new(arguments.quick)?;
    for (name, section) in SECTIONS {
        if name.contains(&arguments.filter) {
            eprintln!("{name}");
            section(&mut scope)?;
        }
    }
    let folder = arguments.folder.unwrap_or_else(|| PathBuf::from("."));
    scope.report.write(&folder)?;
    plot::write(&scope.curves, &folder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }
}
