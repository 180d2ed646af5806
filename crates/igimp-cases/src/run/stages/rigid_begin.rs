//! Rigid bodies at the beginning of a stage that moves them.

use igimp_assembly::{Geometry, Stencils, System};
use igimp_model::{RigidDrive, RigidMove, Stage, StageKind};
use igimp_text::short;

use crate::CaseError;
use crate::run::rigid::{cell_near, gap_below, has_level_base, made};
use crate::run::{Model, State};

/// Prepares a state for a stage that moves rigid bodies: those that are not there are placed, and a held
/// component goes over to the force that will drive it. Warns of bodies that were shifted, and of those that soil is never near.
pub(crate) fn begin<const D: usize>(
    model: &Model<'_, D>,
    state: &mut State<D>,
    stage: &Stage,
    moves: &[RigidMove],
) -> Result<Vec<String>, CaseError> {
    let mut remarks = Vec::new();
    for motion in moves {
        if !state.controls.rigid[motion.body].placed {
            remarks.extend(place(model, state, motion.body)?);
            remarks.extend(heavy_at_once(model, stage, motion));
        }
        let body = &mut state.controls.rigid[motion.body];
        for (k, drive) in motion.drives.iter().enumerate() {
            match drive {
                Some(RigidDrive::By(_)) => body.loaded[k] = None,
                Some(RigidDrive::Force(_)) => {
                    body.loaded[k] = body.loaded[k].or(Some(body.track.force[k]));
                }
                None => {}
            }
        }
    }
    if stage.geometry == Geometry::Given {
        remarks.extend(
            moves
                .iter()
                .filter_map(|motion| out_of_reach(model, state, motion.body)),
        );
    }
    Ok(remarks)
}

/// The remark on a body whose weight nothing holds as it is placed, where forces come on in steps.
fn heavy_at_once<const D: usize>(
    model: &Model<'_, D>,
    stage: &Stage,
    motion: &RigidMove,
) -> Option<String> {
    let part = &model.case.rigid[motion.body];
    let comes_on = matches!(stage.kind, StageKind::Rigid(_)) && stage.steps > 1;
    let is_free = matches!(motion.drives[D - 1], Some(RigidDrive::Force(_)));
    (part.weight > 0.0 && is_free && comes_on).then(|| {
        let (name, up) = (&part.name, ["x", "y", "z"][D - 1]);
        format!(
            "the weight of the rigid body \"{name}\" acts whole in the first of {} steps: a stage before that holds it, {up} = \"0 m\", \
             lets it come on evenly",
            stage.steps
        )
    })
}

/// The remark on a body that touches no soil as a geometry is drawn that stays as it is: the gap never closes.
fn out_of_reach<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    index: usize,
) -> Option<String> {
    let part = &model.case.rigid[index];
    let slot = state.controls.placed().position(|body| body == index)?;
    let (body, particles) = (&state.body.rigid[slot], &state.body.particles);
    // From the nearest place of the body to the domain.
    let gap = |(x, half): (&[f64; D], &[f64; D])| {
        let (distance, normal) = body.nearest(x);
        let apart = std::iter::zip(half, normal)
            .map(|(half, normal)| ((distance * normal).abs() - half).max(0.0));
        apart.map(|apart| apart * apart).sum::<f64>().sqrt()
    };
    let soil = std::iter::zip(&particles.x, &particles.half_length);
    let nearest = soil.map(gap).fold(f64::INFINITY, f64::min);
    (nearest > TOUCHES * cell_near(model.case, part)).then(|| {
        format!(
            "the rigid body \"{}\" stands {} m off all soil, and on a given geometry a gap stays as it is drawn: nothing will touch it; \
             let the body begin at the soil, or write geometry = \"moving\"",
            part.name,
            short(nearest)
        )
    })
}

/// On a given geometry soil within this share of a cell touches a body from the start \[-\].
const TOUCHES: f64 = 0.1;

/// Puts a rigid body where it starts, or by as much lower as the soil beneath it settled.
pub(crate) fn place<const D: usize>(
    model: &Model<'_, D>,
    state: &mut State<D>,
    index: usize,
) -> Result<Option<String>, CaseError> {
    let case = model.case;
    let part = &case.rigid[index];
    let mut body = made(case, index, model.laws.len())?;
    let mut settled = gap_below(part, &state.body.particles) - model.gaps[index];
    let is_shifted = settled.is_finite() && settled.abs() > LEAST_SHIFT * cell_near(case, part);
    if is_shifted {
        body.pose.origin[D - 1] -= settled;
        state.controls.rigid[index].track.lowered = settled;
    }
    let slot = state.controls.placed().take_while(|&k| k < index).count();
    state.body.rigid.insert(slot, body);
    state.controls.rigid[index].placed = true;
    let stands = model.gaps[index].abs() <= LEAST_SHIFT * cell_near(case, part);
    if is_shifted
        && stands
        && has_level_base(part)
        && let Some(gap) = least_mean_gap(model, state, slot)?
        && gap > LAID * cell_near(case, part)
    {
        // The highest soil alone carries nothing: contact is averaged.
        settled += gap;
        state.body.rigid[slot].pose.origin[D - 1] -= gap;
        state.controls.rigid[index].track.lowered = settled;
    }
    state.body.particles.resolve_overlap(&state.body.rigid);
    let way = if settled > 0.0 { "down" } else { "up" };
    Ok(is_shifted.then(|| {
        format!(
            "the rigid body \"{}\" was set {way} by {} m, as far as the soil beneath it went",
            part.name,
            short(settled.abs())
        )
    }))
}

/// A body whose gap to soil is less than this share of a cell lies on it \[-\].
const LAID: f64 = 1e-7;

/// A body is not set down by less than this share of a cell \[-\].
pub(crate) const LEAST_SHIFT: f64 = 1e-9;

/// The smallest mean gap around a point of the sides of a body that has touched nothing yet \[m\]; none where no soil is near.
/// The rounding of its edges has no such point.
fn least_mean_gap<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    slot: usize,
) -> Result<Option<f64>, CaseError> {
    let method = model.method(Geometry::Moving);
    let conditions = model.conditions(&state.controls, &state.controls, 0.0)?;
    let particles = &state.body.particles;
    let stencils = Stencils::build_under(particles, &method, &conditions, &state.body.load_points)?;
    let structures = state.body.structures();
    let system = System::with_structures(particles, &structures, &stencils, &conditions, &method)?;
    let still = vec![[0.0; D]; system.node_count()];
    let Ok(contact) = system.bodies_at(&still) else {
        return Ok(None);
    };
    let knots = contact.bodies[slot].contact.knots.iter();
    let gaps = knots.filter(|knot| knot.area > 0.0).map(|knot| knot.gap);
    let least = gaps.fold(f64::INFINITY, f64::min);
    Ok(Some(least).filter(|gap| gap.is_finite()))
}
