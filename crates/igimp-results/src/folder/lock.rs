//! One program at a time writes into a folder.
//!
//! The system keeps the lock for the process and lets go of it when the process ends, however it ends:
//! the file that stays behind means nothing. Where a file system knows no locks there is none.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::Path;

use crate::atomic::at;
use crate::error::ResultsError;

/// The file that is locked.
pub(crate) const NAME: &str = ".igimp.lock";

/// Keeps other programs out of a folder until it is dropped.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Keeps everybody else out of a folder, which is made.
    ///
    /// # Errors
    /// [`ResultsError::InUse`] when another run holds it; [`ResultsError::Link`], [`ResultsError::File`].
    pub fn alone(folder: &Path) -> Result<Self, ResultsError> {
        Self::take(folder, File::try_lock)
    }

    /// Shares a folder, which is made, with others that share it, and keeps out [`Lock::alone`].
    ///
    /// # Errors
    /// As [`Lock::alone`].
    pub fn shared(folder: &Path) -> Result<Self, ResultsError> {
        Self::take(folder, File::try_lock_shared)
    }

    fn take(
        folder: &Path,
        lock: fn(&File) -> Result<(), TryLockError>,
    ) -> Result<Self, ResultsError> {
        fs::create_dir_all(folder).map_err(at(folder))?;
        let path = folder.join(NAME);
        let file = match File::create_new(&path) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => open(&path)?,
            file => file.map_err(at(&path))?,
        };
        match lock(&file) {
            Err(TryLockError::WouldBlock) => Err(ResultsError::InUse {
                path: folder.into(),
            }),
            Err(TryLockError::Error(error)) if error.kind() != ErrorKind::Unsupported => {
                Err(at(&path)(error))
            }
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Self { _file: file }),
        }
    }
}

/// Opens the file of an earlier run; it is never written.
fn open(path: &Path) -> Result<File, ResultsError> {
    let about = fs::symlink_metadata(path).map_err(at(path))?;
    if about.is_symlink() {
        return Err(ResultsError::Link { path: path.into() });
    }
    if !about.is_file() {
        let source = io::Error::other("it is not a file");
        return Err(at(path)(source));
    }
    OpenOptions::new()
        .read(true)
        .write(true)
        .open(path)
        .map_err(at(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn one_alone_or_several_that_share() {
        let scratch = Scratch::new();
        let folder = scratch.path().join("results");
        let alone = Lock::alone(&folder).unwrap();
        let error = Lock::alone(&folder).unwrap_err();
        insta::assert_snapshot!(
            scratch.hide(&error),
            @"another igimp writes into DIR/results; wait until it has ended, or choose another folder for the results"
        );
        assert!(Lock::shared(&folder).is_err());
        drop(alone);
        let one = Lock::shared(&folder).unwrap();
        let two = Lock::shared(&folder).unwrap();
        assert!(Lock::alone(&folder).is_err());
        drop((one, two));
        Lock::alone(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_not_followed() {
        let scratch = Scratch::new();
        let outside = scratch.path().join("outside");
        std::os::unix::fs::symlink(&outside, scratch.path().join(NAME)).unwrap();
        let error = Lock::alone(scratch.path()).unwrap_err();
        insta::assert_snapshot!(
            scratch.hide(&error),
            @"DIR/.igimp.lock is a link that leads elsewhere; remove it, or choose another folder for the results"
        );
        assert!(!outside.exists());
    }
}
