//! Runs the four benchmark cases of the paper and problems with exact answers, holds every result
//! against outside values, and compares curves and effort with snapshots. `cargo xtask validate`
//! calls this program.

mod anisotropic_slope;
mod column;
mod comparisons;
mod contact;
mod continuum;
mod exact;
mod footing;
mod harness;
mod layers;
mod limit;
mod limit_equilibrium;
mod manufactured;
mod mesh_study;
mod mohr_coulomb_slope;
mod motion;
mod pictures;
mod pseudo_static;
mod reinforcement;
mod runs;
mod slope_profile;
mod slopes;
mod softening_footing;
mod space;
mod stages;
mod strength_profile;
mod tilted_layer;
mod von_mises_slope;
mod water;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use clap::{Parser, ValueEnum};
use igimp_cases::{CaseError, is_of_the_system};
use igimp_results::ResultsError;
use rayon::prelude::*;

use crate::harness::review::Difference;
use crate::harness::study::{Level, Study};

/// Exit codes; part of the contract with callers.
const REFERENCE_MISSED: u8 = 1;
const BAD_INPUT: u8 = 2;
const NOT_CONVERGED: u8 = 3;
const INPUT_OUTPUT: u8 = 4;

/// Runs the benchmark cases and holds them against outside values and snapshots.
///
/// Exit codes: 0 all met; 1 a reference or a snapshot missed; 2 bad input; 3 a run that had to
/// reach its end did not; 4 a file could not be written.
// Each switch is its own flag on the command line.
#[allow(clippy::struct_excessive_bools)]
#[derive(Debug, Parser)]
#[command(name = "validate", version)]
struct Arguments {
    /// Run only these cases (may be repeated).
    #[arg(long, value_enum, value_name = "CASE")]
    case: Vec<Case>,
    /// Coarse meshes and short runs: under a minute.
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// Finer meshes and further variants too.
    #[arg(long)]
    full: bool,
    /// Rewrite the snapshots with today's results.
    #[arg(long)]
    accept: bool,
    /// Accept what an earlier run left beside the snapshots, without running anything.
    #[arg(long, conflicts_with_all = ["case", "quick", "full", "accept", "matrix", "out", "threads"])]
    accept_left: bool,
    /// Rewrite the verification matrix in the book with today's results, at the full level; of some cases their sections.
    #[arg(long, requires = "full")]
    matrix: bool,
    /// Folder for tables, pictures and the summary.
    #[arg(long, value_name = "DIR", default_value = "target/validation")]
    out: PathBuf,
    /// Folder of the snapshots; those of the workspace when not given.
    #[arg(long, value_name = "DIR")]
    snapshots: Option<PathBuf>,
    /// Threads to use; all cores when not given.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
// In the order of the printed table; started from the last one, which takes longest.
enum Case {
    Column,
    VonMisesSlope,
    MohrCoulombSlope,
    Footing,
    Manufactured,
    Cylinder,
    Revolution,
    Cook,
    NotchedStrip,
    Prism,
    Elastica,
    Slopes,
    Limit,
    MeshStudy,
    TiltedLayer,
    PseudoStatic,
    Layers,
    StrengthProfile,
    SlopeProfile,
    AnisotropicSlope,
    SofteningFooting,
    ReinforcementBar,
    ReinforcementSeam,
    ReinforcementCut,
    Water,
    Stages,
    FootingContact,
    ContactFooting,
    ContactColumn,
    ContactIncline,
    ContactPatch,
    ContactHertz,
    ContactPunch,
    ContactStrip,
    ContactWedge,
    ContactEmbedded,
    ContactPipe,
    ContactAnchor,
    ContactWall,
    ContactPlaces,
    ContactFitted,
    ContactDeep,
    ContactBar,
    SpaceColumn,
    SpaceSlice,
    SpaceSafety,
    SpaceWalls,
    SpaceSphere,
    SpaceCryer,
    SpaceTorsion,
    ContactSpace,
    ContactSphere,
    ContactCircle,
    Motion,
    Comparisons,
}

impl Arguments {
    /// Folder of the snapshots, from the root of the file system: insta takes another path as one beside
    /// the source.
    fn snapshots(&self) -> Result<PathBuf, CaseError> {
        let folder = self
            .snapshots
            .clone()
            .unwrap_or_else(harness::review::snapshots);
        let absolute = std::path::absolute(&folder).map_err(|source| ResultsError::File {
            path: folder,
            source,
        });
        Ok(absolute?)
    }
}

impl Case {
    fn study(self, level: Level, out: &Path) -> Result<Study, CaseError> {
        match self {
            Self::Column => column::study(out),
            Self::VonMisesSlope => von_mises_slope::study(level, out),
            Self::MohrCoulombSlope => mohr_coulomb_slope::study(level, out),
            Self::Footing => footing::study(level, out),
            Self::Manufactured => manufactured::study(level, out),
            Self::Cylinder => continuum::cylinder::study(level, out),
            Self::Revolution => continuum::revolution::study(level, out),
            Self::Cook => continuum::cook::study(level, out),
            Self::NotchedStrip => continuum::notched_strip::study(level, out),
            Self::Prism => continuum::prism::study(out),
            Self::Elastica => continuum::elastica::study(level, out),
            Self::Slopes => slopes::study(level, out),
            Self::Limit => limit::study(level, out),
            Self::MeshStudy => mesh_study::study(level, out),
            Self::PseudoStatic => pseudo_static::study(level, out),
            Self::TiltedLayer => tilted_layer::study(level, out),
            Self::Layers => layers::study(out),
            Self::StrengthProfile => strength_profile::study(level, out),
            Self::SlopeProfile => slope_profile::study(level, out),
            Self::AnisotropicSlope => anisotropic_slope::study(level, out),
            Self::SofteningFooting => softening_footing::study(level, out),
            Self::ReinforcementBar => reinforcement::bar::study(out),
            Self::ReinforcementSeam => reinforcement::seam::study(level, out),
            Self::ReinforcementCut => reinforcement::cut::study(level, out),
            Self::Water => water::study(level, out),
            Self::Stages => stages::study(out),
            Self::FootingContact => footing::contact::study(level, out),
            Self::ContactFooting => contact::footing::study(level, out),
            Self::ContactColumn => contact::column::study(out),
            Self::ContactIncline => contact::incline::study(out),
            Self::ContactPatch => contact::patch::study(out),
            Self::ContactHertz => contact::hertz::study(level, out),
            Self::ContactPunch => contact::punch::study(level, out),
            Self::ContactStrip => contact::strip::study(level, out),
            Self::ContactWedge => contact::wedge::study(level, out),
            Self::ContactEmbedded => contact::embedded::study(level, out),
            Self::ContactPipe => contact::pipe::study(level, out),
            Self::ContactAnchor => contact::anchor::study(level, out),
            Self::ContactWall => contact::wall::study(level, out),
            Self::ContactPlaces => contact::places::study(level, out),
            Self::ContactFitted => contact::places::fitted(level, out),
            Self::ContactDeep => contact::buried::deep::study(level, out),
            Self::ContactBar => contact::buried::bar::study(level, out),
            Self::SpaceColumn => space::column::study(out),
            Self::SpaceSlice => space::slice::study(out),
            Self::SpaceSafety => space::safety::study(level, out),
            Self::SpaceWalls => space::walls::study(level, out),
            Self::SpaceSphere => space::sphere::study(level, out),
            Self::SpaceCryer => space::cryer::study(level, out),
            Self::SpaceTorsion => space::torsion::study(level, out),
            Self::ContactSpace => contact::space::study(level, out),
            Self::ContactSphere => contact::space::sphere::study(level, out),
            Self::ContactCircle => contact::space::circle::study(level, out),
            Self::Motion => motion::study(level, out),
            Self::Comparisons => comparisons::study(level, out),
        }
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if arguments.accept && std::env::var_os("INSTA_UPDATE").is_none_or(|value| value != "always") {
        return again_with_update();
    }
    let ended = if arguments.accept_left {
        accept_left(arguments.snapshots())
    } else {
        validate(&arguments)
    };
    match ended {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            report_error(&error);
            ExitCode::from(exit_code(&error))
        }
    }
}

fn report_error(error: &CaseError) {
    eprintln!("error: {error}");
    let mut source = error.source();
    while let Some(cause) = source {
        eprintln!("  because: {cause}");
        source = cause.source();
    }
}

fn exit_code(error: &CaseError) -> u8 {
    if is_of_the_system(error) {
        INPUT_OUTPUT
    } else {
        BAD_INPUT
    }
}

/// Snapshots are rewritten by a child with the variable that insta reads at its start.
fn again_with_update() -> ExitCode {
    let run = std::env::current_exe().and_then(|program| {
        Command::new(program)
            .args(std::env::args_os().skip(1))
            .env("INSTA_UPDATE", "always")
            .status()
    });
    match run {
        Ok(status) => ExitCode::from(
            status
                .code()
                .and_then(|code| u8::try_from(code).ok())
                .unwrap_or(INPUT_OUTPUT),
        ),
        Err(error) => {
            eprintln!("error: cannot start again to rewrite the snapshots: {error}");
            ExitCode::from(INPUT_OUTPUT)
        }
    }
}

/// Accepts the files that were left, and names them.
fn accept_left(folder: Result<PathBuf, CaseError>) -> Result<u8, CaseError> {
    let folder = folder?;
    let accepted = harness::review::accept_left(&folder).map_err(|source| ResultsError::File {
        path: folder,
        source,
    })?;
    for name in &accepted {
        println!("accepted: {name}");
    }
    println!("{} snapshots accepted", accepted.len());
    Ok(0)
}

/// Runs everything asked for and returns the exit code. A case that fails takes nothing from the
/// others: their results are written and printed first.
fn validate(arguments: &Arguments) -> Result<u8, CaseError> {
    let clock = Instant::now();
    if let Some(threads) = arguments.threads {
        // Fails only if the pool exists already, which it does not at the start.
        let _ = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global();
    }
    std::fs::create_dir_all(&arguments.out).map_err(|source| ResultsError::File {
        path: arguments.out.clone(),
        source,
    })?;
    let level = match (arguments.quick, arguments.full) {
        (true, _) => Level::Quick,
        (_, true) => Level::Full,
        _ => Level::Default,
    };
    let cases: Vec<Case> = Case::value_variants()
        .iter()
        .rev()
        .copied()
        .filter(|case| arguments.case.is_empty() || arguments.case.contains(case))
        .collect();
    let results: Vec<Result<Study, CaseError>> = cases
        .par_iter()
        .map(|case| {
            let study = case.study(level, &arguments.out);
            let end = if study.is_ok() { "done" } else { "failed" };
            let name = case
                .to_possible_value()
                .map_or_else(String::new, |v| v.get_name().into());
            eprintln!("{name}: {end} after {:.0} s", clock.elapsed().as_secs_f64());
            study
        })
        .collect();
    let (mut studies, mut errors) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(study) => studies.push(study),
            Err(error) => errors.push(error),
        }
    }
    studies.reverse();
    errors.reverse();

    let pictures = arguments.out.join("review");
    let mut missed = harness::snapshot::compare(&studies, &arguments.snapshots()?, &pictures)?;
    harness::table::write_summary(&studies, &missed, &arguments.out)?;
    let all_cases = arguments.case.is_empty() && errors.is_empty();
    if arguments.matrix && errors.is_empty() {
        harness::matrix::write(&studies, all_cases)?;
    }
    let drift = harness::matrix::drift(&studies, level, all_cases)?;
    missed.extend(drift.into_iter().map(|change| Difference {
        name: "verification matrix".to_owned(),
        change,
    }));
    let code = print_report(&studies, &missed, arguments, clock.elapsed().as_secs_f64());
    for error in &errors {
        report_error(error);
    }
    Ok(errors.first().map_or(code, exit_code))
}

