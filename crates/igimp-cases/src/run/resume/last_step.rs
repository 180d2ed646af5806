//! The last step of a march that a path of equilibria may follow, as checkpoints tell it.

use igimp_solver::LastStep;
use serde::{Deserialize, Serialize};

/// That step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SavedStep {
    /// Nodal step displacements, node after node \[length\].
    u: Vec<f64>,
    /// Change of the load factor \[-\].
    change: f64,
    /// Gross work of the external force \[force·length\].
    work: f64,
    /// Share of that work that was not elastic \[-\].
    dissipated: f64,
}

impl SavedStep {
    /// A step as it is saved.
    pub(crate) fn of<const D: usize>(step: &LastStep<D>) -> Self {
        Self {
            u: step.u.as_flattened().to_vec(),
            change: step.change,
            work: step.work,
            dissipated: step.dissipated,
        }
    }

    /// The step that was saved.
    pub(crate) fn step<const D: usize>(&self) -> LastStep<D> {
        let (nodes, _) = self.u.as_chunks::<D>();
        LastStep {
            u: nodes.to_vec(),
            change: self.change,
            work: self.work,
            dissipated: self.dissipated,
        }
    }
}
