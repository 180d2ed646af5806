//! The report of a step: the equilibrium that it reached, or why there is none.

use std::time::Duration;

use igimp_assembly::{
    AssemblyError, Motion, Penetration, StepEnergy, StepWork, TieForce, WaterMoved,
};
use igimp_linear::{LinearEffort, LinearSolverError};
use thiserror::Error;

/// A component of the motion of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// Displacement along an axis.
    Displacement(usize),
    /// Rotation, in the plane or about an axis.
    Rotation(usize),
}

impl Component {
    /// In messages.
    fn name(self) -> &'static str {
        match self {
            Self::Displacement(0) => "displacement in x",
            Self::Displacement(1) => "displacement in y",
            Self::Displacement(_) => "displacement in z",
            Self::Rotation(_) => "rotation",
        }
    }
}

/// A place as it is printed, to a millionth of its unit.
fn place(position: &[f64]) -> String {
    let rounded = { position.iter() }.map(|x| ((x * 1e6).round() / 1e6).to_string());
    rounded.collect::<Vec<_>>().join(", ")
}

/// Why a step found no equilibrium.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum StepFailure {
    /// The corrections ran out.
    #[error("not converged after {iterations} corrections")]
    MaxIterations {
        /// How many were made.
        iterations: usize,
    },
    /// The residual grew far beyond its smallest value.
    #[error("the residual diverges")]
    Diverged,
    /// The residual found no new smallest value for many corrections.
    #[error("the residual stagnates")]
    Stagnated,
    /// Converged, but a particle would be carried off the background grid.
    #[error("particle {particle} would leave the background grid at {position:?} m")]
    LeavesGrid {
        /// Number of the particle, from 0.
        particle: usize,
        /// Where it would go \[length\], axes beyond the dimension 0.
        position: [f64; 3],
    },
    /// Converged, but a load point would be carried off the background grid.
    #[error("load point {point} would leave the background grid at {position:?} m")]
    LoadPointLeavesGrid {
        /// Number of the point, from 0.
        point: usize,
        /// Where it would go \[length\], axes beyond the dimension 0.
        position: [f64; 3],
    },
    /// Converged, but reinforcement would be carried off the background grid.
    #[error("the reinforcement \"{name}\" would leave the background grid at {position:?} m")]
    ReinforcementLeavesGrid {
        /// Its name.
        name: String,
        /// Where it would go \[length\], axes beyond the dimension 0.
        position: [f64; 3],
    },
    /// Converged, but a particle would be carried into a rigid body, or through it.
    #[error(transparent)]
    Penetration(#[from] Penetration),
    /// Converged, but soil has gone too far into a rigid body.
    #[error("soil has gone {share:.3} of a cell into the rigid body \"{body}\" at {position:?} m")]
    TooDeep {
        /// Name of the body.
        body: String,
        /// How far, as a share of the cell \[-\].
        share: f64,
        /// Where it is deepest \[length\], axes beyond the dimension 0.
        position: [f64; 3],
    },
    /// Converged, but motion changed by more than the step resolves.
    #[error("what changes with time changes by more than a step of {duration:.3e} s resolves")]
    TooLong {
        /// Duration of the step \[time\].
        duration: f64,
        /// How long it may be, as a share of that \[-\].
        share: f64,
    },
    /// Converged, but the body moves as a mechanism in a step that hides where that begins.
    #[error(
        "the body moves as a mechanism in a step that hides where that begins: a shorter one shows it"
    )]
    MechanismAtOnce,
    /// A rigid body is free to move, and nothing holds it.
    #[error(
        "nothing holds the rigid body \"{body}\" in its {}: {}",
        component.name(),
        if *touches { "the soil around it gives no resistance" } else { "no soil is near it" }
    )]
    NotHeld {
        /// Name of the body.
        body: String,
        /// The component that nothing holds.
        component: Component,
        /// Whether soil is near enough to touch it.
        touches: bool,
    },
    /// A step in statics would carry a rigid body further than one that equilibrium goes on in.
    #[error(
        "the rigid body \"{body}\" would go by {way:.3} m and turn by {rotation:.3} rad in one step"
    )]
    Thrown {
        /// Name of the body.
        body: String,
        /// Its way \[length\].
        way: f64,
        /// Its rotation \[rad\].
        rotation: f64,
    },
    /// The free field beside a wall finds no equilibrium.
    #[error("the column of soil in free field beside a wall does not move on")]
    FreeField(#[source] Box<StepFailure>),
    /// A number of the linear system that must be finite is not.
    #[error("the {vector} at {position:?} m, axis {axis}, is not finite")]
    NotFinite {
        /// `"right-hand side"` or `"correction"`.
        vector: &'static str,
        /// Place of the node \[length\], axes beyond the dimension 0.
        position: [f64; 3],
        /// The component, from 0.
        axis: usize,
    },
    /// The linear system is singular at a node, which nothing holds.
    #[error("the linear system is singular at ({}) m, in the {}: nothing holds that node", place(position), component.map_or("scalar of the node", Component::name))]
    Singular {
        /// Place of the node \[length\].
        position: Vec<f64>,
        /// The component of its displacement; none for its pore pressure or nonlocal strain.
        component: Option<Component>,
    },
    /// The equations could not be formed.
    #[error("the equations could not be formed")]
    Assembly(#[source] AssemblyError),
    /// The linear system could not be solved.
    #[error("the linear system could not be solved")]
    Linear(#[from] LinearSolverError),
}

impl From<AssemblyError> for StepFailure {
    fn from(error: AssemblyError) -> Self {
        match error {
            AssemblyError::Thrown {
                body,
                way,
                rotation,
            } => Self::Thrown {
                body,
                way,
                rotation,
            },
            other => Self::Assembly(other),
        }
    }
}

impl StepFailure {
    /// Whether the failure speaks for want of equilibrium, as past a limit load: the equations were
    /// there and Newton's method found no solution near. A particle that leaves the grid, a law that
    /// cannot answer or memory that runs out tell nothing of the load that a body carries.
    pub fn is_want_of_equilibrium(&self) -> bool {
        match self {
            Self::MaxIterations { .. }
            | Self::Diverged
            | Self::Stagnated
            | Self::Singular { .. }
            | Self::Thrown { .. }
            | Self::MechanismAtOnce
            | Self::NotHeld { .. } => true,
            Self::LeavesGrid { .. }
            | Self::LoadPointLeavesGrid { .. }
            | Self::ReinforcementLeavesGrid { .. }
            | Self::Penetration(_)
            | Self::TooDeep { .. }
            | Self::TooLong { .. }
            | Self::NotFinite { .. } => false,
            Self::FreeField(failure) => failure.is_want_of_equilibrium(),
            Self::Assembly(error) => error.is_too_far(),
            Self::Linear(error) => {
                error.is_singular()
                    || matches!(error, LinearSolverError::NotPositiveDefinite { .. })
            }
        }
    }

    /// Whether a linear system had no solution: a node without soil that holds it, or soil that has lost its stiffness.
    pub fn is_singular(&self) -> bool {
        match self {
            Self::Singular { .. } => true,
            Self::Linear(error) => error.is_singular(),
            _ => false,
        }
    }

    /// How long a step may be that is made again, as a share of this one, where the failure tells \[-\].
    pub(crate) fn share_of_next(&self) -> Option<f64> {
        match self {
            Self::TooLong { share, .. } => Some(*share),
            _ => None,
        }
    }

    /// Whether something was to be carried off the grid: a smaller step only puts that off.
    pub(crate) fn leaves_grid(&self) -> bool {
        matches!(
            self,
            Self::LeavesGrid { .. }
                | Self::LoadPointLeavesGrid { .. }
                | Self::ReinforcementLeavesGrid { .. }
        )
    }
}

/// A step whose work is dissipated by this share moves the body as a mechanism \[-\].
pub const MECHANISM: f64 = 0.99;

/// A step that was not accepted, with its data.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("no equilibrium between load factors {from} and {to}")]
pub struct StepError {
    /// Load factor at the start \[-\].
    pub from: f64,
    /// Load factor tried \[-\].
    pub to: f64,
    /// Relative out-of-balance norm before each correction \[-\].
    pub residuals: Vec<f64>,
    /// Position \[length\] and axis of the largest out-of-balance force.
    pub worst: Option<([f64; 3], usize)>,
    /// Why.
    #[source]
    pub failure: Box<StepFailure>,
}

/// Time spent in the phases of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseTimes {
    /// Stencils, unknowns, external force, pattern.
    pub set_up: Duration,
    /// Passes over the particles: stress, internal force, tangent matrix; residual.
    pub assembly: Duration,
    /// Factorisation of the tangent matrices, with the analysis of their patterns.
    pub factor: Duration,
    /// Solution of the linear systems.
    pub solve: Duration,
    /// Writing the accepted state.
    pub commit: Duration,
}

impl PhaseTimes {
    /// Adds another step's times.
    pub fn add(&mut self, other: &Self) {
        self.set_up += other.set_up;
        self.assembly += other.assembly;
        self.factor += other.factor;
        self.solve += other.solve;
        self.commit += other.commit;
    }
}

/// An accepted step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepReport {
    /// Load factor at the start \[-\].
    pub from: f64,
    /// Load factor reached \[-\].
    pub to: f64,
    /// Number of corrections.
    pub iterations: usize,
    /// Relative out-of-balance norm before each correction and at the end \[-\].
    pub residuals: Vec<f64>,
    /// Whether the step was accepted above the tolerance because its residual is nothing but
    /// round-off of the internal force.
    pub at_round_off: bool,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Share of particles that returned to the yield surface \[-\].
    pub plastic_share: f64,
    /// Share of the load that dropped nodes take without a support \[-\].
    pub false_support: f64,
    /// The ghost penalty that the step was given because a node that hardly touches soil left its
    /// system singular; zero in a step that did without \[-\].
    pub ghost_penalty: f64,
    /// The fraction of a cell below which nodes were tied, of a step on a given geometry that was singular at one which hardly touches
    /// soil; zero in a step that did without \[-\].
    pub tied_below: f64,
    /// Whether the grid took over means of the motion of the particles, which lose energy, as no motion that comes closest to it
    /// was found.
    pub moves_by_means: bool,
    /// Position \[length\] and axis of the largest out-of-balance force that was left.
    pub worst: Option<([f64; 3], usize)>,
    /// Share of the external force that drag against motion carries; zero in equilibrium \[-\].
    pub drag_share: f64,
    /// The work of stress on the strain of the step, of a step on a path.
    pub work: Option<StepWork>,
    /// Duration; zero in statics \[time\].
    pub duration: f64,
    /// Where the work of a step that takes time goes; none in statics.
    pub energy: Option<StepEnergy>,
    /// The water that moved, of a step in which water flows.
    pub water: Option<WaterMoved>,
    /// How many times as long the next step may be as this one, of a step that takes time \[-\].
    pub pace: f64,
    /// The work of the external force on the step \[force·length\].
    pub external_work: f64,
    /// The same, with the magnitude of each component's work \[force·length\].
    pub gross_work: f64,
    /// By how much the residual that was left puts the load factor in doubt where that was unknown, as a share of it
    /// \[-\].
    pub factor_in_doubt: f64,
    /// How the linear systems were solved.
    pub linear: LinearEffort,
    /// Time spent.
    pub times: PhaseTimes,
}

/// Forces of an accepted step, by node of its grid.
#[derive(Clone, Debug, PartialEq)]
pub struct NodalForces<const D: usize> {
    /// Reaction f_int − f_ext where displacement is prescribed, zero elsewhere \[force\].
    pub reactions: Vec<[f64; D]>,
    /// Step displacement \[length\].
    pub u: Vec<[f64; D]>,
    /// How the nodes move; none in statics.
    pub motion: Option<Motion<D>>,
    /// The forces that make the nodes of two walls move together.
    pub ties: Vec<TieForce<D>>,
}

/// A position with zeros beyond the dimension, for messages.
pub(crate) fn padded<const D: usize>(x: &[f64; D]) -> [f64; 3] {
    let mut out = [0.0; 3];
    out[..D].copy_from_slice(x);
    out
}
