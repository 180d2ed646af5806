//! GOAL: laws that hold for any body: balance of force and moment, conservation of
//! volume and mass, and the bookkeeping of supports.
//! BODY: random graded grids in two and three dimensions with up to a dozen particles anywhere on
//! them, domains cut by walls and overlapping, laws mixed, in their second step.
//! ORACLE: identities of the method, derived beside each test.

use crate::common::{Random, by_particle, displacements, laws, methods};
use igimp_assembly::{
    Constraints, Kinematics, Method, ParticleSeed, Particles, Stencils, StepConditions, StepLoads,
    System, Trial,
};
use igimp_material::TangentKind;
use igimp_shape::{Axis, Grid};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Smallest cell of the random grids \[length\].
const SMALLEST_CELL: f64 = 0.5;

/// Largest nodal displacement of a step: keeps all determinants far from zero.
const LARGEST_STEP: f64 = 0.03;

/// A random body, its method and the seed of its motion.
#[derive(Clone, Debug)]
struct Sample<const D: usize> {
    grid: Grid<D>,
    seeds: Vec<ParticleSeed<D>>,
    method: Method,
    motion: u64,
}

fn axis() -> impl Strategy<Value = Axis> {
    let sizes = prop::collection::vec(SMALLEST_CELL..1.5, 2..=4);
    (-2.0..2.0, sizes).prop_map(|(start, sizes)| {
        let mut nodes = vec![start];
        for size in sizes {
            nodes.push(nodes[nodes.len() - 1] + size);
        }
        Axis::from_nodes(nodes).unwrap()
    })
}

fn sample<const D: usize>() -> impl Strategy<Value = Sample<D>> {
    let particle = (
        prop::array::uniform::<_, D>(0.05..0.95),
        prop::array::uniform::<_, D>(0.02..0.7),
        0.05..1.0,
        0.0..3.0,
        0..laws().len(),
    );
    (
        prop::array::uniform::<_, D>(axis()),
        prop::collection::vec(particle, 1..=12),
        prop::sample::select(methods()),
        any::<u64>(),
    )
        .prop_map(|(axes, particles, method, motion)| {
            let grid = Grid::new(axes);
            let (lower, upper) = grid.bounds();
            let seeds = particles
                .into_iter()
                .map(|(place, half_length, volume, density, law)| ParticleSeed {
                    x: std::array::from_fn(|d| lower[d] + place[d] * (upper[d] - lower[d])),
                    half_length,
                    volume,
                    density,
                    law,
                    centroid: [0.0; _],
                })
                .collect();
            Sample {
                grid,
                seeds,
                method,
                motion,
            }
        })
}

/// The sample after one random step, at a trial of a second one.
struct State<const D: usize> {
    grid: Grid<D>,
    method: Method,
    conditions: StepConditions<D>,
    before: Particles<D>,
    stencils: Stencils<D>,
    u: Vec<[f64; D]>,
    trial: Trial<D>,
}

impl<const D: usize> State<D> {
    /// `cuts` says whether small cuts are treated; without, every node counts.
    fn of(sample: Sample<D>, cuts: bool) -> Self {
        let Sample {
            grid,
            seeds,
            mut method,
            motion,
        } = sample;
        if !cuts {
            method.small_cuts.below = 0.0;
        }
        let mut random = Random(motion);
        let conditions = StepConditions::new(
            grid.clone(),
            Constraints::free(&grid),
            StepLoads {
                gravity: std::array::from_fn(|axis| 1.0 + axis as f64),
                factors: Vec::new(),
                drag: 0.0,
            },
            laws().into_iter().map(|(_, law)| law).collect(),
        )
        .unwrap();
        let mut body = Particles::new(&seeds).unwrap();
        let first = displacements(&grid, LARGEST_STEP, &mut random);
        let (stencils, trial) = evaluate(&conditions, &body, &method, &first);
        body.commit(&stencils, &method, &trial, &first);
        let u = displacements(&grid, LARGEST_STEP, &mut random);
        let (stencils, trial) = evaluate(&conditions, &body, &method, &u);
        Self {
            grid,
            method,
            conditions,
            before: body,
            stencils,
            u,
            trial,
        }
    }

    /// The volume that a particle's stress acts on, as the kinematics define it.
    fn stressed_volume(&self, particle: usize) -> f64 {
        match self.method.kinematics {
            Kinematics::FiniteStrain => self.before.volume0[particle],
            Kinematics::SmallStrain => self.before.volume(particle),
        }
    }

    /// Σ V τ over the particles, and the sum of its magnitudes.
    fn total_stress(&self) -> ([[f64; D]; D], f64) {
        let (mut total, mut size) = ([[0.0; D]; D], 0.0);
        for (particle, state) in by_particle(&self.trial, &self.stencils)
            .into_iter()
            .enumerate()
        {
            let volume = self.stressed_volume(particle);
            for a in 0..D {
                for b in 0..D {
                    total[a][b] += volume * state.tau[a][b];
                    size += volume * state.tau[a][b].abs();
                }
            }
        }
        (total, size)
    }

