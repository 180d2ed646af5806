//! The factor of safety as the limit of a path of equilibria, the strength reduction factor an unknown (theory,
//! eqs. 33a to 33f).

use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::StepWork;
use igimp_model::{ReductionPath, Stage, StrengthReduction};
use igimp_results::ending::{EndReason, PathEnd};
use igimp_results::summary::{PathPoint, PathSummary, SafetySummary, StageSummary, StrengthShares};
use igimp_solver::{
    Accepted, Body, ContinuationSettings, ContinuationState, Observed, Observer, StepError,
    StepFailure, follow,
};
use igimp_text::short;

use super::path_remarks::{self, MOST_FACTOR};
use super::shares::{LastStep, shares};
use super::{names, undeformed_or_found, weight_drains};
use crate::error::{CaseError, on_one_line};
use crate::limit::{self, Course};
use crate::run::Event;
use crate::run::model::{Model, displacement_scale};
use crate::run::resume::End;
use crate::run::session::{Session, StageEnd, StagePath, march_path};
use crate::run::stages::loading::begin;
use crate::run::state::{Controls, State};

/// A path begins at no smaller factor than this \[-\]: with so many times its strength a body that falls is one that
/// no strength holds.
const LEAST_FACTOR: f64 = 0.01;

/// How a path is followed.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// First change of the factor, as a share of it \[-\].
    first_change: f64,
    /// How many changes of the factor do work before steps of work; none: all, until one fails.
    direct_steps: Option<usize>,
}

impl Way {
    /// Two changes, and steps of work from there.
    const fn by_work(first_change: f64) -> Self {
        Self {
            first_change,
            direct_steps: Some(2),
        }
    }

    /// The settings of a path; its peak is resolved where soil softens.
    fn settings<const D: usize>(self, model: &Model<'_, D>) -> ContinuationSettings {
        ContinuationSettings {
            first_change: self.first_change,
            direct_steps: self.direct_steps.unwrap_or(usize::MAX),
            resolves_peak: (model.case.materials.iter()).any(|soil| soil.softening.is_some()),
            ..ContinuationSettings::new(model.march_settings(1).newton)
        }
    }
}

/// The ways of a path, each but the first where it was lost before. A corner that yields by itself takes all of the work of a step:
/// changes of the factor go past it.
const WAYS: [Way; 4] = [
    Way::by_work(0.05),
    Way {
        first_change: 0.05,
        direct_steps: None,
    },
    Way::by_work(0.035),
    Way::by_work(0.025),
];

/// Searches for the factor of safety of a state along a path of equilibria; the state is left as it was found.
pub(super) fn search<const D: usize>(
    session: &mut Session<'_, D>,
    state: &State<D>,
    number: usize,
    reduction: &StrengthReduction,
    summary: &mut StageSummary,
) -> Result<StageEnd, CaseError> {
    let stage = &session.model.case.stages[number];
    let base = undeformed_or_found(session.model, state, reduction)?;
    if reduction.path == ReductionPath::Reduce {
        // Displacements count from the start of the search, in the first row too.
        begin(session, &base, number)?;
    }
    let scale = displacement_scale(session.model, &base);
    let mut from = match reduction.path {
        ReductionPath::Reduce => 1.0,
        ReductionPath::Gravity => 0.5 * reduction.bracket[0].min(1.0),
    };
    let followed = loop {
        let search = Search {
            stage,
            reduction,
            found: &state.controls,
            weight_drains: weight_drains(session.model.case, number),
        };
        let (start, ended) = search.loaded(session, &base, from, summary)?;
        if let Some(StageEnd::Interrupted) = ended {
            return Ok(StageEnd::Interrupted);
        }
        let failed_to_load = matches!(ended, Some(StageEnd::NotConverged(_)));
        if !failed_to_load {
            let followed = search.follow_again(session, &start, from, summary)?;
            let is_lost = followed.is_lost();
            if !(is_lost && followed.points.is_empty()) || from <= LEAST_FACTOR {
                break followed;
            }
        } else if from <= LEAST_FACTOR {
            break Followed {
                ended: StageEnd::Completed(EndReason::NoStrengthHolds),
                points: Vec::new(),
                end: PathEnd::Lost,
                limit: None,
                last: None,
                shares: None,
            };
        }
        from = (0.5 * from).max(LEAST_FACTOR);
    };
    if matches!(followed.ended, StageEnd::Interrupted) {
        return Ok(StageEnd::Interrupted);
    }
    summary.reached = 1.0;
    Ok(finish(
        session,
        (number, reduction),
        followed,
        scale,
        summary,
    ))
}

