//! The elimination tree cut into tasks: subtrees, and above them the large fronts one by one.
//!
//! Where the tree is cut depends on the plan only and never on the number of threads, and every
//! front adds up the contributions of its children in their order: the bits of the result do not depend
//! on how many threads work on the tasks.

use std::ops::Range;

use crate::multifrontal::dense::layout::Shape;
use crate::multifrontal::tree::front::{Extent, Front};

/// Subtrees with less than this part of all operations are not cut further.
const FINEST: f64 = 1.0 / 40.0;

/// Operations below which the whole tree is one task.
const WORTH_CUTTING: f64 = 2e7;

/// A contiguous range of fronts that one thread works on, after the tasks below it.
pub(crate) struct Task {
    pub(crate) fronts: Range<usize>,
    /// Tasks whose last fronts are the children of the first front here, in their order.
    pub(crate) below: Vec<Task>,
    /// The share of the common arrays of this task and all tasks below it.
    pub(crate) total: Extent,
    /// The share of this task.
    pub(crate) extent: Extent,
    /// Room for contributions that wait within the task, by shape and stack.
    pub(crate) stacks: [[usize; 2]; 2],
    /// Unknowns of the border of the last front that its parent passes on.
    passed_on: usize,
    /// The same of the children of the last front.
    left: Vec<usize>,
}

impl Task {
    /// Largest number of entries of contributions that wait while this task and those below it are worked on, on one
    /// thread.
    pub(crate) fn waiting(&self, shape: Shape) -> usize {
        let (mut held, mut most) = (0, 0);
        for task in &self.below {
            most = most.max(held + task.waiting(shape));
            held += shape.entries(task.passed_on);
            most = most.max(held + task.left_below(shape));
        }
        let [even, odd] = self.stacks[shape as usize];
        most.max(even + odd + self.left_below(shape))
    }

    /// Entries that wait for the last front when it is eliminated.
    fn left_below(&self, shape: Shape) -> usize {
        self.left.iter().map(|&border| shape.entries(border)).sum()
    }

    /// Whether the task is a single large front, worth the work of several threads.
    pub(crate) fn is_large(&self) -> bool {
        !self.below.is_empty()
    }

    /// The tasks below by their last fronts, with where the parts of vectors on their borders lie
    /// in those of all tasks below, in their order.
    pub(crate) fn outer_parts(&self) -> impl Iterator<Item = (usize, Range<usize>)> + '_ {
        let mut end = 0;
        self.below.iter().map(move |task| {
            end += task.total.outer;
            (task.fronts.end - 1, end - task.extent.outer..end)
        })
    }
}

impl Extent {
    fn add(&mut self, other: &Self) {
        self.pivots += other.pivots;
        self.squares += other.squares;
        self.halves += other.halves;
        self.panels += other.panels;
        self.outer += other.outer;
    }
}

/// Cuts the tree, and places the contributions of the fronts in the stacks of their tasks.
pub(crate) fn cut(fronts: &mut [Front], children: &[u32]) -> Vec<Task> {
    // Operations of the subtrees.
    let mut work: Vec<f64> = Vec::with_capacity(fronts.len());
    let mut roots: Vec<usize> = Vec::new();
    for (this, front) in fronts.iter().enumerate() {
        let (w, r) = (front.pivots as f64, front.border as f64);
        let below = &children[front.children.clone()];
        let below: f64 = below.iter().map(|&child| work[child as usize]).sum();
        work.push(below + w * (w * w * (2.0 / 3.0) + 2.0 * r * (w + r)));
        roots.truncate(roots.len() - front.children.len());
        roots.push(this);
    }
    let total: f64 = roots.iter().map(|&root| work[root]).sum();
    let coarsest = if total < WORTH_CUTTING {
        f64::INFINITY
    } else {
        FINEST * total
    };
    let mut cutter = Cutter {
        fronts,
        children,
        work,
        coarsest,
    };
    roots.into_iter().map(|root| cutter.task(root)).collect()
}

struct Cutter<'a> {
    fronts: &'a mut [Front],
    children: &'a [u32],
    work: Vec<f64>,
    /// Work beyond which a subtree is cut.
    coarsest: f64,
}

impl Cutter<'_> {
    fn task(&mut self, root: usize) -> Task {
        let front = &self.fronts[root];
        let is_cut = self.work[root] > self.coarsest && !front.children.is_empty();
        let (first, below): (usize, Vec<Task>) = if is_cut {
            let children = &self.children[front.children.clone()];
            let below = children.iter().map(|&child| self.task(child as usize));
            (root, below.collect())
        } else {
            (front.subtree, Vec::new())
        };
        let mut extent = Extent::default();
        for front in &self.fronts[first..=root] {
            extent.add(&front.extent());
        }
        extent.outer = self.fronts[root].border;
        let mut total = extent;
        for task in &below {
            total.add(&task.total);
        }
        let front = &self.fronts[root];
        let children = &self.children[front.children.clone()];
        let left = children
            .iter()
            .map(|&child| self.fronts[child as usize].passed_on);
        Task {
            passed_on: front.passed_on,
            left: left.collect(),
            fronts: first..root + 1,
            below,
            total,
            extent,
            stacks: self.place_contributions(&(first..root)),
        }
    }

    /// Places the waiting contributions of all fronts of a task but the last, whose contribution leaves it; returns the
    /// largest fill of both stacks, by shape.
    fn place_contributions(&mut self, fronts: &Range<usize>) -> [[usize; 2]; 2] {
        [Shape::Square, Shape::Triangle].map(|shape| {
            let (mut fill, mut largest) = ([0, 0], [0, 0]);
            for this in fronts.clone() {
                let front = &self.fronts[this];
                let stack = front.stack;
                let start = fill[stack];
                fill[stack] += shape.entries(front.passed_on);
                largest[stack] = largest[stack].max(fill[stack]);
                if let Some(&eldest) = self.children[front.children.clone()].first() {
                    let eldest = &self.fronts[eldest as usize];
                    fill[1 - stack] = eldest.contribution[shape as usize].start;
                }
                self.fronts[this].contribution[shape as usize] = start..fill[stack];
            }
            largest
        })
    }
}
