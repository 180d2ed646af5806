//! The factor of safety by strength reduction: an interval, found by a search that always ends
//! (theory, eqs. 31 to 34).

mod continuation;
mod criterion;
mod interval;
mod path_remarks;
mod remarks;
mod shares;
mod trial;

use std::sync::Arc;

use igimp_assembly::Geometry;
use igimp_model::{Case, ReductionPath, SearchMethod, Stage, StageKind, StrengthReduction};
use igimp_results::ending::EndReason;
use igimp_results::summary::{SafetySummary, StageSummary, TrialSummary};
use igimp_solver::Body;
use igimp_text::short;

use self::criterion::default_limit;
use self::interval::next_factor;
use self::remarks::{few_cells, holds_its_weight, moving_mass, remarks, tension};
use super::loading::begin;
use crate::error::CaseError;
use crate::run::Event;
use crate::run::model::{Model, height};
use crate::run::resume::{End, Search};
use crate::run::session::{Session, StageEnd, StagePath, march_path};
use crate::run::state::{Controls, State};

/// Most trials that a search makes before it reports the interval that it has.
const MOST_TRIALS: usize = 40;

/// Trials without a single equilibrium after which no other strength is tried.
const FUTILE_TRIALS: usize = 4;

/// Displacements of the last standing state above this share of the height are worth a remark \[-\].
const SLID: f64 = 0.01;

/// Searches for the factor of safety of a state at rest, which is left as it was found, with its motion.
pub(crate) fn reduce_strength<const D: usize>(
    session: &mut Session<'_, D>,
    state: &State<D>,
    number: usize,
    reduction: &StrengthReduction,
    summary: &mut StageSummary,
    left: Option<Search<D>>,
) -> Result<StageEnd, CaseError> {
    let cell = session.model.cell_height()?;
    for &material in &reduction.materials {
        let material = &session.model.case.materials[material];
        if let Some(least) = material.least_cohesion(cell) {
            session.warn_of_stage(number, &format!(
                "\"{}\" counts with a cohesion of {} kPa, γh/400, which the cells at its face need",
                material.name,
                short(1e-3 * least)
            ));
        }
    }
    let still = state.at_rest();
    let ended = match reduction.search {
        SearchMethod::Continuation => {
            continuation::search(session, &still, number, reduction, summary)
        }
        SearchMethod::Trials => {
            by_trials(session, (state, &still), number, reduction, summary, left)
        }
    };
    if summary.safety.is_some()
        && let Some(text) = few_cells(session.model.case, &state.body.particles)
    {
        session.warn_of_stage(number, &text);
    }
    ended
}

/// Searches by trials, each of which stands or fails, from a state as it was found and at rest.
fn by_trials<const D: usize>(
    session: &mut Session<'_, D>,
    (kept, state): (&State<D>, &State<D>),
    number: usize,
    reduction: &StrengthReduction,
    summary: &mut StageSummary,
    left: Option<Search<D>>,
) -> Result<StageEnd, CaseError> {
    let stage = &session.model.case.stages[number];
    let mut trials = Trials::new(session, (kept, state), number, stage, reduction, left)?;
    // Where gravity is raised anew the state found is none that a trial begins with.
    if trials.made.is_empty() && reduction.path == ReductionPath::Reduce {
        // Displacements of trials count from the start of the search, and so does the first row.
        begin(session, &trials.base, number)?;
    }
    if let Some(text) = holds_its_weight(session.model.case, number, reduction) {
        session.warn_of_stage(number, &text);
    }
    let ended = trials.search(session, summary);
    summary.safety = Some(trials.finish(session));
    ended
}

/// The trials of one search.
struct Trials<'a, const D: usize> {
    number: usize,
    stage: &'a Stage,
    reduction: &'a StrengthReduction,
    /// The state that goes on after the search, with its motion.
    kept: &'a State<D>,
    /// The state that the search was asked for, at rest.
    found: &'a State<D>,
    /// The displacement at which the body counts as failed \[m\], if one does.
    limit: Option<f64>,
    /// The beginning of every trial: that state, or undeformed bodies where gravity is raised anew.
    base: State<D>,
    made: Vec<TrialSummary>,
    /// The largest stable factor, with its equilibrium.
    stable: Option<End<D>>,
    /// The smallest failed factor, with the last equilibrium on the way to it.
    failed: Option<End<D>>,
}

