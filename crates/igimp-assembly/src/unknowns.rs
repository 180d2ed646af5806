//! Which degrees of freedom are unknown, and where the blocks of the tangent matrix live.

use std::sync::Arc;

use igimp_shape::Grid;

use crate::constraints::Constraints;
use crate::error::AssemblyError;
use crate::matrix::{NodeBlock, Pattern};
use crate::stencils::{Stencils, cell_volume};

/// Marks a degree of freedom without an unknown, or a pair of nodes without a block.
const NONE: u32 = u32::MAX;

/// The unknowns of a step: free degrees of freedom of active nodes, nodes ascending.
#[derive(Clone, Debug)]
pub struct Unknowns<const D: usize> {
    /// Number of unknowns on nodes before each node; length nodes + 1.
    first: Vec<u32>,
    /// Rank of each component among the node's unknowns.
    rank: Vec<[u32; D]>,
    /// Active nodes: with volume, not dropped as a small cut.
    active: Vec<bool>,
    len: usize,
}

impl<const D: usize> Unknowns<D> {
    /// Numbers the unknowns. Nodes whose volume is below `drop_below` of their cells' volume are
    /// dropped: their displacement is zero. (Tied nodes carry no volume any more.)
    ///
    /// # Errors
    /// [`AssemblyError::NoUnknowns`].
    pub(crate) fn number(
        grid: &Grid<D>,
        stencils: &Stencils<D>,
        constraints: &Constraints<D>,
        drop_below: f64,
    ) -> Result<Self, AssemblyError> {
        let nodes = grid.node_count();
        let mut first = Vec::with_capacity(nodes + 1);
        let mut rank = vec![[NONE; D]; nodes];
        let mut active = vec![false; nodes];
        let mut len: u32 = 0;
        for node in 0..nodes {
            first.push(len);
            let volume = stencils.node_volume()[node];
            active[node] = volume > 0.0 && volume >= drop_below * cell_volume(grid, node);
            if !active[node] {
                continue;
            }
            let mut own = 0;
            for axis in 0..D {
                if constraints.of(node, axis).is_none() {
                    rank[node][axis] = own;
                    own += 1;
                }
            }
            len += own;
        }
        first.push(len);
        if len == 0 {
            return Err(AssemblyError::NoUnknowns);
        }
        Ok(Self {
            first,
            rank,
            active,
            len: len as usize,
        })
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no unknown: never, by construction.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The unknown of a node's component, if it is free.
    #[inline]
    pub fn index(&self, node: usize, axis: usize) -> Option<usize> {
        let rank = self.rank[node][axis];
        (rank != NONE).then(|| (self.first[node] + rank) as usize)
    }

    /// Whether a node takes part: it carries enough volume.
    pub fn is_active(&self, node: usize) -> bool {
        self.active[node]
    }

    /// Number of active nodes.
    pub fn active_nodes(&self) -> usize {
        self.active.iter().filter(|&&active| active).count()
    }

    /// Number of unknowns on nodes before `node`.
    pub(crate) fn before(&self, node: usize) -> usize {
        self.first[node] as usize
    }

    /// The free components of a node with their unknowns.
    #[inline]
    pub(crate) fn of(&self, node: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..D).filter_map(move |axis| self.index(node, axis).map(|unknown| (axis, unknown)))
    }

    fn count(&self, node: usize) -> u32 {
        self.first[node + 1] - self.first[node]
    }
}

/// Places of node blocks in the columns of the tangent matrix, found by the difference of the
/// nodes' places on the grid.
#[derive(Clone, Debug)]
pub(crate) struct BlockTable<const D: usize> {
    window: usize,
    reach: usize,
    /// Offset within a column of node j of the first row of node i, by j and code(i) − code(j).
    offsets: Vec<u32>,
    /// Position of each node in `offsets`.
    compact: Vec<u32>,
}

