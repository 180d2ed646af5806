//! The plan of a factorisation: which front eliminates what, in which order, and where its factors
//! and its contribution to the parent are stored.
//!
//! J. W. H. Liu, *The multifrontal method for sparse matrix solution: theory and practice*, SIAM
//! Review 34 (1992). Depends on the nodes and on the reach of their couplings only, where the
//! couplings keep to that reach.

use std::ops::Range;
use std::sync::Arc;

use super::neighbours::{NONE, Neighbours};
use super::supernodes::Supernodes;
use super::tasks::{Task, cut};
use crate::coupling_reach::Reach;
use crate::multifrontal::dense::layout::Shape;
use crate::multifrontal::tree::front::Front;
use crate::{LinearSolverError, NestedDissection, Pattern, check};

/// Stands for the parent of a root.
pub(crate) const NO_FRONT: usize = usize::MAX;

/// Everything that a factorisation needs to know besides the values.
pub(crate) struct Plan {
    pub(crate) pattern: Arc<Pattern>,
    /// The couplings that the plan holds for, if for more than those of the pattern.
    reach: Option<Reach>,
    /// For each coupled pair of blocks (j, i) where the rows of j begin within a column of i.
    pub(crate) mirrored: Vec<u32>,
    /// Block of the pattern at each rank of the order of elimination.
    pub(crate) order: Vec<u32>,
    /// Rank of each block.
    pub(crate) rank: Vec<u32>,
    /// Position of the first unknown of each rank, and the number of unknowns.
    pub(crate) position: Vec<u32>,
    /// The fronts in postorder: children before parents, subtrees contiguous.
    pub(crate) fronts: Vec<Front>,
    /// Ranks of the border nodes of all fronts, ascending within a front.
    pub(crate) borders: Vec<u32>,
    /// Children of all fronts, ascending within a front.
    pub(crate) children: Vec<u32>,
    /// Unknowns of the largest border.
    pub(crate) largest_border: usize,
    /// The parts of the tree that may be worked on at the same time, by root.
    pub(crate) tasks: Vec<Task>,
}

impl Plan {
    /// Analyses a structurally symmetric pattern.
    pub(crate) fn new(pattern: &Arc<Pattern>) -> Result<Self, LinearSolverError> {
        check::valid_pattern(pattern)?;
        let mirrored = check::mirrored(pattern)?;
        let reach = Reach::of(pattern);
        let NestedDissection { nodes, parts } = NestedDissection::within(pattern, &reach);
        let mut rank = vec![0; nodes.len()];
        for (new, &old) in nodes.iter().enumerate() {
            rank[old] = new as u32;
        }
        let before = positions(pattern, nodes.iter().copied());
        let neighbours = Neighbours::new(pattern, &nodes, &rank, &reach);
        let mut supernodes = Supernodes::new(&parts, &before, &neighbours);
        let covers_reach = neighbours.cover_reach();
        let sequence = supernodes.sequence();

        // From ranks of the dissection to ranks in the sequence of the fronts.
        let mut order = Vec::with_capacity(nodes.len());
        let mut moved = vec![0; nodes.len()];
        for &supernode in &sequence {
            for old in supernodes.columns(supernode).flatten() {
                moved[old] = order.len() as u32;
                order.push(nodes[old] as u32);
            }
        }
        for (new, &block) in order.iter().enumerate() {
            rank[block as usize] = new as u32;
        }
        let mut plan = Self {
            pattern: Arc::clone(pattern),
            reach: covers_reach.then_some(reach),
            mirrored,
            position: positions(pattern, order.iter().map(|&block| block as usize)),
            order,
            rank,
            fronts: Vec::with_capacity(sequence.len()),
            borders: Vec::new(),
            children: Vec::new(),
            largest_border: 0,
            tasks: Vec::new(),
        };
        plan.list_fronts(&supernodes, &sequence, &moved);
        let borders = plan.fronts.iter().map(|front| front.border);
        plan.largest_border = borders.max().unwrap_or(0);
        plan.tasks = cut(&mut plan.fronts, &plan.children);
        Ok(plan)
    }

    /// Whether the plan serves another pattern, which it then takes over: one that would be given
    /// the same plan, so that the bits of a solution do not depend on what was solved before.
    pub(crate) fn adopt(&mut self, pattern: &Arc<Pattern>) -> Result<bool, LinearSolverError> {
        let fits = pattern.blocks == self.pattern.blocks
            && check::valid_pattern(pattern).is_ok()
            && (self.reach.as_ref())
                .is_some_and(|reach| *reach == Reach::of(pattern) && reach.covers(pattern));
        if fits {
            self.mirrored = check::mirrored(pattern)?;
            self.pattern = Arc::clone(pattern);
        }
        Ok(fits)
    }

