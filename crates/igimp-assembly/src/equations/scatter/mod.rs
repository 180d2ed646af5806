//! From the tangent of one particle into the matrix: its unknown rows as runs that lie one after the
//! other in every column, and its columns one by one.

pub(crate) mod scalar;
pub(crate) mod water;

use igimp_linear::Pattern;
use igimp_shape::Support;

use crate::equations::blocks::BlockTable;
use crate::equations::linearised::Linearised;

/// The unknown rows of one particle.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    runs: Vec<Run>,
}

/// Rows that follow one another in a particle, and whose values do so in every column of the matrix.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// First row.
    first: u32,
    len: u32,
    /// Code and block of the node of the first row, and how many unknowns of the node stand before it.
    code: u32,
    block: u32,
    rank: u32,
    /// Code of the last node, and how many rows of the run stand before its own.
    code_of_last: u32,
    before_last: u32,
}

/// Rows that follow one another, and so do their values in the columns of a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) first: usize,
    pub(crate) len: usize,
    /// Where the first one is in the columns.
    pub(crate) offset: usize,
}

impl Rows {
    /// Lists the unknown rows of some nodes, which have D rows each, and one more for their scalar if `with_scalar`.
    #[allow(
        clippy::inline_always,
        reason = "a constant where it is called, which it has to reach the loop"
    )]
    #[inline(always)]
    pub(crate) fn set<const D: usize>(
        &mut self,
        nodes: impl Iterator<Item = usize>,
        table: &BlockTable<D>,
        with_scalar: bool,
    ) {
        let of_node = D + usize::from(with_scalar);
        self.runs.clear();
        // The row and the unknown that would make the last run longer.
        let mut next = (u32::MAX, u32::MAX);
        for (i, node) in nodes.enumerate() {
            let node = &table.nodes[node];
            let mut add = |first: u32, rank: u32, len: u32| {
                let here = (first, node.first + rank);
                match self.runs.last_mut() {
                    Some(run) if here == next => {
                        if rank == 0 {
                            run.code_of_last = node.code;
                            run.before_last = run.len;
                        }
                        run.len += len;
                    }
                    _ => self.runs.push(Run {
                        first,
                        len,
                        code: node.code,
                        block: node.block,
                        rank,
                        code_of_last: node.code,
                        before_last: 0,
                    }),
                }
                next = (here.0 + len, here.1 + len);
            };
            let first = (i * of_node) as u32;
            let has_scalar = with_scalar && node.has_scalar;
            if usize::from(node.len) == D && has_scalar == with_scalar {
                add(first, 0, of_node as u32);
                continue;
            }
            for (rank, axis) in node.components().enumerate() {
                add(first + axis as u32, rank as u32, 1);
            }
            if has_scalar {
                add(first + D as u32, u32::from(node.len), 1);
            }
        }
    }

    /// Adds the tangent of one particle to the slice of values that begins at `start`.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn scatter<const D: usize>(
        &self,
        supports: &[Support<D>],
        (table, pattern): (&BlockTable<D>, &Pattern),
        linearised: &mut Linearised<D>,
        (start, slice): (usize, &mut [f64]),
    ) {
        for (j, support) in supports.iter().enumerate() {
            let column = &table.nodes[support.node];
            if column.len == 0 {
                continue;
            }
            let columns = linearised.columns(j);
            let stored = pattern.values_of(column.block as usize);
            let values = &mut slice[stored.start - start..stored.end - start];
            let offsets = table.offsets_of(support.node);
            let offset = |run: &Run| offsets(run.code, run.block) + run.rank as usize;
            let height = pattern.height(column.block as usize);
            if usize::from(column.len) == D {
                for run in &self.runs {
                    let offset = offset(run);
                    for c in 0..D {
                        let sums = &mut values[c * height + offset..];
                        add(sums, &columns[c][run.first as usize..], run.len as usize);
                    }
                }
            } else {
                for run in &self.runs {
                    let offset = offset(run);
                    for (rank, c) in column.components().enumerate() {
                        let sums = &mut values[rank * height + offset..];
                        add(sums, &columns[c][run.first as usize..], run.len as usize);
                    }
                }
            }
        }
    }

    /// Lists the rows from `first` on that one of the listed `nodes` is coupled to.
    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    pub(crate) fn coupled<const D: usize>(
        &self,
        (table, nodes): (&BlockTable<D>, &[usize]),
        node: usize,
        first: usize,
        pieces: &mut Vec<Piece>,
    ) {
        let near = table.near_offsets(node);
        for run in &self.runs {
            let rows = run.first as usize..(run.first + run.len) as usize;
            if rows.end <= first {
                continue;
            }
            let whole = near.as_ref().and_then(|near| {
                let begin = near(run.code)? + run.rank as usize;
                let is_whole = run.before_last == 0
                    || near(run.code_of_last) == Some(begin + run.before_last as usize);
                is_whole.then_some(begin)
            });
            if let Some(offset) = whole {
                let from = rows.start.max(first);
                pieces.push(Piece {
                    first: from,
                    len: rows.end - from,
                    offset: offset + from - rows.start,
                });
                continue;
            }
            // Some nodes of the run may be coupled, and others not.
            let offset = table.offsets_if_coupled(node);
            let mut done = rows.start;
            while done < rows.end {
                let i = done / D;
                let row = &table.nodes[nodes[i]];
                let rank = if done == rows.start { run.rank } else { 0 };
                let part = done..rows.end.min((i + 1) * D);
                let from = part.start.max(first);
                if let Some(offset) = offset(row.code, row.block).filter(|_| from < part.end) {
                    pieces.push(Piece {
                        first: from,
                        len: part.end - from,
                        offset: offset + rank as usize + from - part.start,
                    });
                }
                done = part.end;
            }
        }
    }
}

/// Adds the first `len` terms to the first `len` sums.
#[allow(
    clippy::inline_always,
    reason = "compiled for the instructions of the caller"
)]
#[inline(always)]
pub(crate) fn add(sums: &mut [f64], terms: &[f64], len: usize) {
    match len {
        3 => add_all::<3>(sums, terms),
        4 => add_all::<4>(sums, terms),
        6 => add_all::<6>(sums, terms),
        9 => add_all::<9>(sums, terms),
        _ => {
            for (sum, term) in sums.iter_mut().zip(&terms[..len]) {
                *sum += term;
            }
        }
    }
}

/// The same for a number that is known: so few that nothing is left of the loop.
#[allow(
    clippy::inline_always,
    reason = "compiled for the instructions of the caller"
)]
#[inline(always)]
fn add_all<const N: usize>(sums: &mut [f64], terms: &[f64]) {
    let sums = sums
        .first_chunk_mut::<N>()
        .expect("a run ends within its column");
    let terms = terms
        .first_chunk::<N>()
        .expect("a run ends within the rows");
    for k in 0..N {
        sums[k] += terms[k];
    }
}
