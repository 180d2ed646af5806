//! GOAL: on a given geometry strain adds up without turning or moving anything, and a sliver of soil
//! beyond a face resists nothing; shared gradients are means.
//! BODY: a block of three by three cells, moved a little over a line of the grid, so that its particles
//! reach into the cells beyond.
//! ORACLE: strain that adds up linearly, identities of a consistent gradient, and modes that a mean over
//! cells does not see.

use crate::common::{Random, laws, particles};
use igimp_assembly::{
    Constraints, Geometry, Locking, Method, Particles, Remedy, Stencils, StepConditions, StepLoads,
    System,
};
use igimp_material::{Elasticity, MohrCoulomb, TangentKind};
use igimp_shape::{Axis, Grid};

fn grid() -> Grid<2> {
    let axis = Axis::uniform(0.0, 1.0, 8).unwrap();
    Grid::new([axis.clone(), axis])
}

fn conditions(law: usize) -> StepConditions<2> {
    let grid = grid();
    StepConditions::new(
        grid.clone(),
        Constraints::free(&grid),
        StepLoads::gravity([0.0; 2]),
        vec![laws()[law].1.clone()],
    )
    .unwrap()
}

/// Quarter-cell particles from 2 to 5 along both axes, moved by `shift`.
fn block(shift: f64) -> Particles<2> {
    let mut seeds = Vec::new();
    for row in 0..6 {
        for column in 0..6 {
            seeds.push(igimp_assembly::ParticleSeed {
                x: [column, row].map(|k| 2.25 + 0.5 * f64::from(k) + shift),
                half_length: [0.25; 2],
                volume: 0.25,
                density: 1.0,
                law: 0,
                centroid: [0.0; _],
            });
        }
    }
    Particles::new(&seeds).unwrap()
}

fn given(locking: Locking) -> Method {
    Method {
        locking,
        geometry: Geometry::Given,
        ..Method::igimp_bbar()
    }
}

/// Nodal displacements of a uniform gradient.
fn affine(grid: &Grid<2>, gradient: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    (0..grid.node_count())
        .map(|node| {
            let x = grid.node_position(node);
            std::array::from_fn(|a| gradient[a][0] * x[0] + gradient[a][1] * x[1])
        })
        .collect()
}

#[test]
fn two_half_steps_are_one_whole_step_and_nothing_moves() {
    let conditions = conditions(0);
    let gradient = [[3.0, 1.0], [-1.0, -2.0]];
    for locking in [Locking::None, Locking::BBar, Locking::SharedStrain] {
        let method = given(locking);
        let mut ends = Vec::new();
        for parts in [1, 2] {
            let mut body = block(0.003);
            let before = body.clone();
            let part = gradient.map(|row| row.map(|g| g / f64::from(parts) * 1e-3));
            let u = affine(&conditions.grid, part);
            for _ in 0..parts {
                let stencils = Stencils::build(&body, &method, &conditions).unwrap();
                let system = System::new(&body, &stencils, &conditions, &method).unwrap();
                let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
                body.commit(&stencils, &method, &trial, &u);
            }
            assert_eq!(body.x, before.x);
            assert_eq!(body.def_grad, before.def_grad);
            assert_eq!(body.half_length, before.half_length);
            assert_ne!(body.displacement, before.displacement);
            ends.push(body.sigma.clone());
        }
        let largest = |sigma: &[[[f64; 3]; 3]]| {
            let all = sigma.iter().flatten().flatten();
            all.fold(0.0_f64, |largest, value| largest.max(value.abs()))
        };
        let scale = largest(&ends[0]);
        assert!(scale > 0.0);
        for (one, two) in ends[0].iter().zip(&ends[1]) {
            for (a, b) in one.iter().flatten().zip(two.iter().flatten()) {
                assert!((a - b).abs() < 1e-12 * scale, "{locking:?}: {a} {b}");
            }
        }
    }
}

#[test]
fn a_sliver_has_no_nodes_of_its_own() {
    let conditions = conditions(0);
    // The block reaches 0.3 % of a cell beyond the lines at 5, and leaves those at 2.
    let body = block(0.003);
    for locking in [Locking::None, Locking::BBar, Locking::SharedStrain] {
        let stencils = Stencils::build(&body, &given(locking), &conditions).unwrap();
        for particle in 0..body.len() {
            let list = stencils.of(particle);
            let place = |node| conditions.grid.node_place(node);
            assert!(
                list.iter()
                    .all(|s| place(s.node).into_iter().all(|k| k <= 5))
            );
            for a in 0..2 {
                for b in 0..2 {
                    let sum = |gradient: fn(&igimp_shape::Support<2>) -> [f64; 2]| -> f64 {
                        list.iter()
                            .map(|s| gradient(s)[b] * conditions.grid.node_position(s.node)[a])
                            .sum()
                    };
                    let identity = f64::from(u8::from(a == b));
                    assert!((sum(|s| s.grad) - identity).abs() < 1e-13);
                    assert!((sum(|s| s.grad_bar) - identity).abs() < 1e-13);
                }
            }
        }
    }
}

