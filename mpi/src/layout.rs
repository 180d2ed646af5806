//! From the matrix of rank 0 to ranges of rows: which nodes each rank has, and their entries by rows.
//!
//! Nodes stand in the order of the geometric dissection, which keeps neighbours together, and each rank has a run of them. All
//! nodes have as many rows as the problem has dimensions, and one more where pressures are among the unknowns; a component that is
//! held, or is not there, has a row of its own with its diagonal alone.

use std::ops::Range;
use std::sync::Arc;

use igimp_linear::{
    LinearSolverError, NestedDissection, NodeBlock, Pattern, SCALAR, TangentMatrix,
};
use rayon::prelude::*;

/// Nodes that a thread takes at a time.
const PIECE: usize = 256;

/// The rows of a rank as they are sent: blocks by node, in the order of all ranks.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct RankPattern {
    /// Where the list of each node begins in `columns`, one more than nodes.
    pub(crate) starts: Vec<u32>,
    /// Nodes that each is coupled to, ascending.
    pub(crate) columns: Vec<u32>,
    /// Coordinates of the nodes, component by component \[m\].
    pub(crate) coordinates: Vec<f64>,
}

impl RankPattern {
    /// Rows unknown by unknown: starts and columns.
    pub(crate) fn by_unknowns(&self, rows: usize) -> (Vec<i32>, Vec<i32>) {
        let mut starts = vec![0];
        let mut columns = Vec::with_capacity(self.columns.len() * rows * rows);
        for list in self.starts.windows(2) {
            let list = &self.columns[list[0] as usize..list[1] as usize];
            for _ in 0..rows {
                columns.extend(list.iter().flat_map(|&node| {
                    let first = node as usize * rows;
                    (first..first + rows).map(|column| column as i32)
                }));
                starts.push(columns.len() as i32);
            }
        }
        (starts, columns)
    }
}

/// The components of the unknowns of a node: axes, and after them pressure.
type Components = [u8; 4];

/// How the rows of a pattern are spread over ranks.
#[derive(Debug)]
pub(crate) struct Layout {
    pattern: Arc<Pattern>,
    /// Dimensions of the problem.
    pub(crate) dims: usize,
    /// Rows of a node.
    pub(crate) rows: usize,
    /// Blocks of the pattern in the order of all ranks.
    order: Vec<u32>,
    /// The nodes of each rank in that order.
    ranges: Vec<Range<usize>>,
    /// By node in that order, where its couplings begin in `couplings`.
    starts: Vec<usize>,
    /// Entries of `Pattern::coupled`, those of a node by ascending place of the other in that order.
    couplings: Vec<u32>,
    /// By entry of `Pattern::coupled`, where the rows of the node begin within a column of the other.
    within: Vec<u32>,
    /// By block of the pattern the component of each of its unknowns, and whether others are held.
    components: Vec<Components>,
}

impl Layout {
    /// Spreads a pattern over so many ranks.
    pub(crate) fn new(pattern: &Arc<Pattern>, ranks: usize) -> Result<Self, LinearSolverError> {
        let within = pattern.rows_within_columns()?;
        let nodes = pattern.blocks.len();
        let order: Vec<u32> = NestedDissection::new(pattern)
            .nodes
            .iter()
            .map(|&node| node as u32)
            .collect();
        let mut place = vec![0; nodes];
        for (new, &old) in order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let (mut starts, mut couplings) = (vec![0], Vec::with_capacity(pattern.coupled.len()));
        for &old in &order {
            let begin = couplings.len();
            let entries = pattern.starts[old as usize]..pattern.starts[old as usize + 1];
            couplings.extend(entries.map(|entry| entry as u32));
            couplings[begin..]
                .sort_unstable_by_key(|&entry| place[pattern.coupled[entry as usize] as usize]);
            starts.push(couplings.len());
        }
        let dims = dimensions(pattern);
        let rows = dims + usize::from(pattern.has_scalars());
        if pattern.unknowns().max(nodes * rows) > i32::MAX as usize
            || pattern.coupled.len() > u32::MAX as usize
        {
            let part = "indices of 32 bits for PETSc";
            return Err(LinearSolverError::OutOfMemory { part });
        }
        Ok(Self {
            pattern: Arc::clone(pattern),
            dims,
            rows,
            ranges: ranges(&starts, ranks),
            order,
            starts,
            couplings,
            within,
            components: components(pattern, dims),
        })
    }

