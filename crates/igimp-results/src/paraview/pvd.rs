//! Frames of a run for ParaView: numbered `.vtu` files and the `.pvd` collection that gives each
//! its time, and the stage that it belongs to as its group.
//!
//! The collection is written anew after each frame, whole or not at all, so it can be opened while
//! the run goes on and names no frame that is not there.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use igimp_text::on_a_line;

use crate::atomic::{at, write_whole};
use crate::error::ResultsError;
use crate::vtu::read::unescaped;
use crate::vtu::{UnstructuredGrid, escaped};

/// Name of the frames of particles.
pub const PARTICLES: &str = "particles";

/// Name of the frames of the background grid.
pub const GRID: &str = "grid";

/// Name of the frames of rigid bodies.
pub const RIGID: &str = "rigid";

/// Name of the frames of reinforcement.
pub const REINFORCEMENT: &str = "reinforcement";

/// Behind the name of a state that is written beside the frames, for its reinforcement.
pub(crate) const OF_REINFORCEMENT: &str = "-reinforcement";

/// Behind the name of a state that is written beside the frames, for its rigid bodies.
pub(crate) const OF_BODIES: &str = "-rigid";

/// A `.pvd` file and its frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Collection {
    folder: PathBuf,
    stem: &'static str,
    frames: Vec<Frame>,
}

/// A frame of a collection.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Pseudo-time that ParaView shows \[-\]; frames come in the order of their times.
    pub time: f64,
    /// Name of the stage, on a line.
    pub stage: String,
    /// File, relative to the collection.
    pub file: String,
}

impl Collection {
    /// An empty collection in a folder that exists, usually of [`PARTICLES`], [`GRID`] or [`RIGID`].
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn create(folder: &Path, stem: &'static str) -> Result<Self, ResultsError> {
        let collection = Self {
            folder: folder.to_path_buf(),
            stem,
            frames: Vec::new(),
        };
        collection.write()?;
        Ok(collection)
    }

    /// Goes on after the first `frames` frames of an earlier run; its later ones are removed.
    ///
    /// Without frames to keep the collection is made anew.
    ///
    /// # Errors
    /// [`ResultsError::Unusable`] when the collection has fewer frames or is not one of igimp;
    /// [`ResultsError::File`].
    pub fn resume(folder: &Path, stem: &'static str, frames: usize) -> Result<Self, ResultsError> {
        let mut collection = Self {
            folder: folder.to_path_buf(),
            stem,
            frames: Vec::new(),
        };
        if frames > 0 {
            let path = collection.path();
            let text = fs::read_to_string(&path).map_err(at(&path))?;
            let unusable = |why: String| ResultsError::Unusable {
                path: path.clone(),
                why,
            };
            collection.frames = parse(&text)
                .ok_or_else(|| unusable("it is not a collection that igimp wrote".into()))?;
            let found = collection.frames.len();
            if found < frames {
                return Err(unusable(format!("it has {found} of {frames} frames")));
            }
            collection.frames.truncate(frames);
            for frame in &collection.frames {
                let file = folder.join(&frame.file);
                fs::metadata(&file).map_err(at(&file))?;
            }
        }
        collection.write()?;
        collection.remove_later_frames()?;
        Ok(collection)
    }

    /// Writes a frame of a stage and adds it.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn add(
        &mut self,
        time: f64,
        stage: &str,
        grid: &UnstructuredGrid,
    ) -> Result<PathBuf, ResultsError> {
        let file = format!("{}_{:04}.vtu", self.stem, self.frames.len() + 1);
        let path = self.folder.join(&file);
        grid.clone().at_time(time).write(&path)?;
        let stage = on_a_line(stage).into_owned();
        self.frames.push(Frame { time, stage, file });
        self.write()?;
        Ok(path)
    }

    /// The frames so far.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The `.pvd` file.
    pub fn path(&self) -> PathBuf {
        self.folder.join(format!("{}.pvd", self.stem))
    }

    fn write(&self) -> Result<(), ResultsError> {
        write_whole(&self.path(), text_of(&self.frames))
    }

    fn remove_later_frames(&self) -> Result<(), ResultsError> {
        let folder = &self.folder;
        for entry in fs::read_dir(folder).map_err(at(folder))? {
            let entry = entry.map_err(at(folder))?;
            let name = entry.file_name();
            let number = name.to_str().and_then(|name| frame_number(name, self.stem));
            if number.is_some_and(|number| number > self.frames.len()) {
                fs::remove_file(entry.path()).map_err(at(&entry.path()))?;
            }
        }
        Ok(())
    }
}

/// Writes the collection of some states of a stage, `NAME.pvd`, in the order of their times: strength reduction factors of the
/// ends of a search, or seconds of a motion.
///
/// # Errors
/// [`ResultsError::File`].
pub(crate) fn write_states(
    folder: &Path,
    name: &str,
    mut states: Vec<Frame>,
) -> Result<(), ResultsError> {
    states.sort_by(|a, b| a.time.total_cmp(&b.time));
    write_whole(&folder.join(format!("{name}.pvd")), text_of(&states))
}