#[test]
fn the_mean_of_a_cell_sees_no_hourglass() {
    let conditions = conditions(1);
    let grid = grid();
    let body = particles::<2>(&grid, 0.0, &mut Random(7));
    let mut method = given(Locking::SharedStrain);
    method.geometry = Geometry::Moving;
    let stencils = Stencils::build(&body, &method, &conditions).unwrap();
    // Hourglass: zero mean strain in every cell.
    let u: Vec<[f64; 2]> = (0..grid.node_count())
        .map(|node| {
            let [i, j] = grid.node_place(node);
            let sign = if (i + j) % 2 == 0 { 1e-6 } else { -1e-6 };
            [sign, 0.0]
        })
        .collect();
    for particle in 0..body.len() {
        let strain = |gradient: fn(&igimp_shape::Support<2>) -> [f64; 2]| -> f64 {
            let list = stencils.of(particle).iter();
            list.map(|s| u[s.node][0] * gradient(s)[0])
                .sum::<f64>()
                .abs()
        };
        assert!(strain(|s| s.grad_bar) < 1e-12);
        // A tenth of the particle's own is left, at most 2e-6 across a cell.
        assert!(strain(|s| s.grad) < 0.101 * 2e-6);
    }
}

// GOAL: a thin layer that moves with the cells behind it takes its mean from them on a given geometry, and keeps its own on a moving one.
// BODY: the block moved by a tenth of a cell along both axes, so that layers lie above it, beside it and at its corner.
// ORACLE: bending of the top row of cells, u_x = x (y − 4.5), whose mean over a cell of that row has no ∂u_x/∂x; with the middle
// of the layer it would be one in the layer, which holds a fifth of the topmost particles.
#[test]
fn a_layer_that_moves_with_the_cell_behind_shares_its_mean() {
    let conditions = conditions(1);
    let body = block(0.1);
    let mut method = given(Locking::BBar);
    (method.small_cuts.below, method.small_cuts.remedy) = (0.05, Remedy::Extrapolate);
    for (geometry, expected) in [(Geometry::Given, 0.0), (Geometry::Moving, 0.2)] {
        method.geometry = geometry;
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let stretch = |particle: usize| -> f64 {
            let bending = |support: &igimp_shape::Support<2>| {
                let [x, y] = conditions.grid.node_position(support.node);
                support.grad_bar[0] * x * (y - 4.5)
            };
            stencils.of(particle).iter().map(bending).sum()
        };
        let top = (0..body.len()).filter(|&particle| body.x[particle][1] > 4.6);
        for particle in top {
            let found = stretch(particle);
            assert!((found - expected).abs() < 1e-12, "{geometry:?}: {found}");
        }
    }
}

#[test]
fn elastic_soil_that_moves_shares_as_b_bar_does() {
    let conditions = conditions(0);
    let body = particles::<2>(&grid(), 0.0, &mut Random(11));
    let of = |method: &Method| Stencils::build(&body, method, &conditions).unwrap();
    let (shared, b_bar) = (of(&Method::shared_strain()), of(&Method::igimp_bbar()));
    for particle in 0..body.len() {
        let (one, other) = (shared.of(particle), b_bar.of(particle));
        assert_eq!(one.len(), other.len());
        for (a, b) in one.iter().zip(other) {
            assert_eq!(a.node, b.node);
            for axis in 0..2 {
                assert!((a.grad[axis] - b.grad[axis]).abs() < 1e-12);
                assert!((a.grad_bar[axis] - b.grad_bar[axis]).abs() < 1e-12);
            }
        }
    }
}

