//! One cycle of multigrid, with the skin solved for before and after.

use std::sync::Arc;

use super::boundary_nodes::BoundaryNodes;
use super::hierarchy::{self, Preconditioner};
use crate::{LinearSolverError, Pattern, TangentMatrix};

/// Grids and skin of a matrix.
pub(super) struct Cycle {
    grids: Box<dyn Preconditioner>,
    skin: BoundaryNodes,
    /// The residual after the skin was solved for.
    rest: Vec<f64>,
}

impl Cycle {
    /// Makes the grids of a pattern.
    pub(super) fn new(pattern: &Arc<Pattern>) -> Result<Self, LinearSolverError> {
        Ok(Self {
            grids: hierarchy::new(pattern)?,
            skin: BoundaryNodes::default(),
            rest: Vec::new(),
        })
    }

    /// Takes over the values of a matrix with that pattern.
    pub(super) fn set(&mut self, matrix: &TangentMatrix, diagonal: &[f64]) {
        self.grids.set(matrix, diagonal);
        self.skin.set(matrix, diagonal);
    }

    /// z ← about K⁻¹ r.
    pub(super) fn apply(&mut self, matrix: &TangentMatrix, r: &[f64], z: &mut [f64]) {
        let Self { grids, skin, rest } = self;
        if !skin.is_there() {
            grids.apply(r, z);
            return;
        }
        rest.clear();
        rest.extend_from_slice(r);
        skin.before(matrix, rest);
        grids.apply(rest, z);
        skin.add(matrix, z);
        if matrix.symmetric {
            skin.after(matrix, r, z);
        }
    }

    /// Whether the skin tells that a symmetric matrix is not positive definite.
    pub(super) fn is_indefinite(&self) -> bool {
        self.skin.is_indefinite
    }

    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.grids.unknowns()
    }

    /// Number of grids.
    pub(super) fn levels(&self) -> usize {
        self.grids.levels()
    }
}
