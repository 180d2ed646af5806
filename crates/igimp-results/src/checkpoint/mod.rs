//! The state of a run on disk, so that a killed run goes on where it was.
//!
//! A checkpoint is a folder: `meta.json`, and for each named state (a [`Body`]) a folder of `.npy`
//! arrays. `meta.json` holds the format version, the program, the fingerprint of the case, a value
//! of the caller, for each array its length in bytes and its SHA-256, and its own SHA-256
//! ([`seal`]); a change of an array in numpy writes all three anew.
//!
//! | array | shape | |
//! |---|---|---|
//! | `x`, `displacement` | n × 2 | position, displacement \[m\] |
//! | `def_grad` | n × 2 × 2 | deformation gradient F \[-\] |
//! | `b_e` | n × 3 × 3 | elastic left Cauchy–Green tensor \[-\] |
//! | `sigma` | n × 3 × 3 | Cauchy stress of the law, tension positive: effective where there is water \[Pa\] |
//! | `half_length`, `half_length0` | n × 2 | half-lengths of the domain, now and as seeded \[m\] |
//! | `centroid` | n × 2 | centroid of its soil within the domain as seeded, from the middle, over half-lengths \[-\] |
//! | `volume0`, `mass` | n | volume as seeded \[m³/m\], mass \[kg/m\] |
//! | `pore_pressure`, `excess` | n | given and excess pore pressure, compression positive \[Pa\] |
//! | `number` | n | number that the particle keeps |
//! | `ratios` | n × 3 | strength, friction and stiffness over those of the law |
//! | `law`, `regime` | n | index of the law; code of the regime ([`Regime::code`](igimp_material::Regime::code)) |
//! | `eps_p_eq` | n | accumulated plastic strain \[-\] |
//! | `internal` | n × 4 | internal variables of the law; only where a law has any |
//! | `load_point_x`, `load_point_force` | m × 2 | loaded points \[m\], forces at factor 1 \[N/m\] |
//! | `load_point_load` | m | index of the load |
//!
//! A checkpoint is written under a temporary name, handed to the disk ([`write()`]) or left to the
//! system to be ([`write_quickly`]), and renamed. One that it
//! replaces is called `NAME.previous` in between. Whenever the program is killed, [`newest`] finds
//! a whole checkpoint, the new one or the one before.

use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use igimp_solver::Body;
use rayon::prelude::*;

use crate::atomic::{create, sync_folder, sync_together};
use crate::error::ResultsError;

mod arrays;
pub mod difference;
mod in_memory;
mod manifest;

pub use crate::error::checkpoint::CheckpointError;
pub use crate::error::checkpoint::FORMAT_VERSION;
pub use crate::error::checkpoint::PROGRAM;
use crate::error::checkpoint::at;
pub use in_memory::{Files, from_files, to_files};
use manifest::{Manifest, StateEntry};
pub use manifest::{Meta, seal, sha256};

const TEMPORARY: &str = ".tmp-";
const REPLACED: &str = ".previous";

/// A state of a run, read from disk.
#[derive(Clone, Debug)]
pub struct Checkpoint<const D: usize> {
    /// The metadata.
    pub meta: Meta,
    /// Bodies by name, in the order in which they were written.
    pub states: Vec<(String, Body<D>)>,
}

/// Writes a checkpoint into a folder of checkpoints, which is made if need be.
///
/// A checkpoint of the same name is replaced. Names that differ only in the number at their end
/// are a family, such as `load-0010` and `load-0020`; of the family of `name` the last `keep` that
/// were written stay, this one always. Temporaries of a killed run are removed.
///
/// # Errors
/// [`CheckpointError::Name`] for names other than letters, digits, `-` and `_`;
/// [`CheckpointError::File`].
pub fn write<const D: usize>(
    folder: &Path,
    name: &str,
    states: &[(&str, &Body<D>)],
    meta: &Meta,
    keep: usize,
) -> Result<PathBuf, ResultsError> {
    write_to_last(folder, name, states, meta, keep, Lasts::PowerLoss)
}

/// Writes a checkpoint as [`write()`] does, without waiting for the disk: it outlasts a kill of the
/// program, and a loss of power only if the system had time to write. A damaged one is noticed and
/// passed over when a run is taken up again.
///
/// # Errors
/// As [`write()`].
pub fn write_quickly<const D: usize>(
    folder: &Path,
    name: &str,
    states: &[(&str, &Body<D>)],
    meta: &Meta,
    keep: usize,
) -> Result<PathBuf, ResultsError> {
    write_to_last(folder, name, states, meta, keep, Lasts::Kill)
}

