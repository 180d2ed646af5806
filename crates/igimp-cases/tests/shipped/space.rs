//! Cases in space.

use crate::{between, ran_in_space};
use igimp_results::summary::StageOutcome::{Completed, Stopped};

#[test]
fn a_square_footing_carries_what_limit_analysis_says() {
    let ran = ran_in_space("footing_3d", &["output.figures=[]"]);
    assert_eq!(ran.outcomes(), [Completed]);
    // Lower bound 5.52, best upper bound 5.95.
    between(ran.measured("bearing capacity factor"), 5.5, 6.0);
}

#[test]
fn a_slope_between_valley_sides_is_stronger_than_in_the_plane() {
    let ran = ran_in_space("slope_3d", &["output.figures=[]"]);
    assert_eq!(ran.outcomes(), [Completed, Stopped]);
    let limit = ran.end_of("load-displacement");
    between(limit, 5.175, 7.877);
    // Rough valley sides carry a part of the weight.
    assert!(ran.virtual_work(limit * 0.2) < 0.97);
}

#[test]
fn a_slope_from_a_raster_is_as_safe_as_its_bounds_say() {
    let ran = ran_in_space("landslide_3d", &["stages.1.tolerance=0.2"]);
    assert_eq!(ran.outcomes(), [Completed; 2]);
    let [stable, failed] = ran.factor_of_safety(1);
    between(stable, 1.035, 1.575);
    between(failed, stable, stable + 0.2);
    let volume: f64 = ran.run.body.particles.volume0.iter().sum();
    assert!((volume / 687.5 - 1.0).abs() < 1e-9, "{volume}");
    assert!(ran.virtual_work(1.0) < 0.97);
}
