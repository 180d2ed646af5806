//! Fields along the sections of a case at the end of a stage.

use std::collections::HashMap;

use igimp_assembly::{AssemblyError, Particles, SharedLaw};
use igimp_model::{Average, Case, Cut, Section};
use igimp_report::pictures::file_name;
use igimp_results::fields;
use igimp_results::measure::{nearest, place::Place};
use igimp_results::tables::table::Table;
use igimp_shape::Grid;

use crate::run::model::Model;
use crate::run::state::State;

/// A plane lies on the end of a domain up to this share of its size \[-\].
const AT_FACE: f64 = 1e-6;

/// Number and name of a stage as part of a file name.
pub(crate) fn stage_name<const D: usize>(case: &Case<D>, stage: usize) -> String {
    format!("{}-{}", stage + 1, file_name(&case.stages[stage].name))
}

/// Columns of a table before those of the recorded fields: the distance and the coordinates.
pub(crate) const fn before_fields<const D: usize>() -> usize {
    D + 1
}

/// One table per section, named `SECTION__STAGE`, with the foot of every place on the line; the share of
/// mobilised strength is that of the strength that acts.
///
/// Values are those at the feet, on the line, of the particles nearest to equally spaced places along it, each once,
/// carried there from the particles and cells around; places without a particle within a cell are left out. Or they are means over the
/// cells of the grid that the places lie in, of all particles there by their volume.
pub(crate) fn read<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    stage: usize,
) -> Result<Vec<Table>, AssemblyError> {
    let case = model.case;
    let particles = &state.body.particles;
    let laws = model.laws_reduced_by(&state.controls.srf)?;
    let grid = model
        .grid(model.lowered(&state.controls))
        .map_err(|source| AssemblyError::Grid { source })?;
    let mut cells: Option<Cells<D>> = None;
    let tables = case
        .sections
        .iter()
        .map(|section| {
            let places = ["x_[m]", "y_[m]", "z_[m]"].into_iter().take(D);
            let mut header: Vec<String> = std::iter::once("distance_[m]")
                .chain(places)
                .map(str::to_owned)
                .collect();
            header.extend(section.record.iter().map(|&field| field.header()));
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
                table.push(row((case, section), &group, particles, (&laws, &grid)));
            }
            table
        })
        .collect();
    Ok(tables)
}

/// One table per plane that the case states in space, named `cut-AXIS-PLACE__STAGE`: the particles whose domains the plane
/// crosses, with the fields that are drawn.
pub(crate) fn planes<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    stage: usize,
) -> Result<Vec<Table>, AssemblyError> {
    let case = model.case;
    let particles = &state.body.particles;
    let wanted = &case.output.figures;
    if wanted.is_empty() || case.output.cuts.is_empty() {
        return Ok(Vec::new());
    }
    let laws = model.laws_reduced_by(&state.controls.srf)?;
    let places = ["x_[m]", "y_[m]", "z_[m]"].into_iter().take(D);
    let fields = wanted.iter().map(|&field| field.header());
    let header: Vec<String> = places.map(str::to_owned).chain(fields).collect();
    let table = |cut: &Cut| {
        let crossed = crossed(particles, cut);
        let row = |k: usize| {
            let values = wanted.iter();
            let values = values.map(|&field| fields::value(field, particles, k, &laws));
            particles.x[k].iter().copied().chain(values).collect()
        };
        Table {
            name: format!("{}__{}", cut.name(), stage_name(case, stage)),
            header: header.clone(),
            rows: crossed.into_iter().map(row).collect(),
        }
    };
    Ok(case.output.cuts.iter().map(table).collect())
}

/// The particles whose domains a plane crosses. One between two domains crosses the upper one, and at the end of the soil the
/// last.
fn crossed<const D: usize>(particles: &Particles<D>, cut: &Cut) -> Vec<usize> {
    let ends = |k: usize| {
        let (x, half) = (particles.x[k][cut.axis], particles.half_length[k][cut.axis]);
        [x - half, x + half]
    };
    let within = |&k: &usize| ends(k)[0] <= cut.at && cut.at < ends(k)[1];
    let found: Vec<usize> = (0..particles.len()).filter(within).collect();
    if !found.is_empty() {
        return found;
    }
    let ends_there = |&k: &usize| {
        let [lower, upper] = ends(k);
        (upper - cut.at).abs() <= AT_FACE * (upper - lower)
    };
    (0..particles.len()).filter(ends_there).collect()
}

