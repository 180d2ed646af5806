//! Direct solvers on tangents that assembly makes: Cholesky for the von Mises block, LU for the
//! Mohr–Coulomb block; ordering, analysis, factorisation and solution apart.

use std::cell::OnceCell;

use criterion::{BatchSize, BenchmarkId, Criterion};
use igimp_benchmarks::block::Block;
use igimp_benchmarks::equations::{Direct, Equations};
use igimp_benchmarks::{BenchResult, Set, elements, made, run};
use igimp_linear::NestedDissection;

/// Cells along a side: 5000, 20 000 and 80 000 unknowns.
const SIZES: [usize; 3] = [50, 100, 200];
/// A factorisation takes long enough for few samples to do.
const SAMPLES: usize = 10;

fn main() -> BenchResult {
    let sizes = match Set::asked() {
        Set::Short => &SIZES[..1],
        Set::Full => &SIZES,
    };
    run(|criterion| {
        for &cells in sizes {
            for method in Direct::ALL {
                bench(criterion, method, cells);
            }
        }
        Ok(())
    })
}

fn bench(criterion: &mut Criterion, method: Direct, cells: usize) {
    let input = OnceCell::new();
    let equations = || input.get_or_init(|| made(Equations::new(method.soil(), cells)));
    let mut group = criterion.benchmark_group("factorisation");
    group
        .sample_size(SAMPLES)
        .throughput(elements(Block::unknowns(cells)));
    let id = |phase: &str| {
        let name = format!("{}/{phase}", method.name());
        BenchmarkId::new(name, Block::unknowns(cells))
    };
    group.bench_function(id("order"), |bencher| {
        let pattern = &equations().matrix.pattern;
        bencher.iter(|| NestedDissection::new(pattern));
    });
    group.bench_function(id("analyse"), |bencher| {
        let pattern = &equations().matrix.pattern;
        bencher.iter_batched_ref(
            || method.solver(),
            |solver| solver.analyse(pattern),
            BatchSize::PerIteration,
        );
    });
    let mut solver = method.solver();
    group.bench_function(id("factor"), |bencher| {
        let matrix = &equations().matrix;
        bencher.iter(|| solver.factor(matrix));
    });
    let mut du = Vec::new();
    group.bench_function(id("solve"), |bencher| {
        let equations = equations();
        if du.is_empty() {
            made(solver.factor(&equations.matrix));
        }
        bencher.iter(|| equations.solve(&mut *solver, &mut du));
    });
    group.finish();
}
