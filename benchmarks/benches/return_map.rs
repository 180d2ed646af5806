//! Constitutive laws: return maps in principal space, and with the lift to tensors around them in
//! plane strain.

use std::hint::black_box;

use criterion::Criterion;
use igimp_assembly::SharedLaw;
use igimp_benchmarks::states::{BenchLaw, COUNT, Side, laws, trial_strains, turned};
use igimp_benchmarks::{BenchResult, elements, run};
use igimp_material::{
    History, MaterialError, PointContext, Principal, TangentKind, Tensor, lift_finite, lift_small,
};

fn main() -> BenchResult {
    run(|criterion| {
        for BenchLaw { name, law, sides } in laws()? {
            for &side in sides {
                bench(criterion, &format!("{name}/{}", side.name()), &law, side);
            }
        }
        Ok(())
    })
}

fn bench(criterion: &mut Criterion, name: &str, law: &SharedLaw, side: Side) {
    let history = History::default();
    let kind = TangentKind::Consistent;
    let strains = trial_strains(law, side);
    let stretches: Vec<Principal> = strains
        .iter()
        .map(|strain| strain.map(|component| (2.0 * component).exp()))
        .collect();

    pass(criterion, "return_map", name, &strains, |strain| {
        law.return_map(strain, &history, &PointContext::STATIC)
    });
    pass(criterion, "lift_small", name, &turned(&strains), |eps_e| {
        lift_small::<2>(&**law, eps_e, &history, kind)
    });
    let stretches: Vec<Tensor> = turned(&stretches);
    pass(criterion, "lift_finite", name, &stretches, |b_e| {
        lift_finite::<2>(&**law, b_e, &history, kind)
    });
}

/// Times one pass over all trial states.
fn pass<S, T>(
    criterion: &mut Criterion,
    group: &str,
    name: &str,
    states: &[S],
    answer: impl Fn(&S) -> Result<T, MaterialError>,
) {
    let mut group = criterion.benchmark_group(group);
    group.throughput(elements(COUNT));
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            for state in states {
                black_box(answer(state)?);
            }
            Ok::<(), MaterialError>(())
        });
    });
    group.finish();
}
