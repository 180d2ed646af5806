//! Dense blocks of fronts: products, eliminations and how they are stored.

pub(crate) mod dense_lu;
pub(crate) mod layout;
pub(crate) mod panels;
pub(crate) mod scalar;
pub(crate) mod signs;
pub(crate) mod tiles;
