//! Torsion of bars, round and square, up to full yield.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Constraints, Method, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_geometry::seed::fill;
use igimp_geometry::solid::{Cylinder, Solid};
use igimp_material::{Elasticity, VonMises};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::Grid;
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use super::Octant;
use crate::continuum::laboratory::{grid_of, run};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A quarter of a bar, round or square, is twisted: its ends turn, and their sections are free to warp. The torque is held against the exact one, elastic, in between, and fully plastic.";
const SAINT_VENANT: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "torsion after Saint-Venant",
    locator: "T = G θ J, round J = π R⁴/2, square J = 0.140577 a⁴",
};
const NADAI: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "plastic torsion, Nádai's sand heap",
    locator: "round (2π k R³/3) (1 − (c/R)³/4), c = k/(Gθ); square k a³/3 once all of it yields",
};
/// Shear modulus over strength.
const SHEAR: f64 = 1000.0;
/// Poisson's ratio \[-\].
const POISSON: f64 = 0.3;
/// Largest elastic shear strain of the run over the strain at yield \[-\].
const TWIST: f64 = 20.0;
/// Steps of a run.
const STEPS: usize = 80;

/// A section with a half width or radius of 1.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Section {
    Round,
    Square,
}

/// One bar.
#[derive(Clone, Copy, Debug)]
struct Bar {
    section: Section,
    /// Cells along half the width.
    cells: usize,
    /// Particles in a cell along one direction.
    points: usize,
    least: Level,
}

const fn bar(section: Section, cells: usize, points: usize, least: Level) -> Bar {
    Bar {
        section,
        cells,
        points,
        least,
    }
}

static BARS: [Bar; 6] = [
    bar(Section::Round, 8, 3, Level::Quick),
    bar(Section::Square, 8, 2, Level::Quick),
    bar(Section::Round, 16, 3, Level::Default),
    bar(Section::Square, 16, 2, Level::Full),
    bar(Section::Round, 24, 3, Level::Full),
    bar(Section::Square, 24, 2, Level::Full),
];

impl Bar {
    fn variant(&self) -> String {
        let section = match self.section {
            Section::Round => "round, R",
            Section::Square => "square, a/2",
        };
        format!(
            "{section}/h = {}, {}³ particles a cell",
            self.cells, self.points
        )
    }

    fn length(&self) -> f64 {
        1.0 / self.cells as f64
    }

    /// Twist per length at a load factor; yield begins at the rim of the round bar at `factor = 1/TWIST`.
    fn twist(factor: f64) -> f64 {
        factor * TWIST / SHEAR
    }

    /// Torque of the elastic bar, and of the one that yields where its strain goes beyond yield: for the square bar
    /// once all of it yields \[strength·length³\].
    fn exact(&self, twist: f64) -> [f64; 2] {
        match self.section {
            Section::Round => {
                let core = (1.0 / (SHEAR * twist)).min(1.0);
                [
                    0.5 * PI * SHEAR * twist,
                    2.0 / 3.0 * PI * (1.0 - 0.25 * core.powi(3)),
                ]
            }
            Section::Square => [0.140_577 * 16.0 * SHEAR * twist, 8.0 / 3.0],
        }
    }

    /// Runs it; the table has twist and torque.
    fn run(&self) -> Result<(RunRecord, Table), CaseError> {
        let h = self.length();
        let cells = self.cells + usize::from(self.section == Section::Round);
        let grid = grid_of(h, [cells, cells, 1])?;
        let section = Octant(match self.section {
            Section::Round => Solid::Cylinder(Cylinder {
                axis: 2,
                centre: [0.0; 2],
                radius: 1.0,
                between: [0.0, h],
            }),
            Section::Square => Solid::Cuboid([0.0; 3], [1.0, 1.0, h]),
        });
        let seeds = fill(&grid, &section, self.points, 1.0, 0)?;
        let mut body = Body::new(Particles::new(&seeds)?);
        let elasticity = Elasticity::new(2.0 * (1.0 + POISSON) * SHEAR, POISSON)?;
        let law: SharedLaw = Arc::new(VonMises::from_undrained_strength(elasticity, 1.0)?);
        let load_path = |from: f64, to: f64| {
            StepConditions::new(
                grid.clone(),
                Self::turned(&grid, h * (Self::twist(to) - Self::twist(from)))?,
                StepLoads::gravity([0.0; 3]),
                vec![Arc::clone(&law)],
            )
        };
        let mut curve = Table::new(
            format!("torque_{:?}_{}", self.section, self.cells).to_lowercase(),
            &["twist_over_that_at_yield_[-]", "torque_[k]"],
        );
        let mut observe = |accepted: &Accepted<'_, 3>| {
            let twist = Self::twist(accepted.report.to);
            curve.push(vec![SHEAR * twist, torque(accepted)]);
            ControlFlow::Continue(())
        };
        let settings = MarchSettings::steps(STEPS);
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

    /// The lower end held, the upper one turned by so much, both free to warp; and the planes x = 0 and y = 0, on which
    /// only the displacement across is free.
    fn turned(grid: &Grid<3>, angle: f64) -> Result<Constraints<3>, AssemblyError> {
        let mut constraints = Constraints::free(grid);
        for (normal, held) in [(0, 1), (1, 0)] {
            constraints.fix_wall(grid, normal, false, held)?;
            constraints.fix_wall(grid, normal, false, 2)?;
        }
        let (sine, cosine) = angle.sin_cos();
        for node in 0..grid.node_count() {
            let [x, y, z] = grid.node_position(node);
            let moved = if z > 0.0 {
                [(cosine - 1.0) * x - sine * y, sine * x + (cosine - 1.0) * y]
            } else {
                [0.0; 2]
            };
            for (axis, moved) in moved.into_iter().enumerate() {
                constraints.prescribe(node, axis, moved)?;
            }
        }
        Ok(constraints)
    }
}

/// The torque at the upper end of the whole bar \[force·length\].
fn torque(accepted: &Accepted<'_, 3>) -> f64 {
    let grid = &accepted.conditions.grid;
    let mut torque = 0.0;
    for (node, reaction) in accepted.forces.reactions.iter().enumerate() {
        let [x, y, z] = grid.node_position(node);
        if z > 0.0 {
            torque += x * reaction[1] - y * reaction[0];
        }
    }
    4.0 * torque
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("space-torsion", ABOUT, out)?;
    let bars: Vec<&Bar> = BARS.iter().filter(|bar| bar.least <= level).collect();
    let done = bars
        .par_iter()
        .map(|bar| bar.run())
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (bar, (record, curve)) in bars.into_iter().zip(done) {
        let run = study.run_to_end(record);
        let at = |twist: f64| {
            let row = curve.rows.iter().find(|row| (row[0] - twist).abs() < 1e-6);
            row.map_or(f64::NAN, |row| row[1])
        };
        let mut check = |twist: f64, oracle: Oracle, exact: f64| {
            study.check(
                run,
                format!("torque at Gθ/k = {twist} [k a³]"),
                oracle.says(exact),
                Band::Relative(0.02),
                at(twist),
            );
        };
        check(0.5, SAINT_VENANT, bar.exact(0.5 / SHEAR)[0]);
        let plastic: &[f64] = match bar.section {
            Section::Round => &[1.5, 2.0, TWIST],
            Section::Square => &[TWIST],
        };
        for &twist in plastic {
            check(twist, NADAI, bar.exact(twist / SHEAR)[1]);
        }
        curve.write_csv(&study.folder)?;
    }
    Ok(study)
}
