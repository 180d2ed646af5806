//! Contact at one knot.

use super::*;

const PENALTY: Penalty = Penalty {
    stiffness: 10.0,
    smoothing: 0.02,
    tangential: 0.5,
};
/// Normal stiffness of the rows below: 10 E/h \[stress/length\].
const STIFFNESS: f64 = 2000.0;

/// A knot whose gap opens with the second component of the displacement of a node, and slips with the first.
fn row(gap: f64, area: f64, before: ContactNode) -> KnotContact<2> {
    KnotContact {
        body: 0,
        knot: 0,
        area,
        gap,
        cell: 0.5,
        young: 100.0,
        adhesion: 1.5,
        opening: vec![(0, [0.0, 1.0])],
        slip: [vec![(0, [1.0, 0.0])], Vec::new()],
        arms: None,
        before,
    }
}

fn closed(pressure: f64, shear: f64) -> ContactNode {
    ContactNode {
        pressure,
        shear: [shear, 0.0],
        area: 1.0,
        is_closed: true,
        ..ContactNode::default()
    }
}

fn with_shear(shear: Shear, tension: Tension) -> Interface {
    Interface { shear, tension }
}

fn limited(friction: f64) -> Shear {
    Shear::Limited {
        adhesion: vec![1.5],
        varies: false,
        friction,
    }
}

// GOAL: a step begins with the force that the last one left, on whatever area is covered now.
// CASE: pressed on either branch of eq. 46, and pulled at a bond; areas that shrink to a half, grow, and vanish nearly.
// ORACLE: force is pressure times area, before and now; what is left of a third of the area is twice the pressure.
#[test]
fn the_force_of_the_last_step_is_carried_to_the_area_at_hand() {
    // Where the branches of eq. 46 meet.
    let meet = 0.5 * STIFFNESS * PENALTY.smoothing * row(0.0, 1.0, closed(0.0, 0.0)).cell;
    for (pressure, tension) in [
        (3.0, Tension::None),
        (40.0, Tension::None),
        (0.9 * meet, Tension::None),
        (1.1 * meet, Tension::None),
        (3.0, Tension::Bonded),
        (-3.0, Tension::Bonded),
        (-3.0, Tension::Limit(50.0)),
    ] {
        let interface = with_shear(Shear::Rough, tension);
        for (area, share) in [(0.5, 1.0), (0.8, 1.0), (1.0, 1.0), (1.7, 1.0), (0.25, 0.5)] {
            let mut row = row(0.0, area, closed(pressure, 0.7));
            row.carry_force(&interface, &PENALTY, 2.0);
            let now = row.traction(&interface, &PENALTY, &[[0.0; 2]]);
            let label = format!("{tension:?} {pressure} on {area}: {now:?}");
            assert!(
                (area * now.pressure - share * pressure).abs() < 1e-12,
                "{label}"
            );
            assert!((area * now.shear[0] - share * 0.7).abs() < 1e-12, "{label}");
        }
    }
}

/// GOAL: soil that leaves a knot takes along what it carries: pressure has a bound however little is left, in however many steps.
/// ORACLE: a force on all of the knot that is carried until a tenth is covered has ten times its pressure there, and no more below.
#[test]
fn the_last_crumb_does_not_carry_all_force() {
    let interface = with_shear(Shear::Rough, Tension::None);
    let (mut before, mut area) = (closed(3.0, 0.7), 1.0);
    while area > 1e-6 {
        area *= 0.93;
        let mut row = row(0.0, area, before);
        row.carry_force(&interface, &PENALTY, 1.0);
        let now = row.traction(&interface, &PENALTY, &[[0.0; 2]]);
        before = ContactNode {
            pressure: now.pressure,
            shear: now.shear,
            area,
            ..before
        };
    }
    assert!((before.pressure - 30.0).abs() < 1e-9, "{before:?}");
}

