//! Files that are there whole or not at all, also when the program is killed while it writes; and that
//! are new: a link under a name that is written goes, and its target stays as it is.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::error::ResultsError;

/// Writes a file under a temporary name beside its place, hands it to the disk, and renames it.
///
/// Whoever reads `path` finds the old content or the new. The temporary name is `.NAME.tmp`; a
/// stale one is overwritten.
///
/// # Errors
/// [`ResultsError::File`].
pub fn write_atomically(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), ResultsError> {
    let temporary = temporary_name(path);
    write_synced(&temporary, bytes.as_ref()).map_err(at(&temporary))?;
    fs::rename(&temporary, path).map_err(at(path))?;
    if let Some(folder) = path.parent() {
        sync_folder(folder).map_err(at(folder))?;
    }
    Ok(())
}

/// Writes a file under a temporary name beside its place and renames it, as [`write_atomically`] does, and
/// leaves it to the system when the disk has it: after a kill the file is whole, after a loss of
/// power it may not be.
///
/// # Errors
/// [`ResultsError::File`].
pub fn write_whole(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), ResultsError> {
    let temporary = temporary_name(path);
    write_new(&temporary, bytes).map_err(at(&temporary))?;
    fs::rename(&temporary, path).map_err(at(path))
}

/// Waits until the disk has files, all at once: together they take little longer than one.
pub(crate) fn sync_together<E: Send>(
    files: &[(PathBuf, File)],
    at: impl Fn(&Path, io::Error) -> E + Sync,
) -> Result<(), E> {
    files
        .par_iter()
        .try_for_each(|(path, file)| file.sync_all().map_err(|error| at(path, error)))
}

/// `.NAME.tmp` beside the file.
pub(crate) fn temporary_name(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".tmp");
    path.with_file_name(name)
}

/// A new, empty file; an earlier one of the name is gone. Of a link, symbolic or hard, the name goes and
/// never its target.
pub(crate) fn create(path: &Path) -> io::Result<File> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => File::create_new(path),
    }
}

/// Writes a new file, as `create` makes it, and leaves it to the system when the disk has it.
///
/// # Errors
/// The error of the system.
pub fn write_new(path: &Path, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    create(path)?.write_all(bytes.as_ref())
}

/// Writes a file and waits until the disk has it.
pub(crate) fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Waits until the disk knows the names in a folder, where the system can be asked to.
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    #[cfg(unix)]
    {
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        File::open(folder)?.sync_all()
    }
    #[cfg(not(unix))]
    {
        let _ = folder;
        Ok(())
    }
}

/// Adds a path to an error of the system.
pub fn at(path: &Path) -> impl FnOnce(io::Error) -> ResultsError {
    let path = path.to_path_buf();
    move |source| ResultsError::File { path, source }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn content_is_replaced_and_no_temporary_stays() {
        let scratch = Scratch::new();
        let path = scratch.path().join("summary.json");
        fs::write(temporary_name(&path), "left by a killed run, and longer").unwrap();
        write_atomically(&path, "old").unwrap();
        write_atomically(&path, "new").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 1);
    }

    /// GOAL: a name that is a link never leads a write to another file.
    #[cfg(unix)]
    #[test]
    fn links_are_replaced_and_not_followed() {
        let scratch = Scratch::new();
        let (outside, path) = (scratch.path().join("outside"), scratch.path().join("name"));
        for symbolic in [true, false] {
            for write in [
                |path: &Path| write_new(path, "ours").unwrap(),
                |path: &Path| write_atomically(path, "ours").unwrap(),
            ] {
                fs::write(&outside, "the user's").unwrap();
                for name in [&path, &temporary_name(&path)] {
                    let _ = fs::remove_file(name);
                    if symbolic {
                        std::os::unix::fs::symlink(&outside, name).unwrap();
                    } else {
                        fs::hard_link(&outside, name).unwrap();
                    }
                }
                write(&path);
                assert_eq!(fs::read_to_string(&path).unwrap(), "ours");
                assert_eq!(fs::read_to_string(&outside).unwrap(), "the user's");
            }
        }
    }

    #[test]
    fn a_missing_folder_is_named() {
        let scratch = Scratch::new();
        let error = write_atomically(&scratch.path().join("no/such.txt"), "").unwrap_err();
        insta::assert_snapshot!(scratch.hide(&error), @"cannot access DIR/no/.such.txt.tmp");
    }
}
