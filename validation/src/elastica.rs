//! The beam under an end load against the elastica.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Constraints, DomainUpdate, LoadPoint, Method, Particles, SharedLaw, StepConditions, StepLoads,
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
    let m = Method::igimp_bbar;
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
    for (cells, points) in [(4, 3), (8, 2), (8, 3), (8, 4), (16, 3)] {
        jobs.push((String::new(), base(cells, points, 10, 0, m())));
    }
    for steps in [1, 2, 5, 20, 40] {
        jobs.push((String::new(), base(8, 3, steps, 0, m())));
    }
    jobs.push((String::new(), base(8, 3, 10, 30, m())));
    jobs.push((String::new(), base(8, 3, 10, 30, Method::igimp())));
    jobs.push((String::new(), base(8, 3, 10, 30, Method::impm_bbar())));
    jobs.push((
        "fixed domains".into(),
        base(
            8,
            3,
            10,
            30,
            Method {
                domain_update: DomainUpdate::Fixed,
                ..m()
            },
        ),
    ));
    let mut none = m();
    none.small_cuts.below = 0.0;
    jobs.push(("no ties".into(), base(8, 3, 10, 30, none)));
    let mut ghost = m();
    ghost.small_cuts.ghost_penalty = 1e-3;
    jobs.push(("ghost 1e-3".into(), base(8, 3, 10, 30, ghost)));
    let mut more = m();
    more.small_cuts.below = 1e-2;
    jobs.push(("ties below 1e-2".into(), base(8, 3, 10, 30, more)));
    jobs.push((
        "shifted".into(),
        Bending {
            shift: 0.5,
            ..base(8, 3, 10, 0, m())
        },
    ));
    jobs.push((
        "tiny, one step".into(),
        Bending {
            load: 0.01,
            ..base(8, 3, 1, 20, m())
        },
    ));
    jobs.push((
        "tiny, shifted".into(),
        Bending {
            load: 0.01,
            shift: 0.5,
            ..base(8, 3, 1, 20, m())
        },
    ));
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
