//! The beam under an end load against the elastica.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, LoadPoint, Method, Particles, SharedLaw, StepConditions, StepLoads,
};
use igimp_cases::CaseError;
use igimp_cases::check::Band;
use igimp_cases::figures::{CurvePlot, Series};
use igimp_cases::seed::fill_polygon;
use igimp_cases::table::Table;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchSettings};

use crate::exact::elastica::Cantilever;
use crate::laboratory::run;
use crate::oracle::{Oracle, OracleKind};
use crate::study::{Level, Run, Study};

/// Bends a beam of length 10 and depth 1 in `steps`, then holds the load for `hold` more.
struct Bending {
    load: f64,
    cells: usize,
    points: usize,
    steps: usize,
    hold: usize,
    method: Method,
    shift: f64,
}

impl Bending {
    fn run(&self) -> Result<(Run, Table), CaseError> {
        let h = 1.0 / self.cells as f64;
        let grid = Grid::new([
            Axis::uniform(0.0, h, 11 * self.cells)?,
            Axis::uniform(-8.0 - self.shift * h, h, 10 * self.cells)?,
        ]);
        let polygon = [[0.0, 0.0], [10.25, 0.0], [10.25, 1.0], [0.0, 1.0]];
        let mut body = Body {
            particles: Particles::new(&fill_polygon(&grid, &polygon, self.points, 1.0, 0)?)?,
            load_points: vec![LoadPoint {
                x: [10.0, 0.5],
                force: [0.0, -self.load],
                load: 0,
            }],
        };
        let law: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(1200.0, 0.0)?));
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0);
        constraints.fix_wall(&grid, 0, false, 1);
        let all = (self.steps + self.hold) as f64;
        let program = |_from: f64, to: f64| {
            Ok(StepConditions {
                grid: grid.clone(),
                constraints: constraints.clone(),
                loads: StepLoads {
                    factors: vec![(to * all / self.steps as f64).min(1.0)],
                    ..StepLoads::gravity([0.0; 2])
                },
                laws: vec![Arc::clone(&law)],
            })
        };
        let mut curve = Table::new("deflection", &["step", "deflection_[-]"]);
        let mut observe = |accepted: &Accepted<'_, 2>| {
            let tip = accepted.body.load_points[0].x;
            curve.push(vec![accepted.report.to * all, (0.5 - tip[1]) / 10.0]);
            ControlFlow::Continue(())
        };
        let variant = format!(
            "{}, h = 1/{}, {}x{} points, {} + {} steps, load {}, shift {}",
            self.method.label(),
            self.cells,
            self.points,
            self.points,
            self.steps,
            self.hold,
            self.load,
            self.shift
        );
        let settings = MarchSettings::steps(self.steps + self.hold);
        let (run, _) = run(
            variant,
            &mut body,
            &self.method,
            &settings,
            &program,
            &mut observe,
        );
        Ok((run, curve))
    }
}

pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("elastica", "", out)?;
    let mut jobs = vec![];
    let base = |cells, points, steps, hold, method| Bending {
        load: 1.0,
        cells,
        points,
        steps,
        hold,
        method,
        shift: 0.0,
    };
    for method in [Method::igimp(), Method::igimp_bbar()] {
        for (cells, points, steps) in [
            (8, 2, 10),
            (8, 4, 10),
            (8, 3, 1),
            (8, 3, 40),
            (16, 3, 1),
            (16, 3, 10),
            (4, 3, 10),
        ] {
            jobs.push((String::new(), base(cells, points, steps, 0, method.clone())));
        }
        for load in [2.0, 5.0] {
            jobs.push((
                String::new(),
                Bending {
                    load,
                    ..base(8, 3, 20, 0, method.clone())
                },
            ));
        }
        for below in [1e-6, 1e-5, 1e-3] {
            let mut other = method.clone();
            other.small_cuts.below = below;
            jobs.push((format!("below {below}"), base(8, 3, 10, 0, other)));
        }
        jobs.push((
            "small strain".into(),
            base(
                8,
                3,
                10,
                0,
                Method {
                    kinematics: igimp_assembly::Kinematics::SmallStrain,
                    ..method.clone()
                },
            ),
        ));
        jobs.push((
            "shifted".into(),
            Bending {
                shift: 0.5,
                ..base(8, 3, 10, 0, method.clone())
            },
        ));
        jobs.push((
            "shifted".into(),
            Bending {
                shift: 0.5,
                ..base(8, 3, 1, 0, method.clone())
            },
        ));
    }
    for (name, job) in &jobs {
        let exact = Cantilever {
            load: job.load,
            extension: 1.0 / 1200.0,
            shear: 2e-3,
        }
        .end()[0];
        let (run, curve) = job.run()?;
        let at = |k: usize| {
            curve
                .rows
                .get(k - 1)
                .map_or(f64::NAN, |row| 100.0 * (row[1] / exact - 1.0))
        };
        eprintln!(
            "{name} {}: exact {exact:.5}; {} {:+.2} % then {:+.2} % cuts {} {:.1} s",
            run.variant,
            run.outcome,
            at(job.steps),
            at(job.steps + job.hold),
            run.cuts,
            run.seconds
        );
    }
    let _ = level;
    Ok(study)
}
