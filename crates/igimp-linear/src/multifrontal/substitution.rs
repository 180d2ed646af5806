//! Solving with the factors, over the tree of tasks.
//!
//! Changes that a task makes in the part of the vector that belongs to the tasks above it are kept apart
//! until these add them up in their order; the bits of the solution do not depend on the number of
//! threads.

use super::super::LinearSolverError;
use super::dense::scalar::Scalar;
use super::factors::Factors;
use super::kernel::Substitution;
use super::scratch::{Scratch, Tools, make_room};
use super::tree::plan::Plan;
use super::tree::tasks::Task;
use crate::multifrontal::tree::front::{Extent, Front};

/// Vectors for solves, kept from solve to solve.
#[derive(Default)]
pub(super) struct Vectors<T> {
    /// The vector being solved for, by position.
    vector: Vec<T>,
    /// Parts of vectors on the borders of the tasks.
    outer: Vec<T>,
}

impl<T: Scalar> Vectors<T> {
    /// Replaces a vector by (an approximation of) K⁻¹ times it; `scale` is the diagonal of S where
    /// S K S was factorised, by unknown.
    pub(super) fn solve<S: Substitution<T>>(
        &mut self,
        plan: &Plan,
        factors: &Factors<T>,
        scale: Option<&[f64]>,
        scratch: &Scratch<T>,
        vector: &mut [f64],
    ) -> Result<(), LinearSolverError> {
        let outer = plan.tasks.iter().map(|task| task.total.outer).sum();
        make_room(&mut self.outer, outer, "vector")?;
        self.vector.clear();
        let scaled = |unknown: usize| scale.map_or(1.0, |scale| scale[unknown]);
        for &block in &plan.order {
            let block = plan.pattern.blocks[block as usize];
            let unknowns = block.first..block.first + block.len;
            self.vector
                .extend(unknowns.map(|unknown| T::near(vector[unknown] * scaled(unknown))));
        }
        let job = Job::<S, T> {
            plan,
            factors,
            scratch,
            kind: std::marker::PhantomData,
        };
        let (y, outer) = (&mut self.vector[..], &mut self.outer[..outer]);
        job.each(Direction::Forward, &plan.tasks, Place::default(), y, outer)?;
        job.each(Direction::Backward, &plan.tasks, Place::default(), y, outer)?;
        for (&block, &position) in plan.order.iter().zip(&plan.position) {
            let block = plan.pattern.blocks[block as usize];
            for k in 0..block.len {
                let unknown = block.first + k;
                let value = self.vector[position as usize + k].wide();
                vector[unknown] = value * scaled(unknown);
            }
        }
        Ok(())
    }
}

#[derive(Clone, Copy)]
enum Direction {
    /// y ← L⁻¹ P y, children before parents.
    Forward,
    /// y ← U⁻¹ y, parents before children.
    Backward,
}

/// Where the factors of a task and of those below it begin.
#[derive(Clone, Copy, Default)]
struct Place {
    entries: usize,
    position: usize,
}

struct Job<'a, S, T> {
    plan: &'a Plan,
    factors: &'a Factors<T>,
    scratch: &'a Scratch<T>,
    kind: std::marker::PhantomData<S>,
}

