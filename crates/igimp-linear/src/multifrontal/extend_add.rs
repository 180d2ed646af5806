//! Adding the contribution of a child to the front of its parent, stretch by stretch.
//!
//! I. S. Duff & J. K. Reid, *The multifrontal solution of indefinite sparse symmetric linear
//! systems*, ACM Trans. Math. Softw. 9 (1983). Entries at the pivots of the parent are added to its factors at
//! once; only entries at its border wait for it.

use std::ops::Range;

use super::dense::layout::Layout;
use super::dense::scalar::Scalar;
use super::tree::plan::Plan;
use crate::multifrontal::tree::front::Front;

/// Consecutive border unknowns of a child that are consecutive in the parent.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    /// First of them in the border of the child.
    pub(super) source: usize,
    /// First of them among the pivots or in the border of the parent.
    pub(super) target: usize,
    pub(super) len: usize,
}

/// Where the border of a child lies in its parent: first stretches among the pivots, then in the border.
#[derive(Default)]
pub(super) struct BorderMap {
    /// Unknowns of the border of the child.
    pub(super) rows: usize,
    /// The first of them that are pivots of the parent.
    pub(super) taken: usize,
    stretches: Vec<Stretch>,
    pivot_stretches: usize,
}

impl BorderMap {
    /// Maps the border of a child; `local` gives the first row in the border of the parent of each
    /// of its border nodes, by rank.
    pub(super) fn set(&mut self, plan: &Plan, child: &Front, parent: &Front, local: &[u32]) {
        self.rows = child.border;
        self.taken = child.border - child.passed_on;
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

    /// Stretches among the pivots.
    pub(super) fn among_pivots(&self) -> &[Stretch] {
        &self.stretches[..self.pivot_stretches]
    }

    /// Stretches in the border.
    pub(super) fn in_border(&self) -> &[Stretch] {
        &self.stretches[self.pivot_stretches..]
    }

    /// How many pivots of the parent stand before a place in the border of the child, `all` where it is
    /// beyond them.
    pub(super) fn pivots_before(&self, source: usize, all: usize) -> usize {
        let stretches = self.among_pivots();
        let next = stretches.partition_point(|stretch| stretch.source + stretch.len <= source);
        stretches.get(next).map_or(all, |stretch| {
            stretch.target + source.saturating_sub(stretch.source)
        })
    }
}

/// The contribution of a child that its parent passes on: the entries of its border without the pivots of the parent.
pub(super) struct Waiting<'a, T> {
    pub(super) map: BorderMap,
    pub(super) entries: &'a [T],
}

impl<T: Scalar> Waiting<'_, T> {
    /// Adds entries of some columns of the parent's border, from their diagonal on, to a tile of them whose rows begin with
    /// the first column. Waiting entries are a [`triangle`].
    pub(super) fn add_lower(&self, tile: &mut [T], height: usize, columns: &Range<usize>) {
        let rows = self.map.rows - self.map.taken;
        let stretches = self.map.in_border();
        for (index, offset, target) in within(stretches, columns) {
            let stretch = stretches[index].from(offset);
            let source = &self.entries[triangle_column(rows, stretch.source - self.map.taken)];
            let into = &mut tile[(target - columns.start) * height..][..height];
            let shift = (self.map.taken, columns.start);
            add_stretch(into, source, stretch, shift);
            for &stretch in &stretches[index + 1..] {
                add_stretch(into, source, stretch, shift);
            }
        }
    }

    /// The same with all rows from `first_row` on of the parent's border. Waiting entries are a square.
    pub(super) fn add_square(
        &self,
        tile: &mut [T],
        height: usize,
        columns: &Range<usize>,
        first_row: usize,
    ) {
        let rows = self.map.rows - self.map.taken;
        let stretches = self.map.in_border();
        let first = stretches.partition_point(|run| run.target + run.len <= first_row);
        for (index, offset, target) in within(stretches, columns) {
            let column = stretches[index].source + offset - self.map.taken;
            let source = &self.entries[column * rows..][..rows];
            let into = &mut tile[(target - columns.start) * height..][..height];
            for stretch in &stretches[first..] {
                let stretch = stretch.from(first_row.saturating_sub(stretch.target));
                add_stretch(into, source, stretch, (self.map.taken, first_row));
            }
        }
    }

    /// Adds the columns from `first_column` on of some rows of the parent's border, transposed. Waiting entries are a square.
    pub(super) fn add_transposed(
        &self,
        tile: &mut [T],
        height: usize,
        rows_of_parent: &Range<usize>,
        first_column: usize,
    ) {
        let rows = self.map.rows - self.map.taken;
        let stretches = self.map.in_border();
        let first = stretches.partition_point(|run| run.target + run.len <= first_column);
        for (index, offset, target) in within(stretches, rows_of_parent) {
            let row = stretches[index].source + offset - self.map.taken;
            let into = &mut tile[(target - rows_of_parent.start) * height..][..height];
            for stretch in &stretches[first..] {
                let stretch = stretch.from(first_column.saturating_sub(stretch.target));
                let into = &mut into[stretch.target - first_column..][..stretch.len];
                let column = stretch.source - self.map.taken;
                for (k, into) in into.iter_mut().enumerate() {
                    *into += self.entries[(column + k) * rows + row];
                }
            }
        }
    }
}

