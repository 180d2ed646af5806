//! A file that a case file names: its text, the units of its columns, and why it cannot be used.

use std::fmt::Display;
use std::path::{Path, PathBuf};

use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::{Dimension, Quantity};
use igimp_schema::text::clip;
use igimp_schema::tree::{Node, Value};

use crate::bytes;

/// Most bytes of a file.
pub(crate) const LARGEST: u64 = 32 << 20;

/// Why a file cannot be used, and what to do about it.
pub(crate) struct Trouble {
    pub(crate) message: String,
    pub(crate) help: String,
}

impl Trouble {
    pub(crate) fn new(message: impl Display, help: impl Display) -> Self {
        Self {
            message: message.to_string(),
            help: help.to_string(),
        }
    }
}

/// A file that a case file names.
pub(crate) struct Named {
    pub(crate) path: PathBuf,
}

impl Named {
    /// The file of a value, its path from the folder of the case file.
    pub(crate) fn new(value: &Node, folder: &Path) -> Option<Self> {
        let path = folder.join(value.text()?);
        Some(Self { path })
    }

    /// Whether the name ends so.
    pub(crate) fn ends_in(&self, extension: &str) -> bool {
        let ending = self.path.extension();
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case(extension))
    }

    pub(crate) fn report(&self, value: &Node, trouble: Trouble, problems: &mut Problems) {
        let path = clip(&self.path.display().to_string(), 80);
        problems
            .error(
                value.place,
                format!("cannot use {path}: {}", trouble.message),
            )
            .help(trouble.help);
    }
}

/// The text of a file of so many bytes at most; bytes that are no UTF-8 become replacement characters.
///
/// # Errors
/// The error of the system, or a message for a directory, a pipe or too many bytes.
pub fn text_of(path: &Path, most: u64) -> Result<String, String> {
    // Asked before it is opened: a pipe would be waited for.
    let about = std::fs::metadata(path).map_err(|error| error.to_string())?;
    if !about.is_file() {
        return Err("it is not a file".to_owned());
    }
    let bytes = bytes::of_file(path, most).map_err(|error| error.to_string())?;
    if bytes.len() as u64 > most {
        return Err(format!("it has more than {} MB", most >> 20));
    }
    let text = String::from_utf8_lossy(&bytes);
    Ok(text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned())
}

/// The unit of a column: that of a key of the case file, `(key, value)`, or of its header; both have to agree.
pub(crate) fn unit_of(
    (key, stated): (&str, Option<&str>),
    (column, header): (&str, Option<&str>),
    dimension: Dimension,
) -> Result<String, Trouble> {
    let example = dimension.usual_unit();
    let unit = match (stated, header) {
        (Some(stated), Some(header)) if stated.trim() != header.trim() => {
            return Err(Trouble::new(
                format_args!(
                    "its {column} is in `{}` by its header, and in `{}` by the case file",
                    clip(header, 20),
                    clip(stated, 20)
                ),
                "keep one of them",
            ));
        }
        (Some(unit), _) | (None, Some(unit)) => unit.trim(),
        (None, None) => {
            return Err(Trouble::new(
                format_args!("nothing says in which unit its {column} is"),
                format_args!(
                    "write it into the header of the column, as in `{column} [{example}]`, or beside the file, as in {key} = \"{example}\""
                ),
            ));
        }
    };
    match Quantity::parse_as(&format!("1 {unit}"), dimension) {
        Ok(_) => Ok(unit.to_owned()),
        Err(error) => Err(Trouble::new(&error, error.help(Some(dimension)))),
    }
}

/// The unit of length of a file that cannot say it, from beside its name.
pub(crate) fn unit_beside(like: &Node) -> Result<String, Trouble> {
    if like.get("unit").is_none() {
        return Err(Trouble::new(
            "nothing says in which unit it is",
            "write it beside the file, as in unit = \"m\"",
        ));
    }
    let stated = ("unit", like.text_at("unit"));
    unit_of(stated, ("coordinates", None), Dimension::Length)
}

/// A number of a file as a value with its unit.
pub(crate) fn quantity(
    number: f64,
    unit: &str,
    dimension: Dimension,
    like: &Node,
) -> Result<Node, Trouble> {
    let text = format!("{number} {unit}");
    match Quantity::parse_as(&text, dimension) {
        Ok(value) => Ok(Node::written(Value::Quantity(value, text), like.place)),
        Err(error) => Err(Trouble::new(&error, error.help(Some(dimension)))),
    }
}
