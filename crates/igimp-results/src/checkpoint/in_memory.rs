//! A checkpoint as the bytes of its files, without a disk: for programs that keep or send them in
//! their own way, and for tests of the reader.

use std::collections::BTreeMap;
use std::path::Path;

use igimp_solver::Body;

use super::manifest::{FILE, Manifest, StateEntry};
use super::{
    Checkpoint, CheckpointError, Meta, accepted, array_file, arrays, at, check_name, load_from,
};

/// The files of a checkpoint: their places within its folder, such as `meta.json` and
/// `current/x.npy`, and their bytes.
pub type Files = BTreeMap<String, Vec<u8>>;

/// The files that [`write()`](super::write()) makes; `sequence` is the running number that tells
/// later checkpoints of a folder from earlier ones.
///
/// # Errors
/// [`CheckpointError::Name`] for names other than letters, digits, `-` and `_`.
pub fn to_files<const D: usize>(
    name: &str,
    sequence: u64,
    states: &[(&str, &Body<D>)],
    meta: &Meta,
) -> Result<Files, CheckpointError> {
    let mut files = Files::new();
    let mut entries = Vec::new();
    check_name(name)?;
    for (state, body) in states {
        check_name(state)?;
        let mut entry = StateEntry::new(state, body);
        for (array, values) in arrays::of_body(body) {
            let bytes = values.to_bytes();
            entry.note(array, &bytes);
            files.insert(array_file(state, array), bytes);
        }
        entries.push(entry);
    }
    let manifest = Manifest::new(name, sequence, meta, entries);
    let bytes = manifest.to_bytes().map_err(at(Path::new(FILE)))?;
    files.insert(FILE.to_owned(), bytes);
    Ok(files)
}

/// Reads a checkpoint from its files, as [`read`](super::read) does from a folder; messages name
/// the folder `path`.
///
/// # Errors
/// Those of [`read`](super::read), save [`CheckpointError::File`]: a file that is missing is
/// damage.
pub fn from_files<const D: usize>(
    path: &Path,
    files: &Files,
    expected_fingerprint: Option<&str>,
) -> Result<Checkpoint<D>, CheckpointError> {
    let Some(meta) = files.get(FILE) else {
        let (path, why) = (path.into(), "it has no meta.json");
        return Err(CheckpointError::NotACheckpoint { path, why });
    };
    let manifest = Manifest::from_bytes(path, meta)?;
    let manifest = accepted(path, manifest, expected_fingerprint)?;
    load_from(path, manifest, |file| {
        let bytes = files.get(file).cloned();
        bytes.ok_or_else(|| "there is no such file".to_owned())
    })
}
