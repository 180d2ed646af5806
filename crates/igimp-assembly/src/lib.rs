//! From particles to a system of equations: the assembly of the implicit generalised
//! interpolation material point method with B-bar.
//!
//! The weak form (theory, eq. 1) becomes a sum over particles (eq. 1a). A step reads like the paper. [`Stencils`] hold who touches what, frozen for the step;
//! [`System`] evaluates stress and internal force at a trial displacement and, in the same pass, the
//! exact tangent; [`Particles::commit`] accepts a converged trial. Tension is positive.
//!
//! Nothing here iterates, cuts a step, reads a file or prints.

mod body;
mod contributions;
mod equations;
mod error;
mod method;
mod small;
mod step;

pub use body::particles::{ParticleFields, ParticleSeed, Particles};
pub use body::work::{PlasticFlow, StepWork};
pub use contributions::pore_water::{HeldForces, PoreSite, PoreState, PoreWater, Water};
pub use contributions::reinforcement::{
    Hold, Reinforcement, ReinforcementControl, Segment, SegmentState, Station,
};
pub use contributions::rigid::{
    AcceptedContact, CarryingTriangle, ContactNode, ContactState, Drive, Interface, Penalty, Pose,
    RigidBody, RigidMotion, Shear, Surface, SurfaceError, SurfaceTriangle, Swallowed, Tension,
};
pub use equations::kinematics::ParticleTrial;
pub use equations::residual::OutOfBalance;
pub use equations::system::System;
pub use equations::trial::Trial;
pub use equations::unknowns::Unknowns;
pub use error::AssemblyError;
pub use method::{DomainUpdate, Geometry, Kinematics, Locking, Method, Remedy, SmallCuts};
pub use step::constraints::Constraints;
pub use step::loads::{LoadPoint, StepLoads};
pub use step::stencils::Stencils;
pub use step::step_conditions::{SharedLaw, StepConditions};
