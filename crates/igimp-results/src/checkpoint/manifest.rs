//! `meta.json`: kind, owner and arrays of a checkpoint.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use igimp_solver::Body;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest as _, Sha256};

use crate::atomic::create;
use crate::error::checkpoint::{CheckpointError, FORMAT_VERSION, PROGRAM, at};

const FORMAT: &str = "igimp checkpoint";
pub(super) const FILE: &str = "meta.json";

/// The program's metadata of a checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct Meta {
    /// The program that writes it.
    pub program: String,
    /// SHA-256 of all input, in hexadecimal ([`sha256`]): a state is taken up for the same input
    /// only.
    pub fingerprint: String,
    /// Where the run stands, in the form of the run. Numbers come back to the bit, save NaN.
    pub data: Value,
}

impl Meta {
    /// Of this program.
    pub fn new(fingerprint: impl Into<String>, data: Value) -> Self {
        Self {
            program: PROGRAM.into(),
            fingerprint: fingerprint.into(),
            data,
        }
    }
}

/// SHA-256 in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .fold(String::with_capacity(64), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        })
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Manifest {
    format: String,
    format_version: u64,
    pub(super) program: String,
    pub(super) fingerprint: String,
    name: String,
    /// Later checkpoints of a folder have larger numbers.
    pub(super) sequence: u64,
    data: Value,
    pub(super) states: Vec<StateEntry>,
    /// SHA-256 of the file without these digits; the last entry.
    sha256: String,
}

/// The text of a manifest whose last `"sha256": ""` is filled with the SHA-256 of the text as it was
/// given.
///
/// This is how a manifest vouches for itself: its digits taken out, it has the sum that they state.
/// Whoever changes a manifest empties the entry and seals it again.
pub fn seal(manifest: &str) -> String {
    let empty = ["\"sha256\": \"\"", "\"sha256\":\"\""];
    let ends = empty.map(|empty| manifest.rfind(empty).map(|at| at + empty.len() - 1));
    match ends.into_iter().flatten().max() {
        None => manifest.to_owned(),
        Some(at) => {
            let sum = sha256(manifest.as_bytes());
            [&manifest[..at], &sum, &manifest[at..]].concat()
        }
    }
}

/// Whether a manifest is as it was sealed, its sum being these digits.
fn is_sealed(manifest: &str, sum: &str) -> bool {
    manifest
        .rsplit_once(sum)
        .is_some_and(|(before, after)| sha256([before, after].concat().as_bytes()) == sum)
}

/// One state of a checkpoint.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct StateEntry {
    pub name: String,
    #[serde(default = "plane", skip_serializing_if = "is_plane")]
    pub(super) dimensions: usize,
    pub(super) particles: usize,
    pub(super) load_points: usize,
    files: BTreeMap<String, FileEntry>,
}

/// Dimensions of a body of which nothing is said.
fn plane() -> usize {
    2
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "the signature that serde asks for"
)]
fn is_plane(dimensions: &usize) -> bool {
    *dimensions == plane()
}

#[derive(Debug, Serialize, Deserialize)]
struct FileEntry {
    bytes: u64,
    sha256: String,
}

impl Manifest {
    pub(super) fn new(name: &str, sequence: u64, meta: &Meta, states: Vec<StateEntry>) -> Self {
        let Meta {
            program,
            fingerprint,
            data,
        } = meta.clone();
        Self {
            format: FORMAT.into(),
            format_version: FORMAT_VERSION,
            program,
            fingerprint,
            name: name.into(),
            sequence,
            data,
            states,
            sha256: String::new(),
        }
    }

    pub(super) fn into_meta(self) -> Meta {
        Meta {
            program: self.program,
            fingerprint: self.fingerprint,
            data: self.data,
        }
    }

    /// Writes the file, and leaves it to the caller to hand it to the disk.
    pub(super) fn write(&self, checkpoint: &Path) -> Result<(PathBuf, File), CheckpointError> {
        let path = checkpoint.join(FILE);
        let write = || {
            let mut file = create(&path)?;
            file.write_all(&self.to_bytes()?)?;
            Ok(file)
        };
        let file = write().map_err(at(&path))?;
        Ok((path, file))
    }

    /// The bytes of the file.
    pub(super) fn to_bytes(&self) -> io::Result<Vec<u8>> {
        let mut text = serde_json::to_string_pretty(self).map_err(io::Error::from)?;
        text.push('\n');
        Ok(seal(&text).into_bytes())
    }

    pub(super) fn read(checkpoint: &Path) -> Result<Self, CheckpointError> {
        let path = checkpoint.join(FILE);
        match fs::read(&path) {
            Ok(bytes) => Self::from_bytes(checkpoint, &bytes),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                Err(CheckpointError::NotACheckpoint {
                    path: checkpoint.into(),
                    why: "it has no meta.json",
                })
            }
            Err(error) => Err(at(&path)(error)),
        }
    }

    /// The content of the file's bytes; messages name the folder.
    pub(super) fn from_bytes(checkpoint: &Path, bytes: &[u8]) -> Result<Self, CheckpointError> {
        let damaged = |error: serde_json::Error| CheckpointError::Damaged {
            path: checkpoint.into(),
            file: FILE.into(),
            why: error.to_string(),
        };
        let value: Value = serde_json::from_slice(bytes).map_err(damaged)?;
        if value["format"] != FORMAT {
            return Err(CheckpointError::NotACheckpoint {
                path: checkpoint.into(),
                why: "its meta.json says nothing of igimp",
            });
        }
        match value["format_version"].as_u64() {
            None | Some(FORMAT_VERSION) => {}
            Some(found) => {
                let path = checkpoint.into();
                return Err(CheckpointError::OtherFormat { path, found });
            }
        }
        let manifest: Self = serde_json::from_value(value).map_err(damaged)?;
        let text = String::from_utf8_lossy(bytes);
        if !is_sealed(&text, &manifest.sha256) {
            return Err(CheckpointError::Damaged {
                path: checkpoint.into(),
                file: FILE.into(),
                why: "it does not say what was written (SHA-256)".into(),
            });
        }
        Ok(manifest)
    }
}

impl StateEntry {
    pub(super) fn new<const D: usize>(name: &str, body: &Body<D>) -> Self {
        Self {
            name: name.into(),
            dimensions: D,
            particles: body.particles.len(),
            load_points: body.load_points.len(),
            files: BTreeMap::new(),
        }
    }

    /// Remembers the size and the sum of an array.
    pub(super) fn note(&mut self, array: &str, bytes: &[u8]) {
        let entry = FileEntry {
            bytes: bytes.len() as u64,
            sha256: sha256(bytes),
        };
        self.files.insert(array.into(), entry);
    }

    /// Whether an array was written.
    pub(super) fn has(&self, array: &str) -> bool {
        self.files.contains_key(array)
    }

    /// Says why bytes are not those that were written.
    pub(super) fn compare(&self, array: &str, bytes: &[u8]) -> Result<(), String> {
        let Some(entry) = self.files.get(array) else {
            return Err("meta.json does not list it".into());
        };
        if bytes.len() as u64 != entry.bytes {
            return Err(format!(
                "it has {} bytes instead of {}",
                bytes.len(),
                entry.bytes
            ));
        }
        if sha256(bytes) != entry.sha256 {
            return Err("its bytes are not those that were written (SHA-256)".into());
        }
        Ok(())
    }
}
