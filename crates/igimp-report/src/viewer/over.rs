//! Lines and surfaces over the frames of a stage: water tables, free surfaces of seepage, and the slip line or surface.
//!
//! Lines in the plane, rasters in space. `igimp view` and the frames of a report take them from here.

use std::fs;
use std::path::{Path, PathBuf};

use igimp_geometry::region::Region;
use igimp_model::{Case, PoreSource, SeepageCase, in_plane};
use igimp_results::tables::rows;
use igimp_seepage::{Extent, OnFaces};
use serde::Serialize;

use crate::pictures::file_name;
use crate::pictures::water::tables_after;

/// Places along each side of the plan at which the level of a water table in space is taken.
const PLACES: usize = 25;

/// A water table, a free surface, or where soil slips.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Surface {
    /// In the plane: points from left to right \[m\].
    Line(Vec<[f64; 2]>),
    /// In space: levels over the crossings of lines, by y and then x; null where there is none \[m\].
    Raster {
        /// Places along x \[m\].
        x: Vec<f64>,
        /// Places along y \[m\].
        y: Vec<f64>,
        /// Levels \[m\].
        z: Vec<Vec<Option<f64>>>,
    },
}

/// Lines and surfaces over the frames of a stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Over {
    /// The water at the end of the stage.
    pub water: Vec<Surface>,
    /// Where soil shears most as it begins to fail, of a search: a line, in space a surface.
    pub slip: Option<Surface>,
}

/// Lines and surfaces over the frames of every stage of a case, by the tables of its results folder as far as these are there.
pub fn by_stage<const D: usize>(case: &Case<D>, folder: &Path) -> Vec<Over> {
    let Ok(root) = fs::canonicalize(folder) else {
        return vec![Over::default(); case.stages.len()];
    };
    let stage = |stage: usize| {
        let mut water = tables(case, stage);
        water.extend(free_surface(case, stage, &root));
        let name = file_name(&case.stages[stage].name);
        let slip = table(&root, "slip_lines", &format!("{}-{name}", stage + 1));
        Over {
            water,
            slip: slip.map(|rows| slip_of::<D>(&rows)),
        }
    };
    (0..case.stages.len()).map(stage).collect()
}

/// The rows of a table of a results folder; none where it is not a plain file that stands there itself.
fn table(root: &Path, within: &str, name: &str) -> Option<Vec<Vec<f64>>> {
    let path: PathBuf = root.join(within).join(format!("{name}.csv"));
    let is_plain = fs::canonicalize(&path).is_ok_and(|real| real == path) && path.is_file();
    is_plain.then(|| rows::read(&path).ok().map(|read| read.rows))?
}

/// The slip line by the first two columns of its table, in space the surface by its three.
fn slip_of<const D: usize>(rows: &[Vec<f64>]) -> Surface {
    if D == 2 {
        let point = |row: &Vec<f64>| row.first_chunk::<2>().copied();
        return Surface::Line(rows.iter().filter_map(point).collect());
    }
    let point = |row: &Vec<f64>| row.first_chunk::<3>().map(|row| (*row, Some(row[2])));
    over_lines(&rows.iter().filter_map(point).collect::<Vec<_>>())
}

/// The water tables at the end of a stage.
fn tables<const D: usize>(case: &Case<D>, stage: usize) -> Vec<Surface> {
    if let Some(case) = in_plane::<Case<D>, Case<2>>(case) {
        let ends = [case.grid.lower()[0], case.grid.upper()[0]];
        let tables = tables_after(case, stage, ends).into_iter();
        return tables.map(|line| Surface::Line(line.points)).collect();
    }
    in_plane::<Case<D>, Case<3>>(case).map_or_else(Vec::new, |case| rasters(case, stage))
}

/// The free surface of the flow at the end of a stage, by its table, and the free water that stands over the ground.
fn free_surface<const D: usize>(case: &Case<D>, stage: usize, root: &Path) -> Vec<Surface> {
    let condition = case.water_after(stage);
    let Some((condition, water)) = condition.and_then(|k| Some((k, case.water.get(k)?))) else {
        return Vec::new();
    };
    let PoreSource::Seepage(flow) = &water.source else {
        return Vec::new();
    };
    let name = file_name(&format!("seepage-{}", water.name));
    let ground = Ground::new(case, condition, flow);
    let rows = table(root, "sections", &name).unwrap_or_default();
    let rows: Vec<([f64; D], Option<f64>)> = (rows.iter())
        .filter_map(|row| row.first_chunk::<D>())
        .map(|row| (*row, ground.level(row)))
        .collect();
    if D == 2 {
        let runs = rows.chunk_by(|a, b| a.1.is_some() == b.1.is_some());
        let line = |run: &[([f64; D], Option<f64>)]| {
            let points = run
                .iter()
                .filter_map(|(row, level)| Some([row[0], (*level)?]));
            points.collect::<Vec<_>>()
        };
        let lines = runs.map(line).filter(|line| line.len() > 1);
        return lines.map(Surface::Line).collect();
    }
    vec![over_lines(&rows)]
}

