//! GOAL: a pattern by blocks is the scalar pattern that it stands for, and symbolic work lasts while
//! the nodes do.
//! ORACLE: products and entries of `nalgebra-sparse` matrices; solutions that are known.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::support::{Body, distance, manufactured, stored};
use igimp_linear::{LinearSolver, MultifrontalLu, SolverKind};
use igimp_linear::{Pattern, TangentMatrix};
use nalgebra::DVector;

const PLANNED: [SolverKind; 3] = [
    SolverKind::Auto,
    SolverKind::MultifrontalCholesky,
    SolverKind::Multifrontal,
];

fn bodies() -> [Body; 4] {
    [
        Body::line(9),
        Body::plane(7, 5),
        Body::plane(9, 9).slope().unsymmetric(0.3),
        Body::solid([4, 3, 5]).unsymmetric(0.3),
    ]
}

#[test]
fn blocks_expand_to_compressed_columns() {
    for body in bodies() {
        let matrix = body.tangent();
        let pattern = &matrix.pattern;
        // Every unknown of every pair of coupled blocks, once, in ascending order.
        let mut expected = Vec::new();
        for (index, block) in pattern.blocks.iter().enumerate() {
            for column in block.first..block.first + block.len {
                for &other in pattern.coupled_to(index) {
                    let rows = pattern.blocks[other as usize];
                    expected.extend((rows.first..rows.first + rows.len).map(|row| (column, row)));
                }
            }
        }
        let entries = stored(pattern);
        assert_eq!(entries.len(), pattern.stored());
        let places = entries.iter().map(|&(column, row, _)| (column, row));
        assert!(places.eq(expected));
    }
}

#[test]
fn products_and_diagonals_are_those_of_the_expanded_matrix() {
    for body in bodies() {
        let matrix = body.tangent();
        let csc = matrix.to_csc();
        let n = matrix.pattern.unknowns();
        let x: Vec<f64> = (0..n).map(|k| (k as f64).sin()).collect();
        let mut y = vec![f64::NAN; n];
        matrix.multiply(&x, &mut y);
        let expected = &csc * DVector::from_column_slice(&x);
        assert!(distance(expected.as_slice(), &y) < 1e-12);
        for (unknown, entry) in matrix.diagonal().enumerate() {
            let expected = csc.get_entry(unknown, unknown).unwrap().into_value();
            assert!(entry.to_bits() == expected.to_bits());
        }
    }
}

/// The matrix without the couplings for which `drop` holds, both ways.
fn without(matrix: &TangentMatrix, drop: impl Fn(usize, usize) -> bool) -> TangentMatrix {
    let pattern = &matrix.pattern;
    let mut starts = vec![0];
    let mut coupled = Vec::new();
    for block in 0..pattern.blocks.len() {
        let rows = pattern.coupled_to(block).iter().copied();
        coupled.extend(rows.filter(|&row| {
            let row = row as usize;
            row == block || !drop(row.min(block), row.max(block))
        }));
        starts.push(coupled.len());
    }
    let fewer = Pattern::new(pattern.blocks.clone(), starts, coupled, pattern.reach);
    let mut reduced = TangentMatrix::zeros(Arc::new(fewer), matrix.symmetric);
    let values: BTreeMap<(usize, usize), f64> = stored(pattern)
        .into_iter()
        .map(|(column, row, entry)| ((column, row), matrix.values[entry]))
        .collect();
    for (column, row, entry) in stored(&reduced.pattern) {
        reduced.values[entry] = values[&(column, row)];
    }
    // Still positive definite without the couplings.
    let mut lost = vec![0.0; pattern.unknowns()];
    for (&(column, _), value) in &values {
        lost[column] += value.abs();
    }
    for (column, row, entry) in stored(&reduced.pattern) {
        if column == row {
            reduced.values[entry] += lost[column];
        }
    }
    reduced
}

fn recovers(solver: &mut dyn LinearSolver, matrix: &TangentMatrix) {
    let (exact, rhs) = manufactured(matrix, 11);
    let mut solution = vec![0.0; rhs.len()];
    solver.factor(matrix).unwrap();
    let report = solver.solve(matrix, &rhs, &mut solution).unwrap();
    assert!(report.relative_residual < 1e-11, "{report:?}");
    assert!(distance(&exact, &solution) < 1e-9, "{}", solver.name());
}

