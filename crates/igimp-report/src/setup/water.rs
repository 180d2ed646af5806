//! Conditions of the water, and the drainage of soil, as tables.

use igimp_model::{Case, Drainage, Material, PoreSource, StageKind, WaterCondition};
use igimp_results::summary::SetupTable;
use igimp_text::short;

use super::{NONE, kilo, point, table};

/// Most points of a line that are listed one by one.
const MOST_POINTS: usize = 12;

/// The conditions of the water.
pub(super) fn conditions<const D: usize>(case: &Case<D>) -> SetupTable {
    let rows = case.water.iter().enumerate();
    let rows = rows.map(|(index, water)| condition(case, index, water));
    let header = [
        "Water",
        "Pore pressure",
        "Bodies with their own",
        "In force",
        "Unit weight [kN/m³]",
    ];
    table("Water", &header, rows.collect())
}

fn condition<const D: usize>(case: &Case<D>, index: usize, water: &WaterCondition) -> Vec<String> {
    let mut pressure = source::<D>(&water.source);
    if water.carried {
        pressure.push_str("; carried along by the soil");
    }
    let bodies = water.bodies.iter();
    let bodies: Vec<String> = bodies
        .map(|(body, pores)| format!("{}: {}", case.bodies[*body].name, source::<D>(pores)))
        .collect();
    let calls = case.stages.iter().filter(
        |stage| matches!(&stage.kind, StageKind::Construction(works) if works.water == Some(index)),
    );
    let start = (index == 0).then(|| "from the start".to_owned());
    let calls = calls.map(|stage| format!("from stage {} on", stage.name));
    let force: Vec<String> = start.into_iter().chain(calls).collect();
    let or_none = |list: &[String]| match list {
        [] => NONE.to_owned(),
        list => list.join("; "),
    };
    vec![
        water.name.clone(),
        pressure,
        or_none(&bodies),
        or_none(&force),
        short(case.water_unit_weight / 1e3),
    ]
}

fn source<const D: usize>(pores: &PoreSource) -> String {
    match pores {
        PoreSource::Dry => "dry".to_owned(),
        PoreSource::Points(raster) => {
            let values = raster.values.iter().flatten().copied();
            format!(
                "up to {} kPa by a raster of {} by {} points",
                short(values.fold(0.0, f64::max) / 1e3),
                raster.x.len(),
                raster.y.len()
            )
        }
        PoreSource::Seepage(flow) => {
            let when = match &flow.in_time {
                Some(transient) => format!("after {} s", short(transient.time)),
                None => "steady".to_owned(),
            };
            let conditions = &flow.conditions;
            let kind = if conditions.confined {
                "confined flow"
            } else {
                "flow with a free surface"
            };
            format!(
                "computed: {kind}, {when}, {} conditions on faces, {} regions",
                conditions.faces.len(),
                conditions.regions.len()
            )
        }
        PoreSource::Surface(terrain) => {
            let (lower, upper) = terrain.bounds();
            format!(
                "table by a surface from z = {} m to {} m",
                short(lower[2]),
                short(upper[2])
            )
        }
        PoreSource::Drained(drained) => format!(
            "table level at z = {} m within the ground, along its surface, and at z = {} m outside",
            short(drained.inside()),
            short(drained.outside())
        ),
        PoreSource::Ratio(ratio) => format!("r_u = {}", short(*ratio)),
        PoreSource::Table(points) => match points.as_slice() {
            [only] => {
                let up = if D == 2 { "y" } else { "z" };
                format!("table level at {up} = {} m", short(only[1]))
            }
            points if points.len() <= MOST_POINTS => {
                let points: Vec<String> = points.iter().map(|&at| point(at)).collect();
                format!("table through {} m", points.join(" "))
            }
            points => format!("table through {} points", points.len()),
        },
    }
}

/// The drainage of the materials; empty without water and without soil that generates pore pressure.
pub(super) fn soils<const D: usize>(case: &Case<D>) -> SetupTable {
    let is_undrained = |soil: &Material| matches!(soil.drainage, Drainage::Undrained { .. });
    let is_shown = !case.water.is_empty() || case.materials.iter().any(is_undrained);
    let soils = case.materials.iter().filter(|_| is_shown);
    let rows = soils.map(|soil| {
        let drainage = match soil.drainage {
            Drainage::Drained => "drained; strength by effective stress".to_owned(),
            Drainage::Undrained { stiffness, flows } => format!(
                "{}; strength by effective stress, water of K_w/n = {}{}",
                if flows { "coupled" } else { "undrained" },
                kilo(stiffness.modulus, "Pa"),
                soil.permeability
                    .filter(|_| flows)
                    .map_or_else(String::new, |k| format!(", k = {} m/s", short(k.along)))
            ),
            Drainage::Total => "strength by total stress".to_owned(),
        };
        let saturated = soil.saturated.unwrap_or(soil.unit_weight);
        vec![soil.name.clone(), short(saturated / 1e3), drainage]
    });
    let header = [
        "Material",
        "Unit weight below the table [kN/m³]",
        "Drainage",
    ];
    table("Soil and water", &header, rows.collect())
}
