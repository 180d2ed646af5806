//! The command line.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use igimp_schema::quantity::{Dimension, Quantity};
use igimp_study::element::{Measure, StandardTest, name_of};
use igimp_study::fit::Vary;
use igimp_study::threads;
use igimp_text::{MemoryLimit, NoAmount};

const EXIT_CODES: &str = "Exit codes: 0 done, references met; 1 a reference missed; 2 bad input; \
                          3 not converged or interrupted; 4 input or output failed.";

/// Large deformation of soil by the implicit generalised interpolation material point method.
///
/// A problem is one case file: start with `igimp new slope > slope.toml`, look at it with
/// `igimp check slope.toml`, and run it with `igimp run slope.toml`.
#[derive(Debug, Parser)]
#[command(name = "igimp", version, after_help = EXIT_CODES)]
pub(crate) struct CommandLine {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Write a commented case file to standard output.
    New(New),
    /// Check a case file and tell its size.
    Check(CaseArguments),
    /// Print a case file completed with every default.
    Explain(CaseArguments),
    /// Run a case, or one task of a sweep.
    Run(RunArguments),
    /// Make the report of a results folder again.
    Report(Report),
    /// Test the law of a material on its own, as in the laboratory.
    Element(ElementArguments),
    /// Find parameters of a material from data of the laboratory, and how well each is known.
    Fit(FitArguments),
    /// Look at a results folder in the browser.
    View(View),
    /// Make a film of the frames of a results folder.
    Film(FilmArguments),
    /// Run a parameter study.
    Sweep(SweepArguments),
    /// Gather the results of a parameter study in one table.
    Collect(Collect),
    /// Run the built-in cases and hold them against their references.
    Validate(Validate),
    /// Print the JSON Schema of case files, for editors.
    Schema,
    /// Print completions for a shell.
    Completions(Completions),
    /// Print the manual page, or write one page a command.
    Man(Man),
}

#[derive(Debug, Args)]
pub(crate) struct New {
    /// Name of a template; without one they are listed.
    pub(crate) template: Option<String>,
    /// List the templates.
    #[arg(long, conflicts_with = "template")]
    pub(crate) list: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CaseArguments {
    /// Case file; - reads standard input.
    pub(crate) case: PathBuf,
    /// Replace a value of the file, as in materials.clay.cohesion="12 kPa" (may be repeated).
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Compute the case on so many meshes, of h, h/2 and h/4, for the error of the mesh.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=3))]
    pub(crate) meshes: Option<u8>,
    /// Most memory for factors in space, as "12 GiB" or "25 %" of what the computer has; without it that of the case,
    /// that of the environment (IGIMP_MEMORY), or half of what the computer has.
    #[arg(long, value_name = "AMOUNT", value_parser = amount_of_memory)]
    pub(crate) memory: Option<String>,
}

impl CaseArguments {
    /// All that replaces values of the file.
    pub(crate) fn settings(&self) -> Vec<String> {
        with_short_ways(&self.set, self.meshes, self.memory.as_deref())
    }
}

impl RunArguments {
    /// All that replaces values of the file.
    pub(crate) fn settings(&self) -> Vec<String> {
        with_short_ways(&self.set, self.meshes, self.memory.as_deref())
    }
}

/// `--meshes` and `--memory` are short ways to set a value.
fn with_short_ways(set: &[String], meshes: Option<u8>, memory: Option<&str>) -> Vec<String> {
    let study = meshes.map(|meshes| format!("mesh_study.meshes={meshes}"));
    let memory = memory.map(|memory| format!("solver.memory={memory}"));
    set.iter().cloned().chain(study).chain(memory).collect()
}

fn amount_of_memory(text: &str) -> Result<String, NoAmount> {
    text.parse().map(|_: MemoryLimit| text.to_owned())
}