impl<S: Substitution<T>, T: Scalar> Job<'_, S, T> {
    /// Goes through several tasks with everything below them. `y` and `outer` are their parts.
    fn each(
        &self,
        direction: Direction,
        tasks: &[Task],
        place: Place,
        y: &mut [T],
        outer: &mut [T],
    ) -> Result<(), LinearSolverError> {
        match tasks {
            [] => Ok(()),
            [task] => match direction {
                Direction::Forward => self.forward(task, place, y, outer),
                Direction::Backward => self.backward(task, place, y, outer),
            },
            _ => {
                let (left, right) = tasks.split_at(tasks.len() / 2);
                let sum = |part: &dyn Fn(&Extent) -> usize| -> usize {
                    left.iter().map(|task| part(&task.total)).sum()
                };
                let (left_y, right_y) = y.split_at_mut(sum(&|extent| extent.pivots));
                let (left_outer, right_outer) = outer.split_at_mut(sum(&|extent| extent.outer));
                let right_place = Place {
                    entries: place.entries + sum(&S::entries),
                    position: place.position + left_y.len(),
                };
                let (left, right) = rayon::join(
                    || self.each(direction, left, place, left_y, left_outer),
                    || self.each(direction, right, right_place, right_y, right_outer),
                );
                left.and(right)
            }
        }
    }

    fn forward(
        &self,
        task: &Task,
        place: Place,
        y: &mut [T],
        outer: &mut [T],
    ) -> Result<(), LinearSolverError> {
        let (y_below, y) = y.split_at_mut(task.total.pivots - task.extent.pivots);
        let (outer_below, outer) = outer.split_at_mut(task.total.outer - task.extent.outer);
        self.each(Direction::Forward, &task.below, place, y_below, outer_below)?;

        let mut tools = self.scratch.tools(self.plan)?;
        let Tools { local, border, .. } = &mut tools;
        let mut part = Part::new(self.plan, task, y, outer, local);
        part.outer.fill(T::default());
        for (child, changes) in task.outer_parts() {
            let child = &self.plan.fronts[child];
            part.add(self.plan, child, &outer_below[changes]);
        }
        let mut values = &self.factors.values[Self::first_entry(task, place)..];
        for front in &self.plan.fronts[task.fronts.clone()] {
            let (lu, later) = values.split_at(S::entries(&front.extent()));
            values = later;
            let exchanges = &self.factors.exchanges[front.first..front.end()];
            let product = &mut border[..front.border];
            S::forward(lu, exchanges, part.pivots(front), product, task.is_large());
            part.add(self.plan, front, product);
        }
        self.scratch.give_back(tools);
        Ok(())
    }

    fn backward(
        &self,
        task: &Task,
        place: Place,
        y: &mut [T],
        outer: &mut [T],
    ) -> Result<(), LinearSolverError> {
        let (y_below, y) = y.split_at_mut(task.total.pivots - task.extent.pivots);
        let (outer_below, outer) = outer.split_at_mut(task.total.outer - task.extent.outer);
        let mut tools = self.scratch.tools(self.plan)?;
        let Tools { local, border, .. } = &mut tools;
        let mut part = Part::new(self.plan, task, y, outer, local);
        let first = Self::first_entry(task, place);
        let mut values = &self.factors.values[first..first + S::entries(&task.extent)];
        for front in self.plan.fronts[task.fronts.clone()].iter().rev() {
            let (earlier, factors) = values.split_at(values.len() - S::entries(&front.extent()));
            values = earlier;
            part.gather(self.plan, front, &mut border[..front.border]);
            let border = &border[..front.border];
            S::backward(factors, part.pivots(front), border, task.is_large());
        }
        for (child, known) in task.outer_parts() {
            let child = &self.plan.fronts[child];
            part.gather(self.plan, child, &mut outer_below[known]);
        }
        self.scratch.give_back(tools);
        self.each(
            Direction::Backward,
            &task.below,
            place,
            y_below,
            outer_below,
        )
    }

    /// Where the factors of a task itself begin.
    fn first_entry(task: &Task, place: Place) -> usize {
        place.entries + S::entries(&task.total) - S::entries(&task.extent)
    }
}

/// The part of a vector that a task sees: its own positions, and the border to those above.
struct Part<'a, T> {
    /// First and last position of its own.
    start: usize,
    end: usize,
    y: &'a mut [T],
    outer: &'a mut [T],
    /// First row in the border, by rank.
    local: &'a [u32],
}

impl<'a, T: Scalar> Part<'a, T> {
    fn new(
        plan: &Plan,
        task: &Task,
        y: &'a mut [T],
        outer: &'a mut [T],
        local: &'a mut [u32],
    ) -> Self {
        let fronts = &plan.fronts[task.fronts.clone()];
        let (first, root) = (&fronts[0], &fronts[fronts.len() - 1]);
        plan.locate(root, local);
        Self {
            start: first.first,
            end: root.end(),
            y,
            outer,
            local,
        }
    }

    fn pivots(&mut self, front: &Front) -> &mut [T] {
        &mut self.y[front.first - self.start..front.end() - self.start]
    }

    /// The entries of a border node.
    fn entries(&mut self, plan: &Plan, rank: u32) -> &mut [T] {
        let positions = plan.positions_of(rank);
        if positions.start < self.end {
            &mut self.y[positions.start - self.start..positions.end - self.start]
        } else {
            let first = self.local[rank as usize] as usize;
            &mut self.outer[first..first + positions.len()]
        }
    }

    /// Adds to the border of a front.
    fn add(&mut self, plan: &Plan, front: &Front, mut changes: &[T]) {
        for &rank in plan.rows(front) {
            let entries = self.entries(plan, rank);
            let (part, later) = changes.split_at(entries.len());
            changes = later;
            for (entry, change) in entries.iter_mut().zip(part) {
                *entry += *change;
            }
        }
    }

    /// Takes the border of a front.
    fn gather(&mut self, plan: &Plan, front: &Front, mut border: &mut [T]) {
        for &rank in plan.rows(front) {
            let entries = self.entries(plan, rank);
            let (part, later) = border.split_at_mut(entries.len());
            part.copy_from_slice(entries);
            border = later;
        }
    }
}