impl<const D: usize> BlockTable<D> {
    /// Finds the coupled nodes, and with them the sparsity pattern. `extra` lists further coupled
    /// pairs of nodes, both ways.
    pub(crate) fn build(
        grid: &Grid<D>,
        stencils: &Stencils<D>,
        unknowns: &Unknowns<D>,
        extra: &[(usize, usize)],
        previous: Option<&Arc<Pattern>>,
    ) -> (Self, Arc<Pattern>) {
        let apart = |&(a, b): &(usize, usize)| {
            let places = std::iter::zip(grid.node_place(a), grid.node_place(b));
            places.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
        };
        let reach = extra.iter().map(apart).fold(stencils.reach(), usize::max);
        let window = 2 * reach + 1;
        let mut compact = vec![NONE; grid.node_count()];
        let mut columns = Vec::new();
        for node in 0..grid.node_count() {
            if unknowns.count(node) > 0 {
                compact[node] = u32::try_from(columns.len()).expect("fewer than 2^32 nodes");
                columns.push(node);
            }
        }
        let size = window.pow(D as u32);
        let mut table = Self {
            window,
            reach,
            offsets: vec![NONE; columns.len() * size],
            compact,
        };
        let codes: Vec<usize> = (0..grid.node_count())
            .map(|node| table.code(&grid.node_place(node)))
            .collect();
        for particle in 0..stencils.len() {
            let own = stencils.of(particle);
            for column in own {
                if table.compact[column.node] == NONE {
                    continue;
                }
                for row in own {
                    let slot = table.slot(column.node, codes[column.node], codes[row.node]);
                    table.offsets[slot] = 0;
                }
            }
        }
        for &(column, row) in extra {
            if table.compact[column] != NONE {
                let slot = table.slot(column, codes[column], codes[row]);
                table.offsets[slot] = 0;
            }
        }
        let pattern = table.number(grid, unknowns, &columns);
        match previous {
            Some(previous) if **previous == pattern => (table, Arc::clone(previous)),
            _ => (table, Arc::new(pattern)),
        }
    }

    /// Turns the marks of coupled nodes into offsets, and writes the pattern.
    fn number(&mut self, grid: &Grid<D>, unknowns: &Unknowns<D>, columns: &[usize]) -> Pattern {
        let size = self.window.pow(D as u32);
        let mut starts = vec![0];
        let mut coupled = Vec::new();
        let mut blocks = Vec::with_capacity(columns.len());
        for (position, &column) in columns.iter().enumerate() {
            let place = grid.node_place(column);
            let mut height = 0;
            for slot in 0..size {
                let offset = &mut self.offsets[position * size + slot];
                if *offset == NONE {
                    continue;
                }
                let row = neighbour(grid, &place, slot, self.window, self.reach);
                if unknowns.count(row) == 0 {
                    *offset = NONE;
                    continue;
                }
                *offset = height;
                height += unknowns.count(row);
                coupled.push(self.compact[row]);
            }
            starts.push(coupled.len());
            let mut block_place = [0; 3];
            block_place[..D].copy_from_slice(&place);
            blocks.push(NodeBlock {
                first: unknowns.before(column),
                len: unknowns.count(column) as usize,
                place: block_place,
            });
        }
        Pattern::new(blocks, starts, coupled, self.reach)
    }

    /// A number for a node's place such that differences tell two nodes' distance apart.
    #[inline]
    pub(crate) fn code(&self, place: &[usize; D]) -> usize {
        place
            .iter()
            .rev()
            .fold(0, |code, &position| code * self.window + position)
    }

    /// Offset within the columns of node `column` of the first row of node `row`; both must carry
    /// unknowns and be coupled.
    #[inline]
    pub(crate) fn offset(&self, column: usize, column_code: usize, row_code: usize) -> usize {
        self.offsets[self.slot(column, column_code, row_code)] as usize
    }

    #[inline]
    fn slot(&self, column: usize, column_code: usize, row_code: usize) -> usize {
        let size = self.window.pow(D as u32);
        let centre = (size - 1) / 2;
        self.compact[column] as usize * size + row_code + centre - column_code
    }
}

/// The node that a slot of the window around `place` stands for.
fn neighbour<const D: usize>(
    grid: &Grid<D>,
    place: &[usize; D],
    slot: usize,
    window: usize,
    reach: usize,
) -> usize {
    let mut rest = slot;
    grid.node_index(std::array::from_fn(|axis| {
        let step = rest % window;
        rest /= window;
        place[axis] + step - reach
    }))
}
