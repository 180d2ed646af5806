//! How assembly grows with the number of particles.

use igimp_assembly::Stencils;
use igimp_benchmarks::BenchResult;
use igimp_benchmarks::block::{Block, Soil};
use igimp_benchmarks::pass::Pass;

use super::plot::Curve;
use super::rounds::{Rounds, exponent, timed};
use super::scope::Scope;

/// Cells along a side: 10 000 to a million particles.
const SIZES: [usize; 5] = [50, 90, 158, 280, 500];
/// Particles that a round goes over at least, by repeating small sizes.
const PER_ROUND: usize = 200_000;

pub(crate) fn run(scope: &mut Scope) -> BenchResult {
    let sizes = scope.choose(&SIZES[..3], &SIZES[..]);
    let mut rows = Vec::new();
    for soil in [Soil::VonMises, Soil::MohrCoulomb] {
        let costs = measure(scope, soil, sizes)?;
        let mut points = Vec::new();
        for (&cells, cost) in std::iter::zip(sizes, &costs) {
            let particles = Block::<2>::particles(cells);
            let name = format!("{}/iteration", soil.name());
            scope
                .report
                .row("growth", &name, particles, "ns/particle", cost);
            let ratio = cost.over(&costs[0]);
            points.push([particles as f64, particles as f64 * cost.median()]);
            let mut power = String::new();
            if points.len() > 1 {
                let fitted = exponent(&points);
                power = format!("{fitted:.3}");
                let report = &mut scope.report;
                let name = |part: &str| format!("{}/{part}", soil.name());
                report.row("growth", &name("over-smallest"), particles, "-", &ratio);
                let fitted = Rounds(vec![fitted]);
                report.row("growth", &name("exponent"), particles, "-", &fitted);
            }
            rows.push([
                soil.name().to_owned(),
                particles.to_string(),
                format!("{:.0}", cost.median()),
                format!("{:.2}", ratio.median()),
                power,
            ]);
        }
        let label = format!("assembly, {}", soil.name());
        scope.curves.push(Curve {
            label,
            points,
            power: 1.0,
        });
    }
    let report = &mut scope.report;
    report.heading("Growth with size");
    report.paragraph(
        "Linearise (stress, internal force and tangent) on one thread, all sizes in turn \\[ns per particle\\]. *Ratio*: over the \
         smallest size. *Exponent* p of time ∝ particles^p, fitted to this and the smaller sizes; \
         1 is what can be hoped for.",
    );
    report.table(["law", "particles", "cost", "ratio", "exponent"], &rows);
    Ok(())
}

/// Cost of an iteration per particle \[ns\], by size.
fn measure(scope: &Scope, soil: Soil, sizes: &[usize]) -> BenchResult<Vec<Rounds>> {
    let blocks = sizes.iter().map(|&cells| {
        let block = Block::new(soil, cells)?;
        let stencils = block.stencils()?;
        Ok((block, stencils))
    });
    let blocks: Vec<(Block<2>, Stencils<2>)> = blocks.collect::<BenchResult<_>>()?;
    let mut passes = Vec::new();
    for (block, stencils) in &blocks {
        passes.push(Pass::new(block, stencils)?);
    }
    let mut costs = vec![Rounds::default(); sizes.len()];
    for round in 0..=scope.choose(3, 5) {
        for (((block, _), pass), cost) in blocks.iter().zip(&mut passes).zip(&mut costs) {
            let times = PER_ROUND.div_ceil(block.len());
            let time = scope.pools[0].install(|| {
                timed(|| {
                    for _ in 0..times {
                        pass.linearise()?;
                    }
                    BenchResult::Ok(())
                })
                .map_err(|error| error.to_string())
            })?;
            if round > 0 {
                cost.push(time / (times * block.len()) as f64);
            }
        }
    }
    Ok(costs)
}
