//! Bodies of particles, and their changes in a step.

pub(crate) mod columns;
pub(crate) mod particles;
