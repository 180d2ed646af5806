//! The results folder: its layout, and clearing the files of an earlier run without touching
//! others.
//!
//! | | |
//! |---|---|
//! | `summary.json`, `report.html` | outcome, for programs and for people |
//! | `case.toml`, `case.completed.toml` | the case as given, and with every default |
//! | `energy.csv` | where the work of stages that take time went |
//! | `convergence.csv` | residuals of all steps, accepted or cut |
//! | `curves/`, `monitors/`, `reinforcement/`, `rigid/`, `sections/`, `slip_lines/` | tables (`.csv`) |
//! | `figures/` | pictures (`.svg`, `.png`), films (`.gif`) |
//! | `paraview/` | particles and grid (`.pvd`, `.vtu`) |
//! | `checkpoint/`, `last-converged/` | states ([`checkpoint`]) |
//! | `mesh-1/`, `mesh-2/`, … | of a study of the mesh error: a folder like this for each mesh |
//! | `mesh_study.csv` | its results on all meshes |
//! | `.igimp` | says that igimp made the folder, and for which case ([`owner`](crate::folder::provenance)) |
//! | `.igimp.lock` | keeps a second run out ([`lock`]) |

pub mod lock;
pub mod overwrite_guard;
pub mod provenance;

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::checkpoint;
use crate::atomic::{at, temporary_name};
use crate::error::ResultsError;
use crate::paraview::pvd;
use crate::summary::Summary;
use overwrite_guard::refuse_links;
use provenance::{Claim, Owner};

pub use crate::atomic::write_atomically;

const MARKER: &str = ".igimp";
const MARKER_TEXT: &str = "igimp writes its results here.\n";

const SUMMARY: &str = "summary.json";
const MESH_STUDY: &str = "mesh_study.csv";
const FILES: [&str; 6] = [
    SUMMARY,
    MESH_STUDY,
    "report.html",
    "case.completed.toml",
    "convergence.csv",
    "energy.csv",
];
/// Most meshes of a study of the mesh error.
const MOST_MESHES: usize = 3;
pub(super) const TABLES: [&str; 6] = [
    "curves",
    "monitors",
    "reinforcement",
    "rigid",
    "sections",
    SLIP_LINES,
];
const SLIP_LINES: &str = "slip_lines";
pub(super) const FIGURES: &str = "figures";
pub(super) const PARAVIEW: &str = "paraview";
pub(super) const CHECKPOINT: &str = "checkpoint";

/// Name of the checkpoint beside the other results that a run without equilibrium leaves.
pub const LAST_CONVERGED: &str = "last-converged";

/// A folder laid out for the results of one run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder {
    root: PathBuf,
}

impl Folder {
    /// Makes the folder, or clears the files of an earlier run of igimp.
    ///
    /// Only files of our names go; `case.toml` stays until it is written anew, for it may be the
    /// user's own.
    ///
    /// # Errors
    /// [`ResultsError::ForeignFolder`] for a folder that is not empty and was not written by igimp;
    /// [`ResultsError::Link`], [`ResultsError::File`], [`ResultsError::Checkpoint`].
    pub fn afresh(root: &Path, claim: &Claim) -> Result<Self, ResultsError> {
        refuse_foreign(root)?;
        refuse_links(root)?;
        if root.exists() {
            clear(root)?;
        }
        mark(root, claim, false)?;
        Self::lay_out(root)
    }

    /// The folder of an earlier run, with all its results.
    ///
    /// # Errors
    /// [`ResultsError::NoResults`] if igimp wrote nothing there; [`ResultsError::Link`],
    /// [`ResultsError::File`].
    pub fn open(root: &Path) -> Result<Self, ResultsError> {
        if !is_ours(root) {
            return Err(ResultsError::NoResults { path: root.into() });
        }
        refuse_links(root)?;
        Self::lay_out(root)
    }

    fn lay_out(root: &Path) -> Result<Self, ResultsError> {
        let folder = Self {
            root: root.to_path_buf(),
        };
        fs::create_dir_all(root).map_err(at(root))?;
        for name in TABLES.into_iter().chain([FIGURES, PARAVIEW, CHECKPOINT]) {
            let path = root.join(name);
            fs::create_dir_all(&path).map_err(at(&path))?;
        }
        Ok(folder)
    }

    /// The folder itself.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// `summary.json`.
    pub fn summary(&self) -> PathBuf {
        self.root.join(SUMMARY)
    }

    /// `report.html`.
    pub fn report(&self) -> PathBuf {
        self.root.join("report.html")
    }

    /// `case.toml`, the case as given.
    pub fn case(&self) -> PathBuf {
        self.root.join("case.toml")
    }

    /// `case.completed.toml`, the case with every default.
    pub fn completed_case(&self) -> PathBuf {
        self.root.join("case.completed.toml")
    }

