//! The reader of checkpoints: a manifest and the arrays that it lists.
//!
//! An entry of the corpus is a folder. Files that it leaves out are those of the entry `whole`, so
//! that a damaged array is one small file; a manifest that it leaves out is that of `whole` with
//! lengths and sums of the entry's own arrays. Manifests are sealed when they are read.
//!
//! What must hold, beside that nothing panics and nothing is reserved before it is there:
//!
//! - a checkpoint that is read is written and read again: the same words, the same bits;
//! - its arrays survive, and so do the very bytes if the manifest is as the program writes it;
//! - what is refused is refused with a message.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use igimp_results::checkpoint::{self, Checkpoint, Files, PROGRAM, from_files, sha256, to_files};
use igimp_results::npy::Array;
use serde_json::{Value, json};

use super::{Verdict, holds};
use crate::input::Input;
use crate::mutate::damage;
use crate::random::Random;

const MANIFEST: &str = "meta.json";
const BASE: &str = "whole";
/// Stands in the manifests of the corpus for the program and its version.
const ANY_PROGRAM: &str = "igimp VERSION";

/// Entries with the files that they leave out.
pub(super) fn complete(paths: &[PathBuf], known: Vec<Input>) -> Vec<Input> {
    let is_base = |path: &PathBuf| path.file_name().is_some_and(|name| name == BASE);
    let base = paths.iter().position(is_base).map(|at| known[at].clone());
    let base = base.unwrap_or_default();
    let whole = |run: Input| {
        let mut input = base.clone();
        let is_sealed = !run.parts.contains_key(MANIFEST);
        input.parts.extend(run.parts);
        if let Some(bytes) = input.parts.get_mut(MANIFEST)
            && let Ok(text) = std::str::from_utf8(bytes)
        {
            *bytes = text.replace(ANY_PROGRAM, PROGRAM).into_bytes();
        }
        if is_sealed {
            seal(&mut input.parts);
        } else {
            seal_manifest(&mut input.parts);
        }
        input
    };
    known.into_iter().map(whole).collect()
}

/// A damaged checkpoint: its manifest, or arrays with sums that hide the damage, or without.
pub(super) fn mutated(
    entry: &Input,
    other: &Input,
    words: &[String],
    random: &mut Random,
) -> Input {
    let mut input = entry.clone();
    let (mut arrays, mut is_sealed) = (0, false);
    match random.below(10) {
        0..4 => {}
        4..9 => (arrays, is_sealed) = (random.length(1), true),
        _ => arrays = 1,
    }
    if arrays == 0 {
        let other = other.parts.get(MANIFEST).map_or(&[][..], Vec::as_slice);
        if let Some(manifest) = input.parts.get_mut(MANIFEST) {
            damage(manifest, other, words, random);
        }
        if !random.once_in(4) {
            seal_manifest(&mut input.parts);
        }
    }
    for _ in 0..arrays {
        let names: Vec<String> = input
            .parts
            .keys()
            .filter(|name| *name != MANIFEST)
            .cloned()
            .collect();
        let (Some(name), Some(donor)) = (random.pick(&names), random.pick(&names)) else {
            break;
        };
        let other = other.parts.get(donor).map_or(&[][..], Vec::as_slice);
        match (random.below(8), input.parts.get_mut(name)) {
            (0, Some(array)) => *array = other.to_vec(),
            (1, _) => {
                input.parts.remove(name);
            }
            (2 | 3, Some(array)) => overwrite_number(array, random),
            (_, Some(array)) => damage(array, other, words, random),
            (_, None) => {}
        }
    }
    if is_sealed {
        seal(&mut input.parts);
    }
    input
}

/// Puts a number that a computation would not like into an array.
fn overwrite_number(array: &mut [u8], random: &mut Random) {
    let numbers = [
        f64::NAN,
        f64::INFINITY,
        -0.0,
        f64::MAX,
        f64::MIN_POSITIVE / 8.0,
        -1.0,
    ];
    let last = array.len() / 8;
    let at = 8 * random.below(last.max(1));
    if let (Some(place), Some(number)) = (array.get_mut(at..at + 8), random.pick(&numbers)) {
        place.copy_from_slice(&number.to_le_bytes());
    }
}

