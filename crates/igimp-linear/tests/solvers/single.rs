//! GOAL: factors in single precision, with an iteration around them, solve to what is asked; where they
//! do not serve, double precision does, and the reason is reported.
//! ORACLE: known solutions; the solution of the factors in double precision.

use crate::support::{Body, distance, manufactured};
use igimp_linear::TangentMatrix;
use igimp_linear::{AutoSolver, LinearSolver, LinearSolverError, Reason, SolverKind};
use rayon::ThreadPoolBuilder;

/// Bodies with one particle a cell, large enough to be cut into tasks.
fn bodies() -> [Body; 3] {
    let large = |body: Body| Body {
        particles: 1,
        ..body
    };
    [
        Body::plane(9, 7),
        large(Body::plane(70, 60)),
        large(Body::solid([11, 12, 10])),
    ]
}

/// Takes a part of the largest diagonal entry off all of them: far from positive definite.
fn indefinite(body: &Body) -> TangentMatrix {
    let mut matrix = body.clone().tangent();
    let most = matrix.diagonal().fold(0.0, f64::max);
    let pattern = matrix.pattern.clone();
    let columns = pattern.compressed_columns();
    for column in 0..pattern.unknowns() {
        for entry in columns.col_ptr[column]..columns.col_ptr[column + 1] {
            if columns.row_idx[entry] == column {
                matrix.values[entry] -= 0.4 * most;
            }
        }
    }
    matrix
}

#[test]
fn the_solution_is_as_good_as_asked_for_on_any_number_of_threads() {
    for body in bodies() {
        for unsymmetric in [0.0, 0.2] {
            let matrix = body.clone().unsymmetric(unsymmetric).tangent();
            let (exact, rhs) = manufactured(&matrix, 3);
            let found = |threads| {
                let pool = ThreadPoolBuilder::new().num_threads(threads).build();
                pool.unwrap().install(|| {
                    let mut solver = SolverKind::Single.build();
                    solver.ask_for(1e-11);
                    let mut solution = vec![0.0; rhs.len()];
                    for _ in 0..2 {
                        solver.factor(&matrix).unwrap();
                        let report = solver.solve(&matrix, &rhs, &mut solution).unwrap();
                        assert!(report.method.starts_with("single"), "{report:?}");
                        assert!((1..20).contains(&report.refinements), "{report:?}");
                        assert!(report.relative_residual < 1e-9, "{report:?}");
                    }
                    assert_eq!(solver.effort().reason, Reason::Asked);
                    solution
                })
            };
            let alone = found(1);
            assert!(distance(&exact, &alone) < 1e-6);
            for threads in [2, 3, 7] {
                let same = std::iter::zip(&alone, &found(threads))
                    .all(|(a, b)| a.to_bits() == b.to_bits());
                assert!(same, "{threads} threads, {} unknowns", rhs.len());
            }
        }
    }
}

#[test]
fn what_is_not_positive_definite_is_factorised_in_double_precision() {
    let matrix = indefinite(&Body::plane(9, 7));
    let (exact, rhs) = manufactured(&matrix, 3);
    let mut solver = SolverKind::Single.build();
    let mut solution = vec![0.0; rhs.len()];
    solver.factor(&matrix).unwrap();
    let report = solver.solve(&matrix, &rhs, &mut solution).unwrap();
    assert_eq!(report.method, "multifrontal-lu");
    assert!(distance(&exact, &solution) < 1e-6);
    let effort = solver.effort();
    assert_eq!(effort.reason, Reason::SingleFailed { iterations: 0 });
    assert_eq!(
        effort.reason.to_string(),
        "not positive definite in single precision"
    );
    // It is not tried again in this step, but in the next.
    let sound = Body::plane(9, 7).tangent();
    solver.factor(&sound).unwrap();
    assert_eq!(solver.effort().reason, effort.reason);
    solver.start_step();
    solver.factor(&sound).unwrap();
    assert_eq!(solver.effort().reason, Reason::Asked);
}

#[test]
fn auto_takes_it_where_factors_fit_no_other_way_and_iteration_fails() {
    let mut matrix = indefinite(&Body::solid([11, 12, 10]));
    matrix.symmetric = false;
    let (exact, rhs) = manufactured(&matrix, 3);
    let mut solution = vec![0.0; rhs.len()];
    let mut tight = AutoSolver::by_iteration().with_factor_bytes(1000);
    tight.factor(&matrix).unwrap();
    let factors = match tight.effort().reason {
        Reason::Memory { factors, .. } => factors,
        other => panic!("{other:?}"),
    };
    // There is room for neither.
    let refused = tight.solve(&matrix, &rhs, &mut solution);
    assert!(
        matches!(refused, Err(LinearSolverError::NotConverged { .. })),
        "{refused:?}"
    );

    let allowed = factors * 2 / 3;
    let mut solver = AutoSolver::by_iteration().with_factor_bytes(allowed);
    solver.ask_for(1e-9);
    solver.factor(&matrix).unwrap();
    let report = solver.solve(&matrix, &rhs, &mut solution).unwrap();
    assert_eq!(report.method, "single-gmres");
    assert!(distance(&exact, &solution) < 1e-4);
    let effort = solver.effort();
    assert!(
        matches!(effort.reason, Reason::OnlySingle { iterations, .. } if iterations == effort.lost_iterations),
        "{effort:?}"
    );
}
