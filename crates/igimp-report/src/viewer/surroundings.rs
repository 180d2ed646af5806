//! Data of a case that its frames do not hold: the edges of its bodies, and its water.

use std::path::Path;
use std::sync::Arc;

use igimp_model::{Case, Stage, in_plane};
use igimp_results::paraview::pvd;

use super::over::{Over, by_stage};
use crate::outlines::Outlines;
use crate::patches::Pieces;

/// The bodies of a case as frames are drawn with them.
#[derive(Clone, Debug)]
pub enum Bodies {
    /// In the plane: pieces and edges.
    Plane(Arc<Pieces>),
    /// In space: edges.
    Space(Outlines),
}

impl Bodies {
    /// The bodies of a case; none where they cannot be seeded.
    pub fn of<const D: usize>(case: &Case<D>) -> Option<Self> {
        if let Some(case) = in_plane::<Case<D>, Case<2>>(case) {
            return Pieces::of(case).ok().map(Arc::new).map(Self::Plane);
        }
        let case = in_plane::<Case<D>, Case<3>>(case)?;
        Outlines::of(case).ok().map(Self::Space)
    }
}

/// Bodies, stages and water that the frames of a report are drawn with.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    pub(super) bodies: Option<Bodies>,
    pub(super) stages: Vec<Stage>,
    pub(super) over: Vec<Over>,
}

impl Surroundings {
    /// Those of the frames of a results folder, with the bodies in pieces where these are known already; nothing where there
    /// are no frames.
    pub fn of<const D: usize>(case: &Case<D>, folder: &Path, pieces: Option<Arc<Pieces>>) -> Self {
        let frames = pvd::frames(&folder.join("paraview"), pvd::PARTICLES);
        if frames.is_none_or(|found| found.is_empty()) {
            return Self::default();
        }
        Self {
            bodies: pieces.map(Bodies::Plane).or_else(|| Bodies::of(case)),
            stages: case.stages.clone(),
            over: by_stage(case, folder),
        }
    }
}
