//! GOAL: a step that finds no equilibrium says why, names what is at fault, and changes nothing.
//! BODY: small blocks of 2 × 2 particles per unit cell that float, fall, leave their grid, collapse
//! or meet a law that cannot answer.
//! ORACLE: the failure that each of these must be; the bits of the body before.

use std::error::Error;
use std::sync::Arc;

use crate::body_support::{
    Poisoned, bits, block, conditions, confined, elastic, loaded, methods, solve, standing,
    unit_grid, von_mises,
};
use igimp_assembly::{AssemblyError, Constraints, LoadPoint, Method, SharedLaw, StepConditions};
use igimp_material::MaterialError;
use igimp_shape::Grid;
use igimp_solver::{Body, NewtonSettings, StepError, StepFailure};

/// Tries the step with every variant of the method: it must fail as `expected`, with a chain of
/// causes, and leave every bit of the body as it was.
fn fails(
    body: &Body<2>,
    conditions: &StepConditions<2>,
    settings: &NewtonSettings,
    expected: impl Fn(&StepFailure) -> bool,
) {
    for (label, method) in methods() {
        let mut tried = body.clone();
        let error = solve(&mut tried, &method, conditions, settings).unwrap_err();
        assert!(expected(&error.failure), "{label}: {:?}", error.failure);
        assert_eq!(bits(&tried), bits(body), "{label}");
        assert!(error.from == 0.0 && error.to > 0.99, "{label}");
        let tried_once = !error.residuals.is_empty();
        assert_eq!(error.worst.is_some(), tried_once, "{label}");
        assert!(chain(&error).len() >= 2, "{label}");
    }
}

/// The messages of an error and its causes.
fn chain(error: &StepError) -> Vec<String> {
    let mut messages = vec![error.to_string()];
    let mut cause = error.source();
    while let Some(next) = cause {
        messages.push(next.to_string());
        cause = next.source();
    }
    messages
}

fn settings() -> NewtonSettings {
    NewtonSettings::default()
}

fn grid() -> Grid<2> {
    unit_grid([6, 6])
}

fn floating() -> Body<2> {
    block(&grid(), [1, 1], [4, 4])
}

fn poisoned(tangent_alone: bool) -> SharedLaw {
    Arc::new(Poisoned {
        above: 0.02,
        tangent_alone,
    })
}

/// A body without any support, and one that a wall keeps from moving one way only: the failure tells a place of the body, and the
/// component that nothing holds.
#[test]
fn a_body_that_floats_or_falls_is_singular() {
    let singular = |failure: &StepFailure| matches!(failure, StepFailure::Singular { .. });
    let falls = |failure: &StepFailure| {
        let message = "in the displacement in y: nothing holds that node";
        singular(failure) && failure.to_string().ends_with(message)
    };
    let mut constraints = Constraints::free(&grid());
    let free = conditions(&grid(), &constraints, &elastic(), 0.3);
    fails(&floating(), &free, &settings(), singular);
    constraints.fix_wall(&grid(), 0, false, 0).unwrap();
    let beside_a_wall = conditions(&grid(), &constraints, &elastic(), 0.3);
    let falling = block(&grid(), [0, 1], [3, 4]);
    fails(&falling, &beside_a_wall, &settings(), falls);
}

#[test]
fn a_law_that_answers_nan_is_not_believed() {
    let (body, conditions) = loaded(&poisoned(false), 1.0);
    fails(&body, &conditions, &settings(), |failure| {
        matches!(
            failure,
            StepFailure::Assembly(AssemblyError::Material {
                source: MaterialError::NonFinite { quantity: "stress" },
                ..
            })
        )
    });
}

/// A tangent that is not a number is refused where it is used, and its particle named.
#[test]
fn a_tangent_that_is_not_a_number_is_refused() {
    let (mut body, conditions) = loaded(&poisoned(true), 1.0);
    let before = bits(&body);
    let error = solve(&mut body, &Method::default(), &conditions, &settings()).unwrap_err();
    assert!(
        matches!(
            *error.failure,
            StepFailure::Assembly(AssemblyError::Material {
                source: MaterialError::NonFinite {
                    quantity: "tangent"
                },
                ..
            })
        ),
        "{error:?}"
    );
    assert_eq!(bits(&body), before);
}

/// The law's failure names the particle that it failed at: the first of the lowest cell, which
/// alone is strained beyond the law's reach.
#[test]
fn a_stress_that_is_not_a_number_names_its_particle() {
    let grid = unit_grid([3, 4]);
    let law: SharedLaw = Arc::new(Poisoned {
        above: 0.012,
        tangent_alone: false,
    });
    let mut constraints = standing(&grid);
    constraints.fix_wall(&grid, 0, true, 0).unwrap();
    let mut body = block(&grid, [0, 0], [3, 3]);
    let conditions = conditions(&grid, &constraints, &law, 0.8);
    let error = solve(&mut body, &Method::igimp(), &conditions, &settings()).unwrap_err();
    assert_eq!(
        chain(&error),
        [
            "no equilibrium between load factors 0 and 1",
            "the equations could not be formed",
            "particle 0: the constitutive law failed",
            "the stress must be finite",
        ]
    );
}

