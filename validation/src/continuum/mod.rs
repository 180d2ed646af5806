//! Problems of continuum mechanics without a case file.

pub(crate) mod cook;
pub(crate) mod cylinder;
pub(crate) mod elastica;
pub(crate) mod laboratory;
pub(crate) mod notched_strip;
pub(crate) mod prism;
pub(crate) mod revolution;
