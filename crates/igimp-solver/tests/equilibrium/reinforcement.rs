//! GOAL: a step that is accepted takes reinforcement along, and the next one begins with its tension.
//! BODY: a block that is stretched evenly from step to step, with a soft bar along it.
//! ORACLE: the force of a bar is its stiffness times the strain of the block; its ends are where the block carries them.

use std::sync::Arc;

use crate::body_support::{YOUNG, block, conditions, solve, unit_grid};
use igimp_assembly::{
    Constraints, Hold, Kinematics, Method, Reinforcement, Segment, SegmentState, SharedLaw, Station,
};
use igimp_material::{Elasticity, HenckyElastic};
use igimp_solver::NewtonSettings;

/// Axial stiffness, too small for the block to notice \[force\].
const STIFFNESS: f64 = 1e-6;

#[test]
fn steps_take_reinforcement_along() {
    let grid = unit_grid([6, 3]);
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0).unwrap();
    constraints.fix_wall(&grid, 1, false, 1).unwrap();
    for row in 0..=3 {
        let node = grid.node_index([4, row]);
        constraints.prescribe(node, 0, 0.04).unwrap();
    }
    let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(YOUNG, 0.0).unwrap()));
    let conditions = conditions(&grid, &constraints, &law, 0.0);
    let method = Method {
        kinematics: Kinematics::SmallStrain,
        ..Method::igimp()
    };
    let mut body = block(&grid, [0, 0], [4, 3]);
    let hold = Hold {
        fastened: 1e3,
        bonded: 0.0,
    };
    let ends = [[0.6, 1.3], [2.9, 1.3]];
    body.reinforcement = vec![Reinforcement {
        name: "bar".to_owned(),
        stiffness: STIFFNESS,
        stations: ends.map(|x| Station { points: vec![x] }).to_vec(),
        segments: vec![Segment {
            length: 2.3,
            tensile: 1.0,
            held: [hold; 2],
            state: SegmentState::default(),
        }],
    }];
    solve(&mut body, &method, &conditions, &NewtonSettings::default()).unwrap();
    let bar = &body.reinforcement[0];
    let [before, after] = [
        &ends,
        &[bar.stations[0].points[0], bar.stations[1].points[0]],
    ];
    for (before, after) in before.iter().zip(after) {
        assert!((after[0] - 1.01 * before[0]).abs() < 1e-9, "{after:?}");
        assert!((after[1] - before[1]).abs() < 1e-9, "{after:?}");
    }
    let force = bar.segments[0].state.force;
    assert!((force / (0.01 * STIFFNESS) - 1.0).abs() < 1e-6, "{force:e}");

    // The grid stays, the block has grown: its rightmost soil has left the column that is moved, and strains less.
    let stretch = |body: &igimp_solver::Body<2>| {
        let bar = &body.reinforcement[0];
        bar.stations[1].points[0][0] - bar.stations[0].points[0][0]
    };
    let held = stretch(&body);
    solve(&mut body, &method, &conditions, &NewtonSettings::default()).unwrap();
    let strain = (held - 2.3 + stretch(&body) - held) / 2.3;
    let force = body.reinforcement[0].segments[0].state.force;
    assert!(force > 0.014 * STIFFNESS, "{force:e}");
    assert!(
        (force / (strain * STIFFNESS) - 1.0).abs() < 1e-2,
        "{force:e} for {strain}"
    );
}
