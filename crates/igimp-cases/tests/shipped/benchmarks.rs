//! The four benchmarks of the paper.

use crate::{between, ran};
use igimp_results::summary::StageOutcome::Completed;

#[test]
fn column_has_the_height_of_the_exact_solution() {
    let ran = ran("column", &[]);
    assert_eq!(ran.outcomes(), [Completed]);
    assert!(ran.meets_its_checks());
    between(ran.virtual_work(1.0), 0.999, 1.001);
}

#[test]
fn von_mises_slope_is_in_equilibrium_at_large_displacement() {
    let ran = ran(
        "von_mises_slope",
        &[
            "grid.cell=1 m",
            "grid.domain.y=[\"0 m\", \"16 m\"]",
            "stages.0.steps=5",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed]);
    between(ran.run.summary.stages[0].largest_displacement, 0.6, 0.9);
    between(ran.virtual_work(1.0), 0.99, 1.01);
}

#[test]
fn mohr_coulomb_slope_has_its_factor_of_safety() {
    let ran = ran(
        "mohr_coulomb_slope",
        &[
            "grid.cell=2 m",
            "grid.domain.y=[\"0 m\", \"12 m\"]",
            "stages.0.factors=[0.8, 1.2]",
            "stages.0.tolerance=0.05",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed]);
    let [stable, failed] = ran.factor_of_safety(0);
    between(stable, 1.32, failed);
    between(failed, stable, 1.52);
    // Every listed factor makes a point of the curve, and nothing else does.
    let curve = ran.curve("displacement");
    assert_eq!(curve.len(), 2);
    between(curve[0][1], 0.36, 0.39);
    between(curve[1][1], 0.39, 0.45);
}

#[test]
fn footing_follows_limit_analysis_at_first() {
    let ran = ran(
        "footing",
        &[
            "grid.cell=0.21 m",
            "stages.0.bodies=[{ body = \"footing\", y = \"-0.2 m\" }]",
            "stages.0.steps=14",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed]);
    between(ran.end_of("resistance"), 5.1, 6.1);
}

#[test]
fn bonded_footing_follows_limit_analysis_at_first() {
    let ran = ran(
        "footing_bonded",
        &[
            "grid.cell=0.2 m",
            "stages.0.settlement=0.2 m",
            "stages.0.steps=14",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed]);
    between(ran.end_of("resistance"), 5.2, 5.8);
}
