//! GOAL: what cannot be solved ends in a typed error, never in a panic or in a silent NaN, and
//! what is merely awkward (zero diagonals, indefinite matrices) is solved.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::support::{Body, Random, assemble, distance, from_dense, manufactured, stored};
use igimp_linear::{GeneralLu, LinearSolver, LinearSolverError, MultifrontalLu, SolverKind};
use igimp_linear::{NodeBlock, Pattern, TangentMatrix};

const CHOLESKY: [SolverKind; 3] = [
    SolverKind::FaerCholesky,
    SolverKind::MultifrontalCholesky,
    SolverKind::NalgebraCholesky,
];
const LU: [SolverKind; 2] = [SolverKind::Auto, SolverKind::Multifrontal];

fn solve(
    kind: SolverKind,
    matrix: &TangentMatrix,
    rhs: &[f64],
) -> Result<Vec<f64>, LinearSolverError> {
    let mut solver = kind.build();
    solver.factor(matrix)?;
    let mut solution = vec![f64::NAN; rhs.len()];
    solver.solve(matrix, rhs, &mut solution)?;
    assert!(
        solution.iter().all(|x| x.is_finite()),
        "{kind:?} handed out {solution:?}"
    );
    Ok(solution)
}

#[test]
fn values_that_are_not_finite_are_refused() {
    for poison in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for kind in SolverKind::ALL {
            let mut matrix = Body::plane(4, 4).tangent();
            let mut rhs = vec![1.0; matrix.pattern.unknowns()];
            let mut solver = kind.build();
            solver.factor(&matrix).unwrap();
            rhs[5] = poison;
            let refused = solver.solve(&matrix, &rhs, &mut vec![0.0; rhs.len()]);
            let array = "right-hand side";
            assert_eq!(
                refused,
                Err(LinearSolverError::NonFinite { array, index: 5 }),
                "{kind:?}"
            );

            matrix.values[17] = poison;
            let refused = solver.factor(&matrix);
            let array = "matrix";
            assert_eq!(
                refused,
                Err(LinearSolverError::NonFinite { array, index: 17 }),
                "{kind:?}"
            );
            rhs[5] = 1.0;
            let refused = solver.solve(&matrix, &rhs, &mut vec![0.0; rhs.len()]);
            assert_eq!(refused, Err(LinearSolverError::NotFactored), "{kind:?}");
        }
    }
}

#[test]
fn solutions_that_overflow_are_refused() {
    let matrix = from_dense(&[&[1e-200, 0.0], &[0.0, 1.0]], true);
    for kind in SolverKind::ALL {
        let refused = solve(kind, &matrix, &[1e200, 1.0]);
        assert!(refused.is_err(), "{kind:?}: {refused:?}");
    }
}

#[test]
fn zero_rows_and_columns_are_named() {
    let row = from_dense(
        &[&[2.0, 1.0, 1.0], &[0.0, 0.0, 0.0], &[1.0, 1.0, 3.0]],
        true,
    );
    let column = from_dense(
        &[&[2.0, 0.0, 1.0], &[1.0, 0.0, 1.0], &[1.0, 0.0, 3.0]],
        true,
    );
    for kind in SolverKind::ALL {
        for matrix in [&row, &column] {
            let refused = solve(kind, matrix, &[1.0; 3]);
            assert_eq!(
                refused,
                Err(LinearSolverError::Singular { unknown: Some(1) }),
                "{kind:?}"
            );
        }
    }
}

/// Springs between the nodes of a grid and none to the ground: constant vectors are in the null
/// space exactly.
fn floating(nodes_x: usize, nodes_y: usize) -> TangentMatrix {
    let mut entries: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    let mut spring = |a: usize, b: usize| {
        for (row, column, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            *entries.entry((column, row)).or_default() += sign;
        }
    };
    for node in 0..nodes_x * nodes_y {
        if node % nodes_x + 1 < nodes_x {
            spring(node, node + 1);
        }
        if node / nodes_x + 1 < nodes_y {
            spring(node, node + nodes_x);
        }
    }
    let block = |first| NodeBlock {
        first,
        len: 1,
        free: 1,
        place: [first % nodes_x, first / nodes_x, 0],
    };
    let blocks = (0..nodes_x * nodes_y).map(block).collect();
    assemble(&entries, nodes_x * nodes_y, blocks, true)
}

