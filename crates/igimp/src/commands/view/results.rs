//! The files of a results folder that the page shows, and no others.

use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::UNIX_EPOCH;

use igimp_input::CaseFile;
use igimp_model::{AnyCase, Every, StageKind};
use igimp_report::viewer::over::{Over, by_stage};
use igimp_report::viewer::{self, Bodies, Keep};
use igimp_report::whereabouts::{Whereabouts, whereabouts};
use igimp_results::paraview::pvd::{self, Frame};
use igimp_results::summary::Summary;
use serde_json::{Value, json};

use crate::error::ProgramError;

/// Folders whose files are shown, by ending, and how they are called in HTTP.
const SHOWN: [(&str, &str, &str); 5] = [
    ("paraview", "pvd", "application/xml"),
    ("paraview", "vtu", "application/xml"),
    ("curves", "csv", "text/csv; charset=utf-8"),
    ("monitors", "csv", "text/csv; charset=utf-8"),
    ("rigid", "csv", "text/csv; charset=utf-8"),
];

/// Most folders that a message lists.
const MOST_LISTED: usize = 12;

/// Bytes of a page that are looked at for its maker, and its mark.
const LARGEST_HEAD: u64 = 2048;
const GENERATOR: &str = "<meta name=\"generator\" content=\"igimp";

/// Largest summary that is read \[bytes\].
const LARGEST_SUMMARY: u64 = 64 << 20;

/// A folder of results, by its path without links.
#[derive(Debug)]
pub(super) struct Results {
    root: PathBuf,
    /// The bodies of the case, once a frame is asked for.
    bodies: OnceLock<Option<Bodies>>,
}

impl Results {
    /// The results of one run; of several runs in a folder the message tells which there are.
    pub(super) fn open(folder: &Path) -> Result<Self, ProgramError> {
        let access = |source| ProgramError::File {
            path: folder.to_owned(),
            source,
        };
        let root = fs::canonicalize(folder).map_err(access)?;
        if is_of_a_run(&root) {
            return Ok(Self {
                root,
                bodies: OnceLock::new(),
            });
        }
        let inside = runs_inside(folder, &root).map_err(access)?;
        let shown = folder.display();
        if inside.is_empty() {
            return Err(ProgramError::usage(
                format!("there are no results of a run in {shown}"),
                "give the folder that `igimp run` names in its last line",
            ));
        }
        let more = inside.len().saturating_sub(MOST_LISTED);
        let mut lines: Vec<String> = inside
            .iter()
            .take(MOST_LISTED)
            .map(|path| format!("\n    igimp view {}", path.display()))
            .collect();
        if more > 0 {
            lines.push(format!("\n    and {more} more"));
        }
        Err(ProgramError::usage(
            format!("{shown} holds the results of several runs"),
            format!("look at one of them:{}", lines.concat()),
        ))
    }

    /// The index that the page reads before it asks for files, as JSON: the case, its stages so far, and
    /// every file with a text that changes when the file does.
    pub(super) fn index(&self) -> String {
        let summary = self.summary();
        let case = self.case();
        let case = case.as_ref().map(CaseFile::any_case);
        let title = case.map_or("", AnyCase::title);
        let stages: Vec<Value> = std::iter::zip(0.., summary.iter().flat_map(|run| &run.stages))
            .map(|(number, stage)| {
                let trials = stage.safety.as_ref().map(|found| found.trials.len());
                json!({
                    "name": stage.name,
                    "rows": trials.map_or(stage.steps, |made| made.min(listed(case, number))),
                })
            })
            .collect();
        let planned: Vec<&str> = case
            .iter()
            .flat_map(|case| case.stages())
            .map(|stage| &*stage.name)
            .collect();
        let recorded: serde_json::Map<String, Value> = case
            .iter()
            .flat_map(|case| case.curves())
            .map(|curve| (format!("curves/{}.csv", curve.name), json!(curve.stage)))
            .collect();
        let files: serde_json::Map<String, Value> = SHOWN
            .iter()
            .flat_map(|(folder, ending, _)| self.names(folder, ending))
            .map(|(name, path)| (name, json!(version(&path))))
            .collect();
        json!({
            "title": title,
            "folder": self.root.file_name().map(|name| name.to_string_lossy()),
            "stages": stages,
            "planned": planned,
            "frames": self.frames(case),
            "stage_of_curve": recorded,
            "never": case.is_some_and(|case| case.output().paraview == Every::Never),
            "seconds": self.seconds(),
            "over": case.map(|case| self.over(case)),
            "files": files,
        })
        .to_string()
    }

    /// The folder of frames, if it is there and no link.
    fn paraview(&self) -> Option<PathBuf> {
        let folder = self.root.join("paraview");
        let is_there = fs::canonicalize(&folder).is_ok_and(|real| real == folder);
        is_there.then_some(folder)
    }

    /// Where frames stand in the run, by their files.
    fn frames(&self, case: Option<&AnyCase>) -> serde_json::Map<String, Value> {
        let folder = self.paraview();
        let frames = folder.and_then(|path| pvd::frames(&path, pvd::PARTICLES));
        let frames = frames.unwrap_or_default();
        let places = whereabouts(&frames, case.map_or(&[], AnyCase::stages));
        let place = |(frame, at): (Frame, Whereabouts)| {
            let entry = json!({ "stage": at.stage, "step": at.step, "when": at.when });
            (format!("paraview/{}", frame.file), entry)
        };
        frames.into_iter().zip(places).map(place).collect()
    }

