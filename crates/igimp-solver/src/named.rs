//! Names for what a linear solver knows by its index only: the particle, the node.

use igimp_assembly::System;
use igimp_material::TangentKind;
use igimp_shape::Grid;

use crate::linear::LinearSolverError;
use crate::newton::{StepFailure, padded};

/// The failure of a linear solver with a name for what is not finite: the particle whose tangent it
/// is, or the node. `made_at` are the step displacements that the matrix was made with, none for the
/// elastic one of the step's start.
pub(crate) fn named<const D: usize>(
    error: LinearSolverError,
    system: &System<'_, D>,
    grid: &Grid<D>,
    made_at: Option<&[[f64; D]]>,
) -> StepFailure {
    match error {
        LinearSolverError::NonFinite { what: "matrix", .. } => {
            let tangents = match made_at {
                Some(u) => system.finite_tangents(u, TangentKind::Consistent),
                None => {
                    let still = vec![[0.0; D]; grid.node_count()];
                    system.finite_tangents(&still, TangentKind::Elastic)
                }
            };
            tangents.map_or_else(StepFailure::from, |()| error.into())
        }
        LinearSolverError::NonFinite { what, index } => {
            let what = if what == "solution" {
                "correction"
            } else {
                what
            };
            not_finite(what, index, system, grid)
        }
        other => other.into(),
    }
}

/// The failure that names the node of an unknown.
pub(crate) fn not_finite<const D: usize>(
    what: &'static str,
    unknown: usize,
    system: &System<'_, D>,
    grid: &Grid<D>,
) -> StepFailure {
    match system.unknowns().place(unknown) {
        Some((node, axis)) => StepFailure::NotFinite {
            what,
            position: padded(&grid.node_position(node)),
            axis,
        },
        None => {
            let index = unknown;
            LinearSolverError::NonFinite { what, index }.into()
        }
    }
}
