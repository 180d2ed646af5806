//! The factor of safety by strength reduction: an interval, found by a search that always ends
//! (theory, eqs. 31 to 34).

use std::sync::Arc;

use igimp_assembly::Geometry;
use igimp_solver::{Body, MarchSettings, StepError};

use super::Event;
use super::left::{End, Search};
use super::loading::begin;
use super::model::Model;
use super::records::{Moment, largest_displacement};
use super::session::{Ended, Path, Session, march_path};
use super::state::{Controls, State};
use crate::case::{ReductionPath, Stage, StrengthReduction};
use crate::check::short;
use crate::error::CaseError;
use crate::summary::{SafetySummary, StageSummary, TrialSummary};

/// Most trials that a search makes before it reports the interval that it has.
const MOST_TRIALS: usize = 40;

/// The search goes no further down than this factor \[-\]: with a hundred times its strength a body
/// that falls is one that no strength holds.
const LEAST_FACTOR: f64 = 0.01;

/// A particle moves when its displacement exceeds this share of the largest \[-\].
const MOVING: f64 = 0.1;

/// Displacements of the last standing state above this share of the height are worth a remark \[-\].
const SLID: f64 = 0.01;

/// A moving share of the mass below this is called local \[-\].
const LOCAL: f64 = 0.02;

/// Searches for the factor of safety of a state, which is left as it was found.
pub(crate) fn reduce_strength(
    session: &mut Session<'_>,
    state: &State,
    number: usize,
    reduction: &StrengthReduction,
    summary: &mut StageSummary,
    left: Option<Search>,
) -> Result<Ended, CaseError> {
    let stage = &session.model.case.stages[number];
    let mut trials = Trials::new(session, state, number, stage, reduction, left)?;
    // Where gravity is raised anew the state found is none that a trial begins with.
    if trials.made.is_empty() && reduction.path == ReductionPath::Reduce {
        begin(session, state, number)?;
    }
    let ended = trials.search(session, summary);
    summary.safety = Some(trials.finish(session));
    ended
}

/// The trials of one search.
struct Trials<'a> {
    number: usize,
    stage: &'a Stage,
    reduction: &'a StrengthReduction,
    /// The state that the search was asked for.
    found: &'a State,
    /// The displacement at which the body counts as failed \[m\], if one does.
    limit: Option<f64>,
    /// What every trial begins with: that state, or undeformed bodies where gravity is raised anew.
    base: State,
    made: Vec<TrialSummary>,
    /// The largest stable factor, with its equilibrium.
    stable: Option<End>,
    /// The smallest failed factor, with the last equilibrium on the way to it.
    failed: Option<End>,
}