// Each switch is its own flag on the command line.
#[allow(clippy::struct_excessive_bools)]
#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    /// Case file, - for standard input; with --task a sweep file.
    pub(crate) case: PathBuf,
    /// Results folder; the one named in the case when not given.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace a value of the file, as in materials.clay.cohesion="12 kPa" (may be repeated).
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Compute the case on so many meshes, of h, h/2 and h/4, for the error of the mesh.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=3), conflicts_with = "task")]
    pub(crate) meshes: Option<u8>,
    /// Most memory for factors in space, as "12 GiB" or "25 %" of what the computer has; without it that of the case,
    /// that of the environment (IGIMP_MEMORY), or half of what the computer has.
    #[arg(long, value_name = "AMOUNT", value_parser = amount_of_memory, conflicts_with = "task")]
    pub(crate) memory: Option<String>,
    /// Threads to use; all cores when not given.
    #[arg(long, value_name = "N", value_parser = a_number_of_threads)]
    pub(crate) threads: Option<usize>,
    /// Go on from the newest checkpoint in the results folder; with --task, also leave a task alone that is done, and
    /// wait for one that another program runs.
    #[arg(long)]
    pub(crate) resume: bool,
    /// Begin afresh where a stopped run could go on, or another case has its results.
    #[arg(long, conflicts_with_all = ["resume", "from_stage"])]
    pub(crate) overwrite: bool,
    /// Begin with a stage, from the saved end of the one before it.
    #[arg(long, value_name = "NAME", conflicts_with = "resume")]
    pub(crate) from_stage: Option<String>,
    /// Run this task of a sweep, numbered from 1.
    #[arg(long, value_name = "N", conflicts_with_all = ["out", "set", "from_stage"])]
    pub(crate) task: Option<usize>,
    /// Write a linear system of every stage into this folder, for other solvers.
    #[arg(long, value_name = "DIR", conflicts_with = "task")]
    pub(crate) export_matrix: Option<PathBuf>,
    /// Print the verdict only.
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Report {
    /// Results folder.
    pub(crate) folder: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct ElementArguments {
    /// Case file, or a file with `igimp = 1` and materials alone.
    pub(crate) file: PathBuf,
    /// The material; needed where the file has several.
    #[arg(long, value_name = "NAME")]
    pub(crate) material: Option<String>,
    /// The test.
    #[arg(long, value_name = "TEST", default_value = "triaxial-drained", value_parser = a_test())]
    pub(crate) test: String,
    /// A path of one's own in place of a test: a CSV file with columns such as strain_yy `[%]` and stress_xx `[kPa]`,
    /// compression positive, and a row for the end of every leg.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["test", "strain"])]
    pub(crate) path: Option<PathBuf>,
    /// Initial axial stress, effective, compression positive.
    #[arg(long, value_name = "STRESS", default_value = "100 kPa", value_parser = a_stress)]
    pub(crate) stress: f64,
    /// Initial stress at the sides, effective; the axial one when not given.
    #[arg(long, value_name = "STRESS", value_parser = a_stress)]
    pub(crate) side_stress: Option<f64>,
    /// Natural axial strain in percent at the end, compression positive, or shear strain of tests in shear.
    #[arg(long, value_name = "PERCENT", default_value = "20", allow_negative_numbers = true, value_parser = a_percentage)]
    pub(crate) strain: f64,
    /// Steps of the test, or of a leg of a path.
    #[arg(long, value_name = "N", default_value = "200", value_parser = at_least_one)]
    pub(crate) steps: usize,
    /// How long the test takes, or a leg of a path: the rate of strain of clay with `rate`; none: its reference rate.
    #[arg(long, value_name = "TIME", default_value = "0 s", value_parser = a_time)]
    pub(crate) duration: f64,
    /// Linear strain and stress per initial area, in place of natural strain and Cauchy stress.
    #[arg(long)]
    pub(crate) small_strain: bool,
    /// Data of the laboratory, drawn over the curves: a CSV file with the columns of element.csv that were measured.
    #[arg(long, value_name = "FILE")]
    pub(crate) data: Option<PathBuf>,
    /// Replace a value of the file, as in materials.clay.cohesion="12 kPa" (may be repeated).
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Folder of the report, tables and pictures; results/element-MATERIAL-TEST when not given.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct FitArguments {
    /// Case file, or a file with `igimp = 1` and materials alone; its values are where the search begins.
    pub(crate) file: PathBuf,
    /// The material; needed where the file has several.
    #[arg(long, value_name = "NAME")]
    pub(crate) material: Option<String>,
    /// A parameter to find, a key of the material such as friction, or with bounds "friction=20 deg..40 deg" (may be repeated).
    #[arg(long, value_name = "KEY", required = true)]
    pub(crate) vary: Vec<Vary>,
    /// Data of a test: a CSV file with the columns of element.csv that were measured (repeated for several tests).
    #[arg(long, value_name = "FILE", required = true)]
    pub(crate) data: Vec<PathBuf>,
    /// The test of the data, or the CSV file of a path; once, or once for each data in their order.
    #[arg(long, value_name = "TEST", default_value = "triaxial-drained")]
    pub(crate) test: Vec<String>,
    /// Initial axial stress, effective, compression positive; once, or once for each data.
    #[arg(long, value_name = "STRESS", default_value = "100 kPa", value_parser = a_stress)]
    pub(crate) stress: Vec<f64>,
    /// Initial stress at the sides, effective; the axial one when not given; once, or once for each data.
    #[arg(long, value_name = "STRESS", value_parser = a_stress)]
    pub(crate) side_stress: Vec<f64>,
    /// Standard deviation of what is measured, as in "q=2 kPa" (may be repeated); without it the same share of the largest value.
    #[arg(long, value_name = "QUANTITY=VALUE", value_parser = a_scatter)]
    pub(crate) scatter: Vec<(Measure, f64)>,
    /// Steps of a test, or of a leg of a path; there is a stop at every measurement besides.
    #[arg(long, value_name = "N", default_value = "200", value_parser = at_least_one)]
    pub(crate) steps: usize,
    /// How long the test takes, or a leg of a path: the rate of strain of clay with `rate`; none: its reference rate.
    #[arg(long, value_name = "TIME", default_value = "0 s", value_parser = a_time)]
    pub(crate) duration: f64,
    /// Linear strain and stress per initial area, in place of natural strain and Cauchy stress.
    #[arg(long)]
    pub(crate) small_strain: bool,
    /// Replace a value of the file, as in materials.clay.cohesion="12 kPa" (may be repeated).
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
    /// Folder of the report, tables and pictures; results/fit-MATERIAL when not given.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct View {
    /// Results folder; its run may still be going on. Of a test or a fit the report is opened.
    pub(crate) folder: PathBuf,
    /// Results folder of another run, shown beside it: frames and fields are chosen for both.
    #[arg(long, value_name = "DIR")]
    pub(crate) beside: Option<PathBuf>,
    /// Print the address, and open no browser.
    #[arg(long)]
    pub(crate) no_open: bool,
}

#[derive(Debug, Args)]
pub(crate) struct FilmArguments {
    /// Results folder of a run in plane strain.
    pub(crate) folder: PathBuf,
    /// Field that is shown; the speed of a motion, else the displacement, when not given.
    #[arg(long, value_name = "FIELD")]
    pub(crate) field: Option<String>,
    /// Stage that is shown; the last motion, else the whole run, when not given.
    #[arg(long, value_name = "NAME")]
    pub(crate) stage: Option<String>,
    /// How fast a motion is shown: 1 as fast as it was, 0.1 ten times slower.
    #[arg(long, value_name = "FACTOR", value_parser = a_pace)]
    pub(crate) pace: Option<f64>,
    /// Width in pixels.
    #[arg(long, value_name = "N", default_value = "800", value_parser = clap::value_parser!(u32).range(200..=4000))]
    pub(crate) width: u32,
    /// File of the film, an animated GIF; figures/film-FIELD.gif in the folder when not given.
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SweepArguments {
    /// Sweep file.
    #[arg(value_name = "SWEEP")]
    pub(crate) file: PathBuf,
    /// Tasks that run at the same time.
    #[arg(long, value_name = "N", default_value = "1", value_parser = at_least_one)]
    pub(crate) jobs: usize,
    /// Threads to use in all, all cores when not given; with --to those of a task, 1 when not given.
    #[arg(long, value_name = "N", value_parser = a_number_of_threads)]
    pub(crate) threads: Option<usize>,
    /// Begin tasks afresh that were stopped, and replace those of another sweep.
    #[arg(long)]
    pub(crate) overwrite: bool,
    /// List the tasks and their settings, and run none.
    #[arg(long)]
    pub(crate) list: bool,
    /// Run none, and write what a scheduler needs to run those that are not done.
    #[arg(long, value_name = "SCHEDULER", conflicts_with_all = ["jobs", "overwrite", "list"])]
    pub(crate) to: Option<Scheduler>,
    /// Ranks of a task, started by Slurm with igimp-mpi in place of igimp.
    #[arg(long, value_name = "N", requires = "to", default_value = "1", value_parser = at_least_one)]
    pub(crate) ranks: usize,
}

/// The scheduler that starts the tasks of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Scheduler {
    /// A batch script with an array job.
    Slurm,
    /// A job file.
    Hyperqueue,
    /// This computer: the command that does it, with as many jobs as have room.
    Local,
}

#[derive(Debug, Args)]
pub(crate) struct Collect {
    /// Sweep file.
    #[arg(value_name = "SWEEP")]
    pub(crate) file: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct Validate {
    /// Cases to run; all that declare references when none is named.
    pub(crate) names: Vec<String>,
    /// Only cases of little work.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Folder for results; none are written when not given.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Threads to use; all cores when not given.
    #[arg(long, value_name = "N", value_parser = a_number_of_threads)]
    pub(crate) threads: Option<usize>,
}

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// Shell.
    pub(crate) shell: Shell,
}

#[derive(Debug, Args)]
pub(crate) struct Man {
    /// Write one page a command into this folder.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("must be at least 1".to_owned()),
        Ok(number) => Ok(number),
        Err(_) => Err("expected a whole number".to_owned()),
    }
}

fn a_number_of_threads(text: &str) -> Result<usize, String> {
    let threads = at_least_one(text)?;
    threads::refusal(threads).map_or(Ok(threads), Err)
}

fn a_test() -> PossibleValuesParser {
    PossibleValuesParser::new(StandardTest::ALL.map(name_of))
}

fn a_stress(text: &str) -> Result<f64, String> {
    Quantity::parse_as(text, Dimension::Stress)
        .map_err(|error| format!("{error}; {}", error.help(Some(Dimension::Stress))))
}

fn a_time(text: &str) -> Result<f64, String> {
    match Quantity::parse_as(text, Dimension::Time) {
        Ok(time) if time >= 0.0 => Ok(time),
        Ok(_) => Err("a test takes no negative time".to_owned()),
        Err(error) => Err(format!("{error}; {}", error.help(Some(Dimension::Time)))),
    }
}

fn a_scatter(text: &str) -> Result<(Measure, f64), String> {
    let form = || "expected a quantity and a positive value such as \"q=2 kPa\"".to_owned();
    let (name, value) = text.split_once('=').ok_or_else(form)?;
    let measure = Measure::of_name(name.trim()).ok_or_else(|| {
        let names = Measure::ALL.map(Measure::name).join(", ");
        format!("quantities are {names}")
    })?;
    let value = measure.value(value).filter(|value| *value > 0.0);
    Ok((measure, value.ok_or_else(form)?))
}

fn a_percentage(text: &str) -> Result<f64, String> {
    match text.trim().trim_end_matches('%').trim_end().parse() {
        Ok(number) if (-1000.0..=1000.0).contains(&number) => Ok(number / 100.0),
        _ => Err("expected a percentage such as 20".to_owned()),
    }
}

fn a_pace(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(pace) if (1e-6..=1e6).contains(&pace) => Ok(pace),
        _ => Err("expected a number such as 1 or 0.1".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_makes_sense() {
        CommandLine::command().debug_assert();
    }
}
