//! One load step from equilibrium to equilibrium: the last step to full gravity of the two slopes,
//! with the grid of the cases.

use criterion::{BatchSize, BenchmarkId, Criterion};
use igimp_benchmarks::slopes::{self, PreparedStep};
use igimp_benchmarks::{BenchResult, elements, run};

/// A step takes long enough for few samples to do.
const SAMPLES: usize = 10;
/// Cell size of both slopes \[m\].
const CELL: f64 = 0.5;

fn main() -> BenchResult {
    run(|criterion| {
        bench(criterion, "von-mises-slope", &slopes::von_mises(CELL)?)?;
        bench(
            criterion,
            "mohr-coulomb-slope",
            &slopes::mohr_coulomb(CELL)?,
        )
    })
}

fn bench(criterion: &mut Criterion, name: &str, prepared: &PreparedStep) -> BenchResult {
    let mut workspace = PreparedStep::workspace();
    let report = prepared.take(&mut prepared.body.clone(), &mut workspace)?;
    println!(
        "{name}: {} corrections, {:.0} % of the particles plastic",
        report.iterations,
        100.0 * report.plastic_share
    );
    let particles = prepared.body.particles.len();
    let mut group = criterion.benchmark_group("whole_step");
    group.sample_size(SAMPLES).throughput(elements(particles));
    group.bench_function(BenchmarkId::new(name, particles), |bencher| {
        bencher.iter_batched_ref(
            || prepared.body.clone(),
            |body| prepared.take(body, &mut workspace),
            BatchSize::PerIteration,
        );
    });
    group.finish();
    Ok(())
}
