//! Who touches what: the supports of every particle, frozen for one step, and their transpose by
//! node.

use std::collections::BTreeMap;
use std::ops::Range;

use igimp_shape::{Grid, Scratch, Support, supports};
use rayon::prelude::*;

use crate::constraints::Constraints;
use crate::error::AssemblyError;
use crate::method::{Method, Remedy, SmallCuts};
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
    supports: Supports<D>,
    reach: usize,
    node_volume: Vec<f64>,
    masters: BTreeMap<usize, usize>,
    strips: Strips,
}

impl<const D: usize> Stencils<D> {
    /// Evaluates the basis of a method at all particles, and ties nodes that are small cuts to
    /// their neighbours if the method says so.
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
        constraints: &Constraints<D>,
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

        let mut supports = Supports { offsets, all };
        let mut node_volume = supports.node_volume(grid, particles);
        let mut masters = BTreeMap::new();
        if method.small_cuts.remedy == Remedy::Tie {
            masters = masters_of_cuts(
                grid,
                &supports,
                &node_volume,
                constraints,
                method.small_cuts,
            );
            if !masters.is_empty() {
                supports = supports.tied(&masters);
                node_volume = supports.node_volume(grid, particles);
            }
        }
        let reach = (0..n)
            .map(|particle| {
                supports
                    .bounds(grid, particle)
                    .1
                    .into_iter()
                    .max()
                    .unwrap_or(0)
            })
            .max()
            .unwrap_or(0);
        let strips = Strips::build(grid, n, |particle| {
            let own = supports.of(particle);
            (own[0].node, own[own.len() - 1].node)
        });
        Ok(Self {
            supports,
            reach,
            node_volume,
            masters,
            strips,
        })
    }

    /// The supports of one particle, nodes ascending.
    pub fn of(&self, particle: usize) -> &[Support<D>] {
        self.supports.of(particle)
    }

    /// The lowest place and the extent, in nodes along each axis, of a particle's supports.
    pub(crate) fn box_of(&self, grid: &Grid<D>, particle: usize) -> ([usize; D], [usize; D]) {
        self.supports.bounds(grid, particle)
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.supports.offsets.len() - 1
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

    /// Tied nodes with the nodes that they move with.
    pub(crate) fn masters(&self) -> &BTreeMap<usize, usize> {
        &self.masters
    }

    /// The node that a node moves with: itself unless it is tied.
    pub(crate) fn master(&self, node: usize) -> usize {
        self.masters.get(&node).copied().unwrap_or(node)
    }

    /// Particles grouped by strips of node rows, for sums that are the same for any thread count.
    pub(crate) fn strips(&self) -> &Strips {
        &self.strips
    }

    /// The transpose: which particles touch each node.
    pub fn transpose(&self, node_count: usize) -> Transpose {
        let mut offsets = vec![0; node_count + 1];
        for support in &self.supports.all {
            offsets[support.node + 1] += 1;
        }
        for node in 0..node_count {
            offsets[node + 1] += offsets[node];
        }
        let mut cursor = offsets.clone();
        let mut particles = vec![0; self.supports.all.len()];
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

/// The supports of all particles, one after another.
#[derive(Clone, Debug)]
struct Supports<const D: usize> {
    offsets: Vec<usize>,
    all: Vec<Support<D>>,
}

impl<const D: usize> Supports<D> {
    fn of(&self, particle: usize) -> &[Support<D>] {
        &self.all[self.offsets[particle]..self.offsets[particle + 1]]
    }

    /// Σ_p S_i V_p by node \[length^D\].
    fn node_volume(&self, grid: &Grid<D>, particles: &Particles<D>) -> Vec<f64> {
        let mut node_volume = vec![0.0; grid.node_count()];
        for particle in 0..particles.len() {
            let volume = particles.volume(particle);
            for support in self.of(particle) {
                node_volume[support.node] += support.value * volume;
            }
        }
        node_volume
    }

    /// The lowest place of a particle's nodes, and how far they extend along each axis.
    fn bounds(&self, grid: &Grid<D>, particle: usize) -> ([usize; D], [usize; D]) {
        let mut lower = [usize::MAX; D];
        let mut upper = [0; D];
        for support in self.of(particle) {
            let place = grid.node_place(support.node);
            for axis in 0..D {
                lower[axis] = lower[axis].min(place[axis]);
                upper[axis] = upper[axis].max(place[axis]);
            }
        }
        (lower, std::array::from_fn(|axis| upper[axis] - lower[axis]))
    }

    /// The supports with every tied node replaced by its master.
    fn tied(&self, masters: &BTreeMap<usize, usize>) -> Self {
        let mut offsets = Vec::with_capacity(self.offsets.len());
        let mut all: Vec<Support<D>> = Vec::with_capacity(self.all.len());
        offsets.push(0);
        for particle in 0..self.offsets.len() - 1 {
            let start = all.len();
            all.extend_from_slice(self.of(particle));
            let mut tied = false;
            for support in &mut all[start..] {
                if let Some(&master) = masters.get(&support.node) {
                    support.node = master;
                    tied = true;
                }
            }
            if tied {
                all[start..].sort_by_key(|support| support.node);
                merge_equal_nodes(&mut all, start);
            }
            offsets.push(all.len());
        }
        Self { offsets, all }
    }
}

/// Adds up neighbouring supports of the same node from `start` on.
fn merge_equal_nodes<const D: usize>(all: &mut Vec<Support<D>>, start: usize) {
    let mut kept = start;
    for k in start + 1..all.len() {
        let support = all[k];
        if all[kept].node == support.node {
            let sum = &mut all[kept];
            sum.value += support.value;
            for axis in 0..D {
                sum.grad[axis] += support.grad[axis];
                sum.grad_bar[axis] += support.grad_bar[axis];
            }
        } else {
            kept += 1;
            all[kept] = support;
        }
    }
    all.truncate(kept + 1);
}

/// The master of every node that is a small cut: the nearest node that shares a particle with it,
/// carries enough soil and has the same constraints; of equally near ones that with most soil.
fn masters_of_cuts<const D: usize>(
    grid: &Grid<D>,
    supports: &Supports<D>,
    node_volume: &[f64],
    constraints: &Constraints<D>,
    small_cuts: SmallCuts,
) -> BTreeMap<usize, usize> {
    // Touched, not of positive volume: a point on a face sees the cell beyond by its gradient only.
    let mut cuts = vec![false; grid.node_count()];
    for support in &supports.all {
        let node = support.node;
        cuts[node] = node_volume[node] < small_cuts.below * cell_volume(grid, node);
    }
    let is_cut = |node: usize| cuts[node];
    if !cuts.contains(&true) {
        return BTreeMap::new();
    }
    let distance = |a: usize, b: usize| {
        let (a, b) = (grid.node_position(a), grid.node_position(b));
        std::iter::zip(a, b)
            .map(|(a, b)| (a - b) * (a - b))
            .sum::<f64>()
    };
    let mut masters = BTreeMap::new();
    for particle in 0..supports.offsets.len() - 1 {
        let own = supports.of(particle);
        for cut in own
            .iter()
            .map(|support| support.node)
            .filter(|&node| is_cut(node))
        {
            if (0..D).all(|axis| constraints.of(cut, axis).is_some()) {
                continue;
            }
            for candidate in own.iter().map(|support| support.node) {
                let alike =
                    (0..D).all(|axis| constraints.of(cut, axis) == constraints.of(candidate, axis));
                if is_cut(candidate) || !alike {
                    continue;
                }
                let key = |master: usize| (distance(cut, master), -node_volume[master]);
                let master = masters.entry(cut).or_insert(candidate);
                if key(candidate) < key(*master) {
                    *master = candidate;
                }
            }
        }
    }
    masters
}

/// The mean volume of a cell around a node: the product of half the lengths to its neighbours,
/// doubled at walls \[length^D\].
pub(crate) fn cell_volume<const D: usize>(grid: &Grid<D>, node: usize) -> f64 {
    let place = grid.node_place(node);
    (0..D)
        .map(|axis| {
            let nodes = grid.axes[axis].nodes();
            let lower = place[axis].saturating_sub(1);
            let upper = (place[axis] + 1).min(nodes.len() - 1);
            (nodes[upper] - nodes[lower]) / (upper - lower) as f64
        })
        .product()
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
            supports(
                grid,
                &*method.basis,
                &x,
                &half_length,
                &mut scratch,
                &mut own,
            )
            .map_err(|source| AssemblyError::Shape {
                particle,
                position: padded(&x),
                source,
            })?;
            if !method.bbar {
                for support in &mut own {
                    support.grad_bar = support.grad;
                }
            }
            counts.push(own.len());
            all.extend_from_slice(&own);
        }
        Ok(Self {
            counts,
            supports: all,
        })
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
