//! Solvers of published packages: second opinions, and the last resort.

pub(crate) mod faer_cholesky;
pub(crate) mod general_lu;
pub(crate) mod nalgebra_cholesky;
pub(crate) mod sprs_bicgstab;
