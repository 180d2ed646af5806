//! GOAL: iteration with multigrid finds what factorisations find, on bodies with holes, ragged surfaces, cut cells and
//! ties, in few iterations that hardly grow with the body, with the same bits on any number of threads; and
//! where it fails it says so or a factorisation takes over.
//! ORACLE: the direct solvers, and the residual of the matrix itself.

use std::sync::Arc;

use crate::body_support::Random;
use crate::consolidation::flow;
use igimp_assembly::{
    Constraints, Method, ParticleSeed, Particles, SharedLaw, Stencils, StepConditions, StepLoads,
    System,
};
use igimp_linear::TangentMatrix;
use igimp_linear::{AutoSolver, LinearSolver, LinearSolverError, Reason, SolveReport, SolverKind};
use igimp_material::{Elasticity, HenckyElastic, MohrCoulomb, TangentKind, VonMises};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, Workspace, step};
use proptest::prelude::*;
use rayon::ThreadPoolBuilder;

fn elastic(poisson: f64) -> SharedLaw {
    Arc::new(HenckyElastic::new(Elasticity::new(1e7, poisson).unwrap()))
}

fn von_mises() -> SharedLaw {
    let elasticity = Elasticity::new(1e7, 0.3).unwrap();
    Arc::new(VonMises::from_undrained_strength(elasticity, 1e4).unwrap())
}

fn mohr_coulomb() -> SharedLaw {
    let elasticity = Elasticity::new(1e7, 0.3).unwrap();
    Arc::new(MohrCoulomb::new(elasticity, 1e4, 0.35, 0.0).unwrap())
}

/// A block of 10 m on its base and with rolling sides, without the cells that `is_empty` takes away; two particles a cell and
/// direction, a little off their places.
fn ground<const D: usize>(
    law: &SharedLaw,
    cells: usize,
    seed: u64,
    is_empty: impl Fn([usize; D]) -> bool,
) -> (Particles<D>, StepConditions<D>) {
    let h = 10.0 / cells as f64;
    let axis = Axis::uniform(0.0, h, cells + 2).unwrap();
    let grid = Grid::new(std::array::from_fn(|_| axis.clone()));
    let mut constraints = Constraints::free(&grid);
    for side in 0..D - 1 {
        constraints.fix_wall(&grid, side, false, side).unwrap();
    }
    for direction in 0..D {
        constraints
            .fix_wall(&grid, D - 1, false, direction)
            .unwrap();
    }
    let mut gravity = [0.0; D];
    gravity[D - 1] = -0.3;
    let loads = StepLoads {
        gravity,
        factors: Vec::new(),
        drag: 0.0,
    };
    let conditions = StepConditions::new(grid, constraints, loads, vec![Arc::clone(law)]).unwrap();
    let mut random = Random(seed);
    let mut seeds = Vec::new();
    for mut part in 0..(2 * cells).pow(D as u32) {
        let place: [usize; D] = std::array::from_fn(|_| {
            let along = part % (2 * cells);
            part /= 2 * cells;
            along
        });
        let x = place.map(|k| 0.5 * h * (k as f64 + 0.5) + 0.1 * h * random.symmetric());
        if !is_empty(place.map(|k| k / 2)) {
            seeds.push(ParticleSeed {
                x,
                half_length: [0.25 * h; D],
                volume: (0.5 * h).powi(D as i32),
                density: 2000.0,
                law: 0,
                centroid: [0.0; _],
            });
        }
    }
    (Particles::new(&seeds).unwrap(), conditions)
}

