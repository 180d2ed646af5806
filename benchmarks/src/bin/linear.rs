//! `linear FOLDER` times a linear solver of the workspace on a system that
//! `igimp run --export-matrix` wrote, and prints one line of JSON. `compare/compare.py` holds other
//! libraries against it.

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use igimp_linear::{
    LinearSolver, LinearSolverError, MultifrontalCholesky, MultifrontalLu, SolveReport, SolverKind,
    TangentMatrix,
};
use igimp_results::linear_system::LinearSystem;
use serde_json::{Value, json};

/// Times a linear solver on an exported system.
#[derive(Debug, Parser)]
struct Arguments {
    /// Folder of the system: `stage-01`, say, in the folder of `igimp run --export-matrix`.
    folder: PathBuf,
    /// Name of the solver; `auto` is the one that runs take for such a matrix.
    #[arg(long, value_name = "NAME", default_value = "auto", value_parser = kind_named)]
    solver: SolverKind,
    /// Threads to use.
    #[arg(long, value_name = "N", default_value = "1")]
    threads: usize,
    /// Relative residual that the solver is asked for.
    #[arg(long, value_name = "R")]
    asked: Option<f64>,
    /// Rounds; times are their medians.
    #[arg(long, value_name = "K", default_value = "1")]
    rounds: usize,
}

/// The kind of solver with a name.
fn kind_named(name: &str) -> Result<SolverKind, String> {
    let is_named = |kind: &SolverKind| kind.build().name() == name;
    SolverKind::ALL.into_iter().find(is_named).ok_or_else(|| {
        let names = SolverKind::ALL.map(|kind| kind.build().name());
        format!("there are {}", names.join(", "))
    })
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match tell(&arguments) {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Reads the system, solves it, and tells of it.
fn tell(arguments: &Arguments) -> Result<Value, Box<dyn Error>> {
    let pool = rayon::ThreadPoolBuilder::new();
    pool.num_threads(arguments.threads).build_global()?;
    let system = LinearSystem::read(&arguments.folder)?;
    let matrix = system.matrix()?;
    let rounds = arguments.rounds.max(1);
    let measured = measure(
        arguments.solver,
        arguments.asked,
        &matrix,
        &system.rhs,
        rounds,
    )?;
    let [analysis, factor, solve] = measured.seconds.map(median);
    let [analysis_cpu, factor_cpu, solve_cpu] = measured.cpu.map(median);
    let report = measured.report;
    Ok(json!({
        "solver": report.method,
        "threads": arguments.threads,
        "unknowns": matrix.pattern.unknowns(),
        "stored": matrix.pattern.stored(),
        "symmetric": matrix.symmetric,
        "analysis": analysis,
        "factor": factor,
        "solve": solve,
        "analysis_cpu": analysis_cpu,
        "factor_cpu": factor_cpu,
        "solve_cpu": solve_cpu,
        "entries": measured.entries,
        "memory_mib": measured.memory,
        "residual": report.relative_residual,
        "refinements": report.refinements,
        "perturbed_pivots": report.perturbed_pivots,
    }))
}

/// A solver; the direct ones tell the size of their factors.
enum Solver {
    Cholesky(MultifrontalCholesky),
    Lu(MultifrontalLu),
    Other(Box<dyn LinearSolver>),
}

impl Solver {
    /// A new solver. What `auto` prepares shows only with the matrix, so the one that it takes is
    /// made here.
    fn new(kind: SolverKind, symmetric: bool) -> Self {
        match (kind, symmetric) {
            (SolverKind::MultifrontalCholesky, _) | (SolverKind::Auto, true) => {
                Self::Cholesky(MultifrontalCholesky::default())
            }
            (SolverKind::Multifrontal, _) | (SolverKind::Auto, false) => {
                Self::Lu(MultifrontalLu::default())
            }
            (kind, _) => Self::Other(kind.build()),
        }
    }

    fn get(&mut self) -> &mut dyn LinearSolver {
        match self {
            Self::Cholesky(solver) => solver,
            Self::Lu(solver) => solver,
            Self::Other(solver) => &mut **solver,
        }
    }

    fn factor_entries(&self) -> Option<usize> {
        match self {
            Self::Cholesky(solver) => Some(solver.factor_entries()),
            Self::Lu(solver) => Some(solver.factor_entries()),
            Self::Other(_) => None,
        }
    }
}

/// What was measured.
struct Measured {
    /// Times of analysis (ordering and symbolic work), factorisation and solution, by round \[s\].
    seconds: [Vec<f64>; 3],
    /// Processor time of all threads in them \[s\]; to a few milliseconds, and not a number where
    /// the system does not tell.
    cpu: [Vec<f64>; 3],
    /// Entries of the factors.
    entries: Option<usize>,
    /// Largest resident memory beyond that of the matrix \[MiB\], where the system tells.
    memory: Option<f64>,
    report: SolveReport,
}

/// Analyses, factorises and solves. As in a Newton iteration the factorisation that counts is one
/// more with the same pattern, when memory is at hand.
fn measure(
    kind: SolverKind,
    asked: Option<f64>,
    matrix: &TangentMatrix,
    rhs: &[f64],
    rounds: usize,
) -> Result<Measured, LinearSolverError> {
    let before = forget_peak().and_then(|()| resident("VmRSS:"));
    let mut seconds: [Vec<f64>; 3] = Default::default();
    let mut cpu = seconds.clone();
    let mut last = None;
    for _ in 0..rounds {
        drop(last.take());
        let mut solver = Solver::new(kind, matrix.symmetric);
        if let Some(asked) = asked {
            solver.get().ask_for(asked);
        }
        let mut solution = vec![0.0; rhs.len()];
        let mut phase = |number: usize, clock: Clock| {
            let [wall, processor] = clock.elapsed();
            seconds[number].push(wall);
            cpu[number].push(processor);
        };
        let clock = Clock::start();
        solver.get().analyse(&matrix.pattern)?;
        phase(0, clock);
        solver.get().factor(matrix)?;
        let clock = Clock::start();
        solver.get().factor(matrix)?;
        phase(1, clock);
        let clock = Clock::start();
        let report = solver.get().solve(matrix, rhs, &mut solution)?;
        phase(2, clock);
        last = Some((solver, report));
    }
    let (solver, report) = last.expect("there is at least one round");
    let peak = resident("VmHWM:");
    Ok(Measured {
        seconds,
        cpu,
        entries: solver.factor_entries(),
        memory: before.zip(peak).map(|(before, peak)| peak - before),
        report,
    })
}

/// The beginning of a phase.
struct Clock {
    wall: Instant,
    processor: Option<f64>,
}

impl Clock {
    fn start() -> Self {
        Self {
            wall: Instant::now(),
            processor: processor_seconds(),
        }
    }

    /// Wall-clock and processor time since then \[s\].
    fn elapsed(self) -> [f64; 2] {
        let processor = self.processor.zip(processor_seconds());
        [
            self.wall.elapsed().as_secs_f64(),
            processor.map_or(f64::NAN, |(start, end)| end - start),
        ]
    }
}

/// Processor time of all threads of this process \[s\], where the system tells.
fn processor_seconds() -> Option<f64> {
    let mut sum = 0.0;
    for thread in fs::read_dir("/proc/self/task").ok()? {
        let text = fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
        sum += 1e-9 * nanoseconds;
    }
    Some(sum)
}

/// Makes the system count the peak of the resident memory anew, where it can.
fn forget_peak() -> Option<()> {
    fs::write("/proc/self/clear_refs", "5").ok()
}

/// A line of the system's account of this process \[MiB\].
fn resident(name: &str) -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(name))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}

