//! Rigid bodies with mass on an incline of stiff soil: a block slides, a cylinder and a sphere roll.

use std::time::Instant;

use igimp_assembly::{
    Constraints, Drive, Interface, Method, Particles, RigidBody, RigidMotion, Shear,
    StepConditions, StepLoads, Surface, Tension, TimeScheme, TimeStep,
};
use igimp_cases::CaseError;
use igimp_linear::SolverKind;
use igimp_model::check::Band;
use igimp_solver::{Body, MarchReport, NewtonSettings, Outcome, Workspace, step};

use super::elastic;
use crate::continuum::laboratory::{filled, grid_of};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

const INCLINE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "mechanics of rigid bodies",
    locator: "a block slides by g (sin β − μ cos β); a cylinder rolls by ⅔ g sin β, a sphere by 5/7 g sin β",
};
/// Gravity \[length/time²\], angle of the incline \[rad\], longest step \[time\].
const GRAVITY: f64 = 1e-2;
const SLOPE: f64 = 0.5;
const LONGEST: f64 = 0.0625;
/// Steps in which a body settles before it is let go.
const SETTLES: usize = 80;

/// A body on ground of stiff soil, two units deep, in axes along the incline.
struct Slide<const D: usize> {
    variant: String,
    /// Size of the grid and of its cells \[length\].
    extent: [f64; D],
    cell: f64,
    body: RigidBody<D>,
    turns: bool,
    /// How long it moves \[time\].
    time: f64,
}

/// A side that friction alone holds.
fn rubbing(friction: f64) -> Interface {
    Interface {
        shear: Shear::Limited {
            adhesion: vec![0.0],
            varies: false,
            friction,
        },
        tension: Tension::None,
    }
}

fn over(scheme: TimeScheme, duration: f64, is_first: bool) -> TimeStep {
    TimeStep {
        duration,
        scheme,
        lumped: 0.01,
        is_first,
        must_resolve: false,
    }
}

impl<const D: usize> Slide<D> {
    /// The ground and its supports.
    fn ground(&self) -> Result<(Body<D>, StepConditions<D>), CaseError> {
        let cells = self.extent.map(|side| (side / self.cell).round() as usize);
        let mut filled_cells = cells;
        filled_cells[D - 1] = (2.0 / self.cell).round() as usize;
        let seeds = filled(&grid_of(self.cell, filled_cells)?, 2);
        let grid = grid_of(self.cell, cells)?;
        let mut constraints = Constraints::free(&grid);
        for axis in 0..D {
            constraints.fix_wall(&grid, D - 1, false, axis)?;
        }
        let loads = StepLoads::gravity([0.0; D]);
        let still = StepConditions::new(grid, constraints, loads, vec![elastic()?])?;
        let mut body = Body::new(Particles::new(&seeds)?);
        body.rigid = vec![self.body.clone()];
        Ok((body, still))
    }

    /// Lets the body settle and go; how it went, and where it is.
    fn run(&self) -> Result<(RunRecord, RigidBody<D>), CaseError> {
        let clock = Instant::now();
        let (mut body, still) = self.ground()?;
        let weight = self.body.motion.mass * GRAVITY;
        let mut pressed = RigidMotion::held();
        pressed.displacement[D - 1] = Drive::Loaded(-weight * SLOPE.cos());
        let mut free = pressed.clone();
        free.displacement = [Drive::Loaded(0.0); D];
        free.displacement[0] = Drive::Loaded(weight * SLOPE.sin());
        free.displacement[D - 1] = pressed.displacement[D - 1];
        if self.turns {
            free.rotation = [Drive::Loaded(0.0); 3];
        }
        let mut report = MarchReport {
            outcome: Outcome::Completed,
            steps: Vec::new(),
            failures: Vec::new(),
        };
        let (method, settings) = (Method::igimp(), NewtonSettings::default());
        let mut workspace = Workspace::new(SolverKind::Auto.build());
        let mut go = |body: &mut Body<D>, motion: &RigidMotion<D>, time: TimeStep| {
            let conditions = (still.clone().with_motions(vec![motion.clone()]))
                .and_then(|given| given.with_time(Some(time)));
            let conditions = conditions.map_err(CaseError::from)?;
            let ends = (0.0, 1.0);
            let stepped = step(body, &method, &conditions, ends, &settings, &mut workspace);
            Ok::<_, CaseError>(stepped.map(|(step, _)| step))
        };
        for k in 0..SETTLES {
            let time = over(TimeScheme::BackwardEuler, LONGEST, k == 0);
            match go(&mut body, &pressed, time)? {
                Ok(step) => report.steps.push(step),
                Err(cause) => return Ok((self.ended(report, cause, clock), self.body.clone())),
            }
        }
        body.rest();
        let (mut past, mut duration) = (0.0, LONGEST);
        while past < self.time {
            let time = over(TimeScheme::GeneralisedAlpha, duration, past == 0.0);
            match go(&mut body, &free, time)? {
                Ok(step) => {
                    report.steps.push(step);
                    past += duration;
                    if 2.0 * duration <= LONGEST && (past / (2.0 * duration)).fract() == 0.0 {
                        duration *= 2.0;
                    }
                }
                Err(cause) if duration < 2e-3 => {
                    return Ok((self.ended(report, cause, clock), self.body.clone()));
                }
                Err(cause) => {
                    report.failures.push(cause);
                    duration *= 0.5;
                }
            }
        }
        let record = RunRecord::new(self.variant.as_str(), &report, clock.elapsed());
        Ok((record, body.rigid.remove(0)))
    }

