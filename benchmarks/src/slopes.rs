//! The two slopes of the paper one load step before full gravity: the input of the whole-step
//! bench.

use std::ops::ControlFlow;

use igimp_assembly::{Method, StepConditions};
use igimp_cases::run::{Controls, Model};
use igimp_cases::shipped::find;
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
    pub fn workspace() -> Workspace<2> {
        Workspace::new(SolverKind::Auto.build())
    }

    /// Takes the step, from `body`, a clone of [`Self::body`].
    ///
    /// # Errors
    /// [`StepError`](igimp_solver::StepError) when no equilibrium is found.
    pub fn take(
        &self,
        body: &mut Body<2>,
        workspace: &mut Workspace<2>,
    ) -> BenchResult<StepReport> {
        let settings = NewtonSettings::default();
        let (method, conditions) = (&self.method, &self.conditions);
        let (report, _) = step(body, method, conditions, self.factors, &settings, workspace)?;
        Ok(report)
    }
}

/// The von Mises slope at a cell size \[m\] and a strength reduced by 1.2; its other
/// parameters are those of the shipped case.
///
/// # Errors
/// A cell size that makes no grid, or a march that finds no equilibrium.
pub fn von_mises(cell: f64) -> BenchResult<PreparedStep> {
    prepare("von_mises_slope", cell, [40.0, 15.0 + cell])
}

/// The Mohr–Coulomb slope at a cell size \[m\] and a strength reduced by 1.2; its other
/// parameters are those of the shipped case.
///
/// # Errors
/// A cell size that makes no grid, or a march that finds no equilibrium.
pub fn mohr_coulomb(cell: f64) -> BenchResult<PreparedStep> {
    prepare("mohr_coulomb_slope", cell, [36.0, 10.0 + cell])
}

/// Marches a shipped slope to the last but one of the equal steps to full gravity.
fn prepare(name: &str, cell: f64, [x, y]: [f64; 2]) -> BenchResult<PreparedStep> {
    let overrides = [
        format!("grid.cell={cell} m"),
        format!("grid.domain={{ x = ['0 m', '{x} m'], y = ['0 m', '{y} m'] }}"),
    ];
    let shipped = find(name).ok_or("the case is not shipped")?;
    let case = shipped.case_file(overrides)?.into_case();
    let (model, initial) = Model::new(&case)?;
    let under = |gravity: f64| Controls {
        gravity,
        srf: vec![REDUCTION; case.materials.len()],
        ..initial.controls.clone()
    };
    let stage = &case.stages[0];
    let before = stage.steps.max(2) - 1;
    let start = before as f64 / (before + 1) as f64;
    let mut body = initial.body.clone();
    let report = march(
        &mut body,
        &case.method,
        &|from: f64, to: f64| model.conditions(&under(start * from), &under(start * to), 0.0),
        &MarchSettings::steps(before),
        &mut PreparedStep::workspace(),
        &mut |_: &Accepted<'_, 2>| ControlFlow::Continue(()),
    );
    if let Outcome::StepTooSmall { cause, .. } = report.outcome {
        return Err(cause.into());
    }
    Ok(PreparedStep {
        body,
        conditions: model.conditions(&under(start), &under(1.0), 0.0)?,
        method: case.method,
        factors: (start, 1.0),
    })
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
