//! The equations of equilibrium of a step: residual and tangent.

pub(crate) mod batches;
pub(crate) mod blocks;
pub(crate) mod damping;
pub(crate) mod ground;
pub(crate) mod kinematics;
pub(crate) mod linearised;
pub(crate) mod mirror;
pub(crate) mod motion;
pub(crate) mod pass;
pub(crate) mod patch;
pub(crate) mod reach;
pub(crate) mod residual;
pub(crate) mod scatter;
pub(crate) mod system;
pub(crate) mod trial;
