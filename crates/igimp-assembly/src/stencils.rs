//! Who touches what: the supports of every particle, frozen for one step, and their transpose by
//! node.

use std::ops::Range;

use igimp_shape::{Grid, Scratch, Support, supports};
use rayon::prelude::*;

use crate::error::AssemblyError;
use crate::method::Method;
use crate::particles::Particles;
use crate::strips::Strips;

/// Particles handled by one task when stencils are built: fixed, so that results do not depend on
/// the number of threads.
const CHUNK: usize = 2048;

/// Basis values S, gradients ∇S and cell-averaged centre gradients ∇S̄ of all particles.
///
/// Without B-bar, ∇S̄ is replaced by ∇S, so that the four variants of the method run through the
/// same code.
#[derive(Clone, Debug)]
pub struct Stencils<const D: usize> {
    offsets: Vec<usize>,
    supports: Vec<Support<D>>,
    reach: usize,
    node_volume: Vec<f64>,
    strips: Strips,
}

impl<const D: usize> Stencils<D> {
    /// Evaluates the basis of a method at all particles.
    ///
    /// Half-lengths count up to one cell: a domain stretched further would couple ever more nodes
    /// without gain.
    ///
    /// # Errors
    /// [`AssemblyError::Shape`] names the first particle whose centre left the grid.
    pub fn build(
        grid: &Grid<D>,
        particles: &Particles<D>,
        method: &Method,
    ) -> Result<Self, AssemblyError> {
        let n = particles.len();
        let chunks: Vec<Result<Chunk<D>, AssemblyError>> = (0..n.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let range = chunk * CHUNK..n.min((chunk + 1) * CHUNK);
                Chunk::build(grid, particles, method, range)
            })
            .collect();
        let mut offsets = Vec::with_capacity(n + 1);
        offsets.push(0);
        let mut all = Vec::new();
        for chunk in chunks {
            let Chunk { counts, supports } = chunk?;
            for count in counts {
                offsets.push(offsets[offsets.len() - 1] + count);
            }
            all.extend_from_slice(&supports);
        }

        let mut node_volume = vec![0.0; grid.node_count()];
        let mut reach = 0;
        for particle in 0..n {
            let own = &all[offsets[particle]..offsets[particle + 1]];
            let volume = particles.volume(particle);
            for support in own {
                node_volume[support.node] += support.value * volume;
            }
            let first = grid.node_place(own[0].node);
            let last = grid.node_place(own[own.len() - 1].node);
            for axis in 0..D {
                reach = reach.max(last[axis] - first[axis]);
            }
        }
        let strips = Strips::build(grid, n, |particle| {
            (all[offsets[particle]].node, all[offsets[particle + 1] - 1].node)
        });
        Ok(Self { offsets, supports: all, reach, node_volume, strips })
    }

    /// The supports of one particle, nodes ascending.
    pub fn of(&self, particle: usize) -> &[Support<D>] {
        &self.supports[self.offsets[particle]..self.offsets[particle + 1]]
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there is no particle: never, by construction.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Largest distance, in nodes along one axis, between two nodes of one particle.
    pub fn reach(&self) -> usize {
        self.reach
    }

    /// Volume that each grid node represents, Σ_p S_i V_p \[length^D\], by node.
    pub fn node_volume(&self) -> &[f64] {
        &self.node_volume
    }

    /// Particles grouped by strips of node rows, for sums that are the same for any thread count.
    pub(crate) fn strips(&self) -> &Strips {
        &self.strips
    }

    /// The transpose: which particles touch each node.
    pub fn transpose(&self, node_count: usize) -> Transpose {
        let mut offsets = vec![0; node_count + 1];
        for support in &self.supports {
            offsets[support.node + 1] += 1;
        }
        for node in 0..node_count {
            offsets[node + 1] += offsets[node];
        }
        let mut cursor = offsets.clone();
        let mut particles = vec![0; self.supports.len()];
        for particle in 0..self.len() {
            for support in self.of(particle) {
                particles[cursor[support.node]] = particle;
                cursor[support.node] += 1;
            }
        }
        Transpose { offsets, particles }
    }
}

/// The particles that touch each node, ascending.
#[derive(Clone, Debug)]
pub struct Transpose {
    offsets: Vec<usize>,
    particles: Vec<usize>,
}

impl Transpose {
    /// The particles that touch one node, ascending.
    pub fn of(&self, node: usize) -> &[usize] {
        &self.particles[self.offsets[node]..self.offsets[node + 1]]
    }
}

struct Chunk<const D: usize> {
    counts: Vec<usize>,
    supports: Vec<Support<D>>,
}

impl<const D: usize> Chunk<D> {
    fn build(
        grid: &Grid<D>,
        particles: &Particles<D>,
        method: &Method,
        range: Range<usize>,
    ) -> Result<Self, AssemblyError> {
        let mut counts = Vec::with_capacity(range.len());
        let mut all = Vec::with_capacity(range.len() * 3_usize.pow(D as u32));
        let mut scratch = Scratch::default();
        let mut own = Vec::new();
        for particle in range {
            let x = particles.x[particle];
            let half_length = capped_half_length(grid, &x, particles.half_length[particle]);
            supports(grid, &*method.basis, &x, &half_length, &mut scratch, &mut own)
                .map_err(|source| AssemblyError::Shape { particle, position: padded(&x), source })?;
            if !method.bbar {
                for support in &mut own {
                    support.grad_bar = support.grad;
                }
            }
            counts.push(own.len());
            all.extend_from_slice(&own);
        }
        Ok(Self { counts, supports: all })
    }
}

/// Half-lengths limited to the size of the cell that holds the centre.
fn capped_half_length<const D: usize>(
    grid: &Grid<D>,
    x: &[f64; D],
    mut half_length: [f64; D],
) -> [f64; D] {
    if let Some(cell) = grid.cell_at(x) {
        let size = grid.cell_size(cell);
        for axis in 0..D {
            half_length[axis] = half_length[axis].min(size[axis]);
        }
    }
    half_length
}

/// A position with zeros beyond the dimension, for messages.
pub(crate) fn padded<const D: usize>(x: &[f64; D]) -> [f64; 3] {
    let mut out = [0.0; 3];
    out[..D].copy_from_slice(x);
    out
}
