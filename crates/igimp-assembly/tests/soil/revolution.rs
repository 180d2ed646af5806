//! Bodies of revolution (theory, eqs. 130 to 130e).

use std::f64::consts::PI;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, Geometry, Method, ParticleSeed, Particles, Section, SharedLaw, Stencils,
    StepConditions, StepLoads, System, Trial,
};
use igimp_material::{Elasticity, HenckyElastic, MohrCoulomb, TangentKind};
use igimp_shape::{Axis, Grid, Linear};

use crate::common::by_particle;

/// A grid from the axis on, with unequal cells.
fn grid() -> Grid<2> {
    let radii = Axis::from_nodes(vec![0.0, 0.8, 1.9, 2.9, 4.1]).unwrap();
    Grid::new([radii, Axis::from_nodes(vec![0.0, 1.1, 2.0, 3.2]).unwrap()])
}

/// Three by two particles in all cells but the outermost and the topmost.
fn body(grid: &Grid<2>) -> Particles<2> {
    let mut seeds = Vec::new();
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        if place[0] == 3 || place[1] == 2 {
            continue;
        }
        let (size, lower) = (
            grid.cell_size(place),
            grid.node_position(grid.node_index(place)),
        );
        let half_length = [size[0] / 6.0, size[1] / 4.0];
        for k in 0..6 {
            let part = [k % 3, k / 3];
            let x: [f64; 2] = std::array::from_fn(|axis| {
                lower[axis] + f64::from(2 * part[axis] + 1) * half_length[axis]
            });
            let area = 4.0 * half_length[0] * half_length[1];
            seeds.push(ParticleSeed {
                x,
                half_length,
                volume: Section::Axisymmetric.thickness(x[0]) * area,
                density: 2.0,
                law: 0,
                centroid: [0.0; _],
            });
        }
    }
    Particles::new(&seeds).unwrap()
}

fn methods() -> Vec<Method> {
    let mut methods = Vec::new();
    let linear = Method {
        basis: Arc::new(Linear),
        ..Method::igimp_bbar()
    };
    for of in [
        Method::igimp(),
        Method::igimp_bbar(),
        Method::shared_strain(),
        linear,
    ] {
        for geometry in [Geometry::Moving, Geometry::Given] {
            methods.push(Method {
                section: Section::Axisymmetric,
                geometry,
                ..of.clone()
            });
        }
    }
    methods
}

fn elastic() -> SharedLaw {
    Arc::new(HenckyElastic::new(Elasticity::new(100.0, 0.3).unwrap()))
}

/// The body at nodal displacements (a r, b z).
fn trial(
    method: &Method,
    law: SharedLaw,
    [a, b]: [f64; 2],
) -> (Trial<2>, Stencils<2>, Vec<[f64; 2]>) {
    let grid = grid();
    let particles = body(&grid);
    let constraints = Constraints::free(&grid);
    let loads = StepLoads::gravity([0.0, -3.0]);
    let conditions = StepConditions::new(grid.clone(), constraints, loads, vec![law]).unwrap();
    let stencils = Stencils::build(&particles, method, &conditions).unwrap();
    let system = System::new(&particles, &stencils, &conditions, method).unwrap();
    let u: Vec<[f64; 2]> = (0..system.node_count())
        .map(|node| system.node_position(node))
        .map(|[r, z]| [a * r, b * z])
        .collect();
    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
    let f_ext = system.f_ext().to_vec();
    (trial, stencils, f_ext)
}

// GOAL: particles stay at the places that a uniform stretch carries them to, also beside the axis, by every variant.
// ORACLE: the displacement of a place is (a r, b z), and r over what it was is the stretch around the axis. By the centroid of its
// volume a particle beside the axis went a third too far.
#[test]
fn places_move_with_the_stretch() {
    let [a, b] = [0.03, -0.02];
    let soil = MohrCoulomb::new(Elasticity::new(100.0, 0.3).unwrap(), 1e3, 0.4, 0.1).unwrap();
    let laws: [SharedLaw; 2] = [elastic(), Arc::new(soil)];
    for (law, method) in laws
        .iter()
        .flat_map(|law| methods().into_iter().map(move |m| (law, m)))
    {
        let grid = grid();
        let mut particles = body(&grid);
        let (trial, stencils, _) = trial(&method, law.clone(), [a, b]);
        let u: Vec<[f64; 2]> = (0..grid.node_count())
            .map(|node| grid.node_position(node))
            .map(|[r, z]| [a * r, b * z])
            .collect();
        let before = particles.clone();
        particles.commit(&stencils, &method, &trial, &u);
        for (p, &[r, z]) in before.x.iter().enumerate() {
            let [by_r, by_z] = particles.displacement[p];
            assert!(
                (by_r - a * r).abs() < 1e-13,
                "{}: {by_r} at {r}",
                method.label()
            );
            assert!(
                (by_z - b * z).abs() < 1e-13,
                "{}: {by_z} at {z}",
                method.label()
            );
            if method.geometry == Geometry::Moving {
                let around = 1.0 + particles.hoop_strain[p];
                assert!((particles.x[p][0] / r - around).abs() < 1e-13);
            }
        }
    }
}

