//! GOAL: all linear solvers recover the same known solution, on matrices like the tangent of a
//! body of particles on one- to three-dimensional grids, and do so with the same bits every time.

use std::collections::BTreeMap;

use crate::support::{Body, chain, distance, manufactured, stored};
use igimp_linear::TangentMatrix;
use igimp_linear::{LinearSolver, MultifrontalLu, SolverKind};
use proptest::prelude::*;

const DIRECT: [SolverKind; 5] = [
    SolverKind::Auto,
    SolverKind::FaerCholesky,
    SolverKind::MultifrontalCholesky,
    SolverKind::Multifrontal,
    SolverKind::NalgebraCholesky,
];
const UNSYMMETRIC: [SolverKind; 3] = [
    SolverKind::Auto,
    SolverKind::Multifrontal,
    SolverKind::SprsBiCgStab,
];

fn recovers(solver: &mut dyn LinearSolver, matrix: &TangentMatrix) {
    let (exact, rhs) = manufactured(matrix, 11);
    solver.factor(matrix).unwrap();
    let mut solution = vec![f64::NAN; rhs.len()];
    let report = solver.solve(matrix, &rhs, &mut solution).unwrap();
    let error = distance(&exact, &solution);
    let case = format!("{} on {} unknowns", solver.name(), rhs.len());
    assert!(report.relative_residual <= 1e-11, "{case}: {report:?}");
    assert!(error <= 1e-9, "{case}: error {error:e}, {report:?}");
    assert_eq!(report.perturbed_pivots, 0, "{case}");
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
        let matrix = body.tangent();
        for kind in SolverKind::ALL {
            recovers(&mut *kind.build(), &matrix);
        }
    }
}

/// GOAL: a quasi-definite matrix is factorised without pivots, by L J Lᵀ, in any order of elimination, also where fronts are
/// stored by strides; one that is none, with the wrong sign of one pressure, goes to LU. Single precision and multigrid by blocks come to the
/// same.
/// ORACLE: the known solution.
#[test]
fn pressures_are_factorised_with_their_signs() {
    for body in bodies() {
        let matrix = body.clone().pressure().tangent();
        assert_eq!(
            method(&mut *SolverKind::Auto.build(), &matrix),
            "multifrontal-ldlt"
        );
        for kind in [
            SolverKind::Single,
            SolverKind::Multigrid,
            SolverKind::Multifrontal,
        ] {
            recovers(&mut *kind.build(), &matrix);
        }
        recovers(
            &mut *SolverKind::Auto.build(),
            &body.pressure().unsymmetric(0.2).tangent(),
        );
    }
    let solid = Body {
        particles: 1,
        ..Body::solid([14, 14, 14])
    };
    let matrix = solid.pressure().tangent();
    let mut cholesky = SolverKind::MultifrontalCholesky.build();
    assert_eq!(method(&mut *cholesky, &matrix), "multifrontal-ldlt");
    let mut matrix = Body::plane(9, 8).pressure().tangent();
    let last = matrix.pattern.unknowns() - 1;
    let mut entries = stored(&matrix.pattern).into_iter();
    let (_, _, index) = entries
        .find(|&(column, row, _)| column == last && row == last)
        .unwrap();
    matrix.values[index] *= -50.0;
    assert_eq!(
        method(&mut *SolverKind::Auto.build(), &matrix),
        "multifrontal-lu"
    );
}

/// The method by which a solver recovers a known solution.
fn method(solver: &mut dyn LinearSolver, matrix: &TangentMatrix) -> &'static str {
    recovers(solver, matrix);
    let (_, rhs) = manufactured(matrix, 5);
    let mut solution = vec![0.0; rhs.len()];
    solver.solve(matrix, &rhs, &mut solution).unwrap().method
}

#[test]
fn lu_and_iteration_agree_on_unsymmetric_matrices() {
    for body in bodies() {
        let matrix = body.unsymmetric(0.2).tangent();
        for kind in UNSYMMETRIC {
            recovers(&mut *kind.build(), &matrix);
        }
    }
}

