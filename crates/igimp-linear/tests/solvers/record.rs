//! GOAL: a record keeps the system that it was asked for and changes nothing.
//! ORACLE: the same solver without a record, and the systems that it was given.

use crate::support::{Body, manufactured};
use igimp_linear::TangentMatrix;
use igimp_linear::{LinearSolver, LinearSolverError, Record, SolverKind};

fn solve(solver: &mut dyn LinearSolver, matrix: &TangentMatrix, rhs: &[f64]) -> Vec<f64> {
    let mut solution = vec![0.0; rhs.len()];
    solver.factor(matrix).unwrap();
    solver.solve(matrix, rhs, &mut solution).unwrap();
    solution
}

#[test]
fn the_second_system_is_kept_or_the_only_one() {
    let matrices: Vec<TangentMatrix> = (1..=4)
        .map(|seed| Body::plane(7, 5).seed(seed).tangent())
        .collect();
    let record = Record::of_system(2);
    let mut recorded = record.around(SolverKind::Auto.build());
    let mut plain = SolverKind::Auto.build();
    assert!(record.take().is_none());

    for systems in [1, 2, 4] {
        let mut expected = Vec::new();
        for matrix in &matrices[..systems] {
            let (_, rhs) = manufactured(matrix, 3);
            let solution = solve(&mut *recorded, matrix, &rhs);
            assert_eq!(solution, solve(&mut *plain, matrix, &rhs));
            expected.push((matrix.values.clone(), rhs, solution));
        }
        let kept = record.take().unwrap();
        assert_eq!(kept.number, systems.min(2));
        assert_eq!(
            (kept.matrix.values, kept.rhs, kept.solution),
            expected[kept.number - 1]
        );
        assert!(record.take().is_none(), "the record begins anew");
    }
    assert_eq!(recorded.name(), plain.name());
    assert_eq!(recorded.analyses(), plain.analyses());
}

#[test]
fn a_system_that_cannot_be_solved_is_not_kept() {
    let mut matrix = Body::plane(4, 4).tangent();
    let (_, rhs) = manufactured(&matrix, 3);
    let record = Record::of_system(1);
    let mut solver = record.around(SolverKind::FaerCholesky.build());
    matrix.values.fill(0.0);
    assert!(solver.factor(&matrix).is_err());
    let mut solution = vec![0.0; rhs.len()];
    assert_eq!(
        solver.solve(&matrix, &rhs, &mut solution),
        Err(LinearSolverError::NotFactored)
    );
    assert!(record.take().is_none());
}
