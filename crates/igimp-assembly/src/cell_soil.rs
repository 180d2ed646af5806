//! The soil in every cell of the grid: how much there is, and where its centroid lies. From it come
//! gradients that the particles of a cell share, and which cells hold slivers only (theory, eqs. 8a to 8d).

use igimp_shape::{CellPart, Grid, Support, cell_parts};
use rayon::prelude::*;

use crate::error::AssemblyError;
use crate::method::{Geometry, Locking, Method};
use crate::particles::Particles;
use crate::step_conditions::SharedLaw;
use crate::supports::{CHUNK, capped_half_length, merge_equal_nodes, off_grid};

/// A cell that is filled to less than this share holds a sliver of soil that reached over its face
/// \[-\].
const SLIVER: f64 = 0.02;

/// Share β of its own distortion that a particle keeps where plastic flow is associated, on a given
/// geometry \[-\].
const OWN_GIVEN: f64 = 0.02;

/// The same on a moving one: what the mean does not see is held in every step \[-\].
const OWN_MOVING: f64 = 0.1;

/// The same where plastic flow is not associated \[-\].
const OWN_NON_ASSOCIATED: f64 = 0.3;

/// The soil of every cell, and the parts of every particle.
pub(crate) struct CellSoil<const D: usize> {
    /// The parts of `CHUNK` particles after `CHUNK` particles: where those of each begin, and all.
    parts: Vec<(Vec<u32>, Vec<CellPart<D>>)>,
    /// Whether a cell holds no more than a sliver, by cell.
    is_sliver: Vec<bool>,
    /// Where the tents of a cell give the gradients that its particles share, from 0 to 1 in each
    /// direction, by cell: the centre X = 1/2, or the centroid of the soil \[-\].
    shared_at: Vec<[f64; D]>,
    /// Share β of its own distortion that a particle keeps, by law \[-\].
    own_share: Vec<f64>,
    locking: Locking,
}

impl<const D: usize> CellSoil<D> {
    /// Lays the particles over a grid.
    ///
    /// # Errors
    /// [`AssemblyError::Shape`] names the first particle whose centre left the grid.
    pub(crate) fn build(
        grid: &Grid<D>,
        particles: &Particles<D>,
        method: &Method,
        laws: &[SharedLaw],
    ) -> Result<Self, AssemblyError> {
        let len = particles.len();
        let parts = (0..len.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let own = chunk * CHUNK..len.min((chunk + 1) * CHUNK);
                let (mut first, mut all) = (Vec::with_capacity(own.len() + 1), Vec::new());
                first.push(0);
                for particle in own {
                    let x = &particles.x[particle];
                    let half_length = capped_half_length(grid, x, particles.half_length[particle]);
                    cell_parts(grid, &*method.basis, x, &half_length, &mut all)
                        .map_err(|source| off_grid(particle, x, source))?;
                    first.push(all.len() as u32);
                }
                Ok((first, all))
            })
            .collect::<Vec<Result<_, AssemblyError>>>();
        let parts = parts.into_iter().collect::<Result<Vec<_>, _>>()?;
        let of_law = |law| own_share(law, method.geometry);
        let mut soil = Self {
            parts,
            is_sliver: vec![false; grid.cell_count()],
            shared_at: vec![[0.5; D]; grid.cell_count()],
            own_share: laws.iter().map(of_law).collect(),
            locking: method.locking,
        };
        if method.geometry == Geometry::Given {
            soil.find_soil(grid, particles);
        }
        Ok(soil)
    }

    /// Finds slivers, and the centroid of the soil of every cell: sums of volumes and first moments in
    /// the order of the particles.
    fn find_soil(&mut self, grid: &Grid<D>, particles: &Particles<D>) {
        let mut volume = vec![0.0; grid.cell_count()];
        let mut moment = vec![[0.0; D]; grid.cell_count()];
        for particle in 0..particles.len() {
            for part in of(&self.parts, particle) {
                let cell = grid.cell_index(part.cell);
                let own = part.share * particles.volume(particle);
                volume[cell] += own;
                for axis in 0..D {
                    moment[cell][axis] += own * part.middle[axis];
                }
            }
        }
        for (cell, (volume, moment)) in volume.into_iter().zip(moment).enumerate() {
            if volume > 0.0 && self.locking == Locking::SharedStrain {
                self.shared_at[cell] = moment.map(|moment| moment / volume);
            }
            let size: f64 = grid.cell_size(grid.cell_place(cell)).iter().product();
            self.is_sliver[cell] = volume < SLIVER * size;
        }
    }

    /// Replaces `out` with the supports of a particle of law number `law` (theory, eq. 8b), nodes
    /// ascending. On a given geometry slivers are cut off, unless there is nothing else.
    pub(crate) fn supports(
        &self,
        grid: &Grid<D>,
        (particle, law): (usize, usize),
        out: &mut Vec<Support<D>>,
    ) {
        let parts = of(&self.parts, particle);
        let cell = |part: &CellPart<D>| grid.cell_index(part.cell);
        let kept = |part: &&CellPart<D>| !self.is_sliver[cell(part)];
        let share: f64 = parts.iter().filter(kept).map(|part| part.share).sum();
        let all = share <= 0.5;
        let whole = if all { 1.0 } else { share };
        let own = match self.locking {
            Locking::SharedStrain => self.own_share[law],
            Locking::None | Locking::BBar => 1.0,
        };
        out.clear();
        for part in parts.iter().filter(|part| all || kept(part)) {
            let weight = part.share / whole;
            let shared_at = match self.locking {
                Locking::None => part.middle,
                Locking::BBar | Locking::SharedStrain => self.shared_at[cell(part)],
            };
            let own_tents = grid.tents(part.cell, part.middle);
            for (tent, shared) in own_tents.zip(grid.tents(part.cell, shared_at)) {
                let (node, value, grad) = tent;
                out.push(Support {
                    node,
                    value: weight * value,
                    grad: std::array::from_fn(|axis| {
                        weight * (own * grad[axis] + (1.0 - own) * shared.2[axis])
                    }),
                    grad_bar: shared.2.map(|slope| weight * slope),
                });
            }
        }
        out.sort_by_key(|support| support.node);
        let count = merge_equal_nodes(out);
        out.truncate(count);
    }
}

/// The parts of one particle.
fn of<const D: usize>(parts: &[(Vec<u32>, Vec<CellPart<D>>)], particle: usize) -> &[CellPart<D>] {
    let (first, all) = &parts[particle / CHUNK];
    let place = particle % CHUNK;
    &all[first[place] as usize..first[place + 1] as usize]
}

/// The share of its own distortion that a particle of a law keeps. Elastic soil keeps all of it: bending
/// has to be resisted. In soil that yields the rest is shared, and what is kept holds modes that the
/// mean does not see; they add up from step to step where the body moves. Where flow is not associated
/// equilibrium is not unique, and sharing less keeps Newton's method on its way.
fn own_share(law: &SharedLaw, geometry: Geometry) -> f64 {
    match geometry {
        _ if !law.yields() => 1.0,
        _ if !law.has_symmetric_tangent() => OWN_NON_ASSOCIATED,
        Geometry::Given => OWN_GIVEN,
        Geometry::Moving => OWN_MOVING,
    }
}
