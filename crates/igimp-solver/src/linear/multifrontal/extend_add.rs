//! Adding what a child contributes to the front of its parent, stretch by stretch.
//!
//! I. S. Duff & J. K. Reid, *The multifrontal solution of indefinite sparse symmetric linear
//! systems*, ACM Trans. Math. Softw. 9 (1983).

use std::ops::Range;

use super::plan::{Front, Plan};

/// Consecutive border unknowns of a child that are consecutive in the parent.
#[derive(Clone, Copy)]
struct Stretch {
    /// First of them in the border of the child.
    source: usize,
    /// First of them among the pivots or in the border of the parent.
    target: usize,
    len: usize,
}

/// Where the border of a child lies in its parent: first stretches among the pivots, then in the border.
#[derive(Default)]
pub(super) struct BorderMap {
    /// Unknowns of the border of the child.
    rows: usize,
    stretches: Vec<Stretch>,
    pivot_stretches: usize,
}

/// A block stored by columns with so many rows.
pub(super) struct Block<'a> {
    pub(super) entries: &'a mut [f64],
    pub(super) rows: usize,
}

impl BorderMap {
    /// Maps the border of a child; `local` gives the first row in the border of the parent of each
    /// of its border nodes, by rank.
    pub(super) fn set(&mut self, plan: &Plan, child: &Front, parent: &Front, local: &[u32]) {
        self.rows = child.border;
        self.stretches.clear();
        self.pivot_stretches = 0;
        let mut source = 0;
        for &rank in plan.rows(child) {
            let positions = plan.positions_of(rank);
            let len = positions.len();
            let among_pivots = positions.start < parent.end();
            let target = if among_pivots {
                positions.start - parent.first
            } else {
                local[rank as usize] as usize
            };
            let begins = among_pivots || self.stretches.len() > self.pivot_stretches;
            match self.stretches.last_mut() {
                Some(stretch) if begins && stretch.target + stretch.len == target => {
                    stretch.len += len;
                }
                _ => self.stretches.push(Stretch {
                    source,
                    target,
                    len,
                }),
            }
            if among_pivots {
                self.pivot_stretches = self.stretches.len();
            }
            source += len;
        }
    }

    fn parts(&self) -> (&[Stretch], &[Stretch]) {
        self.stretches.split_at(self.pivot_stretches)
    }

    /// Adds the rows of the child's columns among the pivots.
    pub(super) fn add_to_pivots(&self, child: &[f64], pivots: &mut Block, lower: &mut Block) {
        let (into_pivots, into_border) = self.parts();
        for columns in into_pivots {
            for k in 0..columns.len {
                let source = &child[(columns.source + k) * self.rows..][..self.rows];
                add_stretches(pivots.column(columns.target + k), source, into_pivots);
                add_stretches(lower.column(columns.target + k), source, into_border);
            }
        }
    }

    /// The same where the contribution of the child is a [`triangle`].
    pub(super) fn add_lower_to_pivots(&self, child: &[f64], pivots: &mut Block, lower: &mut Block) {
        let (into_pivots, into_border) = self.parts();
        for (index, columns) in into_pivots.iter().enumerate() {
            for k in 0..columns.len {
                let source = &child[triangle_column(self.rows, columns.source + k)];
                let target = pivots.column(columns.target + k);
                add_stretch(target, source, columns.from(k));
                add_stretches(target, source, &into_pivots[index + 1..]);
                add_stretches(lower.column(columns.target + k), source, into_border);
            }
        }
    }

    /// Adds the columns of the child's border to the rows of the pivots, into a transposed block.
    pub(super) fn add_transposed(&self, child: &[f64], upper: &mut Block) {
        let (into_pivots, into_border) = self.parts();
        for rows in into_pivots {
            for columns in into_border {
                let target = &mut upper.entries[rows.target * upper.rows + columns.target..];
                let source = &child[columns.source * self.rows + rows.source..];
                add_block_transposed(target, upper.rows, source, self.rows, rows.len, columns.len);
            }
        }
    }

    /// Adds the part that the parent passes on to its own contribution.
    pub(super) fn pass_on(&self, child: &[f64], contribution: &mut Block) {
        let (_, into_border) = self.parts();
        for columns in into_border {
            for k in 0..columns.len {
                let source = &child[(columns.source + k) * self.rows..][..self.rows];
                add_stretches(contribution.column(columns.target + k), source, into_border);
            }
        }
    }

    /// The same where both are a [`triangle`], the parent's with so many rows.
    pub(super) fn pass_on_lower(&self, child: &[f64], contribution: &mut [f64], rows: usize) {
        let (_, into_border) = self.parts();
        for (index, columns) in into_border.iter().enumerate() {
            for k in 0..columns.len {
                let source = &child[triangle_column(self.rows, columns.source + k)];
                let target = &mut contribution[triangle_column(rows, columns.target + k)];
                add_stretch(target, source, columns.from(k));
                add_stretches(target, source, &into_border[index + 1..]);
            }
        }
    }
}

/// Entries of the lower triangle of a symmetric block with so many rows, stored by columns from the diagonal on.
pub(super) fn triangle(rows: usize) -> usize {
    rows * (rows + 1) / 2
}

/// As many entries of such a triangle as a column has rows, of which those from the diagonal on are the column.
pub(super) fn triangle_column(rows: usize, column: usize) -> Range<usize> {
    let before = column * rows - column * (column + 1) / 2;
    before..before + rows
}

impl Stretch {
    /// What is left of a stretch without its first `k` unknowns.
    fn from(&self, k: usize) -> Self {
        Self {
            source: self.source + k,
            target: self.target + k,
            len: self.len - k,
        }
    }
}

impl Block<'_> {
    fn column(&mut self, column: usize) -> &mut [f64] {
        &mut self.entries[column * self.rows..][..self.rows]
    }
}

/// Adds stretches of `source` where they belong in `target`.
fn add_stretches(target: &mut [f64], source: &[f64], stretches: &[Stretch]) {
    for &stretch in stretches {
        add_stretch(target, source, stretch);
    }
}

fn add_stretch(target: &mut [f64], source: &[f64], stretch: Stretch) {
    let into = &mut target[stretch.target..stretch.target + stretch.len];
    let from = &source[stretch.source..stretch.source + stretch.len];
    for (into, &value) in into.iter_mut().zip(from) {
        *into += value;
    }
}

/// Adds the transpose of a block of `rows` by `columns` entries; both are stored by columns, with
/// the given numbers of entries from one column to the next.
fn add_block_transposed(
    target: &mut [f64],
    target_step: usize,
    source: &[f64],
    source_step: usize,
    rows: usize,
    columns: usize,
) {
    for j in 0..rows {
        let into = &mut target[j * target_step..][..columns];
        for (k, into) in into.iter_mut().enumerate() {
            *into += source[k * source_step + j];
        }
    }
}
