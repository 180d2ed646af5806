//! Limit loads on the given geometry: where the march of a stage finds no equilibrium at a greater load, the path of
//! equilibria goes on with the load factor as an unknown (theory, eqs. 33a to 33f).

use std::ops::ControlFlow;

use igimp_assembly::{AssemblyError, Geometry, StepConditions};
use igimp_model::{Driven, RigidMove, Stage, StageKind};
use igimp_results::ending::{EndReason, PathEnd};
use igimp_results::summary::{PathPoint, PathSummary, StageSummary};
use igimp_solver::{
    Accepted, ContinuationSettings, ContinuationState, LastStep, LoadPath, MarchSettings, Observer,
    StepError, follow,
};
use igimp_text::short;

use crate::error::{CaseError, on_one_line};
use crate::limit::{self, Course};
use crate::run::model::displacement_scale;
use crate::run::output::moment::Moment;
use crate::run::session::{Session, StageEnd};
use crate::run::state::{Controls, State};
use crate::run::{Event, rigid};

/// The first change of the load over the smallest one at which the march found no equilibrium \[-\].
const FIRST_CHANGE: f64 = 0.5;

/// Whether a stage goes on along its path of equilibria where its march finds none, or moves as a mechanism.
pub(crate) fn is_sought(stage: &Stage) -> bool {
    stage.stop_when.no_equilibrium
        && stage.geometry == Geometry::Given
        && stage.consolidation.is_none()
        && match &stage.kind {
            StageKind::Gravity { .. } | StageKind::Load { .. } => true,
            StageKind::Rigid(moves) => !moves.iter().any(RigidMove::is_moved),
            _ => false,
        }
}

/// Whether the path begins where a march ended.
pub(crate) fn begins(summary: &StageSummary, error: &StepError) -> bool {
    summary.reached > 0.0 && error.failure.is_want_of_equilibrium()
}

/// The factor of the control that a stage drives, or of the forces on rigid bodies, the share of them that was `reached`
/// \[-\].
fn factor(driven: Option<Driven>, controls: &Controls, reached: f64) -> f64 {
    match driven {
        None => reached,
        Some(Driven::Load(load)) => controls.factors[load],
        Some(Driven::Acceleration(component)) => controls.acceleration[component],
        Some(Driven::Gravity) => controls.gravity,
    }
}

/// The control that a stage drives from controls to controls, and its way.
fn way(stage: &Stage, from: &Controls, to: &Controls) -> (Option<Driven>, Course) {
    let driven = Driven::of(&stage.kind, |driven| factor(Some(driven), from, 0.0));
    let course = Course::between(factor(driven, from, 0.0), factor(driven, to, 1.0));
    (driven, course)
}

/// The settings of a path: it begins with a share of the smallest step at which the march found no equilibrium.
fn continuation_settings(
    march: MarchSettings,
    stage: &Stage,
    summary: &StageSummary,
) -> ContinuationSettings {
    let smallest = march.cut_factor.powi(march.cuts as i32) / stage.steps as f64;
    ContinuationSettings {
        first_change: FIRST_CHANGE * smallest / summary.reached,
        direct_steps: usize::MAX,
        ..ContinuationSettings::new(march.newton)
    }
}

/// Follows the path of a stage on from the last equilibrium of its march and the step that came there, from controls to controls.
pub(crate) fn follow_on<const D: usize>(
    session: &mut Session<'_, D>,
    state: &mut State<D>,
    (number, from, to): (usize, &Controls, &Controls),
    last: Option<LastStep<D>>,
    summary: &mut StageSummary,
) -> Result<StageEnd, CaseError> {
    let model = session.model;
    let stage = &model.case.stages[number];
    let settings = continuation_settings(model.march_settings(stage.steps), stage, summary);
    let mut continuation = ContinuationState::start(summary.reached, last, &settings);
    let mut workspace = session.workspace();
    let (driven, course) = way(stage, from, to);
    let begins = PathPoint {
        factor: factor(driven, &state.controls, summary.reached),
        work: summary.work,
        displacement: session.displacement(stage.stop_when.monitor, &state.body.particles),
        ..PathPoint::default()
    };
    let mut watch = Watch {
        number,
        stage,
        way: (from, to),
        controls: from.towards(to, summary.reached).moved_as(&state.controls),
        driven,
        course,
        points: vec![begins],
        end: PathEnd::Lost,
        limit: None,
        stopped: Ok(None),
        session,
        summary,
    };
    let failure = follow(
        &mut continuation,
        &mut state.body,
        &model.method(stage.geometry),
        &settings,
        &mut workspace,
        &mut watch,
    );
    let Watch {
        points,
        end,
        limit,
        stopped,
        controls,
        ..
    } = watch;
    state.controls = controls;
    summary.reached = continuation.factor;
    let ended = match (stopped?, failure) {
        (Some(ended), _) => ended,
        (None, Some(error)) => StageEnd::NotConverged(error),
        (None, None) => StageEnd::Stopped(EndReason::StepsOfPathRanOut),
    };
    if let StageEnd::NotConverged(error) = &ended {
        session.warn_of_stage(number, &lost(error));
    }
    let path = PathSummary {
        end,
        from: factor(driven, from, 0.0),
        mechanism: limit::mechanism(&points),
        limit,
        knee: limit::knee(&points, course),
        rise: limit.and_then(|at| limit::rise(&points, course, &at)),
        displacement_scale: displacement_scale(model, state),
        shares: None,
        points,
    };
    if let Some(text) = remark(&path, &stage.name) {
        session.warn(text);
    }
    summary.path = Some(path);
    Ok(ended)
}

