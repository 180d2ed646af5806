//! A rigid strip footing pushed one width deep into Tresca soil: resistance against penetration
//! (Yuan et al. 2021, fourth benchmark; set-up after Kardani et al. 2015).
//!
//! The grid follows the footing. At the start of each step the rows at or below the initial
//! surface are compressed to `y₀ (D − w)/D` and the rows above are shifted by −w, so that the base
//! is always a row of nodes. The footing's edge lies in the middle of a cell.

use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Constraints, Method, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_material::{Elasticity, Tresca};
use igimp_shape::{Axis, Grid};
use igimp_solver::{
    Accepted, Body, MarchReport, MarchSettings, Workspace, linear::SolverKind, march,
};

use crate::error::CaseError;
use crate::parameter::{at_least_one, not_negative, positive};
use crate::seed::fill_polygon;
use crate::table::Table;

/// Parameters of the footing, half model; SI units.
#[derive(Clone, Debug)]
pub struct Footing {
    /// Variant of the method.
    pub method: Method,
    /// Width B of the whole footing \[m\].
    pub width: f64,
    /// Cells per width B/h, odd so that the edge lies mid-cell.
    pub cells_per_width: usize,
    /// Breadth of the half model and depth of the soil, in widths \[-\].
    pub extent: usize,
    /// Height of the grid above the surface, in widths \[-\].
    pub room: f64,
    /// Whether soil sticks to base and shaft.
    pub rough: bool,
    /// Young's modulus \[Pa\].
    pub young: f64,
    /// Poisson's ratio \[-\].
    pub poisson: f64,
    /// Undrained strength s_u \[Pa\].
    pub undrained_strength: f64,
    /// Particles per cell and direction.
    pub per_direction: usize,
    /// Penetration w at the end, over B \[-\].
    pub penetration: f64,
    /// Load steps.
    pub steps: usize,
}

impl Default for Footing {
    fn default() -> Self {
        Self {
            method: Method::default(),
            width: 1.0,
            cells_per_width: 9,
            extent: 5,
            room: 1.0,
            rough: true,
            young: 100e3,
            poisson: 0.495,
            undrained_strength: 1e3,
            per_direction: 3,
            penetration: 1.0,
            steps: 75,
        }
    }
}

/// The footing after its push.
#[derive(Clone, Debug)]
pub struct FootingResult {
    /// The particles at the last equilibrium.
    pub particles: Particles<2>,
    /// w/B against N = resistance / (B s_u), compression positive.
    pub resistance: Table,
    /// Penetration reached over B \[-\].
    pub reached: f64,
    /// The steps.
    pub report: MarchReport,
}

impl FootingResult {
    /// N at a penetration w/B, linear between steps \[-\]; not a number beyond the last step.
    pub fn resistance_at(&self, penetration: f64) -> f64 {
        let rows = &self.resistance.rows;
        rows.windows(2)
            .find(|pair| pair[0][0] <= penetration && penetration <= pair[1][0] + 1e-12)
            .map_or(f64::NAN, |pair| {
                let t = (penetration - pair[0][0]) / (pair[1][0] - pair[0][0]);
                pair[0][1] + t * (pair[1][1] - pair[0][1])
            })
    }
}

impl Footing {
    /// Cell size h \[m\].
    pub fn cell(&self) -> f64 {
        self.width / self.cells_per_width as f64
    }

