//! Rigid bodies.

use crate::{between, ran};
use igimp_results::summary::StageOutcome::Completed;

#[test]
fn contact_footing_lets_go() {
    let ran = ran(
        "contact_footing",
        &["grid.cell=0.2 m", "stages.0.steps=20", "stages.1.steps=4"],
    );
    assert_eq!(ran.outcomes(), [Completed; 2]);
    between(
        ran.measured("resistance N after it was pulled"),
        -0.05,
        0.05,
    );
    let curve = ran.curve("resistance");
    let highest = curve.iter().map(|p| p[1]).fold(0.0, f64::max);
    between(highest, 4.0, 7.5);
}

#[test]
fn eccentric_footing_carries_less_and_lifts_off() {
    let ran = ran("eccentric_footing", &[]);
    assert_eq!(ran.outcomes(), [Completed; 2]);
    assert!(ran.meets_its_checks());
    between(ran.end_of("contact width"), 0.5, 0.8);
}

#[test]
fn pipe_meets_the_fit_at_shallow_depth() {
    let ran = ran("pipe", &["stages.0.bodies.0.y=-0.1 m", "stages.0.steps=20"]);
    assert_eq!(ran.outcomes(), [Completed]);
    // 7.1 (w/D)^0.33; limit analysis without the lip has 2.96 to 3.10.
    between(ran.end_of("resistance"), 2.8, 3.7);
}

#[test]
fn wall_is_between_active_and_passive_pressure() {
    let ran = ran("wall", &["grid.cell=0.5 m", "rigid.0.thickness=1 m"]);
    assert_eq!(ran.outcomes(), [Completed; 3]);
    between(ran.measured("active pressure"), 0.26, 0.40);
    between(ran.measured("passive pressure"), 2.4, 3.6);
}

#[test]
fn plate_anchor_leaves_a_gap() {
    let ran = ran("plate_anchor", &[]);
    assert_eq!(ran.outcomes(), [Completed]);
    assert!(ran.meets_its_checks());
}

#[test]
fn wedge_meets_more_resistance_with_depth() {
    let ran = ran(
        "wedge",
        &[
            "bodies.0.points_per_cell=4",
            "stages.0.bodies.0.y=-0.3 m",
            "stages.0.steps=40",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed]);
    // The band of the template's check, from 7.7 to 9.2 at a depth of 1 m: resistance grows with depth.
    between(ran.end_of("resistance"), 0.3 * 7.7, 0.3 * 9.2);
}
