//! GOAL: input without sense is refused with a message that names the field or the particle.

use crate::common::{Random, conditions, grid, laws, particles};
use igimp_assembly::{
    AssemblyError, Constraints, LoadPoint, Method, ParticleSeed, Particles, Stencils,
    StepConditions, StepLoads, Structures, System,
};
use igimp_material::TangentKind;

const SEED: ParticleSeed<2> = ParticleSeed {
    x: [1.5, 1.5],
    half_length: [0.25; 2],
    volume: 0.25,
    density: 1.0,
    law: 0,
    centroid: [0.0; _],
};

#[test]
fn an_empty_body() {
    let error = Particles::<2>::new(&[]).unwrap_err();
    assert_eq!(error.to_string(), "the body is empty: it holds no particle");
}

#[test]
fn a_particle_without_volume() {
    let error = Particles::new(&[
        SEED,
        ParticleSeed {
            volume: -1.0,
            ..SEED
        },
    ])
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "particle 1: volume is -1, but must be positive and finite"
    );
}

#[test]
fn a_particle_off_the_grid_is_named() {
    let grid = grid::<2>(4);
    let body = Particles::new(&[
        SEED,
        ParticleSeed {
            x: [1.5, 99.0],
            ..SEED
        },
    ])
    .unwrap();
    let conditions = conditions(&grid, &laws()[0].1);
    let error = Stencils::build(&body, &Method::default(), &conditions).unwrap_err();
    assert!(matches!(error, AssemblyError::Shape { particle: 1, .. }));
    assert_eq!(
        error.to_string(),
        "particle 1 at [1.5, 99.0, 0.0] m has no place on the background grid"
    );
}

#[test]
fn an_unknown_law() {
    let grid = grid::<2>(4);
    let body = Particles::new(&[ParticleSeed { law: 3, ..SEED }]).unwrap();
    let method = Method::default();
    let conditions = conditions(&grid, &laws()[0].1);
    let error = Stencils::build(&body, &method, &conditions).unwrap_err();
    assert_eq!(
        error.to_string(),
        "particle 0 uses law 3, but there are 1 laws (numbered from 0)"
    );
}

#[test]
fn a_constraint_on_a_node_that_is_not_there() {
    let mut constraints = Constraints::free(&grid::<2>(2));
    assert_eq!(
        constraints.prescribe(9, 0, 0.0).unwrap_err().to_string(),
        "a constraint names node 9, but the grid has 9 nodes (numbered from 0)"
    );
    assert!(constraints.prescribe(3, 0, f64::NAN).is_err());
}

#[test]
fn everything_fixed() {
    let grid = grid::<2>(4);
    let body = Particles::new(&[SEED]).unwrap();
    let method = Method::default();
    let mut conditions = conditions(&grid, &laws()[0].1);
    let stencils = Stencils::build(&body, &method, &conditions).unwrap();
    for node in 0..grid.node_count() {
        for axis in 0..2 {
            conditions.constraints.prescribe(node, axis, 0.0).unwrap();
        }
    }
    let error = System::new(&body, &stencils, &conditions, &method).unwrap_err();
    assert_eq!(error, AssemblyError::NoUnknowns);
}

#[test]
fn conditions_that_are_not_finite() {
    let step = conditions(&grid::<2>(4), &laws()[0].1);
    let stated = |spoil: fn(&mut StepLoads<2>)| {
        let mut loads = step.loads.clone();
        spoil(&mut loads);
        StepConditions::new(
            step.grid.clone(),
            step.constraints.clone(),
            loads,
            step.laws.clone(),
        )
        .unwrap_err()
    };
    let refused = |quantity, index| AssemblyError::NonFinite { quantity, index };
    assert_eq!(
        stated(|loads| loads.gravity[1] = f64::NAN),
        refused("gravity", 1)
    );
    assert_eq!(
        stated(|loads| loads.factors = vec![1.0, f64::INFINITY]),
        refused("load factor", 1)
    );
    assert_eq!(stated(|loads| loads.drag = f64::NAN), refused("drag", 0));
}