/// The middle of some values, the mean of the two in the middle of an even number.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 {
        values[half]
    } else {
        0.5 * (values[half - 1] + values[half])
    }
}

#[cfg(test)]
mod tests {
    use igimp_cases::run::{Event, Start, Target, run};
    use igimp_input::shipped::find;

    use super::*;

    #[test]
    fn an_exported_system_is_solved() {
        let folder = std::env::temp_dir().join(format!("igimp-linear-{}", std::process::id()));
        let overrides = [
            "grid.cell=2 m",
            "grid.domain={ x = ['0 m', '40 m'], y = ['0 m', '18 m'] }",
            "stages.0.steps=2",
            "stages.0.factor=0.5",
        ];
        let file = find("von_mises_slope")
            .unwrap()
            .case_file(overrides)
            .unwrap();
        let target = Target {
            systems: Some(folder.join("systems")),
            ..Target::of(&file, folder.join("results"))
        };
        let quiet = &mut |_: &Event<'_, 2>| {};
        let never = std::sync::atomic::AtomicBool::new(false);
        run(file.case(), Some(&target), Start::Afresh, quiet, &never).unwrap();
        let system = LinearSystem::read(&folder.join("systems/stage-01")).unwrap();
        let matrix = system.matrix().unwrap();
        for kind in SolverKind::ALL {
            let measured = measure(kind, None, &matrix, &system.rhs, 2).unwrap();
            assert!(measured.report.relative_residual < 1e-9, "{kind:?}");
            assert_eq!(measured.seconds.map(|times| times.len()), [2; 3]);
        }
        assert!(
            Solver::new(SolverKind::Auto, true)
                .factor_entries()
                .is_some()
        );
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn solvers_are_known_by_their_names() {
        assert_eq!(kind_named("auto"), Ok(SolverKind::Auto));
        assert!(kind_named("none").unwrap_err().contains("nalgebra-llt"));
    }

    #[test]
    fn the_median_is_in_the_middle() {
        assert!((median(vec![3.0, 1.0, 2.0]) - 2.0).abs() < 1e-15);
        assert!((median(vec![4.0, 1.0]) - 2.5).abs() < 1e-15);
    }
}