// GOAL: tension across a bond adds nothing to friction.
// CASE: a bond that is pulled or pressed while soil slips far.
// ORACLE: Coulomb, |τ| = a + μ max(p, 0).
#[test]
fn a_bond_that_is_pulled_keeps_its_adhesion_alone() {
    let interface = with_shear(limited(0.5), Tension::Bonded);
    for (gap, limit) in [(0.004, 1.5), (-0.004, 1.5 + 0.5 * 8.0)] {
        let row = row(gap, 1.0, closed(0.0, 0.0));
        let traction = row.traction(&interface, &PENALTY, &[[-0.1, 0.0]]);
        assert!((traction.pressure + STIFFNESS * gap).abs() < 1e-12);
        assert!((traction.shear[0] - limit).abs() < 1e-12, "{traction:?}");
        assert!(traction.slips);
    }
}

// GOAL: soil that did not touch a side is not held along it.
// CASE: slip past a rough side at a distance and where soil comes in this very step, and past one with adhesion from more
// than a tenth of a cell off.
// ORACLE: no traction across a gap; the side holds from the end of the step on in which it is reached.
#[test]
fn a_side_that_was_not_touched_does_not_hold() {
    for (shear, gaps) in [
        (Shear::Rough, [0.051, -0.001]),
        (limited(0.0), [0.051, 0.2]),
    ] {
        let interface = with_shear(shear, Tension::None);
        for gap in gaps {
            let apart = row(gap, 1.0, ContactNode::default());
            let traction = apart.traction(&interface, &PENALTY, &[[-1e-4, 0.0]]);
            assert!(
                traction.shear[0].abs() < 1e-15,
                "{interface:?}: {traction:?}"
            );
        }
        let touching = row(-0.001, 1.0, closed(0.0, 0.0));
        let traction = touching.traction(&interface, &PENALTY, &[[-1e-4, 0.0]]);
        let held = 0.5 * STIFFNESS * 1e-4;
        assert!((traction.shear[0] - held).abs() < 1e-12, "{traction:?}");
    }
}

// GOAL: adhesion acts across a gap that a grid cannot tell from none, but not across a crack.
// CASE: soil that is 0.08 of a cell off a side without tension and slips far; the same behind a bond that broke.
// ORACLE: limit analysis lets a side that opens at no pressure carry its adhesion: |τ| = a, p = 0. A crack carries nothing.
#[test]
fn a_side_that_has_hardly_opened_adheres() {
    let interface = with_shear(limited(0.5), Tension::None);
    let near = row(0.04, 1.0, ContactNode::default());
    let traction = near.traction(&interface, &PENALTY, &[[-0.1, 0.0]]);
    assert!(traction.pressure.abs() < 1e-15 && traction.slips);
    assert!((traction.shear[0] - 1.5).abs() < 1e-12, "{traction:?}");
    let broken = ContactNode {
        is_broken: true,
        ..ContactNode::default()
    };
    let apart = row(0.04, 1.0, broken).traction(&interface, &PENALTY, &[[-0.1, 0.0]]);
    assert!(apart.shear[0].abs() < 1e-15, "{apart:?}");
}

// GOAL: a bond that was broken does not carry tension again.
// CASE: opening of a broken bond that is still closed, beside one that holds.
// ORACLE: no tension across a crack; the same opening at stiffness ε E/h where the bond holds.
#[test]
fn a_broken_bond_stays_broken_in_a_step() {
    let interface = with_shear(Shear::Rough, Tension::Limit(50.0));
    let opened = [[0.0, 1e-3]];
    let whole = row(0.0, 1.0, closed(0.0, 0.0));
    let broken = ContactNode {
        is_broken: true,
        ..whole.before
    };
    let held = whole.traction(&interface, &PENALTY, &opened).pressure;
    assert!((held + STIFFNESS * 1e-3).abs() < 1e-12, "{held}");
    let left = row(0.0, 1.0, broken).traction(&interface, &PENALTY, &opened);
    assert!(left.pressure.abs() < 1e-15 && !left.breaks, "{left:?}");
    // Pressed together again it is a side without tension.
    let mut again = row(
        0.0,
        0.5,
        ContactNode {
            pressure: 3.0,
            ..broken
        },
    );
    again.carry_force(&interface, &PENALTY, 1.0);
    let pressed = again.traction(&interface, &PENALTY, &[[0.0; 2]]).pressure;
    assert!((0.5 * pressed - 3.0).abs() < 1e-12, "{pressed}");
}
