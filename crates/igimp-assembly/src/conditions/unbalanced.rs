//! Forces that hold a body while a change of its conditions is put on step by step.

use std::sync::Arc;

/// Unbalanced nodal forces after a change of construction, released linearly over the stage.
#[derive(Clone, Debug)]
pub struct UnbalancedForces<const D: usize> {
    /// By node of the grid \[force\].
    pub forces: Arc<Vec<[f64; D]>>,
    /// The share that still acts \[-\].
    pub share: f64,
}
