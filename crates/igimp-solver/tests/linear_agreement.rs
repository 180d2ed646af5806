//! GOAL: all linear solvers recover the same known solution, on matrices like the tangent of a
//! body of particles on one- to three-dimensional grids.

#[path = "linear_support/mod.rs"]
mod support;

use igimp_solver::linear::SolverKind;
use support::{Body, distance, manufactured};

fn recovers(kind: SolverKind, body: &Body) {
    let matrix = body.tangent();
    let (exact, rhs) = manufactured(&matrix, 11);
    let mut solver = kind.build();
    solver.factor(&matrix).unwrap();
    let mut solution = vec![0.0; rhs.len()];
    let report = solver.solve(&rhs, &mut solution).unwrap();
    assert!(report.relative_residual <= 1e-11, "{kind:?}: {report:?}");
    let error = distance(&exact, &solution);
    assert!(error <= 1e-9, "{kind:?} on {} unknowns: error {error:e}", rhs.len());
}

fn bodies() -> Vec<Body> {
    vec![
        Body::line(1),
        Body::line(2),
        Body::line(57),
        Body::plane(3, 3),
        Body::plane(4, 9),
        Body::plane(30, 17),
        Body::plane(31, 20).slope(),
        Body::solid([6, 5, 7]),
    ]
}

#[test]
fn all_agree_on_symmetric_matrices() {
    for body in bodies() {
        for kind in SolverKind::ALL {
            recovers(kind, &body);
        }
    }
}

#[test]
fn lu_and_iteration_agree_on_unsymmetric_matrices() {
    for body in bodies() {
        let body = body.unsymmetric(0.2);
        for kind in [SolverKind::Auto, SolverKind::Multifrontal, SolverKind::SprsBiCgStab] {
            recovers(kind, &body);
        }
    }
}

#[test]
fn direct_solvers_recover_twenty_thousand_unknowns() {
    let body = Body { particles: 1, ..Body::plane(100, 100) };
    recovers(SolverKind::FaerCholesky, &body);
    recovers(SolverKind::NalgebraCholesky, &body);
    recovers(SolverKind::Multifrontal, &body);
    recovers(SolverKind::Multifrontal, &body.unsymmetric(0.2));
}
