//! Steady seepage of a case: what is solved.

use igimp_model::{Case, SeepageCase};
use igimp_seepage::{Seepage, SeepageBody, solve};

use crate::error::CaseError;

/// Solves for the flow of the condition of that index, in the ground as the case draws it.
pub(super) fn solved<const D: usize>(
    case: &Case<D>,
    condition: usize,
    own: &SeepageCase,
) -> Result<Seepage<D>, CaseError> {
    let water = || case.water[condition].name.clone();
    let bodies = case.bodies_of_water(condition);
    for (_, material) in &bodies {
        let material = &case.materials[*material];
        if material.permeability.is_none() {
            return Err(CaseError::NoPermeability {
                water: water(),
                material: material.name.clone(),
            });
        }
    }
    let bodies: Vec<SeepageBody<'_, D>> = (bodies.into_iter())
        .map(|(region, soil)| SeepageBody { region, soil })
        .collect();
    let free = |place: &[f64; D]| {
        let level = own.free_water.as_ref()?.table(place)?;
        level.is_finite().then_some(level)
    };
    let conditions = own.with_soils(&case.materials);
    solve(&case.grid.grid()?, &bodies, &conditions, &free).map_err(|source| CaseError::Seepage {
        water: water(),
        source,
    })
}