impl<'a> Trials<'a> {
    fn new(
        session: &Session<'_>,
        found: &'a State,
        number: usize,
        stage: &'a Stage,
        reduction: &'a StrengthReduction,
        left: Option<Search>,
    ) -> Result<Self, CaseError> {
        let mut base = match reduction.path {
            ReductionPath::Reduce => found.clone(),
            ReductionPath::Gravity => Model::new(session.model.case)?.1,
        };
        base.body.particles.reset_displacements();
        let limit = reduction
            .failure_displacement
            .or_else(|| default_limit(session.model, stage, &base));
        let left = left.unwrap_or_default();
        Ok(Self {
            number,
            stage,
            reduction,
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
        session: &mut Session<'_>,
        summary: &mut StageSummary,
    ) -> Result<Ended, CaseError> {
        while let Some(srf) = self.next() {
            if session.interrupted() {
                return Ok(Ended::Interrupted);
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
                    self.found,
                    &search,
                    &session.summary,
                )?;
            }
        }
        summary.reached = 1.0;
        Ok(Ended::Completed("the interval is narrow enough".to_owned()))
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
        if made >= MOST_TRIALS + self.reduction.factors.len() {
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
        session: &mut Session<'_>,
        summary: &mut StageSummary,
        srf: f64,
    ) -> Result<Option<Ended>, CaseError> {
        let listed = self.made.len() < self.reduction.factors.len();
        let (mut state, from, mut before) = self.start(srf);
        let to = self.end(srf);
        let settings = self.settings(session.model, &from, srf);
        let path = Path {
            from: &from,
            to: &to,
            drag: &|_, _| 0.0,
            method: session.model.method(self.stage.geometry),
            settings,
            left: None,
        };
        let effort = [summary.steps, summary.iterations, summary.cuts];
        let reduction = self.reduction;
        let limit = self.limit;
        let mut course: Vec<[f64; 2]> = Vec::new();
        // The last equilibrium, and the last within the criterion.
        let mut last = Arc::new(state.body.clone());
        let mut within: Option<End> = None;
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
            Ended::Interrupted => return Ok(Some(ended)),
            // It tells nothing of the strength that the body needs.
            Ended::NotConverged(cause) if !cause.failure.is_want_of_equilibrium() => {
                return Ok(Some(ended));
            }
            _ => {}
        }
        // A reduction fails at the factor that it reached by the criterion, or at the smallest one at
        // which it found no equilibrium.
        let begun = from.srf[reduction.materials[0]];
        let srf = match (&ended, reduction.path) {
            (Ended::Stopped(_), ReductionPath::Reduce) => {
                state.controls.srf[reduction.materials[0]]
            }
            (Ended::NotConverged(cause), ReductionPath::Reduce) => begun + cause.to * (srf - begun),
            _ => srf,
        };
        let displacement = session.displacement(reduction.monitor, &state.body.particles);
        let exceeded = limit.is_some_and(|limit| displacement > limit);
        let (stable, reason) = match &ended {
            Ended::NotConverged(cause) => (false, self.no_equilibrium(&state, cause)),
            _ if exceeded => (false, self.exceeded(session)),
            _ => (true, "in equilibrium".to_owned()),
        };
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
        if listed && !matches!(ended, Ended::NotConverged(_)) {
            self.record(session, &state, summary.plastic_share)?;
        }
        let end = End { srf, state, before };
        self.narrow(session, stable, end, within);
        Ok(None)
    }

    /// Where a trial begins: the stable state of the largest smaller factor, or the base; with the
    /// equilibrium before it.
    fn start(&self, srf: f64) -> (State, Controls, Option<Arc<Body<2>>>) {
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

    /// What acts at the end of a trial: what was found with strength reduced, and gravity in full
    /// where none acted yet.
    fn end(&self, srf: f64) -> Controls {
        let mut end = self.found.controls.clone();
        if self.reduction.path == ReductionPath::Gravity && end.gravity == 0.0 {
            end.gravity = 1.0;
        }
        for &material in &self.reduction.materials {
            end.srf[material] = srf;
        }
        end
    }

    /// Steps of a trial: by gravity those of the stage; of a reduction, one on the way to the lower end of
    /// the bracket, where equilibrium is expected, and beyond it in strides of which the stage has so many
    /// from full strength to the upper end. A reduction is cut until its step is no wider than the tolerance, and once more.
    fn settings(&self, model: &Model<'_>, from: &Controls, srf: f64) -> MarchSettings {
        let [low, high] = self.reduction.bracket;
        if self.reduction.path == ReductionPath::Gravity {
            return model.march_settings(self.stage.steps);
        }
        let way = (srf - from.srf[self.reduction.materials[0]]).abs();
        let stride = (high - low).max(high - 1.0) / self.stage.steps as f64;
        let steps = if srf <= low {
            1
        } else {
            ((way / stride).ceil() as usize).max(1)
        };
        let mut settings = model.march_settings(steps);
        let wide = way / steps as f64 / self.reduction.tolerance;
        let halvings = (wide.max(1.0).ln() / -settings.cut_factor.ln()).ceil();
        settings.cuts = settings.cuts.max(halvings as u32 + 1);
        settings
    }

    fn exceeded(&self, session: &Session<'_>) -> String {
        let limit = self.limit.unwrap_or(f64::INFINITY);
        let whose = session.whose_displacement(self.reduction.monitor);
        format!("{whose} exceeds {} m", short(limit))
    }

    fn no_equilibrium(&self, state: &State, cause: &StepError) -> String {
        let failure = &cause.failure;
        match self.reduction.path {
            ReductionPath::Gravity => {
                let reached = short(cause.from);
                format!("no equilibrium beyond {reached} of the load: {failure}")
            }
            ReductionPath::Reduce => {
                let reached = state.controls.srf[self.reduction.materials[0]];
                format!("no equilibrium beyond SRF {reached:.4}: {failure}")
            }
        }
    }

    /// Adds the row of a listed factor to the curves.
    fn record(
        &self,
        session: &mut Session<'_>,
        state: &State,
        plastic_share: f64,
    ) -> Result<(), CaseError> {
        session.record(&Moment {
            stage: self.number,
            number: self.made.len(),
            progress: 1.0,
            particles: &state.body.particles,
            controls: &state.controls,
            resistance: 0.0,
            plastic_share,
        })
    }

    /// Takes a trial into the interval.
    fn narrow(&mut self, session: &mut Session<'_>, stable: bool, end: End, within: Option<End>) {
        let below_failed =
            |srf: f64, failed: &Option<End>| failed.as_ref().is_none_or(|f| srf < f.srf);
        let mut candidates: Vec<End> = within.into_iter().collect();
        if stable {
            if !below_failed(end.srf, &self.failed) {
                session.warn(format!(
                    "the slope stands at SRF {:.4} though it failed at a smaller factor; \
                     the factor of safety is that of the smallest factor that failed",
                    end.srf
                ));
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
    fn slid(&self, session: &Session<'_>) -> Option<String> {
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

    /// The interval with its criterion; warns of what a reader has to know.
    fn finish(self, session: &mut Session<'_>) -> SafetySummary {
        let case = session.model.case;
        let names = |reduced: bool| -> Vec<String> {
            case.materials
                .iter()
                .enumerate()
                .filter(|(k, _)| self.reduction.materials.contains(k) == reduced)
                .map(|(_, material)| material.name.clone())
                .collect()
        };
        let mut criterion = match self.stage.geometry {
            Geometry::Given => "no equilibrium is found on the given geometry".to_owned(),
            Geometry::Moving => "no equilibrium is found".to_owned(),
        };
        if self.limit.is_some() {
            criterion = format!("{criterion}, or {}", self.exceeded(session));
        }
        let moving_mass = self.failed.as_ref().map(|end| moving_mass(&end.state));
        let stable = self.stable.as_ref().map(|end| end.srf);
        let failed = self.failed.as_ref().map(|end| end.srf);
        let slid = self.slid(session);
        let safety = SafetySummary {
            stable,
            failed,
            criterion,
            materials: names(true),
            excluded: names(false),
            moving_mass,
            trials: self.made,
        };
        for text in remarks(&safety, self.reduction).into_iter().chain(slid) {
            session.warn(text);
        }
        session.records.factor_of_safety = match (stable, failed) {
            (Some(stable), Some(failed)) => 0.5 * (stable + failed),
            _ => f64::NAN,
        };
        if let Some(output) = &mut session.output {
            output.keep_ends(self.stable, self.failed);
        }
        safety
    }
}

/// Whether a trial is the one at F = 1.
fn at_full_strength(trial: &TrialSummary) -> bool {
    (trial.srf - 1.0).abs() < 1e-9
}

/// What a reader has to know about an interval.
fn remarks(safety: &SafetySummary, reduction: &StrengthReduction) -> Vec<String> {
    let mut remarks = Vec::new();
    let [low, high] = reduction.bracket;
    if safety
        .trials
        .iter()
        .any(|trial| at_full_strength(trial) && !trial.stable)
    {
        remarks.push(
            "the body does not stand at full strength (SRF 1): the factor of safety is below 1, or \
             the start of the search is not in equilibrium"
                .to_owned(),
        );
    }
    match (safety.stable, safety.failed) {
        (Some(stable), None) => remarks.push(format!(
            "the slope still stands at SRF {stable:.4}, the largest factor tried"
        )),
        (None, Some(failed)) => remarks.push(format!(
            "the slope fails even at SRF {failed:.4}, the smallest factor tried"
        )),
        (Some(stable), Some(failed)) if failed <= low || stable >= high => remarks.push(format!(
            "the factor of safety lies outside the bracket [{low}, {high}], which was widened"
        )),
        _ => {}
    }
    if let Some(share) = safety.moving_mass.filter(|&share| share < LOCAL) {
        remarks.push(format!(
            "only {} % of the mass moves at failure: this is a local failure; leave its material \
             out with `materials`, or give it a little cohesion, to find that of the whole slope",
            short(100.0 * share)
        ));
    }
    remarks
}

/// The share of the mass that moves by more than a tenth of the largest displacement \[-\]; of the
/// volume where nothing has a weight.
fn moving_mass(state: &State) -> f64 {
    let particles = &state.body.particles;
    let limit = MOVING * largest_displacement(particles);
    let weighs = particles.mass.iter().any(|&mass| mass > 0.0);
    let share = if weighs {
        &particles.mass
    } else {
        &particles.volume0
    };
    let moving: f64 = particles
        .displacement
        .iter()
        .zip(share)
        .filter(|(d, _)| d[0].hypot(d[1]) > limit)
        .map(|(_, share)| share)
        .sum();
    moving / share.iter().sum::<f64>()
}

/// Height of the bodies \[m\].
fn height(state: &State) -> f64 {
    let particles = &state.body.particles;
    let levels = || {
        let edges = particles.x.iter().zip(&particles.half_length);
        edges.flat_map(|(x, half_length)| [x[1] - half_length[1], x[1] + half_length[1]])
    };
    levels().fold(f64::NEG_INFINITY, f64::max) - levels().fold(f64::INFINITY, f64::min)
}

/// The displacement γH²/E at which a body of moving geometry counts as failed when the case states none
/// \[m\] (theory, eq. 32a), with means over the volume: the mean unit weight and the mean of 1/E. None on
/// a given geometry, which needs none, and for bodies without weight.
fn default_limit(model: &Model<'_>, stage: &Stage, state: &State) -> Option<f64> {
    if stage.geometry == Geometry::Given {
        return None;
    }
    let particles = &state.body.particles;
    let weight = particles.mass.iter().sum::<f64>() * model.case.gravity;
    let volume: f64 = particles.volume0.iter().sum();
    let soft: f64 = particles
        .law
        .iter()
        .zip(&particles.volume0)
        .map(|(&law, volume)| volume / model.laws[law].elasticity().young())
        .sum();
    let limit = weight / volume * height(state).powi(2) * soft / volume;
    (limit > 0.0).then_some(limit)
}

/// The factor to try next between the largest stable and the smallest failed one, at most a stride
/// above the stable one, or beyond; none when the interval is narrow enough.
fn next_factor(
    (stable, failed): (Option<f64>, Option<f64>),
    (low, high): (f64, f64),
    tolerance: f64,
    stride: f64,
) -> Option<f64> {
    match (stable, failed) {
        (Some(stable), Some(failed)) if failed - stable <= tolerance * (1.0 + 1e-9) => None,
        (Some(stable), Some(failed)) => Some((stable + stride).min(0.5 * (stable + failed))),
        (Some(stable), None) if stable < low => Some(low),
        (Some(stable), None) if stable < high => Some(high),
        (Some(stable), None) => Some(stable + (high - low)),
        (None, Some(failed)) if failed <= LEAST_FACTOR => None,
        (None, Some(failed)) if low < failed => Some(low),
        (None, Some(failed)) => Some((0.5 * failed).max(LEAST_FACTOR)),
        (None, None) => Some(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The interval and the number of trials for a body that stands below `limit`.
    fn search(limit: f64, bracket: (f64, f64)) -> (Option<f64>, Option<f64>, usize) {
        let (mut stable, mut failed, mut made) = (None, None, 0);
        while let Some(srf) = next_factor((stable, failed), bracket, 0.01, f64::INFINITY) {
            if srf < limit {
                stable = Some(srf);
            } else {
                failed = Some(srf);
            }
            made += 1;
            if made == MOST_TRIALS {
                break;
            }
        }
        (stable, failed, made)
    }

    #[test]
    fn the_interval_holds_the_factor() {
        for limit in [0.2, 0.99, 1.0001, 1.38, 1.99, 5.0] {
            for bracket in [(1.0, 2.0), (1.3, 1.5)] {
                let (stable, failed, made) = search(limit, bracket);
                let (stable, failed) = (stable.unwrap(), failed.unwrap());
                assert!(stable < limit && limit <= failed && failed - stable <= 0.0101);
                assert!(made < 30, "{limit}: {made}");
            }
        }
    }

    #[test]
    fn a_factor_within_the_bracket_is_sought_within_it() {
        let next = |stable| next_factor((stable, None), (1.0, 1.6), 0.01, f64::INFINITY);
        assert_eq!(next(Some(0.8)), Some(1.0));
        assert_eq!(next(Some(1.4)), Some(1.6));
        assert_eq!(next(Some(1.6)), Some(1.6 + (1.6 - 1.0)));
    }

    #[test]
    fn a_search_without_an_end_ends() {
        let (_, failed, made) = search(f64::INFINITY, (1.0, 2.0));
        assert_eq!((failed, made), (None, MOST_TRIALS));
        let (stable, failed, made) = search(0.0, (1.0, 2.0));
        assert_eq!((stable, failed), (None, Some(LEAST_FACTOR)));
        assert!(made < 10, "{made}");
    }
}
