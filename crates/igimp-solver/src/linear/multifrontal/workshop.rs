//! Memory to work in, kept from factorisation to factorisation.
//!
//! Each thread takes a set of tools from the shelf and puts it back. What is on the shelf depends on
//! how many threads there were; what is computed with it does not.

use std::sync::Mutex;

use super::super::LinearSolverError;
use super::extend_add::BorderMap;
use super::plan::Plan;

/// What one task needs while it is worked on.
#[derive(Default)]
pub(super) struct Tools {
    /// Contributions that wait for their parents.
    pub(super) stacks: [Vec<f64>; 2],
    /// First row in the border of the current front, by rank.
    pub(super) local: Vec<u32>,
    pub(super) map: BorderMap,
    /// Part of a vector on the border of a front.
    pub(super) border: Vec<f64>,
    /// What a kernel works in.
    pub(super) scratch: Vec<f64>,
}

/// The shelf.
#[derive(Default)]
pub(super) struct Workshop {
    tools: Mutex<Vec<Tools>>,
    /// Room for contributions from task to task.
    buffers: Mutex<Vec<Vec<f64>>>,
}

impl Workshop {
    /// Tools for a task of a plan.
    pub(super) fn tools(&self, plan: &Plan) -> Result<Tools, LinearSolverError> {
        let mut tools = lock(&self.tools).pop().unwrap_or_default();
        if tools.local.len() < plan.order.len() {
            tools.local.resize(plan.order.len(), 0);
        }
        make_room(&mut tools.border, plan.largest_border, "vector")?;
        Ok(tools)
    }

    pub(super) fn give_back(&self, tools: Tools) {
        lock(&self.tools).push(tools);
    }

    /// A buffer of at least so many entries, of any content.
    pub(super) fn buffer(&self, len: usize) -> Result<Vec<f64>, LinearSolverError> {
        let mut buffers = lock(&self.buffers);
        let fitting = (0..buffers.len()).filter(|&index| buffers[index].len() >= len);
        let smallest = fitting.min_by_key(|&index| buffers[index].len());
        let mut buffer = smallest
            .map(|index| buffers.swap_remove(index))
            .unwrap_or_default();
        drop(buffers);
        make_room(&mut buffer, len, "contributions")?;
        Ok(buffer)
    }

    pub(super) fn give_back_buffer(&self, buffer: Vec<f64>) {
        if !buffer.is_empty() {
            lock(&self.buffers).push(buffer);
        }
    }
}

/// The content of a lock, also after a panic elsewhere: tools have no state that could be broken.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Makes room for `len` entries; what was there before is of no interest.
///
/// Memory is kept while it suffices, and some is added to spare when it does not: a body that
/// spreads over the grid asks for a little more in every step. Fresh memory comes zeroed from the
/// system and is not touched before it is used.
pub(super) fn make_room(
    values: &mut Vec<f64>,
    len: usize,
    what: &'static str,
) -> Result<(), LinearSolverError> {
    if values.len() < len {
        *values = Vec::new();
        let roomy = len + len / 16;
        values
            .try_reserve_exact(roomy)
            .map_err(|_| LinearSolverError::OutOfMemory { what })?;
        *values = Vec::new();
        *values = vec![0.0; roomy];
    }
    Ok(())
}
