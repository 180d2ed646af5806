//! The frames of a run for ParaView: particles, grid, rigid bodies and reinforcement.

use std::fs::File;
use std::path::{Path, PathBuf};

use igimp_assembly::{Particles, SharedLaw};
use igimp_model::{Case, Field, StageKind};
use igimp_shape::Grid;
use igimp_text::on_a_line;

use super::particles::{Extras, of_grid, of_particles};
use super::pvd::{self, Collection, Frame};
use crate::atomic::{at, sync_folder, sync_together};
use crate::error::ResultsError;
use crate::fields;
use crate::reinforcement::{self, Installed};
use crate::rigid::{self, Standing};
use crate::vtu::UnstructuredGrid;

/// Structures that are there in a frame.
#[derive(Clone, Debug, Default)]
pub struct Structures<'a, const D: usize> {
    /// Rigid bodies.
    pub rigid: Vec<Standing<'a, D>>,
    /// Reinforcement.
    pub reinforcement: Vec<Installed<'a, D>>,
}

/// A state as a frame shows it.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a, const D: usize> {
    /// The particles.
    pub particles: &'a Particles<D>,
    /// Their laws, at the strength of the state.
    pub laws: &'a [SharedLaw],
    /// The structures among them.
    pub structures: &'a Structures<'a, D>,
}

/// A state at an end of a search that was written beside the frames.
#[derive(Clone, Copy, Debug)]
pub struct StateOfSearch {
    /// Which, such as `last-stable`.
    pub name: &'static str,
    /// Its strength reduction factor \[-\].
    pub srf: f64,
}

/// The frames of a run.
#[derive(Debug)]
pub struct Frames {
    folder: PathBuf,
    particles: Collection,
    grid: Collection,
    /// Of a case with rigid bodies.
    rigid: Option<Collection>,
    /// Of a case with reinforcement.
    reinforcement: Option<Collection>,
    /// Whether there is pore water to write of.
    pore_water: bool,
    /// How many materials there are.
    materials: usize,
    /// Whether the body is one of revolution.
    axisymmetric: bool,
    /// By stage that moves in time: its number, and the places of its frames in the collections with their times \[s\].
    motion: Vec<(usize, Vec<(usize, f64)>)>,
    /// Frames that the disk is known to have.
    synced: usize,
}

impl Frames {
    /// Goes on after the first `frames` frames of a folder that exists; 0 begins anew. Rigid bodies and
    /// reinforcement have frames in cases that have some, and effective stress and pore pressure are written
    /// where there is water.
    ///
    /// # Errors
    /// [`ResultsError::Unusable`], [`ResultsError::File`].
    pub fn open<const D: usize>(
        folder: &Path,
        frames: usize,
        case: &Case<D>,
    ) -> Result<Self, ResultsError> {
        let of = |stem, is_there: bool| {
            let opened = is_there.then(|| Collection::resume(folder, stem, frames));
            opened.transpose()
        };
        let mut all = Self {
            rigid: of(pvd::RIGID, !case.rigid.is_empty())?,
            reinforcement: of(pvd::REINFORCEMENT, !case.reinforcement.is_empty())?,
            pore_water: case.has_pore_water(),
            materials: case.materials.len(),
            axisymmetric: case.method.section.is_axisymmetric(),
            motion: Vec::new(),
            folder: folder.to_path_buf(),
            particles: Collection::resume(folder, pvd::PARTICLES, frames)?,
            grid: Collection::resume(folder, pvd::GRID, frames)?,
            synced: frames,
        };
        for (number, stage) in case.stages.iter().enumerate() {
            if matches!(stage.kind, StageKind::Dynamic(_)) {
                all.take_up_motion(number)?;
            }
        }
        Ok(all)
    }