/// The consistent tangent and the out-of-balance force at a settlement that makes much of the body plastic.
fn equations<const D: usize>(
    (particles, conditions): &(Particles<D>, StepConditions<D>),
) -> (TangentMatrix, Vec<f64>) {
    let method = Method::default();
    let stencils = Stencils::build(particles, &method, conditions).unwrap();
    let system = System::new(particles, &stencils, conditions, &method).unwrap();
    let grid = &conditions.grid;
    let mut u: Vec<[f64; D]> = (0..grid.node_count())
        .map(|node| {
            let x = grid.node_position(node);
            let mut u = [0.0; D];
            u[0] = 3e-4 * (0.3 * x[0]).sin() * x[D - 1];
            u[D - 1] = -1e-3 * x[D - 1] * (1.0 + 0.3 * (0.3 * x[0]).cos());
            u
        })
        .collect();
    u.resize(system.node_count(), [0.0; D]);
    let (trial, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
    let force = system.out_of_balance(&trial).unwrap().force;
    (matrix, force)
}

fn solve(
    solver: &mut dyn LinearSolver,
    (matrix, rhs): &(TangentMatrix, Vec<f64>),
) -> (Vec<f64>, SolveReport) {
    solver.factor(matrix).unwrap();
    let mut solution = vec![0.0; rhs.len()];
    let report = solver.solve(matrix, rhs, &mut solution).unwrap();
    (solution, report)
}

/// Largest difference over the largest entry.
fn off(found: &[f64], expected: &[f64]) -> f64 {
    let size = expected.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let differences = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max) / size
}

/// Iterates to 1e-10, and holds the solution against that of a factorisation and against the equations; the number of
/// iterations.
fn iterations(equations: &(TangentMatrix, Vec<f64>)) -> usize {
    let mut by_iteration = SolverKind::Multigrid.build();
    by_iteration.ask_for(1e-10);
    let (found, report) = solve(&mut *by_iteration, equations);
    assert!(
        report.method.starts_with("multigrid"),
        "{:?}",
        by_iteration.effort()
    );
    let (expected, _) = solve(&mut *SolverKind::Multifrontal.build(), equations);
    // In the norm of energy: nodes that hardly touch soil are held so weakly that a displacement says little.
    let energy = |x: &[f64]| {
        let mut force = vec![0.0; x.len()];
        equations.0.multiply(x, &mut force);
        x.iter().zip(&force).map(|(a, b)| a * b).sum::<f64>().abs()
    };
    let difference: Vec<f64> = found.iter().zip(&expected).map(|(a, b)| a - b).collect();
    let error = (energy(&difference) / energy(&expected)).sqrt();
    assert!(error < 1e-4, "{error} off");
    let mut force = vec![0.0; found.len()];
    equations.0.multiply(&found, &mut force);
    assert!(off(&force, &equations.1) < 1e-6);
    report.refinements
}

#[test]
fn iterations_hardly_grow() {
    let of =
        |law: &SharedLaw, cells| iterations(&equations(&ground::<3>(law, cells, 5, |_| false)));
    for (law, most) in [(elastic(0.3), 60), (von_mises(), 60), (mohr_coulomb(), 60)] {
        let (small, large) = (of(&law, 7), of(&law, 13));
        assert!(
            large <= most && large <= 2 * small + 2,
            "{small}, then {large}"
        );
    }
}

/// Ground whose surface cuts cells, with particles that reach a little into the next ones, takes as many iterations as
/// ground that fills its cells.
#[test]
fn cut_cells_cost_no_iterations() {
    let hill = |[x, y, z]: [usize; 3]| 2 * x + y + 3 * z > 38;
    for (law, most) in [
        (elastic(0.3), 10),
        (elastic(0.49), 25),
        (mohr_coulomb(), 40),
    ] {
        let taken = iterations(&equations(&ground::<3>(&law, 11, 4, hill)));
        assert!(taken <= most, "{taken}, and at most {most}");
    }
}

