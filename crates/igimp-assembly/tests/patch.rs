//! GOAL: a uniform deformation gradient is reproduced exactly, and leaves interior nodes in
//! balance.
//! BODY: a regular lattice of particles that tiles its cells; all nodes that see its edge move by
//! u = (F − I) x.
//! ORACLE: the law itself at that F, and the divergence theorem.

mod common;

use common::{Random, conditions, grid, laws, methods, particles};
use igimp_assembly::{Stencils, System};
use igimp_material::{TangentKind, lift_finite, lift_small};
use igimp_shape::{Axis, Grid};

fn uniform<const D: usize>(cells: usize) -> Grid<D> {
    Grid::new(std::array::from_fn(|axis| {
        Axis::uniform(-0.3, 0.5 + 0.1 * axis as f64, cells).unwrap()
    }))
}

/// A deformation increment with stretch and shear.
fn increment<const D: usize>() -> [[f64; D]; D] {
    let full = [
        [1.04, 0.02, -0.01],
        [-0.03, 0.97, 0.015],
        [0.01, 0.025, 1.02],
    ];
    std::array::from_fn(|a| std::array::from_fn(|b| full[a][b]))
}

fn affine<const D: usize>(grid: &Grid<D>, f: &[[f64; D]; D]) -> Vec<[f64; D]> {
    (0..grid.node_count())
        .map(|node| {
            let x = grid.node_position(node);
            std::array::from_fn(|a| (0..D).map(|b| f[a][b] * x[b]).sum::<f64>() - x[a])
        })
        .collect()
}

fn uniform_gradient_is_exact<const D: usize>(cells: usize) {
    let grid = uniform::<D>(cells);
    let f = increment::<D>();
    for (name, law) in laws() {
        for method in methods() {
            let label = format!("{name}, {}, {:?}, {D}D", method.label(), method.kinematics);
            let body = particles(&grid, 0.0, &mut Random(1));
            let conditions = conditions(&grid, &law);
            let stencils = Stencils::build(&body, &method, &conditions).unwrap();
            let system = System::new(&body, &stencils, &conditions, &method).unwrap();
            let u = affine(&grid, &f);
            let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();

            let mut b = [[0.0; 3]; 3];
            let mut strain = [[0.0; 3]; 3];
            for a in 0..3 {
                b[a][a] = 1.0;
                for c in 0..3 {
                    if a < D && c < D {
                        b[a][c] = (0..D).map(|k| f[a][k] * f[c][k]).sum();
                        strain[a][c] = 0.5 * (f[a][c] + f[c][a]) - f64::from(u8::from(a == c));
                    }
                }
            }
            let history = body.history(0);
            let exact = match method.kinematics {
                igimp_assembly::Kinematics::FiniteStrain => {
                    lift_finite::<D>(&*law, &b, &history, TangentKind::Consistent)
                }
                igimp_assembly::Kinematics::SmallStrain => {
                    lift_small::<D>(&*law, &strain, &history, TangentKind::Consistent)
                }
            }
            .unwrap();
            for own in &trial.particles {
                for a in 0..3 {
                    for c in 0..3 {
                        let difference = own.tau[a][c] - exact.tau[a][c];
                        assert!(
                            difference.abs() < 1e-11,
                            "{label}: stress off by {difference:e}"
                        );
                    }
                }
            }
            let scale = trial
                .f_int
                .iter()
                .flatten()
                .fold(0.0, |m: f64, v| m.max(v.abs()));
            for node in 0..grid.node_count() {
                let place = grid.node_place(node);
                // Particles fill all cells but the outer ones.
                if place.iter().all(|&k| (3..=cells - 3).contains(&k)) {
                    for axis in 0..D {
                        let force = trial.f_int[node][axis];
                        assert!(
                            force.abs() < 1e-12 * scale,
                            "{label}: out of balance {force:e}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn uniform_gradient_is_exact_in_two_dimensions() {
    uniform_gradient_is_exact::<2>(8);
}

#[test]
fn uniform_gradient_is_exact_in_three_dimensions() {
    uniform_gradient_is_exact::<3>(7);
}

/// A rotation by 90° in one step turns the stress and changes nothing else. Small cuts are left
/// alone here: a tied node follows its neighbour's translation, not a rotation about it.
fn rotation_rotates_stress<const D: usize>(cells: usize) {
    let mut random = Random(5);
    for (name, law) in laws() {
        for mut method in methods() {
            method.small_cuts.below = 0.0;
            if method.kinematics == igimp_assembly::Kinematics::SmallStrain {
                continue;
            }
            let label = format!("{name}, {}, {D}D", method.label());
            let grid = grid::<D>(cells);
            let mut body = particles(&grid, 1.0, &mut random);
            let conditions = conditions(&grid, &law);
            let strain = common::displacements(&grid, 0.05, &mut random);
            let stencils = Stencils::build(&body, &method, &conditions).unwrap();
            let system = System::new(&body, &stencils, &conditions, &method).unwrap();
            let trial = system.evaluate(&strain, TangentKind::Consistent).unwrap();
            body.commit(&stencils, &method, &trial, &strain);
            let before = body.clone();

            let mut turn = [[0.0; D]; D];
            for a in 2..D {
                turn[a][a] = 1.0;
            }
            turn[0][1] = -1.0;
            turn[1][0] = 1.0;
            let u = affine(&grid, &turn);
            let stencils = Stencils::build(&body, &method, &conditions).unwrap();
            let system = System::new(&body, &stencils, &conditions, &method).unwrap();
            let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
            body.commit(&stencils, &method, &trial, &u);
            for particle in 0..body.len() {
                let (old, new) = (&before.sigma[particle], &body.sigma[particle]);
                let expected = [
                    [old[1][1], -old[1][0], -old[1][2]],
                    [-old[0][1], old[0][0], old[0][2]],
                    [-old[2][1], old[2][0], old[2][2]],
                ];
                for a in 0..3 {
                    for c in 0..3 {
                        let difference = new[a][c] - expected[a][c];
                        assert!(difference.abs() < 1e-11, "{label}: {difference:e}");
                    }
                }
                let volume = body.volume(particle) / before.volume(particle);
                assert!((volume - 1.0).abs() < 1e-13, "{label}");
                let plastic = body.eps_p_eq[particle] - before.eps_p_eq[particle];
                assert!(plastic.abs() < 1e-12, "{label}: plastic strain {plastic:e}");
                let (old, new) = (before.half_length[particle], body.half_length[particle]);
                for axis in 0..D {
                    assert!((old[axis] - new[axis]).abs() < 1e-12, "{label}");
                }
            }
        }
    }
}

#[test]
fn rotation_rotates_stress_in_two_dimensions() {
    rotation_rotates_stress::<2>(5);
}

#[test]
fn rotation_rotates_stress_in_three_dimensions() {
    rotation_rotates_stress::<3>(4);
}
