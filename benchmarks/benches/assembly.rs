//! Assembly: what a load step pays once (set-up) and what each Newton iteration pays (evaluate,
//! linearise), on blocks of growing size, on one thread and on several.

use std::cell::OnceCell;

use criterion::{BenchmarkId, Criterion, SamplingMode};
use igimp_assembly::Stencils;
use igimp_benchmarks::block::{Block, Soil};
use igimp_benchmarks::pass::Pass;
use igimp_benchmarks::{BenchResult, Set, elements, made, run, threads};
use rayon::ThreadPool;

/// Cells along a side: 10 000, 99 856 and a million particles.
const SIZES: [usize; 3] = [50, 158, 500];
/// Cells along a side of the blocks that compare laws: 2500 particles, which stay in the caches.
const SMALL: usize = 25;
/// Cells along a side of the cube: 13 824 particles.
const CUBE: usize = 12;

fn main() -> BenchResult {
    let sizes = match Set::asked() {
        Set::Short => &SIZES[..1],
        Set::Full => &SIZES,
    };
    let counts = threads::counts();
    let pools = counts.iter().map(|&count| threads::pool(count));
    let pools = pools.collect::<BenchResult<Vec<_>>>()?;
    run(|criterion| {
        for &cells in sizes {
            for soil in [Soil::VonMises, Soil::MohrCoulomb] {
                iteration(criterion, soil, cells, &pools);
            }
            set_up(criterion, cells, &pools);
        }
        for soil in Soil::ALL.into_iter().chain(Soil::ITERATED) {
            linearise_of(criterion, soil, &pools[0]);
        }
        for soil in [Soil::VonMises, Soil::MohrCoulomb] {
            in_space(criterion, soil, &pools[0]);
        }
        Ok(())
    })
}

/// A block with its stencils.
fn block(soil: Soil, cells: usize) -> (Block<2>, Stencils<2>) {
    let block = made(Block::new(soil, cells));
    let stencils = made(block.stencils());
    (block, stencils)
}

fn iteration(criterion: &mut Criterion, soil: Soil, cells: usize, pools: &[ThreadPool]) {
    let input = OnceCell::new();
    let mut pass = None;
    let mut group = criterion.benchmark_group("assembly");
    group.throughput(elements(Block::<2>::particles(cells)));
    if cells > SIZES[0] {
        group.sample_size(10).sampling_mode(SamplingMode::Flat);
    }
    for phase in ["evaluate", "linearise"] {
        for pool in pools {
            let threads = threads::name(pool.current_num_threads());
            let name = format!("{}/{phase}/{threads}", soil.name());
            group.bench_function(
                BenchmarkId::new(name, Block::<2>::particles(cells)),
                |bencher| {
                    let (block, stencils) = input.get_or_init(|| block(soil, cells));
                    let pass = pass.get_or_insert_with(|| made(Pass::new(block, stencils)));
                    match phase {
                        "evaluate" => bencher.iter(|| pool.install(|| pass.evaluate())),
                        _ => bencher.iter(|| pool.install(|| pass.linearise())),
                    }
                },
            );
        }
    }
    group.finish();
}

fn set_up(criterion: &mut Criterion, cells: usize, pools: &[ThreadPool]) {
    let input = OnceCell::new();
    let mut group = criterion.benchmark_group("set_up");
    group.throughput(elements(Block::<2>::particles(cells)));
    if cells > SIZES[0] {
        group.sample_size(10).sampling_mode(SamplingMode::Flat);
    }
    for pool in pools {
        let threads = threads::name(pool.current_num_threads());
        let id = |part| BenchmarkId::new(format!("{part}/{threads}"), Block::<2>::particles(cells));
        group.bench_function(id("stencils"), |bencher| {
            let (block, _) = input.get_or_init(|| block(Soil::VonMises, cells));
            bencher.iter(|| pool.install(|| block.stencils()));
        });
        group.bench_function(id("unknowns-and-pattern"), |bencher| {
            let (block, stencils) = input.get_or_init(|| block(Soil::VonMises, cells));
            bencher.iter(|| pool.install(|| block.system(stencils).map(drop)));
        });
    }
    group.finish();
}

fn linearise_of(criterion: &mut Criterion, soil: Soil, pool: &ThreadPool) {
    let input = OnceCell::new();
    let mut pass = None;
    let mut group = criterion.benchmark_group("linearise");
    group.throughput(elements(Block::<2>::particles(SMALL)));
    group.bench_function(soil.name(), |bencher| {
        let (block, stencils) = input.get_or_init(|| block(soil, SMALL));
        let pass = pass.get_or_insert_with(|| made(Pass::new(block, stencils)));
        bencher.iter(|| pool.install(|| pass.linearise()));
    });
    group.finish();
}

fn in_space(criterion: &mut Criterion, soil: Soil, pool: &ThreadPool) {
    let input: OnceCell<(Block<3>, Stencils<3>)> = OnceCell::new();
    let mut pass = None;
    let mut group = criterion.benchmark_group("space");
    group.throughput(elements(Block::<3>::particles(CUBE)));
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    for phase in ["evaluate", "linearise"] {
        group.bench_function(format!("{}/{phase}", soil.name()), |bencher| {
            let (block, stencils) = input.get_or_init(|| {
                let block = made(Block::new(soil, CUBE));
                let stencils = made(block.stencils());
                (block, stencils)
            });
            let pass = pass.get_or_insert_with(|| made(Pass::new(block, stencils)));
            match phase {
                "evaluate" => bencher.iter(|| pool.install(|| pass.evaluate())),
                _ => bencher.iter(|| pool.install(|| pass.linearise())),
            }
        });
    }
    group.finish();
}