    /// Σ |stiffness| |u| of the ghost penalty, which may exceed the stress: its round-off counts.
    fn ghost_size(&self) -> f64 {
        let gamma = self.method.small_cuts.ghost_penalty;
        gamma * 100.0 * LARGEST_STEP * self.grid.node_count() as f64
    }
}

fn evaluate<const D: usize>(
    conditions: &StepConditions<D>,
    body: &Particles<D>,
    method: &Method,
    u: &[[f64; D]],
) -> (Stencils<D>, Trial<D>) {
    let stencils = Stencils::build(body, method, conditions).unwrap();
    let system = System::new(body, &stencils, conditions, method).unwrap();
    let trial = system.evaluate(u, TangentKind::Consistent).unwrap();
    (stencils, trial)
}

/// Σ_i f_i = 0: the stored energy does not change when all nodes move alike, because
/// Σ ∇S_i = Σ ∇S̄_i = 0, and pushing gradients forward is linear. Holds for tied nodes and the
/// ghost penalty too.
fn forces_balance<const D: usize>(sample: Sample<D>) -> Result<(), TestCaseError> {
    let state = State::of(sample, true);
    let (_, size) = state.total_stress();
    let scale = size / SMALLEST_CELL + state.ghost_size();
    for axis in 0..D {
        let sum: f64 = state.trial.f_int.iter().map(|force| force[axis]).sum();
        prop_assert!(sum.abs() <= 1e-13 * scale, "{sum:e} of {scale:e}");
    }
    Ok(())
}

/// Σ_i x_i ⊗ f_i = Σ_p V τ, which is symmetric, so that Σ_i x_i × f_i = 0.
///
/// Finite strain, current positions x_i = X_i + u_i: Σ X_i ⊗ ∇S_i = I gives Σ x_i ⊗ ∇S_i = ΔF,
/// hence Σ x_i ⊗ g_i = ΔF ΔF⁻¹ = I; in the same way Σ x_i ⊗ ḡ_i = I with ΔF_c, so that the
/// volumetric term p (ḡ_i − g_i) drops out. Small strain: gradients are not pushed, and the same
/// holds about the positions at the step's start.
///
/// The ghost stiffness k, alike for all components, annihilates linear fields and is symmetric:
/// Σ_i X_i ⊗ (k u)_i = 0 and Σ_i u_i × (k u)_i = Σ_ij k_ij u_i × u_j = 0. It keeps the moment but
/// adds to the symmetric part.
///
/// Tied nodes stand at their masters' places, where Σ X_i ⊗ ∇S_i ≠ I: left out here.
fn moments_balance<const D: usize>(sample: Sample<D>) -> Result<(), TestCaseError> {
    let state = State::of(sample, false);
    let (total, size) = state.total_stress();
    let mut moments = [[0.0; D]; D];
    let mut lever = 0.0;
    for (node, force) in state.trial.f_int.iter().enumerate() {
        let mut x = state.grid.node_position(node);
        if state.method.kinematics == Kinematics::FiniteStrain {
            for axis in 0..D {
                x[axis] += state.u[node][axis];
            }
        }
        for a in 0..D {
            lever = f64::max(lever, x[a].abs());
            for b in 0..D {
                moments[a][b] += x[a] * force[b];
            }
        }
    }
    let scale = lever * (size / SMALLEST_CELL + state.ghost_size());
    let ghost = state.method.small_cuts.ghost_penalty > 0.0;
    for a in 0..D {
        for b in 0..D {
            let moment = moments[a][b] - moments[b][a];
            prop_assert!(moment.abs() <= 1e-12 * scale, "{moment:e} of {scale:e}");
            if !ghost {
                let difference = moments[a][b] - total[a][b];
                prop_assert!(difference.abs() <= 1e-12 * scale, "{difference:e}");
            }
        }
    }
    Ok(())
}

/// Every particle has supports, each node once, ascending.
fn supports_are_in_order<const D: usize>(sample: Sample<D>) -> Result<(), TestCaseError> {
    let state = State::of(sample, true);
    prop_assert_eq!(state.stencils.len(), state.before.len());
    for particle in 0..state.stencils.len() {
        let supports = state.stencils.of(particle);
        prop_assert!(!supports.is_empty() && supports.is_sorted_by(|a, b| a.node < b.node));
    }
    Ok(())
}