    /// Pushes the footing.
    ///
    /// # Errors
    /// [`CaseError`] for parameters that make no sense. A push that finds no equilibrium is a
    /// result.
    pub fn run(&self) -> Result<FootingResult, CaseError> {
        self.validate()?;
        let depth = self.width * self.extent as f64;
        let grid = self.grid(0.0)?;
        let polygon = [[0.0, 0.0], [depth, 0.0], [depth, depth], [0.0, depth]];
        let seeds = fill_polygon(&grid, &polygon, self.per_direction, 0.0, 0)?;
        let mut body = Body::new(Particles::new(&seeds)?);
        let law = Tresca::new(
            Elasticity::new(self.young, self.poisson)?,
            self.undrained_strength,
        )?;
        let laws: Vec<SharedLaw> = vec![Arc::new(law)];
        let push = self.penetration * self.width;
        let scale = 0.5 * self.width * self.undrained_strength;
        let mut resistance = Table::new(
            "resistance",
            &["penetration_w/B_[-]", "resistance_N_[-]_compression_+"],
        );
        resistance.push(vec![0.0, 0.0]);
        let report = march(
            &mut body,
            &self.method,
            &|from: f64, to: f64| self.conditions(&laws, from * push, to * push),
            &MarchSettings::steps(self.steps),
            &mut Workspace::new(SolverKind::Auto.build()),
            &mut |accepted: &Accepted<'_, 2>| {
                let grid = &accepted.conditions.grid;
                let force: f64 = (0..grid.node_count())
                    .filter(|&node| self.part_of_footing(grid.node_place(node)).is_some())
                    .map(|node| accepted.forces.reactions[node][1])
                    .sum();
                resistance.push(vec![accepted.report.to * self.penetration, -force / scale]);
                ControlFlow::Continue(())
            },
        );
        Ok(FootingResult {
            particles: body.particles,
            reached: report.reached() * self.penetration,
            resistance,
            report,
        })
    }

    fn validate(&self) -> Result<(), CaseError> {
        at_least_one("extent", self.extent)?;
        at_least_one("per_direction", self.per_direction)?;
        at_least_one("steps", self.steps)?;
        positive("width", self.width)?;
        not_negative("room", self.room)?;
        if self.cells_per_width.is_multiple_of(2) {
            return Err(CaseError::InvalidParameter {
                field: "cells_per_width",
                value: self.cells_per_width as f64,
                requirement: "odd, so that the footing's edge lies in the middle of a cell",
            });
        }
        if !(self.penetration > 0.0 && self.penetration < self.extent as f64) {
            return Err(CaseError::InvalidParameter {
                field: "penetration",
                value: self.penetration,
                requirement: "positive and less than the depth of the soil, in widths",
            });
        }
        Ok(())
    }

    fn surface_row(&self) -> usize {
        self.extent * self.cells_per_width
    }

    /// The grid for a penetration w \[m\].
    fn grid(&self, w: f64) -> Result<Grid<2>, igimp_shape::ShapeError> {
        let h = self.cell();
        let depth = self.width * self.extent as f64;
        let columns = self.extent * self.cells_per_width;
        let above =
            (self.room * self.cells_per_width as f64).ceil() as usize + (w / h).ceil() as usize;
        let rows = (0..=self.surface_row() + above)
            .map(|row| {
                let y0 = row as f64 * h;
                if row <= self.surface_row() {
                    y0 * (depth - w) / depth
                } else {
                    y0 - w
                }
            })
            .collect();
        Ok(Grid::new([
            Axis::uniform(0.0, h, columns)?,
            Axis::from_nodes(rows)?,
        ]))
    }

    /// Whether a node belongs to the footing; `Some(true)` on its base.
    fn part_of_footing(&self, [column, row]: [usize; 2]) -> Option<bool> {
        let inside = 2 * column < self.cells_per_width && row >= self.surface_row();
        inside.then_some(row == self.surface_row())
    }

    fn conditions(
        &self,
        laws: &[SharedLaw],
        from: f64,
        to: f64,
    ) -> Result<StepConditions<2>, AssemblyError> {
        let grid = self
            .grid(from)
            .map_err(|source| AssemblyError::Grid { source })?;
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0);
        constraints.fix_wall(&grid, 0, true, 0);
        constraints.fix_wall(&grid, 1, false, 1);
        for node in 0..grid.node_count() {
            let Some(base) = self.part_of_footing(grid.node_place(node)) else {
                continue;
            };
            if self.rough || base {
                constraints.prescribe(node, 1, from - to)?;
            }
            if self.rough || !base {
                constraints.prescribe(node, 0, 0.0)?;
            }
        }
        Ok(StepConditions {
            grid,
            constraints,
            loads: StepLoads {
                gravity: [0.0; 2],
                factors: Vec::new(),
                drag: 0.0,
            },
            laws: laws.to_vec(),
        })
    }
}
