//! Construction stages: bodies come and go, consist of something else, water rises and falls.
//!
//! Whatever a stage changes is changed at its beginning. The nodal forces that would then keep the ground where it is
//! hold it, and are let go over the steps of the stage (theory, eq. 55): the weight of a fill comes on, the support that
//! removed soil gave goes, and each step ends in equilibrium.

use std::sync::Arc;

use igimp_assembly::{
    Kinematics, ParticleFields, Particles, PoreSite, PoreWater as _, RigidBody, Stencils, System,
};
use igimp_material::{
    ConstitutiveModel, History, Remembered, ScaledLaw, TangentKind, directed_history,
    elastic_left_cauchy_green_of, principal_values,
};
use igimp_model::{Case, Construction, Drainage, Ground, StageKind, distance};
use igimp_results::ending::EndReason;
use igimp_results::summary::StageSummary;
use igimp_text::short;

use super::loading::release;
use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::resume::Resumption;
use crate::run::session::{Session, StageEnd};
use crate::run::state::{State, gravity_of_weights};

/// Marches a state to the end of a construction stage; one that an earlier run left within it began with `start`.
pub(crate) fn build<const D: usize>(
    session: &mut Session<'_, D>,
    (start, state): (Option<&State<D>>, &mut State<D>),
    number: usize,
    summary: &mut StageSummary,
    resumption: Option<&Resumption>,
) -> Result<StageEnd, CaseError> {
    let model = session.model;
    let stage = &model.case.stages[number];
    let StageKind::Construction(works) = &stage.kind else {
        return Ok(StageEnd::Completed(EndReason::ReachedItsEnd));
    };
    let (changed, pushed) = changed(model, start.unwrap_or(state), number, works)?;
    let held = holding(model, &changed, number)?;
    if resumption.is_none() {
        for &body in &works.place {
            if let Some(text) = moved_below(model, state, body) {
                session.warn(text);
            }
        }
        if let Some(text) = pushed {
            session.warn_of_stage(number, &text);
        }
        *state = changed;
    }
    release(
        session,
        state,
        (number, Some(Arc::new(held))),
        summary,
        resumption,
    )
}

/// A state with everything that a stage changes, and its warning.
fn changed<const D: usize>(
    model: &Model<'_, D>,
    start: &State<D>,
    number: usize,
    works: &Construction,
) -> Result<(State<D>, Option<String>), CaseError> {
    let case = model.case;
    let mut state = start.clone();
    let mut pushed = None;
    let body_of =
        |particles: &Particles<D>, particle: usize| model.seeded.body[particles.number[particle]];
    if !works.place.is_empty()
        && let Some(later) = &model.later
    {
        let placed = later.keeping(|particle| works.place.contains(&body_of(later, particle)))?;
        state.body.particles = state.body.particles.joined_by(&placed);
        pushed = pushed_aside(case, &mut state);
    }
    if !works.remove.is_empty() {
        let particles = &state.body.particles;
        let stays = |particle| !works.remove.contains(&body_of(particles, particle));
        state.body.particles = particles.keeping(stays)?;
    }
    let mut fields = (*state.body.particles).clone();
    let ground = case.ground();
    for particle in 0..fields.x.len() {
        let body = model.seeded.body[fields.number[particle]];
        if works.dissipate {
            let_water_out(&mut fields, particle);
        }
        let stated = works.materials.iter().find(|(of, _)| *of == body);
        // A body that comes back consists of what it consisted of last.
        let kept = || {
            let last = case.material_after(case.stages[number].start_from, body);
            (works.place.contains(&body) && last != case.bodies[body].material).then_some(last)
        };
        if let Some(material) = stated.map(|(_, material)| *material).or_else(kept) {
            let law = fields.law[particle];
            fields.law[particle] = case.law_beside(law, material);
            // What is placed is free of stress, whatever its law speaks of, and remembers nothing.
            let is_placed = works.place.contains(&body);
            if !is_placed
                && case
                    .material_of(law)
                    .is_same_soil(&case.materials[material])
            {
                continue;
            }
            if !is_placed {
                drain_as(model, &state, &mut fields, particle, law);
            }
            let remembers = (!is_placed).then(|| (law, state.body.particles.history(particle)));
            let stretch = match case.method.kinematics {
                Kinematics::FiniteStrain => state.body.particles.volume_ratio(particle),
                Kinematics::SmallStrain => 1.0,
            };
            let soil = (material, remembers);
            become_soil_of((model, &ground), &mut fields, (particle, stretch), soil)?;
        }
    }
    state.body.particles = Particles::from_fields(fields)?;
    state.controls.water = works.water.or(state.controls.water);
    Ok((state, pushed))
}