/// A collection as a file, a line for each frame.
fn text_of(frames: &[Frame]) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
         <Collection>\n",
    );
    for Frame { time, stage, file } in frames {
        let [stage, file] = [stage, file].map(|text| escaped(text));
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{time}\" group=\"{stage}\" part=\"0\" file=\"{file}\"/>"
        );
    }
    text.push_str("</Collection>\n</VTKFile>\n");
    text
}

/// Removes a collection that [`write_states`] wrote, if it is there.
///
/// # Errors
/// [`ResultsError::File`].
pub(crate) fn remove_states(folder: &Path, name: &str) -> Result<(), ResultsError> {
    let path = folder.join(format!("{name}.pvd"));
    match fs::remove_file(&path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(at(&path)(error)),
        _ => Ok(()),
    }
}

/// The name of the collection of a stage, by its number from 0.
pub fn of_stage(stage: usize) -> String {
    format!("stage-{:02}", stage + 1)
}

/// The frames of particles of a stage that moves in time, by its number from 0, with their times \[s\]; none of other
/// stages.
pub fn motion(folder: &Path, stage: usize) -> Vec<Frame> {
    let is_of_run = |frame: &Frame| frame_number(&frame.file, PARTICLES).is_some();
    let mut frames = frames(folder, &of_stage(stage)).unwrap_or_default();
    frames.retain(is_of_run);
    frames
}

/// The times \[s\] of the frames of particles by their files, of all stages that move in time.
pub fn seconds(folder: &Path) -> HashMap<String, f64> {
    let names = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = names.filter_map(|entry| entry.file_name().into_string().ok());
    let number = |name: &str| {
        let digits = name.strip_prefix("stage-")?.strip_suffix(".pvd")?;
        digits.parse::<usize>().ok()?.checked_sub(1)
    };
    let stages = names.filter_map(|name| number(&name));
    let frames = stages.flat_map(|stage| motion(folder, stage));
    frames.map(|frame| (frame.file, frame.time)).collect()
}

/// The frames of a collection, if it can be read.
pub fn frames(folder: &Path, stem: &str) -> Option<Vec<Frame>> {
    parse(&fs::read_to_string(folder.join(format!("{stem}.pvd"))).ok()?)
}

/// The frames of a collection as [`text_of`] writes it.
fn parse(text: &str) -> Option<Vec<Frame>> {
    if !text.contains("type=\"Collection\"") || !text.trim_end().ends_with("</VTKFile>") {
        return None;
    }
    text.lines()
        .filter(|line| line.starts_with("<DataSet "))
        .map(|line| {
            // Quotes within a name are escaped.
            let rest = line.strip_prefix("<DataSet timestep=\"")?;
            let (time, rest) = rest.split_once("\" group=\"")?;
            let (stage, rest) = rest.split_once("\" part=\"0\" file=\"")?;
            let file = rest.strip_suffix("\"/>")?;
            // Names that we give need no escapes, and lead nowhere else.
            let is_plain = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
            let time = time.parse().ok()?;
            file.chars().all(is_plain).then(|| Frame {
                time,
                stage: unescaped(stage),
                file: file.to_owned(),
            })
        })
        .collect()
}

/// Whether a file of `paraview/` has a name that a run gives: `STEM.pvd`, `STEM_0001.vtu`, and the states
/// of a search, such as `stage-02-last-stable.vtu` and `stage-02-last-stable-rigid.vtu`, with their collections, such as
/// `stage-02.pvd` and `stage-02-rigid.pvd`.
pub(crate) fn is_our_name(name: &str) -> bool {
    let is_frame = [PARTICLES, GRID, RIGID, REINFORCEMENT]
        .iter()
        .any(|stem| name.strip_prefix(stem) == Some(".pvd") || frame_number(name, stem).is_some());
    is_frame || is_of_a_search(name)
}

fn is_of_a_search(name: &str) -> bool {
    let Some((inner, ending)) = name
        .strip_prefix("stage-")
        .and_then(|rest| rest.rsplit_once('.'))
    else {
        return false;
    };
    let (digits, state) = match inner.split_once('-') {
        Some((digits, _)) => (digits, &inner[digits.len()..]),
        None => (inner, ""),
    };
    let is_number = digits.len() >= 2 && digits.bytes().all(|byte| byte.is_ascii_digit());
    let is_state = |state: &str| match ending {
        "vtu" => matches!(state, "-last-stable" | "-first-unstable"),
        "pvd" => state.is_empty(),
        _ => false,
    };
    let mut parts = [OF_BODIES, OF_REINFORCEMENT, ""].iter();
    is_number && parts.any(|of| state.strip_suffix(of).is_some_and(is_state))
}

/// Number of a frame from its name, such as `particles_0001.vtu`.
fn frame_number(name: &str, stem: &str) -> Option<usize> {
    let digits = name
        .strip_prefix(stem)?
        .strip_prefix('_')?
        .strip_suffix(".vtu")?;
    let is_number = digits.len() >= 4 && digits.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| digits.parse().ok())?
}

#[cfg(test)]
mod tests {
    use igimp_shape::{Axis, Grid};

