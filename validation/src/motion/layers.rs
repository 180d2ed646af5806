//! Layers over rock that is shaken, and a pulse that leaves through a base.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::{
    AbsorbingWall, Constraints, Geometry, GroundMotion, Kinematics, Method, Particles, SharedLaw,
    StepConditions, StepLoads, TimeScheme, Walls,
};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_solver::{Accepted, Body};

use super::{POISSON, Steps, YOUNG, bar, compression, elastic, moved, moving};
use crate::continuum::laboratory::grid_of;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::Study;

const LAYER: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "wave equation (Kramer 1996, section 7.2)",
    locator: "1/√(cos² kH + α² sin² kH), α = ρ_s c_s/(ρ_r c_r), 0 for a rigid base",
};
const HALF_SPACE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "wave equation",
    locator: "ground that goes on sends nothing back",
};
/// Cells over the height of a layer, and steps a period.
const HEIGHT: usize = 20;
const STEPS: usize = 80;
/// Displacement of the base or of the outcrop \[length\].
const WAY: f64 = 1e-3;

fn linear() -> Method {
    Method {
        geometry: Geometry::Given,
        kinematics: Kinematics::SmallStrain,
        ..Method::igimp()
    }
}

/// Acceleration of a base that swings by [`WAY`] along the first axis.
fn swings<const D: usize>(omega: f64) -> impl Fn(f64, f64) -> GroundMotion<D> {
    move |from, to| {
        // The change of the velocity of the base over a step.
        let mean = |from: f64, to: f64| {
            let mut all = [0.0; D];
            all[0] = WAY * omega * ((omega * to).cos() - (omega * from).cos()) / (to - from);
            all
        };
        GroundMotion {
            acceleration: mean(from, to),
            earlier: mean(2.0 * from - to, from),
        }
    }
}

/// Half the range of motion in space of a particle over that of its base, from a step on \[-\].
struct Range {
    from: usize,
    step: usize,
    most: [f64; 2],
}

impl Range {
    fn after(from: usize) -> Self {
        Self {
            from,
            step: 0,
            most: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    fn sees(&mut self, displacement: f64, ground: f64) {
        self.step += 1;
        if self.step > self.from {
            let total = displacement / WAY + ground;
            self.most = [self.most[0].min(total), self.most[1].max(total)];
        }
    }

    fn amplification(&self) -> f64 {
        0.5 * (self.most[1] - self.most[0])
    }
}

/// Holds all of them.
pub(super) fn hold(study: &mut Study) -> Result<(), CaseError> {
    for kh in [0.63, 2.64] {
        rigid_base(study, kh)?;
    }
    for kh in [0.6, PI / 2.0, 2.2] {
        compliant_base(study, kh)?;
    }
    for (width, band) in [(4.0, 5e-3), (8.0, 1e-3)] {
        pulse(study, width, band)?;
    }
    Ok(())
}

/// A layer on a rigid base that begins with the standing wave of the exact solution.
fn rigid_base(study: &mut Study, kh: f64) -> Result<(), CaseError> {
    let height = HEIGHT as f64;
    let omega = kh * compression() / height;
    let shape = |x: f64| (kh * (1.0 - x / height)).cos() / kh.cos() - 1.0;
    let mut body = moving(&bar(HEIGHT), |x| [WAY * omega * shape(x[0])])?;
    let grid = grid_of(1.0, [HEIGHT + 1])?;
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0)?;
    let loads = StepLoads::gravity([0.0]);
    let still = StepConditions::new(grid, constraints, loads, vec![elastic()?])?;
    let (top, x) = (2 * HEIGHT - 1, 2.0 * height - 0.5);
    let variant = format!("layer on a rigid base, kH = {kh}");
    let found = shaken(study, &variant, (&mut body, &still), (omega, 4, 0), top);
    let expected = (shape(0.5 * x) + 1.0).abs();
    let quantity = "amplification at the highest particle [-]";
    study.check(
        found.0,
        quantity,
        LAYER.says(expected),
        Band::Relative(0.01),
        found.1,
    );
    Ok(())
}

/// Moves a body on a base that swings for so many periods; the run, and the amplification after the first of them.
fn shaken(
    study: &mut Study,
    variant: &str,
    (body, still): (&mut Body<1>, &StepConditions<1>),
    (omega, periods, waits): (f64, usize, usize),
    particle: usize,
) -> (usize, f64) {
    let steps = Steps::of(
        TimeScheme::Newmark,
        2.0 * PI / omega / STEPS as f64,
        STEPS * periods,
    );
    let mut range = Range::after(STEPS * waits);
    let mut observe = |accepted: &Accepted<'_, 1>| {
        let at = accepted.report.to * steps.duration * steps.count as f64;
        let moved = accepted.body.particles.displacement[particle][0];
        range.sees(moved, (omega * at).sin());
        ControlFlow::Continue(())
    };
    let ground = swings(omega);
    let conditions = |from: f64, to: f64| still.clone().with_ground(Some(ground(from, to)));
    let run = moved(variant, body, &linear(), steps, &conditions, &mut observe);
    (study.run_to_end(run), range.amplification())
}

