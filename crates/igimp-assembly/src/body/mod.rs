//! Bodies of particles, and what a step does to them.

pub(crate) mod columns;
pub(crate) mod particles;
