//! The four cases of the paper, each marched to one load step before the one to measure: the
//! input of the whole-step bench.

use std::ops::ControlFlow;
use std::time::Duration;

use igimp_assembly::{Method, StepConditions, TimeScheme, TimeStep};
use igimp_cases::run::{Controls, Model};
use igimp_input::shipped::find;
use igimp_linear::SolverKind;
use igimp_model::{Case, StageKind};
use igimp_solver::{
    Accepted, Body, NewtonSettings, Outcome, PhaseTimes, StepReport, Workspace, march, step,
};

use crate::BenchResult;

/// Factor by which the strength of both slopes is reduced: they stand, and a good part of them is
/// plastic.
const REDUCTION: f64 = 1.2;

/// A shipped case, and which of its steps to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Name in the bench's identifier.
    pub name: &'static str,
    /// Name of the case file.
    case: &'static str,
    /// Cell size \[m\] and the domain that goes with it \[m\], where they are not the shipped ones.
    grid: Option<(f64, [f64; 2])>,
    /// Factor by which the strength is reduced.
    srf: f64,
    /// Which step is measured.
    step: Step,
}

/// A step of the way to full load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// The last of the steps that the case file asks for.
    Last,
    /// One, counted from 1, of so many equal steps.
    Of(usize, usize),
}

impl Setting {
    /// The cases of the paper: column and footing with the grid of their files, the slopes with
    /// cells of half a metre.
    pub fn of_the_paper() -> [Self; 4] {
        [
            Self {
                name: "column",
                case: "column",
                grid: None,
                srf: 1.0,
                step: Step::Last,
            },
            Self::von_mises_slope("von-mises-slope", 0.5),
            Self::mohr_coulomb_slope("mohr-coulomb-slope", 0.5),
            Self {
                name: "footing",
                case: "footing_bonded",
                grid: None,
                srf: 1.0,
                step: Step::Of(2, 40),
            },
        ]
    }

    /// The slopes with about 100 000 particles, their strength whole, half way to full gravity: a
    /// fine grid finds slopes weaker, and the steps have to converge.
    pub fn large() -> [Self; 2] {
        [
            Self {
                srf: 1.0,
                step: Step::Of(10, 20),
                ..Self::von_mises_slope("von-mises-slope-fine", 0.125)
            },
            Self {
                srf: 1.0,
                step: Step::Of(10, 20),
                ..Self::mohr_coulomb_slope("mohr-coulomb-slope-fine", 0.1)
            },
        ]
    }

    fn von_mises_slope(name: &'static str, cell: f64) -> Self {
        Self {
            name,
            case: "von_mises_slope",
            grid: Some((cell, [40.0, 15.0 + cell])),
            srf: REDUCTION,
            step: Step::Last,
        }
    }

    fn mohr_coulomb_slope(name: &'static str, cell: f64) -> Self {
        Self {
            name,
            case: "mohr_coulomb_slope",
            grid: Some((cell, [36.0, 10.0 + cell])),
            srf: REDUCTION,
            step: Step::Last,
        }
    }

    fn overrides(&self) -> Vec<String> {
        self.grid.map_or_else(Vec::new, |(cell, [x, y])| {
            vec![
                format!("grid.cell={cell} m"),
                format!("grid.domain={{ x = ['0 m', '{x} m'], y = ['0 m', '{y} m'] }}"),
            ]
        })
    }

    /// Marches the case to the start of the step.
    ///
    /// # Errors
    /// A cell size that makes no grid, or a march that finds no equilibrium.
    pub fn prepare(&self) -> BenchResult<PreparedStep> {
        let shipped = find(self.case).ok_or("the case is not shipped")?;
        let case = shipped.case_file(self.overrides())?.into_case();
        let (model, initial) = Model::new(&case)?;
        let end = self.end(&case, &initial.controls);
        let under = |share: f64| Controls {
            gravity: share * end.gravity,
            settlement: share * end.settlement,
            ..end.clone()
        };
        let (number, steps) = match self.step {
            Step::Last => (case.stages[0].steps, case.stages[0].steps),
            Step::Of(number, steps) => (number, steps),
        };
        let before = number - 1;
        let start = before as f64 / steps as f64;
        let stop = number as f64 / steps as f64;
        let mut body = initial.body.clone();
        let report = march(
            &mut body,
            &case.method,
            &|from: f64, to: f64| model.conditions(&under(start * from), &under(start * to), 0.0),
            &model.march_settings(before),
            &mut PreparedStep::workspace(),
            &mut |_: &Accepted<'_, 2>| ControlFlow::Continue(()),
        );
        if let Outcome::StepTooSmall { cause, .. } = report.outcome {
            return Err(cause.into());
        }
        Ok(PreparedStep {
            name: self.name,
            body,
            conditions: model.conditions(&under(start), &under(stop), 0.0)?,
            method: case.method,
            factors: (start, stop),
        })
    }