/// Levels over the crossings of lines.
fn over_lines<const D: usize>(rows: &[([f64; D], Option<f64>)]) -> Surface {
    let along = |axis: usize| {
        let mut places: Vec<f64> = rows.iter().map(|(row, _)| row[axis]).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    };
    let (x, y) = (along(0), along(1));
    let mut z = vec![vec![None; x.len()]; y.len()];
    for (row, level) in rows {
        let of = |places: &[f64], at: f64| places.partition_point(|&place| place < at);
        z[of(&y, row[1])][of(&x, row[0])] = *level;
    }
    Surface::Raster { x, y, z }
}

/// The ground that a flow goes through, with the free water on it.
struct Ground<'c, const D: usize> {
    bodies: Vec<&'c dyn Region<D>>,
    flow: &'c SeepageCase,
    lower: [f64; D],
    upper: [f64; D],
    /// A length that is taken for round-off \[m\].
    reach: f64,
}

impl<'c, const D: usize> Ground<'c, D> {
    fn new(case: &'c Case<D>, condition: usize, flow: &'c SeepageCase) -> Self {
        let (lower, upper) = (case.grid.lower(), case.grid.upper());
        let size = (0..D).fold(0.0_f64, |most, k| most.max(upper[k] - lower[k]));
        let bodies = case.bodies_of_water(condition).into_iter();
        Self {
            bodies: bodies.map(|(body, _)| body).collect(),
            flow,
            lower,
            upper,
            reach: 1e-6 * size,
        }
    }

    /// The level of the free surface at a place whose computed one is its last coordinate \[m\]. Above the ground the heads of the
    /// nearest soil go on and say nothing: there it is that of the free water; none where there is no water, or no ground.
    fn level(&self, row: &[f64; D]) -> Option<f64> {
        let mut place = *row;
        for k in 0..D - 1 {
            place[k] = row[k].clamp(self.lower[k] + self.reach, self.upper[k] - self.reach);
        }
        let tops = self.bodies.iter().filter_map(|body| body.top(&place));
        let top = tops.reduce(f64::max)?;
        if row[D - 1] <= top + self.reach {
            return Some(row[D - 1]);
        }
        place[D - 1] = top;
        self.free_water(&place).filter(|level| *level > top)
    }

    /// The level of the free water over a place on the ground \[m\].
    fn free_water(&self, place: &[f64; D]) -> Option<f64> {
        let table = self.flow.free_water.as_ref();
        if let Some(level) = table.and_then(|source| source.table(place)) {
            return Some(level);
        }
        // Of several boxes that hold a face the last counts.
        let faces = &self.flow.conditions.faces;
        let holds = |axis: usize, within: &Extent<3>| {
            within.lower[axis] - self.reach <= place[axis]
                && place[axis] <= within.upper[axis] + self.reach
        };
        let last = (0..faces.len()).rfind(|&k| (0..D).all(|axis| holds(axis, &faces[k].within)))?;
        let OnFaces::Head(head) = faces[last].condition else {
            return None;
        };
        let moment = self.flow.in_time.as_ref();
        let history = moment.and_then(|m| Some(m.histories.get(last)?.as_ref()?.at(m.time)));
        Some(history.unwrap_or(head))
    }
}

/// Water tables in space at the end of a stage; bodies that are there and have a table of their own show it over their plan.
fn rasters(case: &Case<3>, stage: usize) -> Vec<Surface> {
    let Some(condition) = case.water_after(stage).and_then(|k| case.water.get(k)) else {
        return Vec::new();
    };
    let there = case.bodies_after(stage);
    let local = condition.bodies.iter().filter(|(body, _)| there[*body]);
    let local = local.map(|(body, source)| (source, case.bodies[*body].region.bounds()));
    let plan = (case.grid.lower(), case.grid.upper());
    std::iter::once((&condition.source, plan))
        .chain(local)
        .filter_map(|(source, plan)| raster(source, plan))
        .collect()
}

/// A water table over a plan; none where no place of it has a level.
fn raster(source: &PoreSource, (lower, upper): ([f64; 3], [f64; 3])) -> Option<Surface> {
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
    let z: Vec<_> = y.iter().map(row).collect();
    let is_there = z.iter().flatten().any(Option::is_some);
    is_there.then_some(Surface::Raster { x, y, z })
}