impl<'a, const D: usize> Trials<'a, D> {
    fn new(
        session: &Session<'_, D>,
        (kept, found): (&'a State<D>, &'a State<D>),
        number: usize,
        stage: &'a Stage,
        reduction: &'a StrengthReduction,
        left: Option<Search<D>>,
    ) -> Result<Self, CaseError> {
        let base = undeformed_or_found(session.model, found, reduction)?;
        let limit = reduction
            .failure_displacement
            .or_else(|| default_limit(session.model, stage, &base));
        let left = left.unwrap_or_default();
        Ok(Self {
            number,
            stage,
            reduction,
            kept,
            found,
            limit,
            base,
            made: left.trials,
            stable: left.stable,
            failed: left.failed,
        })
    }

    /// Makes trials until the interval is narrow enough.
    fn search(
        &mut self,
        session: &mut Session<'_, D>,
        summary: &mut StageSummary,
    ) -> Result<StageEnd, CaseError> {
        while let Some(srf) = self.next() {
            if session.interrupted() {
                return Ok(StageEnd::Interrupted);
            }
            if let Some(ended) = self.trial(session, summary, srf)? {
                return Ok(ended);
            }
            if let Some(output) = &mut session.output {
                let search = Search {
                    trials: self.made.clone(),
                    stable: self.stable.clone(),
                    failed: self.failed.clone(),
                };
                output.after_trial(
                    self.number,
                    session.model.case,
                    summary,
                    self.kept,
                    &search,
                    &session.summary,
                )?;
            }
        }
        summary.reached = 1.0;
        Ok(StageEnd::Completed(EndReason::IntervalIsNarrow))
    }

    /// The factor to try next: those that the case lists, then F = 1, then the search.
    fn next(&self) -> Option<f64> {
        let made = self.made.len();
        if let Some(&listed) = self.reduction.factors.get(made) {
            return Some(listed);
        }
        if !self.made.iter().any(at_full_strength) {
            return Some(1.0);
        }
        if made >= MOST_TRIALS + self.reduction.factors.len()
            || stands_nowhere(&self.made, self.reduction.path)
        {
            return None;
        }
        let [low, high] = self.reduction.bracket;
        let stable = self.stable.as_ref().map(|end| end.srf);
        let failed = self.failed.as_ref().map(|end| end.srf);
        // A march of the reduction ends at the last equilibrium, most likely just below the factor
        // of safety: the search goes on in small strides from there.
        let stride = match self.reduction.path {
            ReductionPath::Gravity => f64::INFINITY,
            ReductionPath::Reduce => {
                let since_failure = self.made.iter().rev().take_while(|trial| trial.stable);
                self.reduction.tolerance * 2.0_f64.powi(since_failure.count() as i32)
            }
        };
        next_factor(
            (stable, failed),
            (low, high),
            self.reduction.tolerance,
            stride,
        )
    }

    /// Tries a factor; `Some` when the search cannot go on: the user interrupted, or a step failed for
    /// other reasons than want of equilibrium.
    fn trial(
        &mut self,
        session: &mut Session<'_, D>,
        summary: &mut StageSummary,
        srf: f64,
    ) -> Result<Option<StageEnd>, CaseError> {
        let listed = self.made.len() < self.reduction.factors.len();
        let (mut state, from, mut before) = self.start(srf);
        let to = self.end(srf);
        let settings = self.settings(session.model, &from, srf);
        let method = session.model.method(self.stage.geometry);
        let path = StagePath::of_equilibria((&from, &to), method, settings);
        let effort = [summary.steps, summary.iterations, summary.cuts];
        let reduction = self.reduction;
        let limit = self.limit;
        let mut course: Vec<[f64; 2]> = Vec::new();
        // The last equilibrium, and the last within the criterion.
        let mut last = Arc::new(state.body.clone());
        let mut within: Option<End<D>> = None;
        let ended = march_path(
            session,
            &mut state,
            &path,
            summary,
            &mut |session, _, taken| {
                let now = Arc::new(taken.accepted.body.clone());
                before = Some(std::mem::replace(&mut last, now));
                let particles = &taken.accepted.body.particles;
                let displacement = session.displacement(reduction.monitor, particles);
                let failed = limit.is_some_and(|limit| displacement > limit);
                if reduction.path == ReductionPath::Reduce {
                    course.push([taken.controls.srf[reduction.materials[0]], displacement]);
                }
                if !failed && reduction.path == ReductionPath::Reduce {
                    let state = State {
                        body: taken.accepted.body.clone(),
                        controls: taken.controls.clone(),
                    };
                    within = Some(End {
                        srf: taken.controls.srf[reduction.materials[0]],
                        state,
                        before: before.clone(),
                    });
                }
                Ok((failed && !listed).then(|| self.exceeded(session)))
            },
        )?;
        match &ended {
            StageEnd::Interrupted => return Ok(Some(ended)),
            // It tells nothing of the strength that the body needs.
            StageEnd::NotConverged(cause) if !cause.failure.is_want_of_equilibrium() => {
                return Ok(Some(ended));
            }
            _ => {}
        }
        let srf = self.reached(&ended, &from, &state.controls, srf);
        let displacement = session.displacement(reduction.monitor, &state.body.particles);
        let (stable, reason) = self.outcome(session, &ended, &state, displacement);
        let trial = TrialSummary {
            srf,
            stable,
            reason,
            displacement,
            steps: summary.steps - effort[0],
            iterations: summary.iterations - effort[1],
            cuts: summary.cuts - effort[2],
            course,
        };
        session.tell(&Event::Trial {
            trial: &trial,
            state: &state,
        });
        self.made.push(trial);
        if listed && !matches!(ended, StageEnd::NotConverged(_)) {
            self.record(session, &state, summary.plastic_share)?;
        }
        let end = End { srf, state, before };
        self.narrow(session, stable, end, within);
        Ok(None)
    }

