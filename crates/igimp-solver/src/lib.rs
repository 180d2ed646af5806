//! From one equilibrium to the next: Newton–Raphson iteration, load marching with step cutting, and paths of
//! equilibria.
//!
//! [`step`] finds the equilibrium of one load step, [`march`] drives a body through many. A state
//! is written only when a step is accepted, so nothing is ever rolled back, and why a march
//! stopped is data ([`Outcome`]). [`element`] drives a law on its own.

mod body;
mod continuation;
mod corrector;
pub mod element;
mod free_factor;
mod free_field;
mod march;
mod newton;
mod pace;
mod report;
mod residual_history;
mod sensitivity;
mod settings;
mod workspace;

pub use crate::settings::LoadPath;
pub use crate::settings::NewtonSettings;
pub use crate::workspace::Workspace;
pub use body::Body;
pub use continuation::{ContinuationSettings, ContinuationState, LastStep, follow};
pub use free_field::FreeField;
pub use march::{
    Accepted, Driver, MarchReport, MarchSettings, MarchState, Observed, Observer, Outcome, Pace,
    march, march_from,
};
pub use newton::step;
pub use report::{
    Component, MECHANISM, NodalForces, PhaseTimes, StepError, StepFailure, StepReport,
};
pub use sensitivity::{Increment, KinematicFactor};
