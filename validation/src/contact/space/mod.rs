//! Contact in space: the checks of the plane, turned about all axes.

pub(crate) mod circle;
mod patch;
mod slide;
pub(crate) mod sphere;

use std::path::Path;

use igimp_assembly::{Constraints, ParticleSeed};
use igimp_cases::CaseError;
use igimp_shape::{Axis, Grid, ShapeError};

use crate::continuum::laboratory::filled;
use crate::harness::study::{Level, Study};

/// The book's description of the study.
const ABOUT: &str = "Contact in space, in the bands of the plane: a smooth plate that is turned about the vertical presses a block evenly, with its surface anywhere in its cell; below a plate that is turned about all axes the error falls with the cell; a block slides down an incline in any direction at tan β = μ, and a plate that is pressed and pushed in any direction at H = μ V + a A.";

/// Level ground with its surface at z = 0, in a quarter with planes of symmetry at x = 0 and y = 0, and the
/// grid around it.
struct Quarter {
    seeds: Vec<ParticleSeed<3>>,
    grid: Grid<3>,
}

impl Quarter {
    /// Ground between lines of a grid along x and y, and along z, with 2³ particles in a cell and three layers of
    /// cells above it.
    fn new(sideways: &[f64], mut upward: Vec<f64>) -> Result<Self, ShapeError> {
        let across = || Axis::from_nodes(sideways.to_vec());
        let soil = Grid::new([across()?, across()?, Axis::from_nodes(upward.clone())?]);
        let cells = soil.axes[2].cell_count();
        let (top, size) = (soil.axes[2].end(), soil.axes[2].spacing(cells - 1));
        upward.extend((1..=3).map(|layer| top + size * f64::from(layer)));
        let grid = Grid::new([across()?, across()?, Axis::from_nodes(upward)?]);
        let seeds = filled(&soil, 2);
        Ok(Self { seeds, grid })
    }

    /// Walls that hold the sides sideways and the bottom in all directions.
    fn held(&self) -> Result<Constraints<3>, CaseError> {
        let mut constraints = Constraints::free(&self.grid);
        for axis in 0..2 {
            constraints.fix_wall(&self.grid, axis, false, axis)?;
            constraints.fix_wall(&self.grid, axis, true, axis)?;
        }
        for axis in 0..3 {
            constraints.fix_wall(&self.grid, 2, false, axis)?;
        }
        Ok(constraints)
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-space", ABOUT, out)?;
    patch::check(&mut study, level)?;
    slide::check(&mut study)?;
    Ok(study)
}