/// The remark on a path that was lost.
fn lost(error: &StepError) -> String {
    let cause = on_one_line(&*error.failure);
    format!(
        "the path of equilibria was lost: {cause}; the load that it reached stands, and may not be the limit"
    )
}

/// The remark on the path.
fn remark(path: &PathSummary, stage: &str) -> Option<String> {
    let last = path.limit?;
    let text =
        |point: &PathPoint| format!("{} at {} m", short(point.factor), short(point.displacement));
    if path.end == PathEnd::Fallen {
        return Some(format!(
            "stage \"{stage}\": the limit of the load factor is the furthest, {}, from which it has gone back; checks take it with at = \"peak\"",
            text(&last)
        ));
    }
    if path.end != PathEnd::StillRising {
        return None;
    }
    let mechanism = path.mechanism?;
    let since = match limit::gone_back_from(path, &last) {
        Some(furthest) => format!(
            "has gone back since from {}, which is its limit, to {}",
            text(&furthest),
            text(&last)
        ),
        None => format!(
            "still {}, by {} % in the last doubling of the work, to {}",
            if last.factor.abs() < path.from.abs() {
                "falls"
            } else {
                "rises"
            },
            short(100.0 * path.rise.unwrap_or(0.0)),
            text(&last)
        ),
    };
    Some(format!(
        "stage \"{stage}\": the body moves as a mechanism from load factor {} on, and on the given geometry the load {since}",
        text(&mechanism)
    ))
}

/// Follows a path for its stage.
struct Watch<'w, 's, const D: usize> {
    number: usize,
    stage: &'w Stage,
    /// The controls that the path goes from and to.
    way: (&'w Controls, &'w Controls),
    /// Those of the last equilibrium.
    controls: Controls,
    /// The control that tells the factor; none: forces on rigid bodies.
    driven: Option<Driven>,
    course: Course,
    session: &'w mut Session<'s, D>,
    summary: &'w mut StageSummary,
    points: Vec<PathPoint>,
    end: PathEnd,
    limit: Option<PathPoint>,
    stopped: Result<Option<StageEnd>, CaseError>,
}

impl<const D: usize> Watch<'_, '_, D> {
    /// The controls at a load factor, with the motion of the last equilibrium.
    fn at(&self, factor: f64) -> Controls {
        let (from, to) = self.way;
        from.towards(to, factor).moved_as(&self.controls)
    }

    fn step(&mut self, accepted: &Accepted<'_, D>) -> Result<Option<StageEnd>, CaseError> {
        let report = accepted.report;
        let number = self.summary.steps + 1;
        self.session.tell(&Event::Equilibrium { number, accepted });
        self.session.tally(self.summary, report)?;
        self.session.keep_system(accepted.conditions, self.summary);
        let controls = rigid::moved(self.session.model.case, self.at(report.to), accepted);
        self.controls = controls.clone();
        let particles = &accepted.body.particles;
        self.session.record(&Moment {
            stage: self.number,
            number: self.summary.steps,
            progress: report.to,
            grid: &accepted.conditions.grid,
            particles,
            rigid: &accepted.body.rigid,
            reinforcement: &accepted.body.reinforcement,
            controls: &controls,
            resistance: 0.0,
            plastic_share: report.plastic_share,
            energy: None,
        })?;
        self.session.tell(&Event::Step {
            number,
            progress: report.to,
            report,
        });
        let stop = &self.stage.stop_when;
        let displacement = self.session.displacement(stop.monitor, particles);
        let factor = factor(self.driven, &controls, report.to);
        let point = limit::point(report, factor, self.summary.work, displacement);
        self.points.push(point);
        if self.session.interrupted() {
            return Ok(Some(StageEnd::Interrupted));
        }
        if report.to >= 1.0 {
            return Ok(Some(StageEnd::Stopped(EndReason::LimitBeyondLoad)));
        }
        let end = limit::end(&self.points, self.course, stop.displacement);
        Ok(end.map(|(end, limit)| {
            (self.end, self.limit) = (end, Some(limit));
            StageEnd::Stopped(EndReason::PathEnded {
                end,
                reached: Some(report.to),
            })
        }))
    }
}

impl<const D: usize> LoadPath<D> for Watch<'_, '_, D> {
    fn conditions(&self, from: f64, to: f64) -> Result<StepConditions<D>, AssemblyError> {
        let model = self.session.model;
        let grid = model.grid(model.lowered(self.way.0));
        model.conditions_on(grid, (&self.at(from), &self.at(to)), 0.0)
    }
}

impl<const D: usize> Observer<D> for Watch<'_, '_, D> {
    fn on_step(&mut self, accepted: &Accepted<'_, D>) -> ControlFlow<()> {
        if self.stopped.as_ref().is_ok_and(Option::is_none) {
            self.stopped = self.step(accepted);
        }
        match self.stopped {
            Ok(None) => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }

    fn on_cut(&mut self, error: &StepError) {
        self.session.drop_system();
        let tally = self.session.tally_cut(self.summary, error);
        if let (Ok(_), Err(error)) = (&self.stopped, tally) {
            self.stopped = Err(error);
        }
    }
}
