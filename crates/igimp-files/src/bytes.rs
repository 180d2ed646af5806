//! The bytes of files that users name: bounded, and never waited for.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The bytes of a file, and one more than `most` of them at most, whatever it grows to.
///
/// # Errors
/// The error of the system; anything but a file is refused before it is opened, for a pipe would be waited
/// for and a device might never end.
pub fn of_file(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let about = std::fs::metadata(path)?;
    if about.is_dir() {
        return Err(io::Error::other("it is a folder"));
    }
    if !about.is_file() {
        return Err(io::Error::other(
            "it is no file; a case comes from a pipe with - in place of its name",
        ));
    }
    of(File::open(path)?, most)
}

/// The bytes of a reader, one more than `most` at most.
///
/// # Errors
/// Errors of the reader.
pub fn of(reader: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader
        .take(most.saturating_add(1))
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}
