//! GOAL: a uniform deformation gradient is reproduced exactly, and leaves interior nodes in
//! balance.
//! BODY: a regular lattice of particles that tiles its cells; all nodes that see its edge move by
//! u = (F − I) x.
//! ORACLE: the law itself at that F, and the divergence theorem; that of tractions on the faces of a body too.

use crate::common::{Random, conditions, grid, laws, methods, particles};
use igimp_assembly::{
    AssemblyError, Constraints, Geometry, Kinematics, LoadPoint, Method, ParticleSeed, Particles,
    SharedLaw, Stencils, StepLoads, Structures, System,
};
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
            for point in &trial.particles {
                for a in 0..3 {
                    for c in 0..3 {
                        let difference = point.tau[a][c] - exact.tau[a][c];
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
            let strain = crate::common::displacements(&grid, 0.05, &mut random);
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

/// The lower and upper ends of parts of half a cell from 1 on, and of what is left before `end`.
fn parts_until(end: f64) -> Vec<[f64; 2]> {
    let halves = (0..).map(|half| 1.0 + 0.5 * f64::from(half));
    halves
        .take_while(|from| *from < end)
        .map(|from| [from, (from + 0.5).min(end)])
        .collect()
}

/// Points of equal force a tenth of a cell apart on the sides of a rectangle from (1, 1), under the uniform stress `tau`.
fn pressed_rectangle(to: [f64; 2], tau: &[[f64; 3]; 3]) -> Vec<LoadPoint<2>> {
    let side = |from: [f64; 2], to: [f64; 2], normal: [f64; 2]| {
        let traction = std::array::from_fn(|a| tau[a][0] * normal[0] + tau[a][1] * normal[1]);
        let length = (to[0] - from[0]).abs() + (to[1] - from[1]).abs();
        LoadPoint::along_edge(from, to, traction, (10.0 * length).round() as usize, 0)
    };
    [
        side([1.0, 1.0], [to[0], 1.0], [0.0, -1.0]),
        side([1.0, to[1]], to, [0.0, 1.0]),
        side([1.0, 1.0], [1.0, to[1]], [-1.0, 0.0]),
        side([to[0], 1.0], to, [1.0, 0.0]),
    ]
    .concat()
}

/// A rectangle from (1, 1) of particles that are boxes, half a cell wide or what is left of one.
fn rectangle(to: [f64; 2]) -> Particles<2> {
    let mut seeds = Vec::new();
    for [bottom, top] in parts_until(to[1]) {
        for [left, right] in parts_until(to[0]) {
            let half_length = [0.5 * (right - left), 0.5 * (top - bottom)];
            seeds.push(ParticleSeed {
                x: [0.5 * (left + right), 0.5 * (bottom + top)],
                half_length,
                volume: 4.0 * half_length[0] * half_length[1],
                density: 2.0,
                law: 0,
                centroid: [0.0; 2],
            });
        }
    }
    Particles::new(&seeds).unwrap()
}

/// A rectangle under tractions on its sides is in balance with the uniform stress that has them, wherever in a cell its sides lie:
/// the soil of a loaded cell acts on its nodes as its mean does. Corners that are slivers are left out.
#[test]
fn tractions_on_faces_anywhere_in_a_cell_balance_uniform_stress() {
    let grid = Grid::new([(); 2].map(|()| Axis::uniform(0.0, 1.0, 6).unwrap()));
    let ends = [0.0, 0.2, 0.3, 0.5, 0.7, 0.9].map(|share| 3.0 + share);
    let small = |method: &Method| method.kinematics == Kinematics::SmallStrain;
    let on = |geometry| move |method: Method| Method { geometry, ..method };
    for method in methods().into_iter().filter(small) {
        for method in
            [Geometry::Moving, Geometry::Given].map(|geometry| on(geometry)(method.clone()))
        {
            for to in ends.iter().flat_map(|&right| ends.map(|top| [right, top])) {
                for (name, law) in laws() {
                    let left = out_of_balance_under_tractions(&grid, to, &law, &method);
                    let geometry = method.geometry;
                    assert!(
                        left < 1e-11,
                        "{name}, {}, {geometry:?}, {to:?}: {left}",
                        method.label()
                    );
                }
            }
        }
    }
}

/// The largest nodal force out of balance of a rectangle under the tractions of its stress, over that stress \[-\].
fn out_of_balance_under_tractions(
    grid: &Grid<2>,
    to: [f64; 2],
    law: &SharedLaw,
    method: &Method,
) -> f64 {
    let body = rectangle(to);
    let mut conditions = conditions(grid, law);
    conditions.constraints = Constraints::free(grid);
    conditions.loads = StepLoads::gravity([0.0; 2]);
    conditions.loads.factors = vec![1.0];
    let points = pressed_rectangle(to, &[[0.0; 3]; 3]);
    let stencils = Stencils::build_under(&body, method, &conditions, &points).unwrap();
    let system = System::new(&body, &stencils, &conditions, method).unwrap();
    let u = affine(grid, &[[1.002, 0.001], [0.001, 0.999]]);
    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
    let tau = trial.particles[0].tau;
    let points = pressed_rectangle(to, &tau);
    let structures = Structures {
        points: &points,
        ..Structures::default()
    };
    let system =
        System::with_structures(&body, &structures, &stencils, &conditions, method).unwrap();
    let left = system.out_of_balance(&trial).unwrap().force;
    let largest = |values: &mut dyn Iterator<Item = f64>| {
        values.fold(0.0, |most: f64, value| most.max(value.abs()))
    };
    largest(&mut left.into_iter()) / largest(&mut tau.into_iter().flatten())
}

/// Points beyond the last cell that holds soil act on its face, up to a quarter of a cell away, and are lost further out.
#[test]
fn points_that_left_their_soil_by_a_little_act_on_its_face() {
    let grid = Grid::new([(); 2].map(|()| Axis::uniform(0.0, 1.0, 6).unwrap()));
    let body = rectangle([4.0, 4.0]);
    let (_, law) = laws().swap_remove(0);
    let mut conditions = conditions(&grid, &law);
    conditions.constraints = Constraints::free(&grid);
    conditions.loads.factors = vec![1.0];
    let method = Method::shared_strain();
    let under = |beyond: f64| {
        let x = 4.0 + beyond;
        let points = LoadPoint::along_edge([x, 1.0], [x, 4.0], [-3.0, 1.0], 12, 0);
        let stencils = Stencils::build_under(&body, &method, &conditions, &points).unwrap();
        let structures = Structures {
            points: &points,
            ..Structures::default()
        };
        let system = System::with_structures(&body, &structures, &stencils, &conditions, &method)?;
        let forces = system.f_ext().to_vec();
        let u = vec![[0.5, 0.0]; grid.node_count()];
        Ok::<_, AssemblyError>((forces, points[0].carried(&grid, &stencils, 0, &u)?.x[0]))
    };
    let (on_face, _) = under(0.0).unwrap();
    for beyond in [1e-12, 0.003, 0.249] {
        let (forces, x) = under(beyond).unwrap();
        assert_eq!(forces, on_face, "{beyond}");
        assert!((x - 4.5).abs() < 1e-15, "{beyond}: {x}");
    }
    let lost = under(0.26).unwrap_err();
    assert!(
        matches!(lost, AssemblyError::UnsupportedLoad { .. }),
        "{lost}"
    );
}
