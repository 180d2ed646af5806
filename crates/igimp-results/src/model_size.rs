//! How large a model is.

use serde::{Deserialize, Serialize};

/// Numbers that tell the size of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelSize {
    /// Dimensions of the analysis: 2 in the plane, 3 in space.
    #[serde(default = "plane")]
    pub dimensions: usize,
    /// Whether it is a body of revolution.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub axisymmetric: bool,
    /// Particles, the most that are there at once.
    pub particles: usize,
    /// Cells of the grid.
    pub cells: usize,
    /// Most unknowns of a step.
    pub unknowns: usize,
    /// Total mass times gravity at the start \[N/m; N of whole bodies\].
    pub weight: f64,
    /// Total volume at the start \[m³/m; m³ of whole bodies\].
    pub volume: f64,
}

impl ModelSize {
    /// Whether forces and volumes are those of the whole body, and not per metre run.
    pub fn is_whole(&self) -> bool {
        self.dimensions == 3 || self.axisymmetric
    }
}

/// Summaries that do not say it are of plane strain.
pub(crate) fn plane() -> usize {
    2
}
