//! Flows that cannot be solved.

use igimp_linear::LinearSolverError;
use thiserror::Error;

/// Why there is no seepage.
#[derive(Debug, Error)]
pub enum SeepageError {
    /// No cell of the grid holds soil.
    #[error("no cell of the grid holds soil that water could flow through")]
    NoGround,
    /// Nothing says how high the water stands.
    #[error("no face and no region has a head: give one where water enters or leaves")]
    NoHead,
    /// Nothing says how much water is in the ground.
    #[error(
        "no water enters the ground: no free water touches it, no face and no region has a head or an inflow, and it does not rain; \
         say where water comes from"
    )]
    NotFed,
    /// A box of a condition touches no soil or no face.
    #[error("`{name}` {problem}")]
    Empty {
        /// Name of the condition.
        name: String,
        /// The fault.
        problem: &'static str,
    },
    /// A number that does not serve.
    #[error("{quantity} is {value}, and has to be {wanted}")]
    Value {
        /// The number.
        quantity: String,
        /// Its value.
        value: f64,
        /// The range that it has to be in.
        wanted: &'static str,
    },
    /// Corrections that do not lead to a balance of water.
    #[error(
        "the free surface was not found: after {corrections} corrections the balance is still off by {residual:.1e} of the flow; \
         where more is to be taken from the ground than flows to it, take less; else let the permeability fall over more height, or take \
         smaller cells"
    )]
    NotFound {
        /// Corrections made.
        corrections: usize,
        /// Largest imbalance of a node over the largest flow \[-\].
        residual: f64,
    },
    /// A flow in time that finds no balance.
    #[error(
        "the flow in time does not go on after {time:.4e} s: no step was found that balances or is accurate, however short; \
         let a head or rain that changes at once do so over some time, let the permeability fall over more height, or take other cells"
    )]
    Stuck {
        /// Time of the last balance \[s\].
        time: f64,
    },
    /// A flow in time whose start is that of other ground.
    #[error("the flow that it starts from is that of other ground")]
    OtherGround,
    /// A linear system that could not be solved.
    #[error("a part of the ground has no head to go by, or the flow has no one solution: {source}")]
    Linear {
        /// Why.
        #[from]
        source: LinearSolverError,
    },
}
