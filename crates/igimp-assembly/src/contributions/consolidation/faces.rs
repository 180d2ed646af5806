//! Where water leaves: free faces of soil, open sides of the grid, drained soil beside, and drains (theory, eq. 102).
//!
//! Faces are those of the particles' domains towards cells without soil, wherever they lie in their own cell.

use igimp_shape::{Grid, cell_parts};

use crate::body::particles::Particles;
use crate::conditions::StepConditions;
use crate::conditions::pore_flow::{Consolidating, PoreFlow};
use crate::error::AssemblyError;
use crate::method::{Method, Section};
use crate::step::domain::{capped_half_length, off_grid};

/// Cells that soil fills to less than this share are empty \[-\].
const EMPTY: f64 = 1e-6;

/// Soil closer to a side of the grid than this share of a cell touches it \[-\].
const GAP: f64 = 0.02;

/// Points of Gauss along a side of a face, from its middle, over its half-length.
const ALONG: [f64; 2] = [-0.577_350_269_189_625_8, 0.577_350_269_189_625_8];

/// Soil closer to a rigid body than this share of a cell has no free face there \[-\].
const NEAR_BODY: f64 = 0.5;

/// Drains take domains of which they have half to within this share \[-\].
const ROUND_OFF: f64 = 1e-9;

/// A place where water leaves in proportion to its excess pressure.
#[derive(Clone, Debug)]
pub(crate) struct Opening {
    /// Nodes of the grid with their shares of the pressure there.
    pub(crate) values: Vec<(usize, f64)>,
    /// Water that leaves during the step by pressure, as easily as through a cell \[length^D·length²/force\].
    pub(crate) conductance: f64,
}

/// The soil in a cell.
#[derive(Clone, Copy, Debug)]
struct CellOfSoil<const D: usize> {
    volume: f64,
    /// Ends of the soil in it, from 0 to 1 along each axis.
    lower: [f64; D],
    upper: [f64; D],
    /// Permeability over the unit weight of water of soil that water flows through, by its volume.
    seeping: f64,
    mobility: [f64; D],
}

/// All places where water leaves during a step.
///
/// # Errors
/// [`AssemblyError::Shape`] names a particle whose centre left the grid.
pub(crate) fn openings<const D: usize>(
    particles: &Particles<D>,
    (conditions, method): (&StepConditions<D>, &Method),
    flow: &Consolidating<D>,
    near_body: &dyn Fn(&[f64; D], f64) -> bool,
) -> Result<Vec<Opening>, AssemblyError> {
    let grid = &conditions.grid;
    let mut cells: Vec<Option<CellOfSoil<D>>> = vec![None; grid.cell_count()];
    let mut all = Vec::new();
    let most = (flow.soils.iter())
        .filter_map(|soil| match soil {
            PoreFlow::Flows(soil) => (0..D).map(|a| soil.mobility[a][a]).reduce(f64::max),
            _ => None,
        })
        .fold(0.0, f64::max);
    let mut parts = Vec::new();
    for particle in 0..particles.len() {
        let law = particles.law[particle];
        let x = particles.x[particle];
        let half_length = capped_half_length(grid, &x, particles.half_length[particle]);
        parts.clear();
        cell_parts(grid, &*method.basis, &x, &half_length, &mut parts)
            .map_err(|source| off_grid(particle, &x, source))?;
        let volume = particles.volume(particle);
        let soil = flow.permeable(law);
        let in_drain = drained_share(flow, &x, &half_length);
        let leaks = match flow.soils.get(law) {
            Some(PoreFlow::Drained) => Some((1.0, most)),
            _ => soil.filter(|_| in_drain > 0.0).map(|soil| {
                let mobility = (0..D).map(|a| soil.mobility[a][a]).fold(0.0, f64::max);
                (in_drain, mobility)
            }),
        };
        for part in &parts {
            let size = grid.cell_size(part.cell);
            let cell = cells[grid.cell_index(part.cell)].get_or_insert(CellOfSoil {
                volume: 0.0,
                lower: [1.0; D],
                upper: [0.0; D],
                seeping: 0.0,
                mobility: [0.0; D],
            });
            let part_volume = volume * part.share;
            cell.volume += part_volume;
            let origin = grid.node_position(grid.node_index(part.cell));
            for axis in 0..D {
                let end = |sign: f64| {
                    let at = x[axis] + sign * half_length[axis] - origin[axis];
                    (at / size[axis]).clamp(0.0, 1.0)
                };
                cell.lower[axis] = cell.lower[axis].min(end(-1.0));
                cell.upper[axis] = cell.upper[axis].max(end(1.0));
            }
            if let Some(soil) = soil {
                cell.seeping += part_volume;
                for axis in 0..D {
                    cell.mobility[axis] += part_volume * soil.mobility[axis][axis];
                }
            }
            if let Some((share, mobility)) = leaks {
                let side = size.into_iter().fold(f64::INFINITY, f64::min);
                let tents = grid.tents(part.cell, part.middle);
                all.push(Opening {
                    values: tents.map(|(node, value, _)| (node, value)).collect(),
                    conductance: flow.duration * share * part_volume * mobility / side.powi(2),
                });
            }
        }
    }
    let of_step = (flow, method.section);
    free_faces(grid, &cells, of_step, near_body, &mut all);
    Ok(all)
}