/// A rigid body stands elsewhere than it is drawn when its reference point is further from there \[m\].
const LEAST_SHIFT: f64 = 1e-9;

/// Fill that is moved off rigid bodies by more than this share of the half-length of its particles is worth a warning \[-\].
const PUSHED: f64 = 0.25;

/// Moves fill off rigid bodies that stand elsewhere than they are drawn; a warning where that is far.
fn pushed_aside<const D: usize>(case: &Case<D>, state: &mut State<D>) -> Option<String> {
    let stands_elsewhere = |(index, body): (usize, &RigidBody<D>)| {
        distance(&body.pose.origin, &case.rigid[index].reference) > LEAST_SHIFT
    };
    let mut bodies = std::iter::zip(state.controls.placed(), &state.body.rigid);
    let is_meant = !bodies.any(stands_elsewhere);
    let before = state.body.particles.x.clone();
    let particles = &mut state.body.particles;
    particles.resolve_overlap(&state.body.rigid);
    let moved = |particle: usize| -> (f64, f64) {
        let by = (0..D).map(|axis| (particles.x[particle][axis] - before[particle][axis]).abs());
        let halves = particles.half_length[particle];
        std::iter::zip(by, halves).fold((0.0, 0.0), |(most, share), (by, half)| {
            (by.max(most), (by / half).max(share))
        })
    };
    let all = (0..particles.len()).map(moved);
    let (most, share) = all.fold((0.0, 0.0), |a: (f64, f64), b| (a.0.max(b.0), a.1.max(b.1)));
    (share > PUSHED && !is_meant).then(|| {
        format!(
            "soil that is placed overlaps a rigid body which has moved from where it is drawn, and was shifted off it by up to {} m \
             without strain; draw the fill to where the body stands",
            short(most)
        )
    })
}

/// Makes the stress of a particle that had another law before that of which its law speaks, total or effective; the total
/// stress stays. The excess pressure of soil that drains from now on goes, and its share is out of balance.
fn drain_as<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    fields: &mut ParticleFields<D>,
    particle: usize,
    law_before: usize,
) {
    let law = fields.law[particle];
    let [before, drainage] = [law_before, law].map(|law| model.case.material_of(law).drainage);
    if (before == Drainage::Total) != (drainage == Drainage::Total) {
        let water = state.controls.water.and_then(|k| model.ground_water(k));
        let given = water.map_or(0.0, |water| {
            let site = PoreSite {
                law,
                ..state
                    .body
                    .particles
                    .pore_site(particle, model.case.method.section)
            };
            state.controls.gravity * water.at(site).pressure
        });
        let taken_over = given - (fields.pore_pressure[particle] + fields.excess[particle]);
        for axis in 0..3 {
            fields.sigma[particle][axis][axis] += taken_over;
        }
        fields.pore_pressure[particle] = given;
    }
    if !matches!(drainage, Drainage::Undrained { .. }) {
        let_water_out(fields, particle);
    }
}

/// Takes the excess pore pressure of a particle, and the rest of flow within its cell and in time.
fn let_water_out<const D: usize>(fields: &mut ParticleFields<D>, particle: usize) {
    fields.excess[particle] = 0.0;
    fields.excess_within_cell[particle] = 0.0;
    fields.water_rate[particle] = 0.0;
}

