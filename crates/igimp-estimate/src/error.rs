//! Reasons why a case has no estimate, or needs more than can be had.

use igimp_assembly::AssemblyError;
use igimp_geometry::SeedError;
use igimp_linear::LinearSolverError;
use igimp_material::MaterialError;
use igimp_shape::ShapeError;
use igimp_text::NoAmount;

/// Errors of an estimate.
#[derive(Debug, thiserror::Error)]
pub enum EstimateError {
    /// A body cannot be seeded.
    #[error(transparent)]
    Seed(#[from] SeedError),
    /// The grid cannot be made.
    #[error("the grid cannot be made")]
    Shape(#[from] ShapeError),
    /// A material cannot be made.
    #[error("the material cannot be made")]
    Material(#[from] MaterialError),
    /// The body cannot be made.
    #[error("the body cannot be made")]
    Assembly(#[from] AssemblyError),
    /// The elimination of the unknowns cannot be planned.
    #[error(transparent)]
    LinearSolver(#[from] LinearSolverError),
    /// A variable of the environment is not what it should be.
    #[error("{name} is \"{value}\": {expected}")]
    Variable {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: String,
        /// Its expected form.
        expected: NoAmount,
    },
    /// The run cannot have the memory that it needs.
    #[error(
        "the run is thought to need {needed} of memory, and {limit} can be had, {by}; a larger cell, \
         fewer points per cell or fewer threads need less"
    )]
    Memory {
        /// The estimated need, in words.
        needed: String,
        /// The memory at hand, in words.
        limit: String,
        /// The source of the limit.
        by: &'static str,
    },
}