    /// The times \[s\] of frames by their files, where the soil moves in time.
    fn seconds(&self) -> serde_json::Map<String, Value> {
        let times = self.paraview().map(|folder| pvd::seconds(&folder));
        let times = times.unwrap_or_default();
        let named = times
            .into_iter()
            .map(|(file, time)| (format!("paraview/{file}"), json!(time)));
        named.collect()
    }

    /// Overlays of the frames of every stage.
    fn over(&self, case: &AnyCase) -> Vec<Over> {
        match case {
            AnyCase::Plane(case) => by_stage(case, &self.root),
            AnyCase::Space(case) => by_stage(case, &self.root),
        }
    }

    /// The case of the folder; none where it cannot be read.
    fn case(&self) -> Option<CaseFile> {
        CaseFile::read(&self.root.join("case.completed.toml"), &[]).ok()
    }

    /// A file by its name in an address, with its length and kind; nothing for names that are not
    /// found by looking into the folders that are shown.
    pub(super) fn file(&self, encoded: &str) -> Option<(File, u64, &'static str)> {
        let (path, kind) = self.path(encoded)?;
        let file = File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        Some((file, length, kind))
    }

    /// A frame by its name in an address, as the page takes it.
    pub(super) fn packed(&self, encoded: &str) -> Option<String> {
        let (path, _) = self.path(encoded)?;
        let is_frame = path.extension().is_some_and(|ending| ending == "vtu");
        let bodies = self.bodies.get_or_init(|| match self.case()?.any_case() {
            AnyCase::Plane(case) => Bodies::of(case),
            AnyCase::Space(case) => Bodies::of(case),
        });
        is_frame
            .then(|| viewer::frame(&path, Keep::MUCH, bodies.as_ref()))
            .flatten()
    }

    /// The path of a file that is shown, and its kind.
    fn path(&self, encoded: &str) -> Option<(PathBuf, &'static str)> {
        let name = decoded(encoded)?;
        SHOWN.iter().find_map(|&(folder, ending, kind)| {
            let mut names = self.names(folder, ending);
            names
                .find(|(known, _)| *known == name)
                .map(|(_, path)| (path, kind))
        })
    }

    /// The files of a folder with an ending: plain files that stand there themselves, no links.
    fn names(
        &self,
        folder: &'static str,
        ending: &'static str,
    ) -> impl Iterator<Item = (String, PathBuf)> {
        let entries = fs::read_dir(self.root.join(folder)).into_iter().flatten();
        entries.filter_map(move |entry| {
            let path = entry.ok()?.path();
            let name = path.file_name()?.to_str()?;
            let is_shown = !name.starts_with('.')
                && path.extension().is_some_and(|found| found == ending)
                // The same for any link on the way, also that of the folder.
                && fs::canonicalize(&path).is_ok_and(|real| real == path)
                && path.is_file();
            is_shown.then(|| (format!("{folder}/{name}"), path.clone()))
        })
    }

    fn summary(&self) -> Option<Summary> {
        let path = self.root.join("summary.json");
        let about = fs::symlink_metadata(&path).ok()?;
        if !about.is_file() || about.len() > LARGEST_SUMMARY {
            return None;
        }
        serde_json::from_slice(&fs::read(path).ok()?).ok()
    }
}

/// Whether a run laid out its results here.
fn is_of_a_run(folder: &Path) -> bool {
    folder.join("paraview").is_dir()
}

/// The folders of runs in a folder, in their order.
fn runs_inside(folder: &Path, root: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut inside: Vec<PathBuf> = fs::read_dir(root)?
        .filter_map(|entry| Some(entry.ok()?.file_name()))
        .filter(|name| is_of_a_run(&root.join(name)))
        .map(|name| folder.join(name))
        .collect();
    inside.sort();
    Ok(inside)
}

/// The page of a folder that is none of a run and holds none, as that of a test or of a fit, if igimp made one.
pub(super) fn page_alone(folder: &Path) -> Option<PathBuf> {
    let root = fs::canonicalize(folder).ok()?;
    if is_of_a_run(&root) || !runs_inside(folder, &root).ok()?.is_empty() {
        return None;
    }
    let page = root.join("report.html");
    let mut head = Vec::new();
    let file = File::open(&page).ok()?;
    file.take(LARGEST_HEAD).read_to_end(&mut head).ok()?;
    let is_ours = String::from_utf8_lossy(&head).contains(GENERATOR);
    is_ours.then_some(page)
}

/// Number of factors that the case lists for a search, each of which is a row of the tables.
fn listed(case: Option<&AnyCase>, stage: usize) -> usize {
    match case
        .and_then(|case| case.stages().get(stage))
        .map(|stage| &stage.kind)
    {
        Some(StageKind::StrengthReduction(search)) => search.factors.len(),
        _ => 0,
    }
}

/// A text that changes when a file does.
fn version(path: &Path) -> String {
    let Ok(about) = fs::metadata(path) else {
        return String::new();
    };
    let time = about.modified().ok();
    let since = time.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    format!(
        "{}-{}",
        about.len(),
        since.map_or(0, |since| since.as_nanos())
    )
}

/// A part of an address with its percent signs read once.
fn decoded(encoded: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(encoded.len());
    let mut rest = encoded.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        if first != b'%' {
            bytes.push(first);
            continue;
        }
        let digits = std::str::from_utf8(rest.get(..2)?).ok()?;
        bytes.push(u8::from_str_radix(digits, 16).ok()?);
        rest = &rest[2..];
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_signs_are_read_once() {
        assert_eq!(decoded("a%20b%C3%BC").as_deref(), Some("a bü"));
        assert_eq!(decoded("%252e").as_deref(), Some("%2e"));
        for wrong in ["%", "%2", "%zz", "%ff"] {
            assert_eq!(decoded(wrong), None, "{wrong}");
        }
    }
}
