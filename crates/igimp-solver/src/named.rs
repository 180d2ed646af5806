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
            let tangents = made_at.map_or_else(
                || {
                    let still = vec![[0.0; D]; grid.node_count()];
                    system.finite_tangents(&still, TangentKind::Elastic)
                },
                |u| system.finite_tangents(u, TangentKind::Consistent),
            );
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

/// Refuses a correction that is not finite, whatever solver handed it out.
pub(crate) fn finite_correction<const D: usize>(
    du: &[f64],
    system: &System<'_, D>,
    grid: &Grid<D>,
) -> Result<(), StepFailure> {
    match du.iter().position(|du| !du.is_finite()) {
        Some(unknown) => Err(not_finite("correction", unknown, system, grid)),
        None => Ok(()),
    }
}

/// The failure that names the node of an unknown.
fn not_finite<const D: usize>(
    what: &'static str,
    unknown: usize,
    system: &System<'_, D>,
    grid: &Grid<D>,
) -> StepFailure {
    system.unknowns().place(unknown).map_or_else(
        || {
            let index = unknown;
            LinearSolverError::NonFinite { what, index }.into()
        },
        |(node, axis)| StepFailure::NotFinite {
            what,
            position: padded(&grid.node_position(node)),
            axis,
        },
    )
}