    /// Whether it was made for this pattern.
    pub(crate) fn is_of(&self, pattern: &Arc<Pattern>) -> bool {
        Arc::ptr_eq(&self.pattern, pattern) || self.pattern == *pattern
    }

    /// Unknowns of all ranks, with those of components that are held.
    pub(crate) fn unknowns(&self) -> usize {
        self.order.len() * self.rows
    }

    /// The rows of a rank; `lines` are the coordinates of the lines of the grid along each axis.
    pub(crate) fn of_rank(&self, rank: usize, lines: &[Vec<f64>]) -> RankPattern {
        let nodes = self.ranges[rank].clone();
        let mut place = vec![0; self.order.len()];
        for (new, &old) in self.order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let first = self.starts[nodes.start];
        let own = first..self.starts[nodes.end];
        let coordinate = |old: u32, axis: usize| {
            let at = self.pattern.blocks[old as usize].place[axis];
            let line = lines.get(axis).and_then(|lines| lines.get(at));
            line.copied().unwrap_or(at as f64)
        };
        RankPattern {
            starts: self.starts[nodes.start..=nodes.end]
                .iter()
                .map(|start| (start - first) as u32)
                .collect(),
            columns: self.couplings[own]
                .iter()
                .map(|&entry| place[self.pattern.coupled[entry as usize] as usize])
                .collect(),
            coordinates: self.order[nodes]
                .iter()
                .flat_map(|&old| (0..self.dims).map(move |axis| coordinate(old, axis)))
                .collect(),
        }
    }

    /// The values of the rows of a rank; rows of components that are held have `held` on their diagonal.
    pub(crate) fn values_of(&self, rank: usize, matrix: &TangentMatrix, held: f64) -> Vec<f64> {
        let nodes = self.ranges[rank].clone();
        let square = self.rows * self.rows;
        let first = self.starts[nodes.start];
        let mut values = vec![0.0; (self.starts[nodes.end] - first) * square];
        let mut pieces = Vec::new();
        let mut rest = &mut values[..];
        let mut begin = nodes.start;
        while begin < nodes.end {
            let end = (begin + PIECE).min(nodes.end);
            let (own, behind) = rest.split_at_mut((self.starts[end] - self.starts[begin]) * square);
            pieces.push((begin..end, own));
            (rest, begin) = (behind, end);
        }
        pieces.into_par_iter().for_each(|(nodes, mut own)| {
            for node in nodes {
                let len = (self.starts[node + 1] - self.starts[node]) * square;
                let (rows, behind) = own.split_at_mut(len);
                self.rows_of(node, matrix, held, rows);
                own = behind;
            }
        });
        values
    }

    /// The rows of a node.
    fn rows_of(&self, node: usize, matrix: &TangentMatrix, held: f64, rows: &mut [f64]) {
        let (pattern, count) = (&*self.pattern, self.rows);
        let old = self.order[node] as usize;
        let own = pattern.blocks[old].len;
        let couplings = &self.couplings[self.starts[node]..self.starts[node + 1]];
        let width = couplings.len() * count;
        for (position, &entry) in couplings.iter().enumerate() {
            let other = pattern.coupled[entry as usize] as usize;
            let (height, first) = (pattern.height(other), pattern.first_value[other]);
            let offset = first + self.within[entry as usize] as usize;
            let (of_own, of_other) = (&self.components[old], &self.components[other]);
            let columns = of_other[..pattern.blocks[other].len].iter();
            for (column, &component) in columns.enumerate() {
                let at = position * count + component as usize;
                let values = &matrix.values[offset + column * height..][..own];
                for (&row, &value) in of_own.iter().zip(values) {
                    rows[row as usize * width + at] = value;
                }
            }
            if other == old {
                for component in (0..count).filter(|&own_one| is_held(*of_own, own, own_one)) {
                    rows[component * width + position * count + component] = held;
                }
            }
        }
    }

