//! GOAL: nodes that a body only touches at a corner do no harm, whatever is done about them.
//! BODY: blocks of 2 × 2 particles per unit cell whose domains (iGIMP) or centres (iMPM) reach a
//! hair's breadth into empty cells.
//! ORACLE: rigid motion, differences of the internal force, a hand calculation of what a dropped
//! node resists, and the algebra of the ghost penalty.

use std::sync::Arc;

use crate::common::{Random, by_particle, displacements, laws, methods};
use igimp_assembly::{
    Constraints, Kinematics, LoadPoint, Method, ParticleSeed, Particles, Remedy, SharedLaw,
    Stencils, StepConditions, StepLoads, Structures, System, Trial, UnbalancedForces,
};
use igimp_linear::TangentMatrix;
use igimp_material::TangentKind;
use igimp_shape::{Axis, Grid};
use nalgebra_sparse::na::{DMatrix, DVector};

/// By how much domains reach into empty cells \[cells\].
const SLIVER: f64 = 0.003;

fn unit_grid(cells: [usize; 2]) -> Grid<2> {
    Grid::new(cells.map(|cells| Axis::uniform(0.0, 1.0, cells).unwrap()))
}

/// 2 × 2 particles in each of the listed cells, the whole body moved by `shift`.
fn body(cells: &[[usize; 2]], shift: [f64; 2]) -> Particles<2> {
    let seeds: Vec<_> = cells
        .iter()
        .flat_map(|cell| (0..4).map(move |part| (cell, [part % 2, part / 2])))
        .map(|(cell, place)| ParticleSeed {
            x: std::array::from_fn(|axis| {
                cell[axis] as f64 + 0.25 + 0.5 * f64::from(place[axis]) + shift[axis]
            }),
            half_length: [0.25; 2],
            volume: 0.25,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect();
    Particles::new(&seeds).unwrap()
}

/// The cells from `from` to `to`, the latter not included.
fn cells(from: [usize; 2], to: [usize; 2]) -> Vec<[usize; 2]> {
    (from[1]..to[1])
        .flat_map(|row| (from[0]..to[0]).map(move |column| [column, row]))
        .collect()
}

/// Shifts that make a block small cuts of its upper and right sides: domains that end just beyond
/// a face; for the linear basis, centres that lie just beyond one, or on it.
fn shifts(method: &Method) -> Vec<[f64; 2]> {
    if method.basis.name() == "gimp" {
        vec![[SLIVER; 2], [0.0, SLIVER], [1e-9, 1e-6]]
    } else {
        vec![[0.25 + 1e-5; 2], [0.0, 0.25 + 1e-9], [0.25, 0.25]]
    }
}

fn free(grid: &Grid<2>, law: &SharedLaw) -> StepConditions<2> {
    StepConditions::new(
        grid.clone(),
        Constraints::free(grid),
        StepLoads {
            gravity: [0.0; 2],
            factors: vec![1.0],
            drag: 0.0,
        },
        vec![law.clone()],
    )
    .unwrap()
}

fn elastic() -> SharedLaw {
    laws().remove(0).1
}

fn with_remedy(method: &Method, remedy: Remedy) -> Method {
    let mut method = method.clone();
    method.small_cuts.remedy = remedy;
    method
}

/// A block, a staircase whose inner corner a single domain reaches into, and a lone cell.
fn outlines() -> Vec<Vec<[usize; 2]>> {
    let mut staircase = cells([1, 1], [4, 3]);
    staircase.extend(cells([1, 3], [3, 4]));
    vec![cells([1, 1], [4, 4]), staircase, vec![[2, 2]]]
}

/// The shared methods, and one whose ghost penalty couples nodes further apart than its basis does.
fn variants() -> Vec<Method> {
    let mut ghost = Method::impm_bbar();
    ghost.small_cuts.ghost_penalty = 1e-2;
    let mut methods = methods();
    methods.push(ghost);
    methods
}

/// A rigid translation of any size, given to the unknowns alone, strains no particle and meets no
/// force, the ghost penalty included. Sums over tied supports: Σ S = 1, Σ ∇S = Σ ∇S̄ = 0.
#[test]
fn a_rigid_translation_of_tied_bodies_causes_no_strain() {
    let grid = unit_grid([6, 6]);
    let conditions = free(&grid, &elastic());
    for method in variants() {
        for (outline, cells) in outlines().iter().enumerate() {
            for shift in shifts(&method) {
                let label = format!(
                    "{}, {:?}, ghost {}, outline {outline}, shift {shift:?}",
                    method.label(),
                    method.kinematics,
                    method.small_cuts.ghost_penalty
                );
                let body = body(cells, shift);
                let stencils = Stencils::build(&body, &method, &conditions).unwrap();
                let raw = Stencils::build(&body, &with_remedy(&method, Remedy::Drop), &conditions)
                    .unwrap();
                let supports = |stencils: &Stencils<2>| -> usize {
                    (0..stencils.len()).map(|p| stencils.of(p).len()).sum()
                };
                assert!(
                    supports(&stencils) < supports(&raw),
                    "{label}: nothing is tied"
                );
                for particle in 0..stencils.len() {
                    let list = stencils.of(particle);
                    let unity: f64 = list.iter().map(|support| support.value).sum();
                    assert!((unity - 1.0).abs() < 1e-15, "{label}: {unity}");
                    for axis in 0..2 {
                        let grad: f64 = list.iter().map(|support| support.grad[axis]).sum();
                        let bar: f64 = list.iter().map(|support| support.grad_bar[axis]).sum();
                        assert!(grad.abs() < 1e-15, "{label}: {grad:e}");
                        assert!(bar.abs() < 1e-15, "{label}: {bar:e}");
                    }
                }

                let system = System::new(&body, &stencils, &conditions, &method).unwrap();
                for size in [1e-3, 0.2, 5.0, 1e3] {
                    let u = translated(&system, [size, -0.7 * size]);
                    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
                    for point in &trial.particles {
                        for a in 0..2 {
                            for b in 0..2 {
                                let identity = f64::from(u8::from(a == b));
                                let strain = point.delta_def_grad[a][b] - identity;
                                assert!(strain.abs() < 1e-15 * (1.0 + size), "{label}: {strain:e}");
                            }
                        }
                    }
                    let force = largest(&trial.f_int);
                    assert!(
                        force < 1e-13 * (1.0 + size),
                        "{label}: size {size}, {force:e}"
                    );
                }
            }
        }
    }
}

/// Nodal displacements of a system's unknowns moved alike, as the iteration makes them.
fn translated(system: &System<'_, 2>, by: [f64; 2]) -> Vec<[f64; 2]> {
    let mut u = system.prescribed_motion();
    let mut du = vec![0.0; system.unknowns().len()];
    for node in 0..u.len() {
        for axis in 0..2 {
            if let Some(unknown) = system.unknowns().index(node, axis) {
                du[unknown] = by[axis];
            }
        }
    }
    system.add_correction(&mut u, &du);
    u
}

fn largest(forces: &[[f64; 2]]) -> f64 {
    forces
        .as_flattened()
        .iter()
        .fold(0.0, |largest, force| f64::max(largest, force.abs()))
}

/// The tangent is the derivative of the internal force with tied nodes too, at a strained and
/// yielded trial.
#[test]
fn the_tangent_of_tied_bodies_is_the_derivative_of_the_force() {
    let grid = unit_grid([6, 6]);
    let mut random = Random(3);
    for (name, law) in laws() {
        for method in variants() {
            let label = format!("{name}, {}, {:?}", method.label(), method.kinematics);
            let conditions = free(&grid, &law);
            let body = body(&outlines()[1], shifts(&method)[0]);
            let stencils = Stencils::build(&body, &method, &conditions).unwrap();
            let system = System::new(&body, &stencils, &conditions, &method).unwrap();
            let u = displacements(&grid, 0.02, &mut random);
            let (_, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
            let matrix = dense(&matrix);
            let (mut largest, mut error, mut compared) = (0.0_f64, 0.0_f64, 0);
            for (column, node, axis) in unknowns(&grid, &system) {
                let d = 1e-6;
                let moved = |sign: f64| {
                    let mut u = u.clone();
                    u[node][axis] += sign * d;
                    system.evaluate(&u, TangentKind::Consistent).unwrap()
                };
                let (plus, minus) = (moved(1.0), moved(-1.0));
                if regimes(&plus) != regimes(&minus) {
                    continue; // a kink of the force: differences have no meaning there
                }
                compared += 1;
                for (row, row_node, row_axis) in unknowns(&grid, &system) {
                    let difference =
                        plus.f_int[row_node][row_axis] - minus.f_int[row_node][row_axis];
                    let difference = difference / (2.0 * d);
                    largest = largest.max(difference.abs());
                    error = error.max((difference - matrix[(row, column)]).abs());
                }
            }
            assert!(
                compared > system.unknowns().len() * 3 / 4,
                "{label}: {compared}"
            );
            assert!(error < 1e-7 * largest, "{label}: {:e}", error / largest);
        }
    }
}

fn regimes(trial: &Trial<2>) -> Vec<igimp_material::Regime> {
    let points = trial.particles.iter();
    points.map(|point| point.regime).collect()
}

/// The unknowns with their nodes and axes.
fn unknowns(grid: &Grid<2>, system: &System<'_, 2>) -> Vec<(usize, usize, usize)> {
    (0..grid.node_count())
        .flat_map(|node| [(node, 0), (node, 1)])
        .filter_map(|(node, axis)| {
            let unknown = system.unknowns().index(node, axis)?;
            Some((unknown, node, axis))
        })
        .collect()
}

fn dense(matrix: &TangentMatrix) -> DMatrix<f64> {
    let n = matrix.pattern.unknowns();
    let mut dense = DMatrix::zeros(n, n);
    for (row, column, &value) in matrix.to_csc().triplet_iter() {
        dense[(row, column)] = value;
    }
    dense
}

/// A stiff block that fills the width of its grid settles by 0.2 cells, its base prescribed.
/// Returns the stress by particle, and the condition of the first tangent.
fn settle(method: &Method) -> (Vec<f64>, f64) {
    let grid = unit_grid([3, 6]);
    let mut conditions = free(&grid, &elastic());
    conditions.constraints.fix_wall(&grid, 0, false, 0).unwrap();
    conditions.constraints.fix_wall(&grid, 0, true, 0).unwrap();
    for node in 0..grid.node_count() {
        if grid.node_place(node)[1] <= 1 {
            conditions.constraints.prescribe(node, 1, -0.2).unwrap();
        }
    }
    let body = body(&cells([0, 1], [3, 4]), [0.0, SLIVER]);
    let stencils = Stencils::build(&body, method, &conditions).unwrap();
    let system = System::new(&body, &stencils, &conditions, method).unwrap();
    let still = vec![[0.0; 2]; grid.node_count()];
    let (start, matrix) = system.linearise(&still, TangentKind::Elastic).unwrap();
    let matrix = dense(&matrix);
    let singular_values = matrix.singular_values();
    let condition = singular_values.max() / singular_values.min();

    let mut u = system.prescribed_motion();
    let mut force = system
        .force_of_prescribed_motion(&still, TangentKind::Elastic)
        .unwrap();
    for force in &mut force {
        *force = -*force;
    }
    let mut matrix = matrix;
    let mut trial = start;
    for _ in 0..8 {
        let du = matrix.lu().solve(&DVector::from_vec(force)).unwrap();
        system.add_correction(&mut u, du.as_slice());
        let (next, tangent) = system.linearise(&u, TangentKind::Consistent).unwrap();
        (trial, matrix) = (next, dense(&tangent));
        force = system.out_of_balance(&trial).unwrap().force;
    }
    let residual = force.iter().fold(0.0_f64, |m, value| m.max(value.abs()));
    assert!(residual < 1e-12 * 100.0, "{residual:e}");
    let stress = by_particle(&trial, &stencils);
    let stress = stress.iter().map(|point| point.tau[1][1]);
    (stress.collect(), condition)
}

/// Dropped nodes hold on to the sliver beyond the surface, tied ones do not.
///
/// A column of the block in small strain, in the top cell: all its particles have the strain e of
/// the cell, but those whose domain reaches beyond by the share w = ε/(2 l_p) have
/// (1 − w) e + w δ, with δ = 0.2 what the dropped node stays behind. Balance of the row at the
/// surface, σ_lower + (1 − 2w) σ_upper = 0, gives σ_upper = M w δ / 2 to first order in w.
#[test]
fn dropped_nodes_resist_a_settlement_and_tied_ones_do_not() {
    let elasticity = *elastic().stiffness_bound();
    let constrained = elasticity.bulk() + 4.0 / 3.0 * elasticity.shear();
    for kinematics in [Kinematics::FiniteStrain, Kinematics::SmallStrain] {
        for method in [Method::igimp(), Method::igimp_bbar()] {
            let method = Method {
                kinematics,
                ..method
            };
            let label = format!("{}, {kinematics:?}", method.label());
            let (tied, condition_tied) = settle(&with_remedy(&method, Remedy::Tie));
            let (dropped, condition_dropped) = settle(&with_remedy(&method, Remedy::Drop));
            let size = |stress: &[f64]| stress.iter().fold(0.0_f64, |m, value| m.max(value.abs()));
            assert!(
                size(&tied) < 1e-13 * constrained,
                "{label}: {:e}",
                size(&tied)
            );
            let share = SLIVER / 0.5;
            let expected = 0.5 * constrained * share * 0.2;
            let top = size(&dropped);
            assert!(
                (top - expected).abs() < 0.05 * expected,
                "{label}: {top} {expected}"
            );

            let mut alone = method.clone();
            alone.small_cuts.below = 0.0;
            let (_, condition_alone) = settle(&alone);
            assert!(condition_tied < 1e3, "{label}: {condition_tied:e}");
            assert!(condition_dropped < 1e3, "{label}: {condition_dropped:e}");
            assert!(condition_alone > 1e5, "{label}: {condition_alone:e}");
        }
    }
}

/// The error of ties: a uniform gradient G of the unknowns' displacements is felt in full by
/// particles that touch no tied node, and off by no more than |G| times the share of the domain
/// beyond the face by the others, because Σ X_i ⊗ ∇S_i = I lacks what the tied nodes stand apart
/// from their masters.
#[test]
fn tied_nodes_miss_no_more_of_a_gradient_than_their_share() {
    let grid = unit_grid([6, 6]);
    let conditions = free(&grid, &elastic());
    let gradient = [[0.01, -0.03], [0.02, -0.015]];
    let body = body(&cells([1, 1], [4, 4]), [0.0, SLIVER]);
    for method in [Method::igimp(), Method::igimp_bbar()] {
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        let mut du = vec![0.0; system.unknowns().len()];
        for (unknown, node, axis) in unknowns(&grid, &system) {
            let x = grid.node_position(node);
            du[unknown] = gradient[axis][0] * x[0] + gradient[axis][1] * x[1];
        }
        let mut u = system.prescribed_motion();
        system.add_correction(&mut u, &du);
        let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
        for (particle, point) in by_particle(&trial, &stencils).into_iter().enumerate() {
            let reaches = body.x[particle][1] + 0.25 > 4.0;
            let share = if reaches { SLIVER / 0.5 } else { 0.0 };
            for a in 0..2 {
                for b in 0..2 {
                    let exact = f64::from(u8::from(a == b)) + gradient[a][b];
                    let missed = (point.delta_def_grad[a][b] - exact).abs();
                    let allowed = gradient[a][b].abs() * share + 1e-15;
                    assert!(missed <= 1.000_001 * allowed, "{missed:e} {allowed:e}");
                    assert!(!reaches || b == 0 || missed > 0.99 * allowed);
                }
            }
        }
    }
}

/// The node that each node of a grid moves with in direction y, read from a correction that gives
/// every unknown the number of its node; `None` where a node does not move.
fn moves_with(system: &System<'_, 2>, nodes: usize) -> Vec<Option<usize>> {
    let mut du = vec![0.0; system.unknowns().len()];
    for node in 0..nodes {
        if let Some(unknown) = system.unknowns().index(node, 1) {
            du[unknown] = 1.0 + node as f64;
        }
    }
    let mut u = vec![[0.0; 2]; nodes];
    system.add_correction(&mut u, &du);
    u.iter()
        .map(|u| (u[1] > 0.0).then(|| u[1] as usize - 1))
        .collect()
}

/// A small cut moves with the nearest node of the same constraints: at a wall with a node on the
/// wall; not at all where there is none alike; and as prescribed where it is held itself.
#[test]
fn a_node_is_tied_to_one_with_the_same_constraints() {
    let grid = unit_grid([4, 5]);
    let body = body(&cells([0, 0], [2, 3]), [0.0, SLIVER]);
    let method = Method::igimp_bbar();
    let node = |column: usize, row: usize| grid.node_index([column, row]);
    let mut conditions = free(&grid, &elastic());
    conditions.constraints.fix_wall(&grid, 0, false, 0).unwrap();
    conditions.constraints.fix_wall(&grid, 1, false, 1).unwrap();
    let master_of = |conditions: &StepConditions<2>, cut: usize| {
        let stencils = Stencils::build(&body, &method, conditions).unwrap();
        let system = System::new(&body, &stencils, conditions, &method).unwrap();
        assert!(!system.unknowns().is_active(cut));
        moves_with(&system, grid.node_count())[cut]
    };
    for column in 0..3 {
        assert_eq!(
            master_of(&conditions, node(column, 4)),
            Some(node(column, 3))
        );
    }

    conditions
        .constraints
        .prescribe(node(0, 3), 1, 0.1)
        .unwrap();
    assert_eq!(master_of(&conditions, node(0, 4)), Some(node(0, 2)));
    assert_eq!(master_of(&conditions, node(1, 4)), Some(node(1, 3)));

    let mut held = conditions.clone();
    held.constraints.prescribe(node(0, 2), 1, 0.1).unwrap();
    assert_eq!(master_of(&held, node(0, 4)), None);

    conditions
        .constraints
        .prescribe(node(0, 4), 1, 0.3)
        .unwrap();
    let stencils = Stencils::build(&body, &method, &conditions).unwrap();
    let mut supports = (0..stencils.len()).flat_map(|particle| stencils.of(particle));
    assert!(supports.any(|support| support.node == node(0, 4)));
    let system = System::new(&body, &stencils, &conditions, &method).unwrap();
    let motion = system.prescribed_motion()[node(0, 4)];
    assert_eq!(motion.map(f64::to_bits), [0.0_f64, 0.3].map(f64::to_bits));
}

/// Loads on soil that stands a sliver high in a cell keep their resultant, and move with the soil.
#[test]
fn loads_on_a_sliver_keep_their_resultant_and_move_along() {
    let grid = unit_grid([6, 6]);
    let body = body(&cells([1, 1], [4, 4]), [0.0, SLIVER]);
    let conditions = free(&grid, &elastic());
    let points = LoadPoint::along_edge([1.5, 4.002], [3.5, 4.002], [3.0, -5.0], 7, 0);
    for method in [Method::igimp(), Method::igimp_bbar()] {
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::with_structures(
            &body,
            &Structures {
                points: &points,
                ..Structures::default()
            },
            &stencils,
            &conditions,
            &method,
        )
        .unwrap();
        let mut resultant = [0.0; 2];
        for (node, force) in system.f_ext().iter().enumerate() {
            for axis in 0..2 {
                resultant[axis] += force[axis];
                assert!(force[axis] == 0.0 || system.unknowns().index(node, axis).is_some());
            }
        }
        assert!((resultant[0] - 6.0).abs() < 1e-14 && (resultant[1] + 10.0).abs() < 1e-14);

        let u = translated(&system, [0.25, -0.5]);
        for (index, point) in points.iter().enumerate() {
            let carried = point.carried(&grid, &stencils, index, &u).unwrap();
            assert!((carried.x[0] - point.x[0] - 0.25).abs() < 1e-15);
            assert!((carried.x[1] - point.x[1] + 0.5).abs() < 1e-15);
        }
    }
}

/// Loads beside nodes that are dropped keep resultant and moment, also where they stand far above
/// the sliver, and act on unknowns alone.
#[test]
fn loads_beside_dropped_nodes_keep_resultant_and_moment() {
    let grid = unit_grid([6, 6]);
    let body = body(&cells([1, 1], [4, 4]), [0.0, SLIVER]);
    let mut rollers = free(&grid, &elastic());
    for column in 0..=6 {
        // No node below is held alike, so that there is no master.
        let node = grid.node_index([column, 5]);
        rollers.constraints.prescribe(node, 0, 0.0).unwrap();
    }
    let mut dropping = Method::igimp_bbar();
    dropping.small_cuts.remedy = Remedy::Drop;
    for (conditions, method) in [
        (free(&grid, &elastic()), dropping),
        (rollers, Method::igimp_bbar()),
    ] {
        for height in [4.002, 4.3, 4.7] {
            let points =
                LoadPoint::along_edge([1.2, height], [3.7, height - 0.001], [3.0, -5.0], 7, 0);
            let stencils = Stencils::build(&body, &method, &conditions).unwrap();
            let system = System::with_structures(
                &body,
                &Structures {
                    points: &points,
                    ..Structures::default()
                },
                &stencils,
                &conditions,
                &method,
            )
            .unwrap();
            let mut sums = [0.0; 3];
            for (node, force) in system.f_ext().iter().enumerate() {
                let x = grid.node_position(node);
                sums[0] += force[0];
                sums[1] += force[1];
                sums[2] += x[0] * force[1] - x[1] * force[0];
                for axis in 0..2 {
                    let is_unknown = system.unknowns().index(node, axis).is_some();
                    let label = format!("{height} {node} {force:?}");
                    assert!(force[axis] == 0.0 || is_unknown, "{label}");
                }
            }
            let mut expected = [0.0; 3];
            for LoadPoint { x, force, .. } in &points {
                expected[0] += force[0];
                expected[1] += force[1];
                expected[2] += x[0] * force[1] - x[1] * force[0];
            }
            for (sum, expected) in sums.iter().zip(expected) {
                assert!((sum - expected).abs() < 1e-11, "{height}: {sum} {expected}");
            }
        }
    }
}

/// The ghost stiffness between all nodes, one component, as its part of the internal force.
fn ghost_stiffness(body: &Particles<2>, gamma: f64) -> (Grid<2>, DMatrix<f64>) {
    let grid = unit_grid([6, 6]);
    let conditions = free(&grid, &elastic());
    let nodes = grid.node_count();
    let mut stiffness = DMatrix::zeros(nodes, nodes);
    let force = |gamma: f64, column: usize, axis: usize| {
        let mut method = Method::igimp_bbar();
        method.small_cuts.ghost_penalty = gamma;
        let stencils = Stencils::build(body, &method, &conditions).unwrap();
        let system = System::new(body, &stencils, &conditions, &method).unwrap();
        let mut u = vec![[0.0; 2]; nodes];
        u[column][axis] = 1e-3;
        system.evaluate(&u, TangentKind::Consistent).unwrap().f_int
    };
    for column in 0..nodes {
        for axis in 0..2 {
            let (with, without) = (force(gamma, column, axis), force(0.0, column, axis));
            for row in 0..nodes {
                let entry = 1e3 * (with[row][axis] - without[row][axis]);
                let other = 1e3 * (with[row][1 - axis] - without[row][1 - axis]);
                assert!(other == 0.0, "components are coupled: {other}");
                if axis == 0 {
                    stiffness[(row, column)] = entry;
                } else {
                    let difference: f64 = stiffness[(row, column)] - entry;
                    assert!(
                        difference.abs() < 1e-11,
                        "components differ by {difference:e}"
                    );
                }
            }
        }
    }
    (grid, stiffness)
}

/// The ghost penalty is symmetric and positive semi-definite; it vanishes for displacements that
/// are linear over the whole grid, and with tied nodes for translations.
#[test]
fn the_ghost_penalty_is_symmetric_semi_definite_and_blind_to_linear_motion() {
    let gamma = 1.0;
    for (shift, linear) in [([0.0; 2], true), ([SLIVER; 2], false)] {
        for cells in outlines() {
            let (grid, stiffness) = ghost_stiffness(&body(&cells, shift), gamma);
            let asymmetry = (&stiffness - stiffness.transpose()).amax();
            let size = stiffness.amax();
            assert!(size > 10.0 || cells.len() == 1, "no penalty: {size}");
            assert!(asymmetry < 1e-12 * (1.0 + size), "{asymmetry:e}");
            let fields: [fn([f64; 2]) -> f64; 3] = [|_| 1.0, |x| x[0], |x| x[1]];
            for field in fields.iter().take(if linear { 3 } else { 1 }) {
                let motion = (0..grid.node_count()).map(|node| field(grid.node_position(node)));
                let motion = DVector::from_iterator(grid.node_count(), motion);
                let force = (&stiffness * motion).amax();
                assert!(force < 1e-11 * (1.0 + size), "{force:e}");
            }
            let symmetric = 0.5 * (&stiffness + stiffness.transpose());
            let least = symmetric.symmetric_eigenvalues().min();
            assert!(least > -1e-12 * (1.0 + size), "{least:e}");
        }
    }
}

/// A single domain that reaches further into an empty cell makes nodes with too much soil for a
/// small cut, which its three strains alone cannot hold without B-bar: the ghost penalty does.
#[test]
fn the_ghost_penalty_holds_nodes_that_a_single_domain_reaches() {
    let grid = unit_grid([6, 6]);
    let mut conditions = free(&grid, &elastic());
    for column in 0..=6 {
        for axis in 0..2 {
            let node = grid.node_index([column, 1]);
            conditions.constraints.prescribe(node, axis, 0.0).unwrap();
        }
    }
    let block = body(&cells([1, 1], [4, 4]), [0.0; 2]);
    let mut fields = (*block).clone();
    let top = (0..block.len())
        .max_by(|&a, &b| fields.x[a][1].total_cmp(&fields.x[b][1]))
        .unwrap();
    fields.x[top][1] += 0.08;
    let body = Particles::from_fields(fields).unwrap();
    for mut method in [Method::igimp(), Method::igimp_bbar()] {
        method.small_cuts.ghost_penalty = 1e-3;
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        let still = vec![[0.0; 2]; grid.node_count()];
        let (_, matrix) = system.linearise(&still, TangentKind::Elastic).unwrap();
        let matrix = dense(&matrix);
        let eigenvalues = matrix.symmetric_eigenvalues();
        let condition = eigenvalues.max() / eigenvalues.min();
        assert!(condition > 0.0 && condition < 1e6, "{condition:e}");
    }
}

// GOAL: forces that hold a body act on it whole, also where a small cut has no displacement of its own.
// CASE: a block with tied nodes, and forces on all of its nodes.
// ORACLE: their resultant acts on nodes that take part, and nothing on the tied ones.
#[test]
fn forces_that_hold_tied_nodes_act_on_their_masters() {
    let grid = unit_grid([6, 6]);
    let law = elastic();
    let method = Method::igimp_bbar();
    let body = body(&cells([1, 1], [4, 4]), [SLIVER; 2]);
    let free = free(&grid, &law);
    let stencils = Stencils::build(&body, &method, &free).unwrap();
    let is_tied = |&node: &usize| stencils.is_tied(node);
    let tied: Vec<usize> = (0..grid.node_count()).filter(is_tied).collect();
    assert!(!tied.is_empty());
    let mut random = Random(9);
    let held: Vec<[f64; 2]> = (0..grid.node_count())
        .map(|node| {
            let touched = (stencils.carriers(node)).any(|by| stencils.node_volume(by.node) > 0.0);
            [0, 1].map(|_| if touched { random.symmetric() } else { 0.0 })
        })
        .collect();
    let share = 0.3;
    let conditions = free
        .with_unbalanced(Some(UnbalancedForces {
            forces: Arc::new(held.clone()),
            share,
        }))
        .unwrap();
    let system = System::new(&body, &stencils, &conditions, &method).unwrap();
    let f_ext = system.f_ext();
    for node in tied {
        assert!(f_ext[node].iter().all(|force| *force == 0.0), "{node}");
    }
    for axis in 0..2 {
        let sum = |forces: &[[f64; 2]]| forces.iter().map(|force| force[axis]).sum::<f64>();
        assert!((sum(f_ext) - share * sum(&held)).abs() < 1e-13);
    }
}

// GOAL: small cuts whose motion is extrapolated keep linear fields, also beside a wall, and forces on them act with their moment.
// BODY: the outlines above moved by slivers, and one on a wall of rollers.
// ORACLE: sums over supports that no tie has changed: Σ S x, Σ ∇S ⊗ x and Σ ∇S̄ ⊗ x are the same, Σ S is one.
#[test]
fn extrapolated_small_cuts_keep_linear_fields() {
    let grid = unit_grid([6, 6]);
    let law = elastic();
    let mut on_rollers = free(&grid, &law);
    (on_rollers.constraints.fix_wall(&grid, 1, false, 1)).unwrap();
    let mut extrapolated = 0;
    for method in methods() {
        let drop = with_remedy(&method, Remedy::Drop);
        let extrapolate = with_remedy(&method, Remedy::Extrapolate);
        for (conditions, outline) in [
            (free(&grid, &law), cells([1, 1], [4, 4])),
            (free(&grid, &law), outlines().remove(1)),
            (on_rollers.clone(), cells([1, 0], [4, 3])),
        ] {
            for shift in shifts(&method) {
                let shift = match conditions.constraints.of(0, 1) {
                    Some(_) => [shift[0], 0.0],
                    None => shift,
                };
                let body = body(&outline, shift);
                let plain = Stencils::build(&body, &drop, &conditions).unwrap();
                let tied = Stencils::build(&body, &extrapolate, &conditions).unwrap();
                let cuts: Vec<usize> = (0..grid.node_count())
                    .filter(|&node| tied.is_tied(node))
                    .collect();
                for &cut in &cuts {
                    let carriers: Vec<_> = tied.carriers(cut).collect();
                    extrapolated += usize::from(carriers.len() > 1);
                    for by in carriers {
                        assert!(!tied.is_tied(by.node));
                        if conditions.constraints.of(cut, 1).is_some() {
                            assert!(conditions.constraints.of(by.node, 1).is_some());
                        }
                    }
                }
                for particle in 0..body.len() {
                    let sums = |stencils: &Stencils<2>| {
                        let mut sums = [0.0; 11];
                        for s in stencils.of(particle) {
                            let x = grid.node_position(s.node);
                            sums[0] += s.value;
                            for a in 0..2 {
                                sums[1 + a] += s.value * x[a];
                                for b in 0..2 {
                                    sums[3 + 2 * a + b] += s.grad[a] * x[b];
                                    sums[7 + 2 * a + b] += s.grad_bar[a] * x[b];
                                }
                            }
                        }
                        sums
                    };
                    for (found, expected) in std::iter::zip(sums(&tied), sums(&plain)) {
                        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
                    }
                }
            }
        }
    }
    assert!(extrapolated > 20, "{extrapolated}");
}
