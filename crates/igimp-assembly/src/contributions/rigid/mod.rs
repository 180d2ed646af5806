//! Rigid bodies that soil touches, slides along and leaves (theory, "contact").
//!
//! How a body moves in a step is data ([`RigidMotion`](crate::RigidMotion)); the response of the soil is found with the
//! displacements of the nodes.

mod contact;
mod mortar_integrals;
mod rollers;
mod sums;
mod weight;

pub use contact::AcceptedContact;
pub(crate) use contact::Contact;
pub(crate) use weight::{TurningWeights, add_weights};
