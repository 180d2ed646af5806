//! Iteration with a geometric multigrid as preconditioner, for one matrix after the other.

use std::sync::Arc;

use super::super::{LinearSolverError, SolveReport, check};
use super::boundary_nodes::BoundaryNodes;
use super::hierarchy::{self, Preconditioner};
use crate::krylov::preconditioned::{Demand, LinearSystem, Method, Preconditioned};
use crate::{Pattern, TangentMatrix};

/// Names of the methods.
const NAMES: [&str; 2] = ["multigrid-cg", "multigrid-gmres"];

/// Grids and values of the matrix at hand.
#[derive(Default)]
pub(crate) struct Iteration {
    pattern: Option<Arc<Pattern>>,
    grids: Option<Box<dyn Preconditioner>>,
    skin: BoundaryNodes,
    /// The residual after the skin was solved for.
    rest: Vec<f64>,
    preconditioned: Preconditioned,
}

impl Iteration {
    /// Makes the grids of a pattern, unless they are there. Whether there is more than one.
    pub(crate) fn analyse(&mut self, pattern: &Arc<Pattern>) -> Result<bool, LinearSolverError> {
        if !check::same_pattern(self.pattern.as_ref(), pattern) {
            self.grids = None;
            self.grids = Some(hierarchy::new(pattern)?);
            self.pattern = Some(Arc::clone(pattern));
        }
        Ok(self.grids.as_ref().is_some_and(|grids| grids.levels() > 1))
    }

    /// Takes over the values of a matrix whose pattern was analysed.
    pub(crate) fn set(&mut self, matrix: &TangentMatrix, diagonal: &[f64]) {
        if let Some(grids) = &mut self.grids {
            grids.set(matrix, diagonal);
        }
        self.skin.set(matrix, diagonal);
    }

    /// Solves K x = b.
    pub(crate) fn solve(
        &mut self,
        matrix: &TangentMatrix,
        rhs: &[f64],
        solution: &mut [f64],
        demand: &Demand,
    ) -> Result<SolveReport, LinearSolverError> {
        let Self {
            grids: Some(grids),
            skin,
            rest,
            preconditioned,
            ..
        } = self
        else {
            return Err(LinearSolverError::NotFactored);
        };
        check::length("the matrix", matrix.pattern.unknowns(), grids.unknowns())?;
        let method = Method {
            by_gradients: matrix.symmetric && !skin.is_indefinite,
            names: NAMES,
        };
        let mut apply = |r: &[f64], z: &mut [f64]| {
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
        };
        let system = LinearSystem { matrix, rhs };
        preconditioned.solve(system, solution, demand, method, &mut apply)
    }
}