#[test]
fn singular_matrices_are_told_from_regular_ones() {
    let twice = from_dense(&[&[1.0, 2.0], &[0.5, 1.0]], false);
    let ones = from_dense(&[&[1.0, 1.0], &[1.0, 1.0]], true);
    let rank_two = from_dense(
        &[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], &[7.0, 8.0, 9.0]],
        false,
    );
    for matrix in [twice, ones, rank_two, floating(7, 5), floating(40, 31)] {
        // Reproducible by the matrix, and not.
        let (_, compatible) = manufactured(&matrix, 2);
        let mut incompatible = compatible.clone();
        incompatible[0] += 1.0;
        for rhs in [&compatible, &incompatible] {
            for kind in LU {
                let refused = solve(kind, &matrix, rhs);
                let is_singular = matches!(refused, Err(LinearSolverError::Singular { .. }));
                assert!(is_singular, "{kind:?}: {refused:?}");
            }
            for kind in CHOLESKY.into_iter().filter(|_| matrix.symmetric) {
                let refused = solve(kind, &matrix, rhs);
                assert!(
                    matches!(refused, Err(LinearSolverError::NotPositiveDefinite { .. })),
                    "{kind:?}: {refused:?}"
                );
            }
        }
        let refused = solve(SolverKind::SprsBiCgStab, &matrix, &incompatible);
        assert!(
            matches!(refused, Err(LinearSolverError::Inaccurate { .. })),
            "{refused:?}"
        );
    }
}

/// The stored entries on the diagonal.
fn diagonal(pattern: &Pattern) -> Vec<(usize, usize, usize)> {
    let mut entries = stored(pattern);
    entries.retain(|&(column, row, _)| column == row);
    entries
}

#[test]
fn indefinite_matrices_go_to_lu() {
    let mut matrix = Body::plane(12, 8).tangent();
    for (_, _, entry) in diagonal(&matrix.pattern) {
        matrix.values[entry] -= 6.0;
    }
    let (exact, rhs) = manufactured(&matrix, 4);
    for kind in CHOLESKY {
        let refused = solve(kind, &matrix, &rhs);
        assert!(
            matches!(refused, Err(LinearSolverError::NotPositiveDefinite { .. })),
            "{kind:?}"
        );
    }
    for kind in LU {
        assert!(
            distance(&exact, &solve(kind, &matrix, &rhs).unwrap()) < 1e-9,
            "{kind:?}"
        );
    }
}

#[test]
fn zero_diagonals_are_no_obstacle_to_lu() {
    let exchange = from_dense(&[&[0.0, 1.0], &[2.0, 0.0]], false);
    let cycle = from_dense(
        &[&[0.0, 3.0, 0.0], &[0.0, 0.0, 2.0], &[1.0, 0.0, 0.0]],
        false,
    );
    let mut random = Random(8);
    let mut grid = Body::plane(16, 11).unsymmetric(0.2).tangent();
    for value in &mut grid.values {
        *value = random.signed();
    }
    for (_, _, entry) in diagonal(&grid.pattern) {
        grid.values[entry] = 0.0;
    }
    for matrix in [exchange, cycle, grid] {
        let (exact, rhs) = manufactured(&matrix, 6);
        for kind in LU {
            let error = distance(&exact, &solve(kind, &matrix, &rhs).unwrap());
            assert!(
                error < 1e-8,
                "{kind:?} on {} unknowns: {error:e}",
                rhs.len()
            );
        }
    }
}

/// Without a diagonal to rely on and with most entries zero, fronts run out of usable pivots.
#[test]
fn pivots_out_of_reach_are_replaced_or_left_to_general_lu() {
    let mut random = Random(31);
    let sound = Body::plane(16, 15).unsymmetric(0.2).tangent();
    let (mut refined, mut fell_back) = (0, 0);
    for _ in 0..30 {
        let mut matrix = sound.clone();
        for value in &mut matrix.values {
            *value = if random.signed() < -0.4 {
                random.signed()
            } else {
                0.0
            };
        }
        let (exact, rhs) = manufactured(&matrix, 1);
        let mut general = GeneralLu::default();
        let mut multifrontal = MultifrontalLu::default();
        match (general.factor(&matrix), multifrontal.factor(&matrix)) {
            (Ok(()), Ok(())) => {}
            (Err(LinearSolverError::Singular { .. }), Err(LinearSolverError::Singular { .. })) => {
                continue;
            }
            disagreement => panic!("{disagreement:?}"),
        }
        let mut solution = vec![0.0; rhs.len()];
        general.solve(&matrix, &rhs, &mut solution).unwrap();
        assert!(distance(&exact, &solution) < 1e-6);
        let report = multifrontal.solve(&matrix, &rhs, &mut solution).unwrap();
        assert!(distance(&exact, &solution) < 1e-6, "{report:?}");
        refined += usize::from(report.perturbed_pivots > 0);
        fell_back += usize::from(report.method == "faer-lu");
    }
    assert!(
        refined > 0 && fell_back > 0,
        "{refined} refined, {fell_back} fell back"
    );
}