/// Node volumes Σ_p S_i V_p are not negative and sum to the body's volume, because Σ_i S_i = 1.
fn node_volumes_sum<const D: usize>(sample: Sample<D>) -> Result<(), TestCaseError> {
    let state = State::of(sample, true);
    let volume: f64 = (0..state.before.len())
        .map(|particle| state.before.volume(particle))
        .sum();
    let nodes = 0..state.conditions.grid.node_count();
    let nodes: Vec<f64> = nodes.map(|node| state.stencils.node_volume(node)).collect();
    prop_assert!(nodes.iter().all(|&volume| volume >= 0.0));
    let sum: f64 = nodes.iter().sum();
    prop_assert!((sum - volume).abs() <= 1e-13 * volume, "{sum} {volume}");
    Ok(())
}

/// An accepted step moves the centre of mass by Σ_i m_i u_i / Σ m with the nodal masses
/// m_i = Σ_p S_i m_p, which are what gravity pulls at; and displacement counts what x gained.
fn commit_moves_the_centre_of_mass<const D: usize>(sample: Sample<D>) -> Result<(), TestCaseError> {
    let state = State::of(sample, true);
    let system = System::new(
        &state.before,
        &state.stencils,
        &state.conditions,
        &state.method,
    )
    .unwrap();
    let mut after = state.before.clone();
    after.commit(&state.stencils, &state.method, &state.trial, &state.u);
    let mass: f64 = after.mass.iter().sum();
    for axis in 0..D {
        let gravity = state.conditions.loads.gravity[axis];
        let work: f64 = std::iter::zip(system.f_ext(), &state.u)
            .map(|(force, u)| force[axis] * u[axis] / gravity)
            .sum();
        let mut moved = 0.0;
        for particle in 0..after.len() {
            let gain = after.x[particle][axis] - state.before.x[particle][axis];
            let counted =
                after.displacement[particle][axis] - state.before.displacement[particle][axis];
            moved += after.mass[particle] * gain;
            prop_assert!((gain - counted).abs() <= 1e-14);
        }
        prop_assert!((moved - work).abs() <= 1e-14 * mass, "{moved} {work}");
    }
    prop_assert_eq!(&after.mass, &state.before.mass);
    prop_assert_eq!(&after.volume0, &state.before.volume0);
    Ok(())
}

/// V = det F · V_0 with F = ΔF F_n, ΔF = I + Σ u_i ⊗ ∇S_i without any B-bar.
fn volume_follows_the_deformation<const D: usize>(sample: Sample<D>) -> Result<(), TestCaseError> {
    let state = State::of(sample, true);
    let mut after = state.before.clone();
    after.commit(&state.stencils, &state.method, &state.trial, &state.u);
    for particle in 0..after.len() {
        let mut increment = [[0.0; D]; D];
        for a in 0..D {
            increment[a][a] = 1.0;
            for support in state.stencils.of(particle) {
                for b in 0..D {
                    increment[a][b] += state.u[support.node][a] * support.grad[b];
                }
            }
        }
        for a in 0..D {
            for b in 0..D {
                let chained: f64 = (0..D)
                    .map(|k| increment[a][k] * state.before.def_grad[particle][k][b])
                    .sum();
                let difference = after.def_grad[particle][a][b] - chained;
                prop_assert!(difference.abs() <= 1e-14, "{difference:e}");
            }
        }
        let det = determinant(&after.def_grad[particle]);
        let volume = after.volume(particle);
        let expected = det * after.volume0[particle];
        prop_assert!((volume - expected).abs() <= 1e-15 * expected);
        let grown = determinant(&increment) * state.before.volume(particle);
        prop_assert!((volume - grown).abs() <= 1e-14 * volume, "{volume} {grown}");
    }
    Ok(())
}

/// The determinant by its definition over permutations.
fn determinant<const D: usize>(a: &[[f64; D]; D]) -> f64 {
    match D {
        2 => a[0][0] * a[1][1] - a[0][1] * a[1][0],
        3 => {
            let even = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
            let odd = [[0, 2, 1], [1, 0, 2], [2, 1, 0]];
            let sum = |permutations: [[usize; 3]; 3]| -> f64 {
                permutations
                    .iter()
                    .map(|p| a[0][p[0]] * a[1][p[1]] * a[2][p[2]])
                    .sum()
            };
            sum(even) - sum(odd)
        }
        _ => unreachable!("samples are two- or three-dimensional"),
    }
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_210_219),
        ..ProptestConfig::default()
    }
}

macro_rules! in_two_and_three_dimensions {
    ($($check:ident),* $(,)?) => {
        mod plane {
            use super::*;
            proptest! {
                #![proptest_config(config(200))]
                $(#[test] fn $check(sample in sample::<2>()) { super::$check(sample)?; })*
            }
        }
        mod solid {
            use super::*;
            proptest! {
                #![proptest_config(config(60))]
                $(#[test] fn $check(sample in sample::<3>()) { super::$check(sample)?; })*
            }
        }
    };
}

in_two_and_three_dimensions!(
    forces_balance,
    moments_balance,
    supports_are_in_order,
    node_volumes_sum,
    commit_moves_the_centre_of_mass,
    volume_follows_the_deformation,
);
