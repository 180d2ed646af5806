//! The cost of a run, and whether its steps were accepted rightly, gathered from its events.

use igimp_assembly::AssemblyError;
use igimp_cases::run::{Event, Model};
use igimp_linear::LinearSolverError;
use igimp_model::Case;
use igimp_solver::{Accepted, Body, StepError, StepFailure, StepReport};

use crate::bodies::outline::Outline;
use crate::bodies::through::{outlines, reach, wrong_traction};
use crate::recheck::equilibrium;

/// Round-off of the sums of a recheck, relative to the external force \[-\].
const NOISE: f64 = 1e-12;

/// Steps and corrections of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Effort {
    /// Corrections of every accepted step.
    pub(crate) corrections: Vec<usize>,
    /// Steps that were tried and not accepted.
    pub(crate) cuts: usize,
    /// Steps accepted above the tolerance, at round-off.
    pub(crate) at_round_off: usize,
    /// The largest residual of those \[-\].
    pub(crate) worst_at_round_off: f64,
    /// Steps whose equilibrium was computed again.
    pub(crate) rechecked: usize,
    /// Steps that should not have been accepted, in words.
    pub(crate) violations: Vec<String>,
    /// The last step that was not accepted.
    pub(crate) last_cut: Option<Cut>,
    /// Share of particles that yielded in the last accepted step \[-\].
    pub(crate) plastic_share: f64,
    /// The smallest distance of a particle's centre from a rigid body, in half-lengths as seeded \[-\].
    pub(crate) nearest: Option<f64>,
    /// Particles in or through rigid bodies, and traction that these cannot carry, in words.
    pub(crate) contact: Vec<String>,
}

/// A step that was not accepted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// Why.
    pub(crate) cause: &'static str,
    /// The smallest residual after a correction \[-\].
    pub(crate) closest: f64,
}

impl Cut {
    fn new(error: &StepError) -> Self {
        let residuals = error.residuals.iter().skip(1).copied();
        Self {
            cause: cause(&error.failure),
            closest: residuals.fold(f64::INFINITY, f64::min),
        }
    }
}

/// Why a step was not accepted, in a word or two.
fn cause(failure: &StepFailure) -> &'static str {
    match failure {
        StepFailure::MaxIterations { .. } => "corrections run out",
        StepFailure::Diverged => "residual diverges",
        StepFailure::Stagnated => "residual stagnates",
        StepFailure::LeavesGrid { .. }
        | StepFailure::LoadPointLeavesGrid { .. }
        | StepFailure::ReinforcementLeavesGrid { .. } => "leaves the grid",
        StepFailure::TooLong { .. } => "too long a step",
        StepFailure::Thrown { .. } => "throws a body",
        StepFailure::MechanismAtOnce => "is a mechanism at once",
        StepFailure::TooDeep { .. } => "penetrates too deep",
        StepFailure::Penetration(_) => "soil caught by a body",
        StepFailure::NotHeld { .. } => "nothing holds a body",
        StepFailure::NotFinite { .. } => "not finite",
        StepFailure::Assembly(AssemblyError::Inverted { .. }) => "particle inverted",
        StepFailure::Assembly(AssemblyError::Material { .. }) => "law fails",
        StepFailure::Assembly(_) => "no equations",
        StepFailure::Linear(
            LinearSolverError::Singular { .. } | LinearSolverError::NotPositiveDefinite { .. },
        )
        | StepFailure::Singular { .. } => "singular tangent",
        StepFailure::Linear(LinearSolverError::Inaccurate { .. }) => "inaccurate solution",
        StepFailure::Linear(_) => "linear solver fails",
        StepFailure::FreeField(within) => cause(within),
    }
}

/// Follows a run.
pub(crate) struct Follower<'c> {
    case: &'c Case<2>,
    /// The body before the next step, where it is known.
    before: Option<Body<2>>,
    /// Of the rigid bodies of the case.
    outlines: Vec<Outline>,
    /// The gathered effort.
    pub(crate) effort: Effort,
}

