//! Remarks on an interval.

use std::collections::HashMap;

use igimp_assembly::Particles;
use igimp_model::{Case, Drainage, Material, ReductionPath, Strength, StrengthReduction};
use igimp_results::fields::length;
use igimp_results::measure::soil_ends;
use igimp_results::summary::SafetySummary;
use igimp_text::short;

use super::{at_full_strength, stands_nowhere, weight_drains};
use crate::run::output::moment::largest_displacement;
use crate::run::state::State;

/// A particle moves when its displacement exceeds this share of the largest \[-\].
const MOVING: f64 = 0.1;

/// Cells over the height of a slope below which its factor of safety is not to be trusted on one mesh.
const ENOUGH: f64 = 10.0;

/// The same of cells by their width, the least along an axis that is level.
const ENOUGH_COLUMNS: f64 = 5.0;

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
    for (k, x) in particles.x.iter().enumerate() {
        let mut strip = [0; D];
        for axis in 0..D - 1 {
            // Points in the middle of a cell lie on the line between its strips.
            strip[axis] = (STRIPS * axes[axis].place(x[axis]) + 1e-6).floor() as i64;
        }
        let top = axes[D - 1].place(soil_ends(particles, k, D - 1)[1]);
        let highest = surface.entry(strip).or_insert(top);
        *highest = highest.max(top);
    }
    let least = surface.values().copied().fold(f64::INFINITY, f64::min);
    let most = surface.values().copied().fold(f64::NEG_INFINITY, f64::max);
    let rows = most - least;
    let level = |place: f64| {
        let line = place.floor().max(0.0);
        axes[D - 1].rise(line as usize) + (place - line) * axes[D - 1].last_cell()
    };
    let height = level(most) - level(least);
    let widest = (0..D - 1).map(|axis| axes[axis].extremes()[0]);
    let columns = height / widest.fold(0.0, f64::max);
    if rows <= 1.0 + 1e-6 {
        return None;
    }
    let (size, wanted) = if rows < ENOUGH * (1.0 - 1e-6) {
        (format!("is {} cells high", short(rows)), ENOUGH)
    } else if columns < ENOUGH_COLUMNS * (1.0 - 1e-6) {
        let size = format!("is as high as {} cells are wide", short(columns));
        (size, ENOUGH_COLUMNS)
    } else {
        return None;
    };
    Some(format!(
        "the slope {size}: with fewer than {wanted} cells over the height a factor of safety is several per cent too high; a \
         study of meshes (--meshes 2) tells by how much"
    ))
}

/// Remarks on an interval.
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
    remarks.extend(local(safety));
    remarks
}

/// A remark where trials raise gravity on soil that holds its water, though its weight came while all soil drained.
pub(super) fn holds_its_weight<const D: usize>(
    case: &Case<D>,
    number: usize,
    reduction: &StrengthReduction,
) -> Option<String> {
    let by_weight = reduction.path == ReductionPath::Gravity && !case.stages[number].drained;
    let holds = |material: &Material| matches!(material.drainage, Drainage::Undrained { .. });
    let of_soil = by_weight && weight_drains(case, number) && case.materials.iter().any(holds);
    of_soil.then(|| {
        "trials raise gravity on soil that holds its water, though its weight came while all soil drained: the weight is carried \
         by water; search = \"continuation\" lets the soil drain under its weight, and drained = true in this stage tells the \
         drained factor"
            .to_owned()
    })
}

/// A remark where hardly any of the mass moves at failure.
pub(super) fn local(safety: &SafetySummary) -> Option<String> {
    let share = safety.moving_mass.filter(|_| safety.may_be_local())?;
    Some(format!(
        "only {} % of the mass moves at failure: this may be a local failure; leave its material \
         out with `materials`, or give it a little cohesion, to find that of the whole slope",
        short(100.0 * share)
    ))
}

/// The share of the mass that moves by more than a tenth of the largest displacement \[-\]; of the
/// volume where nothing has a weight. None where nothing moves.
pub(super) fn moving_mass<const D: usize>(state: &State<D>) -> Option<f64> {
    let particles = &state.body.particles;
    let moving = sum_of_moving(particles, |_| true)?;
    Some(moving / weights(particles).iter().sum::<f64>())
}

