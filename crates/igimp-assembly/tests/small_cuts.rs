//! GOAL: nodes that a body only touches at a corner do no harm, whatever is done about them.
//! BODY: blocks of 2 × 2 particles per unit cell whose domains (iGIMP) or centres (iMPM) reach a
//! hair's breadth into empty cells.
//! ORACLE: rigid motion, differences of the internal force, a hand calculation of what a dropped
//! node resists, and the algebra of the ghost penalty.

mod common;

use std::collections::BTreeMap;

use common::{Random, displacements, laws, methods};
use igimp_assembly::{
    Constraints, Kinematics, LoadPoint, Method, ParticleSeed, Particles, Remedy, SharedLaw,
    Stencils, StepConditions, StepLoads, System, TangentMatrix, Trial,
};
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
                cell[axis] as f64 + 0.25 + 0.5 * place[axis] as f64 + shift[axis]
            }),
            half_length: [0.25; 2],
            volume: 0.25,
            density: 1.0,
            law: 0,
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
    StepConditions {
        grid: grid.clone(),
        constraints: Constraints::free(grid),
        loads: StepLoads {
            gravity: [0.0; 2],
            point_factor: 1.0,
        },
        laws: vec![law.clone()],
    }
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

/// The master of every node of the dropped variant that the tied one does without, found by where
/// its share went; `None` where it kept its share.
fn masters(
    grid: &Grid<2>,
    raw: &Stencils<2>,
    tied: &Stencils<2>,
) -> BTreeMap<usize, Option<usize>> {
    let mut masters = BTreeMap::new();
    for particle in 0..raw.len() {
        let value = |stencils: &Stencils<2>, node: usize| {
            let own = stencils.of(particle);
            own.iter()
                .find(|support| support.node == node)
                .map(|support| support.grad)
        };
        let lost: Vec<_> = raw
            .of(particle)
            .iter()
            .filter(|support| value(tied, support.node).is_none())
            .collect();
        if let [only] = lost[..] {
            let gained = (0..grid.node_count())
                .find(|&node| value(tied, node).is_some_and(|grad| value(raw, node) != Some(grad)));
            masters.insert(only.node, gained);
        }
    }
    masters
}

/// A rigid translation of any size, given to the unknowns alone, strains no particle and meets no
/// force, the ghost penalty included. Sums over tied supports: Σ S = 1, Σ ∇S = Σ ∇S̄ = 0.
#[test]
fn a_rigid_translation_of_tied_bodies_causes_no_strain() {
    let grid = unit_grid([6, 6]);
    let conditions = free(&grid, &elastic());
    for method in methods() {
        for (outline, cells) in outlines().iter().enumerate() {
            for shift in shifts(&method) {
                let label = format!(
                    "{}, {:?}, ghost {}, outline {outline}, shift {shift:?}",
                    method.label(),
                    method.kinematics,
                    method.small_cuts.ghost_penalty
                );
                let body = body(cells, shift);
                let stencils =
                    Stencils::build(&grid, &body, &method, &conditions.constraints).unwrap();
                let raw = Stencils::build(
                    &grid,
                    &body,
                    &with_remedy(&method, Remedy::Drop),
                    &conditions.constraints,
                )
                .unwrap();
                let supports = |stencils: &Stencils<2>| -> usize {
                    (0..stencils.len()).map(|p| stencils.of(p).len()).sum()
                };
                assert!(
                    supports(&stencils) < supports(&raw),
                    "{label}: nothing is tied"
                );
                for particle in 0..stencils.len() {
                    let own = stencils.of(particle);
                    let unity: f64 = own.iter().map(|support| support.value).sum();
                    assert!((unity - 1.0).abs() < 1e-15, "{label}: {unity}");
                    for axis in 0..2 {
                        let grad: f64 = own.iter().map(|support| support.grad[axis]).sum();
                        let bar: f64 = own.iter().map(|support| support.grad_bar[axis]).sum();
                        assert!(grad.abs() < 1e-15, "{label}: {grad:e}");
                        assert!(bar.abs() < 1e-15, "{label}: {bar:e}");
                    }
                }

                let system =
                    System::new(&body, &stencils, &conditions, &method, &[], None).unwrap();
                for size in [1e-3, 0.2, 5.0, 1e3] {
                    let u = translated(&system, [size, -0.7 * size]);
                    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
                    for own in &trial.particles {
                        for a in 0..2 {
                            for b in 0..2 {
                                let identity = f64::from(u8::from(a == b));
                                let strain = own.delta_def_grad[a][b] - identity;
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
        for method in methods() {
            let label = format!("{name}, {}, {:?}", method.label(), method.kinematics);
            let conditions = free(&grid, &law);
            let body = body(&outlines()[1], shifts(&method)[0]);
            let stencils = Stencils::build(&grid, &body, &method, &conditions.constraints).unwrap();
            let system = System::new(&body, &stencils, &conditions, &method, &[], None).unwrap();
            let u = displacements(&grid, 0.02, &mut random);
            let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
            let matrix = dense(&system.tangent(&trial));
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
    let own = trial.particles.iter();
    own.map(|own| own.lifted.regime).collect()
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
    conditions.constraints.fix_wall(&grid, 0, false, 0);
    conditions.constraints.fix_wall(&grid, 0, true, 0);
    for node in 0..grid.node_count() {
        if grid.node_place(node)[1] <= 1 {
            conditions.constraints.prescribe(node, 1, -0.2).unwrap();
        }
    }
    let body = body(&cells([0, 1], [3, 4]), [0.0, SLIVER]);
    let stencils = Stencils::build(&grid, &body, method, &conditions.constraints).unwrap();
    let system = System::new(&body, &stencils, &conditions, method, &[], None).unwrap();
    let start = system.start(TangentKind::Elastic).unwrap();
    let matrix = dense(&system.tangent(&start));
    let singular_values = matrix.singular_values();
    let condition = singular_values.max() / singular_values.min();

    let mut u = system.prescribed_motion();
    let mut force: Vec<f64> = system.force_of_prescribed_motion(&start);
    force.iter_mut().for_each(|force| *force = -*force);
    let mut matrix = matrix;
    let mut trial = start;
    for _ in 0..8 {
        let du = matrix.lu().solve(&DVector::from_vec(force)).unwrap();
        system.add_correction(&mut u, du.as_slice());
        trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
        matrix = dense(&system.tangent(&trial));
        force = system.out_of_balance(&trial).unwrap().force;
    }
    let residual = force.iter().fold(0.0_f64, |m, value| m.max(value.abs()));
    assert!(residual < 1e-12 * 100.0, "{residual:e}");
    let stress = trial.particles.iter().map(|own| own.lifted.tau[1][1]);
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
    let elasticity = *elastic().elasticity();
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
