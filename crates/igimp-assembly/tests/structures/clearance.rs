//! GOAL: no particle gets into a rigid body: those that come too close are put back, a step that carries
//! one into a body or through it is refused, wherever the particle stood before.
//! BODY: a block of 12 × 3 unit cells with 2 particles per direction, below a body, lifted as a whole.
//! ORACLE: distances by hand.

use crate::common::laws;
use igimp_assembly::{
    AcceptedContact, Constraints, Geometry, Interface, Method, ParticleSeed, Particles,
    Penetration, RigidBody, RigidMotion, Stencils, StepConditions, StepLoads, Structures, Surface,
    System, TimeScheme, TimeStep,
};
use igimp_shape::{Axis, Grid};

/// The half-length of all particles \[length\].
const HALF: f64 = 0.25;

fn particles(centres: impl Iterator<Item = [f64; 2]>) -> Particles<2> {
    let seeds: Vec<_> = centres
        .map(|x| ParticleSeed {
            x,
            half_length: [HALF; 2],
            volume: 4.0 * HALF * HALF,
            density: 1.0,
            law: 0,
            centroid: [0.0; _],
        })
        .collect();
    Particles::new(&seeds).unwrap()
}

fn body(corners: &[[f64; 2]]) -> RigidBody<2> {
    let surface = Surface::polygon(corners, 0.0, 1.0).unwrap();
    let sides = vec![Interface::smooth(); corners.len()];
    let mut body = RigidBody::new(surface, sides, [0.0; 2]);
    "anchor".clone_into(&mut body.name);
    body
}

/// The result of a step over some time that lifts the soil by so much below a body whose lower side is at this height.
fn lifted(
    base: f64,
    by: f64,
    time: Option<TimeStep>,
    geometry: Geometry,
) -> Result<AcceptedContact<2>, Penetration> {
    let grid = Grid::new([12, 10].map(|cells| Axis::uniform(0.0, 1.0, cells).unwrap()));
    let places = (0..24 * 6).map(|k| [k % 24, k / 24].map(|k| HALF + 2.0 * HALF * f64::from(k)));
    let soil = particles(places);
    let top = base + 2.0;
    let bodies = [body(&[
        [5.05, base],
        [7.05, base],
        [7.05, top],
        [5.05, top],
    ])];
    let (_, law) = laws().remove(0);
    let constraints = Constraints::free(&grid);
    let loads = StepLoads::gravity([0.0; 2]);
    let conditions = StepConditions::new(grid, constraints, loads, vec![law])
        .and_then(|conditions| conditions.with_motions(vec![RigidMotion::held()]))
        .and_then(|conditions| conditions.with_time(time))
        .unwrap();
    let method = Method {
        geometry,
        ..Method::igimp_bbar()
    };
    let stencils = Stencils::build(&soil, &method, &conditions).unwrap();
    let system = System::with_structures(
        &soil,
        &Structures {
            bodies: &bodies,
            ..Structures::default()
        },
        &stencils,
        &conditions,
        &method,
    )
    .unwrap();
    let mut u = vec![[0.0, by]; system.node_count()];
    let nodes = u.len();
    u[nodes - 2..].fill([0.0; 2]);
    system.bodies_at(&u)
}

#[test]
fn soil_that_jumps_into_a_body_is_caught() {
    // The upper row of particles begins at height 2.75, in sight of the body.
    let lifted = |by: f64, geometry: Geometry| lifted(3.2, by, None, geometry);
    assert!(lifted(0.2, Geometry::Moving).unwrap().push_out.is_empty());
    for by in [0.4, 0.6] {
        let push_out = lifted(by, Geometry::Moving).unwrap().push_out;
        assert_eq!(push_out.len(), 4, "{push_out:?}");
        for (_, way) in push_out {
            let height = 2.75 + by + way[1];
            assert!((height - (3.2 - 0.5 * HALF)).abs() < 1e-12 && way[0].abs() < 1e-12);
        }
    }
    // Into the body, and through it.
    for (by, least) in [(0.8, 1.4), (5.2, 0.8)] {
        match lifted(by, Geometry::Moving) {
            Err(Penetration {
                body,
                depth,
                position,
                ..
            }) => {
                assert_eq!(body, "anchor");
                assert!(depth > least - 1e-9, "{depth}");
                assert!(
                    (position[1] % 0.5 - (2.75 + by) % 0.5).abs() < 1e-9,
                    "{position:?}"
                );
            }
            other => panic!("{by}: {other:?}"),
        }
        // On a given geometry nothing goes anywhere.
        assert!(lifted(by, Geometry::Given).unwrap().push_out.is_empty());
    }
}

// GOAL: no soil comes up to a body that saw none as the step began: contact would have no part in it.
// CASE: the upper row, whose centres begin 1.25 below the body, five half-lengths off, in statics and in a step that takes time.
// ORACLE: a half-length, to which a step may bring it: its domain touches the body there.
#[test]
fn soil_out_of_sight_does_not_come_up_to_a_body() {
    let time = TimeStep {
        duration: 0.1,
        scheme: TimeScheme::Newmark,
        lumped: 0.0,
        is_first: true,
        must_resolve: true,
    };
    for time in [None, Some(time)] {
        let over = |by: f64| lifted(4.0, by, time, Geometry::Moving);
        for by in [0.9, 0.99] {
            assert!(over(by).unwrap().push_out.is_empty());
        }
        for by in [1.01, 1.2, 1.4] {
            let depth = over(by).unwrap_err().depth;
            assert!((depth - (by - 1.25) / HALF).abs() < 1e-9, "{by}: {depth}");
        }
    }
}

#[test]
fn soil_in_a_notch_is_moved_off_both_sides() {
    let notched = body(&[
        [0.0, 0.0],
        [6.0, 0.0],
        [6.0, 2.0],
        [2.0, 2.0],
        [2.0, 6.0],
        [0.0, 6.0],
    ]);
    let acute = body(&[[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [3.0, 1.0], [0.0, 6.0]]);
    for (body, x) in [(&notched, [2.05, 1.9]), (&acute, [3.03, 1.12])] {
        let mut soil = particles([x, [9.0, 9.0]].into_iter());
        assert_eq!(soil.resolve_overlap(std::slice::from_ref(body)), 1);
        let distance = body.distance(&soil.x[0]);
        assert!((distance - 0.5 * HALF).abs() < 1e-8, "{distance}");
        assert_eq!(soil.resolve_overlap(std::slice::from_ref(body)), 0);
    }
    // Beside any side, left and below too.
    let beside = 0.3 * HALF;
    for x in [[-beside, 3.0], [3.0, -beside], [6.0 + beside, 1.0]] {
        let mut soil = particles([x, [9.0, 9.0]].into_iter());
        assert_eq!(soil.resolve_overlap(std::slice::from_ref(&notched)), 1);
        let distance = notched.distance(&soil.x[0]);
        assert!((distance - 0.5 * HALF).abs() < 1e-8, "{distance}");
    }
    // Soil that stands deep in a body was not cut by its side when it was seeded.
    let mut deep = particles([[1.0, 1.0]].into_iter());
    assert_eq!(deep.resolve_overlap(&[notched]), 0);
}
