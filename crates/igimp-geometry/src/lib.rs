//! Regions that bodies fill: polygons in the plane and solids in space, and the particles seeded in them.
//!
//! | module | what to find |
//! |---|---|
//! | [`region`] | the seam: the part of a body in a box, and where lines cross it |
//! | [`outline`] | where outlines cross, overlap and face each other, for checks |
//! | [`gaps`] | gaps narrower than the cells of a grid |
//! | [`polygon`], [`solid`] | regions of the plane and of space |
//! | [`seed`] | particles from regions |

mod error;
pub mod gaps;
pub mod outline;
pub mod polygon;
pub mod region;
pub mod seed;
pub mod solid;

pub use error::SeedError;