    /// `energy.csv`.
    pub fn energy(&self) -> PathBuf {
        self.root.join("energy.csv")
    }

    /// `convergence.csv`.
    pub fn convergence(&self) -> PathBuf {
        self.root.join("convergence.csv")
    }

    /// `curves/`.
    pub fn curves(&self) -> PathBuf {
        self.root.join("curves")
    }

    /// `rigid/`.
    pub fn rigid(&self) -> PathBuf {
        self.root.join("rigid")
    }

    /// `reinforcement/`.
    pub fn reinforcement(&self) -> PathBuf {
        self.root.join("reinforcement")
    }

    /// `monitors/`.
    pub fn monitors(&self) -> PathBuf {
        self.root.join("monitors")
    }

    /// `slip_lines/`.
    pub fn slip_lines(&self) -> PathBuf {
        self.root.join(SLIP_LINES)
    }

    /// `sections/`.
    pub fn sections(&self) -> PathBuf {
        self.root.join("sections")
    }

    /// `figures/`.
    pub fn figures(&self) -> PathBuf {
        self.root.join(FIGURES)
    }

    /// `paraview/`.
    pub fn paraview(&self) -> PathBuf {
        self.root.join(PARAVIEW)
    }

    /// `checkpoint/`, the folder of checkpoints.
    pub fn checkpoint(&self) -> PathBuf {
        self.root.join(CHECKPOINT)
    }
}

/// Marks a folder as one of igimp, so that a file may be put there before its run begins; it is made.
///
/// # Errors
/// [`ResultsError::ForeignFolder`] for a folder that is not empty and was not written by igimp;
/// [`ResultsError::File`].
pub fn claim(root: &Path) -> Result<(), ResultsError> {
    refuse_foreign(root)?;
    fs::create_dir_all(root).map_err(at(root))?;
    let marker = root.join(MARKER);
    if marker.is_file() {
        return Ok(());
    }
    write_atomically(&marker, MARKER_TEXT)
}

/// Says whose the results of a folder are, and whether their run came to its end; the folder is made.
///
/// # Errors
/// [`ResultsError::File`].
pub fn mark(root: &Path, claim: &Claim, finished: bool) -> Result<(), ResultsError> {
    fs::create_dir_all(root).map_err(at(root))?;
    Owner::of(claim, root, finished).write(&root.join(MARKER))
}

/// The owner of a results folder, if known.
pub fn owner(root: &Path) -> Option<Owner> {
    Owner::read(&root.join(MARKER))
}

/// A results folder, and those of the meshes in it.
pub(super) fn with_meshes(root: &Path) -> impl Iterator<Item = PathBuf> {
    let meshes = (1..=MOST_MESHES).map(|number| root.join(mesh_name(number)));
    std::iter::once(root.to_owned()).chain(meshes)
}

/// Whether there is a checkpoint to go on from, also one of a mesh.
pub fn holds_checkpoints(root: &Path) -> bool {
    with_meshes(root).any(|folder| checkpoint::any(&folder.join(CHECKPOINT)))
}

/// Whether there are results of a run, or of a mesh.
pub fn holds_results(root: &Path) -> bool {
    holds_checkpoints(root)
        || with_meshes(root).any(|folder| {
            ["convergence.csv", SUMMARY]
                .iter()
                .any(|name| folder.join(name).exists())
        })
}

/// Writes the `summary.json` of a results folder.
///
/// # Errors
/// [`ResultsError::File`].
pub fn write_summary(root: &Path, summary: &Summary) -> Result<(), ResultsError> {
    let path = root.join(SUMMARY);
    let text = serde_json::to_string_pretty(summary).map_err(|source| ResultsError::File {
        path: path.clone(),
        source: source.into(),
    })?;
    write_atomically(&path, text + "\n")
}

/// Name of the folder of a mesh within that of its study, numbered from 1.
pub fn mesh_name(number: usize) -> String {
    format!("mesh-{number}")
}

/// Lays out the folder of a study of the mesh error, whose meshes have folders of their own in it.
///
/// From the beginning, the files of an earlier run are cleared as in [`Folder::afresh`], and so are the
/// folders of meshes.
///
/// # Errors
/// [`ResultsError::ForeignFolder`] for a folder that is not empty and was not written by igimp;
/// [`ResultsError::Link`], [`ResultsError::File`], [`ResultsError::Checkpoint`].
pub fn of_study(root: &Path, claim: &Claim, afresh: bool) -> Result<(), ResultsError> {
    refuse_foreign(root)?;
    refuse_links(root)?;
    fs::create_dir_all(root).map_err(at(root))?;
    if afresh {
        clear(root)?;
        clear_meshes(root)?;
    }
    mark(root, claim, false)
}

