//! Where the blocks of the tangent matrix are stored: a table over pairs of nodes that are close, and
//! lists for the few nodes with couplings that reach further.

use std::collections::{BTreeMap, BTreeSet};

use igimp_linear::{NodeBlock, Pattern, SCALAR};
use igimp_shape::{Grid, Support};

use crate::equations::reach::{SMALL_REACH, common_reach, furthest, same_nodes};
use crate::step::stencils::Stencils;
use crate::step::unknowns::Unknowns;

/// Marks a pair of nodes without a block, or a node without unknowns.
const NONE: u32 = u32::MAX;

/// Places of node blocks in the columns of the tangent matrix, found by the difference of the
/// nodes' places on the grid.
#[derive(Clone, Debug)]
pub(crate) struct BlockTable<const D: usize> {
    pub(crate) nodes: Vec<NodePlace>,
    /// The reach of nearly all nodes.
    pub(crate) near: usize,
    /// Pairs of nodes that a column node may have: a window of (2 reach + 1)^D nodes, with the reach
    /// of nearly all nodes.
    window: usize,
    /// Offset within a column of node j of the first row of node i, by the block of j and
    /// code(i) − code(j).
    offsets: Vec<u32>,
    /// The same for column nodes that reach beyond the window: by the block of j, the blocks of its
    /// rows, ascending, with their offsets. One wide particle must not widen the window of all.
    wide: BTreeMap<u32, Vec<(u32, u32)>>,
}

/// Data of a node for scattering.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodePlace {
    /// A number such that differences of it stand for the distance of two nodes.
    pub(crate) code: u32,
    /// Its block in the pattern, or [`NONE`].
    pub(crate) block: u32,
    /// First of its unknowns.
    pub(crate) first: u32,
    /// How many components of its displacement are unknown. A scalar that is unknown follows them.
    pub(crate) len: u8,
    /// Which components they are, one bit each.
    pub(crate) free: u8,
    /// Whether a scalar of it is unknown: its pore pressure or its nonlocal strain.
    pub(crate) has_scalar: bool,
    /// Whether some of its couplings reach beyond the window.
    is_wide: bool,
}

impl NodePlace {
    /// The components that are unknown.
    #[inline]
    pub(crate) fn components(&self) -> impl Iterator<Item = usize> + use<> {
        let free = self.free;
        (0..8).filter(move |axis| free & (1 << axis) != 0)
    }
}

impl<const D: usize> BlockTable<D> {
    /// Finds the coupled nodes, and with them the sparsity pattern. `extra` lists further coupled
    /// pairs of nodes, both ways.
    pub(crate) fn build(
        grid: &Grid<D>,
        stencils: &Stencils<D>,
        unknowns: &Unknowns<D>,
        extra: &[(usize, usize)],
    ) -> (Self, Pattern) {
        let apart = |&(a, b): &(usize, usize)| {
            let places = std::iter::zip(grid.node_place(a), grid.node_place(b));
            places.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
        };
        let reach = extra.iter().map(apart).fold(stencils.reach(), usize::max);
        let (near, is_wide) = if reach > SMALL_REACH {
            let far = extra.iter().map(|pair| (*pair, apart(pair)));
            common_reach(&furthest(grid, stencils, far), reach)
        } else {
            (reach, Vec::new())
        };
        let side = 2 * near + 1;
        let mut table = Self {
            nodes: Vec::with_capacity(grid.node_count()),
            near,
            window: side.pow(D as u32),
            offsets: Vec::new(),
            wide: BTreeMap::new(),
        };
        let mut blocks = Vec::new();
        for node in 0..grid.node_count() {
            let place = grid.node_place(node);
            let code = place.iter().rev().fold(0, |code, &k| code * side + k);
            let len = unknowns.count(node) as usize;
            let block = if len == 0 { NONE } else { blocks.len() as u32 };
            let has_scalar = len > unknowns.free(node).count_ones() as usize;
            table.nodes.push(NodePlace {
                code: u32::try_from(code).expect("fewer than 2^32 places"),
                block,
                first: unknowns.before(node) as u32,
                len: unknowns.free(node).count_ones() as u8,
                free: unknowns.free(node),
                has_scalar,
                is_wide: is_wide.get(node).is_some_and(|&is_wide| is_wide),
            });
            if len > 0 {
                let mut block_place = [0; 3];
                block_place[..D].copy_from_slice(&place);
                blocks.push(NodeBlock {
                    first: unknowns.before(node),
                    len,
                    free: unknowns.free(node) | if has_scalar { SCALAR } else { 0 },
                    place: block_place,
                });
            }
        }
        table.offsets = vec![NONE; blocks.len() * table.window];
        let wide = table.mark(grid, stencils, extra);
        let (starts, coupled) = table.number(grid, unknowns, near, &wide);
        let pattern = Pattern::new(blocks, starts, coupled, reach);
        (table, pattern)
    }

