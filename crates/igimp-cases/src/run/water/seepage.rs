//! Steady seepage of a case: what is solved, and what is told of it.

use igimp_model::{Case, SeepageCase};
use igimp_results::summary::SetupTable;
use igimp_seepage::{Discharge, Seepage, SeepageBody, solve};
use igimp_text::short;

use crate::error::CaseError;
use crate::run::model::Model;

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

/// The flows of a model, with the names of their conditions.
pub(crate) fn flows<'m, const D: usize>(
    model: &'m Model<'_, D>,
) -> impl Iterator<Item = (&'m str, &'m Seepage<D>)> {
    let conditions = model.case.water.iter().enumerate();
    conditions.filter_map(|(index, own)| {
        let flow = model.ground_water(index)?.flow()?;
        Some((own.name.as_str(), &**flow))
    })
}

/// Tables of discharges, and of how flows were found; empty without computed seepage.
pub(crate) fn tables<const D: usize>(model: &Model<'_, D>) -> Vec<SetupTable> {
    let unit = if D == 2 { "m³/s per m" } else { "m³/s" };
    let (mut through, mut found) = (Vec::new(), Vec::new());
    for (name, flow) in flows(model) {
        through.extend(discharges(name, flow));
        found.push(vec![
            name.to_owned(),
            "as the case draws it".to_owned(),
            flow.unknowns.to_string(),
            flow.corrections.to_string(),
            format!("{:.1e}", flow.residual),
            if flow.confined {
                "all pores are full".to_owned()
            } else {
                format!("{} m, to {}", short(flow.width), short(flow.floor))
            },
        ]);
    }
    if found.is_empty() {
        return Vec::new();
    }
    let header = |own: &[&str]| own.iter().map(|&own| own.to_owned()).collect();
    vec![
        SetupTable {
            title: "Seepage: discharges".to_owned(),
            header: header(&[
                "Water",
                "Where",
                &format!("Enters the ground [{unit}]"),
                &format!("Leaves it [{unit}]"),
            ]),
            rows: through,
        },
        SetupTable {
            title: "Seepage: solution".to_owned(),
            header: header(&[
                "Water",
                "Ground",
                "Heads",
                "Corrections",
                "Largest imbalance over the flow",
                "Permeability falls over",
            ]),
            rows: found,
        },
    ]
}

fn discharges<const D: usize>(name: &str, flow: &Seepage<D>) -> Vec<Vec<String>> {
    let number = |value: f64| format!("{value:.4e}");
    let row = |place: &str, ends: [String; 2]| {
        let [enters, leaves] = ends;
        vec![name.to_owned(), place.to_owned(), enters, leaves]
    };
    let flows = |own: &&Discharge| own.inflow > 0.0 || own.outflow > 0.0;
    let mut rows: Vec<Vec<String>> = (flow.discharges.iter().filter(flows))
        .map(|own| row(&own.name, [own.inflow, own.outflow].map(number)))
        .collect();
    rows.push(row("all", [flow.inflow, flow.outflow].map(number)));
    if let Some(outflow) = flow.outflow_at_lower_floor {
        let place = format!("all, with a floor of {}", short(0.1 * flow.floor));
        rows.push(row(&place, [outflow, outflow].map(number)));
    }
    rows.extend(flow.sections.iter().map(|own| {
        let place = format!("section {}, towards the positive axis", own.name);
        row(&place, [number(own.inflow), String::new()])
    }));
    rows
}