/// Clears the folders of meshes that an earlier study left in a results folder: the files of our names,
/// and folders empty then.
///
/// # Errors
/// [`ResultsError::File`], [`ResultsError::Checkpoint`].
pub fn clear_meshes(root: &Path) -> Result<(), ResultsError> {
    for number in 1..=MOST_MESHES {
        let mesh = root.join(mesh_name(number));
        if !mesh.is_dir() || !is_ours(&mesh) {
            continue;
        }
        clear(&mesh)?;
        remove_files(&mesh, |name| {
            [MARKER, lock::NAME, "case.toml"].contains(&name)
        })?;
        for name in TABLES
            .into_iter()
            .chain([FIGURES, PARAVIEW, CHECKPOINT, ""])
        {
            let path = mesh.join(name);
            if path.is_dir() && is_empty(&path)? {
                fs::remove_dir(&path).map_err(at(&path))?;
            }
        }
    }
    Ok(())
}

/// Asks, before anything is written, whether igimp may write into a folder.
///
/// # Errors
/// [`ResultsError::ForeignFolder`] for a folder that is not empty and was not written by igimp;
/// [`ResultsError::File`].
pub fn refuse_foreign(root: &Path) -> Result<(), ResultsError> {
    if root.exists() && !is_empty(root)? && !is_ours(root) {
        return Err(ResultsError::ForeignFolder { path: root.into() });
    }
    Ok(())
}

/// Whether a folder is empty; the lock of a run that has not begun is nothing.
fn is_empty(folder: &Path) -> Result<bool, ResultsError> {
    for entry in fs::read_dir(folder).map_err(at(folder))? {
        if entry.map_err(at(folder))?.file_name() != lock::NAME {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Whether igimp wrote here: by the marker, or its temporary where a run was killed just then; by a
/// summary that names igimp, by a checkpoint.
///
/// A `case.toml` alone is no proof: it may be the input of a run whose output folder this is.
fn is_ours(root: &Path) -> bool {
    let names_igimp = |summary: serde_json::Value| {
        let program = summary["program"].as_str();
        program.is_some_and(|program| program.starts_with("igimp"))
    };
    let summary = fs::read(root.join(SUMMARY)).ok();
    let marker = root.join(MARKER);
    // The temporary first: another igimp may rename it to the marker between the two.
    temporary_name(&marker).is_file()
        || marker.is_file()
        || summary
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .is_some_and(names_igimp)
        || checkpoint::any(&root.join(CHECKPOINT))
}

fn clear(root: &Path) -> Result<(), ResultsError> {
    remove_files(root, |name| FILES.contains(&name))?;
    for folder in TABLES {
        remove_files(&root.join(folder), |name| has_extension(name, &["csv"]))?;
    }
    remove_files(&root.join(FIGURES), |name| {
        has_extension(name, &["svg", "png", "gif"])
    })?;
    remove_files(&root.join(PARAVIEW), pvd::is_our_name)?;
    checkpoint::remove_all(&root.join(CHECKPOINT))?;
    let last = root.join(LAST_CONVERGED);
    if checkpoint::is_checkpoint(&last) {
        fs::remove_dir_all(&last).map_err(at(&last))?;
    }
    Ok(())
}

/// Removes the tables of a folder of tables whose name without extension is one that goes.
///
/// # Errors
/// [`ResultsError::File`].
pub fn clear_tables(folder: &Path, goes: &dyn Fn(&str) -> bool) -> Result<(), ResultsError> {
    remove_files(folder, |name| name.strip_suffix(".csv").is_some_and(goes))
}

/// Removes both files of a picture, by its path in the results folder without extension.
///
/// # Errors
/// [`ResultsError::File`].
pub fn remove_picture(root: &Path, file: &str) -> Result<(), ResultsError> {
    let name = file.strip_prefix("figures/").unwrap_or(file);
    let files = [format!("{name}.svg"), format!("{name}.png")];
    remove_files(&root.join(FIGURES), |name| {
        files.iter().any(|file| file == name)
    })
}

fn has_extension(name: &str, extensions: &[&str]) -> bool {
    let extension = Path::new(name).extension().and_then(|end| end.to_str());
    extension.is_some_and(|extension| extensions.contains(&extension))
}

/// Removes the files of a folder whose name, or whose temporary's name, is ours.
fn remove_files(folder: &Path, is_our_name: impl Fn(&str) -> bool) -> Result<(), ResultsError> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries.map_err(at(folder))?,
    };
    for entry in entries {
        let entry = entry.map_err(at(folder))?;
        let path = entry.path();
        let is_file = entry.file_type().map_err(at(&path))?.is_file();
        let name = entry.file_name();
        let name = name.to_str().unwrap_or_default();
        let of_temporary = name
            .strip_prefix('.')
            .and_then(|name| name.strip_suffix(".tmp"));
        if is_file && is_our_name(of_temporary.unwrap_or(name)) {
            fs::remove_file(&path).map_err(at(&path))?;
        }
    }
    Ok(())
}

#[cfg(test)]
pub(super) mod tests;