    /// The factor of a trial that was asked for one: a reduction fails at the factor that it reached by the criterion, or at the
    /// smallest one at which it found no equilibrium.
    fn reached(&self, ended: &StageEnd, from: &Controls, last: &Controls, srf: f64) -> f64 {
        let reduced = self.reduction.materials[0];
        match (ended, self.reduction.path) {
            (StageEnd::Stopped(_), ReductionPath::Reduce) => last.srf[reduced],
            (StageEnd::NotConverged(cause), ReductionPath::Reduce) => {
                from.srf[reduced] + cause.to * (srf - from.srf[reduced])
            }
            _ => srf,
        }
    }

    /// Whether a trial stands, and why.
    fn outcome(
        &self,
        session: &Session<'_, D>,
        ended: &StageEnd,
        state: &State<D>,
        displacement: f64,
    ) -> (bool, String) {
        match ended {
            StageEnd::NotConverged(cause) => (false, self.no_equilibrium(state, cause)),
            _ if self.limit.is_some_and(|limit| displacement > limit) => {
                (false, self.exceeded(session).to_string())
            }
            _ => (true, "in equilibrium".to_owned()),
        }
    }

    /// Where a trial begins: the stable state of the largest smaller factor, or the base; with the
    /// equilibrium before it.
    fn start(&self, srf: f64) -> (State<D>, Controls, Option<Arc<Body<D>>>) {
        match (self.reduction.path, &self.stable) {
            (ReductionPath::Reduce, Some(end)) if end.srf <= srf => {
                let (state, before) = (end.state.clone(), end.before.clone());
                let from = state.controls.clone();
                (state, from, before)
            }
            (ReductionPath::Reduce, _) => (self.base.clone(), self.found.controls.clone(), None),
            (ReductionPath::Gravity, _) => {
                let mut from = self.base.controls.clone();
                for &material in &self.reduction.materials {
                    from.srf[material] = srf;
                }
                (self.base.clone(), from, None)
            }
        }
    }

    /// Takes a trial into the interval.
    fn narrow(
        &mut self,
        session: &mut Session<'_, D>,
        stable: bool,
        end: End<D>,
        within: Option<End<D>>,
    ) {
        let below_failed =
            |srf: f64, failed: &Option<End<D>>| failed.as_ref().is_none_or(|f| srf < f.srf);
        let mut candidates: Vec<End<D>> = within.into_iter().collect();
        if stable {
            if !below_failed(end.srf, &self.failed) {
                session.warn_of_stage(
                    self.number,
                    &format!(
                        "the slope stands at SRF {:.4} though it failed at a smaller factor; \
                     the factor of safety is that of the smallest factor that failed",
                        end.srf
                    ),
                );
            }
            candidates.push(end);
        } else if below_failed(end.srf, &self.failed) {
            self.failed = Some(end);
        }
        for end in candidates {
            let larger = self.stable.as_ref().is_none_or(|s| end.srf >= s.srf);
            if larger && below_failed(end.srf, &self.failed) {
                self.stable = Some(end);
            }
        }
        if let (Some(stable), Some(failed)) = (&self.stable, &self.failed)
            && stable.srf >= failed.srf
        {
            self.stable = None;
        }
    }

    /// A remark when the last standing state of a moving geometry is no longer the slope that was asked for.
    fn slid(&self, session: &Session<'_, D>) -> Option<String> {
        let End { srf, state, .. } = self.stable.as_ref()?;
        let particles = &state.body.particles;
        let moved = session.displacement(self.reduction.monitor, particles);
        let height = height(&self.base);
        let far = self.stage.geometry == Geometry::Moving && moved > SLID * height;
        far.then(|| {
            format!(
                "the state that stands at SRF {srf:.4} has moved {} m, {} % of the height: the factor is \
                 that of a flatter slope; geometry = \"given\" asks for that of the slope as it is",
                short(moved),
                short(100.0 * moved / height)
            )
        })
    }

