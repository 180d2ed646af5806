//! An expanding thick sphere, and a cavity in much ground, at large strain.

use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Constraints, Method, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_figures::{Colour, CurvePlot, Series};
use igimp_geometry::seed::fill;
use igimp_geometry::solid::{Difference, Solid, Sphere};
use igimp_material::{Elasticity, VonMises};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use super::Octant;
use crate::contact::graded;
use crate::continuum::laboratory::run;
use crate::exact::sphere::ThickSphere;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A thick sphere of nearly incompressible elastic-plastic soil, an eighth of it, is expanded from within by a fifth of its radius, and a cavity in eight times as much ground across by a half. The pressure is held against the exact curve at finite strain once all of the sphere yields, and once the cavity is wider by a fifth, about a cell; before that it is told.";
const SPHERE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "expanding incompressible thick sphere, Hencky elasticity",
    locator: "p = ∫ 2 min(6G ln(r/R), 2 s_u) dr/r with r³ − R³ = a³ − a₀³",
};
/// Poisson's ratio: nearly incompressible \[-\].
const POISSON: f64 = 0.499;
/// How far the pressure may be from the exact one \[-\].
const SHARE: f64 = 0.015;

/// One expansion.
#[derive(Clone, Copy, Debug)]
struct Expansion {
    name: &'static str,
    exact: ThickSphere,
    /// Inner radius at the end over that at the start \[-\].
    to: f64,
    steps: usize,
    /// Cells along the initial inner radius.
    cells: usize,
    /// Up to where cells are equal; beyond, each is longer by a fifth than the one before \[length\].
    fine: f64,
    /// Particles in a cell along one direction.
    points: usize,
    /// Inner radius over that at the start from which on the pressure is held against the exact one although ground beyond does
    /// not yield \[-\].
    held_from: f64,
    /// Lowest level at which it is run.
    least: Level,
}

/// A thick sphere, b₀ = 2 a₀.
const fn thick(
    name: &'static str,
    shear: f64,
    cells: usize,
    points: usize,
    least: Level,
) -> Expansion {
    Expansion {
        name,
        exact: ThickSphere {
            inner: 1.0,
            outer: 2.0,
            shear,
            strength: 1.0,
        },
        to: 1.2,
        steps: 40,
        cells,
        fine: f64::INFINITY,
        points,
        held_from: f64::INFINITY,
        least,
    }
}

/// A cavity in ground that reaches eight of its radii far: more than yields until it is half as wide again.
const fn cavity(name: &'static str, shear: f64, cells: usize) -> Expansion {
    let mut expansion = thick(name, shear, cells, 3, Level::Full);
    expansion.exact.outer = 8.0;
    expansion.to = 1.5;
    expansion.fine = 2.0;
    expansion.held_from = 1.2;
    expansion
}

static EXPANSIONS: [Expansion; 8] = [
    thick("thick, I_r = 100", 100.0, 3, 3, Level::Quick),
    thick("thick, I_r = 100", 100.0, 5, 3, Level::Full),
    thick("thick, I_r = 33", 100.0 / 3.0, 3, 3, Level::Default),
    thick("thick, I_r = 33", 100.0 / 3.0, 5, 3, Level::Full),
    cavity("cavity, I_r = 100", 100.0, 4),
    cavity("cavity, I_r = 100", 100.0, 5),
    cavity("cavity, I_r = 33", 100.0 / 3.0, 4),
    cavity("cavity, I_r = 33", 100.0 / 3.0, 5),
];

impl Expansion {
    fn variant(&self) -> String {
        format!(
            "{}, a₀/h = {}, {}³ particles a cell",
            self.name, self.cells, self.points
        )
    }

    /// Inner radius at a load factor \[length\].
    fn radius(&self, factor: f64) -> f64 {
        self.exact.inner * (1.0 + factor * (self.to - 1.0))
    }

    fn grid(&self) -> Result<Grid<3>, CaseError> {
        let cell = self.exact.inner / self.cells as f64;
        let reach = self.exact.outer_at(self.radius(1.0));
        let fine = (reach.min(self.fine) / cell).ceil() * cell;
        // The last of the growing cells may end half a cell early.
        let end = if fine < reach { 1.15 * reach } else { fine };
        let lines = graded(cell, [0.0, fine], [0.0, end], 1.2);
        let axis = || Axis::from_nodes(lines.clone());
        Ok(Grid::new([axis()?, axis()?, axis()?]))
    }

