//! Faults of a case, and of the writing of one.

use std::error::Error;
use std::fmt::Write as _;

use igimp_assembly::{AssemblyError, SurfaceError};
use igimp_estimate::EstimateError;
use igimp_figures::FigureError;
use igimp_geometry::SeedError;
use igimp_input::InputError;
use igimp_linear::LinearSolverError;
use igimp_material::MaterialError;
use igimp_model::PointError;
use igimp_report::ReportError;
use igimp_results::ResultsError;
use igimp_results::checkpoint::CheckpointError;
use igimp_shape::ShapeError;

/// Errors of stating or running a case.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// A body cannot be seeded.
    #[error(transparent)]
    Seed(#[from] SeedError),
    /// Results cannot be written or read.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A report or a picture cannot be made.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// A case file states no case.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The case has more than one rigid footing.
    #[error("the case has more than one rigid footing, but the grid can follow only one")]
    SeveralFootings,
    /// The base of a rigid footing is not a row of nodes.
    #[error("the base of the rigid footing at y = {level} m is not on a line of the grid")]
    FootingOffGrid {
        /// Its level \[length\].
        level: f64,
    },
    /// A rigid body cannot be made.
    #[error("the rigid body `{name}` cannot be made")]
    RigidBody {
        /// Its name.
        name: String,
        /// The fault of its surface.
        #[source]
        source: SurfaceError,
    },
    /// The initial stress of level ground is beyond the strength.
    #[error(
        "the initial stress at {} with K0 = {k0} is beyond the strength of `{material}`",
        place(position)
    )]
    InitialStress {
        /// The material.
        material: String,
        /// The place \[length\].
        position: Vec<f64>,
        /// Its coefficient of earth pressure at rest \[-\].
        k0: f64,
    },
    /// A stage begins at the end of one that has none.
    #[error("stage `{stage}` starts from `{from}`, whose end is not known")]
    NoStart {
        /// The stage.
        stage: String,
        /// The one it starts from.
        from: String,
    },
    /// There is no steady seepage.
    #[error("the seepage of the water `{water}` cannot be computed")]
    Seepage {
        /// The condition of the water.
        water: String,
        /// Why.
        #[source]
        source: igimp_seepage::SeepageError,
    },
    /// Seepage through soil that has no permeability.
    #[error("the water `{water}` flows through `{material}`, which has no permeability")]
    NoPermeability {
        /// The condition of the water.
        water: String,
        /// The material.
        material: String,
    },
    /// The case has no stage.
    #[error("the case has no stage: there is nothing to run")]
    NoStages,
    /// The grid cannot be made.
    #[error("the grid cannot be made")]
    Shape(#[from] ShapeError),
    /// A material cannot be made.
    #[error("the material cannot be made")]
    Material(#[from] MaterialError),
    /// A material cannot be made at a place.
    #[error(transparent)]
    Point(#[from] PointError),
    /// The body cannot be made.
    #[error("the body cannot be made")]
    Assembly(#[from] AssemblyError),
    /// The elimination of the unknowns cannot be planned.
    #[error(transparent)]
    LinearSolver(#[from] LinearSolverError),
    /// The cost of the case is not known, or is more than can be had.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
}

/// Whether files, memory or another program stand in the way, rather than the input.
pub fn is_of_the_system(error: &(dyn Error + 'static)) -> bool {
    let mut link = Some(error);
    while let Some(error) = link {
        let is_file = error.is::<std::io::Error>() || error.is::<csv::Error>();
        let refused = error
            .downcast_ref::<CaseError>()
            .is_some_and(|cause| cause.lacks_memory() || cause.is_in_use());
        if is_file || refused {
            return true;
        }
        link = error.source();
    }
    false
}

impl CaseError {
    /// Whether the run would need more memory than can be had.
    fn lacks_memory(&self) -> bool {
        matches!(self, Self::Estimate(EstimateError::Memory { .. }))
    }

    /// The fault of results, if one stands in the way.
    pub fn of_results(&self) -> Option<&ResultsError> {
        match self {
            Self::Results(error) | Self::Report(ReportError::Results(error)) => Some(error),
            _ => None,
        }
    }

    /// Whether another program writes into the folder for results.
    pub fn is_in_use(&self) -> bool {
        matches!(self.of_results(), Some(ResultsError::InUse { .. }))
    }
}

impl From<FigureError> for CaseError {
    fn from(error: FigureError) -> Self {
        Self::Report(error.into())
    }
}

impl From<CheckpointError> for CaseError {
    fn from(error: CheckpointError) -> Self {
        Self::Results(error.into())
    }
}

/// A point in a message.
fn place(point: &[f64]) -> String {
    let numbers: Vec<String> = point.iter().map(f64::to_string).collect();
    format!("({}) m", numbers.join(", "))
}

/// An error and its causes, a line each.
pub fn chain(error: &dyn Error) -> String {
    let mut text = format!("error: {error}");
    let mut cause = error.source();
    while let Some(next) = cause {
        let _ = write!(text, "\n  because: {next}");
        cause = next.source();
    }
    text
}

/// An error and its causes on one line.
pub fn on_one_line(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(next) = cause {
        text = format!("{text}: {next}");
        cause = next.source();
    }
    text
}
