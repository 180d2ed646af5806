//! Basis functions: one `supports` call per particle, linear and GIMP, in the plane and in 3D.

use std::hint::black_box;

use criterion::Criterion;
use igimp_benchmarks::random::Random;
use igimp_benchmarks::{BenchResult, elements, run};
use igimp_shape::{Axis, Basis, Gimp, Grid, Linear, Scratch, supports};

/// Particles per pass, spread over the grid so that no two in a row share their nodes.
const PARTICLES: usize = 4096;

fn main() -> BenchResult {
    run(|criterion| {
        bench::<2>(criterion, "2d-linear", &Linear)?;
        bench::<2>(criterion, "2d-gimp", &Gimp)?;
        bench::<3>(criterion, "3d-linear", &Linear)?;
        bench::<3>(criterion, "3d-gimp", &Gimp)
    })
}

fn bench<const D: usize>(criterion: &mut Criterion, name: &str, basis: &dyn Basis) -> BenchResult {
    let cells: usize = if D == 2 { 100 } else { 22 };
    let axis = Axis::uniform(0.0, 1.0, cells)?;
    let grid: Grid<D> = Grid::new(std::array::from_fn(|_| axis.clone()));
    let mut random = Random::new(1);
    let positions: Vec<[f64; D]> = (0..PARTICLES)
        .map(|_| [0; D].map(|_| random.between(0.5, cells as f64 - 0.5)))
        .collect();
    let (mut scratch, mut list) = (Scratch::default(), Vec::new());

    let mut group = criterion.benchmark_group("basis");
    group.throughput(elements(PARTICLES));
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            for x in &positions {
                supports(&grid, basis, x, &[0.25; D], &mut scratch, &mut list)?;
                black_box(&list);
            }
            Ok::<(), igimp_shape::ShapeError>(())
        });
    });
    group.finish();
    Ok(())
}
