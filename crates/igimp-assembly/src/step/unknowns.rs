//! Which degrees of freedom are unknown.

use std::ops::Range;

use igimp_shape::Grid;

use crate::conditions::constraints::Constraints;
use crate::error::AssemblyError;
use crate::method::SmallCuts;
use crate::step::small_cuts::least_volume;
use crate::step::stencils::Stencils;

/// Marks a degree of freedom without an unknown.
const NONE: u32 = u32::MAX;

/// The unknowns of a step: free degrees of freedom of active nodes, nodes ascending, and then those of
/// rigid bodies. A scalar, excess pore pressure or nonlocal strain, is the last unknown of its node; a node of its own,
/// behind those of rigid bodies, stands for it wherever displacements are listed by node.
#[derive(Clone, Debug)]
pub struct Unknowns<const D: usize> {
    /// Number of unknowns on nodes before each node; length nodes + 1.
    first: Vec<u32>,
    /// Rank of each component among the node's unknowns.
    rank: Vec<[u32; D]>,
    /// Number of nodes with unknowns before each node; length nodes + 1.
    blocks_before: Vec<u32>,
    /// Active nodes: with volume, not dropped as a small cut.
    active: Vec<bool>,
    /// Unknowns of the grid; those of rigid bodies follow.
    of_grid: usize,
    len: usize,
    /// The unknowns that are scalars, with their nodes of the grid, ascending.
    scalars: Vec<(u32, u32)>,
}

impl<const D: usize> Unknowns<D> {
    /// Numbers the unknowns. Nodes whose volume is below that of small cuts are
    /// dropped: their displacement is zero. (Tied nodes carry no volume any more.) Behind the nodes of the
    /// grid stand those of rigid bodies, each with its free components, and those of scalars: the nodes of the grid that
    /// `has_scalar` names, if it names any.
    ///
    /// # Errors
    /// [`AssemblyError::NoUnknowns`].
    pub(crate) fn number(
        grid: &Grid<D>,
        stencils: &Stencils<D>,
        constraints: &Constraints<D>,
        cuts: &SmallCuts,
        of_bodies: &[[bool; D]],
        has_scalar: &[bool],
    ) -> Result<Self, AssemblyError> {
        let nodes = grid.node_count();
        let all = nodes + of_bodies.len();
        let mut first = Vec::with_capacity(all + 1);
        let mut rank = vec![[NONE; D]; all];
        let mut active = vec![false; nodes];
        let mut blocks_before = Vec::with_capacity(nodes + 1);
        let mut scalars = Vec::new();
        let mut blocks = 0;
        let mut len: u32 = 0;
        for node in 0..nodes {
            first.push(len);
            blocks_before.push(blocks);
            let volume = stencils.node_volume(node);
            let has_soil = volume > 0.0 && volume >= least_volume(grid, cuts, node);
            active[node] = has_soil || stencils.is_carrier(node);
            if !active[node] {
                continue;
            }
            let mut count = 0;
            for axis in 0..D {
                if constraints.of(node, axis).is_none() {
                    rank[node][axis] = count;
                    count += 1;
                }
            }
            if has_scalar.get(node) == Some(&true) {
                scalars.push((len + count, node as u32));
                count += 1;
            }
            len += count;
            blocks += u32::from(count > 0);
        }
        blocks_before.push(blocks);
        if len == 0 {
            return Err(AssemblyError::NoUnknowns);
        }
        let of_grid = len as usize;
        for (free, rank) in of_bodies.iter().zip(&mut rank[nodes..]) {
            first.push(len);
            let mut count = 0;
            for axis in (0..D).filter(|&axis| free[axis]) {
                rank[axis] = count;
                count += 1;
            }
            len += count;
        }
        first.push(len);
        Ok(Self {
            first,
            rank,
            blocks_before,
            active,
            of_grid,
            len: len as usize,
            scalars,
        })
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Number of unknowns of the grid; those of rigid bodies follow.
    pub fn of_grid(&self) -> usize {
        self.of_grid
    }

    /// Number of nodes of the grid.
    pub(crate) fn nodes_of_grid(&self) -> usize {
        self.active.len()
    }

    /// Whether there is no unknown: never, by construction.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The first of the nodes that stand for a scalar, which is the first component of each.
    pub fn first_scalar(&self) -> usize {
        self.rank.len()
    }

    /// The nodes of the grid with an unknown scalar, ascending, in the order of the nodes that stand for it.
    pub fn scalar_nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.scalars.iter().map(|&(_, node)| node as usize)
    }

    /// The scalars of some nodes of the grid, by their number.
    pub(crate) fn scalars_of(&self, nodes: &Range<usize>) -> Range<usize> {
        let before =
            |end: usize| (self.scalars).partition_point(|&(_, node)| (node as usize) < end);
        before(nodes.start)..before(nodes.end)
    }

    /// Number of unknowns that are scalars.
    pub(crate) fn scalar_count(&self) -> usize {
        self.scalars.len()
    }

    /// The unknown of a node's component, if it is free.
    #[inline]
    pub fn index(&self, node: usize, axis: usize) -> Option<usize> {
        let Some(rank) = self.rank.get(node) else {
            let (unknown, _) = self.scalars[node - self.rank.len()];
            return (axis == 0).then_some(unknown as usize);
        };
        let rank = rank[axis];
        (rank != NONE).then(|| (self.first[node] + rank) as usize)
    }

    /// The node and the axis of an unknown, if it exists; of a scalar the node that stands for it.
    pub fn place(&self, unknown: usize) -> Option<(usize, usize)> {
        let among = (self.scalars).binary_search_by_key(&unknown, |&(scalar, _)| scalar as usize);
        if let Ok(place) = among {
            return Some((self.rank.len() + place, 0));
        }
        let after = self
            .first
            .partition_point(|&first| first as usize <= unknown);
        let node = after.checked_sub(1).filter(|_| unknown < self.len)?;
        let axis = (0..D).find(|&axis| self.index(node, axis) == Some(unknown))?;
        Some((node, axis))
    }

    /// Whether a node takes part: it carries enough volume.
    pub fn is_active(&self, node: usize) -> bool {
        self.active[node]
    }

    /// The node of the grid in whose block of the matrix the unknowns of a node are: itself, but for a scalar.
    #[inline]
    pub(crate) fn block_node(&self, node: usize) -> usize {
        match node.checked_sub(self.rank.len()) {
            Some(place) => self.scalars[place].1 as usize,
            None => node,
        }
    }

    /// Number of unknowns on nodes before `node`.
    pub(crate) fn before(&self, node: usize) -> usize {
        self.first[node] as usize
    }

    /// Number of nodes with unknowns before `node`.
    pub(crate) fn blocks_before(&self, node: usize) -> usize {
        self.blocks_before[node] as usize
    }

    /// The free components of a node with their unknowns.
    #[inline]
    pub(crate) fn of(&self, node: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..D).filter_map(move |axis| self.index(node, axis).map(|unknown| (axis, unknown)))
    }

    /// The free components of displacement of a node, one bit each.
    #[inline]
    pub(crate) fn free(&self, node: usize) -> u8 {
        let mut free = 0;
        for axis in 0..D {
            free |= u8::from(self.rank[node][axis] != NONE) << axis;
        }
        free
    }

    /// Number of unknowns of a node of the grid, a scalar included.
    pub(crate) fn count(&self, node: usize) -> u32 {
        self.first[node + 1] - self.first[node]
    }
}
