//! Forces that hold a body while a change of its conditions is put on step by step.

use std::sync::Arc;

/// Forces that hold a body where a change has put it out of balance, until they are let go.
#[derive(Clone, Debug)]
pub struct UnbalancedForces<const D: usize> {
    /// By node of the grid \[force\].
    pub forces: Arc<Vec<[f64; D]>>,
    /// The share that still acts \[-\].
    pub share: f64,
}