    /// The interval with its criterion; warns of its remarks.
    fn finish(self, session: &mut Session<'_, D>) -> SafetySummary {
        let case = session.model.case;
        let mut criterion = match self.stage.geometry {
            Geometry::Given => "no equilibrium is found on the given geometry".to_owned(),
            Geometry::Moving => "no equilibrium is found".to_owned(),
        };
        if self.limit.is_some() {
            criterion = format!("{criterion}, or {}", self.exceeded(session));
        }
        let moving_mass = self.failed.as_ref().and_then(|end| moving_mass(&end.state));
        let tension = (self.failed.as_ref()).and_then(|end| tension(case, &end.state));
        let stable = self.stable.as_ref().map(|end| end.srf);
        let failed = self.failed.as_ref().map(|end| end.srf);
        let slid = self.slid(session);
        let safety = SafetySummary {
            stable,
            failed,
            criterion,
            materials: names(case, self.reduction, true),
            excluded: names(case, self.reduction, false),
            moving_mass,
            trials: self.made,
            path: None,
        };
        let remarks = remarks(&safety, self.reduction).into_iter();
        for text in remarks.chain(slid).chain(tension) {
            session.warn_of_stage(self.number, &text);
        }
        session.records.factor_of_safety = safety.factor().unwrap_or(f64::NAN);
        if let Some(output) = &mut session.output {
            output.keep_ends(self.stable, self.failed);
        }
        safety
    }
}

/// The beginning of a search: the state found, or undeformed bodies where gravity is raised anew. Displacements count
/// from there.
fn undeformed_or_found<const D: usize>(
    model: &Model<'_, D>,
    found: &State<D>,
    reduction: &StrengthReduction,
) -> Result<State<D>, CaseError> {
    let mut base = match reduction.path {
        ReductionPath::Reduce => found.clone(),
        ReductionPath::Gravity => model.undeformed(found)?,
    };
    base.body.particles.reset_displacements();
    Ok(base)
}

/// Whether all soil drained while its weight came on, of the stages that lead to a search: under gravity, or as K₀ gave its stress.
fn weight_drains<const D: usize>(case: &Case<D>, number: usize) -> bool {
    let stages = &case.stages;
    let mut before = std::iter::successors(Some(number), |&k| stages[k].start_from).skip(1);
    let drains = before.find_map(|k| match stages[k].kind {
        StageKind::Gravity { .. } => Some(stages[k].drained),
        StageKind::K0 => Some(true),
        _ => None,
    });
    drains.unwrap_or(stages[number].drained)
}

/// Names of the materials that a search reduces, or of the others.
fn names<const D: usize>(
    case: &Case<D>,
    reduction: &StrengthReduction,
    reduced: bool,
) -> Vec<String> {
    case.materials
        .iter()
        .enumerate()
        .filter(|(k, _)| reduction.materials.contains(k) == reduced)
        .map(|(_, material)| material.name.clone())
        .collect()
}

/// Whether a trial is the one at F = 1.
fn at_full_strength(trial: &TrialSummary) -> bool {
    (trial.srf - 1.0).abs() < 1e-9
}

/// Whether so many reductions failed before their first equilibrium that the failure is none of strength.
fn stands_nowhere(trials: &[TrialSummary], path: ReductionPath) -> bool {
    path == ReductionPath::Reduce
        && trials.len() >= FUTILE_TRIALS
        && trials.iter().all(|trial| !trial.stable && trial.steps == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(srf: f64, stable: bool, steps: usize) -> TrialSummary {
        TrialSummary {
            srf,
            stable,
            reason: String::new(),
            displacement: 0.0,
            steps,
            iterations: 0,
            cuts: 0,
            course: Vec::new(),
        }
    }

    #[test]
    fn four_trials_without_an_equilibrium_tell_nothing_of_strength() {
        let futile = [1.0, 0.5, 0.25, 0.125].map(|srf| trial(srf, false, 0));
        assert!(stands_nowhere(&futile, ReductionPath::Reduce));
        assert!(!stands_nowhere(&futile[1..], ReductionPath::Reduce));
        // Raised gravity finds its first equilibrium under a part of the weight or not at all.
        assert!(!stands_nowhere(&futile, ReductionPath::Gravity));
        for found in [trial(0.125, true, 1), trial(0.125, false, 1)] {
            let mut trials = futile.clone();
            trials[3] = found;
            assert!(!stands_nowhere(&trials, ReductionPath::Reduce));
        }
    }
}