    /// The controls at the end of the first stage; a strength reduction raises gravity to 1.
    fn end(&self, case: &Case<2>, initial: &Controls) -> Controls {
        let (gravity, settlement) = match case.stages[0].kind {
            StageKind::Displacement { settlement, .. } => (0.0, settlement),
            StageKind::Gravity { factor, .. } => (factor, 0.0),
            _ => (1.0, 0.0),
        };
        Controls {
            gravity,
            settlement,
            srf: vec![self.srf; case.materials.len()],
            ..initial.clone()
        }
    }
}

/// A body in equilibrium, and the conditions of its next step.
#[derive(Clone, Debug)]
pub struct PreparedStep {
    /// Name in the bench's identifier.
    pub name: &'static str,
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

    /// The same step with inertia, over a duration \[s\], as one within a motion.
    ///
    /// # Errors
    /// A duration that is not positive.
    pub fn in_motion(mut self, duration: f64) -> BenchResult<Self> {
        self.conditions = self.conditions.with_time(Some(TimeStep {
            duration,
            scheme: TimeScheme::GeneralisedAlpha,
            lumped: 0.01,
            is_first: false,
            must_resolve: false,
        }))?;
        Ok(self)
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

/// Names of the phases of a step, in the order of [`phases`].
pub const PHASES: [&str; 5] = ["set-up", "assembly", "factor", "solve", "commit"];

/// The time that a step spent in each phase.
pub fn phases(times: &PhaseTimes) -> [Duration; PHASES.len()] {
    [
        times.set_up,
        times.assembly,
        times.factor,
        times.solve,
        times.commit,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_steps_converge_with_plastic_flow() {
        let coarse = [
            Setting {
                step: Step::Of(3, 40),
                ..Setting::of_the_paper()[0]
            },
            Setting::von_mises_slope("von Mises", 1.0),
            Setting::mohr_coulomb_slope("Mohr-Coulomb", 1.0),
        ];
        for setting in coarse {
            let prepared = setting.prepare().unwrap();
            let mut body = prepared.body.clone();
            let report = prepared
                .take(&mut body, &mut PreparedStep::workspace())
                .unwrap();
            assert!(report.iterations >= 2, "{report:?}");
            let plastic = setting.case != "column";
            assert_eq!(report.plastic_share > 0.1, plastic, "{report:?}");
        }
    }

    #[test]
    fn a_step_in_motion_has_inertia() {
        let setting = Setting::mohr_coulomb_slope("Mohr-Coulomb", 1.0);
        let prepared = setting.prepare().unwrap().in_motion(0.05).unwrap();
        let mut body = prepared.body.clone();
        let report = prepared
            .take(&mut body, &mut PreparedStep::workspace())
            .unwrap();
        assert!(report.iterations >= 2, "{report:?}");
        assert!(report.energy.unwrap().kinetic > 0.0, "{report:?}");
    }

    #[test]
    fn the_footing_starts_where_its_grid_has_followed_it() {
        let setting = Setting {
            step: Step::Of(2, 75),
            ..Setting::of_the_paper()[3]
        };
        let prepared = setting.prepare().unwrap();
        let (start, stop) = prepared.factors;
        assert!((start - 1.0 / 75.0).abs() < 1e-12 && (stop - 2.0 / 75.0).abs() < 1e-12);
        let rows = prepared.conditions.grid.axes[1].nodes();
        assert!(rows.iter().any(|y| (y - 5.0 + start).abs() < 1e-9));
    }
}
