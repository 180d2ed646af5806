//! What a run writes for ParaView: the particles, the grid and rigid bodies, frame by frame.

use std::fs::File;
use std::path::{Path, PathBuf};

use igimp_assembly::{Particles, SharedLaw};
use igimp_shape::Grid;

use super::atomic::{at, sync_folder, sync_together};
use super::fields;
use super::particles::{Extras, of_grid, of_particles};
use super::pvd::{self, Collection};
use super::rigid::{Standing, lines};
use super::vtu::UnstructuredGrid;
use crate::case::{Case, Field};
use crate::error::CaseError;

/// The frames of a run.
#[derive(Debug)]
pub struct Frames {
    folder: PathBuf,
    particles: Collection,
    grid: Collection,
    /// Of a case with rigid bodies.
    rigid: Option<Collection>,
    /// Whether there is pore water to write of.
    pore_water: bool,
    /// Frames that the disk is known to have.
    synced: usize,
}

impl Frames {
    /// Goes on after the first `frames` frames of a folder that exists; 0 begins anew. Rigid bodies have
    /// frames in cases that have some, and effective stress and pore pressure are written where there is water.
    ///
    /// # Errors
    /// [`CaseError::Unusable`], [`CaseError::File`].
    pub fn open(folder: &Path, frames: usize, case: &Case) -> Result<Self, CaseError> {
        let has_rigid = !case.rigid.is_empty();
        let rigid = has_rigid.then(|| Collection::resume(folder, pvd::RIGID, frames));
        Ok(Self {
            rigid: rigid.transpose()?,
            pore_water: case.has_pore_water(),
            folder: folder.to_path_buf(),
            particles: Collection::resume(folder, pvd::PARTICLES, frames)?,
            grid: Collection::resume(folder, pvd::GRID, frames)?,
            synced: frames,
        })
    }

    /// Adds a frame at a pseudo-time.
    ///
    /// # Errors
    /// [`CaseError::File`].
    pub fn add(
        &mut self,
        time: f64,
        (particles, laws): (&Particles<2>, &[SharedLaw]),
        grid: &Grid<2>,
        rigid: &[Standing<'_>],
    ) -> Result<(), CaseError> {
        let cells = self.cells(particles, laws);
        self.particles.add(time, &cells)?;
        self.grid.add(time, &of_grid(grid, None))?;
        if let Some(collection) = &mut self.rigid {
            collection.add(time, &lines(rigid))?;
        }
        Ok(())
    }

    /// Writes particles beside the frames, as `NAME.vtu`, and rigid bodies as `NAME-rigid.vtu`.
    ///
    /// # Errors
    /// [`CaseError::File`].
    pub fn beside(
        &self,
        name: &str,
        (particles, laws): (&Particles<2>, &[SharedLaw]),
        rigid: &[Standing<'_>],
    ) -> Result<(), CaseError> {
        if self.rigid.is_some() {
            let name = format!("{name}{}.vtu", pvd::OF_BODIES);
            lines(rigid).write(&self.folder.join(name))?;
        }
        let path = self.folder.join(name).with_extension("vtu");
        self.cells(particles, laws).write(&path)
    }

    fn cells(&self, particles: &Particles<2>, laws: &[SharedLaw]) -> UnstructuredGrid {
        let utilisation = fields::values(Field::Utilisation, particles, laws);
        let carried = carried(particles, laws);
        let extras = Extras {
            utilisation: Some(&utilisation),
            carried: &carried,
            def_grad: true,
            pore_water: self.pore_water,
        };
        of_particles(particles, &extras)
    }

    /// Waits until the disk has every frame: before a checkpoint that counts on them.
    ///
    /// # Errors
    /// [`CaseError::File`].
    pub fn sync(&mut self) -> Result<(), CaseError> {
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
        let collections = [&self.particles, &self.grid].into_iter().chain(&self.rigid);
        let files: Vec<_> = collections
            .flat_map(new)
            .map(open)
            .collect::<Result<_, CaseError>>()?;
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
/// Strength and stiffness of the particles, where they are not those of the materials everywhere.
fn carried(particles: &Particles<2>, laws: &[SharedLaw]) -> Vec<(&'static str, Vec<f64>)> {
    let varies = particles.ratios.iter().any(|ratios| !ratios.are_one());
    let arrays = [
        ("strength [Pa]", Field::Strength),
        ("friction angle [rad]", Field::Friction),
        ("Young's modulus [Pa]", Field::Young),
    ];
    let arrays = arrays.into_iter().filter(|_| varies);
    arrays
        .map(|(name, field)| (name, fields::values(field, particles, laws)))
        .collect()
}