/// A search along a path.
struct Search<'a> {
    stage: &'a Stage,
    reduction: &'a StrengthReduction,
    /// Controls of the state that was found.
    found: &'a Controls,
    /// Whether all soil drains while gravity is raised anew.
    weight_drains: bool,
}

/// A path that was followed.
struct Followed<const D: usize> {
    ended: StageEnd,
    points: Vec<PathPoint>,
    end: PathEnd,
    /// The equilibrium that tells the factor.
    limit: Option<PathPoint>,
    /// The last equilibrium, with that before.
    last: Option<End<D>>,
    /// The shares in the factor, or why they are unknown.
    shares: Option<Result<StrengthShares, StepFailure>>,
}

impl<const D: usize> Followed<D> {
    /// Whether the path was lost: no equilibrium was found beyond its last one.
    fn is_lost(&self) -> bool {
        matches!(self.ended, StageEnd::NotConverged(_))
    }

    /// Factor of the last equilibrium \[-\].
    fn reached(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.factor)
    }
}

impl Search<'_> {
    /// Controls at a strength reduction factor.
    fn at(&self, factor: f64) -> Controls {
        let mut controls = self.found.clone();
        controls.drained = self.stage.drained;
        if self.reduction.path == ReductionPath::Gravity && controls.gravity == 0.0 {
            controls.gravity = 1.0;
        }
        for &material in &self.reduction.materials {
            controls.srf[material] = factor;
        }
        controls
    }

    /// The state in which the path begins: that found, or undeformed bodies loaded at the strength of a factor; and how
    /// the loading ended.
    fn loaded<const D: usize>(
        &self,
        session: &mut Session<'_, D>,
        base: &State<D>,
        factor: f64,
        summary: &mut StageSummary,
    ) -> Result<(State<D>, Option<StageEnd>), CaseError> {
        let mut state = base.clone();
        if self.reduction.path == ReductionPath::Reduce {
            return Ok((state, None));
        }
        let mut from = base.controls.clone();
        for &material in &self.reduction.materials {
            from.srf[material] = factor;
        }
        let model = session.model;
        let mut to = self.at(factor);
        to.drained = self.weight_drains;
        let path = StagePath::of_equilibria(
            (&from, &to),
            model.method(self.stage.geometry),
            model.march_settings(self.stage.steps),
        );
        let ended = march_path(session, &mut state, &path, summary, &mut |_, _, _| Ok(None))?;
        state.body.particles.reset_displacements();
        Ok((state, Some(ended)))
    }

    /// Follows the path of a state from a strength reduction factor to its end; one that is lost once more with other first
    /// steps, and of those that are lost the one that came to the largest factor.
    fn follow_again<const D: usize>(
        &self,
        session: &mut Session<'_, D>,
        start: &State<D>,
        from: f64,
        summary: &mut StageSummary,
    ) -> Result<Followed<D>, CaseError> {
        let [usual, others @ ..] = WAYS;
        let mut furthest = self.follow(session, start, (from, usual), summary)?;
        for way in others {
            if !furthest.is_lost() || furthest.points.is_empty() {
                break;
            }
            let steps = match way.direct_steps {
                None => "steps of the factor".to_owned(),
                Some(_) => format!("first steps of {} %", short(100.0 * way.first_change)),
            };
            session.warn(format!(
                "the path of equilibria in stage \"{}\" was lost at {}, and is followed again with {steps}",
                self.stage.name,
                short(furthest.reached()),
            ));
            let again = self.follow(session, start, (from, way), summary)?;
            if !again.is_lost() || again.reached() > furthest.reached() {
                furthest = again;
            }
        }
        Ok(furthest)
    }

    /// Follows the path of a state from a strength reduction factor to its end, in one of the ways.
    fn follow<const D: usize>(
        &self,
        session: &mut Session<'_, D>,
        start: &State<D>,
        (from, way): (f64, Way),
        summary: &mut StageSummary,
    ) -> Result<Followed<D>, CaseError> {
        let model = session.model;
        let mut state = start.clone();
        let lowered = model.lowered(&start.controls);
        let load_path = |from: f64, to: f64| {
            let controls = (&self.at(from), &self.at(to));
            model.conditions_on(model.grid(lowered), controls, 0.0)
        };
        let settings = way.settings(model);
        let mut continuation = ContinuationState::start(from, None, &settings);
        let mut workspace = session.workspace();
        let mut watch = Watch::of(self, session, summary, &state.body);
        let method = model.method(self.stage.geometry);
        let failure = follow(
            &mut continuation,
            &mut state.body,
            &method,
            &settings,
            &mut workspace,
            &mut Observed {
                load_path: &load_path,
                observer: &mut watch,
            },
        );
        let Watch {
            before,
            points,
            mut end,
            mut limit,
            work,
            stopped,
            ..
        } = watch;
        state.controls = self.at(continuation.factor);
        let is_mechanism = limit::mechanism(&points).is_some();
        let shares = match (&before, &continuation.last, &work) {
            (Some(body), Some(last), Some((work, external_work, gross_work))) if is_mechanism => {
                let step = LastStep {
                    model,
                    method: &method,
                    body,
                    u: &last.u,
                    work,
                    external_work: *external_work,
                    gross_work: *gross_work,
                    srf: &state.controls.srf,
                    reduced: &self.reduction.materials,
                    factor: continuation.factor,
                    at: &|factor| load_path(continuation.factor, factor),
                };
                Some(shares(&step, &mut workspace))
            }
            _ => None,
        };
        // Systems of shares are none of a step.
        session.drop_system();
        let ended = match (stopped?, failure, limit::lost_past(&points)) {
            (Some(ended), ..) => ended,
            (None, Some(_), Some(largest)) => {
                (end, limit) = (PathEnd::Fallen, Some(largest));
                StageEnd::Completed(EndReason::PathEnded { end, reached: None })
            }
            (None, Some(error), None) => StageEnd::NotConverged(error),
            (None, None, _) => StageEnd::Completed(EndReason::StepsOfPathRanOut),
        };
        let srf = continuation.factor;
        let last = (!points.is_empty()).then_some(End { srf, state, before });
        Ok(Followed {
            ended,
            points,
            end,
            limit,
            last,
            shares,
        })
    }
}