impl<'c> Follower<'c> {
    /// Follows a run of a case from its beginning.
    pub(crate) fn new(case: &'c Case<2>) -> Self {
        let initial = Model::new(case).ok();
        Self {
            case,
            before: initial.map(|(_, state)| state.body),
            outlines: outlines(case),
            effort: Effort::default(),
        }
    }

    /// Takes an event.
    pub(crate) fn on_event(&mut self, event: &Event<'_, 2>) {
        match event {
            Event::Equilibrium { accepted, .. } => self.accepted(accepted),
            Event::Cut { error } => {
                self.effort.cuts += 1;
                self.effort.last_cut = Some(Cut::new(error));
            }
            // The next step begins with a state that is not known here.
            Event::Trial { .. } | Event::StageEnded { .. } => self.before = None,
            _ => {}
        }
    }

    fn accepted(&mut self, accepted: &Accepted<'_, 2>) {
        let report = accepted.report;
        let effort = &mut self.effort;
        effort.corrections.push(report.iterations);
        effort.plastic_share = report.plastic_share;
        let tolerance = self.case.solver.tolerance;
        let last = report.residuals.last().copied().unwrap_or(f64::NAN);
        if report.at_round_off {
            effort.at_round_off += 1;
            effort.worst_at_round_off = effort.worst_at_round_off.max(last);
        }
        // Written so that a residual that is not a number does not pass.
        let meets = last <= tolerance;
        if meets == report.at_round_off {
            let text = format!(
                "accepted at {last:.1e}, at round-off: {}",
                report.at_round_off
            );
            effort.violations.push(at(report, &text));
        }
        self.bodies(accepted);
        let effort = &mut self.effort;
        // A ghost penalty adds to the forces of particles and bodies.
        let again = self.before.as_ref().filter(|before| {
            report.ghost_penalty == 0.0 && before.rigid.len() == accepted.body.rigid.len()
        });
        if let Some(again) = again.and_then(|before| equilibrium(self.case, before, accepted)) {
            effort.rechecked += 1;
            let allowed = if report.at_round_off {
                again.round_off
            } else {
                tolerance
            };
            // As above.
            let holds = again.residual <= 1.001 * allowed + NOISE;
            if !holds {
                let text = format!(
                    "the residual is {:.2e} when computed again, reported {last:.2e}, allowed \
                     {allowed:.2e}",
                    again.residual
                );
                effort.violations.push(at(report, &text));
            }
        }
        self.before = Some(accepted.body.clone());
    }

    /// Looks at the rigid bodies of a step.
    fn bodies(&mut self, accepted: &Accepted<'_, 2>) {
        let after = accepted.body;
        if after.rigid.is_empty() {
            return;
        }
        // The first stage of bodies names all of them; before it there are those that are there from the start.
        let all = after.rigid.len() == self.outlines.len();
        let there = std::iter::zip(&self.case.rigid, &self.outlines);
        let there = there.filter(|(part, _)| all || part.from_start);
        let outlines: Vec<&Outline> = there.map(|(_, outline)| outline).collect();
        let before = self.before.as_ref();
        // Bodies that came in with this step have no way behind them.
        let before = before.filter(|before| before.rigid.len() == after.rigid.len());
        let before = before.map(|before| (&before.particles, &before.rigid[..]));
        let found = reach(&outlines, before, (&after.particles, &after.rigid));
        let effort = &mut self.effort;
        effort.nearest = match (effort.nearest, found.nearest) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        let wrong = found
            .violations
            .into_iter()
            .chain(wrong_traction(&after.rigid));
        effort
            .contact
            .extend(wrong.map(|text| at(accepted.report, &text)));
    }
}

/// A remark with its step.
fn at(report: &StepReport, text: &str) -> String {
    format!("step {:.5} to {:.5}: {text}", report.from, report.to)
}
