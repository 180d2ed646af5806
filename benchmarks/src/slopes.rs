//! The two slopes of the paper one load step before full gravity: the input of the whole-step
//! bench.

use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::{Constraints, Method, Particles, SharedLaw, StepConditions, StepLoads};
use igimp_cases::mohr_coulomb_slope::MohrCoulombSlope;
use igimp_cases::seed::fill_polygon;
use igimp_cases::slope::{GRAVITY, SlopeGeometry};
use igimp_cases::von_mises_slope::VonMisesSlope;
use igimp_material::{ConstitutiveModel, Elasticity, MohrCoulomb, VonMises};
use igimp_shape::Grid;
use igimp_solver::linear::SolverKind;
use igimp_solver::{
    Accepted, Body, MarchSettings, NewtonSettings, Outcome, StepReport, Workspace, march, step,
};

use crate::BenchResult;

/// Factor by which the strength of both slopes is reduced: they stand, and a good part of them is
/// plastic.
const REDUCTION: f64 = 1.2;

/// A body in equilibrium, and the conditions of its next step.
#[derive(Debug)]
pub struct PreparedStep {
    /// The body at the start of the step.
    pub body: Body<2>,
    method: Method,
    conditions: StepConditions<2>,
    factors: (f64, f64),
}

impl PreparedStep {
    /// A workspace with the solver that the cases use.
    pub fn workspace() -> Workspace {
        Workspace::new(SolverKind::Auto.build())
    }

    /// Takes the step, from `body`, a clone of [`Self::body`].
    ///
    /// # Errors
    /// [`StepError`](igimp_solver::StepError) when no equilibrium is found.
    pub fn take(&self, body: &mut Body<2>, workspace: &mut Workspace) -> BenchResult<StepReport> {
        let settings = NewtonSettings::default();
        let (method, conditions) = (&self.method, &self.conditions);
        let (report, _) = step(body, method, conditions, self.factors, &settings, workspace)?;
        Ok(report)
    }
}

/// The von Mises slope at a cell size \[m\] and a strength reduced by 1.2; its other
/// parameters are those of the case.
///
/// # Errors
/// A cell size that makes no grid, or a march that finds no equilibrium.
pub fn von_mises(cell: f64) -> BenchResult<PreparedStep> {
    let case = VonMisesSlope::default();
    let elasticity = Elasticity::new(case.young, case.poisson)?;
    let law = VonMises::from_undrained_strength(elasticity, case.undrained_strength)?;
    let grid = case.geometry.grid(cell, 4.0 * cell)?;
    let slope = Slope {
        constraints: case.geometry.walls(&grid),
        grid,
        law: law.reduced(REDUCTION)?,
    };
    slope.prepare(&case.geometry, case.unit_weight, case.method, case.steps)
}

/// The Mohr–Coulomb slope at a cell size \[m\] and a strength reduced by 1.2; its other
/// parameters are those of the case.
///
/// # Errors
/// A cell size that makes no grid, or a march that finds no equilibrium.
pub fn mohr_coulomb(cell: f64) -> BenchResult<PreparedStep> {
    let case = MohrCoulombSlope::default();
    let law = MohrCoulomb::new(
        Elasticity::new(case.young, case.poisson)?,
        case.cohesion,
        case.friction_angle,
        case.dilation_angle,
    )?;
    let grid = case.geometry.grid(cell, 4.0)?;
    let slope = Slope {
        constraints: case.geometry.walls(&grid),
        grid,
        law: law.reduced(REDUCTION)?,
    };
    slope.prepare(&case.geometry, case.unit_weight, case.method, case.steps)
}

/// What does not change over the march.
struct Slope {
    grid: Grid<2>,
    constraints: Constraints<2>,
    law: SharedLaw,
}

impl Slope {
    /// Marches to the last but one of `steps` equal steps to full gravity.
    fn prepare(
        &self,
        geometry: &SlopeGeometry,
        unit_weight: f64,
        method: Method,
        steps: usize,
    ) -> BenchResult<PreparedStep> {
        let seeds = fill_polygon(&self.grid, &geometry.polygon(), 2, unit_weight / GRAVITY, 0)?;
        let mut body = Body::new(Particles::new(&seeds)?);
        let before = steps.max(2) - 1;
        let start = before as f64 / (before + 1) as f64;
        let report = march(
            &mut body,
            &method,
            &|_: f64, to: f64| Ok(self.conditions(start * to)),
            &MarchSettings::steps(before),
            &mut PreparedStep::workspace(),
            &mut |_: &Accepted<'_, 2>| ControlFlow::Continue(()),
        );
        if let Outcome::StepTooSmall { cause, .. } = report.outcome {
            return Err(cause.into());
        }
        Ok(PreparedStep {
            body,
            method,
            conditions: self.conditions(1.0),
            factors: (start, 1.0),
        })
    }

    /// The conditions under a factor on gravity.
    fn conditions(&self, factor: f64) -> StepConditions<2> {
        StepConditions {
            grid: self.grid.clone(),
            constraints: self.constraints.clone(),
            loads: StepLoads {
                gravity: [0.0, -factor * GRAVITY],
                factors: Vec::new(),
                drag: 0.0,
            },
            laws: vec![Arc::clone(&self.law)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_converges_with_plastic_flow() {
        for prepared in [von_mises(1.0).unwrap(), mohr_coulomb(1.0).unwrap()] {
            let mut body = prepared.body.clone();
            let report = prepared
                .take(&mut body, &mut PreparedStep::workspace())
                .unwrap();
            assert!(report.iterations >= 3, "{report:?}");
            assert!(report.plastic_share > 0.1, "{report:?}");
        }
    }
}
