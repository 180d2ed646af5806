//! GOAL: drag against motion balances what the soil cannot carry, and says how much that is.
//! BODY: a block of 2 × 2 particles per unit cell between smooth walls.
//! ORACLE: without support it moves as a rigid body by u = g/drag; on its base it comes to rest
//! with the same stresses as without drag.

use crate::body_support::{elastic, loaded, solve};
use igimp_assembly::{Constraints, Method};
use igimp_solver::NewtonSettings;

const GRAVITY: f64 = 0.1;

#[test]
fn a_block_without_support_moves_by_gravity_over_drag() {
    let (mut body, mut conditions) = loaded(&elastic(), GRAVITY);
    let grid = &conditions.grid;
    conditions.constraints = Constraints::free(grid);
    conditions.constraints.fix_wall(grid, 0, false, 0).unwrap();
    conditions.loads.drag = 2.0;
    let (settings, method) = (NewtonSettings::default(), Method::default());
    let before = body.particles.x.clone();
    let (report, _) = solve(&mut body, &method, &conditions, &settings).unwrap();
    assert!((report.drag_share - 1.0).abs() < 1e-9);
    for (x, before) in body.particles.x.iter().zip(&before) {
        assert!((x[1] - before[1] + GRAVITY / 2.0).abs() < 1e-9);
        assert!((x[0] - before[0]).abs() < 1e-9);
    }
}

#[test]
fn a_supported_block_comes_to_rest_as_without_drag() {
    let (still, mut conditions) = loaded(&elastic(), GRAVITY);
    let (settings, method) = (NewtonSettings::default(), Method::default());
    let mut at_once = still.clone();
    solve(&mut at_once, &method, &conditions, &settings).unwrap();
    let mut creeping = still;
    conditions.loads.drag = 1.0;
    let mut shares = Vec::new();
    for _ in 0..6 {
        let (report, _) = solve(&mut creeping, &method, &conditions, &settings).unwrap();
        shares.push(report.drag_share);
    }
    assert!(
        shares.windows(2).all(|pair| pair[1] < pair[0]),
        "{shares:?}"
    );
    assert!(shares[5] < 1e-5 * shares[0], "{shares:?}");
    let stress =
        |body: &igimp_solver::Body<2>, particle: usize| body.particles.sigma[particle][1][1];
    for particle in 0..at_once.particles.len() {
        let (a, b) = (stress(&at_once, particle), stress(&creeping, particle));
        assert!((a - b).abs() < 0.02 * GRAVITY * 4.0, "{particle}: {a} {b}");
    }
}