    /// The entries of a vector over all unknowns of the pattern that a rank has.
    pub(crate) fn part_of(&self, rank: usize, vector: &[f64]) -> Vec<f64> {
        let mut part = vec![0.0; self.ranges[rank].len() * self.rows];
        self.each_of(rank, |at, unknown| part[at] = vector[unknown]);
        part
    }

    /// Writes the part of a rank into a vector over all unknowns of the pattern.
    pub(crate) fn put(&self, rank: usize, part: &[f64], vector: &mut [f64]) {
        self.each_of(rank, |at, unknown| vector[unknown] = part[at]);
    }

    /// Visits the unknowns of a rank: their place in its part, and in the pattern.
    fn each_of(&self, rank: usize, mut visit: impl FnMut(usize, usize)) {
        let nodes = self.ranges[rank].clone();
        for (index, &old) in self.order[nodes].iter().enumerate() {
            let block = self.pattern.blocks[old as usize];
            for local in 0..block.len {
                let component = self.components[old as usize][local] as usize;
                visit(index * self.rows + component, block.first + local);
            }
        }
    }
}

/// Dimensions of a problem: 3 where a node has a third coordinate or displacement.
fn dimensions(pattern: &Pattern) -> usize {
    let of_block = |block: &NodeBlock| {
        let by_place = block.place.iter().rposition(|&along| along != 0);
        let displacements = block.len - usize::from(block.free & SCALAR != 0);
        displacements.max(by_place.map_or(1, |axis| axis + 1))
    };
    pattern.blocks.iter().map(of_block).max().unwrap_or(1)
}

/// By block the component of each of its unknowns.
fn components(pattern: &Pattern, dims: usize) -> Vec<Components> {
    let of_block = |block: &NodeBlock| {
        let mut found = [0, 1, 2, 3];
        let axes = (0..dims as u8).filter(|&axis| block.free >> axis & 1 == 1);
        let pressure = (block.free & SCALAR != 0).then_some(dims as u8);
        if block.free.count_ones() as usize == block.len {
            for (own, component) in found.iter_mut().zip(axes.chain(pressure)) {
                *own = component;
            }
        }
        found
    };
    pattern.blocks.iter().map(of_block).collect()
}

/// Whether a component of a node is no unknown.
fn is_held(components: Components, len: usize, component: usize) -> bool {
    let mut free = components[..len].iter();
    !free.any(|&own| own as usize == component)
}

/// Runs of nodes with about the same number of entries; a rank may have none where there are few.
fn ranges(starts: &[usize], ranks: usize) -> Vec<Range<usize>> {
    let (nodes, all) = (starts.len() - 1, starts[starts.len() - 1]);
    let end = |rank: usize| {
        let wanted = (all as u128 * rank as u128 / ranks as u128) as usize;
        starts.partition_point(|&start| start < wanted).min(nodes)
    };
    (0..ranks).map(|rank| end(rank)..end(rank + 1)).collect()
}

#[cfg(test)]
mod tests {
    use igimp_linear::Border;

    use super::*;

    /// A row of nodes in the plane, the first held across, each coupled to its neighbours; every second one with a pressure where
    /// there are some.
    fn pattern(nodes: usize, has_pressures: bool) -> Arc<Pattern> {
        let (mut blocks, mut starts, mut coupled, mut first) = (vec![], vec![0], vec![], 0);
        for node in 0..nodes {
            let (mut len, mut free) = if node == 0 { (1, 0b10) } else { (2, 0b11) };
            if has_pressures && node % 2 == 0 {
                (len, free) = (len + 1, free | SCALAR);
            }
            let place = [node, 1, 0];
            blocks.push(NodeBlock {
                first,
                len,
                free,
                place,
            });
            first += len;
            let near = node.saturating_sub(1)..(node + 2).min(nodes);
            coupled.extend(near.map(|other| other as u32));
            starts.push(coupled.len());
        }
        Arc::new(Pattern::new(blocks, starts, coupled, 1))
    }

