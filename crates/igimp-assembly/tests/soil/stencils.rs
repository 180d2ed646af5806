//! GOAL: the supports of a particle are exact, for domains of any size and place, walls and
//! tied small cuts included, with both bases, with and without B-bar.
//! BODY: random graded grids in two and three dimensions, particles anywhere on them: in corners,
//! on nodes and walls, with domains down to nothing and across many cells.
//! ORACLE: identities of the basis about the particle's own domain, which is capped at a cell and cut
//! at the walls here anew.

use crate::common::{conditions, laws, methods};
use igimp_assembly::{Locking, Method, ParticleSeed, Particles, Stencils};
use igimp_shape::{Axis, Grid, Support};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Smallest cell of the random grids \[length\].
const SMALLEST_CELL: f64 = 0.5;

/// A random body and its method.
#[derive(Clone, Debug)]
struct Sample<const D: usize> {
    grid: Grid<D>,
    seeds: Vec<ParticleSeed<D>>,
    method: Method,
}

fn axis() -> impl Strategy<Value = Axis> {
    let sizes = prop::collection::vec(SMALLEST_CELL..2.0, 1..=5);
    (-3.0..3.0, sizes).prop_map(|(start, sizes)| {
        let mut nodes = vec![start];
        for size in sizes {
            nodes.push(nodes[nodes.len() - 1] + size);
        }
        Axis::from_nodes(nodes).unwrap()
    })
}

/// Along one axis: a share of the length, whether the next node is taken, and a half-length.
fn place() -> impl Strategy<Value = (f64, bool, f64)> {
    let half_length = prop_oneof![
        3 => 0.01..1.0,
        1 => 1.0..10.0,
        1 => (-17.0..-2.0).prop_map(|exponent| 10_f64.powf(exponent)),
    ];
    (0.0..=1.0, prop::bool::weighted(0.2), half_length)
}

fn sample<const D: usize>() -> impl Strategy<Value = Sample<D>> {
    let particle = (prop::array::uniform::<_, D>(place()), 0.01..1.0, 0.1..3.0);
    (
        prop::array::uniform::<_, D>(axis()),
        prop::collection::vec(particle, 1..=10),
        prop::sample::select(methods()),
    )
        .prop_map(|(axes, particles, method)| {
            let grid = Grid::new(axes);
            let seeds = particles
                .into_iter()
                .map(|(places, volume, density)| ParticleSeed {
                    x: std::array::from_fn(|d| {
                        let (share, on_node, _) = places[d];
                        let axis = &grid.axes[d];
                        let x = axis.start() + share * (axis.end() - axis.start());
                        let x = x.clamp(axis.start(), axis.end());
                        let next = axis.nodes().iter().find(|&&node| node >= x);
                        next.copied().filter(|_| on_node).unwrap_or(x)
                    }),
                    half_length: std::array::from_fn(|d| places[d].2),
                    volume,
                    density,
                    law: 0,
                    centroid: [0.0; _],
                })
                .collect();
            Sample {
                grid,
                seeds,
                method,
            }
        })
}

/// The stencils of a sample; `cuts` says whether small cuts are treated.
fn stencils<const D: usize>(sample: &Sample<D>, cuts: bool) -> (Particles<D>, Stencils<D>) {
    let mut method = sample.method.clone();
    if !cuts {
        method.small_cuts.below = 0.0;
    }
    let particles = Particles::new(&sample.seeds).unwrap();
    let conditions = conditions(&sample.grid, &laws()[1].1);
    let stencils = Stencils::build(&particles, &method, &conditions).unwrap();
    (particles, stencils)
}