/// A block lifted out of its grid: the first particle of its upper row is named, with the place it
/// would go to.
#[test]
fn a_particle_that_leaves_the_grid_is_named() {
    let mut constraints = Constraints::free(&grid());
    for column in 0..=6 {
        let node = grid().node_index([column, 1]);
        constraints.prescribe(node, 0, 0.0).unwrap();
        constraints.prescribe(node, 1, 2.5).unwrap();
    }
    let lifted = conditions(&grid(), &constraints, &elastic(), 0.0);
    let body = floating();
    let upper = |x: &[f64; 2]| x[1] > 3.5;
    let first = body.particles.x.iter().position(upper).unwrap();
    fails(&body, &lifted, &settings(), |failure| {
        matches!(
            failure,
            StepFailure::LeavesGrid { particle, position }
                if *particle == first
                    && (position[0] - 1.25).abs() < 1e-12
                    && (position[1] - 6.25).abs() < 1e-12
        )
    });
}

/// A load point on the upper side goes off the grid where no particle does; the points before it
/// stay where they were.
#[test]
fn a_load_point_that_would_leave_the_grid_stays() {
    let mut constraints = Constraints::free(&grid());
    for column in 0..=6 {
        let node = grid().node_index([column, 1]);
        constraints.prescribe(node, 0, 0.0).unwrap();
        constraints.prescribe(node, 1, 2.1).unwrap();
    }
    let lifted = conditions(&grid(), &constraints, &elastic(), 0.0);
    let mut body = floating();
    body.load_points = LoadPoint::along_edge([2.0, 2.0], [2.0, 5.0], [0.0, -1.0], 2, 0);
    body.load_points[1].x[1] = 4.0;
    fails(&body, &lifted, &settings(), |failure| {
        !failure.is_want_of_equilibrium()
            && matches!(
                failure,
                StepFailure::LoadPointLeavesGrid { point: 1, position }
                    if (position[0] - 2.0).abs() < 1e-12 && (position[1] - 6.1).abs() < 1e-12
            )
    });
}

/// A point that is off the grid from the start, and whose load does not act, is found out after
/// the iteration: the points before it have not moved then.
#[test]
fn a_load_point_off_the_grid_moves_no_other() {
    let (mut body, conditions) = loaded(&elastic(), 0.3);
    body.load_points = LoadPoint::along_edge([1.0, 2.0], [2.0, 2.0], [0.0, -1.0], 2, 0);
    body.load_points[1].x = [100.0, 2.0];
    fails(&body, &conditions, &settings(), |failure| {
        matches!(
            failure,
            StepFailure::Assembly(AssemblyError::LoadPoint { point: 1, .. })
        )
    });
}

#[test]
fn corrections_run_out() {
    let (body, conditions) = loaded(&von_mises(), 1.0);
    for max_iterations in [0, 1, 2] {
        let few = NewtonSettings {
            max_iterations,
            ..settings()
        };
        fails(&body, &conditions, &few, |failure| {
            *failure
                == StepFailure::MaxIterations {
                    iterations: max_iterations,
                }
        });
    }
}

/// A residual that grows beyond what the settings bear ends the step, though it would have come
/// down again.
#[test]
fn a_residual_that_grows_too_far_is_divergence() {
    let (body, conditions) = loaded(&von_mises(), 1.5);
    let strict = NewtonSettings {
        divergence: 1.0,
        ..settings()
    };
    let method = Method::default();
    let mut tried = body.clone();
    let error = solve(&mut tried, &method, &conditions, &strict).unwrap_err();
    assert_eq!(*error.failure, StepFailure::Diverged);
    let [.., before, last] = error.residuals[..] else {
        panic!("{error:?}");
    };
    assert!(last > before);
    assert_eq!(bits(&tried), bits(&body));
    solve(&mut tried, &method, &conditions, &settings()).unwrap();
}

/// Twice the weight that the block can carry has no equilibrium, and none is made up; a block
/// pressed to less than no height is inside out.
#[test]
fn collapse_and_folding_are_failures() {
    let (body, conditions) = loaded(&von_mises(), 5.0);
    fails(&body, &conditions, &settings(), |failure| {
        failure.is_want_of_equilibrium()
            && matches!(
                failure,
                StepFailure::Diverged
                    | StepFailure::Stagnated
                    | StepFailure::MaxIterations { .. }
                    | StepFailure::Assembly(AssemblyError::Inverted { .. })
            )
    });
    let (body, conditions) = confined(&elastic(), 4.1);
    fails(&body, &conditions, &settings(), |failure| {
        matches!(
            failure,
            StepFailure::Assembly(AssemblyError::Inverted { .. })
        )
    });
}

#[test]
fn equations_that_make_no_sense_are_refused() {
    let mut held = conditions(&grid(), &Constraints::free(&grid()), &elastic(), 0.3);
    for node in 0..grid().node_count() {
        for axis in 0..2 {
            held.constraints.prescribe(node, axis, 0.0).unwrap();
        }
    }
    fails(&floating(), &held, &settings(), |failure| {
        !failure.is_want_of_equilibrium()
            && *failure == StepFailure::Assembly(AssemblyError::NoUnknowns)
    });

    let (mut body, mut conditions) = loaded(&elastic(), 0.3);
    conditions.loads.factors = vec![1.0];
    body.load_points = LoadPoint::along_edge([5.5, 1.0], [6.5, 1.0], [0.0, -1.0], 2, 0);
    fails(&body, &conditions, &settings(), |failure| {
        matches!(
            failure,
            StepFailure::Assembly(AssemblyError::UnsupportedLoad { point: 0, .. })
        )
    });
}
