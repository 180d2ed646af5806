//! GOAL: an accepted step moves particles off a rigid body that stand too close to it.
//! BODY: a block without load below a held body whose base is a tenth above the centres of the upper row, 0.15 into their domains.
//! ORACLE: half of the seeded half-length of 0.25, to which each is moved back; nothing else is moved, and nothing is strained.

use std::sync::Arc;

use crate::body_support::{YOUNG, block, conditions, solve, unit_grid};
use igimp_assembly::{Constraints, Interface, Method, RigidBody, RigidMotion, SharedLaw, Surface};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_solver::NewtonSettings;

#[test]
fn a_step_moves_particles_off_a_rigid_body() {
    let grid = unit_grid([6, 5]);
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0).unwrap();
    constraints.fix_wall(&grid, 1, false, 1).unwrap();
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, 0.3).unwrap()));
    let conditions = conditions(&grid, &constraints, &law, 0.0)
        .with_motions(vec![RigidMotion::held()])
        .unwrap();
    let mut body = block(&grid, [0, 0], [4, 3]);
    let corners = [[-1.0, 2.85], [5.0, 2.85], [5.0, 4.0], [-1.0, 4.0]];
    let surface = Surface::polygon(&corners, 0.0, 1.0).unwrap();
    body.rigid = vec![RigidBody::new(
        surface,
        vec![Interface::smooth(); 4],
        [0.0; 2],
    )];
    let before = body.particles.x.clone();
    solve(
        &mut body,
        &Method::igimp_bbar(),
        &conditions,
        &NewtonSettings::default(),
    )
    .unwrap();
    let mut moved = 0;
    for (particle, (before, after)) in before.iter().zip(&body.particles.x).enumerate() {
        let expected = if before[1] > 2.5 {
            2.85 - 0.125
        } else {
            before[1]
        };
        moved += usize::from(before[1] > 2.5);
        assert!((after[1] - expected).abs() < 1e-12, "{before:?} {after:?}");
        assert!((after[0] - before[0]).abs() < 1e-12, "{before:?} {after:?}");
        assert!(
            body.particles.sigma[particle]
                .iter()
                .flatten()
                .all(|x| x.abs() < 1e-9)
        );
    }
    assert_eq!(moved, 8);
}
