//! The results folder: its layout, and clearing what an earlier run left without touching anything
//! else.
//!
//! | | |
//! |---|---|
//! | `summary.json`, `report.html` | outcome, for programs and for people |
//! | `case.toml`, `case.completed.toml` | the case as given, and with every default |
//! | `convergence.csv` | residuals of all steps, accepted or cut |
//! | `curves/`, `monitors/`, `sections/`, `slip_lines/` | tables (`.csv`) |
//! | `figures/` | pictures (`.svg`, `.png`) |
//! | `paraview/` | particles and grid (`.pvd`, `.vtu`) |
//! | `checkpoint/`, `last-converged/` | states ([`checkpoint`]) |
//! | `mesh-1/`, `mesh-2/`, … | of a study of the mesh error: a folder like this for each mesh |
//! | `mesh_study.csv` | its results on all meshes |
//! | `.igimp` | says that igimp made the folder |

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::atomic::{at, temporary_name};
use super::{checkpoint, pvd};
use crate::error::CaseError;
use crate::summary::Summary;

pub use super::atomic::write_atomically;

const MARKER: &str = ".igimp";
const MARKER_TEXT: &str = "igimp writes its results here; a further run replaces them.\n";

const SUMMARY: &str = "summary.json";
const MESH_STUDY: &str = "mesh_study.csv";
const FILES: [&str; 5] = [
    SUMMARY,
    MESH_STUDY,
    "report.html",
    "case.completed.toml",
    "convergence.csv",
];
/// Most meshes of a study of the mesh error.
const MOST_MESHES: usize = 3;
const TABLES: [&str; 4] = ["curves", "monitors", "sections", SLIP_LINES];
const SLIP_LINES: &str = "slip_lines";
const FIGURES: &str = "figures";
const PARAVIEW: &str = "paraview";
const CHECKPOINT: &str = "checkpoint";

/// Name of the checkpoint beside the other results that a run without equilibrium leaves.
pub const LAST_CONVERGED: &str = "last-converged";

/// A folder laid out for the results of one run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder {
    root: PathBuf,
}

impl Folder {
    /// Makes the folder, or clears what an earlier run of igimp left in it.
    ///
    /// Only files of our names go; `case.toml` stays until it is written anew, for it may be the
    /// user's own.
    ///
    /// # Errors
    /// [`CaseError::ForeignFolder`] for a folder that is not empty and was not written by igimp;
    /// [`CaseError::File`], [`CaseError::Checkpoint`].
    pub fn afresh(root: &Path) -> Result<Self, CaseError> {
        refuse_foreign(root)?;
        if root.exists() {
            clear(root)?;
        }
        Self::lay_out(root)
    }

    /// The folder of an earlier run, with all its results.
    ///
    /// # Errors
    /// [`CaseError::NoResults`] if igimp wrote nothing there; [`CaseError::File`].
    pub fn open(root: &Path) -> Result<Self, CaseError> {
        if !is_ours(root) {
            return Err(CaseError::NoResults { path: root.into() });
        }
        Self::lay_out(root)
    }

