//! The particles that the bodies of a case are seeded with.

use igimp_assembly::{ParticleSeed, Particles, SharedLaw};
use igimp_geometry::seed::fill;
use igimp_material::Ratios;
use igimp_model::{Case, laws_at_points};
use igimp_shape::Grid;

use crate::error::CaseError;
use crate::run::state::gravity_of_weights;
use crate::run::water::Seeded;

/// Particles of all bodies, and their seeds. Places with parameters of their own, and cells that several soils share, append
/// their laws.
pub(super) fn seeded<const D: usize>(
    case: &Case<D>,
    (grid, cell_height): (&Grid<D>, f64),
    laws: &mut Vec<SharedLaw>,
) -> Result<(Particles<D>, Seeded<D>), CaseError> {
    let ground = case.ground();
    let (mut seeds, body) = bodies_filled(case, grid)?;
    let ratios = |seed: &ParticleSeed<D>| case.materials[seed.law].ratios_at(&seed.x, &ground);
    let mut ratios: Vec<Ratios> = seeds.iter().map(ratios).collect();
    let parts = (&mut seeds[..], &body[..], &mut ratios[..]);
    laws_at_points(case, (grid, cell_height), parts, laws)?;
    let mut domain = Vec::new();
    if case.water.iter().any(|condition| condition.carried) {
        let boxes = seeds.iter().map(|seed| [seed.x, seed.half_length]);
        domain = boxes.collect();
    }
    let mut particles = Particles::new(&seeds)?
        .with_ratios(ratios)?
        .with_initial_histories(laws)?;
    if (case.materials.iter()).any(|material| material.profiles.permeability.is_some()) {
        let soil = |seed: &ParticleSeed<D>| case.material_of(seed.law);
        let ratio = |seed: &ParticleSeed<D>| soil(seed).permeability_ratio_at(&seed.x, &ground);
        let ratios: Vec<f64> = seeds.iter().map(ratio).collect();
        particles = particles.with_permeability_ratios(&ratios)?;
    }
    Ok((particles, Seeded { body, domain }))
}

/// The seeds of all bodies, one body after the other, and the body of each.
fn bodies_filled<const D: usize>(
    case: &Case<D>,
    grid: &Grid<D>,
) -> Result<(Vec<ParticleSeed<D>>, Vec<usize>), CaseError> {
    let gravity = gravity_of_weights(case.gravity);
    let ground = case.ground();
    let (mut seeds, mut body_of) = (Vec::new(), Vec::new());
    for (body, part) in case.bodies.iter().enumerate() {
        let material = &case.materials[part.material];
        let density = material.unit_weight / gravity;
        let parts = part.per_direction;
        let filled = fill(grid, &*part.region, parts, density, part.material);
        let mut body_seeds = filled.map_err(|error| error.of_body(&part.name))?;
        let section = case.method.section;
        for seed in &mut body_seeds {
            // A ring has the volume of its section times the way of its centroid.
            seed.volume *= section.thickness(seed.x[0] + seed.centroid[0] * seed.half_length[0]);
        }
        if material.profiles.unit_weight.is_some() {
            for seed in &mut body_seeds {
                seed.density = material.unit_weight_at(&seed.x, &ground) / gravity;
            }
        }
        body_of.extend(body_seeds.iter().map(|_| body));
        seeds.extend(body_seeds);
    }
    Ok((seeds, body_of))
}
