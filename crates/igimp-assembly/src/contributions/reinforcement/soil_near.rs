//! Whether soil is near enough to a station to carry it.

use std::collections::HashMap;

use igimp_shape::Grid;

use crate::body::particles::Particles;

/// How far from the domains of all particles a station is still carried, over the size of its cell \[-\].
const FARTHEST: f64 = 0.5;

/// The particles of a body by the cells of a grid that they are in.
pub(super) struct SoilNear<'a, const D: usize> {
    particles: &'a Particles<D>,
    grid: &'a Grid<D>,
    by_cell: HashMap<[usize; D], Vec<usize>>,
}

impl<'a, const D: usize> SoilNear<'a, D> {
    pub(super) fn new(particles: &'a Particles<D>, grid: &'a Grid<D>) -> Self {
        let mut by_cell: HashMap<[usize; D], Vec<usize>> = HashMap::new();
        for (particle, x) in particles.x.iter().enumerate() {
            if let Some(cell) = grid.cell_at(x) {
                by_cell.entry(cell).or_default().push(particle);
            }
        }
        Self {
            particles,
            grid,
            by_cell,
        }
    }

    /// Whether the domain of a particle reaches as near to a place as half a cell.
    pub(super) fn reaches(&self, x: &[f64; D]) -> bool {
        let Some(cell) = self.grid.cell_at(x) else {
            return false;
        };
        let size = self.grid.cell_size(cell);
        let is_near = |particle: usize| {
            let (at, half) = (
                &self.particles.x[particle],
                &self.particles.half_length[particle],
            );
            (0..D).all(|axis| (x[axis] - at[axis]).abs() <= half[axis] + FARTHEST * size[axis])
        };
        (0..3_usize.pow(D as u32)).any(|number| {
            let other: Option<Vec<usize>> = (0..D)
                .map(|axis| (cell[axis] + number / 3_usize.pow(axis as u32) % 3).checked_sub(1))
                .collect();
            let other = other.and_then(|place| <[usize; D]>::try_from(place).ok());
            let list = other.and_then(|cell| self.by_cell.get(&cell));
            list.is_some_and(|list| list.iter().any(|&particle| is_near(particle)))
        })
    }
}
