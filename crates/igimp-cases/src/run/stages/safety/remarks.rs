//! What a reader has to know about an interval.

use std::collections::HashMap;

use igimp_assembly::Particles;
use igimp_model::{Case, StrengthReduction};
use igimp_results::fields::length;
use igimp_results::summary::SafetySummary;
use igimp_text::short;

use super::{at_full_strength, stands_nowhere};
use crate::run::output::records::largest_displacement;
use crate::run::state::State;

/// A particle moves when its displacement exceeds this share of the largest \[-\].
const MOVING: f64 = 0.1;

/// A moving share of the mass below this is called local \[-\].
const LOCAL: f64 = 0.02;

/// Cells over the height of a slope below which its factor of safety is not to be trusted on one mesh.
const ENOUGH: f64 = 10.0;

/// Strips of a cell in which the level of the surface is looked for.
const STRIPS: f64 = 2.0;

/// A remark where a slope is fewer than ten cells high. Its height is that of the surface of the ground, from the lowest
/// to the highest strip of it; level ground is no slope.
pub(super) fn few_cells<const D: usize>(
    case: &Case<D>,
    particles: &Particles<D>,
) -> Option<String> {
    let axes = &case.grid.axes;
    let mut surface: HashMap<[i64; D], f64> = HashMap::new();
    for (x, half_length) in std::iter::zip(&particles.x, &particles.half_length) {
        let mut strip = [0; D];
        for axis in 0..D - 1 {
            strip[axis] = (STRIPS * axes[axis].place(x[axis])).floor() as i64;
        }
        let top = axes[D - 1].place(x[D - 1] + half_length[D - 1]);
        let highest = surface.entry(strip).or_insert(top);
        *highest = highest.max(top);
    }
    let least = surface.values().copied().fold(f64::INFINITY, f64::min);
    let most = surface.values().copied().fold(f64::NEG_INFINITY, f64::max);
    // A face that ends at the side of the grid leaves part of a cell in the last strip.
    let cells = (most - least - 1e-6).ceil();
    (cells > 1.0 && cells < ENOUGH).then(|| {
        format!(
            "the slope is {cells} cells high: with fewer than {ENOUGH} cells over the height a factor of safety is several \
             per cent too high; a study of meshes (--meshes 2) tells by how much"
        )
    })
}

/// What a reader has to know about an interval.
pub(super) fn remarks(safety: &SafetySummary, reduction: &StrengthReduction) -> Vec<String> {
    let mut remarks = Vec::new();
    let [low, high] = reduction.bracket;
    if safety
        .trials
        .iter()
        .any(|trial| at_full_strength(trial) && !trial.stable)
    {
        remarks.push(
            "the body does not stand at full strength (SRF 1): the factor of safety is below 1, or \
             the start of the search is not in equilibrium"
                .to_owned(),
        );
    }
    match (safety.stable, safety.failed) {
        (Some(stable), None) => remarks.push(format!(
            "the slope still stands at SRF {stable:.4}, the largest factor tried"
        )),
        (None, Some(_)) if stands_nowhere(&safety.trials, reduction.path) => remarks.push(
            "no trial found a single equilibrium, whatever the strength: this tells nothing of the factor of safety; \
             more steps, other cells, or `small_cuts` with a larger `below` may"
                .to_owned(),
        ),
        (None, Some(failed)) => remarks.push(format!(
            "the slope fails even at SRF {failed:.4}, the smallest factor tried"
        )),
        (Some(stable), Some(failed)) if failed <= low || stable >= high => remarks.push(format!(
            "the factor of safety lies outside the bracket [{low}, {high}], which was widened"
        )),
        _ => {}
    }
    if let Some(share) = safety.moving_mass.filter(|&share| share < LOCAL) {
        remarks.push(format!(
            "only {} % of the mass moves at failure: this is a local failure; leave its material \
             out with `materials`, or give it a little cohesion, to find that of the whole slope",
            short(100.0 * share)
        ));
    }
    remarks
}

/// The share of the mass that moves by more than a tenth of the largest displacement \[-\]; of the
/// volume where nothing has a weight.
pub(super) fn moving_mass<const D: usize>(state: &State<D>) -> f64 {
    let particles = &state.body.particles;
    let limit = MOVING * largest_displacement(particles);
    let weighs = particles.mass.iter().any(|&mass| mass > 0.0);
    let share = if weighs {
        &particles.mass
    } else {
        &particles.volume0
    };
    let moving: f64 = particles
        .displacement
        .iter()
        .zip(share)
        .filter(|(d, _)| length(d) > limit)
        .map(|(_, share)| share)
        .sum();
    moving / share.iter().sum::<f64>()
}
