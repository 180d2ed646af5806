//! Which nodes the soil of a case in space will couple, found from where its particles are before the run.

use std::sync::Arc;

use igimp_linear::{NodeBlock, Pattern};
use igimp_shape::Grid;

/// Nodes along an axis that a particle no wider than a cell touches at most.
const MOST: usize = 3;
/// Distance, in nodes along one axis, of two nodes that it couples at most.
const REACH: usize = MOST - 1;
/// Places around a node that it may be coupled to, along one axis.
const SIDE: usize = 2 * REACH + 1;
/// By how much of its half-length a particle is thought to have moved: at the start most lie between lines of the grid \[-\].
const MOVED: f64 = 0.1;

/// The boxes of nodes that particles touch once the soil has begun to move.
#[derive(Clone, Debug)]
pub(super) struct Couplings<'g, const D: usize> {
    grid: &'g Grid<D>,
    /// By the first node of a box its shapes, one bit each.
    shapes: Vec<u32>,
}

impl<'g, const D: usize> Couplings<'g, D> {
    /// Of no particle yet.
    pub(super) fn new(grid: &'g Grid<D>) -> Self {
        Self {
            grid,
            shapes: vec![0; grid.node_count()],
        }
    }

    /// Adds that of a particle at `x` \[length\], moved a little towards the middle of the grid.
    pub(super) fn add(&mut self, x: &[f64; D], half_length: &[f64; D]) {
        let (mut first, mut shape) = ([0; D], 0);
        for axis in (0..D).rev() {
            let line = &self.grid.axes[axis];
            let cells = line.cell_count();
            let half = half_length[axis];
            let middle = 0.5 * (line.start() + line.end());
            let x = x[axis] + (MOVED * half).copysign(middle - x[axis]);
            let lower = line.cell_at(x - half).unwrap_or(0);
            let upper = line.cell_at(x + half).unwrap_or(cells - 1);
            first[axis] = lower;
            shape = MOST * shape + (upper + 1 - lower).min(REACH);
        }
        self.shapes[self.grid.node_index(first)] |= 1 << shape;
    }

    /// The pattern of a system with the `free` components of every node, one bit each, of which those without any carry no
    /// unknown.
    pub(super) fn pattern(&self, free: &[u8]) -> Arc<Pattern> {
        let mut around = vec![0_u128; free.len()];
        for (first, &shapes) in self.shapes.iter().enumerate() {
            for shape in (0..MOST.pow(D as u32)).filter(|shape| shapes & (1 << shape) != 0) {
                self.mark(first, shape, &mut around);
            }
        }
        let mut number = vec![u32::MAX; free.len()];
        let mut blocks: Vec<NodeBlock> = Vec::new();
        let mut unknowns = 0;
        for (node, &free) in free.iter().enumerate() {
            if free == 0 || around[node] == 0 {
                continue;
            }
            number[node] = blocks.len() as u32;
            let len = free.count_ones() as usize;
            let mut place = [0; 3];
            place[..D].copy_from_slice(&self.grid.node_place(node));
            blocks.push(NodeBlock {
                first: unknowns,
                len,
                free,
                place,
            });
            unknowns += len;
        }
        let mut starts = vec![0];
        let mut coupled = Vec::new();
        for (node, &block) in number.iter().enumerate() {
            if block == u32::MAX {
                continue;
            }
            let place = self.grid.node_place(node);
            let mut left = around[node];
            while left != 0 {
                let code = left.trailing_zeros() as usize;
                left &= left - 1;
                let other = std::array::from_fn(|axis| {
                    place[axis] + code / SIDE.pow(axis as u32) % SIDE - REACH
                });
                let other = number[self.grid.node_index(other)];
                if other != u32::MAX {
                    coupled.push(other);
                }
            }
            starts.push(coupled.len());
        }
        Arc::new(Pattern::new(blocks, starts, coupled, REACH))
    }

    /// Couples the nodes of a box with each other.
    fn mark(&self, first: usize, shape: usize, around: &mut [u128]) {
        let extent: [usize; D] =
            std::array::from_fn(|axis| shape / MOST.pow(axis as u32) % MOST + 1);
        let first = self.grid.node_place(first);
        let nodes = || {
            (0..extent.iter().product()).map(move |mut k: usize| {
                extent.map(|extent| {
                    let offset = k % extent;
                    k /= extent;
                    offset
                })
            })
        };
        for node in nodes() {
            let place: [usize; D] = std::array::from_fn(|axis| first[axis] + node[axis]);
            let marks = &mut around[self.grid.node_index(place)];
            for other in nodes() {
                let code = (0..D).rev().fold(0, |code, axis| {
                    SIDE * code + other[axis] + REACH - node[axis]
                });
                *marks |= 1 << code;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use igimp_assembly::{
        Constraints, Method, ParticleSeed, Particles, SharedLaw, Stencils, StepConditions,
        StepLoads, System,
    };
    use igimp_material::{Elasticity, HenckyElastic, TangentKind};
    use igimp_shape::Axis;

    /// The foreseen couplings are those that the assembly finds for particles that have moved.
    #[test]
    fn couplings_are_those_of_the_assembly() {
        let axes = [6, 4, 5].map(|cells| Axis::uniform(0.0, 1.0, cells).unwrap());
        let grid = Grid::new(axes);
        let middle = [3.0, 2.0, 2.5];
        let half = 0.25;
        let mut couplings = Couplings::new(&grid);
        let mut seeds = Vec::new();
        // An L: two cells are missing along its edge.
        for part in 0..12 * 8 * 6 {
            let place = [part % 12, part / 12 % 8, part / 96];
            if place[0] > 7 && place[2] > 3 {
                continue;
            }
            let x = place.map(|k| half + 0.5 * f64::from(k));
            couplings.add(&x, &[half; 3]);
            seeds.push(ParticleSeed {
                x: std::array::from_fn(|a| x[a] + (MOVED * half).copysign(middle[a] - x[a])),
                half_length: [half; 3],
                volume: 0.125,
                density: 2000.0,
                law: 0,
                centroid: [0.0; _],
            });
        }
        let particles = Particles::new(&seeds).unwrap();
        let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(1e7, 0.3).unwrap()));
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 2, false, 2).unwrap();
        let loads = StepLoads::gravity([0.0; 3]);
        let conditions = StepConditions::new(grid.clone(), constraints, loads, vec![law]).unwrap();
        let mut method = Method::default();
        // Nodes that hardly touch soil are tied; those of before the motion alone are foreseen.
        method.small_cuts.below = 0.0;
        let stencils = Stencils::build(&particles, &method, &conditions).unwrap();
        let system = System::new(&particles, &stencils, &conditions, &method).unwrap();
        let still = vec![[0.0; 3]; grid.node_count()];
        let (_, matrix) = system.linearise(&still, TangentKind::Elastic).unwrap();
        let free: Vec<u8> = (0..grid.node_count())
            .map(|node| if grid.node_place(node)[2] == 0 { 3 } else { 7 })
            .collect();
        assert_eq!(*couplings.pattern(&free), *matrix.pattern);
    }
}
