//! From particles to a system of equations: the assembly of the implicit generalised
//! interpolation material point method with B-bar.
//!
//! The weak form (theory, eq. 1) becomes a sum over particles (eq. 1a). A step reads like the paper. [`Stencils`] hold the nodes of each particle, frozen for the step;
//! [`System`] evaluates stress and internal force at a trial displacement and, in the same pass, the
//! exact tangent; [`Particles::commit`] accepts a converged trial. Tension is positive.
//!
//! Nothing here iterates, cuts a step, reads a file or prints.

mod body;
pub(crate) mod commit;
pub(crate) mod conditions;
mod contributions;
pub(crate) mod energy;
mod equations;
mod error;
mod laws;
mod method;
mod step;
pub(crate) mod work;

pub use body::columns::{Column, ColumnKind, ColumnRequest, ColumnValues};
pub use body::particles::{ParticleFields, ParticleSeed, Particles};
pub use conditions::StepConditions;
pub use conditions::constraints::Constraints;
pub use conditions::ground_motion::{GroundMotion, Rayleigh};
pub use conditions::loads::{LoadPoint, StepLoads};
pub use conditions::pore_flow::{Consolidating, Permeable, PoreFlow, VoidLaw};
pub use conditions::reinforcement::ReinforcementControl;
pub use conditions::rigid_motion::{Drive, RigidMotion};
pub use conditions::time_step::{TimeScheme, TimeStep};
pub use conditions::unbalanced::UnbalancedForces;
pub use conditions::walls::{AbsorbingWall, FreeMotion, TiedWalls, WallNode, Walls};
pub use conditions::water::{PoreSite, PoreState, PoreStiffness, PoreWater, Water};
pub use contributions::consolidation::{PoresAfter, WaterMoved};
pub use contributions::inertia::Motion;
pub use contributions::reinforcement::{Hold, Reinforcement, Segment, SegmentState, Station};
pub use contributions::rigid::AcceptedContact;
pub use contributions::walls::TieForce;
pub use energy::StepEnergy;
pub use equations::kinematics::ParticleTrial;
pub use equations::residual::OutOfBalance;
pub use equations::system::{Reach, Structures, System};
pub use equations::trial::Trial;
pub use error::AssemblyError;
pub use igimp_rigid::{
    ContactChange, ContactNode, ContactState, Interface, Penalty, Penetration, Pose, RigidBody,
    RigidInertia, Shear, Tension,
};
pub use igimp_surface::{CarryingTriangle, Surface, SurfaceError, SurfaceTriangle};
pub use laws::SharedLaw;
pub use method::{
    CutVolume, DomainUpdate, Geometry, Kinematics, Locking, Method, Remedy, Section, SmallCuts,
};
pub use step::stencils::Stencils;
pub use step::ties::Carrier;
pub use step::unknowns::Unknowns;
pub use work::{PlasticFlow, StepWork};