/// GOAL: soil whose water flows is iterated for as Newton's method asks, from a moment in which it is undrained to one in which it has
/// drained, in numbers that hardly grow with the body; with laws that have symmetric tangents and others.
/// ORACLE: the equations; where water flows, the factors to many digits.
#[test]
fn soil_and_water_are_iterated_for() {
    let laws = [elastic(0.3), von_mises(), mohr_coulomb()];
    // Over H²/c_v, with a modulus of 1.3e7 and a mobility of 1.
    for (law, time) in (laws.iter()).flat_map(|law| [1e-9, 1e-3, 1e3].map(|time| (law, time))) {
        let of = |cells, target: f64| {
            let (particles, conditions) = ground::<3>(law, cells, 5, |[_, _, z]| z + 2 > cells);
            let duration = time * 100.0 / 1.3e7;
            let (matrix, rhs) = equations(&(particles, flow(conditions, [duration, 0.0], 2e9)));
            let mut solver = SolverKind::Multigrid.build();
            solver.ask_for(target);
            let (found, report) = solve(&mut *solver, &(matrix.clone(), rhs.clone()));
            assert_eq!(report.method, "multigrid-coupled-gmres");
            // The norm asked for is Euclid's, and this the largest entry.
            let mut force = vec![0.0; found.len()];
            matrix.multiply(&found, &mut force);
            assert!(off(&force, &rhs) < 30.0 * target, "{time}");
            (matrix, rhs, found, report.refinements)
        };
        let [small, large] = [6, 11].map(|cells| of(cells, 1e-4).3);
        println!("{time:e} H²/c_v: {small} iterations on 6³ cells, {large} on 11³");
        assert!(
            large <= 25 && large <= 2 * small,
            "{time}: {small}, then {large}"
        );
        if time > 1e-6 {
            let (matrix, rhs, found, _) = of(6, 1e-10);
            let (expected, _) = solve(&mut *SolverKind::Multifrontal.build(), &(matrix, rhs));
            assert!(off(&found, &expected) < 1e-6, "{time}");
        }
    }
}

/// GOAL: a border is iterated for with the grid, in hardly more iterations than the grid alone; the equations of the border are met, of
/// which the last one is a constraint without a diagonal.
/// ORACLE: the whole matrix itself.
#[test]
fn a_border_is_iterated_for_with_the_grid() {
    for law in [elastic(0.3), von_mises(), mohr_coulomb()] {
        let (mut matrix, force) = equations(&ground::<3>(&law, 9, 7, |_| false));
        let alone = iterations(&(matrix.clone(), force.clone()));
        let mut random = Random(11);
        let mut side = |len: usize| -> Vec<f64> { (0..len).map(|_| random.symmetric()).collect() };
        let diagonal: f64 = matrix.diagonal().fold(0.0, f64::max);
        for corner in [diagonal, 0.0] {
            let unknowns = force.len() + matrix.border.len();
            let (column, row) = (side(unknowns), side(unknowns));
            matrix.border.append(&column, &row, corner);
        }
        let rhs: Vec<f64> = force.iter().copied().chain([3.0, -2.0]).collect();
        for kind in [SolverKind::Multigrid, SolverKind::Single] {
            let mut solver = kind.build();
            solver.ask_for(1e-10);
            solver.factor(&matrix).unwrap();
            let mut found = vec![0.0; rhs.len()];
            let report = solver.iterate(&matrix, &rhs, &mut found).unwrap().unwrap();
            assert!(
                report.refinements <= alone + 10,
                "{report:?}, {alone} alone"
            );
            let (grid, border) = found.split_at(force.len());
            let mut product = vec![0.0; force.len()];
            matrix.multiply(grid, &mut product);
            let parts = &matrix.border;
            for (column, by) in parts.columns.iter().zip(border) {
                let pairs = product.iter_mut().zip(column);
                pairs.for_each(|(product, entry)| *product += entry * by);
            }
            for (row, corner) in parts.rows.iter().zip(&parts.corner) {
                let sums = [(&row[..], grid), (corner, border)];
                let sums = sums.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>());
                product.push(sums[0] + sums[1]);
            }
            assert!(off(&product, &rhs) < 1e-8, "{kind:?}");
        }
        let mut direct = SolverKind::Multifrontal.build();
        direct.factor(&matrix).unwrap();
        let mut found = vec![0.0; rhs.len()];
        assert_eq!(direct.iterate(&matrix, &rhs, &mut found), Ok(None));
    }
}

