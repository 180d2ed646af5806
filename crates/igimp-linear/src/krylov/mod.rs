//! Krylov iterations with any preconditioner.

pub(crate) mod iterations;
pub(crate) mod preconditioned;
pub(crate) mod product;