/// Lengths and sums in the manifest are made those of the arrays.
fn seal(parts: &mut BTreeMap<String, Vec<u8>>) {
    let Some(Ok(mut manifest)) = parts
        .get(MANIFEST)
        .map(|bytes| serde_json::from_slice::<Value>(bytes))
    else {
        return;
    };
    let states = manifest.get_mut("states").and_then(Value::as_array_mut);
    for state in states.into_iter().flatten() {
        let name = state["name"].as_str().unwrap_or_default().to_owned();
        let Some(files) = state.get_mut("files").and_then(Value::as_object_mut) else {
            continue;
        };
        for (array, entry) in files {
            if let Some(bytes) = parts.get(&format!("{name}/{array}.npy")) {
                *entry = json!({ "bytes": bytes.len(), "sha256": sha256(bytes) });
            }
        }
    }
    if let Some(entries) = manifest.as_object_mut() {
        entries.insert("sha256".to_owned(), "".into());
    }
    parts.insert(MANIFEST.to_owned(), manifest.to_string().into_bytes());
    seal_manifest(parts);
}

/// The manifest's own sum is made that of its text, whatever that says.
fn seal_manifest(parts: &mut BTreeMap<String, Vec<u8>>) {
    let text = parts.get(MANIFEST).map(|bytes| std::str::from_utf8(bytes));
    let Some(Ok(text)) = text else { return };
    let Ok(manifest) = serde_json::from_str::<Value>(text) else {
        return;
    };
    let digits = manifest["sha256"].as_str().unwrap_or_default();
    if let Some((before, after)) = text.rsplit_once(digits) {
        let text = checkpoint::seal(&[before, after].concat());
        parts.insert(MANIFEST.to_owned(), text.into_bytes());
    }
}

/// Reads a checkpoint.
///
/// # Errors
/// What does not hold.
pub fn check(files: &Files) -> Result<Verdict, String> {
    let read = |files: &Files| from_files(Path::new("checkpoint"), files, None);
    let checkpoint = match read(files) {
        Ok(checkpoint) => checkpoint,
        Err(error) => {
            let printed = error.to_string();
            holds(printed.contains("checkpoint"), || {
                format!("a message without a place: {printed}")
            })?;
            return Ok(Verdict::Refused);
        }
    };
    let manifest: Value =
        serde_json::from_slice(&files[MANIFEST]).map_err(|error| error.to_string())?;
    let written = write(&checkpoint, &manifest)?;
    let again = read(&written).map_err(|error| format!("not read again: {error}"))?;
    holds(again.meta == checkpoint.meta, || {
        "other words after writing".to_owned()
    })?;
    holds(write(&again, &manifest)? == written, || {
        "written again, other bytes".to_owned()
    })?;
    for (file, bytes) in written.iter().filter(|(file, _)| *file != MANIFEST) {
        let bits = |bytes: &[u8]| Array::from_bytes(bytes).map(|array| array.to_bytes());
        let before = files.get(file).map(|bytes| bits(bytes));
        holds(before == Some(bits(bytes)), || {
            format!("{file} does not survive")
        })?;
    }
    if written[MANIFEST] == files[MANIFEST] {
        let is_same = written
            .iter()
            .all(|(file, bytes)| files.get(file) == Some(bytes));
        holds(is_same, || "the same manifest for other bytes".to_owned())?;
    }
    Ok(Verdict::Accepted)
}

/// The files of a checkpoint under the name and number of a manifest.
fn write(checkpoint: &Checkpoint<2>, manifest: &Value) -> Result<Files, String> {
    let name = manifest["name"].as_str().unwrap_or_default();
    let sequence = manifest["sequence"].as_u64().unwrap_or_default();
    let states: Vec<_> = checkpoint
        .states
        .iter()
        .map(|(name, body)| (name.as_str(), body))
        .collect();
    to_files(name, sequence, &states, &checkpoint.meta)
        .or_else(|_| to_files("renamed", sequence, &states, &checkpoint.meta))
        .map_err(|error| format!("not written: {error}"))
}
