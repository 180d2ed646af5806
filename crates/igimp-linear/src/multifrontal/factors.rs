//! The factors of a matrix, computed front by front over the tree of tasks.
//!
//! A subtree owns a contiguous range of fronts, positions and factors, and every front adds up its
//! contributions in the order of its children: the bits of the result depend neither on when a
//! subtree is worked on nor on the number of threads. A front is loaded before its first child contributes to it.

use super::super::LinearSolverError;
use super::dense::dense_lu::PivotRecord;
use super::dense::scalar::Scalar;
use super::extend_add::{BorderMap, Waiting};
use super::kernel::{Contribution, Kernel, Room};
use super::scratch::{Scratch, Tools, make_room};
use super::tree::plan::Plan;
use super::tree::tasks::Task;
use crate::multifrontal::tree::front::Front;

/// Factors in the order of elimination.
#[derive(Default)]
pub(super) struct Factors<T> {
    /// Blocks of all fronts, one after the other.
    pub(super) values: Vec<T>,
    /// Row exchanges within the pivot block of each front, by position.
    pub(super) exchanges: Vec<u32>,
    pub(super) record: PivotRecord,
}

/// The contributions that a task leaves for the one above, by child of its last front.
struct Done<T> {
    left: Vec<Vec<T>>,
    record: PivotRecord,
}

/// The front that the tasks below it contribute to, and contributions that wait for it.
struct Above<'a, T> {
    front: &'a Front,
    factors: &'a mut [T],
    waiting: &'a mut Vec<Vec<T>>,
}

