//! What a case file takes from files beside it, put into its tree: polygons and layer lines from CSV and
//! DXF, properties of materials and pore pressures from CSV, surfaces from STL, ESRI ASCII grids and CSV.
//!
//! From then on the tree carries the points themselves, each with its unit: what is built, explained and fingerprinted
//! does not depend on the files any more.

mod columns;
mod dxf;
mod elevation;
mod history;
mod outline;
mod raster;
mod record;
mod stl;

use std::fmt::Display;
use std::path::{Path, PathBuf};

use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::{Dimension, Quantity};
use igimp_schema::text::clip;
use igimp_schema::tree::{Node, Value};

use super::bytes;

/// Most bytes of a file.
const LARGEST: u64 = 32 << 20;

/// Puts what files hold into the tree of the case file of this name.
pub(super) fn read(tree: &mut Node, case: &Path, problems: &mut Problems) {
    let folder = case.parent().unwrap_or(Path::new(""));
    let materials = tree.get_mut("materials").and_then(Node::entries_mut);
    for material in materials.into_iter().flatten() {
        for property in material.node.entries_mut().into_iter().flatten() {
            raster::resolve(&mut property.node, &property.key, folder, problems);
        }
    }
    if let Some(conditions) = tree.get_mut("water") {
        for condition in conditions.items_mut() {
            pressures(condition, folder, problems);
            history::of_faces(condition, folder, problems);
            let own = condition.get_mut("bodies").map(Node::items_mut);
            for body in own.into_iter().flatten() {
                pressures(body, folder, problems);
            }
        }
    }
    let stages = tree.get_mut("stages").map(Node::items_mut);
    for stage in stages.into_iter().flatten() {
        if let Some(motion) = stage.get_mut("ground_motion") {
            record::resolve(motion, folder, problems);
        }
    }
    let loads = tree.get_mut("loads").map(Node::items_mut);
    for load in loads.into_iter().flatten() {
        shape(load, folder, problems);
    }
    let rigid = tree.get_mut("rigid").map(Node::items_mut);
    for body in rigid.into_iter().flatten() {
        shape(body, folder, problems);
    }
    if let Some(bodies) = tree.get_mut("bodies") {
        for body in bodies.items_mut() {
            shape(body, folder, problems);
            let taken = body.get_mut("minus").map(Node::items_mut);
            for taken in taken.into_iter().flatten() {
                shape(taken, folder, problems);
            }
        }
    }
}

/// What says the shape of a body, or of what a load covers.
fn shape(of: &mut Node, folder: &Path, problems: &mut Problems) {
    for key in ["polygon", "plan"] {
        if let Some(polygon) = of.get_mut(key) {
            outline::resolve(polygon, folder, problems);
        }
    }
    let heights = of.get_mut("between").map(Node::items_mut);
    for height in heights.into_iter().flatten() {
        elevation::resolve(height, folder, problems);
    }
    if let Some(surface) = of.get_mut("surface") {
        stl::resolve(surface, folder, problems);
    }
}

/// The pore pressures, or the table, of a condition of the water, or of a body in it.
fn pressures(of: &mut Node, folder: &Path, problems: &mut Problems) {
    if let Some(points) = of.get_mut("u") {
        raster::resolve(points, "u", folder, problems);
    }
    if let Some(surface) = of.get_mut("surface") {
        elevation::resolve(surface, folder, problems);
    }
}

/// Why a file cannot be used, and what to do about it.
pub(super) struct Trouble {
    message: String,
    help: String,
}

impl Trouble {
    fn new(message: impl Display, help: impl Display) -> Self {
        Self {
            message: message.to_string(),
            help: help.to_string(),
        }
    }
}

/// A file that a case file names.
struct Named {
    path: PathBuf,
}

impl Named {
    /// The file of a value, its path from the folder of the case file.
    fn new(value: &Node, folder: &Path) -> Option<Self> {
        let path = folder.join(value.text()?);
        Some(Self { path })
    }

    /// Whether the name ends so.
    fn ends_in(&self, extension: &str) -> bool {
        let own = self.path.extension();
        own.is_some_and(|own| own.eq_ignore_ascii_case(extension))
    }

    fn report(&self, value: &Node, trouble: Trouble, problems: &mut Problems) {
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
pub(crate) fn text_of(path: &Path, most: u64) -> Result<String, String> {
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
fn unit_of(
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
fn unit_beside(like: &Node) -> Result<String, Trouble> {
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
fn quantity(number: f64, unit: &str, dimension: Dimension, like: &Node) -> Result<Node, Trouble> {
    let text = format!("{number} {unit}");
    match Quantity::parse_as(&text, dimension) {
        Ok(value) => Ok(Node::written(Value::Quantity(value, text), like.place)),
        Err(error) => Err(Trouble::new(&error, error.help(Some(dimension)))),
    }
}
