//! Rigid bodies beside soil: a surface with an interface on each of its sides, a pose, a mass, what contact has left
//! behind, the faces that particles turn to them, and the traction of soil at a knot. Nothing here knows of stress in soil or of
//! equilibrium.

mod arm;
mod clearance;
mod face;
mod face_clipping;
mod gyration;
mod images;
mod inertia;
mod interface;
mod knot_contact;
mod pose;
mod state;
mod turn;

use std::sync::Arc;

use igimp_surface::Surface;

pub use arm::Arm;
pub use clearance::{Domains, Penetration, WaysOff, push_out, seeded_too_close};
pub use face::{ALONG_THE_GRID, Face, FacePoint};
pub use face_clipping::{Piece, pieces, tents_within};
pub use gyration::Gyration;
pub use images::{Image, Images};
pub use inertia::RigidInertia;
pub use interface::{Interface, Penalty, Shear, Tension};
pub use knot_contact::{ADHESIVE_GAP, AddBlock, Arms, Functional, KnotContact, Traction};
pub use pose::Pose;
pub use state::{ContactChange, ContactNode, ContactState};
pub use turn::Turn;

/// Nodes that stand for the motion of a body behind the nodes of the grid: one for its displacement, one
/// for its rotation.
pub const NODES_PER_BODY: usize = 2;

/// A rigid body.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody<const D: usize> {
    /// Its name in messages.
    pub name: String,
    /// Its surface, in the frame of the body.
    pub surface: Arc<Surface<D>>,
    /// The interfaces of its sides, in the order of the sides of the surface.
    pub interfaces: Vec<Interface>,
    /// Stiffness of contact.
    pub penalty: Penalty,
    /// Where it stands.
    pub pose: Pose<D>,
    /// Its mass, and how it moves.
    pub motion: RigidInertia<D>,
    /// The state of contact; written in `commit` alone.
    pub contact: ContactState,
}

impl<const D: usize> RigidBody<D> {
    /// A body that has touched nothing yet, with its reference point at `origin` \[length\], where the
    /// frame of its surface begins too.
    ///
    /// # Panics
    /// If there is not one interface for each side.
    pub fn new(surface: Surface<D>, interfaces: Vec<Interface>, origin: [f64; D]) -> Self {
        assert_eq!(
            surface.side_count(),
            interfaces.len(),
            "every side has an interface"
        );
        Self {
            name: "unnamed".to_owned(),
            contact: ContactState::none(surface.knot_count()),
            surface: Arc::new(surface),
            interfaces,
            penalty: Penalty::default(),
            pose: Pose::at(origin),
            motion: RigidInertia::default(),
        }
    }

    /// The knots of its surface in space \[length\].
    pub fn knots(&self) -> Vec<[f64; D]> {
        let knots = self.surface.knots().into_iter();
        knots.map(|(knot, _)| self.pose.into_space(&knot)).collect()
    }

    /// Signed distance of a point \[length\] in space to the surface, negative within the body, and the
    /// direction in which it grows.
    pub fn nearest(&self, x: &[f64; D]) -> (f64, [f64; D]) {
        let (distance, normal) = self.surface.distance(&self.pose.into_body(x));
        (distance, self.pose.direction(&normal))
    }

    /// Displacement \[length\] and rotation \[rad\] of the body with this number among bodies, by the displacements of the nodes that
    /// stand for bodies.
    pub fn motion_of(&self, number: usize, nodes: &[[f64; D]]) -> [[f64; D]; NODES_PER_BODY] {
        let size = self.surface.size();
        let first = NODES_PER_BODY * number;
        [nodes[first], nodes[first + 1].map(|turned| turned / size)]
    }

    /// Force and moment about the reference point on the body with this number among bodies, by the forces at the nodes that stand
    /// for bodies \[force, force·length\].
    pub fn resultant_of(&self, number: usize, nodes: &[[f64; D]]) -> [[f64; D]; NODES_PER_BODY] {
        let size = self.surface.size();
        let first = NODES_PER_BODY * number;
        [nodes[first], nodes[first + 1].map(|turning| turning * size)]
    }

    /// Signed distance of a point \[length\] in space to the surface, negative within the body.
    pub fn distance(&self, x: &[f64; D]) -> f64 {
        self.nearest(x).0
    }
}

/// Number of rotations in space of dimension D: 1 in the plane, 3 in space.
pub const fn rotations(dimension: usize) -> usize {
    dimension * (dimension - 1) / 2
}
