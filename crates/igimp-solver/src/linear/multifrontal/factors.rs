//! The factors of a matrix, computed front by front over the tree of tasks.
//!
//! A subtree owns a contiguous range of fronts, positions and factors, and every front adds up its
//! contributions in the order of its children: the bits of the result depend neither on when a
//! subtree is worked on nor on the number of threads.

use super::super::LinearSolverError;
use super::dense_lu::PivotRecord;
use super::kernel::{Kernel, Room};
use super::plan::Plan;
use super::tasks::Task;
use super::workshop::{Workshop, make_room};

/// Factors in the order of elimination.
#[derive(Default)]
pub(super) struct Factors {
    /// Blocks of all fronts, one after the other.
    pub(super) values: Vec<f64>,
    /// Row exchanges within the pivot block of each front, by position.
    pub(super) exchanges: Vec<u32>,
    pub(super) record: PivotRecord,
}

/// What a task leaves for the one above.
struct Done {
    contribution: Vec<f64>,
    record: PivotRecord,
}

impl Factors {
    /// Computes the factors of a matrix with the planned pattern.
    pub(super) fn compute<K: Kernel>(
        &mut self,
        plan: &Plan,
        kernel: &K,
        workshop: &Workshop,
    ) -> Result<(), LinearSolverError> {
        let entries: usize = plan.tasks.iter().map(|task| K::entries(&task.total)).sum();
        make_room(&mut self.values, entries, "factors")?;
        self.exchanges.resize(plan.unknowns(), 0);
        let job = Job {
            plan,
            kernel,
            workshop,
        };
        let roots = job.tasks(
            &plan.tasks,
            &mut self.values[..entries],
            &mut self.exchanges,
        )?;
        self.record = PivotRecord::default();
        for done in roots {
            self.record.add(&done.record);
        }
        Ok(())
    }
}

/// A factorisation under way.
struct Job<'a, K> {
    plan: &'a Plan,
    kernel: &'a K,
    workshop: &'a Workshop,
}

impl<K: Kernel> Job<'_, K> {
    /// Works on several tasks with everything below them, at the same time where there are threads.
    fn tasks(
        &self,
        tasks: &[Task],
        values: &mut [f64],
        exchanges: &mut [u32],
    ) -> Result<Vec<Done>, LinearSolverError> {
        match tasks {
            [] => Ok(Vec::new()),
            [task] => self.task(task, values, exchanges).map(|done| vec![done]),
            _ => {
                let (left, right) = tasks.split_at(tasks.len() / 2);
                let entries = left.iter().map(|task| K::entries(&task.total)).sum();
                let pivots = left.iter().map(|task| task.total.pivots).sum();
                let (left_values, right_values) = values.split_at_mut(entries);
                let (left_exchanges, right_exchanges) = exchanges.split_at_mut(pivots);
                let (left, right) = rayon::join(
                    || self.tasks(left, left_values, left_exchanges),
                    || self.tasks(right, right_values, right_exchanges),
                );
                let mut done = left?;
                done.extend(right?);
                Ok(done)
            }
        }
    }

    /// Works on a task after those below it.
    fn task(
        &self,
        task: &Task,
        values: &mut [f64],
        exchanges: &mut [u32],
    ) -> Result<Done, LinearSolverError> {
        let (values_below, mut values) =
            values.split_at_mut(K::entries(&task.total) - K::entries(&task.own));
        let (exchanges_below, mut exchanges) =
            exchanges.split_at_mut(task.total.pivots - task.own.pivots);
        let below = self.tasks(&task.below, values_below, exchanges_below)?;

        let shape = K::SHAPE as usize;
        let mut tools = self.workshop.tools(self.plan)?;
        for (stack, &len) in tools.stacks.iter_mut().zip(&task.stacks[shape]) {
            make_room(stack, len, "contributions")?;
        }
        let mut record = PivotRecord::default();
        for done in &below {
            record.add(&done.record);
        }
        let mut output = self.workshop.buffer(K::SHAPE.entries(task.own.outer))?;
        for index in task.fronts.clone() {
            let front = &self.plan.fronts[index];
            let entries = K::entries(&front.extent());
            let (own_values, later_values) = values.split_at_mut(entries);
            let (own_exchanges, later_exchanges) = exchanges.split_at_mut(front.pivots);
            (values, exchanges) = (later_values, later_exchanges);
            let [even, odd] = &mut tools.stacks;
            let (own_stack, stack_below) = if front.stack == 0 {
                (even, &*odd)
            } else {
                (odd, &*even)
            };
            let contribution = if index + 1 == task.fronts.end {
                &mut output[..K::SHAPE.entries(front.border)]
            } else {
                &mut own_stack[front.contribution[shape].clone()]
            };
            let children = self.plan.children[front.children.clone()]
                .iter()
                .enumerate();
            let children = children.map(|(order, &child)| {
                let child = &self.plan.fronts[child as usize];
                let contribution = match below.get(order) {
                    Some(done) => &done.contribution[..],
                    None => &stack_below[child.contribution[shape].clone()],
                };
                (child, contribution)
            });

            self.plan.locate(front, &mut tools.local);
            self.kernel.load(self.plan, front, own_values, &tools.local);
            for (child, entries) in children.clone() {
                tools.map.set(self.plan, child, front, &tools.local);
                K::add(front, own_values, entries, &tools.map);
            }
            let room = Room {
                factors: own_values,
                exchanges: own_exchanges,
                contribution,
                scratch: &mut tools.scratch,
            };
            let found = self
                .kernel
                .eliminate(self.plan, front, room, task.is_large())?;
            record.add(&found);
            let contribution = if index + 1 == task.fronts.end {
                &mut output[..K::SHAPE.entries(front.border)]
            } else {
                &mut own_stack[front.contribution[shape].clone()]
            };
            for (child, entries) in children {
                tools.map.set(self.plan, child, front, &tools.local);
                K::pass_on(front, entries, &tools.map, contribution);
            }
        }
        self.workshop.give_back(tools);
        for done in below {
            self.workshop.give_back_buffer(done.contribution);
        }
        Ok(Done {
            contribution: output,
            record,
        })
    }
}