/// Adds the openings at free faces of soil and at open sides of the grid.
fn free_faces<const D: usize>(
    grid: &Grid<D>,
    cells: &[Option<CellOfSoil<D>>],
    (flow, section): (&Consolidating<D>, Section),
    near_body: &dyn Fn(&[f64; D], f64) -> bool,
    all: &mut Vec<Opening>,
) {
    for (index, cell) in cells.iter().enumerate() {
        let Some(cell) = cell.filter(|cell| cell.seeping > 0.0) else {
            continue;
        };
        let place = grid.cell_place(index);
        for axis in 0..D {
            for is_upper in [false, true] {
                let is_open = match neighbour(grid, place, axis, is_upper) {
                    None if touches(&cell, axis, is_upper) => {
                        flow.open_sides.contains(&(axis, is_upper))
                    }
                    None => flow.open_faces,
                    Some(beyond) => {
                        let size: f64 = grid.cell_size(beyond).iter().product();
                        let radius = grid.node_position(grid.node_index(beyond))[0]
                            + 0.5 * grid.cell_size(beyond)[0];
                        let whole = size * section.thickness(radius);
                        let soil = cells[grid.cell_index(beyond)];
                        flow.open_faces && soil.is_none_or(|soil| soil.volume < EMPTY * whole)
                    }
                };
                if is_open {
                    let flow = (flow, section);
                    face(grid, (place, &cell), (axis, is_upper), flow, near_body, all);
                }
            }
        }
    }
}

/// Whether the soil of a cell reaches its side.
fn touches<const D: usize>(cell: &CellOfSoil<D>, axis: usize, is_upper: bool) -> bool {
    if is_upper {
        cell.upper[axis] > 1.0 - GAP
    } else {
        cell.lower[axis] < GAP
    }
}

/// The cell behind a side, within the grid.
fn neighbour<const D: usize>(
    grid: &Grid<D>,
    mut place: [usize; D],
    axis: usize,
    is_upper: bool,
) -> Option<[usize; D]> {
    place[axis] = if is_upper {
        let next = place[axis] + 1;
        (next < grid.axes[axis].cell_count()).then_some(next)?
    } else {
        place[axis].checked_sub(1)?
    };
    Some(place)
}

/// Adds the openings of the face of the soil of a cell towards a side.
fn face<const D: usize>(
    grid: &Grid<D>,
    (place, cell): ([usize; D], &CellOfSoil<D>),
    (axis, is_upper): (usize, bool),
    (flow, section): (&Consolidating<D>, Section),
    near_body: &dyn Fn(&[f64; D], f64) -> bool,
    all: &mut Vec<Opening>,
) {
    let size = grid.cell_size(place);
    let origin = grid.node_position(grid.node_index(place));
    let mut area = 1.0;
    for other in (0..D).filter(|&other| other != axis) {
        area *= (cell.upper[other] - cell.lower[other]) * size[other];
    }
    let points = ALONG.len().pow(D as u32 - 1);
    for point in 0..points {
        let mut rest = point;
        let within: [f64; D] = std::array::from_fn(|other| {
            if other == axis {
                return if is_upper {
                    cell.upper[axis]
                } else {
                    cell.lower[axis]
                };
            }
            let along = ALONG[rest % ALONG.len()];
            rest /= ALONG.len();
            let (lower, upper) = (cell.lower[other], cell.upper[other]);
            0.5 * (lower + upper + along * (upper - lower))
        });
        let x: [f64; D] = std::array::from_fn(|a| origin[a] + within[a] * size[a]);
        if near_body(&x, NEAR_BODY * size[axis]) {
            continue;
        }
        let mobility = cell.mobility[axis] / cell.seeping;
        let tents = grid.tents(place, within);
        all.push(Opening {
            values: tents.map(|(node, value, _)| (node, value)).collect(),
            conductance: flow.duration * mobility * area * section.thickness(x[0])
                / (points as f64 * size[axis]),
        });
    }
}

/// The share of a domain that drains take, at most 1 \[-\]. A side of a drain takes a domain along with it that lies in it by half, or
/// that has half of the drain: soil that a drain merely touches would drain its cell's nodes.
fn drained_share<const D: usize>(
    flow: &Consolidating<D>,
    x: &[f64; D],
    half_length: &[f64; D],
) -> f64 {
    let of = |[lower, upper]: &[[f64; D]; 2]| -> f64 {
        let along = |axis: usize| {
            let from = (x[axis] - half_length[axis]).max(lower[axis]);
            let to = (x[axis] + half_length[axis]).min(upper[axis]);
            let (length, all) = (2.0 * half_length[axis], upper[axis] - lower[axis]);
            let is_taken = to - from >= (0.5 - ROUND_OFF) * length.min(all);
            if is_taken { (to - from) / length } else { 0.0 }
        };
        (0..D).map(along).product()
    };
    flow.drains.iter().map(of).sum::<f64>().min(1.0)
}
