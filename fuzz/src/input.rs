//! What a target is fed: the bytes of a text, or those of several files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The bytes of an input by the places of its files; a single text has the place `""`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Input {
    /// Bytes by place.
    pub parts: BTreeMap<String, Vec<u8>>,
}

impl Input {
    /// A single text.
    pub fn text(bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            parts: BTreeMap::from([(String::new(), bytes.into())]),
        }
    }

    /// The bytes of a single text; nothing if it has none.
    pub fn bytes(&self) -> &[u8] {
        self.parts.get("").map_or(&[], Vec::as_slice)
    }

    /// Bytes of all parts.
    pub fn size(&self) -> usize {
        self.parts.values().map(Vec::len).sum()
    }

    /// Reads a file as a text, a folder as its files.
    ///
    /// # Errors
    /// What the system says.
    pub fn read(path: &Path) -> io::Result<Self> {
        if path.is_file() {
            return Ok(Self::text(fs::read(path)?));
        }
        let mut input = Self::default();
        for file in files_below(path)? {
            let place = file.strip_prefix(path).unwrap_or(&file);
            let place = place.to_string_lossy().replace('\\', "/");
            input.parts.insert(place, fs::read(&file)?);
        }
        Ok(input)
    }

    /// Writes a text as a file, several parts as a folder.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        for (place, bytes) in &self.parts {
            let path = if place.is_empty() {
                path.to_owned()
            } else {
                path.join(place)
            };
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::write(path, bytes)?;
        }
        Ok(())
    }
}

/// Every entry of a folder of inputs, sorted by name; hidden ones are left out.
///
/// # Errors
/// What the system says.
pub fn entries(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if !entry.file_name().to_string_lossy().starts_with('.') {
            paths.push(entry.path());
        }
    }
    paths.sort();
    Ok(paths)
}

fn files_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for path in entries(folder)? {
        if path.is_dir() {
            files.extend(files_below(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}
