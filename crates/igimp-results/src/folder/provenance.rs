//! The case whose results a folder holds, and whether its run finished, as stored in `.igimp`.

use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::atomic::{at, write_whole};
use crate::error::ResultsError;

/// Where a case comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A case file.
    File(PathBuf),
    /// A part of a file, such as a task of a sweep.
    Part(PathBuf, String),
    /// A text that is no file, by its name.
    Text(String),
}

impl Origin {
    /// In words that stay the same when folder and file are moved together.
    fn seen_from(&self, folder: &Path) -> String {
        match self {
            Self::File(path) => relative(path, folder),
            Self::Part(path, part) => format!("{}, {part}", relative(path, folder)),
            Self::Text(name) => format!("<{name}>"),
        }
    }
}

/// A path as seen from a folder.
fn relative(path: &Path, folder: &Path) -> String {
    let (Ok(path), Ok(folder)) = (path.canonicalize(), folder.canonicalize()) else {
        return path.display().to_string();
    };
    let (to, from) = (
        path.components().collect::<Vec<_>>(),
        folder.components().collect::<Vec<_>>(),
    );
    let common = std::iter::zip(&to, &from)
        .take_while(|(a, b)| a == b)
        .count();
    let up = from[common..].iter().map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(to[common..].iter().copied()).collect();
    way.display().to_string()
}

/// Identity of a run that writes into a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// Where its case comes from.
    pub origin: Origin,
    /// Title of the case.
    pub title: String,
    /// Fingerprint of the input.
    pub input: String,
}

/// The content of `.igimp`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Owner {
    note: String,
    /// Where the case comes from; a path as seen from the folder.
    pub case: String,
    /// Title of the case.
    pub title: String,
    /// Fingerprint of the input.
    pub input: String,
    /// Whether the run came to its end.
    pub finished: bool,
}

impl Owner {
    /// The owner of a folder that a run writes into, or has finished writing.
    pub fn of(claim: &Claim, folder: &Path, finished: bool) -> Self {
        Self {
            note: "igimp writes its results here".to_owned(),
            case: claim.origin.seen_from(folder),
            title: claim.title.clone(),
            input: claim.input.clone(),
            finished,
        }
    }

    /// The content of a file, if it exists and is readable.
    pub fn read(file: &Path) -> Option<Self> {
        serde_json::from_slice(&std::fs::read(file).ok()?).ok()
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn write(&self, file: &Path) -> Result<(), ResultsError> {
        let text = serde_json::to_string_pretty(self).map_err(|error| at(file)(error.into()))?;
        write_whole(file, text + "\n")
    }

    /// Whether both are runs of one case: of one file, which may have been edited, or of one input.
    pub fn is_same_case(&self, other: &Self) -> bool {
        self.case == other.case || self.input == other.input
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn a_case_is_told_from_its_namesake_and_known_after_a_move() {
        let scratch = Scratch::new();
        let at = |place: &str| scratch.path().join(place);
        for folder in ["a/results/slope", "b/results/slope"] {
            std::fs::create_dir_all(at(folder)).unwrap();
        }
        for case in ["a/slope.toml", "b/slope.toml"] {
            std::fs::write(at(case), "").unwrap();
        }
        let seen = |case: &str, folder: &str| Origin::File(at(case)).seen_from(&at(folder));
        let path = seen("a/slope.toml", "a/results/slope");
        assert_eq!(path, "../../slope.toml");
        assert_eq!(seen("b/slope.toml", "b/results/slope"), path);
        assert_eq!(
            seen("b/slope.toml", "a/results/slope"),
            "../../../b/slope.toml"
        );
        let task = Origin::Part(at("a/slope.toml"), "task 3".into());
        assert_eq!(task.seen_from(&at("a")), "slope.toml, task 3");
        assert_eq!(Origin::Text("slope".into()).seen_from(&at("a")), "<slope>");
    }
}
