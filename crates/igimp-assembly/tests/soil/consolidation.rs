//! GOAL: equations with excess pore pressure among the unknowns: their tangent, and whether pressures are held.
//! ORACLE: central differences; the eigenvalues of the pair of displacement and pressure, computed dense.

use std::sync::Arc;

use crate::common::{Random, conditions, displacements, grid, laws, methods, particles};
use igimp_assembly::{
    Consolidating, Constraints, Geometry, Method, ParticleSeed, Particles, Permeable, PoreFlow,
    Section, SharedLaw, Stencils, StepConditions, StepLoads, System, VoidLaw,
};
use igimp_material::{Elasticity, HenckyElastic, TangentKind};
use igimp_shape::{Axis, Grid};
use nalgebra_sparse::na::DMatrix;

fn flow<const D: usize>(duration: f64, stiffness: f64) -> Consolidating<D> {
    let mut mobility = [[0.0; D]; D];
    for (axis, row) in mobility.iter_mut().enumerate() {
        row[axis] = 1.0 + axis as f64;
    }
    Consolidating {
        duration,
        before: 0.5 * duration,
        must_resolve: false,
        soils: vec![PoreFlow::Flows(Permeable {
            mobility,
            stiffness: stiffness.into(),
            follows: Some(VoidLaw {
                initial: 1.0,
                index: None,
            }),
        })],
        open_sides: Vec::new(),
        open_faces: true,
        drains: Vec::new(),
    }
}