    fn lay_out(root: &Path) -> Result<Self, CaseError> {
        let folder = Self {
            root: root.to_path_buf(),
        };
        fs::create_dir_all(root).map_err(at(root))?;
        write_atomically(&root.join(MARKER), MARKER_TEXT)?;
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

    /// `convergence.csv`.
    pub fn convergence(&self) -> PathBuf {
        self.root.join("convergence.csv")
    }

    /// `curves/`.
    pub fn curves(&self) -> PathBuf {
        self.root.join("curves")
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
/// [`CaseError::ForeignFolder`] for a folder that is not empty and was not written by igimp;
/// [`CaseError::File`].
pub fn claim(root: &Path) -> Result<(), CaseError> {
    refuse_foreign(root)?;
    fs::create_dir_all(root).map_err(at(root))?;
    write_atomically(&root.join(MARKER), MARKER_TEXT)
}

/// Writes the `summary.json` of a results folder.
///
/// # Errors
/// [`CaseError::File`].
pub fn write_summary(root: &Path, summary: &Summary) -> Result<(), CaseError> {
    let path = root.join(SUMMARY);
    let text = serde_json::to_string_pretty(summary).map_err(|source| CaseError::File {
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
/// From the beginning, what an earlier run left is cleared as in [`Folder::afresh`], and so are the
/// folders of meshes.
///
/// # Errors
/// [`CaseError::ForeignFolder`] for a folder that is not empty and was not written by igimp;
/// [`CaseError::File`], [`CaseError::Checkpoint`].
pub fn of_study(root: &Path, afresh: bool) -> Result<(), CaseError> {
    claim(root)?;
    if afresh {
        clear(root)?;
        clear_meshes(root)?;
    }
    Ok(())
}

/// Clears the folders of meshes that an earlier study left in a results folder: the files of our names,
/// and what is empty then.
///
/// # Errors
/// [`CaseError::File`], [`CaseError::Checkpoint`].
pub fn clear_meshes(root: &Path) -> Result<(), CaseError> {
    for number in 1..=MOST_MESHES {
        let mesh = root.join(mesh_name(number));
        if !mesh.is_dir() || !is_ours(&mesh) {
            continue;
        }
        clear(&mesh)?;
        remove_files(&mesh, |name| [MARKER, "case.toml"].contains(&name))?;
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
/// [`CaseError::ForeignFolder`] for a folder that is not empty and was not written by igimp;
/// [`CaseError::File`].
pub fn refuse_foreign(root: &Path) -> Result<(), CaseError> {
    if root.exists() && !is_empty(root)? && !is_ours(root) {
        return Err(CaseError::ForeignFolder { path: root.into() });
    }
    Ok(())
}

fn is_empty(folder: &Path) -> Result<bool, CaseError> {
    Ok(fs::read_dir(folder).map_err(at(folder))?.next().is_none())
}

/// Whether igimp wrote here: by the marker, or its temporary where a run was killed just then; by a
/// summary that names igimp, by a checkpoint.
///
/// A `case.toml` alone is no proof: it may be the input of a run that was told to write here.
fn is_ours(root: &Path) -> bool {
    let names_igimp = |summary: serde_json::Value| {
        let program = summary["program"].as_str();
        program.is_some_and(|program| program.starts_with("igimp"))
    };
    let summary = fs::read(root.join(SUMMARY)).ok();
    let marker = root.join(MARKER);
    marker.is_file()
        || temporary_name(&marker).is_file()
        || summary
            .and_then(|bytes| serde_json::from_slice(&bytes).ok())
            .is_some_and(names_igimp)
        || checkpoint::any(&root.join(CHECKPOINT))
}

fn clear(root: &Path) -> Result<(), CaseError> {
    remove_files(root, |name| FILES.contains(&name))?;
    for folder in TABLES {
        remove_files(&root.join(folder), |name| has_extension(name, &["csv"]))?;
    }
    remove_files(&root.join(FIGURES), |name| {
        has_extension(name, &["svg", "png"])
    })?;
    remove_files(&root.join(PARAVIEW), pvd::is_our_name)?;
    checkpoint::remove_all(&root.join(CHECKPOINT))?;
    let last = root.join(LAST_CONVERGED);
    if checkpoint::is_checkpoint(&last) {
        fs::remove_dir_all(&last).map_err(at(&last))?;
    }
    Ok(())
}

fn has_extension(name: &str, extensions: &[&str]) -> bool {
    let extension = Path::new(name).extension().and_then(|end| end.to_str());
    extension.is_some_and(|extension| extensions.contains(&extension))
}

/// Removes the files of a folder whose name, or whose temporary's name, is ours.
fn remove_files(folder: &Path, is_our_name: impl Fn(&str) -> bool) -> Result<(), CaseError> {
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
mod tests {
    use super::*;
    use crate::results::checkpoint::tests::{body, meta};
    use crate::results::scratch::Scratch;

    fn everything(folder: &Folder) {
        for path in [
            folder.summary(),
            folder.report(),
            folder.case(),
            folder.completed_case(),
            folder.convergence(),
            folder.curves().join("a.csv"),
            folder.monitors().join("b.csv"),
            folder.monitors().join(".b.csv.tmp"),
            folder.sections().join("c.csv"),
            folder.figures().join("d.svg"),
            folder.figures().join("d.png"),
            folder.paraview().join("particles.pvd"),
            folder.paraview().join("particles_0001.vtu"),
            folder.paraview().join(".particles_0002.vtu.tmp"),
            folder.paraview().join("grid.pvd"),
            folder.paraview().join("grid_12345.vtu"),
            folder.paraview().join("stage-02-last-stable.vtu"),
            folder.paraview().join("stage-02-first-unstable.vtu"),
        ] {
            fs::write(path, "x").unwrap();
        }
        let states = [("current", &body(3))];
        checkpoint::write(&folder.checkpoint(), "load-1", &states, &meta(), 1).unwrap();
        checkpoint::write(folder.root(), LAST_CONVERGED, &states, &meta(), 1).unwrap();
    }

    fn files(folder: &Path) -> Vec<PathBuf> {
        let mut found = Vec::new();
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                found.extend(files(&path));
            } else {
                found.push(path);
            }
        }
        found.sort();
        found
    }

    #[test]
    fn a_new_folder_is_laid_out() {
        let scratch = Scratch::new();
        let root = scratch.path().join("deep/results");
        let folder = Folder::afresh(&root).unwrap();
        assert_eq!(
            scratch.names("deep/results"),
            [
                ".igimp",
                "checkpoint",
                "curves",
                "figures",
                "monitors",
                "paraview",
                "sections",
                "slip_lines"
            ]
        );
        assert_eq!(folder.root(), root);
        assert!(Folder::open(&root).is_ok());
    }

    /// GOAL: a further run removes what the one before wrote and nothing of the user's.
    #[test]
    fn only_our_files_are_cleared() {
        let scratch = Scratch::new();
        let root = scratch.path().join("results");
        let folder = Folder::afresh(&root).unwrap();
        everything(&folder);
        let notes = [
            folder.root().join("notes.txt"),
            folder.root().join("data/a.csv"),
            folder.curves().join("plot.py"),
            folder.figures().join("paper.pdf"),
            folder.paraview().join("view.pvsm"),
            folder.paraview().join("particles_mine.vtu"),
            folder.paraview().join("other.pvd"),
            folder.checkpoint().join("mine/x.npy"),
        ];
        for path in &notes {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "the user's").unwrap();
        }
        assert_eq!(Folder::afresh(&root).unwrap(), folder);
        let mut expected = notes.to_vec();
        expected.extend([folder.root().join(MARKER), folder.case()]);
        expected.sort();
        assert_eq!(files(&root), expected);
    }

    #[test]
    fn a_resumed_run_finds_everything() {
        let scratch = Scratch::new();
        let folder = Folder::afresh(scratch.path()).unwrap();
        everything(&folder);
        let before = files(scratch.path());
        assert_eq!(Folder::open(scratch.path()).unwrap(), folder);
        assert_eq!(files(scratch.path()), before);
    }

    #[test]
    fn the_folder_of_somebody_else_is_refused() {
        let scratch = Scratch::new();
        fs::write(scratch.path().join("case.toml"), "the user's").unwrap();
        fs::write(scratch.path().join("summary.json"), r#"{"program": "x"}"#).unwrap();
        let error = Folder::afresh(scratch.path()).unwrap_err();
        insta::assert_snapshot!(
            scratch.hide(&error),
            @"DIR is not empty and was not written by igimp; choose another folder for the results"
        );
        let error = Folder::open(scratch.path()).unwrap_err();
        insta::assert_snapshot!(scratch.hide(&error), @"DIR holds no results of igimp");
        assert_eq!(scratch.names(""), ["case.toml", "summary.json"]);
        let file = scratch.path().join("case.toml");
        let error = Folder::afresh(&file).unwrap_err();
        insta::assert_snapshot!(scratch.hide(&error), @"cannot access DIR/case.toml");
    }

    /// A run killed while it wrote the marker leaves a folder that the next run takes.
    #[test]
    fn a_folder_with_half_a_marker_is_ours() {
        let scratch = Scratch::new();
        let root = scratch.path().join("results");
        fs::create_dir(&root).unwrap();
        fs::write(temporary_name(&root.join(MARKER)), "igimp wri").unwrap();
        Folder::open(&root).unwrap();
        Folder::afresh(&root).unwrap();
        assert!(!temporary_name(&root.join(MARKER)).exists());
    }

    #[test]
    fn a_claimed_folder_may_hold_a_file_before_its_run() {
        let scratch = Scratch::new();
        let root = scratch.path().join("task-0001");
        claim(&root).unwrap();
        fs::write(root.join("task.json"), "{}").unwrap();
        claim(&root).unwrap();
        Folder::afresh(&root).unwrap();
        assert!(root.join("task.json").exists());
        let foreign = scratch.path().join("mine");
        fs::create_dir(&foreign).unwrap();
        fs::write(foreign.join("notes.txt"), "the user's").unwrap();
        assert!(matches!(
            claim(&foreign),
            Err(CaseError::ForeignFolder { .. })
        ));
    }

    #[test]
    fn results_without_a_marker_are_known_by_summary_or_checkpoint() {
        let scratch = Scratch::new();
        let states = [("current", &body(2))];
        checkpoint::write(
            &scratch.path().join("a/checkpoint"),
            "k0",
            &states,
            &meta(),
            1,
        )
        .unwrap();
        fs::create_dir(scratch.path().join("b")).unwrap();
        fs::write(
            scratch.path().join("b/summary.json"),
            r#"{"program": "igimp 0.1.0"}"#,
        )
        .unwrap();
        for name in ["a", "b"] {
            Folder::afresh(&scratch.path().join(name)).unwrap();
            assert!(scratch.names(&format!("{name}/checkpoint")).is_empty());
        }
    }
}
