//! From particles to a system of equations: the assembly of the implicit generalised
//! interpolation material point method with B-bar.
//!
//! The weak form (theory, eq. 1) becomes a sum over particles (eq. 1a). A step reads like the paper. [`Stencils`] hold who touches what, frozen for the step;
//! [`System`] evaluates stress and internal force at a trial displacement and, in the same pass, the
//! exact tangent; [`Particles::commit`] accepts a converged trial. Tension is positive.
//!
//! Nothing here iterates, cuts a step, reads a file or prints.

mod batches;
mod blocks;
mod cell_soil;
mod commit;
mod constraints;
mod couplings;
mod dropped;
mod error;
mod ghost;
mod kinematics;
mod linearised;
mod loads;
mod method;
mod mirror;
mod nodal_forces;
mod particles;
mod patch;
mod pore_water;
mod reach;
mod reinforcement;
mod residual;
mod rigid;
mod scatter;
mod small;
mod small_cuts;
mod stencils;
mod step_conditions;
mod strips;
mod supports;
mod system;
mod trial;
mod unknowns;
mod work;

pub use constraints::Constraints;
pub use error::AssemblyError;
pub use kinematics::ParticleTrial;
pub use loads::{LoadPoint, StepLoads};
pub use method::{DomainUpdate, Geometry, Kinematics, Locking, Method, Remedy, SmallCuts};
pub use particles::{ParticleFields, ParticleSeed, Particles};
pub use pore_water::{HeldForces, PoreSite, PoreState, PoreWater, Water};
pub use reinforcement::{
    Hold, Reinforcement, ReinforcementControl, Segment, SegmentState, Station,
};
pub use residual::OutOfBalance;
pub use rigid::{
    AcceptedContact, CarryingTriangle, ContactNode, ContactState, Drive, Interface, Penalty, Pose,
    RigidBody, RigidMotion, Shear, Surface, SurfaceError, SurfaceTriangle, Swallowed, Tension,
};
pub use stencils::Stencils;
pub use step_conditions::{SharedLaw, StepConditions};
pub use system::System;
pub use trial::Trial;
pub use unknowns::Unknowns;
pub use work::{PlasticFlow, StepWork};