#[test]
fn direct_solvers_recover_twenty_thousand_unknowns() {
    let body = Body {
        particles: 1,
        ..Body::plane(100, 100)
    };
    let matrix = body.tangent();
    for kind in DIRECT {
        recovers(&mut *kind.build(), &matrix);
    }
    recovers(
        &mut MultifrontalLu::default(),
        &body.unsymmetric(0.2).tangent(),
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn direct_solvers_recover_bodies_of_any_shape(
        nodes in (1_usize..14, 1_usize..14, 1_usize..4),
        dofs in 1_usize..4,
        slope: bool,
        seed: u64,
    ) {
        let nodes = [nodes.0, nodes.1, nodes.2];
        let body = Body { nodes, dofs, slope, seed, ..Body::plane(1, 1) };
        let matrix = body.tangent();
        for kind in DIRECT {
            recovers(&mut *kind.build(), &matrix);
        }
        recovers(&mut MultifrontalLu::default(), &body.unsymmetric(0.2).tangent());
    }
}

/// Nodes at the rim of a body carry next to nothing; that must not be mistaken for singularity.
#[test]
fn stiffness_may_span_twenty_decades() {
    for (unsymmetric, kinds) in [(0.0, &DIRECT[..]), (0.2, &UNSYMMETRIC[..2])] {
        let mut matrix = Body::plane(13, 9).unsymmetric(unsymmetric).tangent();
        let weight = |unknown: usize| 10_f64.powf(-((unknown * 7 % 11) as f64));
        for (column, row, entry) in stored(&matrix.pattern) {
            matrix.values[entry] *= weight(column) * weight(row);
        }
        let unknowns = matrix.pattern.unknowns();
        let scaled: Vec<f64> = (0..unknowns).map(|k| 1.0 / weight(k)).collect();
        let mut rhs = vec![0.0; scaled.len()];
        matrix.multiply(&scaled, &mut rhs);
        for kind in kinds {
            let mut solver = kind.build();
            solver.factor(&matrix).unwrap();
            let mut solution = vec![0.0; rhs.len()];
            let report = solver.solve(&matrix, &rhs, &mut solution).unwrap();
            assert_eq!(report.perturbed_pivots, 0, "{kind:?}");
            for (x, exact) in solution.iter().zip(&scaled) {
                assert!(
                    (x / exact - 1.0).abs() < 1e-9,
                    "{kind:?}: {x:e} for {exact:e}"
                );
            }
        }
    }
}

/// A bar of springs that hangs under its weight: rounding alone leaves more than 1e-12 of the load. Whoever asks for less,
/// as Newton's method does, is spared the refinement.
#[test]
fn factors_are_refined_to_what_is_asked() {
    const SPRINGS: usize = 300;
    let stiffness = |spring: usize| 1.0 / (1.0 + 0.3 * (spring % 7) as f64);
    let mut entries = BTreeMap::new();
    let (mut exact, mut end) = (Vec::new(), 0.0);
    for spring in 0..SPRINGS {
        let k = stiffness(spring);
        *entries.entry((spring, spring)).or_insert(0.0) += k;
        if let Some(above) = spring.checked_sub(1) {
            *entries.entry((above, above)).or_insert(0.0) += k;
            entries.insert((above, spring), -k);
            entries.insert((spring, above), -k);
        }
        end += (SPRINGS - spring) as f64 / k;
        exact.push(end);
    }
    let matrix = chain(&entries, SPRINGS, true);
    let rhs = vec![1.0; SPRINGS];
    for kind in [
        SolverKind::Auto,
        SolverKind::MultifrontalCholesky,
        SolverKind::Multifrontal,
    ] {
        let mut solver = kind.build();
        solver.factor(&matrix).unwrap();
        let mut refinements = |asked: Option<f64>| {
            if let Some(asked) = asked {
                solver.ask_for(asked);
            }
            let mut solution = vec![0.0; SPRINGS];
            let report = solver.solve(&matrix, &rhs, &mut solution).unwrap();
            assert!(report.relative_residual <= 1e-9, "{kind:?}: {report:?}");
            let error = distance(&exact, &solution) / end;
            assert!(error <= 1e-9, "{kind:?}: error {error:e}");
            report.refinements
        };
        assert!(refinements(None) > 0, "{kind:?}");
        assert_eq!(refinements(Some(1e-4)), 0, "{kind:?}");
        assert!(refinements(Some(1e-12)) > 0, "{kind:?}");
    }
}

#[test]
fn a_zero_right_hand_side_gives_zero() {
    let matrix = Body::plane(5, 5).tangent();
    let zeros = vec![0.0; matrix.pattern.unknowns()];
    for kind in SolverKind::ALL {
        let mut solver = kind.build();
        solver.factor(&matrix).unwrap();
        let mut solution = vec![1.0; zeros.len()];
        let report = solver.solve(&matrix, &zeros, &mut solution).unwrap();
        assert_eq!(solution, zeros, "{kind:?}");
        assert!(report.relative_residual == 0.0, "{kind:?}");
    }
}

#[test]
fn analysis_is_reused_while_the_pattern_stays() {
    let body = Body::plane(8, 6);
    let matrix = body.tangent();
    let other = Body::plane(6, 8).tangent();
    for kind in SolverKind::ALL {
        let mut solver = kind.build();
        solver.analyse(&matrix.pattern).unwrap();
        recovers(&mut *solver, &matrix);
        recovers(&mut *solver, &body.clone().seed(3).tangent());
        assert_eq!(solver.analyses(), 1, "{kind:?}: equal patterns");
        recovers(&mut *solver, &other);
        assert_eq!(solver.analyses(), 2, "{kind:?}: another pattern");
        recovers(&mut *solver, &matrix);
        assert_eq!(solver.analyses(), 3, "{kind:?}: the first again");
    }
}

#[test]
fn repetition_gives_the_same_bits() {
    for unsymmetric in [0.0, 0.2] {
        let matrix = Body::plane(23, 14).unsymmetric(unsymmetric).tangent();
        let other = Body::plane(9, 9).unsymmetric(unsymmetric).tangent();
        let (_, rhs) = manufactured(&matrix, 5);
        for kind in if unsymmetric == 0.0 {
            &SolverKind::ALL[..]
        } else {
            &UNSYMMETRIC[..]
        } {
            let mut solver = kind.build();
            let mut bits = || {
                let mut solution = vec![0.0; rhs.len()];
                solver.factor(&matrix).unwrap();
                solver.solve(&matrix, &rhs, &mut solution).unwrap();
                solver.factor(&other).unwrap();
                solution.into_iter().map(f64::to_bits).collect::<Vec<_>>()
            };
            assert_eq!(bits(), bits(), "{kind:?}");
        }
    }
}