    /// A run that ended before its time.
    fn ended(
        &self,
        mut report: MarchReport,
        cause: igimp_solver::StepError,
        clock: Instant,
    ) -> RunRecord {
        report.outcome = Outcome::StepTooSmall {
            last_converged: 0.0,
            cause,
        };
        RunRecord::new(self.variant.as_str(), &report, clock.elapsed())
    }

    /// Runs it and holds its mean acceleration from rest against that of a rigid body.
    fn hold(self, study: &mut Study, expected: f64, band: f64) -> Result<(), CaseError> {
        let start = self.body.pose.origin[0];
        let (run, moved) = self.run()?;
        let run = study.run_to_end(run);
        let way = moved.pose.origin[0] - start;
        let found = 2.0 * way / (self.time * self.time) / GRAVITY;
        let quantity = "acceleration along the incline / g [-]";
        study.check(
            run,
            quantity,
            INCLINE.says(expected),
            Band::Relative(band),
            found,
        );
        Ok(())
    }
}

/// Holds blocks, and in full cylinder and sphere.
pub(super) fn hold(study: &mut Study, level: Level) -> Result<(), CaseError> {
    for friction in [0.2, 0.4] {
        let corners = [[-1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [-1.0, 1.0]];
        let surface = Surface::polygon(&corners, 0.25, 1.0).expect("the block has an area");
        let mut body = RigidBody::new(surface, vec![rubbing(friction); 4], [3.0, 1.999]);
        body.motion.mass = 1.0;
        let block = Slide {
            variant: format!("block on an incline, tan φ = {friction}"),
            extent: [10.0, 6.0],
            cell: 1.0,
            body,
            turns: false,
            time: 30.0,
        };
        let expected = SLOPE.sin() - friction * SLOPE.cos();
        block.hold(study, expected, 0.01)?;
    }
    if level < Level::Full {
        return Ok(());
    }
    let mut body = RigidBody::new(
        Surface::circle(1.0, 0.06).expect("the cylinder has an area"),
        vec![rubbing(0.5)],
        [3.0, 2.999],
    );
    body.motion.mass = 20.0;
    body.motion.moments[2][2] = 0.5 * 20.0;
    let cylinder = Slide {
        variant: "cylinder on an incline".to_owned(),
        extent: [10.0, 6.0],
        cell: 0.5,
        body,
        turns: true,
        time: 30.0,
    };
    cylinder.hold(study, 2.0 / 3.0 * SLOPE.sin(), 0.01)?;
    // With cells of its radius the body turns less than it moves, by more than its ground gives way (docs/src/hard-numerics.md).
    for (cell, cells, band) in [(1.0, "its radius", 0.02), (0.5, "half its radius", 0.01)] {
        let surface = Surface::sphere(1.0, 0.12).expect("the sphere has a volume");
        let mut body = RigidBody::new(surface, vec![rubbing(0.5)], [3.0, 2.5, 2.999]);
        body.motion.mass = 20.0;
        for axis in 0..3 {
            body.motion.moments[axis][axis] = 0.4 * 20.0;
        }
        let sphere = Slide {
            variant: format!("sphere on an incline, cells of {cells}"),
            extent: [9.0, 5.0, 6.0],
            cell,
            body,
            turns: true,
            time: 15.0,
        };
        sphere.hold(study, 5.0 / 7.0 * SLOPE.sin(), band)?;
    }
    Ok(())
}