#[test]
fn analysis_lasts_while_couplings_change_within_reach() {
    let full = Body::plane(14, 11).tangent();
    let fewer = without(&full, |a, b| (3 * a + 7 * b).is_multiple_of(5));
    let least = without(&full, |a, b| a != b);
    for kind in PLANNED {
        // Planned for few couplings, and then used for more.
        let mut solver = kind.build();
        for matrix in [&least, &fewer, &full, &fewer] {
            recovers(&mut *solver, matrix);
        }
        assert_eq!(solver.analyses(), 1, "{kind:?}");
    }
}

#[test]
fn analysis_is_redone_when_nodes_or_the_reach_change() {
    let full = Body::plane(14, 11).tangent();
    let slope = Body::plane(14, 11).slope().tangent();
    let mut wider = (*full.pattern).clone();
    wider.reach += 1;
    let wider = TangentMatrix {
        pattern: Arc::new(wider),
        ..full.clone()
    };
    for kind in PLANNED {
        let mut solver = kind.build();
        for (analyses, matrix) in [&full, &slope, &full, &wider].into_iter().enumerate() {
            recovers(&mut *solver, matrix);
            assert_eq!(solver.analyses(), analyses + 1, "{kind:?}");
        }
        // A smaller reach would be covered, but a fresh solver would plan otherwise.
        recovers(&mut *solver, &full);
        assert_eq!(solver.analyses(), 5, "{kind:?}");
    }
}

/// Couplings that a pattern does not announce by its reach are found nevertheless.
#[test]
fn couplings_beyond_the_reach_are_planned_for() {
    let full = Body::plane(14, 11).tangent();
    let mut understated = (*full.pattern).clone();
    understated.reach = 1;
    let matrix = TangentMatrix {
        pattern: Arc::new(understated),
        ..full
    };
    for kind in PLANNED {
        recovers(&mut *kind.build(), &matrix);
    }
}

/// A body with some nodes of its upper rim coupled to nodes three layers away, as tied nodes are.
fn with_far_couplings(body: &Body) -> TangentMatrix {
    let matrix = body.tangent();
    let pattern = &matrix.pattern;
    let at = |place: [usize; 3]| {
        let mut blocks = pattern.blocks.iter();
        blocks.position(|block| block.place == place).unwrap()
    };
    let top = body.nodes[1] - 1;
    let far: Vec<[usize; 2]> = [4, 15, 26]
        .map(|x| [at([x, top, 0]), at([x + 3, top - 1, 0])])
        .to_vec();
    let coupled = |a: usize, b: usize| far.contains(&[a, b]) || far.contains(&[b, a]);
    let (mut starts, mut rows) = (vec![0], Vec::new());
    for block in 0..pattern.blocks.len() {
        let near = pattern.coupled_to(block);
        let is_row = |&row: &u32| near.contains(&row) || coupled(block, row as usize);
        rows.extend((0..pattern.blocks.len() as u32).filter(is_row));
        starts.push(rows.len());
    }
    let more = Pattern::new(pattern.blocks.clone(), starts, rows, 3);
    let mut extended = TangentMatrix::zeros(Arc::new(more), matrix.symmetric);
    let values: BTreeMap<(usize, usize), f64> = stored(pattern)
        .into_iter()
        .map(|(column, row, entry)| ((column, row), matrix.values[entry]))
        .collect();
    for (column, row, entry) in stored(&extended.pattern) {
        extended.values[entry] = values.get(&(column, row)).copied().unwrap_or(1e-3);
    }
    extended
}

#[test]
fn a_few_far_couplings_cost_next_to_nothing() {
    for unsymmetric in [0.0, 0.3] {
        let body = Body::plane(40, 30).unsymmetric(unsymmetric);
        let far = with_far_couplings(&body);
        for kind in PLANNED {
            let mut solver = kind.build();
            if unsymmetric == 0.0 || kind != SolverKind::MultifrontalCholesky {
                recovers(&mut *solver, &far);
            }
        }
        let operations = |matrix: &TangentMatrix| {
            let mut solver = MultifrontalLu::default();
            solver.analyse(&matrix.pattern).unwrap();
            solver.factor_operations()
        };
        let ratio = operations(&far) / operations(&body.tangent());
        assert!(ratio < 1.15, "{ratio}");
    }
}
