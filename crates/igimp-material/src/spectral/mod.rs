//! Between tensors and their principal values.

pub(crate) mod eigen;
pub(crate) mod lift;
pub(crate) mod principal;
pub(crate) mod spatial;
