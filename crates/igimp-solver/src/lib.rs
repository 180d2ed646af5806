//! From one equilibrium to the next: Newton–Raphson iteration, load marching with step cutting, and paths of
//! equilibria.
//!
//! [`step`] finds the equilibrium of one load step, [`march`] drives a body through many. A state
//! is written only when a step is accepted, so nothing is ever rolled back, and why a march
//! stopped is data ([`Outcome`]).

mod body;
mod continuation;
mod corrector;
mod free_factor;
mod march;
mod newton;
mod report;
mod residual_history;
mod sensitivity;

pub use body::Body;
pub use continuation::{ContinuationSettings, ContinuationState, MECHANISM, follow};
pub use march::{
    Accepted, LoadPath, MarchReport, MarchSettings, MarchState, Observer, Outcome, march,
    march_from,
};
pub use newton::{NewtonSettings, Workspace, step};
pub use report::{Component, NodalForces, PhaseTimes, StepError, StepFailure, StepReport};
pub use sensitivity::{Increment, KinematicFactor};
