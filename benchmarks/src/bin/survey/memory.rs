//! Peak resident memory per particle and per unknown. A peak never falls, so every size is measured
//! in a process of its own.

use std::process::Command;
use std::{env, fs};

use igimp_benchmarks::BenchResult;
use igimp_benchmarks::block::Block;
use igimp_benchmarks::equations::{Direct, Equations};

use super::rounds::Rounds;
use super::scope::Scope;

/// Cells along a side: 40 000 to 640 000 particles, 20 000 to 320 000 unknowns.
const SIZES: [usize; 3] = [100, 200, 400];

/// Memory of one process \[bytes\].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Memory {
    /// Peak of the assembly, above what the process had at its start.
    assembly: f64,
    /// Peak of the linear solver, above what the process had before.
    solver: f64,
    /// Peak of the whole.
    peak: f64,
}

pub(crate) fn run(scope: &mut Scope) -> BenchResult {
    let sizes = if scope.quick { &SIZES[..2] } else { &SIZES[..] };
    let mut rows = Vec::new();
    for method in Direct::ALL {
        for &cells in sizes {
            let Some(memory) = measure(method, cells)? else {
                scope.report.heading("Memory");
                scope
                    .report
                    .paragraph("Not known: the system does not tell the peak of a process.");
                return Ok(());
            };
            let (particles, unknowns) = (Block::<2>::particles(cells), Block::unknowns(cells));
            let per_particle = memory.assembly / particles as f64;
            let per_unknown = memory.solver / unknowns as f64;
            let name = |part: &str| format!("{}/{part}", method.name());
            let report = &mut scope.report;
            let assembly = Rounds(vec![per_particle]);
            report.row(
                "memory",
                &name("assembly"),
                particles,
                "B/particle",
                &assembly,
            );
            let solver = Rounds(vec![per_unknown]);
            report.row("memory", &name("solver"), unknowns, "B/unknown", &solver);
            rows.push([
                format!("{}, {}", method.soil().name(), method.name()),
                particles.to_string(),
                unknowns.to_string(),
                format!("{per_particle:.0}"),
                format!("{per_unknown:.0}"),
                format!("{:.0}", memory.peak / f64::from(1 << 20)),
                format!("{:.0}", memory.peak / particles as f64),
            ]);
        }
    }
    let report = &mut scope.report;
    report.heading("Memory");
    report.paragraph(
        "Peak resident memory (`VmHWM`) of a process of its own for each size. *Assembly*: bytes per \
         particle of particles, supports, trial and matrix together. *Solver*: bytes per \
         unknown that analysis, factorisation and solution add. The factor grows with n log n, \
         and so does the second figure.",
    );
    let header = [
        "block",
        "particles",
        "unknowns",
        "assembly [B/particle]",
        "solver [B/unknown]",
        "peak [MiB]",
        "peak [B/particle]",
    ];
    report.table(header, &rows);
    Ok(())
}

/// Runs this program for one size; `None` where the system does not tell.
fn measure(method: Direct, cells: usize) -> BenchResult<Option<Memory>> {
    let output = Command::new(env::current_exe()?)
        .args(["--memory-of", method.name(), &cells.to_string()])
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let text = String::from_utf8(output.stdout)?;
    let numbers: Vec<f64> = text
        .split_whitespace()
        .map_while(|word| word.parse().ok())
        .collect();
    Ok(match numbers[..] {
        [assembly, solver, peak] => Some(Memory {
            assembly,
            solver,
            peak,
        }),
        _ => None,
    })
}

/// Prints the memory of one size: assembly, solver, peak \[bytes\], or `unknown`.
pub(crate) fn print(of: &[String]) -> BenchResult {
    let [name, cells] = of else {
        return Err("a method and a number of cells are needed".into());
    };
    let mut methods = Direct::ALL.into_iter();
    let method = methods
        .find(|method| method.name() == name)
        .ok_or("no such method")?;
    let start = status("VmRSS");
    let equations = Equations::new(method.soil(), cells.parse()?)?;
    let (assembled, held) = (status("VmHWM"), status("VmRSS"));
    let mut solver = method.solver();
    solver.factor(&equations.matrix)?;
    equations.solve(&mut *solver, &mut Vec::new())?;
    match (start, assembled, held, status("VmHWM")) {
        (Some(start), Some(assembled), Some(held), Some(peak)) => {
            println!("{} {} {peak}", assembled - start, (peak - held).max(0.0));
        }
        _ => println!("unknown"),
    }
    Ok(())
}

/// A figure of the status of this process \[bytes\], where the system tells.
fn status(key: &str) -> Option<f64> {
    parse(&fs::read_to_string("/proc/self/status").ok()?, key)
}

fn parse(status: &str, key: &str) -> Option<f64> {
    let line = status.lines().find(|line| line.starts_with(key))?;
    let kibibytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1024.0 * kibibytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_status_is_understood() {
        let text = "Name:\tsurvey\nVmHWM:\t    2048 kB\nVmRSS:\t    1024 kB\n";
        assert_eq!(parse(text, "VmRSS"), Some(1_048_576.0));
        assert_eq!(parse(text, "VmSwap"), None);
    }
}
