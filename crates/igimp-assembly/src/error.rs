//! Errors between particles and the global system, with the particle's name.

use igimp_material::MaterialError;
use igimp_shape::ShapeError;
use thiserror::Error;

/// Errors of seeding, stencils, kinematics and constraints.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AssemblyError {
    /// There is nothing to compute.
    #[error("the body is empty: it holds no particle")]
    EmptyBody,
    /// A particle was given a property outside its range.
    #[error("particle {particle}: {field} is {value}, but must be {requirement}")]
    InvalidParticle {
        /// Number of the particle, from 0.
        particle: usize,
        /// Name of the property.
        field: &'static str,
        /// The value given.
        value: f64,
        /// The values that are accepted.
        requirement: &'static str,
    },
    /// A particle names a law that is not in the list.
    #[error("particle {particle} uses law {law}, but there are {laws} laws (numbered from 0)")]
    UnknownLaw {
        /// Number of the particle, from 0.
        particle: usize,
        /// The law it names.
        law: usize,
        /// How many laws there are.
        laws: usize,
    },
    /// A particle's centre or domain has no place on the grid.
    #[error("particle {particle} at {position:?} m has no place on the background grid")]
    Shape {
        /// Number of the particle, from 0.
        particle: usize,
        /// Position of the particle's centre \[length\], axes beyond the dimension 0.
        position: [f64; 3],
        /// The error of the basis.
        #[source]
        source: ShapeError,
    },
    /// The grid of a step cannot be made.
    #[error("the grid of the step cannot be made")]
    Grid {
        /// The error of the axis.
        #[source]
        source: ShapeError,
    },
    /// The law of a step cannot be made.
    #[error("the law of the step cannot be made")]
    Law {
        /// The error of the law.
        #[source]
        source: MaterialError,
    },
    /// A loaded point has no place on the grid.
    #[error("load point {point} at {position:?} m has no place on the background grid")]
    LoadPoint {
        /// Number of the point, from 0.
        point: usize,
        /// Position \[length\], axes beyond the dimension 0.
        position: [f64; 3],
        /// The error of the basis.
        #[source]
        source: ShapeError,
    },
    /// A loaded point stands where there is no soil.
    #[error("load point {point} at {position:?} m acts on a part of the grid that holds no soil")]
    UnsupportedLoad {
        /// Number of the point, from 0.
        point: usize,
        /// Position \[length\], axes beyond the dimension 0.
        position: [f64; 3],
    },
    /// No soil stands in the cells beside a wall that would have a free field.
    #[error("no soil touches the {} wall across axis {axis}, beside which a free field is to move", if *upper { "upper" } else { "lower" })]
    NoFreeField {
        /// The axis across the wall.
        axis: usize,
        /// Whether it is the upper one.
        upper: bool,
    },
    /// A part of a reinforcement is where there is no soil.
    #[error("no soil carries the reinforcement \"{name}\" at {position:?} m")]
    UnsupportedReinforcement {
        /// Its name.
        name: String,
        /// Where \[length\], axes beyond the dimension 0.
        position: [f64; 3],
    },
    /// A law could not answer.
    #[error("particle {particle}: the constitutive law failed")]
    Material {
        /// Number of the particle, from 0.
        particle: usize,
        /// The error of the law.
        #[source]
        source: MaterialError,
    },
    /// A trial displacement turns a particle inside out.
    #[error(
        "particle {particle}: the determinant of the deformation increment is {determinant:.3e}, \
             but must be positive"
    )]
    Inverted {
        /// Number of the particle, from 0.
        particle: usize,
        /// det ΔF, or det of its cell-averaged part.
        determinant: f64,
    },
    /// A trial displacement strains a particle beyond the range of numbers.
    #[error("particle {particle}: the elastic strain {strain:.3e} is beyond all bounds")]
    Overstrained {
        /// Number of the particle, from 0.
        particle: usize,
        /// A principal elastic Hencky strain \[-\].
        strain: f64,
    },
    /// A step in statics carries a rigid body further than equilibrium can be said to go on.
    #[error(
        "the rigid body \"{body}\" would go by {way:.3} m and turn by {rotation:.3} rad in one step"
    )]
    Thrown {
        /// Name of the body.
        body: String,
        /// The way of its reference point where that is free \[length\].
        way: f64,
        /// Its rotation where that is free \[rad\].
        rotation: f64,
    },
    /// A constraint names a node that the grid does not have.
    #[error("a constraint names node {node}, but the grid has {nodes} nodes (numbered from 0)")]
    UnknownNode {
        /// The node named.
        node: usize,
        /// How many nodes there are.
        nodes: usize,
    },
    /// A constraint names an axis that space does not have.
    #[error("a constraint names axis {axis}, but there are {axes} axes (numbered from 0)")]
    UnknownAxis {
        /// The axis named.
        axis: usize,
        /// How many axes there are.
        axes: usize,
    },
    /// Constraints and grid do not belong together.
    #[error(
        "the constraints were made for a grid of {made_for:?} nodes along its axes, but this one \
             has {grid:?}: make them for the grid of the step"
    )]
    OtherGrid {
        /// Nodes along each axis of the grid that the constraints know.
        made_for: Vec<usize>,
        /// Nodes along each axis of the grid given.
        grid: Vec<usize>,
    },
    /// Every degree of freedom is prescribed or dropped.
    #[error("no unknown is left: every active node is fixed")]
    NoUnknowns,
    /// Softening over a length is asked for where it is not solved for.
    #[error(
        "softening over a length goes with plane strain in statics, not with {with}: scale it by the width of its bands"
    )]
    NonlocalStrain {
        /// The setting that it does not go with.
        with: &'static str,
    },
    /// The velocities that the grid takes over from the particles were not found.
    #[error(
        "the motion of the particles could not be given to the grid: a share of {left:.1e} of their momentum is left"
    )]
    MotionNotFound {
        /// The rest of the momentum, over all of it \[-\].
        left: f64,
    },
    /// A number that must be finite is not.
    #[error("{quantity} is not finite at index {index}")]
    NonFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// Index within it.
        index: usize,
    },
}

impl AssemblyError {
    /// Whether a trial displacement went further than any material or any body follows: a shorter one may do.
    pub fn is_too_far(&self) -> bool {
        matches!(
            self,
            Self::Inverted { .. }
                | Self::Overstrained { .. }
                | Self::Thrown { .. }
                | Self::Material {
                    source: MaterialError::NotConverged { .. } | MaterialError::SnapBack { .. },
                    ..
                }
        )
    }
}

/// A position with zeros beyond the dimension, for messages.
pub(crate) fn padded<const D: usize>(x: &[f64; D]) -> [f64; 3] {
    let mut out = [0.0; 3];
    out[..D].copy_from_slice(x);
    out
}