    /// Marks the coupled pairs. Particles that touch the same box of nodes couple the same pairs, and those of
    /// a box within it: each box that is in no other from the same node is marked once. Returns the row
    /// nodes of each wide column node.
    fn mark(
        &mut self,
        grid: &Grid<D>,
        stencils: &Stencils<D>,
        extra: &[(usize, usize)],
    ) -> BTreeMap<usize, BTreeSet<usize>> {
        let mut wide = BTreeMap::new();
        let mut last: &[Support<D>] = &[];
        let mut shapes = vec![0_u64; grid.node_count()];
        let mut nodes = Vec::new();
        for &particle in stencils.order() {
            let supports = stencils.of(particle as usize);
            if same_nodes(supports, last) {
                continue;
            }
            last = supports;
            if let Some(extent) = box_extent(grid, supports) {
                shapes[supports[0].node] |= 1 << shape(extent);
            } else {
                nodes.clear();
                nodes.extend(supports.iter().map(|support| support.node));
                self.couple_all(&nodes, &mut wide);
            }
        }
        let begun = shapes.into_iter().enumerate();
        for (first, shapes) in begun.filter(|&(_, shapes)| shapes != 0) {
            for extent in outermost::<D>(shapes) {
                nodes.clear();
                nodes.extend(box_nodes(grid, first, extent));
                self.couple_all(&nodes, &mut wide);
            }
        }
        for &(column, row) in extra {
            if self.nodes[column].block != NONE && self.nodes[row].block != NONE {
                self.couple(column, row, &mut wide);
            }
        }
        wide
    }

    /// Couples nodes with each other.
    fn couple_all(&mut self, nodes: &[usize], wide: &mut BTreeMap<usize, BTreeSet<usize>>) {
        for &column in nodes {
            if self.nodes[column].block == NONE {
                continue;
            }
            for &row in nodes {
                if self.nodes[row].block != NONE {
                    self.couple(column, row, wide);
                }
            }
        }
    }

    #[inline]
    fn couple(&mut self, column: usize, row: usize, wide: &mut BTreeMap<usize, BTreeSet<usize>>) {
        if self.nodes[column].is_wide {
            wide.entry(column).or_default().insert(row);
        } else {
            let slot = self.slot(column, row);
            self.offsets[slot] = 0;
        }
    }

    /// Turns the marks of coupled nodes into offsets, and lists the coupled blocks of each block.
    fn number(
        &mut self,
        grid: &Grid<D>,
        unknowns: &Unknowns<D>,
        reach: usize,
        wide: &BTreeMap<usize, BTreeSet<usize>>,
    ) -> (Vec<usize>, Vec<u32>) {
        // How far, in node numbers, the node of each slot is from the middle of the window.
        let strides: [usize; D] =
            std::array::from_fn(|axis| (0..axis).map(|a| grid.axes[a].node_count()).product());
        let distances: Vec<isize> = (0..self.window)
            .map(|slot| {
                let mut rest = slot;
                let mut distance = 0;
                for stride in strides {
                    let step = rest % (2 * reach + 1);
                    rest /= 2 * reach + 1;
                    distance += (step as isize - reach as isize) * stride as isize;
                }
                distance
            })
            .collect();
        let blocks = self.offsets.len() / self.window;
        let mut starts = Vec::with_capacity(blocks + 1);
        let mut coupled = Vec::with_capacity(blocks * 5_usize.pow(D as u32));
        starts.push(0);
        let columns = (0..grid.node_count()).filter(|&node| unknowns.count(node) > 0);
        for (column, offsets) in columns.zip(self.offsets.chunks_exact_mut(self.window)) {
            let mut height = 0;
            if let Some(rows) = wide.get(&column) {
                let mut list = Vec::with_capacity(rows.len());
                for &row in rows {
                    list.push((self.nodes[row].block, height));
                    height += unknowns.count(row);
                    coupled.push(self.nodes[row].block);
                }
                self.wide.insert(self.nodes[column].block, list);
            } else {
                for (offset, &distance) in offsets.iter_mut().zip(&distances) {
                    if *offset != NONE {
                        let row = column.wrapping_add_signed(distance);
                        *offset = height;
                        height += unknowns.count(row);
                        coupled.push(self.nodes[row].block);
                    }
                }
            }
            starts.push(coupled.len());
        }
        (starts, coupled)
    }

    /// Where the row of an unknown of node `row` is stored in the column of the unknown that is
    /// `component`-th of node `column`; both nodes must be coupled. The row is the first of its
    /// node.
    #[inline]
    pub(crate) fn value(
        &self,
        pattern: &Pattern,
        column: usize,
        component: usize,
        row: usize,
    ) -> usize {
        let block = self.nodes[column].block as usize;
        let row = &self.nodes[row];
        pattern.values_of(block).start
            + component * pattern.height(block)
            + self.offsets_of(column)(row.code, row.block)
    }