/// The failures that a checkpoint survives as soon as it is written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Lasts {
    Kill,
    PowerLoss,
}

fn write_to_last<const D: usize>(
    folder: &Path,
    name: &str,
    states: &[(&str, &Body<D>)],
    meta: &Meta,
    keep: usize,
    lasts: Lasts,
) -> Result<PathBuf, ResultsError> {
    for name in states.iter().map(|state| state.0).chain([name]) {
        check_name(name)?;
    }
    fs::create_dir_all(folder).map_err(at(folder))?;
    remove_temporaries(folder)?;
    let sequence = list(folder)?
        .iter()
        .map(Found::sequence)
        .max()
        .map_or(1, |last| last + 1);
    let temporary = folder.join(format!("{TEMPORARY}{name}"));
    fs::create_dir(&temporary).map_err(at(&temporary))?;
    // Handed to the disk together, so that the system can merge the writes.
    let mut unsynced = Vec::new();
    let entries = states
        .iter()
        .map(|(state, body)| write_state(&temporary, state, body, &mut unsynced))
        .collect::<Result<_, _>>()?;
    unsynced.push(Manifest::new(name, sequence, meta, entries).write(&temporary)?);
    if lasts == Lasts::PowerLoss {
        sync_together(&unsynced, |path, error| at(path)(error))?;
        let folders = states.iter().map(|(state, _)| temporary.join(state));
        let folders: Vec<PathBuf> = folders.chain([temporary.clone()]).collect();
        folders
            .par_iter()
            .try_for_each(|folder| sync_folder(folder).map_err(at(folder)))?;
    }
    let path = folder.join(name);
    put_in_place(&temporary, &path)?;
    if lasts == Lasts::PowerLoss {
        sync_folder(folder).map_err(at(folder))?;
    }
    prune(folder, name, keep)?;
    Ok(path)
}

/// The checkpoint that was written last and is whole; none in a folder without checkpoints.
///
/// # Errors
/// If there are checkpoints and none can be read, the error of the one written last;
/// [`CheckpointError::File`].
pub fn newest(folder: &Path) -> Result<Option<PathBuf>, CheckpointError> {
    let mut found = list(folder)?;
    found.sort_by_key(|found| std::cmp::Reverse(found.sequence()));
    first_whole(found)
}

/// Errors of the checkpoints that were written after the given one, or whose time of writing
/// cannot be read: [`newest`] passes over them.
///
/// # Errors
/// [`CheckpointError`] when the given one cannot be read.
pub fn passed_over(path: &Path) -> Result<Vec<CheckpointError>, CheckpointError> {
    let sequence = Manifest::read(path)?.sequence;
    let folder = path.parent().unwrap_or(Path::new("."));
    let errors = list(folder)?.into_iter().filter_map(|found| {
        let is_later = found.manifest.is_err() || found.sequence() > sequence;
        let manifest = is_later.then_some(found.manifest)?;
        manifest
            .and_then(|manifest| is_whole(&found.path, manifest))
            .err()
    });
    Ok(errors.collect())
}

/// The checkpoint of a name, or the one that was being replaced under that name when the program
/// was killed; none if there is neither.
///
/// # Errors
/// If there is one and it cannot be read, its error; [`CheckpointError::File`].
pub fn named(folder: &Path, name: &str) -> Result<Option<PathBuf>, CheckpointError> {
    check_name(name)?;
    let mut found = list(folder)?;
    found.retain(|found| found.name() == name);
    found.sort_by_key(|found| std::cmp::Reverse(found.sequence()));
    first_whole(found)
}

/// Reads a checkpoint.
///
/// # Errors
/// [`CheckpointError`]: no checkpoint, another format or program, another fingerprint than the one
/// expected, or damaged.
pub fn read<const D: usize>(
    path: &Path,
    expected_fingerprint: Option<&str>,
) -> Result<Checkpoint<D>, CheckpointError> {
    let manifest = accepted(path, Manifest::read(path)?, expected_fingerprint)?;
    load(path, manifest)
}

/// The manifest, if it is of this program and of the expected case.
fn accepted(
    path: &Path,
    manifest: Manifest,
    expected_fingerprint: Option<&str>,
) -> Result<Manifest, CheckpointError> {
    if expected_fingerprint.is_some_and(|expected| expected != manifest.fingerprint) {
        return Err(CheckpointError::OtherCase {
            path: path.into(),
            differs: None,
        });
    }
    if manifest.program != PROGRAM {
        return Err(CheckpointError::OtherProgram {
            path: path.into(),
            found: manifest.program,
        });
    }
    Ok(manifest)
}

