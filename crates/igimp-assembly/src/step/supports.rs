//! The supports of all particles, frozen for one step.

use igimp_shape::{Grid, Scratch, Support, supports};
use rayon::prelude::*;

use crate::body::particles::{CHUNK, Particles};
use crate::error::AssemblyError;
use crate::method::{Locking, Method};
use crate::step::cell_soil::CellSoil;
use crate::step::domain::{bounds, capped_half_length, merge_equal_nodes, off_grid};
use crate::step::hoops::Hoop;
use crate::step::ties::{Ties, carried};

/// The supports of each particle, nodes ascending.
#[derive(Clone, Debug)]
pub(crate) struct Supports<const D: usize> {
    chunks: Vec<Chunk<D>>,
    len: usize,
    /// Largest distance, in nodes along one axis, between two nodes of one particle.
    reach: usize,
}

/// The supports of `CHUNK` particles, or of the last few.
#[derive(Clone, Debug)]
struct Chunk<const D: usize> {
    /// Where the supports of each particle begin, and how many there are.
    places: Vec<(u32, u32)>,
    all: Vec<Support<D>>,
    /// Stretch around the axis by support; none unless the section is axisymmetric.
    hoops: Vec<Hoop>,
    reach: usize,
}

impl<const D: usize> Supports<D> {
    /// Evaluates the basis of a method at all particles. Here alone is decided of which gradients the
    /// strain of a particle is made: without locking control ∇S̄ is replaced by ∇S; both are those of the cells where there is
    /// `soil` (theory, eqs. 8a to 8e and 8h).
    ///
    /// # Errors
    /// [`AssemblyError::Shape`] names the first particle whose centre left the grid.
    pub(crate) fn build(
        grid: &Grid<D>,
        particles: &Particles<D>,
        method: &Method,
        soil: Option<&CellSoil<D>>,
    ) -> Result<Self, AssemblyError> {
        let len = particles.len();
        let chunks: Vec<Result<Chunk<D>, AssemblyError>> = (0..len.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| Chunk::build(grid, particles, method, soil, chunk * CHUNK))
            .collect();
        let chunks = chunks.into_iter().collect::<Result<Vec<_>, _>>()?;
        let reach = chunks.iter().map(|chunk| chunk.reach).max().unwrap_or(0);
        Ok(Self { chunks, len, reach })
    }

    /// The supports of one particle.
    #[inline]
    pub(crate) fn of(&self, particle: usize) -> &[Support<D>] {
        let chunk = &self.chunks[particle / CHUNK];
        let (start, count) = chunk.places[particle % CHUNK];
        &chunk.all[start as usize..(start + count) as usize]
    }

    /// The supports of one particle, and the stretch around the axis by each; none unless the section is axisymmetric.
    #[inline]
    pub(crate) fn with_hoops(&self, particle: usize) -> (&[Support<D>], &[Hoop]) {
        let chunk = &self.chunks[particle / CHUNK];
        let (start, count) = chunk.places[particle % CHUNK];
        let all = start as usize..(start + count) as usize;
        let hoops = if chunk.hoops.is_empty() {
            &[][..]
        } else {
            &chunk.hoops[all.clone()]
        };
        (&chunk.all[all], hoops)
    }

    /// Number of particles.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Largest distance, in nodes along one axis, between two nodes of one particle.
    pub(crate) fn reach(&self) -> usize {
        self.reach
    }

    /// The particles that touch a marked node, ascending.
    pub(crate) fn touching(&self, marked: &[bool]) -> Vec<usize> {
        let lists: Vec<Vec<usize>> = (0..self.chunks.len())
            .into_par_iter()
            .map(|chunk| {
                let particles = chunk * CHUNK..self.len.min((chunk + 1) * CHUNK);
                let touches = |&particle: &usize| {
                    let mut supports = self.of(particle).iter();
                    supports.any(|support| marked[support.node])
                };
                particles.filter(touches).collect()
            })
            .collect();
        lists.concat()
    }

