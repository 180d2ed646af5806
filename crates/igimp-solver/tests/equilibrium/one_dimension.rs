//! GOAL: in one dimension space is a column of soil that cannot strain sideways, for every law.
//! BODY: columns of two particles per unit cell, and the same between smooth walls in plane strain.
//! ORACLE: the plane column; the exact column at large strain (τ = E ln λ without lateral strain, and
//! so λ = W(s)/s with Lambert's function of the load s above).

use std::sync::Arc;

use crate::body_support::{YOUNG, block, conditions, laws, solve, unit_grid, workspace};
use igimp_assembly::{
    Constraints, Kinematics, Method, ParticleSeed, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Body, NewtonSettings, step};

const CELLS: usize = 8;

const TIGHT: NewtonSettings = NewtonSettings {
    tolerance: 1e-12,
    max_iterations: 50,
    divergence: 1e6,
};

/// A column of two particles in each of `cells` cells.
fn column(cells: usize) -> (Body<1>, Grid<1>) {
    let grid = Grid::new([Axis::uniform(0.0, 1.0, cells).unwrap()]);
    let seeds: Vec<_> = (0..2 * cells)
        .map(|k| ParticleSeed {
            x: [0.25 + 0.5 * k as f64],
            half_length: [0.25],
            volume: 0.5,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect();
    (Body::new(Particles::new(&seeds).unwrap()), grid)
}

/// The column under its own weight; its new state.
fn settled(law: &SharedLaw, method: &Method, cells: usize, gravity: f64) -> Body<1> {
    let (mut body, grid) = column(cells);
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0).unwrap();
    let conditions = StepConditions::new(
        grid,
        constraints,
        StepLoads::gravity([-gravity]),
        vec![Arc::clone(law)],
    )
    .unwrap();
    let (from_to, mut workspace) = ((0.0, 1.0), workspace());
    step(
        &mut body,
        method,
        &conditions,
        from_to,
        &TIGHT,
        &mut workspace,
    )
    .unwrap();
    body
}

#[test]
fn a_line_is_a_plane_between_smooth_walls() {
    let mut plastic = 0;
    for (name, law) in laws() {
        for kinematics in [Kinematics::FiniteStrain, Kinematics::SmallStrain] {
            for method in [Method::impm_bbar(), Method::igimp(), Method::igimp_bbar()] {
                let method = Method {
                    kinematics,
                    ..method
                };
                let line = settled(&law, &method, CELLS, 0.9).particles;
                let grid = unit_grid([1, CELLS]);
                let mut plane = block(&grid, [0, 0], [1, CELLS]);
                let mut walls = Constraints::free(&grid);
                for (normal, upper) in [(0, false), (0, true), (1, false)] {
                    walls.fix_wall(&grid, normal, upper, normal).unwrap();
                }
                let weight = conditions(&grid, &walls, &law, 0.9);
                solve(&mut plane, &method, &weight, &TIGHT).unwrap();
                let plane = plane.particles;
                let label = format!("{name}, {}, {kinematics:?}", method.label());
                for p in 0..line.len() {
                    // Two of the four particles of a cell stand above each other.
                    let twin = 4 * (p / 2) + 2 * (p % 2);
                    let (x, y) = (line.x[p][0], plane.x[twin][1]);
                    assert!((x - y).abs() < 1e-9, "{label}: {p} {x} {y}");
                    let (of_line, other) = (line.sigma[p], plane.sigma[twin]);
                    for (a, b) in [(of_line[0][0], other[1][1]), (of_line[2][2], other[2][2])] {
                        assert!((a - b).abs() < 1e-7, "{label}: {p} {a} {b}");
                    }
                    assert_eq!(line.regime[p], plane.regime[twin], "{label}");
                    plastic += usize::from(line.regime[p].is_plastic());
                }
            }
        }
    }
    assert!(plastic > 100);
}

/// At ρ₀ g l₀ / E = 2 the column stands at (w + w²/2)/2 of its height, w = W(2).
#[test]
fn a_line_at_large_strain_is_exact() {
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, 0.0).unwrap()));
    let w: f64 = 0.852_605_502_013_725_4;
    let errors = [16, 64].map(|cells| {
        let height = cells as f64;
        let body = settled(&law, &Method::default(), cells, 2.0 * YOUNG / height).particles;
        let last = body.len() - 1;
        let top = (body.x[last][0] + body.half_length[last][0]) / height;
        (top / (0.5 * (w + 0.5 * w * w)) - 1.0).abs()
    });
    assert!(
        errors[0] < 0.01 && errors[1] < 0.3 * errors[0],
        "{errors:?}"
    );
}