/// Σ S = 1, Σ ∇S = Σ ∇S̄ = 0, values and supports in range: also for tied nodes.
fn sums_over_nodes<const D: usize>(sample: &Sample<D>) -> Result<(), TestCaseError> {
    for cuts in [false, true] {
        let (particles, stencils) = stencils(sample, cuts);
        for particle in 0..particles.len() {
            let list = stencils.of(particle);
            prop_assert!(list.windows(2).all(|pair| pair[0].node < pair[1].node));
            prop_assert!(
                list.iter()
                    .all(|support| support.node < sample.grid.node_count())
            );
            prop_assert!(list.iter().all(|support| support.value >= 0.0));
            let unity: f64 = list.iter().map(|support| support.value).sum();
            prop_assert!((unity - 1.0).abs() <= 1e-14, "{unity}");
            for d in 0..D {
                let sum: f64 = list.iter().map(|support| support.grad[d]).sum();
                let sum_bar: f64 = list.iter().map(|support| support.grad_bar[d]).sum();
                let largest = sum.abs().max(sum_bar.abs());
                prop_assert!(largest <= 1e-13 / SMALLEST_CELL, "{sum} {sum_bar}");
            }
        }
    }
    Ok(())
}

/// A field a + B·x: S gives it at the middle of the domain as it is cut, ∇S and ∇S̄ give B.
fn linear_fields<const D: usize>(sample: &Sample<D>) -> Result<(), TestCaseError> {
    let (particles, stencils) = stencils(sample, false);
    for particle in 0..particles.len() {
        let list = stencils.of(particle);
        let middle = middle(sample, particle);
        let weighted = |of: &dyn Fn(&Support<D>) -> f64, a: usize| -> f64 {
            let about = |node: usize| sample.grid.node_position(node)[a] - middle[a];
            list.iter()
                .map(|support| of(support) * about(support.node))
                .sum()
        };
        for a in 0..D {
            let miss = weighted(&|support| support.value, a);
            prop_assert!(miss.abs() <= 1e-13, "{miss:e} off {middle:?}");
            for b in 0..D {
                let identity = f64::from(u8::from(a == b));
                let grad = weighted(&|support| support.grad[b], a);
                let grad_bar = weighted(&|support| support.grad_bar[b], a);
                prop_assert!((grad - identity).abs() <= 1e-12, "{grad}");
                prop_assert!((grad_bar - identity).abs() <= 1e-12, "{grad_bar}");
            }
        }
        if sample.method.locking == Locking::None {
            prop_assert!(list.iter().all(
                |support| support.grad.map(f64::to_bits) == support.grad_bar.map(f64::to_bits)
            ));
        }
    }
    Ok(())
}

/// The middle of a domain that counts up to a cell to either side and ends at the walls; for the
/// linear basis the particle itself.
fn middle<const D: usize>(sample: &Sample<D>, particle: usize) -> [f64; D] {
    let seed = &sample.seeds[particle];
    if sample.method.basis.name() == "linear" {
        return seed.x;
    }
    let cell = sample.grid.cell_at(&seed.x).unwrap();
    std::array::from_fn(|d| {
        let axis = &sample.grid.axes[d];
        let half_length = seed.half_length[d].min(axis.spacing(cell[d]));
        let lower = (seed.x[d] - half_length).max(axis.start());
        let upper = (seed.x[d] + half_length).min(axis.end());
        0.5 * (lower + upper)
    })
}

