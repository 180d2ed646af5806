//! Assembly: what a load step pays once (set-up) and what each Newton iteration pays (evaluate,
//! tangent), on blocks of three sizes.

use criterion::{BenchmarkId, Criterion};
use igimp_assembly::AssemblyError;
use igimp_benchmarks::block::{Block, SIZES};
use igimp_benchmarks::{BenchResult, elements, run};
use igimp_material::TangentKind;

fn main() -> BenchResult {
    run(|criterion| {
        for cells in SIZES {
            bench(criterion, "von-mises", &Block::von_mises(cells)?)?;
        }
        for cells in SIZES {
            bench(criterion, "mohr-coulomb", &Block::mohr_coulomb(cells)?)?;
        }
        Ok(())
    })
}

fn bench(criterion: &mut Criterion, law: &str, block: &Block) -> BenchResult {
    let stencils = block.stencils()?;
    let system = block.system(&stencils)?;
    let trial = system.evaluate(&block.u, TangentKind::Consistent)?;
    let mut matrix = system.tangent(&trial);

    let mut group = criterion.benchmark_group("assembly");
    group.throughput(elements(block.len()));
    let id = |phase: &str| BenchmarkId::new(format!("{law}/{phase}"), block.len());
    group.bench_function(id("set-up"), |bencher| {
        bencher.iter(|| {
            let stencils = block.stencils()?;
            block.system(&stencils)?;
            Ok::<_, AssemblyError>(stencils)
        });
    });
    group.bench_function(id("evaluate"), |bencher| {
        bencher.iter(|| system.evaluate(&block.u, TangentKind::Consistent));
    });
    group.bench_function(id("tangent"), |bencher| {
        bencher.iter(|| system.tangent_into(&trial, &mut matrix));
    });
    group.finish();
    Ok(())
}
