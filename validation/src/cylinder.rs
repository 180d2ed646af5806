//! Expanding cylinders: a thick one, and a cavity in soil without end, at large strain.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{AssemblyError, Constraints, Method, Particles, SharedLaw, StepConditions, StepLoads};
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::figures::{Colour, CurvePlot, Series};
use igimp_cases::seed::fill_polygon;
use igimp_cases::table::Table;
use igimp_material::{Elasticity, VonMises};
use igimp_shape::Grid;
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use crate::exact::cylinder::ThickCylinder;
use crate::laboratory::{grid_of, run};
use crate::oracle::{Oracle, OracleKind};
use crate::study::{Level, Run, Study};

/// Corners of the polygon along a quarter of a circle; its area is right to 1e-5.
const ARC: usize = 200;
/// Poisson's ratio: nearly incompressible \[-\].
const POISSON: f64 = 0.4999;

/// One expansion.
#[derive(Clone, Debug)]
struct Expansion {
    exact: ThickCylinder,
    /// Inner radius at the end over that at the start \[-\].
    to: f64,
    steps: usize,
    /// Cells along the initial inner radius.
    cells: usize,
    /// Particles in a cell along one direction.
    points: usize,
    method: Method,
}

impl Expansion {
    /// Inner radius at a load factor \[length\].
    fn radius(&self, factor: f64) -> f64 {
        self.exact.inner * (1.0 + factor * (self.to - 1.0))
    }

    /// Runs it; the table has radius, pressure and exact pressure.
    fn run(&self, name: &str) -> Result<(Run, Table), CaseError> {
        let cell = self.exact.inner / self.cells as f64;
        let reach = self.exact.outer_at(self.radius(1.0)) + cell;
        let grid = grid_of(cell, [(reach / cell).ceil() as usize; 2])?;
        let polygon = quarter_ring(self.exact.inner, self.exact.outer);
        let seeds = fill_polygon(&grid, &polygon, self.points, 1.0, 0)?;
        let mut body = Body::new(Particles::new(&seeds)?);
        let young = 2.0 * (1.0 + POISSON) * self.exact.shear;
        let elasticity = Elasticity::new(young, POISSON)?;
        let law: SharedLaw = Arc::new(VonMises::from_undrained_strength(
            elasticity,
            self.exact.strength,
        )?);
        let program = |from: f64, to: f64| {
            Ok(StepConditions {
                constraints: self.driven(&grid, self.radius(from), self.radius(to))?,
                grid: grid.clone(),
                loads: StepLoads::gravity([0.0; 2]),
                laws: vec![Arc::clone(&law)],
            })
        };
        let header = ["inner_radius_[-]", "pressure_[s_u]", "exact_[s_u]"];
        let mut curve = Table::new(format!("pressure_{name}"), &header);
        let mut observe = |accepted: &Accepted<'_, 2>| {
            let a = self.radius(accepted.report.to);
            let unit = self.exact.strength;
            let pressure = pressure(accepted) / unit;
            curve.push(vec![a, pressure, self.exact.pressure(a) / unit]);
            ControlFlow::Continue(())
        };
        let variant = format!("{}, a₀/h = {}", self.method.label(), self.cells);
        let settings = MarchSettings::steps(self.steps);
        let (run, _) = run(variant, &mut body, &self.method, &settings, &program, &mut observe);
        Ok((run, curve))
    }

    /// Planes of symmetry, and the exact motion r'² = r² + a'² − a² of all nodes within the cavity.
    fn driven(&self, grid: &Grid<2>, from: f64, to: f64) -> Result<Constraints<2>, AssemblyError> {
        let mut constraints = Constraints::free(grid);
        constraints.fix_wall(grid, 0, false, 0);
        constraints.fix_wall(grid, 1, false, 1);
        let added = to * to - from * from;
        for node in 0..grid.node_count() {
            let x = grid.node_position(node);
            let r = x[0].hypot(x[1]);
            if r > 0.0 && r <= from * (1.0 + 1e-9) {
                let stretch = (r * r + added).sqrt() / r;
                for axis in 0..2 {
                    constraints.prescribe(node, axis, (stretch - 1.0) * x[axis])?;
                }
            }
        }
        Ok(constraints)
    }
}

/// The pressure within that does the work of the reactions on the motion v = x/r², which keeps the
/// volume: `Σ R·v = p π/2` for a quarter \[force/length²\].
fn pressure(accepted: &Accepted<'_, 2>) -> f64 {
    let grid = &accepted.conditions.grid;
    let mut work = 0.0;
    for (node, reaction) in accepted.forces.reactions.iter().enumerate() {
        let (x, u) = (grid.node_position(node), accepted.forces.u[node]);
        let now = [x[0] + u[0], x[1] + u[1]];
        let square = now[0] * now[0] + now[1] * now[1];
        if square > 0.0 {
            work += (reaction[0] * now[0] + reaction[1] * now[1]) / square;
        }
    }
    work / FRAC_PI_2
}

/// A quarter of a ring around the origin.
fn quarter_ring(inner: f64, outer: f64) -> Vec<[f64; 2]> {
    let at = |radius: f64, k: usize| {
        let (sine, cosine) = (0.5 * PI * k as f64 / ARC as f64).sin_cos();
        let rounded = |value: f64| if value < 1e-12 { 0.0 } else { value };
        [radius * rounded(cosine), radius * rounded(sine)]
    };
    let outside = (0..=ARC).map(|k| at(outer, k));
    outside.chain((0..=ARC).rev().map(|k| at(inner, k))).collect()
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("cylinder", "", out)?;
    let exact = ThickCylinder { inner: 1.0, outer: 2.0, shear: 100.0, strength: 1.0 };
    let mut jobs = vec![];
    for (method, points) in [(Method::igimp_bbar(), 2), (Method::igimp_bbar(), 3), (Method::igimp(), 2), (Method::impm_bbar(), 2)] {
        for cells in [4, 8, 16] {
            for steps in [25, 50] {
            jobs.push(Expansion { exact, to: 1.5, steps, cells, points, method: method.clone() });
            }
        }
    }
    let soft = ThickCylinder { inner: 1.0, outer: 8.0, shear: 100.0/3.0, strength: 1.0 };
    for (cells, points) in [(2, 2), (2, 3), (4, 2), (4,3)] {
            jobs.push(Expansion { exact: soft, to: 4.0, steps: 60, cells, points, method: Method::igimp_bbar() });
    }
    let _ = level;
    for job in &jobs {
        let (run, curve) = job.run("x")?;
        eprintln!("{} points {} steps {} {} cuts {} {:.1} s", run.variant, job.points, job.steps, run.outcome, run.cuts, run.seconds);
        let n = curve.rows.len();
        for row in curve.rows.iter().step_by((n / 10).max(1)) {
            eprintln!("   {:.3} {:.4} {:.4} {:+.2} %", row[0], row[1], row[2], 100.0 * (row[1] / row[2] - 1.0));
        }
        if let Some(row) = curve.rows.last() {
            eprintln!("   {:.3} {:.4} {:.4} {:+.2} %", row[0], row[1], row[2], 100.0 * (row[1] / row[2] - 1.0));
        }
        study.run(run);
    }
    Ok(study)
}
