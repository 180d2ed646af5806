//! Bodies of particles, and what a step does to them.

pub(crate) mod particles;