#[test]
fn planes_are_solved_too() {
    let slope = |[x, y]: [usize; 2]| x + y > 34;
    for law in [elastic(0.3), von_mises(), mohr_coulomb()] {
        let taken = iterations(&equations(&ground::<2>(&law, 30, 9, slope)));
        assert!(taken < 60, "{taken}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// Ground whose surface goes up and down at random, with caves: pillars that are one cell
    /// wide, and tangents that are not positive definite, may go to a factorisation.
    #[test]
    fn ragged_ground_is_solved(seed: u64, law in 0..3_usize, caves in 0..12_usize) {
        const CELLS: usize = 8;
        let mut random = Random(seed);
        let mut below = |most: usize| ((0.5 * (random.symmetric() + 1.0)) * most as f64) as usize;
        let heights: Vec<usize> = (0..CELLS * CELLS).map(|_| 3 + below(CELLS - 2)).collect();
        let caves: Vec<[usize; 3]> =
            (0..caves).map(|_| [below(CELLS), below(CELLS), 1 + below(3)]).collect();
        let is_empty = |[x, y, z]: [usize; 3]| {
            z >= heights[x + CELLS * y] || caves.contains(&[x, y, z]) && z + 2 < heights[x + CELLS * y]
        };
        let law = [elastic(0.3), von_mises(), mohr_coulomb()][law].clone();
        let equations = equations(&ground::<3>(&law, CELLS, seed, is_empty));
        let mut solver = SolverKind::Multigrid.build();
        solver.ask_for(1e-8);
        let (found, report) = solve(&mut *solver, &equations);
        let mut force = vec![0.0; found.len()];
        equations.0.multiply(&found, &mut force);
        prop_assert!(off(&force, &equations.1) < 1e-6);
        let effort = solver.effort();
        prop_assert!(effort.method == report.method && effort.solutions == 1, "{:?}", effort);
    }
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    for law in [von_mises(), mohr_coulomb()] {
        let hill = |[x, y, z]: [usize; 3]| x + y + z > 26;
        let equations = equations(&ground::<3>(&law, 13, 3, hill));
        let found = |threads| {
            let pool = ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                let mut solver = SolverKind::Multigrid.build();
                solver.ask_for(1e-8);
                // Twice: the second time in memory that is used again.
                solve(&mut *solver, &equations);
                let (solution, report) = solve(&mut *solver, &equations);
                assert!(report.method.starts_with("multigrid"));
                solution.into_iter().map(f64::to_bits).collect::<Vec<_>>()
            })
        };
        let alone = found(1);
        for threads in [2, 3, 7] {
            assert!(alone == found(threads), "{threads} threads");
        }
    }
}

#[test]
fn what_does_not_converge_is_factorised_or_refused() {
    let mut equations = equations(&ground::<3>(&elastic(0.3), 8, 1, |_| false));
    // Far from positive definite.
    let diagonal: f64 = equations.0.diagonal().fold(0.0, f64::max);
    let entries = diagonal_entries(&equations.0);
    for entry in entries {
        equations.0.values[entry] -= 0.4 * diagonal;
    }
    let mut solver = AutoSolver::by_iteration();
    let (found, report) = solve(&mut solver, &equations);
    assert!(report.method.starts_with("multifrontal"), "{report:?}");
    let effort = solver.effort();
    assert!(
        matches!(effort.reason, Reason::NotConverged { iterations } if iterations == effort.lost_iterations),
        "{effort:?}"
    );
    let (expected, _) = solve(&mut *SolverKind::Multifrontal.build(), &equations);
    assert!(off(&found, &expected) < 1e-6);
    // In the same step the next matrix is factorised at once, in the next step not.
    solve(&mut solver, &equations);
    assert_eq!(solver.effort().lost_iterations, effort.lost_iterations);
    solver.start_step();
    solve(&mut solver, &equations);
    assert_eq!(solver.effort(), effort);

    let mut without_room = AutoSolver::by_iteration().with_factor_bytes(1000);
    without_room.factor(&equations.0).unwrap();
    assert!(matches!(
        without_room.effort().reason,
        Reason::Memory { factors, allowed: 1000 } if factors > 1_000_000
    ));
    let mut solution = vec![0.0; equations.1.len()];
    let refused = without_room.solve(&equations.0, &equations.1, &mut solution);
    assert!(
        matches!(refused, Err(LinearSolverError::NotConverged { factor_bytes, .. }) if factor_bytes > Some(1_000_000)),
        "{refused:?}"
    );
}

