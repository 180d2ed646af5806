//! Damping of soil by its elastic stiffness (theory, eq. 75).

use igimp_linear::TangentMatrix;

/// Damping by the elastic stiffness as the step begins: a force β K_e v.
#[derive(Debug)]
pub(crate) struct StiffnessDamping {
    /// β \[time\].
    pub(crate) factor: f64,
    /// By which a displacement becomes a velocity \[1/time\].
    pub(crate) rate: f64,
    /// K_e by unknown of the grid \[force/length\].
    pub(crate) stiffness: TangentMatrix,
}
