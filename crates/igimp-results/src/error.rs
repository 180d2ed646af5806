//! Errors of the results folder and of the files in it.

pub(crate) mod checkpoint;

use std::path::PathBuf;

use thiserror::Error;

use checkpoint::CheckpointError;

/// Errors of writing, reading and replacing results.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// A file cannot be written or read.
    #[error("cannot access {}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        #[source]
        source: std::io::Error,
    },
    /// A table cannot be written.
    #[error("cannot write the table {}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// The error of the writer.
        #[source]
        source: csv::Error,
    },
    /// The folder for results holds something else.
    #[error(
        "{} is not empty and was not written by igimp; choose another folder for the results",
        path.display()
    )]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
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
    /// The folder of a sweep holds tasks of another one, or a run of its own.
    #[error(
        "{} holds results of {}: `folder` in [output] of the sweep file chooses another folder{}",
        path.display(),
        whose(case, title),
        if *are_tasks { ", --overwrite replaces them" } else { "" }
    )]
    OtherStudy {
        /// The folder.
        path: PathBuf,
        /// Where these come from, as seen from the folder; empty if it is not known.
        case: String,
        /// The title of a case.
        title: String,
        /// Whether they are tasks, and not a run.
        are_tasks: bool,
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
        /// The reason.
        why: String,
    },
    /// An array file cannot be read.
    #[error("cannot read the array {}", path.display())]
    Npy {
        /// The file.
        path: PathBuf,
        /// The reason.
        #[source]
        source: NpyError,
    },
    /// The state of a run cannot be saved or taken up again.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// Another case in a message.
fn whose(case: &str, title: &str) -> String {
    match (case, title) {
        ("", _) => "an input that is not known".to_owned(),
        (case, "") => format!("another input, {case}"),
        (case, title) => format!("another input, {case} (\"{title}\")"),
    }
}

/// Why bytes are no array that igimp reads.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum NpyError {
    /// The first bytes are wrong.
    #[error("this is not a .npy file")]
    NotNpy,
    /// Another version of the format.
    #[error("format version {major}.{minor}; only 1.0 is read")]
    Version {
        /// Major number.
        major: u8,
        /// Minor number.
        minor: u8,
    },
    /// The file ends within its header.
    #[error("the file ends within its header")]
    CutHeader,
    /// The header is not the literal it should be.
    #[error("the header is not understood: {why}")]
    Header {
        /// The reason.
        why: &'static str,
    },
    /// Numbers of a kind that is not read.
    #[error("numbers of type `{descr}`; only `<f8`, `<u8`, `<i4` and `|u1` are read")]
    Type {
        /// The type as the header names it.
        descr: String,
    },
    /// Columns first.
    #[error("the array is in Fortran order; save numpy.ascontiguousarray(a) instead")]
    FortranOrder,
    /// The shape does not fit the length of the file.
    #[error("the shape {shape:?} does not fit the {bytes} bytes of numbers")]
    Length {
        /// The shape.
        shape: Vec<usize>,
        /// Bytes after the header.
        bytes: usize,
    },
}