impl<T: Scalar> Factors<T> {
    /// Computes the factors of a matrix with the planned pattern.
    pub(super) fn compute<K: Kernel<T>>(
        &mut self,
        plan: &Plan,
        kernel: &K,
        scratch: &Scratch<T>,
    ) -> Result<(), LinearSolverError> {
        let entries: usize = plan.tasks.iter().map(|task| K::entries(&task.total)).sum();
        make_room(&mut self.values, entries, "factors")?;
        self.exchanges.resize(plan.unknowns(), 0);
        let job = Job {
            plan,
            kernel,
            scratch,
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
struct Job<'a, K, T> {
    plan: &'a Plan,
    kernel: &'a K,
    scratch: &'a Scratch<T>,
}

impl<K: Kernel<T>, T: Scalar> Job<'_, K, T> {
    /// Works on several tasks with everything below them, at the same time where there are threads.
    fn tasks(
        &self,
        tasks: &[Task],
        values: &mut [T],
        exchanges: &mut [u32],
    ) -> Result<Vec<Done<T>>, LinearSolverError> {
        match tasks {
            [] => Ok(Vec::new()),
            [task] => self.task(task, values, exchanges).map(|done| vec![done]),
            _ => {
                let (left, right) = tasks.split_at(tasks.len() / 2);
                let (entries, pivots) = extent::<K, T>(left);
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

    /// The same, and adds their contributions to the front above them, in their order: those on the left as soon as
    /// they are done.
    fn tasks_below(
        &self,
        tasks: &[Task],
        values: &mut [T],
        exchanges: &mut [u32],
        above: &mut Above<'_, T>,
    ) -> Result<PivotRecord, LinearSolverError> {
        match tasks {
            [] => Ok(PivotRecord::default()),
            [task] => {
                let done = self.task(task, values, exchanges)?;
                self.pass_on(task, values, &done, above)
            }
            _ => {
                let (left, right) = tasks.split_at(tasks.len() / 2);
                let (entries, pivots) = extent::<K, T>(left);
                let (left_values, mut right_values) = values.split_at_mut(entries);
                let (left_exchanges, right_exchanges) = exchanges.split_at_mut(pivots);
                let (record, done) = rayon::join(
                    || self.tasks_below(left, left_values, left_exchanges, above),
                    || self.tasks(right, right_values, right_exchanges),
                );
                let mut record = record?;
                for (task, done) in right.iter().zip(done?) {
                    let (part, later) = right_values.split_at_mut(K::entries(&task.total));
                    right_values = later;
                    record.add(&self.pass_on(task, part, &done, above)?);
                }
                Ok(record)
            }
        }
    }

    /// Adds the contribution of a task to the front above; the threads share the work.
    fn pass_on(
        &self,
        task: &Task,
        values: &[T],
        done: &Done<T>,
        above: &mut Above<'_, T>,
    ) -> Result<PivotRecord, LinearSolverError> {
        let front = &self.plan.fronts[task.fronts.end - 1];
        let mut waiting = Vec::new();
        make_room(
            &mut waiting,
            K::SHAPE.entries(front.passed_on),
            "contributions",
        )?;
        let mut tools = self.scratch.tools(self.plan)?;
        let children = self.plan.children[front.children.clone()].iter();
        let left = children.zip(&done.left).map(|(&child, left)| {
            let child = &self.plan.fronts[child as usize];
            (child, &left[..K::SHAPE.entries(child.passed_on)])
        });
        let room = Room {
            parent: above.front,
            factors: above.factors,
            waiting: &mut waiting[..K::SHAPE.entries(front.passed_on)],
        };
        let entries = K::entries(&front.extent());
        let factors = &values[values.len() - entries..];
        self.contribute(front, factors, left, room, &mut tools.rest(), true)?;
        self.scratch.give_back(tools);
        above.waiting.push(waiting);
        Ok(done.record)
    }

    /// Works out the contribution of a front to its parent.
    fn contribute<'b>(
        &self,
        front: &Front,
        factors: &[T],
        children: impl Iterator<Item = (&'b Front, &'b [T])>,
        room: Room<'_, T>,
        tools: &mut Rest<'_, T>,
        large: bool,
    ) -> Result<(), LinearSolverError> {
        let plan = self.plan;
        let mut maps = std::mem::take(tools.maps);
        plan.locate(front, tools.local);
        let children = children.map(|(child, entries)| {
            let mut map = maps.pop().unwrap_or_default();
            map.set(plan, child, front, tools.local);
            Waiting { map, entries }
        });
        let children: Vec<Waiting<T>> = children.collect();
        let mut map = maps.pop().unwrap_or_default();
        plan.locate(room.parent, tools.local);
        map.set(plan, front, room.parent, tools.local);
        let contribution = Contribution {
            front,
            factors,
            children: &children,
            map: &map,
        };
        K::contribute(contribution, room, tools.scratch, large)?;
        maps.push(map);
        maps.extend(children.into_iter().map(|child| child.map));
        *tools.maps = maps;
        Ok(())
    }

    /// Works on a task after those below it, up to the elimination of its last front.
    fn task(
        &self,
        task: &Task,
        values: &mut [T],
        exchanges: &mut [u32],
    ) -> Result<Done<T>, LinearSolverError> {
        let below = K::entries(&task.total) - K::entries(&task.extent);
        let (values_below, values) = values.split_at_mut(below);
        let (exchanges_below, exchanges) =
            exchanges.split_at_mut(task.total.pivots - task.extent.pivots);
        if task.is_large() {
            let front = &self.plan.fronts[task.fronts.start];
            let mut tools = self.scratch.tools(self.plan)?;
            self.plan.locate(front, &mut tools.local);
            self.kernel.load(self.plan, front, values, &tools.local);
            self.scratch.give_back(tools);
            let mut left = Vec::new();
            let mut above = Above {
                front,
                factors: &mut *values,
                waiting: &mut left,
            };
            let mut record =
                self.tasks_below(&task.below, values_below, exchanges_below, &mut above)?;
            let found = self
                .kernel
                .eliminate(self.plan, front, values, exchanges, true)?;
            record.add(&found);
            return Ok(Done { left, record });
        }
        let mut tools = self.scratch.tools(self.plan)?;
        let shape = K::SHAPE as usize;
        for (stack, &len) in tools.stacks.iter_mut().zip(&task.stacks[shape]) {
            make_room(stack, len, "contributions")?;
        }
        let done = self.subtree(task, values, exchanges, &mut tools)?;
        self.scratch.give_back(tools);
        Ok(done)
    }

    /// Works on the fronts of a subtree one after the other.
    fn subtree(
        &self,
        task: &Task,
        values: &mut [T],
        mut exchanges: &mut [u32],
        tools: &mut Tools<T>,
    ) -> Result<Done<T>, LinearSolverError> {
        let plan = self.plan;
        let shape = K::SHAPE as usize;
        let fronts = &plan.fronts[task.fronts.clone()];
        tools.offsets.clear();
        let mut end = 0;
        for front in fronts {
            tools.offsets.push(end);
            end += K::entries(&front.extent());
        }
        tools.offsets.push(end);
        let mut record = PivotRecord::default();
        for (number, front) in fronts.iter().enumerate() {
            let (swaps, later_exchanges) = exchanges.split_at_mut(front.pivots);
            exchanges = later_exchanges;
            let (values, later) = values.split_at_mut(tools.offsets[number + 1]);
            let panel = &mut values[tools.offsets[number]..];
            if front.children.is_empty() {
                plan.locate(front, &mut tools.local);
                self.kernel.load(plan, front, panel, &tools.local);
            }
            let found = self.kernel.eliminate(plan, front, panel, swaps, false)?;
            record.add(&found);
            let index = task.fronts.start + number;
            if index + 1 == task.fronts.end {
                break;
            }

            let above = front.parent - task.fronts.start;
            let parent = &fronts[above];
            let first = tools.offsets[above] - tools.offsets[number + 1];
            let factors = &mut later[first..][..K::entries(&parent.extent())];
            let is_first = plan.children[parent.children.start] as usize == index;
            let [even, odd] = &mut tools.stacks;
            let (stack, stack_below) = if front.stack == 0 {
                (even, &*odd)
            } else {
                (odd, &*even)
            };
            let mut rest = Rest {
                local: &mut tools.local,
                maps: &mut tools.maps,
                scratch: &mut tools.scratch,
            };
            if is_first {
                plan.locate(parent, rest.local);
                self.kernel.load(plan, parent, factors, rest.local);
            }
            let children = plan.children[front.children.clone()].iter();
            let children = children.map(|&child| {
                let child = &plan.fronts[child as usize];
                (child, &stack_below[child.contribution[shape].clone()])
            });
            let room = Room {
                parent,
                factors,
                waiting: &mut stack[front.contribution[shape].clone()],
            };
            self.contribute(front, panel, children, room, &mut rest, false)?;
        }
        let last = &fronts[fronts.len() - 1];
        let children = plan.children[last.children.clone()].iter();
        let left = children.map(|&child| {
            let child = &plan.fronts[child as usize];
            tools.stacks[child.stack][child.contribution[shape].clone()].to_vec()
        });
        Ok(Done {
            left: left.collect(),
            record,
        })
    }
}

/// Tools but for the stacks.
struct Rest<'a, T> {
    local: &'a mut Vec<u32>,
    maps: &'a mut Vec<BorderMap>,
    scratch: &'a mut Vec<T>,
}

impl<T> Tools<T> {
    fn rest(&mut self) -> Rest<'_, T> {
        Rest {
            local: &mut self.local,
            maps: &mut self.maps,
            scratch: &mut self.scratch,
        }
    }
}

/// Entries of the factors and pivots of tasks with those below them.
fn extent<K: Kernel<T>, T: Scalar>(tasks: &[Task]) -> (usize, usize) {
    let entries = tasks.iter().map(|task| K::entries(&task.total)).sum();
    let pivots = tasks.iter().map(|task| task.total.pivots).sum();
    (entries, pivots)
}