/// Prints notes, table and misses; returns the exit code.
fn print_report(
    studies: &[Study],
    missed: &[Difference],
    arguments: &Arguments,
    seconds: f64,
) -> u8 {
    for note in studies.iter().flat_map(|study| &study.notes) {
        println!("{note}\n");
    }
    if let Some(note) = harness::study::coverage::note(studies) {
        println!("{note}\n");
    }
    println!("{}", harness::table::checks(studies));
    let rows = || studies.iter().flat_map(|study| &study.rows);
    let failed = rows().filter(|row| !row.pass).count();
    println!(
        "checks: {} passed, {failed} failed",
        rows().count() - failed
    );
    println!(
        "snapshots and matrix: {} differ; {seconds:.0} s; tables, pictures and summary.json in {}",
        missed.len(),
        arguments.out.display(),
    );
    for row in rows().filter(|row| !row.pass) {
        let check = &row.check;
        println!(
            "missed: {}, {}: {} is {}, expected {} ({}), band {}",
            check.case,
            check.variant,
            check.quantity,
            igimp_text::short(check.measured),
            igimp_text::short(check.expected),
            check.source,
            check.band,
        );
    }
    for study in studies {
        for run in study.runs.iter().filter(|run| run.at_round_off > 0) {
            println!(
                "round-off: {}, {}: {} steps were accepted above the tolerance, at round-off",
                study.case, run.variant, run.at_round_off,
            );
        }
    }
    for difference in missed {
        println!("differs: {difference}");
    }
    if !missed.is_empty() {
        println!(
            "old against new: {}; accept snapshots with `cargo insta review` or --accept-left, the \
             matrix with --full --matrix; how: the book, page \"Reviewing a change of numbers\"",
            arguments.out.join("review").display()
        );
    }
    let unfinished: Vec<&String> = studies.iter().flat_map(|study| &study.unfinished).collect();
    for text in &unfinished {
        println!("{text}");
    }
    if !unfinished.is_empty() {
        NOT_CONVERGED
    } else if failed > 0 || !missed.is_empty() {
        REFERENCE_MISSED
    } else {
        0
    }
}