// GOAL: a uniform stretch is uniform at every particle, by every variant, on either geometry.
// ORACLE: F = diag(1 + a, 1 + b, 1 + a).
#[test]
fn a_uniform_stretch_is_exact() {
    let [a, b] = [0.03, -0.02];
    let soil = MohrCoulomb::new(Elasticity::new(100.0, 0.3).unwrap(), 1e3, 0.4, 0.1).unwrap();
    for law in [elastic(), Arc::new(soil)] {
        for method in methods() {
            let (trial, stencils, _) = trial(&method, law.clone(), [a, b]);
            let expected = match method.geometry {
                Geometry::Moving => [a.ln_1p(), b.ln_1p(), a.ln_1p()],
                Geometry::Given => [a, b, a],
            };
            for point in by_particle(&trial, &stencils) {
                let mut strains = point.eps_e;
                let mut expected = expected;
                strains.sort_by(f64::total_cmp);
                expected.sort_by(f64::total_cmp);
                for (strain, expected) in std::iter::zip(strains, expected) {
                    assert!(
                        (strain - expected).abs() < 1e-14,
                        "{}: {strain}",
                        method.label()
                    );
                }
            }
        }
    }
}

// GOAL: uniform pressure is in equilibrium within the body, whose particles fill their cells.
// ORACLE: no force on nodes within; the force of the pressure on the outer face, 2πR H p, and on the top, πR² p, in sum.
#[test]
fn uniform_pressure_is_in_equilibrium() {
    let stretch = 0.02;
    let grid = grid();
    for method in methods() {
        if method.basis.name() == "linear" {
            continue;
        }
        let (trial, stencils, _) = trial(&method, elastic(), [stretch, stretch]);
        let sigma = by_particle(&trial, &stencils)[0].tau[0][0];
        let (p, [radius, height]) = match method.geometry {
            Geometry::Moving => (
                sigma * (1.0_f64 + stretch).powi(-3),
                [2.9, 2.0].map(|x| x * (1.0 + stretch)),
            ),
            Geometry::Given => (sigma, [2.9, 2.0]),
        };
        let mut sums = [0.0; 2];
        for (node, f_int) in trial.f_int.iter().enumerate() {
            let place = grid.node_place(node);
            if place[0] < 3 && place[0] > 0 {
                assert!(
                    f_int[0].abs() < 1e-12 * p * radius * radius,
                    "{} {place:?} {f_int:?}",
                    method.label()
                );
            }
            if place[0] == 3 {
                sums[0] += f_int[0];
            }
            if place[1] == 2 {
                sums[1] += f_int[1];
            } else if place[1] == 1 {
                assert!(
                    f_int[1].abs() < 1e-12 * p * radius * radius,
                    "{} {place:?} {f_int:?}",
                    method.label()
                );
            }
        }
        let expected = [2.0 * PI * radius * height * p, PI * radius * radius * p];
        for (sum, expected) in std::iter::zip(sums, expected) {
            assert!(
                (sum - expected).abs() < 1e-12 * expected,
                "{}: {sums:?} {expected}",
                method.label()
            );
        }
    }
}

// GOAL: nodes take the weight of the rings around them.
// ORACLE: ∫ N_i 2πr dr of the hat functions, by the exact integral over each cell: r_c h/2 ± h²/12.
#[test]
fn weight_is_that_of_rings() {
    let grid = grid();
    for method in methods() {
        if method.basis.name() == "linear" {
            continue;
        }
        let (.., f_ext) = trial(&method, elastic(), [0.0; 2]);
        let nodes = grid.axes[0].nodes();
        for k in 0..4 {
            let mut ring = 0.0;
            if k < 3 {
                let h = nodes[k + 1] - nodes[k];
                ring += 0.5 * (nodes[k] + nodes[k + 1]) * h / 2.0 - h * h / 12.0;
            }
            if k > 0 {
                let h = nodes[k] - nodes[k - 1];
                ring += 0.5 * (nodes[k] + nodes[k - 1]) * h / 2.0 + h * h / 12.0;
            }
            let column: f64 = (0..3).map(|row| f_ext[grid.node_index([k, row])][1]).sum();
            let expected = -3.0 * 2.0 * 2.0 * 2.0 * PI * ring;
            assert!(
                (column - expected).abs() < 1e-12 * expected.abs(),
                "{}: {column} {expected}",
                method.label()
            );
        }
    }
}
