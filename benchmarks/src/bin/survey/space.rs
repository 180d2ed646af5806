//! What a body in space costs: assembly measured on a cube, factorisation counted.

use igimp_benchmarks::BenchResult;
use igimp_benchmarks::block::{Block, Soil};
use igimp_benchmarks::cube::plan;
use igimp_benchmarks::pass::Pass;

use super::rounds::{Rounds, exponent, timed};
use super::scope::Scope;
use super::yardstick::DensePeak;

/// Cells along a side of the square and of the cube: 10 000 and 13 824 particles.
const CELLS: [usize; 2] = [50, 12];
/// Nodes along a side of the cubes that are counted: 3000 to 192 000 unknowns.
const SIDES: [usize; 4] = [10, 20, 30, 40];

/// Cost of a step's set-up and of an iteration \[ns per particle\], and what explains it.
struct Assembly {
    stencils: Rounds,
    system: Rounds,
    evaluate: Rounds,
    linearise: Rounds,
    entries: f64,
    bytes: f64,
}

pub(crate) fn run(scope: &mut Scope) -> BenchResult {
    let mut rows = Vec::new();
    for soil in [Soil::VonMises, Soil::MohrCoulomb] {
        let plane = assembly::<2>(scope, soil, CELLS[0])?;
        let space = assembly::<3>(scope, soil, CELLS[1])?;
        let particles = [
            Block::<2>::particles(CELLS[0]),
            Block::<3>::particles(CELLS[1]),
        ];
        for ((name, found), particles) in [("plane", &plane), ("space", &space)]
            .into_iter()
            .zip(particles)
        {
            for (part, time) in [
                ("stencils", &found.stencils),
                ("unknowns-and-pattern", &found.system),
                ("evaluate", &found.evaluate),
                ("linearise", &found.linearise),
            ] {
                let name = format!("{name}/{}/{part}", soil.name());
                let report = &mut scope.report;
                report.row("space", &name, particles, "ns/particle", time);
            }
            let nanoseconds_per_entry = found.linearise.map(|time| time / found.entries);
            rows.push([
                format!("{name}, {}", soil.name()),
                format!("{:.0}", found.entries),
                format!("{:.0}", found.bytes),
                format!("{:.0}", found.stencils.median()),
                format!("{:.0}", found.system.median()),
                format!("{:.0}", found.evaluate.median()),
                format!("{:.0}", found.linearise.median()),
                format!("{:.2}", nanoseconds_per_entry.median()),
            ]);
        }
    }
    let report = &mut scope.report;
    report.heading("Three dimensions");
    report.paragraph(
        "Assembly of a square with 2 × 2 and of a cube with 2 × 2 × 2 particles per cell, one \
         thread \\[ns per particle\\]. *Entries*: what a particle adds to the matrix, the \
         square of nodes times directions, on average.",
    );
    let header = [
        "block",
        "entries",
        "bytes",
        "stencils",
        "unknowns and pattern",
        "evaluate",
        "linearise",
        "linearise per entry [ns]",
    ];
    report.table(header, &rows);
    count(scope)
}

fn assembly<const D: usize>(scope: &Scope, soil: Soil, cells: usize) -> BenchResult<Assembly> {
    let block: Block<D> = Block::new(soil, cells)?;
    let stencils = block.stencils()?;
    let mut pass = Pass::new(&block, &stencils)?;
    let mut times = [const { Rounds(Vec::new()) }; 4];
    let (particles, pool) = (block.len() as f64, &scope.pools[0]);
    for _ in 0..scope.choose(5, 15) {
        let found = [
            pool.install(|| timed(|| block.stencils()))?,
            pool.install(|| timed(|| block.system(&stencils)))?,
            pool.install(|| timed(|| pass.evaluate()))?,
            pool.install(|| timed(|| pass.linearise()))?,
        ];
        for (times, time) in times.iter_mut().zip(found) {
            times.push(time / particles);
        }
    }
    let [of_stencils, system, evaluate, linearise] = times;
    Ok(Assembly {
        stencils: of_stencils,
        system,
        evaluate,
        linearise,
        entries: pass.entries_per_particle(),
        bytes: pass.bytes() as f64 / particles,
    })
}

/// Counts what factorisations would take.
fn count(scope: &mut Scope) -> BenchResult {
    let sides = if scope.quick { &SIDES[..3] } else { &SIDES[..] };
    let mut peak = DensePeak::new();
    peak.measure();
    let peak = Rounds((0..5).map(|_| peak.measure()).collect()).median();
    let (mut operations, mut entries, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    for &side in sides {
        let plan = plan(side)?;
        let unknowns = plan.unknowns as f64;
        operations.push([unknowns, plan.operations]);
        entries.push([unknowns, plan.factor_entries as f64]);
        rows.push([
            plan.unknowns.to_string(),
            plan.stored.to_string(),
            format!("{:.1}", plan.factor_entries as f64 / 1e6),
            format!("{:.2}", 8e-9 * plan.factor_entries as f64),
            format!("{:.1}", plan.operations / 1e9),
            format!("{:.1}", plan.operations / 1e9 / peak),
        ]);
    }
    let report = &mut scope.report;
    report.paragraph(&format!(
        "LU factorisation of a cube of free nodes on the nested dissection, counted and not carried \
         out. Operations grow with the number of unknowns to the power {:.2}, entries with {:.2}; \
         theory says 2 and 4/3 for large cubes. *At least*: operations over the dense peak of one \
         thread, {peak:.1} GFlop/s.",
        exponent(&operations),
        exponent(&entries)
    ));
    let header = [
        "unknowns",
        "entries of K",
        "factors [10^6]",
        "factors [GB]",
        "operations [GFlop]",
        "at least [s]",
    ];
    report.table(header, &rows);
    Ok(())
}