    fn matrix(pattern: &Arc<Pattern>) -> TangentMatrix {
        let values = (0..pattern.stored())
            .map(|k| (k as f64 + 1.0).sin())
            .collect();
        TangentMatrix {
            pattern: Arc::clone(pattern),
            values,
            symmetric: false,
            border: Border::default(),
        }
    }

    /// GOAL: the rows of all ranks together are the matrix, for more ranks than there are nodes too.
    /// ORACLE: its product by columns.
    #[test]
    fn rows_of_ranks_are_the_matrix() {
        let sizes = [(40, 1), (40, 3), (2, 4)];
        for ((nodes, ranks), coupled) in sizes
            .into_iter()
            .flat_map(|own| [(own, false), (own, true)])
        {
            let pattern = pattern(nodes, coupled);
            let rows_of_node = 2 + usize::from(coupled);
            let matrix = matrix(&pattern);
            let layout = Layout::new(&pattern, ranks).unwrap();
            assert_eq!((layout.dims, layout.rows), (2, rows_of_node));
            assert_eq!(layout.unknowns(), rows_of_node * nodes);
            let x: Vec<f64> = (0..pattern.unknowns()).map(|k| 1.0 + k as f64).collect();
            let mut expected = vec![0.0; x.len()];
            matrix.multiply(&x, &mut expected);
            let parts = (0..ranks).flat_map(|rank| layout.part_of(rank, &x));
            let all: Vec<f64> = parts.collect();
            let mut found = vec![f64::NAN; x.len()];
            for rank in 0..ranks {
                let (starts, columns) = layout.of_rank(rank, &[]).by_unknowns(rows_of_node);
                let values = layout.values_of(rank, &matrix, 7.0);
                assert_eq!(values.len(), columns.len());
                let rows = starts.windows(2).map(|ends| {
                    let row = ends[0] as usize..ends[1] as usize;
                    assert!(columns[row.clone()].is_sorted_by(|a, b| a < b));
                    row.map(|k| values[k] * all[columns[k] as usize]).sum()
                });
                layout.put(rank, &rows.collect::<Vec<f64>>(), &mut found);
            }
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        }
    }

    /// GOAL: a component that is held has its diagonal alone, and nodes stand where the lines of the grid are.
    #[test]
    fn held_components_are_apart() {
        let pattern = pattern(3, false);
        let layout = Layout::new(&pattern, 1).unwrap();
        let lines = [vec![0.0, 2.0, 6.0], vec![-1.0, 5.0]];
        let own = layout.of_rank(0, &lines);
        let node = (0..3).find(|&k| own.coordinates[2 * k] == 0.0).unwrap();
        assert!((own.coordinates[2 * node + 1] - 5.0).abs() < 1e-12);
        let (starts, columns) = own.by_unknowns(2);
        let values = layout.values_of(0, &matrix(&pattern), 7.0);
        let row = starts[2 * node] as usize..starts[2 * node + 1] as usize;
        let filled: Vec<_> = row.filter(|&k| values[k] != 0.0).collect();
        assert_eq!(filled.len(), 1);
        assert_eq!(
            (columns[filled[0]], values[filled[0]]),
            (2 * node as i32, 7.0)
        );
    }

    /// GOAL: ranks have about the same number of entries.
    #[test]
    fn ranks_have_equal_shares() {
        let layout = Layout::new(&pattern(1000, false), 4).unwrap();
        let shares = (0..4).map(|rank| layout.of_rank(rank, &[]).columns.len());
        for share in shares {
            assert!((700..=800).contains(&share), "{share}");
        }
    }
}
