//! Ordering, analysis, factorisation and solution by size, and the rate of the factorisation
//! against that of a dense product.

use igimp_benchmarks::equations::{Direct, Equations};
use igimp_benchmarks::{BenchResult, threads};
use igimp_linear::NestedDissection;

use super::plot::Curve;
use super::rounds::{Rounds, exponent, timed};
use super::scope::Scope;
use super::yardstick::DensePeak;

/// Cells along a side: 5000 to 320 000 unknowns.
const SIZES: [usize; 4] = [50, 100, 200, 400];

/// Times of one method at one size \[ns\].
#[derive(Default)]
struct Measured {
    order: Rounds,
    analyse: Rounds,
    /// By pool.
    factor: Vec<Rounds>,
    solve: Rounds,
    /// Dense rate in the same round \[GFlop/s\].
    peak: Rounds,
}

pub(crate) fn run(scope: &mut Scope) -> BenchResult {
    let sizes = if scope.quick {
        &SIZES[..3]
    } else {
        &SIZES[1..]
    };
    let mut rows = Vec::new();
    let mut exponents = Vec::new();
    for method in Direct::ALL {
        let (mut points, mut work) = (Vec::new(), Vec::new());
        for &cells in sizes {
            let rounds = if cells == SIZES[3] {
                3
            } else {
                scope.choose(3, 5)
            };
            let equations = Equations::new(method.soil(), cells)?;
            let taken = measure(scope, method, &equations, rounds)?;
            note(scope, method, &equations, &taken, &mut rows)?;
            let unknowns = equations.matrix.pattern.unknowns() as f64;
            points.push([unknowns, taken.factor[0].median()]);
            let dense = taken.factor[0].with(&taken.peak, |time, peak| time * peak);
            work.push([unknowns, dense.median()]);
        }
        let power = exponent(&work);
        exponents.push(format!("{} {power:.2}", method.name()));
        let power = Rounds(vec![power]);
        let largest = points.last().map_or(0, |point| point[0] as usize);
        scope.report.row(
            "factorisation",
            &format!("{}/exponent", method.name()),
            largest,
            "-",
            &power,
        );
        let label = format!("factorisation, {}", method.name());
        scope.curves.push(Curve {
            label,
            points,
            power: 1.5,
        });
    }
    let report = &mut scope.report;
    report.heading("Linear equations");
    report.paragraph(&format!(
        "Tangents of a square block, Cholesky with von Mises soil, LU with Mohr–Coulomb soil; times \
         in ms, on one thread where no other number is given. *Analysis* contains the ordering. *Rate* \
         counts the operations of the plan of elimination; *peak* is a dense product of 1024 rows on \
         one thread, measured in turn with it. The time of a factorisation, as the operations that \
         the dense product does meanwhile, grows with the number of unknowns to the power: {}; 1.5 is \
         what theory says of the operations in the plane.",
        exponents.join(", ")
    ));
    let header = [
        "method",
        "unknowns",
        "entries",
        "ordering",
        "analysis",
        "threads",
        "factorisation",
        "gain",
        "solution",
        "rate [GFlop/s]",
        "peak [GFlop/s]",
        "share",
    ];
    report.table(header, &rows);
    Ok(())
}

fn measure(
    scope: &Scope,
    method: Direct,
    equations: &Equations,
    rounds: usize,
) -> BenchResult<Measured> {
    let pattern = &equations.matrix.pattern;
    let mut taken = Measured {
        factor: vec![Rounds::default(); scope.pools.len()],
        ..Measured::default()
    };
    let mut peak = DensePeak::new();
    peak.measure();
    let mut du = Vec::new();
    let mut solver = method.solver();
    scope.pools[0].install(|| solver.factor(&equations.matrix))?;
    for _ in 0..rounds {
        let order = || Ok::<_, std::convert::Infallible>(NestedDissection::new(pattern));
        taken.order.push(timed(order)?);
        let mut fresh = method.solver();
        let analysed = scope.pools[0].install(|| timed(|| fresh.analyse(pattern)))?;
        taken.analyse.push(analysed);
        drop(fresh);
        taken.peak.push(peak.measure());
        for (pool, factor) in std::iter::zip(&scope.pools, &mut taken.factor) {
            factor.push(pool.install(|| timed(|| solver.factor(&equations.matrix)))?);
        }
        let solved = scope.pools[0].install(|| timed(|| equations.solve(&mut *solver, &mut du)))?;
        taken.solve.push(solved);
    }
    Ok(taken)
}

fn note(
    scope: &mut Scope,
    method: Direct,
    equations: &Equations,
    taken: &Measured,
    rows: &mut Vec<[String; 12]>,
) -> BenchResult {
    let pattern = &equations.matrix.pattern;
    let unknowns = pattern.unknowns();
    let operations = equations.operations(method)?;
    let report = &mut scope.report;
    let per_unknown = |times: &Rounds| times.map(|time| time / unknowns as f64);
    for (phase, times) in [
        ("order", &taken.order),
        ("analyse", &taken.analyse),
        ("solve", &taken.solve),
    ] {
        let name = format!("{}/{phase}", method.name());
        report.row(
            "factorisation",
            &name,
            unknowns,
            "ns/unknown",
            &per_unknown(times),
        );
    }
    let ms = |times: &Rounds| format!("{:.2}", times.median() / 1e6);
    for (pool, factor) in std::iter::zip(&scope.pools, &taken.factor) {
        let count = pool.current_num_threads();
        let name = |part: &str| format!("{}/{part}/{}", method.name(), threads::name(count));
        let rate = factor.map(|time| operations / time);
        let share = rate.over(&taken.peak).map(|share| 100.0 * share);
        report.row(
            "factorisation",
            &name("factor"),
            unknowns,
            "ns/unknown",
            &per_unknown(factor),
        );
        report.row("factorisation", &name("rate"), unknowns, "GFlop/s", &rate);
        report.row(
            "factorisation",
            &name("share-of-peak"),
            unknowns,
            "%",
            &share,
        );
        rows.push([
            method.name().to_owned(),
            unknowns.to_string(),
            pattern.stored().to_string(),
            ms(&taken.order),
            ms(&taken.analyse),
            count.to_string(),
            ms(factor),
            format!("{:.2}", taken.factor[0].over(factor).median()),
            ms(&taken.solve),
            format!("{:.1}", rate.median()),
            format!("{:.1}", taken.peak.median()),
            format!("{:.0} %", share.median()),
        ]);
    }
    Ok(())
}
