//! What can be wrong with a case, and what can stop it from being written down.

use std::error::Error;
use std::fmt::Write as _;
use std::path::PathBuf;

use igimp_assembly::{AssemblyError, SurfaceError};
use igimp_linear::LinearSolverError;
use igimp_material::MaterialError;
use igimp_shape::ShapeError;

use crate::input::InputError;
use crate::results::checkpoint::CheckpointError;
use crate::results::npy::NpyError;
use igimp_figures::FigureError;

/// Errors of stating or running a case.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// A case file states no case.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A body reaches beyond the grid.
    #[error("the body reaches {}, outside the grid domain", place(corner))]
    OutsideGrid {
        /// The corner \[length\].
        corner: Vec<f64>,
    },
    /// A body has no volume.
    #[error("the body is empty: it has no volume on the grid")]
    EmptyBody,
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
        /// What is wrong with its surface.
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
    /// The case has no stage.
    #[error("the case has no stage: there is nothing to run")]
    NoStages,
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
    /// A file cannot be written or read.
    #[error("cannot access {}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: std::io::Error,
    },
    /// A table cannot be written.
    #[error("cannot write the table {}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// What the writer said.
        #[source]
        source: csv::Error,
    },
    /// A picture cannot be drawn.
    #[error("cannot draw a picture")]
    Figure(#[from] FigureError),
    /// The folder for results holds something else.
    #[error(
        "{} is not empty and was not written by igimp; choose another folder for the results",
        path.display()
    )]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
    },
    /// The run cannot have the memory that it needs.
    #[error(
        "the run is thought to need {needed} of memory, and {limit} can be had, {by}; a larger cell, \
         fewer points per cell or fewer threads need less"
    )]
    Memory {
        /// What it is thought to need, in words.
        needed: String,
        /// What can be had, in words.
        limit: String,
        /// Who sets the limit.
        by: &'static str,
    },
    /// Another program writes into the folder for results.
    #[error(
        "another igimp writes into {}; wait until it has ended, or choose another folder for the results",
        path.display()
    )]
    InUse {
        /// The folder.
        path: PathBuf,
    },
    /// The folder for results holds those of another case.
    #[error(
        "{} holds results of {}: --out chooses another folder, --overwrite replaces them",
        path.display(),
        whose(case, title)
    )]
    OtherResults {
        /// The folder.
        path: PathBuf,
        /// Where that case comes from, as seen from the folder; empty if it is not known.
        case: String,
        /// Its title.
        title: String,
    },
    /// The folder for results holds a run that was stopped and can go on.
    #[error(
        "{} holds a run that was stopped and can go on{} --overwrite begins afresh, --out chooses \
         another folder",
        path.display(),
        if *same_input { ": --resume goes on with it," } else { " with the input that it had:" }
    )]
    Unfinished {
        /// The folder.
        path: PathBuf,
        /// Whether it was made of the same input, so that it can go on as it is.
        same_input: bool,
    },
    /// A file or folder that is written is a link.
    #[error(
        "{} is a link that leads elsewhere; remove it, or choose another folder for the results",
        path.display()
    )]
    Link {
        /// The link.
        path: PathBuf,
    },
    /// A folder that should hold results of an earlier run does not.
    #[error("{} holds no results of igimp", path.display())]
    NoResults {
        /// The folder.
        path: PathBuf,
    },
    /// A file of an earlier run cannot be continued or read.
    #[error("cannot go on with {}: {why}", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// An array file cannot be read.
    #[error("cannot read the array {}", path.display())]
    Npy {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        #[source]
        source: NpyError,
    },
    /// The state of a run cannot be saved or taken up again.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// Whether files, memory or another program stand in the way, rather than the input.
pub fn is_of_the_system(error: &(dyn Error + 'static)) -> bool {
    let mut link = Some(error);
    while let Some(error) = link {
        let is_file = error.is::<std::io::Error>() || error.is::<csv::Error>();
        let refused = error
            .downcast_ref::<CaseError>()
            .is_some_and(|own| matches!(own, CaseError::InUse { .. } | CaseError::Memory { .. }));
        if is_file || refused {
            return true;
        }
        link = error.source();
    }
    false
}

/// A point in a message.
fn place(point: &[f64]) -> String {
    let numbers: Vec<String> = point.iter().map(f64::to_string).collect();
    format!("({}) m", numbers.join(", "))
}

/// Another case in a message.
fn whose(case: &str, title: &str) -> String {
    match (case, title) {
        ("", _) => "an input that is not known".to_owned(),
        (case, "") => format!("another input, {case}"),
        (case, title) => format!("another input, {case} (\"{title}\")"),
    }
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
