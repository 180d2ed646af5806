//! Why a checkpoint cannot be written or taken up again.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Errors of saving and loading the state of a run.
#[derive(Debug, Error)]
pub enum CheckpointError {
    /// The folder is something else.
    #[error("{} is not a checkpoint of igimp: {why}", path.display())]
    NotACheckpoint {
        /// The folder.
        path: PathBuf,
        /// The missing part.
        why: &'static str,
    },
    /// The checkpoint is laid out in another way.
    #[error(
        "the checkpoint in {} has format version {found}; this program reads version {}",
        path.display(), FORMAT_VERSION
    )]
    OtherFormat {
        /// The folder.
        path: PathBuf,
        /// Its format version.
        found: u64,
    },
    /// The checkpoint has another fingerprint.
    #[error(
        "the checkpoint in {} belongs to another case or to other input{}; run without --resume \
         and --from-stage to begin afresh",
        path.display(), in_parentheses(differs.as_deref())
    )]
    OtherCase {
        /// The folder.
        path: PathBuf,
        /// A key that differs, with both values, where it is known.
        differs: Option<String>,
    },
    /// The checkpoint comes from another version of the program.
    #[error(
        "the checkpoint in {} was written by {found}, and this is {}; resume with that version, \
         or run without --resume to begin afresh",
        path.display(), PROGRAM
    )]
    OtherProgram {
        /// The folder.
        path: PathBuf,
        /// The program that wrote it.
        found: String,
    },
    /// The checkpoint differs from the one written.
    #[error("the checkpoint in {} is damaged: {file}: {why}", path.display())]
    Damaged {
        /// The folder.
        path: PathBuf,
        /// The file within it.
        file: String,
        /// The reason.
        why: String,
    },
    /// A name that cannot be a folder everywhere.
    #[error(
        "`{name}` cannot name a checkpoint or a state: only letters a to z, digits, `-` and `_`"
    )]
    Name {
        /// The name.
        name: String,
    },
    /// A file cannot be written or read.
    #[error("cannot access {}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        #[source]
        source: io::Error,
    },
}

/// Adds a path to an error of the system.
pub(crate) fn at(path: &Path) -> impl FnOnce(io::Error) -> CheckpointError {
    let path = path.to_path_buf();
    move |source| CheckpointError::File { path, source }
}

/// Version of the layout; another one is not read.
pub const FORMAT_VERSION: u64 = 5;

/// The program and its version, as written into checkpoints.
pub const PROGRAM: &str = concat!("igimp ", env!("CARGO_PKG_VERSION"));

fn in_parentheses(text: Option<&str>) -> String {
    text.map_or_else(String::new, |text| format!(" ({text})"))
}
