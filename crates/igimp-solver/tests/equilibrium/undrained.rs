//! GOAL: in element tests clay has the strength of the direction in which it is loaded and of the rate at which it is sheared; the direction
//! is that at the start of a step, which is late by one step while stress turns.
//! ORACLE: the three strengths that are stated, the ellipse between them (theory, eq. 121), the logarithm of the rate (eq. 124).

use igimp_material::{Curve, Directions, RateEffect, Softening};
use igimp_solver::element::{
    COMPONENTS, Control, ElementPath, ElementState, ElementTest, Kinematics, StandardTest,
};

use crate::body_support::elasticity;

const CU: f64 = 1.0;
const SHARES: Directions = Directions {
    simple_shear: 0.75,
    passive: 0.5,
};

/// Tresca and von Mises.
fn laws() -> [Softening; 2] {
    let curve = Curve::constant(CU);
    [
        Softening::tresca(elasticity(), curve).unwrap(),
        Softening::von_mises(elasticity(), curve).unwrap(),
    ]
}

fn ran(law: &Softening, path: ElementPath, steps: usize, duration: f64) -> Vec<ElementState> {
    let legs = path.legs.len();
    let test = ElementTest {
        sigma: [-1.0; 3],
        path,
        steps,
        kinematics: Kinematics::Small,
        durations: vec![duration; legs],
    };
    let run = test.run(law).unwrap();
    assert_eq!(run.failure, None);
    run.states
}

/// Largest shear stress in the plane.
fn shear(state: &ElementState) -> f64 {
    let s = &state.sigma;
    (0.5 * (s[0][0] - s[1][1])).hypot(s[0][1])
}

/// Undrained plane strain with the major compression at an angle to the vertical.
fn strained(angle: f64, size: f64) -> [f64; COMPONENTS] {
    let (sine, cosine) = (2.0 * angle).sin_cos();
    [size * cosine, -size * cosine, 0.0, -2.0 * size * sine]
}

fn path(legs: Vec<[f64; COMPONENTS]>) -> ElementPath {
    ElementPath {
        controls: [Control::Strain; COMPONENTS],
        legs,
    }
}

#[test]
fn each_direction_has_its_strength() {
    for law in laws() {
        let law = law.with_directions(SHARES).unwrap();
        let end = |path: ElementPath| shear(ran(&law, path, 20, 0.0).last().unwrap());
        let compression = StandardTest::PlaneStrainUndrained;
        let three = [
            (end(compression.path(0.2)), CU),
            (
                end(StandardTest::SimpleShearUndrained.path(0.4)),
                SHARES.simple_shear,
            ),
            (end(compression.path(-0.2)), SHARES.passive),
        ];
        for (measured, expected) in three {
            assert!(
                (measured / expected - 1.0).abs() < 1e-9,
                "{measured} {expected}"
            );
        }
        for degrees in [10.0, 30.0, 50.0, 70.0, 85.0] {
            let angle = f64::to_radians(degrees);
            let radius = end(path(vec![strained(angle, 0.2)]));
            // The equation of the ellipse, with half axes from the three strengths.
            let [centre, level] = [0.5 * (CU - SHARES.passive), 0.5 * (CU + SHARES.passive)];
            let upright = SHARES.simple_shear / (1.0 - (centre / level).powi(2)).sqrt();
            let (sine, cosine) = (2.0 * angle).sin_cos();
            let on =
                ((radius * cosine - centre) / level).powi(2) + (radius * sine / upright).powi(2);
            assert!((on - 1.0).abs() < 1e-9, "{degrees}: {radius} {on}");
        }
    }
}

/// Stress that turns from active loading to simple shear: halved steps halve what the frozen angle is late by.
#[test]
fn the_frozen_angle_is_of_first_order() {
    let law = laws()[0].clone().with_directions(SHARES).unwrap();
    let turned = |steps: usize| {
        let mut legs = vec![strained(0.0, 0.1), strained(0.0, 0.1)];
        legs[1][3] = -0.02;
        let states = ran(&law, path(legs), steps, 0.0);
        shear(states.last().unwrap())
    };
    let fine = turned(12_800);
    let late = [25, 50, 100, 200].map(|steps| turned(steps) - fine);
    println!("late by {late:?} of c_u in 25 to 200 steps, {fine} in the limit");
    for pair in late.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((0.8..1.25).contains(&order), "{order} {late:?}");
    }
}

#[test]
fn each_rate_has_its_strength() {
    let rate = RateEffect {
        per_log_cycle: 0.12,
        reference: 3e-6,
    };
    for law in laws() {
        let law = law.with_rate(rate).unwrap();
        for speed in [3e-7_f64, 3e-6, 3e-5, 1e-3, 2.0] {
            let expected = CU * (1.0 + 0.12 * (speed / 3e-6).max(1.0).log10());
            for steps in [20, 40] {
                let shearing = StandardTest::SimpleShearUndrained.path(1.0);
                let states = ran(&law, shearing, steps, 1.0 / speed);
                let error = shear(states.last().unwrap()) / expected - 1.0;
                assert!(error.abs() < 1e-9, "{speed:e} {steps}: {error:e}");
            }
        }
    }
}