/// Constraints of a smaller and of a larger grid, and of one with as many nodes in other rows.
#[test]
fn constraints_of_another_grid_or_axis() {
    let uniform = |cells: [usize; 2]| {
        let axes = cells.map(|cells| igimp_shape::Axis::uniform(0.0, 1.0, cells).unwrap());
        igimp_shape::Grid::new(axes)
    };
    let grid = uniform([5, 3]);
    let body = Particles::new(&[SEED]).unwrap();
    let method = Method::default();
    for other in [[2, 2], [9, 9], [3, 5]] {
        let mut foreign = Constraints::free(&uniform(other));
        let expected = AssemblyError::OtherGrid {
            made_for: other.map(|cells| cells + 1).to_vec(),
            grid: vec![6, 4],
        };
        assert_eq!(foreign.fix_wall(&grid, 0, false, 0), Err(expected.clone()));
        assert_eq!(foreign, Constraints::free(&uniform(other)));
        let mut step = conditions(&grid, &laws()[0].1);
        let stated = StepConditions::new(
            grid.clone(),
            foreign.clone(),
            step.loads.clone(),
            step.laws.clone(),
        );
        assert_eq!(stated.unwrap_err(), expected);
        let mut other = step.clone();
        other.constraints = foreign.clone();
        let error = Stencils::build(&body, &method, &other).unwrap_err();
        assert_eq!(error, expected);
        let stencils = Stencils::build(&body, &method, &step).unwrap();
        step.constraints = foreign;
        let error = System::new(&body, &stencils, &step, &method).unwrap_err();
        assert_eq!(error, expected);
        assert!(error.to_string().contains("[6, 4]"), "{error}");
    }

    let mut free = Constraints::free(&grid);
    let unknown = |axis| Err(AssemblyError::UnknownAxis { axis, axes: 2 });
    assert_eq!(free.fix_wall(&grid, 2, false, 0), unknown(2));
    assert_eq!(free.fix_wall(&grid, 0, true, 3), unknown(3));
    assert_eq!(free.prescribe(0, 2, 0.0), unknown(2));
    let node = AssemblyError::UnknownNode {
        node: 24,
        nodes: 24,
    };
    assert_eq!(free.prescribe(24, 0, 0.0), Err(node));
    assert_eq!(free, Constraints::free(&grid));
    assert_eq!((free.of(24, 0), free.of(0, 2)), (None, None));
}

#[test]
fn a_load_on_empty_cells() {
    let grid = grid::<2>(6);
    let body = Particles::new(&[SEED]).unwrap();
    let method = Method::default();
    let mut conditions = conditions(&grid, &laws()[0].1);
    conditions.loads.factors = vec![1.0];
    let stencils = Stencils::build(&body, &method, &conditions).unwrap();
    let point = LoadPoint {
        x: [5.5, 5.5],
        force: [1.0, 0.0],
        load: 0,
    };
    let error = System::with_structures(
        &body,
        &Structures {
            points: &[point],
            ..Structures::default()
        },
        &stencils,
        &conditions,
        &method,
    )
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "load point 0 at [5.5, 5.5, 0.0] m acts on a part of the grid that holds no soil"
    );
}

#[test]
fn a_displacement_that_turns_a_particle_inside_out_or_is_not_a_number() {
    let grid = grid::<2>(5);
    let body = particles(&grid, 0.0, &mut Random(1));
    let method = Method::default();
    for (_, law) in laws() {
        let conditions = conditions(&grid, &law);
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        let folded: Vec<[f64; 2]> = (0..grid.node_count())
            .map(|node| [-2.0 * grid.node_position(node)[0], 0.0])
            .collect();
        let error = system
            .evaluate(&folded, TangentKind::Consistent)
            .unwrap_err();
        assert!(
            matches!(error, AssemblyError::Inverted { particle: 0, .. }),
            "{error}"
        );
        let mut poisoned = vec![[0.0; 2]; grid.node_count()];
        poisoned[grid.node_index([2, 2])][1] = f64::NAN;
        assert!(system.evaluate(&poisoned, TangentKind::Consistent).is_err());
    }
}

/// An edge load keeps its resultant and its moment.
#[test]
fn an_edge_load_keeps_resultant_and_moment() {
    let grid = grid::<2>(6);
    let body = particles(&grid, 0.0, &mut Random(1));
    let method = Method::default();
    let mut conditions = conditions(&grid, &laws()[0].1);
    let stencils = Stencils::build(&body, &method, &conditions).unwrap();
    conditions.loads.gravity = [0.0; 2];
    conditions.loads.factors = vec![2.0];
    let points = LoadPoint::along_edge([1.3, 4.1], [4.4, 3.7], [3.0, -5.0], 11, 0);
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
    let length = 3.1_f64.hypot(0.4);
    let (mut force, mut moment) = ([0.0; 2], 0.0);
    for (node, f) in system.f_ext().iter().enumerate() {
        let x = grid.node_position(node);
        force[0] += f[0];
        force[1] += f[1];
        moment += x[0] * f[1] - x[1] * f[0];
    }
    let expected = [6.0 * length, -10.0 * length];
    assert!((force[0] - expected[0]).abs() < 1e-12 * length);
    assert!((force[1] - expected[1]).abs() < 1e-12 * length);
    let lever = 2.85 * expected[1] - 3.9 * expected[0];
    assert!((moment - lever).abs() < 1e-10);
}

/// GOAL: a determinant is printed with four digits. ORACLE: by hand.
#[test]
fn determinants_have_four_digits() {
    let error = AssemblyError::Inverted {
        particle: 8072,
        determinant: -0.204_181_711_961_970_46,
    };
    let text = error.to_string();
    assert!(
        text.contains("increment is -2.042e-1, but must be positive"),
        "{text}"
    );
}