/// GOAL: weight is where the soil is, and what the variation of stress carries of it is no force and no moment (theory,
/// eqs. 8e and 8f).
/// ORACLE: statics: nodal forces of a bilinear basis have the sum and the first moments of the weight of the soil.
#[test]
fn weight_acts_at_the_centroid_of_the_soil() {
    let mut seeds: Vec<igimp_assembly::ParticleSeed<2>> = Vec::new();
    for (row, width) in [4, 3, 1].into_iter().enumerate() {
        for column in 0..2 * width {
            for half in 0..2 {
                let is_cut = column == 2 * width - 1;
                seeds.push(igimp_assembly::ParticleSeed {
                    x: [
                        2.25 + 0.5 * f64::from(column),
                        2.25 + row as f64 + 0.5 * f64::from(half),
                    ],
                    half_length: [0.25; 2],
                    volume: if is_cut { 0.125 } else { 0.25 },
                    density: 1.0,
                    law: 0,
                    centroid: if is_cut { [-1.0 / 3.0; 2] } else { [0.0; 2] },
                });
            }
        }
    }
    let particles = Particles::new(&seeds).unwrap();
    let grid = grid();
    let gravity = [0.3, -2.0];
    let elasticity = Elasticity::new(1e7, 0.3).unwrap();
    let friction = 0.5;
    let sand = MohrCoulomb::new(elasticity, 0.0, friction, friction).unwrap();
    // Cells of a body that nothing holds are loose (theory, eq. 8i).
    let mut held = Constraints::free(&grid);
    for (x, axis) in (2..=6).flat_map(|x| [(x, 0), (x, 1)]) {
        held.prescribe(grid.node_index([x, 2]), axis, 0.0).unwrap();
    }
    let conditions = StepConditions::new(
        grid.clone(),
        held,
        StepLoads::gravity(gravity),
        vec![std::sync::Arc::new(sand)],
    )
    .unwrap();
    let forces = |locking| {
        let method = given(locking);
        let stencils = Stencils::build(&particles, &method, &conditions).unwrap();
        let system = System::new(&particles, &stencils, &conditions, &method).unwrap();
        system.f_ext().to_vec()
    };
    let (shared, alone) = (forces(Locking::SharedStrain), forces(Locking::None));
    let mass: f64 = seeds.iter().map(|seed| seed.volume).sum();
    for force in [&shared, &alone] {
        for axis in 0..2 {
            let sum: f64 = force.iter().map(|f| f[axis]).sum();
            assert!((sum - mass * gravity[axis]).abs() < 1e-12, "{sum}");
            for along in 0..2 {
                let moment: f64 = (0..force.len())
                    .map(|node| force[node][axis] * grid.node_position(node)[along])
                    .sum();
                let exact: f64 = seeds
                    .iter()
                    .map(|seed| {
                        let place = seed.x[along] + seed.centroid[along] * seed.half_length[along];
                        seed.volume * gravity[axis] * place
                    })
                    .sum();
                assert!((moment - exact).abs() < 1e-11, "{moment} {exact}");
            }
        }
    }
    // Full cells around a node cancel, those at the stairs do not.
    let apart = |place: [usize; 2]| {
        let node = grid.node_index(place);
        (0..2).fold(0.0_f64, |most, axis| {
            most.max((shared[node][axis] - alone[node][axis]).abs())
        })
    };
    assert!(apart([3, 3]) < 1e-14, "{}", apart([3, 3]));
    assert!(apart([5, 3]) > 1e-3, "{}", apart([5, 3]));
}

// GOAL: particles of a cell share the mean of its soil, also where soil fills a part of the cell.
// CASE: a block whose uppermost cells are filled to their lower half, each particle within one cell.
// ORACLE: the mean of the gradients of the particles in the cell, which without sharing are those of their places.
#[test]
fn shared_slopes_are_the_mean_over_the_soil_of_a_cell() {
    let conditions = conditions(1);
    let whole = block(0.0);
    let body = whole.keeping(|p| whole.x[p][1] < 4.5).unwrap();
    let of = |locking| Stencils::build(&body, &given(locking), &conditions).unwrap();
    let (alone, shared) = (of(Locking::None), of(Locking::SharedStrain));
    let cell = |particle: usize| body.x[particle].map(|x| x.floor() as i64);
    for particle in 0..body.len() {
        let beside: Vec<usize> = (0..body.len())
            .filter(|&p| cell(p) == cell(particle))
            .collect();
        for support in shared.of(particle) {
            for axis in 0..2 {
                let slopes = beside.iter().map(|&other| {
                    let mut near = alone.of(other).iter().filter(|s| s.node == support.node);
                    near.next().map_or(0.0, |s| s.grad[axis])
                });
                let mean = slopes.sum::<f64>() / beside.len() as f64;
                let found = support.grad_bar[axis];
                assert!((found - mean).abs() < 1e-13, "{found} {mean}");
            }
        }
    }
}

// GOAL: a particle that is in slivers for the most part keeps them, and one that is not gives them up.
// CASE: a small particle across a line beside a block, four and six tenths of it in the empty cell beyond.
// ORACLE: the rule of eq. 8d; what is kept of either has weights that sum to one.
#[test]
fn a_particle_keeps_the_slivers_that_it_is_mostly_in() {
    let conditions = conditions(0);
    for (x, keeps) in [(4.992, false), (5.008, true)] {
        let small = Particles::new(&[igimp_assembly::ParticleSeed {
            x: [x, 3.5],
            half_length: [0.04; 2],
            volume: 0.08 * 0.08,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        }])
        .unwrap();
        let body = block(0.0).joined_by(&small);
        let mut method = given(Locking::BBar);
        // Nodes beyond are small cuts: they would be those of the block.
        method.small_cuts.below = 0.0;
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let supports = stencils.of(body.len() - 1);
        let sum: f64 = supports.iter().map(|support| support.value).sum();
        assert!((sum - 1.0).abs() < 1e-14, "{sum}");
        let beyond = |support: &igimp_shape::Support<2>| {
            let [column, _] = conditions.grid.node_place(support.node);
            column == 6 && support.value > 0.0
        };
        assert_eq!(supports.iter().any(beyond), keeps, "{x}");
    }
}
