//! Shared parts of all studies: outside values, snapshots, the tables and the matrix.

pub(crate) mod matrix;
pub(crate) mod oracle;
pub(crate) mod reference;
pub(crate) mod review;
pub(crate) mod snapshot;
pub(crate) mod study;
pub(crate) mod table;