/// Node volumes and masses are Σ S V and Σ S m over the particles, and sum to those of the body;
/// tied or not. A node without supports has none.
fn shares_add_up<const D: usize>(sample: &Sample<D>) -> Result<(), TestCaseError> {
    for cuts in [false, true] {
        let (particles, stencils) = stencils(sample, cuts);
        let nodes = sample.grid.node_count();
        let (mut volumes, mut masses) = (vec![0.0; nodes], vec![0.0; nodes]);
        for particle in 0..particles.len() {
            for support in stencils.of(particle) {
                volumes[support.node] += support.value * particles.volume(particle);
                masses[support.node] += support.value * particles.mass[particle];
            }
        }
        let whole = |of: &dyn Fn(usize) -> f64, count: usize| (0..count).map(of).sum::<f64>();
        let volume = whole(&|particle| particles.volume(particle), particles.len());
        let mass = whole(&|particle| particles.mass[particle], particles.len());
        for node in 0..nodes {
            let (found, expected) = (stencils.node_volume(node), volumes[node]);
            prop_assert!(
                (found - expected).abs() <= 1e-14 * volume,
                "{found} {expected}"
            );
            let (found, expected) = (stencils.node_mass(node), masses[node]);
            prop_assert!(
                (found - expected).abs() <= 1e-14 * mass,
                "{found} {expected}"
            );
        }
        let sum = whole(&|node| stencils.node_volume(node), nodes);
        prop_assert!((sum - volume).abs() <= 1e-13 * volume, "{sum} {volume}");
        let sum = whole(&|node| stencils.node_mass(node), nodes);
        prop_assert!((sum - mass).abs() <= 1e-13 * mass, "{sum} {mass}");
    }
    Ok(())
}

/// Ties only join nodes: the share of a node is the sum of those of the nodes that it now
/// stands for, so that supports never grow in number.
fn ties_only_join<const D: usize>(sample: &Sample<D>) -> Result<(), TestCaseError> {
    let (particles, plain) = stencils(sample, false);
    let (_, tied) = stencils(sample, true);
    for particle in 0..particles.len() {
        let (before, after) = (plain.of(particle), tied.of(particle));
        prop_assert!(after.len() <= before.len());
        for support in after {
            // A node that is left stands for itself and for others.
            let whole = before.iter().find(|other| other.node == support.node);
            if let Some(whole) = whole {
                prop_assert!(support.value >= whole.value - 1e-15);
            }
        }
    }
    Ok(())
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_261_121),
        ..ProptestConfig::default()
    }
}

macro_rules! in_two_and_three_dimensions {
    ($($check:ident),* $(,)?) => {
        mod plane {
            use super::*;
            proptest! {
                #![proptest_config(config(300))]
                $(#[test] fn $check(sample in sample::<2>()) { super::$check(&sample)?; })*
            }
        }
        mod solid {
            use super::*;
            proptest! {
                #![proptest_config(config(80))]
                $(#[test] fn $check(sample in sample::<3>()) { super::$check(&sample)?; })*
            }
        }
    };
}

in_two_and_three_dimensions!(
    sums_over_nodes,
    linear_fields,
    shares_add_up,
    ties_only_join
);

// GOAL: particles beyond the first block of those that are handled together see the grid as the first do.
// CASE: 1296 particles, in blocks of 1024.
// ORACLE: Σ x_i ⊗ ∇S_i = I and Σ x_i ⊗ ∇S̄_i = I, and the centroid of what a particle sees is near its own.
#[test]
fn particles_of_later_blocks_see_the_grid() {
    let grid = crate::common::grid::<2>(20);
    let body = crate::common::particles(&grid, 0.0, &mut crate::common::Random(29));
    assert!(body.len() > 1024);
    let law = laws().remove(0).1;
    let conditions = conditions(&grid, &law);
    for method in [Method::shared_strain(), Method::igimp_bbar()] {
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        for particle in 0..body.len() {
            let list = stencils.of(particle);
            for a in 0..2 {
                let place = |support: &Support<2>| grid.node_position(support.node)[a];
                let x: f64 = list.iter().map(|s| s.value * place(s)).sum();
                assert!((x - body.x[particle][a]).abs() < 1e-10, "{particle}: {x}");
                for b in 0..2 {
                    let expected = f64::from(u8::from(a == b));
                    let sum: f64 = list.iter().map(|s| s.grad[b] * place(s)).sum();
                    let bar: f64 = list.iter().map(|s| s.grad_bar[b] * place(s)).sum();
                    assert!((sum - expected).abs() < 1e-10 && (bar - expected).abs() < 1e-10);
                }
            }
        }
    }
}