#[test]
fn misuse_is_refused() {
    let matrix = Body::plane(4, 3).tangent();
    let unsymmetric = Body::plane(4, 3).unsymmetric(0.2).tangent();
    let n = matrix.pattern.unknowns();
    for kind in SolverKind::ALL {
        let mut solver = kind.build();
        let unprepared = solver.solve(&matrix, &vec![1.0; n], &mut vec![0.0; n]);
        assert_eq!(unprepared, Err(LinearSolverError::NotFactored), "{kind:?}");
        solver.factor(&matrix).unwrap();
        let long_rhs = solver.solve(&matrix, &vec![1.0; n + 1], &mut vec![0.0; n]);
        assert!(
            matches!(long_rhs, Err(LinearSolverError::WrongLength { found, .. }) if found == n + 1)
        );
        let short_solution = solver.solve(&matrix, &vec![1.0; n], &mut vec![0.0; n - 1]);
        assert!(
            matches!(short_solution, Err(LinearSolverError::WrongLength { found, .. }) if found == n - 1)
        );
        let another = Body::plane(5, 3).tangent();
        let n_other = another.pattern.unknowns();
        let other_matrix = solver.solve(&another, &vec![1.0; n_other], &mut vec![0.0; n_other]);
        assert!(
            matches!(other_matrix, Err(LinearSolverError::WrongLength { found, .. }) if found == n_other),
            "{kind:?}: {other_matrix:?}"
        );
        let mut cut = matrix.clone();
        cut.values.pop();
        assert!(matches!(
            solver.factor(&cut),
            Err(LinearSolverError::WrongLength { .. })
        ));
    }
    for kind in CHOLESKY {
        assert_eq!(
            kind.build().factor(&unsymmetric),
            Err(LinearSolverError::NotSymmetric)
        );
    }
}

#[test]
fn patterns_are_checked() {
    let sound = (*Body::plane(4, 3).tangent().pattern).clone();
    let empty = Pattern::new(vec![], vec![0], vec![], 2);
    let mut broken = Vec::new();
    let mut breaks = |change: &dyn Fn(&mut Pattern)| {
        let mut pattern = sound.clone();
        change(&mut pattern);
        broken.push(pattern);
    };
    breaks(&|pattern| _ = pattern.blocks.remove(0));
    breaks(&|pattern| pattern.blocks.truncate(3));
    breaks(&|pattern| pattern.blocks[2].len += 1);
    breaks(&|pattern| _ = pattern.coupled.remove(0));
    breaks(&|pattern| pattern.coupled.swap(0, 1));
    breaks(&|pattern| pattern.coupled[pattern.starts[1] - 1] = 1_000_000);
    breaks(&|pattern| pattern.starts[2] = 10_000);
    breaks(&|pattern| pattern.starts[1] = 0);
    breaks(&|pattern| pattern.first_value[1] += 1);
    for kind in SolverKind::ALL {
        let refused = kind.build().analyse(&Arc::new(empty.clone()));
        assert_eq!(refused, Err(LinearSolverError::Empty), "{kind:?}");
        for pattern in &broken {
            let refused = kind.build().analyse(&Arc::new(pattern.clone()));
            assert!(
                matches!(refused, Err(LinearSolverError::InvalidPattern { .. })),
                "{kind:?}: {refused:?}"
            );
        }
    }

    // Lists of blocks, of which the first is coupled to the second alone, or not to itself.
    for lists in [&[&[0, 1][..], &[1]], &[&[1][..], &[0, 1]]] {
        let starts = vec![0, lists[0].len(), lists[0].len() + lists[1].len()];
        let coupled = lists.concat();
        let one_sided = Arc::new(Pattern::new(sound.blocks[..2].to_vec(), starts, coupled, 2));
        for kind in LU {
            let refused = kind.build().analyse(&one_sided);
            assert!(
                matches!(refused, Err(LinearSolverError::InvalidPattern { .. })),
                "{refused:?}"
            );
        }
    }
}
