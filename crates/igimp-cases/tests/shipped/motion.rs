//! Motion in time.

use crate::{between, ran};
use igimp_results::summary::StageOutcome::{Completed, Stopped};

#[test]
fn an_earthquake_moves_a_slope_as_far_as_a_block() {
    let ran = ran("earthquake_slope", &[]);
    assert_eq!(ran.outcomes(), [Completed, Stopped, Completed]);
    let stage = &ran.run.summary.stages[2];
    let block = stage.newmark.as_ref().unwrap();
    println!(
        "{block:?} {} {:?} {}",
        stage.largest_displacement, stage.energy, stage.steps
    );
    assert!(block.is_limit);
    between(block.yield_coefficient, 0.15, 0.35);
    between(block.displacement, 0.005, 0.2);
    // The soil also sways, and its layer amplifies the motion of the rock.
    between(stage.largest_displacement / block.displacement, 0.5, 10.0);
}

#[test]
fn a_slope_slides_until_it_rests() {
    let ran = ran("landslide_dynamic", &[]);
    assert_eq!(ran.outcomes(), [Completed, Completed, Completed]);
    let stage = &ran.run.summary.stages[2];
    assert_eq!(stage.code, "came-to-rest");
    // Farther than a few cells, and not out of the picture; lower than level ground could stand at what strength is left.
    between(stage.largest_displacement, 3.0, 20.0);
    let energy = stage.energy.unwrap();
    between(energy.plastic / energy.loads, 0.9, 1.02);
}

#[test]
fn a_boulder_falls_freely_and_digs_itself_in() {
    let ran = ran("impact", &[]);
    assert_eq!(ran.outcomes(), [Completed, Completed]);
    // It falls by 0.5 m, by g t²/2 until then.
    let way = ran.curve("settlement");
    let falling: Vec<_> = way
        .iter()
        .filter(|own| own[0] > 0.1 && own[1] < 0.45)
        .collect();
    assert!(falling.len() > 3);
    for own in falling {
        between(own[1] / (0.5 * 9.81 * own[0] * own[0]), 0.999, 1.001);
    }
    let energy = ran.curve("energy");
    let fastest = energy.iter().map(|own| own[1]).fold(0.0, f64::max);
    // Of 20 kN/m over 0.5 m.
    between(fastest, 9.5e3, 10.6e3);
    println!("impact settles by {}", ran.end_of("settlement"));
    between(ran.end_of("settlement"), 0.55, 0.9);
}

#[test]
fn a_column_of_sand_collapses_until_it_rests() {
    let ran = ran("column_collapse", &["grid.cell=2 cm"]);
    assert_eq!(ran.outcomes(), [Completed]);
    let stage = &ran.run.summary.stages[0];
    assert_eq!(stage.code, "came-to-rest");
    // Lower than it stood, and not flat: half a column of this shape keeps most of its height.
    between(ran.end_of("height"), 0.07, 0.099);
    let fastest = ran
        .curve("kinetic-energy")
        .iter()
        .map(|own| own[1])
        .fold(0.0, f64::max);
    between(ran.end_of("kinetic-energy") / fastest, 0.0, 1e-6);
}