/// Removes every checkpoint that was written after the given one: a run that goes on from here
/// must not find them later.
///
/// # Errors
/// [`CheckpointError`] when the given one cannot be read or another cannot be removed.
pub fn discard_after(path: &Path) -> Result<(), CheckpointError> {
    let sequence = Manifest::read(path)?.sequence;
    let folder = path.parent().unwrap_or(Path::new("."));
    for found in list(folder)? {
        if found.sequence() > sequence {
            remove(&found.path)?;
        }
    }
    Ok(())
}

/// Removes every checkpoint and temporary; nothing else.
pub(super) fn remove_all(folder: &Path) -> Result<(), CheckpointError> {
    if folder.is_dir() {
        remove_temporaries(folder)?;
    }
    for found in list(folder)? {
        remove(&found.path)?;
    }
    Ok(())
}

/// Whether a folder holds a checkpoint of igimp, whole or damaged.
pub(super) fn is_checkpoint(path: &Path) -> bool {
    !matches!(
        Manifest::read(path),
        Err(CheckpointError::NotACheckpoint { .. } | CheckpointError::File { .. })
    )
}

/// Whether a folder of checkpoints holds any.
pub(super) fn any(folder: &Path) -> bool {
    list(folder).is_ok_and(|found| !found.is_empty())
}

/// A folder that holds a checkpoint, whole or not.
struct Found {
    path: PathBuf,
    manifest: Result<Manifest, CheckpointError>,
}

impl Found {
    /// Running number; 0 if it cannot be read.
    fn sequence(&self) -> u64 {
        self.manifest
            .as_ref()
            .map_or(0, |manifest| manifest.sequence)
    }

    fn name(&self) -> &str {
        let name = self.path.file_name().and_then(|name| name.to_str());
        let name = name.unwrap_or_default();
        name.strip_suffix(REPLACED).unwrap_or(name)
    }
}