/// A wall of dashpots alone at the lower end of an axis.
fn dashpots<const D: usize>(normal: usize, upper: bool) -> AbsorbingWall<D> {
    AbsorbingWall {
        normal,
        upper,
        spring: [0.0; D],
    }
}

/// A layer on eight cells of rock of four times its density and stiffness, with dashpots below.
fn compliant_base(study: &mut Study, kh: f64) -> Result<(), CaseError> {
    let rock = 8;
    let mut seeds = bar(HEIGHT + rock);
    for seed in &mut seeds[..2 * rock] {
        (seed.density, seed.law) = (4.0, 1);
    }
    let mut body = Body::new(Particles::new(&seeds)?);
    let stiff: SharedLaw = Arc::new(HenckyElastic::new(Elasticity::new(4.0 * YOUNG, POISSON)?));
    let grid = grid_of(1.0, [HEIGHT + rock + 1])?;
    let constraints = Constraints::free(&grid);
    let loads = StepLoads::gravity([0.0]);
    let walls = Walls {
        absorbing: vec![dashpots(0, false)],
        ..Walls::default()
    };
    let still = StepConditions::new(grid, constraints, loads, vec![elastic()?, stiff])?
        .with_walls(Some(walls))?;
    let omega = kh * compression() / HEIGHT as f64;
    let variant = format!("layer on a compliant base, α = 0.25, kH = {kh:.3}");
    let top = seeds.len() - 1;
    let found = shaken(study, &variant, (&mut body, &still), (omega, 16, 15), top);
    let expected = 1.0 / f64::hypot(kh.cos(), 0.25 * kh.sin());
    let quantity = "amplification at the surface [-]";
    study.check(
        found.0,
        quantity,
        LAYER.says(expected),
        Band::Relative(0.01),
        found.1,
    );
    Ok(())
}

/// A pulse that leaves through a matched base; half of it comes from the free surface.
fn pulse(study: &mut Study, width: f64, band: f64) -> Result<(), CaseError> {
    let cells = 80;
    let speed = |x: f64| WAY * (-((x - 50.0) / width).powi(2)).exp();
    let mut body = moving(&bar(cells), |x| [speed(x[0])])?;
    let start: f64 = std::iter::zip(&body.particles.mass, &body.particles.velocity)
        .map(|(m, v)| 0.5 * m * v[0] * v[0])
        .sum();
    let grid = grid_of(1.0, [cells + 1])?;
    let constraints = Constraints::free(&grid);
    let walls = Walls {
        absorbing: vec![dashpots(0, false)],
        ..Walls::default()
    };
    let still = StepConditions::new(
        grid,
        constraints,
        StepLoads::gravity([0.0]),
        vec![elastic()?],
    )?
    .with_walls(Some(walls))?;
    let steps = Steps::of(TimeScheme::Newmark, 0.25 / compression(), 700);
    let mut left = f64::NAN;
    let mut observe = |accepted: &Accepted<'_, 1>| {
        if let Some(energy) = &accepted.report.energy {
            left = energy.kinetic + energy.elastic;
        }
        ControlFlow::Continue(())
    };
    let conditions = |_: f64, _: f64| Ok(still.clone());
    let variant = format!("pulse of {:.0} cells, matched base", 2.0 * PI * width);
    let run = moved(
        &variant,
        &mut body,
        &linear(),
        steps,
        &conditions,
        &mut observe,
    );
    let run = study.run_to_end(run);
    let quantity = "share of the amplitude that comes back [-]";
    let back = (left / start).sqrt();
    study.check(
        run,
        quantity,
        HALF_SPACE.says(0.0),
        Band::AtMost(band),
        back,
    );
    Ok(())
}
