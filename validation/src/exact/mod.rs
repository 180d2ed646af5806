//! Exact solutions that studies are held against.

pub(crate) mod breathing;
pub(crate) mod cylinder;
pub(crate) mod elastica;
pub(crate) mod sphere;