    /// Number of unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        self.position.last().map_or(0, |&end| end as usize)
    }

    /// The unknown at a position of the order of elimination.
    pub(crate) fn unknown_at(&self, position: usize) -> usize {
        let rank = self
            .position
            .partition_point(|&first| first as usize <= position)
            - 1;
        let block = self.pattern.blocks[self.order[rank] as usize];
        block.first + position - self.position[rank] as usize
    }

    /// Positions of the unknowns of a rank.
    pub(crate) fn positions_of(&self, rank: u32) -> Range<usize> {
        let rank = rank as usize;
        self.position[rank] as usize..self.position[rank + 1] as usize
    }

    /// Ranks of the border nodes of a front.
    pub(crate) fn rows(&self, front: &Front) -> &[u32] {
        &self.borders[front.rows.clone()]
    }

    /// Notes the first row in the border of a front of each of its border nodes, by rank.
    pub(crate) fn locate(&self, front: &Front, local: &mut [u32]) {
        let mut row = 0;
        for &rank in self.rows(front) {
            local[rank as usize] = row;
            row += self.positions_of(rank).len() as u32;
        }
    }

    /// Floating-point operations of an elimination with two triangles of factors.
    pub(crate) fn operations(&self) -> f64 {
        let of_front = |front: &Front| {
            let (w, r) = (front.pivots as f64, front.border as f64);
            w * (w * w * (2.0 / 3.0) + 2.0 * r * (w + r))
        };
        self.fronts.iter().map(of_front).sum()
    }

    /// Largest number of entries that wait for their parents at the same time, on one thread.
    pub(crate) fn contribution_entries(&self, shape: Shape) -> usize {
        let waiting = self.tasks.iter().map(|task| task.waiting(shape));
        waiting.max().unwrap_or(0)
    }

    /// Lists the fronts with their borders and children, in the sequence of elimination.
    fn list_fronts(&mut self, supernodes: &Supernodes, sequence: &[u32], moved: &[u32]) {
        let mut front_of = vec![NONE; supernodes.len()];
        let (mut first, mut column) = (0, 0);
        for (front, &this) in sequence.iter().enumerate() {
            front_of[this as usize] = front as u32;
            let (pivots, border) = supernodes.size(this);
            let start = self.borders.len();
            let rows = supernodes.rows(this).iter();
            self.borders.extend(rows.map(|&row| moved[row as usize]));
            self.borders[start..].sort_unstable();
            let columns =
                column..column + supernodes.columns(this).map(|run| run.len()).sum::<usize>();
            column = columns.end;
            self.fronts.push(Front {
                first,
                pivots,
                border,
                columns,
                rows: start..self.borders.len(),
                parent: NO_FRONT,
                subtree: front,
                children: 0..0,
                passed_on: 0,
                stack: 0,
                contribution: [0..0, 0..0],
            });
            first += pivots;
        }

        // Children by counting; parents stand after them.
        let parent_of = |front: usize| {
            let above = supernodes.parent(sequence[front]);
            front_of.get(above as usize).map(|&parent| parent as usize)
        };
        for front in 0..sequence.len() {
            if let Some(parent) = parent_of(front) {
                self.fronts[parent].children.end += 1;
                self.fronts[parent].subtree =
                    self.fronts[parent].subtree.min(self.fronts[front].subtree);
            }
        }
        let mut total = 0;
        for front in &mut self.fronts {
            let count = front.children.end;
            front.children = total..total;
            total += count;
        }
        self.children = vec![0; total];
        for front in 0..sequence.len() {
            if let Some(parent) = parent_of(front) {
                let slot = &mut self.fronts[parent].children.end;
                self.children[*slot] = front as u32;
                *slot += 1;
            }
        }
        for front in (0..sequence.len()).rev() {
            if let Some(parent) = parent_of(front) {
                self.fronts[front].parent = parent;
                self.fronts[front].stack = 1 - self.fronts[parent].stack;
                let end = self.fronts[parent].end();
                let rows = self.rows(&self.fronts[front]).iter();
                let passed_on = rows.map(|&rank| self.positions_of(rank));
                let passed_on = passed_on.filter(|range| range.start >= end);
                self.fronts[front].passed_on = passed_on.map(|range| range.len()).sum();
            }
        }
    }
}

/// Position of the first unknown of each block in an order, and the number of unknowns.
fn positions(pattern: &Pattern, order: impl Iterator<Item = usize>) -> Vec<u32> {
    let mut positions = Vec::with_capacity(pattern.blocks.len() + 1);
    let mut next = 0;
    positions.push(next);
    for block in order {
        next += pattern.blocks[block].len as u32;
        positions.push(next);
    }
    positions
}
