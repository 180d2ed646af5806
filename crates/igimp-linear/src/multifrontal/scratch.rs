//! Memory to work in, kept from factorisation to factorisation.
//!
//! Each thread takes a set of tools from the shelf and puts it back. The stock of the shelf depends on
//! how many threads there were; results computed with it do not.

use std::sync::Mutex;

use super::dense::scalar::Scalar;
use super::extend_add::BorderMap;
use super::tree::plan::Plan;
use crate::LinearSolverError;

/// Scratch memory of one task.
#[derive(Default)]
pub(crate) struct Tools<T> {
    /// Contributions that wait for parents.
    pub(crate) stacks: [Vec<T>; 2],
    /// First row in the border of the current front, by rank.
    pub(crate) local: Vec<u32>,
    /// Where fronts lie in their parents, for a front and its children.
    pub(super) maps: Vec<BorderMap>,
    /// Where the factors of each front of the task begin.
    pub(crate) offsets: Vec<usize>,
    /// Part of a vector on the border of a front.
    pub(crate) border: Vec<T>,
    /// Scratch memory of the kernel.
    pub(crate) scratch: Vec<T>,
}

/// The shelf.
#[derive(Default)]
pub(crate) struct Scratch<T> {
    tools: Mutex<Vec<Tools<T>>>,
}

impl<T: Scalar> Scratch<T> {
    /// Tools for a task of a plan.
    pub(crate) fn tools(&self, plan: &Plan) -> Result<Tools<T>, LinearSolverError> {
        let mut tools = lock(&self.tools).pop().unwrap_or_default();
        if tools.local.len() < plan.order.len() {
            tools.local.resize(plan.order.len(), 0);
        }
        make_room(&mut tools.border, plan.largest_border, "vector")?;
        Ok(tools)
    }

    pub(crate) fn give_back(&self, tools: Tools<T>) {
        lock(&self.tools).push(tools);
    }
}

/// The content of a lock, also after a panic elsewhere: tools have no state that could be broken.
fn lock<C>(mutex: &Mutex<C>) -> std::sync::MutexGuard<'_, C> {
    mutex
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Makes room for `len` entries; earlier entries are of no interest.
///
/// Memory is kept while it suffices, and some is added to spare when it does not: a body that
/// spreads over the grid asks for a little more in every step. Fresh memory comes zeroed from the
/// system and is not touched before it is used.
pub(crate) fn make_room<T: Copy + Default>(
    values: &mut Vec<T>,
    len: usize,
    part: &'static str,
) -> Result<(), LinearSolverError> {
    if values.len() < len {
        *values = Vec::new();
        let roomy = len + len / 16;
        values
            .try_reserve_exact(roomy)
            .map_err(|_| LinearSolverError::OutOfMemory { part })?;
        *values = Vec::new();
        *values = vec![T::default(); roomy];
    }
    Ok(())
}
