//! Ghost penalty on the faces of boundary cells: a small stiffness against jumps of the normal
//! gradient, γ E h ∫ ⟦∂u/∂n⟧ · ⟦∂v/∂n⟧ (theory, eq. 28; Burman 2010), which keeps nodes with little soil tied to
//! their neighbours. It acts on step displacements, so it leaves no stress behind. The share of a
//! tied node acts on its master.

use igimp_shape::Grid;

use crate::body::particles::Particles;
use crate::contributions::couplings::{Coupling, Couplings};
use crate::step::stencils::Stencils;

/// The ghost stiffness for factor `gamma`, none for 0; `young` gives each particle's modulus.
pub(crate) fn ghost_penalty<const D: usize>(
    grid: &Grid<D>,
    particles: &Particles<D>,
    stencils: &Stencils<D>,
    young: impl Fn(usize) -> f64,
    gamma: f64,
) -> Couplings {
    if gamma <= 0.0 {
        return Couplings(Vec::new());
    }
    let cells = Cells::gather(grid, particles, stencils, young);
    let mut entries = Vec::new();
    for cell in 0..grid.cell_count() {
        let place = grid.cell_place(cell);
        for axis in 0..D {
            if place[axis] + 1 == grid.axes[axis].cell_count() {
                continue;
            }
            let mut beyond = place;
            beyond[axis] += 1;
            let other = grid.cell_index(beyond);
            let both_active = cells.active[cell] && cells.active[other];
            if both_active && (cells.on_boundary(grid, place) || cells.on_boundary(grid, beyond)) {
                let mass = cells.volume[cell] + cells.volume[other];
                let mean_young = (cells.young_volume[cell] + cells.young_volume[other]) / mass;
                face(grid, place, axis, gamma * mean_young, &mut entries);
            }
        }
    }
    let mut carried = Vec::with_capacity(entries.len());
    for entry in entries {
        for row in stencils.carriers(entry.row) {
            carried.extend(stencils.carriers(entry.column).map(|column| Coupling {
                row: row.node,
                column: column.node,
                stiffness: row.weight * column.weight * entry.stiffness,
            }));
        }
    }
    Couplings(carried)
}

/// Which cells hold soil, and how stiff it is.
struct Cells {
    active: Vec<bool>,
    volume: Vec<f64>,
    young_volume: Vec<f64>,
}

impl Cells {
    fn gather<const D: usize>(
        grid: &Grid<D>,
        particles: &Particles<D>,
        stencils: &Stencils<D>,
        young: impl Fn(usize) -> f64,
    ) -> Self {
        let mut cells = Self {
            active: vec![false; grid.cell_count()],
            volume: vec![0.0; grid.cell_count()],
            young_volume: vec![0.0; grid.cell_count()],
        };
        for particle in 0..particles.len() {
            let (first, extent) = stencils.box_of(grid, particle);
            for offset in 0..extent.iter().product::<usize>() {
                let mut rest = offset;
                let place = std::array::from_fn(|axis| {
                    let step = rest % extent[axis];
                    rest /= extent[axis];
                    first[axis] + step
                });
                let cell = grid.cell_index(place);
                let volume = particles.volume(particle);
                cells.active[cell] = true;
                cells.volume[cell] += volume;
                cells.young_volume[cell] += volume * young(particle);
            }
        }
        cells
    }

    /// Whether a face neighbour of a cell, within the grid, holds no soil.
    fn on_boundary<const D: usize>(&self, grid: &Grid<D>, place: [usize; D]) -> bool {
        (0..D).any(|axis| {
            let mut lower = place;
            let mut upper = place;
            lower[axis] = place[axis].saturating_sub(1);
            upper[axis] = (place[axis] + 1).min(grid.axes[axis].cell_count() - 1);
            !self.active[grid.cell_index(lower)] || !self.active[grid.cell_index(upper)]
        })
    }
}

/// The face between a cell and its neighbour along `axis`: the jump of the normal derivative is a
/// second difference over three nodes, integrated exactly along the face.
fn face<const D: usize>(
    grid: &Grid<D>,
    place: [usize; D],
    axis: usize,
    modulus: f64,
    entries: &mut Vec<Coupling>,
) {
    let size = grid.cell_size(place);
    let mut beyond = place;
    beyond[axis] += 1;
    let (h_lower, h_upper) = (size[axis], grid.cell_size(beyond)[axis]);
    let jump = [1.0 / h_lower, -1.0 / h_lower - 1.0 / h_upper, 1.0 / h_upper];
    let h = 0.5 * (h_lower + h_upper);
    let nodes = 3 * 2_usize.pow(D as u32 - 1);
    let node = |k: usize| {
        let mut corner = k / 3;
        grid.node_index(std::array::from_fn(|d| {
            if d == axis {
                place[d] + k % 3
            } else {
                let step = corner % 2;
                corner /= 2;
                place[d] + step
            }
        }))
    };
    for k in 0..nodes {
        for l in 0..nodes {
            let (mut corner_k, mut corner_l) = (k / 3, l / 3);
            let mut along_face = 1.0;
            for d in (0..D).filter(|&d| d != axis) {
                let share = if corner_k % 2 == corner_l % 2 {
                    1.0 / 3.0
                } else {
                    1.0 / 6.0
                };
                along_face *= share * size[d];
                corner_k /= 2;
                corner_l /= 2;
            }
            entries.push(Coupling {
                row: node(k),
                column: node(l),
                stiffness: modulus * h * jump[k % 3] * jump[l % 3] * along_face,
            });
        }
    }
}
