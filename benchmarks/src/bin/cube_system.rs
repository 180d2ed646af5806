//! `cube_system FOLDER` writes the tangent of a cube of soil as `igimp run --export-matrix` would, for
//! `compare/space.py`: the states are those of the program `iteration`. It tells what an assembly takes.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use igimp_benchmarks::BenchResult;
use igimp_benchmarks::block::{Block, Soil};
use igimp_benchmarks::pass::Pass;
use igimp_linear::SolvedSystem;
use igimp_results::linear_system::{About, LinearSystem};

/// Writes the tangent of a cube of soil.
#[derive(Debug, Parser)]
struct Arguments {
    /// Folder for the system.
    folder: PathBuf,
    /// A square instead of a cube.
    #[arg(long)]
    plane: bool,
    /// Cells along a side.
    #[arg(long, value_name = "N", default_value = "20")]
    cells: usize,
    /// What the cube is made of: hencky-elastic, von-mises, mohr-coulomb.
    #[arg(long, value_name = "NAME", default_value = "hencky-elastic", value_parser = soil_named)]
    soil: Soil,
    /// Poisson's ratio.
    #[arg(long, value_name = "NU", default_value = "0.3")]
    poisson: f64,
}

fn soil_named(name: &str) -> Result<Soil, String> {
    let mut all = Soil::ALL.into_iter();
    all.find(|soil| soil.name() == name).ok_or_else(|| {
        let names = Soil::ALL.map(Soil::name);
        format!("there are {}", names.join(", "))
    })
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let written = if arguments.plane {
        write::<2>(&arguments)
    } else {
        write::<3>(&arguments)
    };
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Assembles and writes the system; nothing is solved, and its solution is written as zero.
fn write<const D: usize>(arguments: &Arguments) -> BenchResult {
    let threads = rayon::current_num_threads();
    let block: Block<D> = Block::with_poisson(arguments.soil, arguments.poisson, arguments.cells)?;
    let (matrix, rhs) = {
        let stencils = block.stencils()?;
        let mut pass = Pass::new(&block, &stencils)?;
        let mut best = f64::INFINITY;
        for _ in 0..3 {
            let start = Instant::now();
            pass.linearise()?;
            best = best.min(start.elapsed().as_secs_f64());
        }
        let microseconds = 1e6 * best / block.len() as f64;
        println!("assembly on {threads} threads: {microseconds:.2} µs a particle");
        pass.equations()?
    };
    let about = About {
        program: format!("igimp {}", env!("CARGO_PKG_VERSION")),
        case: format!(
            "{}, Poisson's ratio {}",
            arguments.soil.name(),
            arguments.poisson
        ),
        stage: "prescribed state".to_owned(),
        stage_number: 1,
        step: 1,
        ..About::default()
    };
    let solved = SolvedSystem {
        number: 1,
        solution: vec![0.0; rhs.len()],
        matrix,
        rhs,
    };
    LinearSystem::of(solved, block.grid(), block.constraints(), about).write(&arguments.folder)?;
    Ok(())
}