    /// Replaces the supports of one particle by those on the nodes that `supports` move with, which are its own or those of its
    /// cells, and adds up supports that come together.
    pub(crate) fn tie(
        &mut self,
        grid: &Grid<D>,
        particle: usize,
        (supports, hoops): (&[Support<D>], &[Hoop]),
        ties: &Ties,
    ) {
        let mut tied = carried(supports, ties);
        tied.sort_by_key(|support| support.node);
        let count = merge_equal_nodes(&mut tied);
        let hoops = carried_hoops(supports, hoops, ties, &tied[..count]);
        let chunk = &mut self.chunks[particle / CHUNK];
        let (start, room) = &mut chunk.places[particle % CHUNK];
        if count > *room as usize {
            *start = chunk.all.len() as u32;
            chunk.all.extend_from_slice(&tied[..count]);
            chunk.hoops.extend_from_slice(&hoops);
        } else {
            chunk.all[*start as usize..][..count].copy_from_slice(&tied[..count]);
            if !hoops.is_empty() {
                chunk.hoops[*start as usize..][..count].copy_from_slice(&hoops);
            }
        }
        *room = count as u32;
        let (_, extent) = bounds(grid, self.of(particle));
        self.reach = extent.into_iter().fold(self.reach, usize::max);
    }
}

impl<const D: usize> Chunk<D> {
    fn build(
        grid: &Grid<D>,
        particles: &Particles<D>,
        method: &Method,
        soil: Option<&CellSoil<D>>,
        first: usize,
    ) -> Result<Self, AssemblyError> {
        let range = first..particles.len().min(first + CHUNK);
        let mut chunk = Self {
            places: Vec::with_capacity(range.len()),
            all: Vec::with_capacity(range.len() * 3_usize.pow(D as u32)),
            hoops: Vec::new(),
            reach: 0,
        };
        let mut scratch = Scratch::default();
        let (mut stencil, mut hoops) = (Vec::new(), Vec::new());
        for particle in range {
            if let Some(soil) = soil {
                soil.supports(
                    grid,
                    (particle, particles.law[particle]),
                    &mut stencil,
                    &mut hoops,
                );
                let (_, extent) = bounds(grid, &stencil);
                chunk.reach = extent.into_iter().fold(chunk.reach, usize::max);
            } else {
                let x = particles.x[particle];
                let half_length = capped_half_length(grid, &x, particles.half_length[particle]);
                let basis = &*method.basis;
                supports(grid, basis, &x, &half_length, &mut scratch, &mut stencil)
                    .map_err(|source| off_grid(particle, &x, source))?;
                if method.locking == Locking::None {
                    for support in &mut stencil {
                        support.grad_bar = support.grad;
                    }
                }
                for count in scratch.counts() {
                    chunk.reach = chunk.reach.max(count - 1);
                }
            }
            chunk
                .places
                .push((chunk.all.len() as u32, stencil.len() as u32));
            chunk.all.extend_from_slice(&stencil);
            chunk.hoops.extend_from_slice(&hoops);
        }
        Ok(chunk)
    }
}

/// The stretch around the axis by the supports `tied` that stand for `supports` once tied nodes move with others.
fn carried_hoops<const D: usize>(
    supports: &[Support<D>],
    hoops: &[Hoop],
    ties: &Ties,
    tied: &[Support<D>],
) -> Vec<Hoop> {
    let mut carried = vec![Hoop::default(); if hoops.is_empty() { 0 } else { tied.len() }];
    for (support, &hoop) in supports.iter().zip(hoops) {
        let mut add = |node: usize, weight: f64| {
            let place = tied.binary_search_by_key(&node, |support| support.node);
            if let Some(sum) = place.ok().and_then(|place| carried.get_mut(place)) {
                *sum = sum.plus(weight, hoop);
            }
        };
        match ties.get(&support.node) {
            Some(carriers) => carriers.iter().for_each(|by| add(by.node, by.weight)),
            None => add(support.node, 1.0),
        }
    }
    carried
}
