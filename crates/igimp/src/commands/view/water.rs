//! Water tables and free surfaces of seepage by stage, as the page draws them: lines in the plane, rasters in space.

use std::path::{Path, PathBuf};

use igimp_model::{AnyCase, Case, PoreSource};
use igimp_report::pictures::file_name;
use igimp_report::pictures::water::tables_after;
use igimp_results::tables::rows;
use serde_json::{Value, json};

/// Places along each side of the plan at which the level of a water table in space is taken.
const PLACES: usize = 25;

/// The water of every stage at its end. `section` finds a table of sections by its file name.
pub(super) fn by_stage(
    case: &AnyCase,
    section: &dyn Fn(&str) -> Option<PathBuf>,
) -> Vec<Vec<Value>> {
    match case {
        AnyCase::Plane(case) => {
            let ends = [case.grid.lower()[0], case.grid.upper()[0]];
            of_stages(case, section, &|stage| {
                let tables = tables_after(case, stage, ends).into_iter();
                tables.map(|table| json!(table.points)).collect()
            })
        }
        AnyCase::Space(case) => of_stages(case, section, &|stage| rasters(case, stage)),
    }
}

/// Tables and the free surface of each stage.
fn of_stages<const D: usize>(
    case: &Case<D>,
    section: &dyn Fn(&str) -> Option<PathBuf>,
    tables: &dyn Fn(usize) -> Vec<Value>,
) -> Vec<Vec<Value>> {
    let surface = |stage| {
        let condition = case.water.get(case.water_after(stage)?)?;
        let PoreSource::Seepage(_) = condition.source else {
            return None;
        };
        let name = file_name(&format!("seepage-{}", condition.name));
        free_surface::<D>(&section(&format!("{name}.csv"))?)
    };
    (0..case.stages.len())
        .map(|stage| tables(stage).into_iter().chain(surface(stage)).collect())
        .collect()
}

/// The free surface of a flow by its table: a line in the plane, a raster in space.
fn free_surface<const D: usize>(path: &Path) -> Option<Value> {
    let rows = rows::read(path).ok()?.rows;
    if D == 2 {
        return Some(json!(rows));
    }
    let along = |axis: usize| {
        let mut places: Vec<f64> = rows.iter().map(|row| row[axis]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    };
    let (x, y) = (along(0), along(1));
    let mut levels = vec![vec![None; x.len()]; y.len()];
    for row in &rows {
        let of = |places: &[f64], at: f64| places.partition_point(|&own| own < at);
        levels[of(&y, row[1])][of(&x, row[0])] = Some(row[2]);
    }
    Some(json!({ "x": x, "y": y, "z": levels }))
}

/// Water tables in space at the end of a stage; bodies that are there and have a table of their own show it over their plan.
fn rasters(case: &Case<3>, stage: usize) -> Vec<Value> {
    let Some(condition) = case.water_after(stage).and_then(|k| case.water.get(k)) else {
        return Vec::new();
    };
    let there = case.bodies_after(stage);
    let own = condition.bodies.iter().filter(|(body, _)| there[*body]);
    let own = own.map(|(body, source)| (source, case.bodies[*body].region.bounds()));
    let plan = (case.grid.lower(), case.grid.upper());
    std::iter::once((&condition.source, plan))
        .chain(own)
        .filter_map(|(source, plan)| raster(source, plan))
        .collect()
}

/// A water table over a plan; none where no place of it has a level.
fn raster(source: &PoreSource, (lower, upper): ([f64; 3], [f64; 3])) -> Option<Value> {
    let along = |axis: usize| -> Vec<f64> {
        let size = upper[axis] - lower[axis];
        let place = |k: usize| lower[axis] + size * k as f64 / (PLACES - 1) as f64;
        (0..PLACES).map(place).collect()
    };
    let (x, y) = (along(0), along(1));
    let level = |x: f64, y: f64| {
        let level = source.table(&[x, y, 0.0])?;
        level.is_finite().then_some(level)
    };
    let row = |&y: &f64| -> Vec<Option<f64>> { x.iter().map(|&x| level(x, y)).collect() };
    let levels: Vec<_> = y.iter().map(row).collect();
    let is_there = levels.iter().flatten().any(Option::is_some);
    is_there.then(|| json!({ "x": x, "y": y, "z": levels }))
}