/// Gives a particle weight, strength and stiffness of a material; its stress stays, of which `stretch` makes that which goes with
/// the elastic strain (theory, eq. 15), and so does its memory of the law before.
fn become_soil_of<const D: usize>(
    (model, ground): (&Model<'_, D>, &Ground<D>),
    fields: &mut ParticleFields<D>,
    (particle, stretch): (usize, f64),
    (material, remembers): (usize, Option<(usize, History)>),
) -> Result<(), CaseError> {
    let case = model.case;
    let gravity = gravity_of_weights(case.gravity);
    let place = fields.x[particle];
    let soil = &case.materials[material];
    let before = model.laws[fields.law[particle]].stiffness_bound().young();
    let shared = (before / soil.young - 1.0).abs() > 1e-12;
    let mut ratios = soil.ratios_at(&place, ground);
    if shared {
        // In cells of several soils all have one stiffness, that of the cell.
        ratios.stiffness = 1.0;
    }
    fields.ratios[particle] = ratios;
    fields.ln_permeability_ratio[particle] = soil.permeability_ratio_at(&place, ground).ln();
    fields.mass[particle] =
        fields.volume0[particle] * soil.unit_weight_at(&place, ground) / gravity;
    let tau = fields.sigma[particle].map(|row| row.map(|stress| stress * stretch));
    let law = ScaledLaw::new(&*model.laws[fields.law[particle]], ratios)?;
    let mut history = law.initial_history(&principal_values::<D>(&tau));
    if let Some((law_before, old)) = remembers {
        let before = Remembered {
            variables: model.laws[law_before].internal_variables(),
            history: &old,
        };
        history = law.remembering(history, &before);
    }
    let axes = case.method.section.axes_looked_at::<D>();
    let history = directed_history::<D>(&law, &tau, history, axes);
    fields.internal[particle] = history.internal;
    fields.b_e[particle] = elastic_left_cauchy_green_of::<D>(&law, &tau, &history)?;
    Ok(())
}

/// The nodal forces that keep a changed state where it is \[N/m\].
fn holding<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    stage: usize,
) -> Result<Vec<[f64; D]>, CaseError> {
    let method = model.method(model.case.stages[stage].geometry);
    let conditions = model.conditions(&state.controls, &state.controls, 0.0)?;
    let particles = &state.body.particles;
    let stencils = Stencils::build_under(particles, &method, &conditions, &state.body.load_points)?;
    let structures = state.body.structures();
    let system = System::with_structures(particles, &structures, &stencils, &conditions, &method)?;
    let still = vec![[0.0; D]; system.node_count()];
    let trial = system.evaluate(&still, TangentKind::Elastic)?;
    Ok(system.holding_forces(&trial))
}

/// The warning where the ground has moved by more than a quarter of a cell around a body that is placed where the
/// case draws it.
fn moved_below<const D: usize>(
    model: &Model<'_, D>,
    start: &State<D>,
    body: usize,
) -> Option<String> {
    let part = &model.case.bodies[body];
    let cell = model.case.grid.smallest_cell();
    let (lower, upper) = part.region.bounds();
    let near = |x: &[f64; D]| {
        (0..D).all(|axis| (lower[axis] - cell[axis]..=upper[axis] + cell[axis]).contains(&x[axis]))
    };
    let particles = &start.body.particles;
    let moved = (0..particles.len())
        .filter(|&particle| near(&particles.x[particle]))
        .map(|particle| particles.displacement[particle][D - 1].abs())
        .fold(0.0, f64::max);
    (moved > 0.25 * cell[D - 1]).then(|| {
        format!(
            "\"{}\" is placed where it is drawn, but the ground around it has moved by up to {} m upwards or \
             downwards; draw it to the level that it is to be filled from, or set reset_displacements in the stage \
             before if that is meant",
            part.name,
            short(moved)
        )
    })
}