/// Largest difference of the tangent from differences over its largest entry, every so many unknowns.
fn tangent_error<const D: usize>(
    grid: &Grid<D>,
    body: &Particles<D>,
    law: &SharedLaw,
    method: &Method,
    random: &mut Random,
) -> f64 {
    let conditions = conditions(grid, law)
        .with_flow(Some(flow(0.02, 1e3)))
        .unwrap();
    let stencils = Stencils::build(body, method, &conditions).unwrap();
    let system = System::new(body, &stencils, &conditions, method).unwrap();
    let mut u = displacements(grid, 0.02, random);
    u.resize_with(system.node_count(), || {
        let mut pressure = [0.0; D];
        pressure[0] = 0.01 * random.symmetric();
        pressure
    });
    let (_, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
    let unknowns = system.unknowns();
    let places: Vec<(usize, usize)> = (0..unknowns.len())
        .map(|unknown| unknowns.place(unknown).unwrap())
        .collect();
    let (mut unit, mut column) = (vec![0.0; unknowns.len()], vec![0.0; unknowns.len()]);
    let (mut largest, mut error, mut compared) = (0.0_f64, 0.0_f64, 0);
    for k in (0..unknowns.len()).step_by(unknowns.len() / 25) {
        let (node, axis) = places[k];
        unit[k] = 1.0;
        matrix.multiply(&unit, &mut column);
        unit[k] = 0.0;
        let d = 1e-6;
        let [plus, minus] = [d, -d].map(|by| {
            let mut u = u.clone();
            u[node][axis] += by;
            system.evaluate(&u, TangentKind::Consistent).unwrap()
        });
        let regimes = |of: &igimp_assembly::Trial<D>| -> Vec<_> {
            of.particles.iter().map(|p| p.regime).collect()
        };
        if regimes(&plus) != regimes(&minus) {
            continue; // the force has a kink here, and differences have no meaning
        }
        compared += 1;
        for (row, &(node, axis)) in places.iter().enumerate() {
            let difference = (plus.f_int[node][axis] - minus.f_int[node][axis]) / (2.0 * d);
            largest = largest.max(difference.abs());
            error = error.max((difference - column[row]).abs());
        }
    }
    assert!(compared > 18, "{compared} columns compared");
    error / largest
}

#[test]
fn the_tangent_is_the_derivative() {
    let mut random = Random(11);
    let (plane, space) = (grid::<2>(6), grid::<3>(4));
    let bodies = (
        particles(&plane, 1.0, &mut random),
        particles(&space, 1.0, &mut random),
    );
    for (name, law) in laws() {
        for method in methods() {
            let given = Method {
                geometry: Geometry::Given,
                ..method.clone()
            };
            let turned = Method {
                section: Section::Axisymmetric,
                ..method.clone()
            };
            for method in [method, given, turned] {
                let error = tangent_error(&plane, &bodies.0, &law, &method, &mut random);
                assert!(
                    error < 1e-6,
                    "{name}, {}, {:?}, {:?}: {error:e}",
                    method.label(),
                    method.geometry,
                    method.section
                );
            }
        }
        let method = Method::igimp_bbar();
        let error = tangent_error(&space, &bodies.1, &law, &method, &mut random);
        assert!(error < 1e-6, "{name} in space: {error:e}");
    }
}

/// A square of cells of soil, the uppermost row filled to a part, held at its sides and its base, and at its top if that is
/// a line of the grid.
fn square(cells: usize, part: f64) -> (Particles<2>, Grid<2>, Constraints<2>) {
    let size = 1.0 / cells as f64;
    let axis = |cells| Axis::uniform(0.0, size, cells).unwrap();
    let is_cut = part < 1.0;
    let grid = Grid::new([axis(cells), axis(cells + usize::from(is_cut))]);
    let mut seeds = Vec::new();
    for row in 0..2 * cells {
        for column in 0..2 * cells {
            let filled = if row / 2 + 1 == cells { part } else { 1.0 };
            let lower = size * (row / 2) as f64;
            let height = 0.5 * size * filled;
            seeds.push(ParticleSeed {
                x: [
                    size * (0.5 * column as f64 + 0.25),
                    lower + height * ((row % 2) as f64 + 0.5),
                ],
                half_length: [0.25 * size, 0.5 * height],
                volume: 0.5 * size * height,
                density: 1.0,
                law: 0,
                centroid: [0.0; 2],
            });
        }
    }
    let mut constraints = Constraints::free(&grid);
    for axis in 0..2 {
        constraints.fix_wall(&grid, 0, false, axis).unwrap();
        constraints.fix_wall(&grid, 0, true, axis).unwrap();
        constraints.fix_wall(&grid, 1, false, axis).unwrap();
        if !is_cut {
            constraints.fix_wall(&grid, 1, true, axis).unwrap();
        }
    }
    (Particles::new(&seeds).unwrap(), grid, constraints)
}

// GOAL: no pressure swings freely between nodes where water has no time to flow: the pair is stable on cut cells too.
// ORACLE: the smallest eigenvalue of the pair with the projection against the pressure mass, times G, is at least 0.1 on
// 16 × 16 cells (0.189 was computed for bilinear elements); without the projection there are more that vanish. With walls all round
// one pressure is free, the constant.
#[test]
fn pressures_are_held() {
    let cells = 16;
    let (young, poisson) = (1.0, 0.0);
    let shear = 0.5 * young;
    for part in [1.0, 0.7, 0.3, 0.1] {
        let (body, grid, constraints) = square(cells, part);
        let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(young, poisson).unwrap()));
        let mut closed = flow(1e-12, 1e12);
        (closed.open_faces, closed.before) = (false, 0.0);
        let loads = StepLoads::gravity([0.0; 2]);
        let conditions = StepConditions::new(grid.clone(), constraints, loads, vec![law])
            .unwrap()
            .with_flow(Some(closed))
            .unwrap();
        let method = Method::igimp_bbar();
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        let still = vec![[0.0; 2]; system.node_count()];
        let (_, matrix) = system.linearise(&still, TangentKind::Elastic).unwrap();
        let unknowns = system.unknowns();
        let pressures: Vec<usize> = (0..unknowns.scalar_nodes().count())
            .map(|k| unknowns.index(unknowns.first_scalar() + k, 0).unwrap())
            .collect();
        let displacements: Vec<usize> = (0..unknowns.len())
            .filter(|unknown| pressures.binary_search(unknown).is_err())
            .collect();
        let mut dense = DMatrix::zeros(unknowns.len(), unknowns.len());
        for (row, column, &value) in matrix.to_csc().triplet_iter() {
            dense[(row, column)] = value;
        }
        let of = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
                dense[(rows[i], columns[j])]
            })
        };
        let soil = of(&displacements, &displacements).cholesky().unwrap();
        let coupling = of(&displacements, &pressures);
        let schur = coupling.transpose() * soil.solve(&coupling);
        let projection = -of(&pressures, &pressures);
        // Pressure over its unknown: the constrained modulus, here that of Young, over a cell.
        let scale = young * cells as f64;
        let mut mass = DMatrix::<f64>::zeros(pressures.len(), pressures.len());
        let places: Vec<usize> = unknowns.scalar_nodes().collect();
        for particle in 0..body.len() {
            let supports = stencils.of(particle);
            for a in supports {
                for b in supports {
                    let [i, j] = [a, b].map(|s| places.binary_search(&s.node).unwrap());
                    mass[(i, j)] += scale * scale * body.volume(particle) * a.value * b.value;
                }
            }
        }
        let factor = mass.cholesky().unwrap().l();
        let eigenvalues = |pair: &DMatrix<f64>| {
            let half = factor.solve_lower_triangular(pair).unwrap();
            let whole = factor.solve_lower_triangular(&half.transpose()).unwrap();
            let mut all: Vec<f64> = (whole.symmetric_eigenvalues().iter())
                .map(|value| value * shear)
                .collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let free = usize::from(part >= 1.0);
        let held = eigenvalues(&(&schur + &projection));
        let bare = eigenvalues(&schur);
        println!(
            "uppermost cells filled to {part}: least {:.3}, most {:.3}; without projection {:.1e}",
            held[free],
            held[held.len() - 1],
            bare[free]
        );
        assert!(held[free] > 0.1, "{part}: {}", held[free]);
        assert!(bare[free] < 1e-9, "{part}: {}", bare[free]);
        assert!(free == 0 || held[0].abs() < 1e-9);
    }
}