    /// The offset within a column of a node of the first row of another, by the code and the block
    /// of that.
    #[inline]
    pub(crate) fn offsets_of(&self, column: usize) -> impl Fn(u32, u32) -> usize + '_ {
        let column = &self.nodes[column];
        let centre = (self.window as u32 - 1) / 2;
        let offsets = &self.offsets[column.block as usize * self.window..][..self.window];
        let wide: &[(u32, u32)] = if column.is_wide {
            &self.wide[&column.block]
        } else {
            &[]
        };
        move |code, block| {
            if wide.is_empty() {
                offsets[(code + centre - column.code) as usize] as usize
            } else {
                wide[wide.partition_point(|&(other, _)| other < block)].1 as usize
            }
        }
    }

    /// The same for a node that need not be coupled, by its code alone; `None` for a column node whose couplings reach
    /// beyond the window.
    #[inline]
    pub(crate) fn near_offsets(&self, column: usize) -> Option<impl Fn(u32) -> Option<usize> + '_> {
        let column = &self.nodes[column];
        let centre = (self.window as u32 - 1) / 2;
        let offsets = &self.offsets[column.block as usize * self.window..][..self.window];
        (!column.is_wide).then_some(move |code: u32| {
            let offset = offsets[(code + centre - column.code) as usize];
            (offset != NONE).then_some(offset as usize)
        })
    }

    /// The same for a node that need not be coupled, but is within the window.
    #[inline]
    pub(crate) fn offsets_if_coupled(&self, column: usize) -> impl Fn(u32, u32) -> Option<usize> {
        let column = &self.nodes[column];
        let centre = (self.window as u32 - 1) / 2;
        let offsets = &self.offsets[column.block as usize * self.window..][..self.window];
        let wide = column.is_wide.then(|| &self.wide[&column.block]);
        move |code, block| match wide {
            Some(wide) => {
                let place = wide.binary_search_by_key(&block, |&(other, _)| other);
                place.ok().map(|place| wide[place].1 as usize)
            }
            None => Some(offsets[(code + centre - column.code) as usize])
                .filter(|&offset| offset != NONE)
                .map(|offset| offset as usize),
        }
    }

    /// How many places the table holds.
    #[cfg(test)]
    pub(crate) fn places(&self) -> usize {
        self.offsets.len() + self.wide.values().map(Vec::len).sum::<usize>()
    }

    #[inline]
    fn slot(&self, column: usize, row: usize) -> usize {
        let (column, row) = (&self.nodes[column], &self.nodes[row]);
        let centre = (self.window as u32 - 1) / 2;
        column.block as usize * self.window + (row.code + centre - column.code) as usize
    }
}

/// The nodes of a box from its first one on, ascending.
#[inline]
fn box_nodes<const D: usize>(
    grid: &Grid<D>,
    first: usize,
    extent: [usize; D],
) -> impl Iterator<Item = usize> {
    let mut stride = 1;
    let strides: [usize; D] = std::array::from_fn(|axis| {
        let step = stride;
        stride *= grid.axes[axis].node_count();
        step
    });
    let count = extent.iter().map(|extent| extent + 1).product();
    let mut place = [0; D];
    let mut node = first;
    (0..count).map(move |_| {
        let current = node;
        for axis in 0..D {
            if place[axis] < extent[axis] {
                place[axis] += 1;
                node += strides[axis];
                break;
            }
            node -= place[axis] * strides[axis];
            place[axis] = 0;
        }
        current
    })
}

/// Sides of boxes up to this many nodes have a shape.
const SIDES: usize = 4;

/// How far the box extends that supports fill, in nodes along each axis; `None` when they do not fill it, or when it
/// is larger than any common one.
#[inline]
fn box_extent<const D: usize>(grid: &Grid<D>, supports: &[Support<D>]) -> Option<[usize; D]> {
    let (first, last) = (supports[0].node, supports[supports.len() - 1].node);
    let places = (grid.node_place(first), grid.node_place(last));
    let mut extent = [0; D];
    for axis in 0..D {
        extent[axis] = places.1[axis].checked_sub(places.0[axis])?;
        if extent[axis] >= SIDES {
            return None;
        }
    }
    let nodes = supports.iter().map(|support| support.node);
    nodes.eq(box_nodes(grid, first, extent)).then_some(extent)
}

/// A number for the sides of a box.
fn shape<const D: usize>(extent: [usize; D]) -> usize {
    extent.iter().rev().fold(0, |code, e| code * SIDES + e)
}

/// The boxes of some shapes, one bit each, that are in no other of them.
fn outermost<const D: usize>(shapes: u64) -> impl Iterator<Item = [usize; D]> {
    let extent = |shape: usize| -> [usize; D] {
        std::array::from_fn(|axis| shape / SIDES.pow(axis as u32) % SIDES)
    };
    let all = move || {
        let mut rest = shapes;
        std::iter::from_fn(move || {
            let shape = rest.trailing_zeros() as usize;
            let some = rest != 0;
            rest &= rest.wrapping_sub(1);
            some.then_some(shape)
        })
    };
    let is_within = move |shape: usize, other: usize| {
        other != shape && std::iter::zip(extent(shape), extent(other)).all(|(a, b)| a <= b)
    };
    all()
        .filter(move |&shape| !all().any(|other| is_within(shape, other)))
        .map(extent)
}
