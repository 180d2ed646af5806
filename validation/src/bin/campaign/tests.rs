//! A reduced campaign: the rules of every run, on a few small slopes and a short, coarse
//! footing.

use std::time::Duration;

use igimp_input::CaseFile;

use crate::bodies::Scene;
use crate::footing::{Footing, depth_reached, resistance_at};
use crate::slope::{Drive, Slope};
use crate::watch::{Budget, End, Watched, watch};

const BUDGET: Budget = Budget {
    corrections: 6000,
    time: Duration::from_secs(300),
    grace: Duration::from_secs(60),
};

/// A slope of the campaign on the coarsest mesh.
fn small(number: u64) -> Slope {
    let mut slope = Slope::random(2026, number);
    slope.foundation = slope.foundation.min(2);
    slope.cells = 5;
    slope.per_direction = 2;
    slope
}

fn run(slope: &Slope) -> Watched {
    let file = CaseFile::parse("slope.toml", &slope.case_file(), &[]);
    watch(file.expect("the slope is a case").into_case(), BUDGET)
}

/// GOAL: slopes of all kinds end in collapse, with a reason, without a panic, and accept nothing
/// above the tolerance that is not round-off.
/// ORACLE: the equilibrium of accepted steps, summed again from the stress that particles carry.
#[test]
fn small_slopes_end_with_a_reason() {
    let slopes: Vec<Slope> = (1..=8).map(small).collect();
    assert!(slopes.iter().any(|slope| slope.drive == Drive::Gravity));
    assert!(slopes.iter().any(|slope| slope.drive != Drive::Gravity));
    for slope in slopes {
        let watched = run(&slope);
        let effort = &watched.effort;
        assert!(watched.is_sound(), "{slope:?}: {watched:?}");
        assert!(watched.end != End::Budget, "{slope:?}: {}", watched.reason);
        assert!(
            effort.rechecked > 0 && effort.plastic_share > 0.0,
            "{slope:?}"
        );
    }
}

/// GOAL: a stiff, nearly incompressible footing goes into plastic flow without trouble.
/// ORACLE: Prandtl's 2 + π, which a coarse mesh meets within some 15 % at a tenth of the width.
#[test]
fn a_short_coarse_footing_is_sound() {
    let footing = Footing {
        stiffness: 1000.0,
        poisson: 0.4999,
        cells_per_width: 3,
        depth: 0.1,
        steps: 5,
    };
    let watched = watch(footing.case().unwrap(), BUDGET);
    assert!(watched.is_sound(), "{watched:?}");
    assert_eq!(watched.end, End::Completed, "{}", watched.reason);
    assert!((depth_reached(&watched.curves) - 0.1).abs() < 1e-9);
    let prandtl = 2.0 + std::f64::consts::PI;
    let n = resistance_at(&watched.curves, 0.1);
    assert!((n / prandtl - 1.0).abs() < 0.15, "N = {n}");
}

/// GOAL: the watch ends a run whose budget is used up, and says so.
/// ORACLE: a budget of ten corrections.
#[test]
fn a_budget_ends_a_run() {
    let slope = small(1);
    let file = CaseFile::parse("slope.toml", &slope.case_file(), &[]).unwrap();
    let budget = Budget {
        corrections: 10,
        ..BUDGET
    };
    let watched = watch(file.into_case(), budget);
    assert_eq!(watched.end, End::Budget, "{}", watched.reason);
}

/// GOAL: seed and number, and nothing else, make a slope.
/// ORACLE: equality of the case files.
#[test]
fn slopes_are_those_of_their_seed() {
    let (a, b) = (Slope::random(7, 3), Slope::random(7, 3));
    assert_eq!(a.case_file(), b.case_file());
    assert_ne!(a.case_file(), Slope::random(7, 4).case_file());
    assert_ne!(a.case_file(), Slope::random(8, 3).case_file());
}

/// GOAL: bodies of several kinds in soil end with a reason, and keep soil out.
/// ORACLE: equilibrium with the traction on the bodies, and distances from their outlines, both computed again.
#[test]
fn a_few_bodies_keep_soil_out() {
    let mut near_soil = 0;
    for number in [3, 6, 11, 23] {
        let scene = Scene::random(2026, number);
        let file = CaseFile::parse("bodies.toml", scene.case_file(), &[]);
        let watched = watch(file.expect("the scene is a case").into_case(), BUDGET);
        assert!(watched.is_sound(), "{number}: {watched:?}");
        assert!(watched.effort.rechecked > 0, "{number}");
        // No distance where no step with a body was accepted.
        if let Some(nearest) = watched.effort.nearest {
            assert!(nearest > 0.49, "{number}: {nearest}");
            near_soil += 1;
        }
    }
    assert!(near_soil >= 2, "{near_soil}");
    let (a, b) = (Scene::random(7, 3), Scene::random(7, 3));
    assert_eq!(a.case_file(), b.case_file());
}