/// Mass of particles, or volume where nothing has a weight.
fn weights<const D: usize>(particles: &Particles<D>) -> &[f64] {
    let weighs = particles.mass.iter().any(|&mass| mass > 0.0);
    if weighs {
        &particles.mass
    } else {
        &particles.volume0
    }
}

/// Sum over the particles that move and are wanted; none where nothing moves.
fn sum_of_moving<const D: usize>(
    particles: &Particles<D>,
    is_wanted: impl Fn(usize) -> bool,
) -> Option<f64> {
    let largest = largest_displacement(particles);
    if largest == 0.0 {
        return None;
    }
    let moves = |&particle: &usize| length(&particles.displacement[particle]) > MOVING * largest;
    let all = (0..particles.len()).filter(moves);
    let weights = weights(particles);
    let sum = all.filter(|&particle| is_wanted(particle));
    Some(sum.fold(0.0, |sum, particle| sum + weights[particle]))
}

/// A share of the mechanism in tension from which on that is worth a remark \[-\]. Of eighteen slopes of 10 m (two to one, one to
/// one, one to two; φ = 20°, c from 2 to 80 kPa) those whose factor a cut-off lowers by 2 % and more, up to 10 %, have 3.7 % and
/// more of it, those that it lowers by 1.3 % and less have less than 3 %.
const CARRIES: f64 = 0.03;

/// A remark where soil in tension takes part in a mechanism and nothing limits its tension: the mean effective stress of such a
/// particle is tensile, beyond round-off. Open cracks at the crest would carry none of it.
pub(super) fn tension<const D: usize>(case: &Case<D>, state: &State<D>) -> Option<String> {
    let particles = &state.body.particles;
    let may_carry = |particle: usize| {
        matches!(
            case.material_of(particles.law[particle]).strength,
            Strength::MohrCoulomb { cohesion, tension_cutoff: None, .. }
            | Strength::DruckerPrager { cohesion, .. } if cohesion > 0.0
        )
    };
    let scale =
        (particles.sigma.iter().flatten().flatten()).fold(0.0, |most: f64, s| most.max(s.abs()));
    let is_pulled = |particle: usize| {
        may_carry(particle) && mean_stress(&particles.sigma[particle]) > 1e-6 * scale
    };
    let all = sum_of_moving(particles, |_| true)?;
    let pulled = sum_of_moving(particles, is_pulled)?;
    let share = pulled / all;
    let mut materials = case.materials.iter();
    let has_cone = materials.any(|soil| matches!(soil.strength, Strength::DruckerPrager { .. }));
    (share >= CARRIES).then(|| {
        format!(
            "{} % of the mass that moves carries tension, which open cracks would not: the factor may be a few per cent too \
             high; tension_cutoff = \"0 kPa\" in the materials at the crest asks without it{}",
            short(100.0 * share),
            if has_cone { " (with model = \"mohr-coulomb\")" } else { "" }
        )
    })
}

fn mean_stress(sigma: &[[f64; 3]; 3]) -> f64 {
    (sigma[0][0] + sigma[1][1] + sigma[2][2]) / 3.0
}

#[cfg(test)]
mod tests {
    use igimp_assembly::ParticleSeed;

    use super::*;

    // GOAL: a body that did not move has no moving share, not one of nothing; of one that did it is that of its mass.
    // ORACLE: by hand.
    #[test]
    fn a_body_at_rest_has_no_moving_share() {
        let seed = |x: f64, density: f64| ParticleSeed {
            x: [x, 0.5],
            half_length: [0.25; 2],
            volume: 0.25,
            density,
            law: 0,
            centroid: [0.0; _],
        };
        let body = Particles::new(&[seed(0.5, 1.0), seed(1.5, 3.0)]).unwrap();
        assert_eq!(sum_of_moving(&body, |_| true), None);
        let mut fields = (*body).clone();
        fields.displacement = vec![[0.0, -0.01], [0.0, -1.0]];
        let moved = Particles::from_fields(fields).unwrap();
        assert_eq!(sum_of_moving(&moved, |_| true), Some(0.75));
        assert_eq!(sum_of_moving(&moved, |particle| particle == 0), Some(0.0));
    }
}