    /// The kept frames of a stage that moves in time; its collections lose the others.
    fn take_up_motion(&mut self, stage: usize) -> Result<(), ResultsError> {
        let kept = self.particles.frames();
        let place = |frame: &Frame| kept.iter().position(|other| other.file == frame.file);
        let timed = pvd::motion(&self.folder, stage).into_iter();
        let timed = timed.filter_map(|frame| Some((place(&frame)?, frame.time)));
        self.motion.push((stage, timed.collect()));
        self.write_motion(self.motion.len() - 1)
    }

    /// Begins the frames of a stage that moves in time, by its number from 0: its first is the last frame of the stage that it
    /// starts from. Whether there is one.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn begin_motion(
        &mut self,
        stage: usize,
        from: Option<&str>,
        seconds: f64,
    ) -> Result<bool, ResultsError> {
        let from = from.map(on_a_line);
        let mut frames = self.particles.frames().iter();
        let found = frames.rposition(|frame| from.as_deref() == Some(frame.stage.as_str()));
        let Some(index) = self.motion.iter().position(|(number, _)| *number == stage) else {
            return Ok(found.is_some());
        };
        self.motion[index].1 = found.map(|place| (place, seconds)).into_iter().collect();
        self.write_motion(index)?;
        Ok(found.is_some())
    }

    /// Whether the last frame of a stage, by its number from 0, is that of a time \[s\]; never of a stage that takes no time.
    pub fn is_at(&self, stage: usize, seconds: f64) -> bool {
        let motion = self.motion.iter().find(|(number, _)| *number == stage);
        let last = motion.and_then(|(_, timed)| timed.last());
        last.is_some_and(|(_, time)| *time >= seconds)
    }

    /// The collections of a stage that moves in time, whose times are seconds: a viewer plays them as they were.
    fn write_motion(&self, index: usize) -> Result<(), ResultsError> {
        let (stage, timed) = &self.motion[index];
        let parts = [
            (Some(&self.particles), ""),
            (self.rigid.as_ref(), pvd::OF_BODIES),
            (self.reinforcement.as_ref(), pvd::OF_REINFORCEMENT),
        ];
        for (collection, of) in parts {
            let Some(collection) = collection else {
                continue;
            };
            let name = format!("{}{of}", pvd::of_stage(*stage));
            let frame = |&(place, time): &(usize, f64)| {
                let frame = collection.frames().get(place)?.clone();
                Some(Frame { time, ..frame })
            };
            let frames: Vec<Frame> = timed.iter().filter_map(frame).collect();
            if frames.is_empty() {
                pvd::remove_states(&self.folder, &name)?;
            } else {
                pvd::write_states(&self.folder, &name, frames)?;
            }
        }
        Ok(())
    }

    /// Adds a frame of a stage, by its number from 0 and its name, at a pseudo-time, and at a time \[s\] where the stage takes
    /// time.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn add<const D: usize>(
        &mut self,
        (time, seconds): (f64, f64),
        (number, stage): (usize, &str),
        scene: &Scene<'_, D>,
        grid: &Grid<D>,
    ) -> Result<(), ResultsError> {
        let cells = self.cells(scene.particles, scene.laws);
        self.particles.add(time, stage, &cells)?;
        self.grid.add(time, stage, &of_grid(grid, None))?;
        let structures = scene.structures;
        if let Some(collection) = &mut self.rigid {
            collection.add(time, stage, &rigid::cells(&structures.rigid))?;
        }
        if let Some(collection) = &mut self.reinforcement {
            let lines = reinforcement::lines(&structures.reinforcement);
            collection.add(time, stage, &lines)?;
        }
        let index = self.motion.iter().position(|(known, _)| *known == number);
        let Some(index) = index else {
            return Ok(());
        };
        let place = self.len() - 1;
        self.motion[index].1.push((place, seconds));
        self.write_motion(index)
    }

    /// Writes particles beside the frames, as `NAME.vtu`, rigid bodies as `NAME-rigid.vtu`, and
    /// reinforcement as `NAME-reinforcement.vtu`.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn beside<const D: usize>(
        &self,
        name: &str,
        scene: &Scene<'_, D>,
    ) -> Result<(), ResultsError> {
        let structures = scene.structures;
        let file = |of| self.folder.join(format!("{name}{of}.vtu"));
        if self.rigid.is_some() {
            rigid::cells(&structures.rigid).write(&file(pvd::OF_BODIES))?;
        }
        if self.reinforcement.is_some() {
            let lines = reinforcement::lines(&structures.reinforcement);
            lines.write(&file(pvd::OF_REINFORCEMENT))?;
        }
        let path = self.folder.join(name).with_extension("vtu");
        self.cells(scene.particles, scene.laws).write(&path)
    }

    /// Collects states that were written beside the frames, as `NAME-STATE.vtu`: `NAME.pvd`, with strength reduction factors
    /// for times, and the same for rigid bodies and reinforcement.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn collect(
        &self,
        name: &str,
        stage: &str,
        states: &[StateOfSearch],
    ) -> Result<(), ResultsError> {
        let parts = [
            (true, ""),
            (self.rigid.is_some(), pvd::OF_BODIES),
            (self.reinforcement.is_some(), pvd::OF_REINFORCEMENT),
        ];
        for (_, of) in parts.into_iter().filter(|(is_there, _)| *is_there) {
            let frame = |state: &StateOfSearch| Frame {
                time: state.srf,
                stage: on_a_line(stage).into_owned(),
                file: format!("{name}-{}{of}.vtu", state.name),
            };
            let frames = states.iter().map(frame).collect();
            pvd::write_states(&self.folder, &format!("{name}{of}"), frames)?;
        }
        Ok(())
    }

    fn cells<const D: usize>(
        &self,
        particles: &Particles<D>,
        laws: &[SharedLaw],
    ) -> UnstructuredGrid {
        let utilisation = fields::values(Field::Utilisation, particles, laws);
        let carried = carried(particles, laws);
        let extras = Extras {
            utilisation: Some(&utilisation),
            carried: &carried,
            materials: Some(self.materials),
            def_grad: true,
            pore_water: self.pore_water,
            axisymmetric: self.axisymmetric,
            motion: !self.motion.is_empty(),
        };
        of_particles(particles, &extras)
    }

    /// Waits until the disk has every frame: before a checkpoint that counts on them.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn sync(&mut self) -> Result<(), ResultsError> {
        let new = |collection: &Collection| -> Vec<PathBuf> {
            let frames = collection.frames()[self.synced..].iter();
            let files = frames.map(|frame| self.folder.join(&frame.file));
            files.chain([collection.path()]).collect()
        };
        if self.synced == self.len() {
            return Ok(());
        }
        let open = |path: PathBuf| {
            let file = File::open(&path).map_err(at(&path))?;
            Ok((path, file))
        };
        let collections = [&self.particles, &self.grid].into_iter();
        let collections = collections.chain(&self.rigid).chain(&self.reinforcement);
        let files: Vec<_> = collections
            .flat_map(new)
            .map(open)
            .collect::<Result<_, ResultsError>>()?;
        sync_together(&files, |path, error| at(path)(error))?;
        sync_folder(&self.folder).map_err(at(&self.folder))?;
        self.synced = self.len();
        Ok(())
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.particles.frames().len()
    }

    /// Whether there is no frame yet.
    pub fn is_empty(&self) -> bool {
        self.particles.frames().is_empty()
    }
}

/// Strength and stiffness of the particles, where they are not those of the materials everywhere, and the internal
/// variables of their laws.
fn carried<const D: usize>(
    particles: &Particles<D>,
    laws: &[SharedLaw],
) -> Vec<(String, Vec<f64>)> {
    let varies = particles.ratios.iter().any(|ratios| !ratios.are_one());
    let arrays = [
        ("strength [Pa]", Field::Strength),
        ("friction angle [rad]", Field::Friction),
        ("Young's modulus [Pa]", Field::Young),
    ];
    let arrays = arrays.into_iter().filter(|_| varies);
    arrays
        .map(|(name, field)| (name.to_owned(), fields::values(field, particles, laws)))
        .chain(fields::internal_variables(particles, laws))
        .collect()
}