/// GOAL: where factors have no room, what leaves less than a tenth is handed out and says how much it leaves; who asks for more
/// than factors are held to gets a solution or none, and not the last of all iterations is made for it.
#[test]
fn without_room_a_tenth_may_be_left() {
    // Pillars of one cell, nearly incompressible: no grid coarser than theirs stands for them.
    let pillars = |[x, y, z]: [usize; 3]| z > 1 && (x % 2 == 1 || y % 2 == 1);
    let equations = equations(&ground::<3>(&elastic(0.4999), 11, 6, pillars));
    let mut solver = AutoSolver::default().with_factor_bytes(1000);
    solver.ask_for(1e-6);
    let (found, report) = solve(&mut solver, &equations);
    let mut left = vec![0.0; found.len()];
    equations.0.multiply(&found, &mut left);
    for (left, rhs) in left.iter_mut().zip(&equations.1) {
        *left -= rhs;
    }
    let size = |of: &[f64]| of.iter().map(|x| x * x).sum::<f64>().sqrt();
    let share = size(&left) / size(&equations.1);
    assert!(share > 1e-6 && share < 0.1, "{share}, {report:?}");

    solver.ask_for(1e-8);
    let mut solution = vec![0.0; found.len()];
    let refused = solver.solve(&equations.0, &equations.1, &mut solution);
    let Err(LinearSolverError::NotConverged {
        iterations,
        relative_residual,
        tolerance,
        ..
    }) = refused
    else {
        panic!("{refused:?}");
    };
    assert!(tolerance <= 1e-6 && relative_residual > tolerance);
    assert!(iterations < 1500, "{iterations}");
}

/// The forecast for a pattern before there is a matrix comes true with the matrix.
#[test]
fn a_forecast_comes_true() {
    let equations = equations(&ground::<3>(&mohr_coulomb(), 9, 4, |_| false));
    let pattern = &equations.0.pattern;
    let forecast = |solver: &mut AutoSolver| solver.forecast(pattern, false).unwrap();
    for bytes in [1000, 60 << 20, 8 << 30] {
        let solver = || AutoSolver::default().with_factor_bytes(bytes);
        let expected = forecast(&mut solver());
        let mut solver = solver();
        let _ = solve(&mut solver, &equations);
        let effort = solver.effort();
        assert_eq!(expected.reason, effort.reason);
        assert_eq!(expected.iterates, effort.iterations > 0);
        assert_eq!(expected.iterates, expected.factor_bytes > bytes);
        // In single precision they may fit where they do not in double.
        let fits = expected.factor_bytes / 2 <= bytes;
        let fallback = if fits { expected.factor_bytes / 2 } else { 0 };
        assert_eq!(
            expected.fallback_bytes,
            if expected.iterates { fallback } else { 0 }
        );
    }
    let single = forecast(&mut AutoSolver::in_single());
    assert_eq!((single.iterates, &single.reason), (false, &Reason::Asked));
    assert!(single.operations > 1e8, "{single:?}");
}

/// Where the diagonal is stored.
fn diagonal_entries(matrix: &TangentMatrix) -> Vec<usize> {
    let columns = matrix.pattern.compressed_columns();
    (0..matrix.pattern.unknowns())
        .filter_map(|column| {
            let rows = columns.col_ptr[column]..columns.col_ptr[column + 1];
            rows.into_iter()
                .find(|&entry| columns.row_idx[entry] == column)
        })
        .collect()
}

/// GOAL: Newton's method needs no more than one correction more than with a factorisation.
#[test]
fn corrections_hardly_grow() {
    for law in [elastic(0.3), von_mises(), mohr_coulomb()] {
        let corrections = |kind: SolverKind| {
            let (particles, conditions) = ground::<3>(&law, 8, 2, |[x, _, z]| x > 4 && z > 5);
            let mut body = Body {
                particles,
                load_points: Vec::new(),
                rigid: Vec::new(),
                reinforcement: Vec::new(),
                free_fields: Vec::new(),
            };
            let mut workspace = Workspace::new(kind.build());
            let (report, _) = step(
                &mut body,
                &Method::default(),
                &conditions,
                (0.0, 1.0),
                &NewtonSettings::default(),
                &mut workspace,
            )
            .unwrap();
            (report.iterations, report.linear)
        };
        let (direct, _) = corrections(SolverKind::Multifrontal);
        let (iterated, effort) = corrections(SolverKind::Multigrid);
        assert!(iterated <= direct + 1, "{iterated}, and {direct}");
        assert!(effort.method.starts_with("multigrid"), "{effort:?}");
        assert_eq!(effort.solutions, iterated);
        assert!(effort.iterations >= iterated && effort.lost_iterations == 0);
    }
}
