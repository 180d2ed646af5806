//! Direct solvers on tangents that assembly makes: Cholesky for the von Mises block, LU for the
//! Mohr–Coulomb block; analysis, factorisation and solution apart.

use criterion::{BatchSize, BenchmarkId, Criterion};
use igimp_benchmarks::block::{Block, SIZES};
use igimp_benchmarks::{BenchResult, elements, run};
use igimp_material::TangentKind;
use igimp_solver::linear::SolverKind;

/// A factorisation takes long enough for few samples to do.
const SAMPLES: usize = 10;

fn main() -> BenchResult {
    run(|criterion| {
        for cells in SIZES {
            let block = Block::von_mises(cells)?;
            bench(
                criterion,
                "cholesky",
                &block,
                SolverKind::MultifrontalCholesky,
            )?;
        }
        for cells in SIZES {
            let block = Block::mohr_coulomb(cells)?;
            bench(criterion, "lu", &block, SolverKind::Multifrontal)?;
        }
        Ok(())
    })
}

fn bench(criterion: &mut Criterion, name: &str, block: &Block, kind: SolverKind) -> BenchResult {
    let stencils = block.stencils()?;
    let system = block.system(&stencils)?;
    let trial = system.evaluate(&block.u, TangentKind::Consistent)?;
    let force = system.out_of_balance(&trial)?.force;
    let matrix = system.tangent(&trial);
    let mut solver = kind.build();
    solver.factor(&matrix)?;
    let mut du = vec![0.0; force.len()];
    solver.solve(&matrix, &force, &mut du)?;

    let mut group = criterion.benchmark_group("factorisation");
    group.sample_size(SAMPLES).throughput(elements(force.len()));
    let id = |phase: &str| BenchmarkId::new(format!("{name}/{phase}"), force.len());
    group.bench_function(id("analyse"), |bencher| {
        bencher.iter_batched_ref(
            || kind.build(),
            |solver| solver.analyse(&matrix.pattern),
            BatchSize::PerIteration,
        );
    });
    group.bench_function(id("factor"), |bencher| {
        bencher.iter(|| solver.factor(&matrix));
    });
    group.bench_function(id("solve"), |bencher| {
        bencher.iter(|| solver.solve(&matrix, &force, &mut du));
    });
    group.finish();
    Ok(())
}
