//! Slopes and cuts.

use crate::{between, file, ran, ran_case};
use igimp_model::Strength;
use igimp_results::summary::StageOutcome::{Completed, Stopped};

#[test]
fn slope_stands_fails_and_rests() {
    let ran = ran(
        "slope",
        &[
            "grid.cell=2 m",
            "stages.0.steps=4",
            "stages.1.tolerance=0.05",
        ],
    );
    let outcomes = ran.outcomes();
    assert_eq!(outcomes[..2], [Completed, Completed]);
    assert!(ran.run.failure.is_none());
    let [stable, failed] = ran.factor_of_safety(1);
    between(stable, 1.25, 1.6);
    between(failed, 1.3, 1.65);
    let run_out = &ran.run.summary.stages[2];
    assert_eq!(run_out.outcome, Completed, "{}", run_out.reason);
    between(run_out.largest_displacement, 0.2, 6.0);
    // The share of mobilised strength is that of the strength that acts, reduced in the run-out.
    let sections = &ran.run.sections;
    let section = sections.iter().find(|t| t.name.ends_with("3-run-out"));
    let utilisation = section.unwrap().points(0, 8);
    let most = utilisation.iter().map(|p| p[1]).fold(0.0, f64::max);
    between(most, 0.99, 1.001);
    between(ran.virtual_work(1.0), 0.98, 1.02);
}

#[test]
fn layered_slope_is_safer_when_one_layer_alone_weakens() {
    let ran = ran(
        "layered_slope",
        &[
            "grid.cell=1 m",
            "grid.domain.y=[\"0 m\", \"13 m\"]",
            "stages.0.steps=4",
            "stages.1.tolerance=0.05",
            "stages.1.steps=15",
            "stages.2.tolerance=0.05",
            "stages.2.steps=15",
        ],
    );
    assert_eq!(ran.outcomes(), [Completed; 3]);
    let all = ran.factor_of_safety(1);
    let soft = ran.factor_of_safety(2);
    between(all[0], 1.15, 1.4);
    assert!(all[1] < soft[0], "{all:?} {soft:?}");
    between(soft[1], 1.5, 2.0);
}

/// GOAL: the factor of a slope by Hoek and Brown lies between those of two Mohr–Coulomb soils that enclose its envelope.
/// ORACLE: the envelope is concave: a tangent lies above it, and the chord from no normal stress to that of the height below it.
#[test]
fn rock_slope_lies_between_chord_and_tangent() {
    let ran = ran("rock_slope", &[]);
    assert_eq!(ran.outcomes(), [Completed, Completed]);
    let rock = ran.factor_of_safety(1);
    let file = file("rock_slope", &[]);
    let Strength::HoekBrown(hoek) = file.case().materials[0].strength else {
        panic!("no rock")
    };
    // Normal and shear stress of the envelope, and its slope, by the minor stress.
    let point = |minor: f64| {
        let (ratio, exponent) = (hoek.ratio(), hoek.exponent());
        let base = ratio * minor / hoek.intact_strength + hoek.cohesive_share();
        let width = hoek.intact_strength * base.powf(exponent);
        let steep = 1.0 + exponent * ratio * base.powf(exponent - 1.0);
        let root = steep.sqrt();
        [
            minor + width / (steep + 1.0),
            width * root / (steep + 1.0),
            (steep - 1.0) / (2.0 * root),
        ]
    };
    let factor = |cohesion: f64, tangent: f64| {
        let mut case = file.case().clone();
        case.materials[0].strength = Strength::MohrCoulomb {
            cohesion,
            friction_angle: tangent.atan(),
            dilation_angle: 0.0,
            flow: igimp_model::Flow::Dilation,
            tension_cutoff: None,
        };
        ran_case(&case).factor_of_safety(1)
    };
    let [normal, shear, tangent] = point(40e3);
    let above = factor(shear - normal * tangent, tangent);
    let at = |stress: f64| {
        let (mut low, mut high) = (
            -hoek.cohesive_share() * hoek.intact_strength / hoek.ratio(),
            stress + 1e6,
        );
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if point(middle)[0] < stress {
                low = middle;
            } else {
                high = middle;
            }
        }
        point(high)[1]
    };
    let (foot, head) = (at(0.0), at(250e3));
    let below = factor(foot, (head - foot) / 250e3);
    println!(
        "F {rock:?} of rock, {below:?} of the chord, {above:?} of the tangent at {normal:.0} Pa"
    );
    assert!(rock[0] > below[0] && rock[1] < above[1]);
}

#[test]
fn undrained_slope_collapses_near_the_bounds() {
    let ran = ran(
        "undrained_slope",
        &["grid.cell=2.5 m", "grid.domain.y=[\"0 m\", \"22.5 m\"]"],
    );
    assert_eq!(ran.outcomes(), [Completed, Stopped]);
    let limit = ran.end_of("load-displacement");
    between(limit, 5.2, 6.3);
    between(ran.virtual_work(limit * 0.225), 0.98, 1.02);
}

#[test]
fn vertical_cut_collapses_near_the_bounds() {
    let ran = ran("vertical_cut", &["grid.cell=0.5 m", "stages.1.steps=15"]);
    assert_eq!(ran.outcomes(), [Completed, Stopped]);
    between(ran.end_of("load-displacement"), 3.7, 4.4);
}

#[test]
fn nails_hold_a_cut_that_would_fall() {
    let overrides = ["grid.cell=0.5 m", "stages.0.steps=3"];
    let held = ran("nailed_cut", &overrides);
    assert_eq!(held.outcomes(), [Completed, Completed]);
    // Circles through the nails, and the share of the mesh.
    between(held.factor_of_safety(1)[0], 1.15, 1.35);
    let most = held.end_of("force in the middle nails");
    between(most, 10e3, 30e3);
    let bare = [overrides[0], overrides[1], "reinforcement=[]", "curves=[]"];
    let bare = ran("nailed_cut", &bare);
    assert!(bare.run.failure.is_some() || bare.factor_of_safety(1)[0] < 1.05);
}