/// Follows a path for its search.
struct Watch<'w, 's, const D: usize> {
    search: &'w Search<'w>,
    session: &'w mut Session<'s, D>,
    summary: &'w mut StageSummary,
    /// The equilibrium before the last one, and that.
    before: Option<Arc<Body<D>>>,
    last: Arc<Body<D>>,
    points: Vec<PathPoint>,
    end: PathEnd,
    limit: Option<PathPoint>,
    /// The work within the last step, and of the external force on it \[force·length\].
    work: Option<(StepWork, f64, f64)>,
    stopped: Result<Option<StageEnd>, CaseError>,
}

impl<'w, 's, const D: usize> Watch<'w, 's, D> {
    fn of(
        search: &'w Search<'w>,
        session: &'w mut Session<'s, D>,
        summary: &'w mut StageSummary,
        body: &Body<D>,
    ) -> Self {
        Self {
            search,
            session,
            summary,
            before: None,
            last: Arc::new(body.clone()),
            points: Vec::new(),
            end: PathEnd::Lost,
            limit: None,
            work: None,
            stopped: Ok(None),
        }
    }

    fn step(&mut self, accepted: &Accepted<'_, D>) -> Result<Option<StageEnd>, CaseError> {
        let report = accepted.report;
        let number = self.summary.steps + 1;
        self.session.tell(&Event::Equilibrium { number, accepted });
        self.session.tally(self.summary, report)?;
        self.session.keep_system(accepted.conditions, self.summary);
        let now = Arc::new(accepted.body.clone());
        self.before = Some(std::mem::replace(&mut self.last, now));
        let before = self.points.last().map_or(0.0, |point| point.work);
        let monitor = self.search.reduction.monitor;
        let particles = &accepted.body.particles;
        let displacement = self.session.displacement(monitor, particles);
        let work = before + report.gross_work;
        let point = limit::point(report, report.to, work, displacement);
        self.work =
            (report.work.clone()).map(|work| (work, report.external_work, report.gross_work));
        self.session.tell(&Event::Path { point: &point });
        self.points.push(point);
        if self.session.interrupted() {
            return Ok(Some(StageEnd::Interrupted));
        }
        let displacement = self.search.reduction.failure_displacement;
        let end = limit::end(&self.points, Course::RISING, displacement);
        Ok(match end {
            Some((end, limit)) => {
                (self.end, self.limit) = (end, Some(limit));
                Some(StageEnd::Completed(EndReason::PathEnded {
                    end,
                    reached: None,
                }))
            }
            None => {
                (report.to >= MOST_FACTOR).then_some(StageEnd::Completed(EndReason::NothingFails))
            }
        })
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

    fn on_return(&mut self, body: &Body<D>, steps: usize) {
        self.points.truncate(self.points.len() - steps);
        (self.before, self.last) = (None, Arc::new(body.clone()));
    }

    fn on_cut(&mut self, error: &StepError) {
        self.session.drop_system();
        let tally = self.session.tally_cut(self.summary, error);
        if let (Ok(_), Err(error)) = (&self.stopped, tally) {
            self.stopped = Err(error);
        }
    }
}

/// The factor of safety that a path tells, with its remarks.
fn finish<const D: usize>(
    session: &mut Session<'_, D>,
    (number, reduction): (usize, &StrengthReduction),
    followed: Followed<D>,
    scale: Option<f64>,
    summary: &mut StageSummary,
) -> StageEnd {
    let Followed {
        ended,
        points,
        end,
        limit,
        last,
        shares,
    } = followed;
    let shares = match shares {
        Some(Err(cause)) => {
            let cause = on_one_line(&cause);
            session.warn_of_stage(
                number,
                &format!("what decides the factor of safety is not known: {cause}"),
            );
            None
        }
        Some(Ok(shares)) => Some(shares),
        None => None,
    };
    let path = PathSummary {
        end,
        from: 0.0,
        mechanism: limit::mechanism(&points),
        limit,
        knee: limit::knee(&points, Course::RISING),
        rise: limit.and_then(|at| limit::rise(&points, Course::RISING, &at)),
        displacement_scale: scale,
        shares,
        points,
    };
    let (stable, failed) = limit::interval(&path);
    let case = session.model.case;
    let tension = (last.as_ref()).and_then(|end| super::remarks::tension(case, &end.state));
    for text in path_remarks::of(&path).into_iter().chain(tension) {
        session.warn_of_stage(number, &text);
    }
    if let StageEnd::NotConverged(cause) = &ended {
        let cause = on_one_line(&*cause.failure);
        session.warn_of_stage(
            number,
            &format!(
                "the path of equilibria was lost: {cause}; what it reached is no limit, and search = \"trials\" asks another way"
            ),
        );
    }
    let moving_mass = last
        .as_ref()
        .and_then(|end| super::remarks::moving_mass(&end.state));
    if let Some(output) = &mut session.output {
        output.keep_ends(last, None);
    }
    let whose = session.whose_displacement(reduction.monitor);
    let safety = SafetySummary {
        stable,
        failed,
        criterion: criterion(reduction, &whose),
        materials: names(session.model.case, reduction, true),
        excluded: names(session.model.case, reduction, false),
        moving_mass,
        trials: Vec::new(),
        path: Some(path),
    };
    session.records.factor_of_safety = safety.factor().unwrap_or(f64::NAN);
    if let Some(text) = super::remarks::local(&safety) {
        session.warn_of_stage(number, &text);
    }
    summary.safety = Some(safety);
    match ended {
        StageEnd::NotConverged(cause) => StageEnd::Completed(EndReason::PathLost {
            cause: cause.failure.to_string(),
        }),
        ended => ended,
    }
}

/// Criterion of failure, in words.
fn criterion(reduction: &StrengthReduction, whose: &str) -> String {
    let limit =
        "the increment is a mechanism and the factor rises no longer, on the given geometry";
    match reduction.failure_displacement {
        Some(displacement) => format!("{limit}, or {whose} exceeds {} m", short(displacement)),
        None => limit.to_owned(),
    }
}