/// The unknowns of stretches whose target is within a range: stretch, number within it, target.
fn within(
    stretches: &[Stretch],
    targets: &Range<usize>,
) -> impl Iterator<Item = (usize, usize, usize)> {
    let first = stretches.partition_point(|run| run.target + run.len <= targets.start);
    let later = stretches[first..].iter().enumerate();
    later
        .take_while(|(_, run)| run.target < targets.end)
        .flat_map(move |(index, run)| {
            let from = targets.start.saturating_sub(run.target);
            let to = run.len.min(targets.end - run.target);
            (from..to).map(move |k| (first + index, k, run.target + k))
        })
}

/// A part of the factors of a parent that some columns of its child are added to, and of the waiting entries of the child.
pub(super) struct Target<'a, T> {
    pub(super) layout: Layout,
    /// First pivot of the part.
    pub(super) first_pivot: usize,
    /// Columns of the pivots from that one on.
    pub(super) pivots: &'a mut [T],
    /// The same columns below the pivots, so many rows each.
    pub(super) lower: &'a mut [T],
    pub(super) border: usize,
    /// Columns that wait, from the one with this number on.
    pub(super) first_waiting: usize,
    pub(super) waiting: &'a mut [T],
}

impl<T: Scalar> Target<'_, T> {
    /// Cuts before a column of the child. `before` are the entries that wait of columns before the cut.
    pub(super) fn cut(
        self,
        map: &BorderMap,
        column: usize,
        pivots: usize,
        before: usize,
    ) -> (Self, Self) {
        let pivot = map.pivots_before(column, pivots).max(self.first_pivot);
        let at = self.layout.offset(pivot) - self.layout.offset(self.first_pivot);
        let at = at.min(self.pivots.len());
        let (left_pivots, right_pivots) = self.pivots.split_at_mut(at);
        let below = (pivot - self.first_pivot) * self.border;
        let (left_lower, right_lower) = self.lower.split_at_mut(below);
        let (left_waiting, right_waiting) = self.waiting.split_at_mut(before);
        let left = Target {
            pivots: left_pivots,
            lower: left_lower,
            waiting: left_waiting,
            ..self
        };
        let right = Target {
            layout: left.layout,
            border: left.border,
            first_pivot: pivot,
            pivots: right_pivots,
            lower: right_lower,
            first_waiting: column.max(map.taken) - map.taken,
            waiting: right_waiting,
        };
        (left, right)
    }

    /// Adds the columns of a tile that are among the pivots. The tile has the rows of the child from `first_row` on, of each
    /// column those from its own on count where only the lower half does.
    pub(super) fn add_columns(
        &mut self,
        map: &BorderMap,
        tile: &[T],
        columns: &Range<usize>,
        first_row: usize,
        lower_half: bool,
    ) {
        let height = map.rows - first_row;
        let (into_pivots, into_border) = (map.among_pivots(), map.in_border());
        let first = into_pivots.partition_point(|run| run.source + run.len <= columns.start);
        for (index, run) in into_pivots.iter().enumerate().skip(first) {
            if run.source >= columns.end {
                break;
            }
            for k in columns.start.saturating_sub(run.source)..run.len.min(columns.end - run.source)
            {
                let source = &tile[(run.source + k - columns.start) * height..][..height];
                let pivot = run.target + k;
                let start = self.layout.offset(pivot) - self.layout.offset(self.first_pivot);
                let shift = (first_row, self.layout.first_row(pivot));
                let into = &mut self.pivots[start..];
                let stretches = if lower_half {
                    add_stretch(into, source, run.from(k), shift);
                    &into_pivots[index + 1..]
                } else {
                    into_pivots
                };
                for &stretch in stretches {
                    add_stretch(into, source, stretch, shift);
                }
                let into =
                    &mut self.lower[(pivot - self.first_pivot) * self.border..][..self.border];
                for &stretch in into_border {
                    add_stretch(into, source, stretch, (first_row, 0));
                }
            }
        }
    }

    /// Adds the columns of a tile below the pivots only; the tile has the rows of the child from `first_row` on, where its
    /// pivots end.
    pub(super) fn add_below(
        &mut self,
        map: &BorderMap,
        tile: &[T],
        columns: &Range<usize>,
        first_row: usize,
    ) {
        let height = map.rows - first_row;
        for run in map.among_pivots() {
            let from = columns.start.saturating_sub(run.source);
            let to = run.len.min(columns.end.saturating_sub(run.source));
            for k in from..to {
                let source = &tile[(run.source + k - columns.start) * height..][..height];
                let first = (run.target + k - self.first_pivot) * self.border;
                let into = &mut self.lower[first..][..self.border];
                for &stretch in map.in_border() {
                    add_stretch(into, source, stretch, (first_row, 0));
                }
            }
        }
    }
}

/// As many entries of such a triangle as a column has rows, of which those from the diagonal on are the column.
pub(super) fn triangle_column(rows: usize, column: usize) -> Range<usize> {
    let before = column * rows - column * (column + 1) / 2;
    before..before + rows
}

impl Stretch {
    /// The rest of a stretch after its first `k` unknowns.
    fn from(&self, k: usize) -> Self {
        let k = k.min(self.len);
        Self {
            source: self.source + k,
            target: self.target + k,
            len: self.len - k,
        }
    }
}

/// Adds a stretch of `source` where it belongs in `target`; both begin with a later row than 0.
#[inline]
fn add_stretch<T: Scalar>(
    target: &mut [T],
    source: &[T],
    stretch: Stretch,
    (first_source, first_target): (usize, usize),
) {
    let into = &mut target[stretch.target - first_target..][..stretch.len];
    let from = &source[stretch.source - first_source..][..stretch.len];
    for (into, &value) in into.iter_mut().zip(from) {
        *into += value;
    }
}