    use super::*;
    use crate::paraview::particles::of_grid;
    use crate::scratch::Scratch;

    /// Its quotes and its end of a line have to be kept out of the markup.
    const STAGE: &str = "weight \"of\n<soil> & file=";

    fn frame() -> UnstructuredGrid {
        let axis = || Axis::uniform(0.0, 1.0, 2).unwrap();
        of_grid(&Grid::new([axis(), axis()]), None)
    }

    fn collection(scratch: &Scratch, frames: usize) -> Collection {
        let mut collection = Collection::create(scratch.path(), PARTICLES).unwrap();
        for k in 0..frames {
            collection.add(k as f64 / 3.0, STAGE, &frame()).unwrap();
        }
        collection
    }

    #[test]
    fn a_collection_names_its_frames() {
        let scratch = Scratch::new();
        let collection = collection(&scratch, 2);
        let text = fs::read_to_string(collection.path()).unwrap();
        insta::assert_snapshot!(text, @r#"
        <?xml version="1.0"?>
        <VTKFile type="Collection" version="1.0" byte_order="LittleEndian">
        <Collection>
        <DataSet timestep="0" group="weight &quot;of�&lt;soil&gt; &amp; file=" part="0" file="particles_0001.vtu"/>
        <DataSet timestep="0.3333333333333333" group="weight &quot;of�&lt;soil&gt; &amp; file=" part="0" file="particles_0002.vtu"/>
        </Collection>
        </VTKFile>
        "#);
        assert_eq!(
            scratch.names(""),
            ["particles.pvd", "particles_0001.vtu", "particles_0002.vtu"]
        );
        let frame = fs::read_to_string(scratch.path().join("particles_0001.vtu")).unwrap();
        assert!(frame.contains("Name=\"TimeValue\" NumberOfTuples=\"1\""));
    }

    /// GOAL: the states of a search come in the order of their factors, and are cleared with what a run wrote.
    #[test]
    fn states_of_a_search_have_a_collection() {
        let scratch = Scratch::new();
        let states = [(1.25, "first-unstable"), (1.2, "last-stable")];
        let states = states.map(|(time, state)| Frame {
            time,
            stage: "safety".to_owned(),
            file: format!("stage-02-{state}.vtu"),
        });
        write_states(scratch.path(), "stage-02", states.to_vec()).unwrap();
        let read = frames(scratch.path(), "stage-02").unwrap();
        assert_eq!(read, [states[1].clone(), states[0].clone()]);
        for name in [
            "stage-02.pvd",
            "stage-102-rigid.pvd",
            "stage-02-reinforcement.pvd",
            "stage-02-last-stable.vtu",
            "stage-02-first-unstable-rigid.vtu",
        ] {
            assert!(is_our_name(name), "{name}");
        }
        for name in [
            "stage-2.pvd",
            "stage-02.vtu",
            "stage-02-last-stable.pvd",
            "stage-02-mine.pvd",
            "stage-02-rigid.vtu",
            "stage-.pvd",
            "stage-02",
        ] {
            assert!(!is_our_name(name), "{name}");
        }
    }

    /// GOAL: a resumed run leaves the files of one that was not interrupted.
    #[test]
    fn a_resumed_collection_goes_on() {
        let scratch = Scratch::new();
        let whole = collection(&scratch, 4);
        let bytes = fs::read(whole.path()).unwrap();
        fs::write(scratch.path().join("particles_00x5.vtu"), "another's").unwrap();
        for kept in 0..=4 {
            let mut resumed = Collection::resume(scratch.path(), PARTICLES, kept).unwrap();
            assert_eq!(resumed.frames(), &whole.frames()[..kept]);
            assert_eq!(scratch.names("").len(), 2 + kept);
            for k in kept..4 {
                resumed.add(k as f64 / 3.0, STAGE, &frame()).unwrap();
            }
            assert_eq!(resumed, whole);
            assert_eq!(fs::read(whole.path()).unwrap(), bytes);
        }
    }

    #[test]
    fn what_cannot_be_continued_is_refused() {
        let scratch = Scratch::new();
        let path = collection(&scratch, 1).path();
        let refusal = |frames| {
            let resumed = Collection::resume(scratch.path(), PARTICLES, frames);
            scratch.hide(&resumed.unwrap_err())
        };
        insta::assert_snapshot!(
            refusal(2),
            @"cannot go on with DIR/particles.pvd: it has 1 of 2 frames"
        );
        let text = fs::read_to_string(&path).unwrap();
        for damaged in [
            "",
            &text[..text.len() / 2],
            &text.replace("particles_0001", "../../particles_0001"),
            &text.replace("timestep=\"0\"", "timestep=\"x\""),
        ] {
            fs::write(&path, damaged).unwrap();
            assert_eq!(
                refusal(1),
                "cannot go on with DIR/particles.pvd: it is not a collection that igimp wrote"
            );
        }
        fs::write(&path, text).unwrap();
        fs::remove_file(scratch.path().join("particles_0001.vtu")).unwrap();
        insta::assert_snapshot!(refusal(1), @"cannot access DIR/particles_0001.vtu");
    }
}
