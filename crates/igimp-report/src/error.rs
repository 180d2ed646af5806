//! Why a report or a picture cannot be made.

use igimp_figures::FigureError;
use igimp_geometry::SeedError;
use igimp_results::ResultsError;
use igimp_shape::ShapeError;

/// Errors of drawing a run.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A picture cannot be drawn.
    #[error("cannot draw a picture")]
    Figure(#[from] FigureError),
    /// The grid cannot be made.
    #[error("the grid cannot be made")]
    Shape(#[from] ShapeError),
    /// A body cannot be drawn in pieces.
    #[error(transparent)]
    Seed(#[from] SeedError),
    /// A film cannot be made of the frames of a folder.
    #[error("there is no film: {why}")]
    NoFilm {
        /// Why not.
        why: String,
    },
    /// A file cannot be written or read.
    #[error(transparent)]
    Results(#[from] ResultsError),
}
