//! Fields along the sections of a case at the end of a stage.

use std::collections::HashMap;

use igimp_assembly::{AssemblyError, Particles, SharedLaw};
use igimp_shape::Grid;

use super::model::Model;
use super::state::State;
use crate::case::{Average, Case, Section};
use crate::measure::nearest;
use crate::results::fields;
use crate::results::pictures::file_name;
use crate::table::Table;

/// Number and name of a stage as part of a file name.
pub(super) fn stage_name(case: &Case, stage: usize) -> String {
    format!("{}-{}", stage + 1, file_name(&case.stages[stage].name))
}

/// Columns of a table before those of the recorded fields.
pub(super) const BEFORE_FIELDS: usize = 3;

/// One table per section, named `SECTION__STAGE`, with the foot of every place on the line; the share of
/// mobilised strength is that of the strength that acts.
///
/// Values are those of the particles nearest to equally spaced places along the line, each once, as the
/// particles hold them; places without a particle within a cell are left out. Or they are means over the
/// cells of the grid that the places lie in, of all particles there by their volume.
pub(crate) fn read(
    model: &Model<'_>,
    state: &State,
    stage: usize,
) -> Result<Vec<Table>, AssemblyError> {
    let case = model.case;
    let particles = &state.body.particles;
    let laws = model.laws_reduced_by(&state.controls.srf)?;
    let grid = model
        .grid(model.lowered(&state.controls))
        .map_err(|source| AssemblyError::Grid { source })?;
    let mut cells: Option<Cells> = None;
    let tables = case
        .sections
        .iter()
        .map(|section| {
            let mut header: Vec<String> = ["distance_[m]", "x_[m]", "y_[m]"]
                .map(str::to_owned)
                .to_vec();
            header.extend(section.record.iter().map(|&field| fields::header(field)));
            let mut table = Table {
                name: format!("{}__{}", section.name, stage_name(case, stage)),
                header,
                rows: Vec::new(),
            };
            let groups = match section.average {
                Average::None => nearest_to(case, section, particles),
                Average::Cell => {
                    let cells = cells.get_or_insert_with(|| Cells::new(&grid, particles));
                    cells.along(section, &grid)
                }
            };
            for group in groups {
                table.push(row(section, &group, (particles, &laws)));
            }
            table
        })
        .collect();
    Ok(tables)
}

/// A place along a section, as a share of its length.
fn place(section: &Section, k: usize) -> [f64; 2] {
    let t = (k as f64 + 0.5) / section.points as f64;
    [0, 1].map(|axis| section.from[axis] + t * (section.to[axis] - section.from[axis]))
}

/// The particles nearest to the places of a section.
fn nearest_to(case: &Case, section: &Section, particles: &Particles<2>) -> Vec<Vec<usize>> {
    let found = (0..section.points).filter_map(|k| {
        let place = place(section, k);
        let [width, height] = case.grid.cell_at(place);
        nearest(particles, &place, width.max(height))
    });
    let mut found: Vec<Vec<usize>> = found.map(|particle| vec![particle]).collect();
    found.dedup();
    found
}

/// The particles of the cells of a grid.
struct Cells(HashMap<[usize; 2], Vec<usize>>);

impl Cells {
    fn new(grid: &Grid<2>, particles: &Particles<2>) -> Self {
        let mut cells: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        for (particle, x) in particles.x.iter().enumerate() {
            if let Some(cell) = grid.cell_at(x) {
                cells.entry(cell).or_default().push(particle);
            }
        }
        Self(cells)
    }

    /// The particles of the cells that the places of a section lie in.
    fn along(&self, section: &Section, grid: &Grid<2>) -> Vec<Vec<usize>> {
        let cells = (0..section.points).filter_map(|k| grid.cell_at(&place(section, k)));
        let mut cells: Vec<[usize; 2]> = cells.collect();
        cells.dedup();
        let own = |cell: &[usize; 2]| self.0.get(cell).cloned();
        cells.iter().filter_map(own).collect()
    }
}

/// The mean over particles, by volume, as a row.
fn row(
    section: &Section,
    group: &[usize],
    (particles, laws): (&Particles<2>, &[SharedLaw]),
) -> Vec<f64> {
    let mean = |of: &dyn Fn(usize) -> f64| match group {
        &[only] => of(only),
        several => {
            let volume: f64 = several.iter().map(|&p| particles.volume(p)).sum();
            several
                .iter()
                .map(|&p| particles.volume(p) * of(p))
                .sum::<f64>()
                / volume
        }
    };
    let x = [0, 1].map(|axis| mean(&|p| particles.x[p][axis]));
    let way = [0, 1].map(|axis| section.to[axis] - section.from[axis]);
    let along = [0, 1].map(|axis| (x[axis] - section.from[axis]) * way[axis]);
    let mut row = vec![(along[0] + along[1]) / way[0].hypot(way[1]), x[0], x[1]];
    let values = section
        .record
        .iter()
        .map(|&field| mean(&|p| fields::value(field, particles, p, laws)));
    row.extend(values);
    row
}
