//! One load step from equilibrium to equilibrium, of each of the four cases of the paper.

use criterion::{BatchSize, BenchmarkId, Criterion};
use igimp_benchmarks::steps::{PreparedStep, Setting};
use igimp_benchmarks::{BenchResult, elements, run};

/// A step takes long enough for few samples to do.
const SAMPLES: usize = 10;

fn main() -> BenchResult {
    run(|criterion| {
        for setting in Setting::of_the_paper() {
            bench(criterion, &setting.prepare()?)?;
        }
        Ok(())
    })
}

fn bench(criterion: &mut Criterion, prepared: &PreparedStep) -> BenchResult {
    let mut workspace = PreparedStep::workspace();
    let report = prepared.take(&mut prepared.body.clone(), &mut workspace)?;
    println!(
        "{}: {} corrections, {:.0} % of the particles plastic",
        prepared.name,
        report.iterations,
        100.0 * report.plastic_share
    );
    let particles = prepared.body.particles.len();
    let mut group = criterion.benchmark_group("whole_step");
    group.sample_size(SAMPLES).throughput(elements(particles));
    group.bench_function(BenchmarkId::new(prepared.name, particles), |bencher| {
        bencher.iter_batched_ref(
            || prepared.body.clone(),
            |body| prepared.take(body, &mut workspace),
            BatchSize::PerIteration,
        );
    });
    group.finish();
    Ok(())
}
