//! What the two slopes share: geometry, grid, walls and the gravity program.

use igimp_assembly::{Constraints, SharedLaw, StepConditions, StepLoads};
use igimp_shape::{Axis, Grid};

use crate::error::CaseError;
use crate::parameter::{not_negative, positive};
use crate::polygon::Polygon;

/// Acceleration of gravity that a unit weight refers to \[m/s²\].
pub const GRAVITY: f64 = 9.81;

/// A plane slope that falls from left to right, on a foundation of the same soil \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeGeometry {
    /// Height H of the slope.
    pub height: f64,
    /// Horizontal length of the slope.
    pub run: f64,
    /// Length of the crest.
    pub crest: f64,
    /// Length of the ground beyond the toe.
    pub toe: f64,
    /// Depth of the foundation below the toe.
    pub foundation: f64,
}

impl SlopeGeometry {
    /// Checks the lengths.
    pub(crate) fn validate(&self) -> Result<(), CaseError> {
        positive("geometry.height", self.height)?;
        not_negative("geometry.run", self.run)?;
        not_negative("geometry.crest", self.crest)?;
        not_negative("geometry.toe", self.toe)?;
        not_negative("geometry.foundation", self.foundation)
    }

    /// Outline, counter-clockwise from the origin at the lower left.
    pub fn polygon(&self) -> Polygon {
        let width = self.crest + self.run + self.toe;
        let top = self.foundation + self.height;
        let mut polygon = vec![[0.0, 0.0], [width, 0.0]];
        if self.foundation > 0.0 {
            polygon.push([width, self.foundation]);
        }
        if self.toe > 0.0 || self.foundation == 0.0 {
            polygon.push([self.crest + self.run, self.foundation]);
        }
        polygon.extend([[self.crest, top], [0.0, top]]);
        polygon.dedup();
        polygon
    }

    /// A uniform grid over the slope, with `room` beyond its toe and above its crest.
    ///
    /// # Errors
    /// [`CaseError::Shape`] for a cell size that makes no grid.
    pub fn grid(&self, cell: f64, room: f64) -> Result<Grid<2>, CaseError> {
        let cells = |length: f64| ((length / cell) - 1e-9).ceil().max(0.0) as usize;
        let width = self.crest + self.run + self.toe;
        let top = self.foundation + self.height;
        let beyond = if self.toe > 0.0 { 0.0 } else { room };
        Ok(Grid::new([
            Axis::uniform(0.0, cell, cells(width + beyond))?,
            Axis::uniform(0.0, cell, cells(top) + 1)?,
        ]))
    }

    /// Rollers on both sides, everything held at the base.
    pub fn walls(&self, grid: &Grid<2>) -> Constraints<2> {
        let mut constraints = Constraints::free(grid);
        constraints.fix_wall(grid, 0, false, 0);
        constraints.fix_wall(grid, 0, true, 0);
        constraints.fix_wall(grid, 1, false, 0);
        constraints.fix_wall(grid, 1, false, 1);
        constraints
    }
}

/// Conditions of a step on a fixed grid under a factor on gravity.
pub(crate) fn under_gravity(
    grid: &Grid<2>,
    constraints: &Constraints<2>,
    laws: &[SharedLaw],
    factor: f64,
) -> StepConditions<2> {
    StepConditions {
        grid: grid.clone(),
        constraints: constraints.clone(),
        loads: StepLoads {
            gravity: [0.0, -factor * GRAVITY],
            factors: Vec::new(),
            drag: 0.0,
        },
        laws: laws.to_vec(),
    }
}
