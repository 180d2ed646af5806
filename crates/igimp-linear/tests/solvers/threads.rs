//! GOAL: the multifrontal solvers give the same bits on any number of threads, also where the tree
//! is cut into tasks and large fronts are shared.
//! ORACLE: the bits of one thread, and the known solution.

use crate::support::{Body, distance, manufactured};
use igimp_linear::SolverKind;
use rayon::ThreadPoolBuilder;

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let large = |body: Body| Body {
        particles: 1,
        ..body
    };
    let bodies = [
        Body::plane(9, 7),
        large(Body::plane(70, 60)),
        large(Body::plane(80, 80).slope()),
        large(Body::solid([11, 12, 10])),
        large(Body::plane(60, 60).pressure()),
    ];
    for body in bodies {
        for (unsymmetric, kinds) in [
            (
                0.0,
                &[SolverKind::MultifrontalCholesky, SolverKind::Multifrontal][..],
            ),
            (0.2, &[SolverKind::Auto]),
        ] {
            let matrix = body.clone().unsymmetric(unsymmetric).tangent();
            let (exact, rhs) = manufactured(&matrix, 3);
            for kind in kinds {
                let solve = || {
                    let mut solver = kind.build();
                    let mut solution = vec![0.0; rhs.len()];
                    // Twice: the second time in memory that is used again.
                    for _ in 0..2 {
                        solver.factor(&matrix).unwrap();
                        solver.solve(&matrix, &rhs, &mut solution).unwrap();
                    }
                    solution
                };
                let alone = on_threads(1, solve);
                assert!(distance(&exact, &alone) < 1e-9);
                for threads in [2, 3, 7] {
                    let together = on_threads(threads, solve);
                    let same =
                        std::iter::zip(&alone, &together).all(|(a, b)| a.to_bits() == b.to_bits());
                    assert!(
                        same,
                        "{kind:?} on {threads} threads, {} unknowns",
                        rhs.len()
                    );
                }
            }
        }
    }
}

/// A failure names the same unknown, wherever it was met first.
#[test]
fn failures_do_not_depend_on_the_number_of_threads() {
    let body = Body {
        particles: 1,
        ..Body::plane(70, 60)
    };
    let mut matrix = body.tangent();
    for value in &mut matrix.values {
        *value = -*value;
    }
    let factor = || SolverKind::MultifrontalCholesky.build().factor(&matrix);
    let alone = on_threads(1, factor);
    assert!(alone.is_err());
    for threads in [2, 3, 7] {
        assert_eq!(alone, on_threads(threads, factor), "{threads} threads");
    }
}
