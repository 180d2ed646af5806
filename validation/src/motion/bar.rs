//! The first mode of a bar, step by step, beside the solution of each scheme for one oscillator.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use igimp_assembly::{
    Constraints, Geometry, Kinematics, Method, StepConditions, StepLoads, TimeScheme,
};
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_solver::{Accepted, Body};

use super::{Steps, bar, compression, elastic, moved, moving};
use crate::continuum::laboratory::grid_of;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};

const OSCILLATOR: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "the scheme of a linear oscillator",
    locator: "backward Euler: energy 1/(1 + (ωΔt)²), phase atan ωΔt a step; Newmark's method: 1 and 2 atan(ωΔt/2)",
};
const WAVES: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "wave equation",
    locator: "first mode of a bar held at one end, T = 4 L/c",
};
/// Cells along the bar, and ω Δt of the bar in one piece \[-\].
const CELLS: usize = 8;
const OMEGA: f64 = 0.5;
/// Steps of backward Euler that leave the first mode alone.
const DAMPED: usize = 80;
/// How far a step may be from its scheme \[-\].
const ROUND_OFF: f64 = 1e-9;

/// Energy and phase of the mode after every step.
#[derive(Default)]
struct Mode {
    energy: Vec<f64>,
    phase: Vec<f64>,
}

/// Moves the bar on by so many steps.
fn go_on(
    variant: &str,
    body: &mut Body<1>,
    (scheme, count): (TimeScheme, usize),
) -> Result<(RunRecord, Mode), CaseError> {
    let grid = grid_of(1.0, [CELLS + 2])?;
    let mut constraints = Constraints::free(&grid);
    constraints.fix_wall(&grid, 0, false, 0)?;
    let loads = StepLoads::gravity([0.0]);
    let still = StepConditions::new(grid, constraints, loads, vec![elastic()?])?;
    let method = Method {
        geometry: Geometry::Given,
        kinematics: Kinematics::SmallStrain,
        ..Method::igimp()
    };
    let continuous = 0.5 * PI * compression() / CELLS as f64;
    let steps = Steps {
        tolerance: 1e-12,
        ..Steps::of(scheme, OMEGA / continuous, count)
    };
    let mut mode = Mode::default();
    let mut observe = |accepted: &Accepted<'_, 1>| {
        let particles = &accepted.body.particles;
        if let Some(energy) = &accepted.report.energy {
            let strained = energy.elastic.sqrt().copysign(particles.sigma[0][0][0]);
            let last = particles.len() - 1;
            let moving = energy.kinetic.sqrt().copysign(particles.velocity[last][0]);
            mode.energy.push(energy.kinetic + energy.elastic);
            mode.phase.push(strained.atan2(moving));
        }
        ControlFlow::Continue(())
    };
    let conditions = |_: f64, _: f64| Ok(still.clone());
    let run = moved(variant, body, &method, steps, &conditions, &mut observe);
    Ok((run, mode))
}

/// Holds backward Euler and Newmark's method against their solutions.
pub(super) fn hold(study: &mut Study) -> Result<(), CaseError> {
    let shape = |x: f64| (0.5 * PI * x / CELLS as f64).sin();
    let mut body = moving(&bar(CELLS), |x| [1e-3 * compression() * shape(x[0])])?;
    let euler = TimeScheme::BackwardEuler;
    let variant = "bar, backward Euler";
    let (run, mode) = go_on(variant, &mut body, (euler, DAMPED + 2))?;
    let run = study.run_to_end(run);
    let [before, after] = [DAMPED, DAMPED + 1];
    let left = mode.energy[after] / mode.energy[before];
    let turned = (mode.phase[after] - mode.phase[before]).rem_euclid(2.0 * PI);
    // All else follows from the frequency that the energy of one step tells.
    let omega = (1.0 / left - 1.0).sqrt();
    let expected = omega.atan();
    let quantity = "phase a step of the first mode [rad]";
    study.check(
        run,
        quantity,
        OSCILLATOR.says(expected),
        Band::Relative(ROUND_OFF),
        turned,
    );
    let quantity = "period of the first mode / (4 L/c) [-]";
    study.check(
        run,
        quantity,
        WAVES.says(1.0),
        Band::Relative(0.01),
        OMEGA / omega,
    );
    let variant = "bar, Newmark's method";
    let (run, mode) = go_on(variant, &mut body, (TimeScheme::Newmark, 40))?;
    let run = study.run_to_end(run);
    let quantity = "energy after 39 steps / energy after one [-]";
    let ratio = mode.energy[39] / mode.energy[0];
    study.check(
        run,
        quantity,
        OSCILLATOR.says(1.0),
        Band::Relative(ROUND_OFF),
        ratio,
    );
    let expected = 2.0 * (0.5 * omega).atan();
    let turned = (mode.phase[39] - mode.phase[38]).rem_euclid(2.0 * PI);
    let quantity = "phase a step of the first mode [rad]";
    study.check(
        run,
        quantity,
        OSCILLATOR.says(expected),
        Band::Relative(ROUND_OFF),
        turned,
    );
    Ok(())
}
