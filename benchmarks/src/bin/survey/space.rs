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

/// Cost of an iteration \[ns per particle\], and what explains it.
struct Assembly {
    evaluate: Rounds,
    linearise: Rounds,
    entries: f64,
    bytes: f64,
}

pub(crate) fn run(scope: &mut Scope) -> BenchResult {
    let plane = assembly::<2>(scope, CELLS[0])?;
    let space = assembly::<3>(scope, CELLS[1])?;
    let rows = [("plane", &plane), ("space", &space)].map(|(name, found)| {
        let nanoseconds_per_entry = found.linearise.map(|time| time / found.entries);
        [
            name.to_owned(),
            format!("{:.0}", found.entries),
            format!("{:.0}", found.bytes),
            format!("{:.0}", found.evaluate.median()),
            format!("{:.0}", found.linearise.median()),
            format!("{:.2}", nanoseconds_per_entry.median()),
        ]
    });
    let report = &mut scope.report;
    for (number, (name, found)) in [("plane", &plane), ("space", &space)]
        .into_iter()
        .enumerate()
    {
        let particles = (2 * CELLS[number]).pow(2 + number as u32);
        report.row(
            "space",
            &format!("{name}/evaluate"),
            particles,
            "ns/particle",
            &found.evaluate,
        );
        report.row(
            "space",
            &format!("{name}/linearise"),
            particles,
            "ns/particle",
            &found.linearise,
        );
    }
    report.heading("Three dimensions");
    report.paragraph(
        "Assembly of a square with 2 × 2 and of a cube with 2 × 2 × 2 particles per cell, von Mises \
         soil, one thread \\[ns per particle\\]. *Entries*: what a particle adds to the matrix, the \
         square of nodes times directions, on average.",
    );
    let header = [
        "block",
        "entries",
        "bytes",
        "evaluate",
        "linearise",
        "linearise per entry [ns]",
    ];
    report.table(header, &rows);
    count(scope)
}

fn assembly<const D: usize>(scope: &Scope, cells: usize) -> BenchResult<Assembly> {
    let block: Block<D> = Block::new(Soil::VonMises, cells)?;
    let stencils = block.stencils()?;
    let mut pass = Pass::new(&block, &stencils)?;
    let (mut evaluate, mut linearise) = (Rounds::default(), Rounds::default());
    let particles = block.len() as f64;
    for _ in 0..scope.choose(5, 15) {
        let time = scope.pools[0].install(|| timed(|| pass.evaluate()))?;
        evaluate.push(time / particles);
        let time = scope.pools[0].install(|| timed(|| pass.linearise()))?;
        linearise.push(time / particles);
    }
    Ok(Assembly {
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