/// The checkpoints of a folder, also damaged ones, without temporaries.
fn list(folder: &Path) -> Result<Vec<Found>, CheckpointError> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(at(folder))? {
        let entry = entry.map_err(at(folder))?;
        let path = entry.path();
        let is_folder = entry.file_type().map_err(at(&path))?.is_dir();
        if !is_folder || entry.file_name().to_string_lossy().starts_with('.') {
            continue;
        }
        match Manifest::read(&path) {
            Err(CheckpointError::NotACheckpoint { .. }) => {}
            manifest => found.push(Found { path, manifest }),
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(found)
}

/// The first that can be read; or the error of the first.
fn first_whole(found: Vec<Found>) -> Result<Option<PathBuf>, CheckpointError> {
    let mut first_error = None;
    for Found { path, manifest } in found {
        match manifest.and_then(|manifest| is_whole(&path, manifest)) {
            Ok(()) => return Ok(Some(path)),
            Err(error) => first_error = first_error.or(Some(error)),
        }
    }
    first_error.map_or(Ok(None), Err)
}

/// Whether a checkpoint can be read; or its error.
fn is_whole(path: &Path, manifest: Manifest) -> Result<(), CheckpointError> {
    let in_space = manifest.states.iter().any(|entry| entry.dimensions == 3);
    if in_space {
        load::<3>(path, manifest).map(drop)
    } else {
        load::<2>(path, manifest).map(drop)
    }
}

fn load<const D: usize>(path: &Path, manifest: Manifest) -> Result<Checkpoint<D>, CheckpointError> {
    load_from(path, manifest, |file| {
        fs::read(path.join(file)).map_err(|error| error.to_string())
    })
}

/// The states of a manifest, from the bytes of the files that it lists.
fn load_from<const D: usize>(
    path: &Path,
    manifest: Manifest,
    bytes: impl Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<Checkpoint<D>, CheckpointError> {
    let states = manifest
        .states
        .iter()
        .map(|entry| Ok((entry.name.clone(), read_state(path, entry, &bytes)?)))
        .collect::<Result<_, CheckpointError>>()?;
    let meta = manifest.into_meta();
    Ok(Checkpoint { meta, states })
}

fn write_state<const D: usize>(
    checkpoint: &Path,
    name: &str,
    body: &Body<D>,
    unsynced: &mut Vec<(PathBuf, File)>,
) -> Result<StateEntry, CheckpointError> {
    let folder = checkpoint.join(name);
    fs::create_dir(&folder).map_err(at(&folder))?;
    let mut entry = StateEntry::new(name, body);
    for (array, values) in arrays::of_body(body) {
        let path = checkpoint.join(array_file(name, array));
        let bytes = values.to_bytes();
        let mut file = create(&path).map_err(at(&path))?;
        file.write_all(&bytes).map_err(at(&path))?;
        entry.note(array, &bytes);
        unsynced.push((path, file));
    }
    Ok(entry)
}

fn read_state<const D: usize>(
    checkpoint: &Path,
    entry: &StateEntry,
    bytes: &impl Fn(&str) -> Result<Vec<u8>, String>,
) -> Result<Body<D>, CheckpointError> {
    let name = &entry.name;
    let damaged = |(array, why): (&str, String)| CheckpointError::Damaged {
        path: checkpoint.into(),
        file: array_file(name, array),
        why,
    };
    if check_name(name).is_err() {
        return Err(damaged(("*", "the state has no proper name".into())));
    }
    if entry.dimensions != D {
        let why = format!("its body is one in {} dimensions", entry.dimensions);
        return Err(damaged(("x", why)));
    }
    arrays::to_body([entry.particles, entry.load_points], |array| {
        if !entry.has(array) {
            return Ok(None);
        }
        let bytes = bytes(&array_file(name, array))?;
        entry.compare(array, &bytes)?;
        Ok(Some(bytes))
    })
    .map_err(damaged)
}

/// Where an array of a state is within its checkpoint.
fn array_file(state: &str, array: &str) -> String {
    format!("{state}/{array}.npy")
}

/// Gives a finished checkpoint its name; at any moment it or the one before is there.
fn put_in_place(temporary: &Path, path: &Path) -> Result<(), CheckpointError> {
    let mut previous = path.as_os_str().to_owned();
    previous.push(REPLACED);
    let previous = PathBuf::from(previous);
    if path.exists() {
        if previous.exists() {
            remove(&previous)?;
        }
        fs::rename(path, &previous).map_err(at(path))?;
    }
    fs::rename(temporary, path).map_err(at(path))?;
    if previous.exists() {
        if let Some(folder) = path.parent() {
            sync_folder(folder).map_err(at(folder))?;
        }
        remove(&previous)?;
    }
    Ok(())
}

/// Removes the oldest of a family beyond `keep`.
fn prune(folder: &Path, name: &str, keep: usize) -> Result<(), CheckpointError> {
    let mut relatives = list(folder)?;
    relatives.retain(|found| family(found.name()) == family(name) && found.name() != name);
    relatives.sort_by_key(|found| std::cmp::Reverse(found.sequence()));
    for found in relatives.iter().skip(keep.saturating_sub(1)) {
        remove(&found.path)?;
    }
    Ok(())
}

/// The part of a name before its final number; a name without a number stands alone.
fn family(name: &str) -> (&str, bool) {
    let stem = name.trim_end_matches(|symbol: char| symbol.is_ascii_digit());
    (stem, stem.len() < name.len())
}

/// Removes a checkpoint so that it is never there in part.
fn remove(path: &Path) -> Result<(), CheckpointError> {
    let mut name = std::ffi::OsString::from(TEMPORARY);
    name.push(path.file_name().unwrap_or_default());
    name.push("-removed");
    let temporary = path.with_file_name(name);
    fs::rename(path, &temporary).map_err(at(path))?;
    fs::remove_dir_all(&temporary).map_err(at(&temporary))
}

fn remove_temporaries(folder: &Path) -> Result<(), CheckpointError> {
    for entry in fs::read_dir(folder).map_err(at(folder))? {
        let entry = entry.map_err(at(folder))?;
        let path = entry.path();
        let is_folder = entry.file_type().map_err(at(&path))?.is_dir();
        if is_folder && entry.file_name().to_string_lossy().starts_with(TEMPORARY) {
            fs::remove_dir_all(&path).map_err(at(&path))?;
        }
    }
    Ok(())
}

fn check_name(name: &str) -> Result<(), CheckpointError> {
    let is_plain = |symbol: char| symbol.is_ascii_alphanumeric() || "-_".contains(symbol);
    if name.is_empty() || name.len() > 100 || !name.chars().all(is_plain) {
        return Err(CheckpointError::Name { name: name.into() });
    }
    Ok(())
}

#[cfg(test)]
pub(super) mod tests;