    /// Runs it; the table has radius, pressure and exact pressure.
    fn run(&self) -> Result<(RunRecord, Table), CaseError> {
        let grid = self.grid()?;
        let ball = |radius| {
            Solid::Sphere(Sphere {
                centre: [0.0; 3],
                radius,
            })
        };
        let shell = Octant(Solid::Difference(Difference {
            of: Box::new(ball(self.exact.outer)),
            minus: vec![ball(self.exact.inner)],
        }));
        let seeds = fill(&grid, &shell, self.points, 1.0, 0)?;
        let mut body = Body::new(Particles::new(&seeds)?);
        let young = 2.0 * (1.0 + POISSON) * self.exact.shear;
        let elasticity = Elasticity::new(young, POISSON)?;
        // 2 s_u in triaxial compression.
        let plane_strain = 2.0 * self.exact.strength / 3.0_f64.sqrt();
        let law: SharedLaw = Arc::new(VonMises::from_undrained_strength(elasticity, plane_strain)?);
        let load_path = |from: f64, to: f64| {
            StepConditions::new(
                grid.clone(),
                Self::driven(&grid, self.radius(from), self.radius(to))?,
                StepLoads::gravity([0.0; 3]),
                vec![Arc::clone(&law)],
            )
        };
        let mut curve = Table::new(
            format!(
                "pressure_{}_{}",
                self.name.replace([' ', ',', '='], ""),
                self.cells
            ),
            &["inner_radius_[-]", "pressure_[s_u]", "exact_[s_u]"],
        );
        let mut observe = |accepted: &Accepted<'_, 3>| {
            let a = self.radius(accepted.report.to);
            curve.push(vec![a, pressure(accepted), self.exact.pressure(a)]);
            ControlFlow::Continue(())
        };
        let settings = MarchSettings::steps(self.steps);
        let (run, _) = run(
            self.variant(),
            &mut body,
            &Method::igimp_bbar(),
            &settings,
            &load_path,
            &mut observe,
        );
        Ok((run, curve))
    }

    /// Planes of symmetry, and the exact motion r'³ = r³ + a'³ − a³ of all nodes within the cavity. Cells
    /// of which all nodes were driven would not keep their volume.
    fn driven(grid: &Grid<3>, from: f64, to: f64) -> Result<Constraints<3>, AssemblyError> {
        let mut constraints = Constraints::free(grid);
        for axis in 0..3 {
            constraints.fix_wall(grid, axis, false, axis)?;
        }
        let added = to.powi(3) - from.powi(3);
        for node in 0..grid.node_count() {
            let x = grid.node_position(node);
            let r = radius(x);
            if r > 0.0 && r <= from {
                let stretch = (r.powi(3) + added).cbrt() / r;
                for (axis, x) in x.into_iter().enumerate() {
                    constraints.prescribe(node, axis, (stretch - 1.0) * x)?;
                }
            }
        }
        Ok(constraints)
    }
}

fn radius(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The pressure within that does the work of the reactions on the motion v = x/r³, which keeps the volume:
/// `Σ R·v = p π/2` for an eighth \[force/length²\].
fn pressure(accepted: &Accepted<'_, 3>) -> f64 {
    let grid = &accepted.conditions.grid;
    let mut work = 0.0;
    for (node, reaction) in accepted.forces.reactions.iter().enumerate() {
        let (x, u) = (grid.node_position(node), accepted.forces.u[node]);
        let now: [f64; 3] = std::array::from_fn(|axis| x[axis] + u[axis]);
        let r = radius(now);
        if r > 0.0 {
            let along: f64 = reaction.iter().zip(now).map(|(force, x)| force * x).sum();
            work += along / r.powi(3);
        }
    }
    work / FRAC_PI_2
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("space-sphere", ABOUT, out)?;
    let jobs: Vec<&Expansion> = EXPANSIONS
        .iter()
        .filter(|expansion| expansion.least <= level)
        .collect();
    let done = jobs
        .par_iter()
        .map(|expansion| expansion.run())
        .collect::<Result<Vec<_>, CaseError>>()?;
    let exact = (0..=200)
        .map(|k| {
            let a = 1.0 + 0.001 * f64::from(k);
            [a, EXPANSIONS[0].exact.pressure(a)]
        })
        .collect();
    let mut shown = vec![Series::line("exact", exact).in_colour(Colour::BLACK)];
    for (job, (record, curve)) in jobs.into_iter().zip(done) {
        let run = study.run_to_end(record);
        for a in [1.01, 1.02, 1.05, 1.1, 1.2, 1.5] {
            let Some(row) = curve.rows.iter().find(|row| (row[0] - a).abs() < 1e-9) else {
                continue;
            };
            let quantity = format!("p/s_u at a = {a} a₀ [-]");
            let all_yields = job.exact.yields_to(a) >= job.exact.outer_at(a);
            if all_yields || a >= job.held_from {
                let expected = SPHERE.says(row[2]);
                study.check(run, quantity, expected, Band::Relative(SHARE), row[1]);
            } else {
                study.notes.push(format!(
                    "space-sphere, {}: {quantity} is {:.4}, exact {:.4}",
                    job.variant(),
                    row[1],
                    row[2]
                ));
            }
        }
        if job.name == EXPANSIONS[0].name {
            let label = format!("a_{{0}}/h = {}", job.cells);
            shown.push(Series::markers(label, curve.points(0, 1)));
        }
        curve.write_csv(&study.folder)?;
    }
    CurvePlot {
        title: "Expanding thick sphere, b_{0} = 2 a_{0}, G/s_{u} = 100".into(),
        x_label: "inner radius / a_{0}".into(),
        y_label: "pressure within / s_{u}".into(),
        series: shown,
        ..CurvePlot::default()
    }
    .write(&study.folder.join("pressure"))?;
    Ok(study)
}
