//! The stresses of level ground: the weight above, and K₀ times that sideways (theory, eqs. 36, 36c
//! and 37).

use igimp_assembly::{Particles, PoreWater as _};
use igimp_material::{ConstitutiveModel, MaterialError, directed_history};

use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::state::State;

/// Sets the stresses of level ground under full gravity in an undeformed body; where gravity is 0 there are none.
///
/// The vertical stress is the weight of the ground above a particle, layer by layer, less the pressure of water in the
/// pores where the law speaks of effective stress; the horizontal ones are K₀ times that. Water that stands on soil of total stress presses
/// on it in all directions alike. The elastic strain follows from the stress, so that the
/// state is what the law would have returned; deformation counts from here.
pub(crate) fn level_ground<const D: usize>(
    model: &Model<'_, D>,
    state: &mut State<D>,
) -> Result<(), CaseError> {
    let case = model.case;
    state.controls.gravity = 1.0;
    if case.gravity <= 0.0 {
        return Ok(());
    }
    let ground = case.ground();
    let water = state.controls.water.and_then(|k| model.ground_water(k));
    let mut fields = (*state.body.particles).clone();
    for particle in 0..fields.x.len() {
        let x = fields.x[particle];
        let material = &*case.material_of(fields.law[particle]).at(&x, &ground);
        let number = fields.number[particle];
        let [vertical, pond] = match &water {
            None => [-ground.weight_above(&x), 0.0],
            Some(water) => water.at_rest(&ground, number, material, &x),
        };
        let k0 = material
            .k0
            .unwrap_or(material.poisson / (1.0 - material.poisson));
        let mut sigma = [k0 * vertical + pond; 3];
        sigma[D - 1] = vertical + pond;
        let tensor =
            std::array::from_fn(|a| std::array::from_fn(|b| if a == b { sigma[a] } else { 0.0 }));
        let answer = |law: &dyn ConstitutiveModel| {
            let axes = case.method.section.axes_looked_at::<D>();
            let history = directed_history::<D>(law, &tensor, law.initial_history(&sigma), axes);
            let excess = law.yield_function(&sigma, &history);
            let is_admissible = excess <= 1e-9 * law.stress_scale(&sigma);
            let strain = is_admissible.then(|| law.elastic_strain(&sigma, &history));
            Ok::<_, MaterialError>(strain.transpose()?.map(|strain| (strain, history)))
        };
        let strain = state
            .body
            .particles
            .ask_law(particle, &model.laws, answer)??;
        let Some((strain, history)) = strain else {
            return Err(CaseError::InitialStress {
                material: material.name.clone(),
                position: x.to_vec(),
                k0,
            });
        };
        if let Some(water) = &water {
            let site = state
                .body
                .particles
                .pore_site(particle, model.case.method.section);
            // At full gravity, as the stress.
            fields.pore_pressure[particle] = water.at(site).pressure;
        }
        fields.internal[particle] = history.internal;
        for axis in 0..3 {
            fields.sigma[particle][axis][axis] = sigma[axis];
            fields.b_e[particle][axis][axis] = (2.0 * strain[axis]).exp();
        }
    }
    state.body.particles = Particles::from_fields(fields)?;
    Ok(())
}