/// A place along a section, as a share of its length.
fn place<const D: usize>(section: &Section<D>, k: usize) -> [f64; D] {
    let t = (k as f64 + 0.5) / section.points as f64;
    std::array::from_fn(|axis| section.from[axis] + t * (section.to[axis] - section.from[axis]))
}

/// The particles nearest to the places of a section.
fn nearest_to<const D: usize>(
    case: &Case<D>,
    section: &Section<D>,
    particles: &Particles<D>,
) -> Vec<Vec<usize>> {
    let found = (0..section.points).filter_map(|k| {
        let place = place(section, k);
        let reach = case.grid.cell_at(place).into_iter().fold(0.0, f64::max);
        nearest(particles, &place, reach)
    });
    let mut found: Vec<Vec<usize>> = found.map(|particle| vec![particle]).collect();
    found.dedup();
    found
}

/// The particles of the cells of a grid.
struct Cells<const D: usize>(HashMap<[usize; D], Vec<usize>>);

impl<const D: usize> Cells<D> {
    fn new(grid: &Grid<D>, particles: &Particles<D>) -> Self {
        let mut cells: HashMap<[usize; D], Vec<usize>> = HashMap::new();
        for (particle, x) in particles.x.iter().enumerate() {
            if let Some(cell) = grid.cell_at(x) {
                cells.entry(cell).or_default().push(particle);
            }
        }
        Self(cells)
    }

    /// The particles of the cells that the places of a section lie in.
    fn along(&self, section: &Section<D>, grid: &Grid<D>) -> Vec<Vec<usize>> {
        let cells = (0..section.points).filter_map(|k| grid.cell_at(&place(section, k)));
        let mut cells: Vec<[usize; D]> = cells.collect();
        cells.dedup();
        let inside = |cell: &[usize; D]| self.0.get(cell).cloned();
        cells.iter().filter_map(inside).collect()
    }
}

/// A row: at the foot of a particle on the line, or the mean over several particles, by volume.
fn row<const D: usize>(
    (case, section): (&Case<D>, &Section<D>),
    group: &[usize],
    particles: &Particles<D>,
    (laws, grid): (&[SharedLaw], &Grid<D>),
) -> Vec<f64> {
    let way: [f64; D] = std::array::from_fn(|axis| section.to[axis] - section.from[axis]);
    let length = fields::length(&way);
    // How far along the line a point stands.
    let along = |x: &[f64; D]| -> f64 {
        let parts = (0..D).map(|axis| (x[axis] - section.from[axis]) * way[axis]);
        parts.sum::<f64>() / length
    };
    let value = |field, p: usize| fields::value(field, particles, p, laws);
    let recorded = section.record.iter();
    match (section.average, group) {
        (Average::None, &[only]) => {
            let distance = along(&particles.x[only]);
            let foot: [f64; D] =
                std::array::from_fn(|axis| section.from[axis] + distance / length * way[axis]);
            let place = Place::near(particles, only, &foot, case.materials.len());
            let values = recorded.map(|&field| place.field(field, particles, laws, grid));
            std::iter::once(distance)
                .chain(foot)
                .chain(values)
                .collect()
        }
        (_, several) => {
            let volume: f64 = several.iter().map(|&p| particles.volume(p)).sum();
            let mean = |of: &dyn Fn(usize) -> f64| match several {
                &[only] => of(only),
                several => {
                    several
                        .iter()
                        .map(|&p| particles.volume(p) * of(p))
                        .sum::<f64>()
                        / volume
                }
            };
            let x: [f64; D] = std::array::from_fn(|axis| mean(&|p| particles.x[p][axis]));
            let values = recorded.map(|&field| mean(&|p| value(field, p)));
            std::iter::once(along(&x)).chain(x).chain(values).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::case;

    /// GOAL: a plane on the upper face of soil crosses its last particles, and one beside the soil none.
    /// ORACLE: the lower face, the mirror image: a row of 8 particles of a block of 4 by 4 cells.
    #[test]
    fn a_plane_on_a_face_crosses_the_particles_there() {
        let case = case();
        let (_, state) = Model::new(&case).unwrap();
        let at = |at: f64| crossed(&state.body.particles, &Cut { axis: 1, at }).len();
        assert_eq!([0.0, 0.9, 1.0, 2.0].map(at), [8; 4]);
        assert_eq!([-0.1, 2.1].map(at), [0; 2]);
    }
}
