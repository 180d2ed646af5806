//! Bodies of particles, and what a step does to them.

pub(crate) mod commit;
pub(crate) mod particles;
pub(crate) mod work;
