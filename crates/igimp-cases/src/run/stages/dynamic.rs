//! Motion in time, with inertia: after failure, or from the first moment on.
//!
//! Every step is the same search for equilibrium, with the force of acceleration among the forces (theory, eqs. 60 to 68). Steps
//! are chosen by the error of the time integration and by the way of the soil, and land on equal parts of the duration, as
//! many as the stage has steps. No factor of safety follows from motion.

use igimp_assembly::{CutVolume, Method, Remedy, SmallCuts};
use igimp_model::{Calm, Case, Driven, Dynamic, GroundMotion, Stage, StageKind};
use igimp_results::ending::EndReason;
use igimp_results::summary::{NewmarkSummary, StageSummary};
use igimp_solver::{MarchSettings, Pace};

use super::loading::{begin, reason_to_stop, target};
use super::rigid_begin;
use super::run_out::{divisor, flowing};
use super::walls;
use crate::error::CaseError;
use crate::run::model::Model;
use crate::run::output::moment::Moment;
use crate::run::reinforcement;
use crate::run::resume::Resumption;
use crate::run::session::{Session, StageEnd, StagePath, TimeIntegration, march_path};
use crate::run::state::{Controls, State};

/// The first step over the time in which a wave crosses a cell \[-\].
const FIRST_STEP: f64 = 1.0;

/// How often a step may be cut in succession, at least: a step chosen by error and way may be far too long.
const CUTS: u32 = 12;

/// How often a step of a stage may be cut in succession.
pub(crate) fn most_cuts<const D: usize>(case: &Case<D>, kind: &StageKind) -> u32 {
    match kind {
        StageKind::Dynamic(_) => case.solver.cuts.max(CUTS),
        _ => case.solver.cuts,
    }
}

/// Moves a state through time.
pub(crate) fn dynamic<const D: usize>(
    session: &mut Session<'_, D>,
    state: &mut State<D>,
    number: usize,
    dynamic: &Dynamic,
    summary: &mut StageSummary,
    resumption: Option<&Resumption>,
) -> Result<StageEnd, CaseError> {
    let model = session.model;
    let stage = &model.case.stages[number];
    if resumption.is_none() {
        place(session, state, dynamic, stage)?;
    }
    let method = method(model, dynamic, stage);
    if resumption.is_none() {
        let walls = walls::begin(model, state, &method, dynamic)?;
        state.body.free_fields = walls::free_fields(model, state, &method, dynamic)?;
        state.controls.walls = walls;
    }
    let start = resumption.map_or(&state.controls, |left| &left.from);
    let Some(mut from) = first_controls(session, start, dynamic, number) else {
        return Ok(StageEnd::Stopped(EndReason::NoFactorOfSafety));
    };
    let mut to = target(model.case, stage, &from);
    to.time += dynamic.duration;
    // Forces on rigid bodies act from the first moment on, and what holds them no longer lets go at once.
    for (first, end) in from.rigid.iter_mut().zip(&to.rigid) {
        first.loaded = end.loaded;
    }
    if resumption.is_none() {
        begin(session, state, number)?;
    }
    let on_ground = |before: &Controls, after: &Controls, conditions| {
        walls::shaken(model, dynamic, (from.time, before, after), conditions)
    };
    let settings = pace(model, state, dynamic, stage.steps)?;
    let path = StagePath {
        time: Some(TimeIntegration {
            scheme: dynamic.scheme,
            lumped: dynamic.lumped_share,
            longest_step: &longest_step(dynamic),
            on_ground: &on_ground,
        }),
        left: resumption,
        ..StagePath::of_equilibria((&from, &to), method, settings)
    };
    let mut calm = resumption.and_then(|left| left.calm).unwrap_or_default();
    let ended = march_path(
        session,
        state,
        &path,
        summary,
        &mut |session, summary, taken| {
            let energy = summary.energy.as_ref();
            session.record(&Moment {
                energy,
                ..taken.moment(number, summary.steps)
            })?;
            let time = taken.controls.time - from.time;
            let share = energy.map_or(1.0, |energy| energy.kinetic / energy.most_kinetic);
            let at_rest = at_rest(dynamic, &mut calm, (time, share));
            let resumption = Resumption {
                resistance: taken.resistance,
                calm: Some(calm),
                end: at_rest.or_else(|| reason_to_stop(session, stage, 0.0, taken)),
                ..Resumption::of(&from, *taken.accepted.state)
            };
            if let Some(output) = &mut session.output {
                let run = &session.summary;
                output.after_step(number, model, summary, taken, &resumption, run)?;
            }
            Ok(resumption.end)
        },
    )?;
    let ended = match ended {
        StageEnd::Stopped(reason @ EndReason::CameToRest { .. }) => StageEnd::Completed(reason),
        other => other,
    };
    // The whole record moves the block: beside soil that it moved in part there is nothing to hold it against.
    if let StageEnd::Completed(_) = ended {
        summary.newmark = sliding_block(session, dynamic);
    }
    Ok(ended)
}

/// Puts rigid bodies and reinforcement where a stage begins with them.
fn place<const D: usize>(
    session: &mut Session<'_, D>,
    state: &mut State<D>,
    dynamic: &Dynamic,
    stage: &Stage,
) -> Result<(), CaseError> {
    let model = session.model;
    for text in rigid_begin::begin(model, state, stage, &dynamic.bodies)? {
        session.warn(text);
    }
    reinforcement::begin(model.case, state, stage);
    state.controls.last_step = 0.0;
    Ok(())
}

/// Whether soil has come to rest by a time of a stage \[s\], with a share of the largest kinetic energy: no sooner than the ground.
fn at_rest(dynamic: &Dynamic, calm: &mut Calm, (time, share): (f64, f64)) -> Option<EndReason> {
    let is_calm = calm.take(time, share / dynamic.at_rest?);
    let record = dynamic.ground_motion.as_ref();
    let shakes_until = record.and_then(|motion| motion.times.last());
    let rests = is_calm && shakes_until.is_none_or(|end| time >= *end);
    rests.then_some(EndReason::CameToRest { time, share })
}

/// The controls that motion begins with; none where the factor of safety that the strength refers to was not found.
fn first_controls<const D: usize>(
    session: &Session<'_, D>,
    start: &Controls,
    dynamic: &Dynamic,
    number: usize,
) -> Option<Controls> {
    let mut from = start.clone();
    if let Some((materials, reduction)) = &dynamic.reduction {
        let factor = divisor(session, number, reduction)?;
        for &material in materials {
            from.srf[material] = factor;
        }
    }
    if begins_to_weigh(&session.model.case.stages, number) {
        // What has had no weight before falls from the first moment on.
        from.gravity = 1.0;
    }
    Some(from)
}

/// Whether gravity has not acted in any stage that a stage goes on from.
fn begins_to_weigh(stages: &[Stage], number: usize) -> bool {
    let before = |&stage: &usize| stages[stage].start_from;
    let earlier = std::iter::successors(before(&number), before);
    let mut kinds = earlier.map(|stage| &stages[stage].kind);
    !kinds.any(|kind| {
        matches!(
            kind,
            StageKind::Gravity { .. } | StageKind::K0 | StageKind::Dynamic(_)
        )
    })
}

/// The method of a stage of motion, with small cuts tied as the stage says.
fn method<const D: usize>(model: &Model<'_, D>, dynamic: &Dynamic, stage: &Stage) -> Method {
    let method = flowing(model);
    Method {
        geometry: stage.geometry,
        small_cuts: SmallCuts {
            below: dynamic.tied_below,
            of: CutVolume::FullSoil,
            remedy: Remedy::Extrapolate,
            ..method.small_cuts
        },
        ..method
    }
}

/// The slide of a block by the motion of the ground, if the stage asks for it: by the yield acceleration at the limit of the
/// path of the stage that has it, or at its last equilibrium.
fn sliding_block<const D: usize>(
    session: &Session<'_, D>,
    dynamic: &Dynamic,
) -> Option<NewmarkSummary> {
    let (from, motion) = (dynamic.newmark_from?, dynamic.ground_motion.as_ref()?);
    let case = session.model.case;
    let summary = session.summary.stages.get(from)?;
    let reached = |number: usize| {
        let stage = session.summary.stages.get(number);
        stage.map_or(0.0, |stage| stage.reached)
    };
    let push = Driven::Acceleration(0);
    let driven = Driven::of(&case.stages[from].kind, |driven| {
        driven.before(case, from, &reached)
    });
    let limit = summary.path.as_ref().and_then(|path| path.limit);
    let limit = limit.filter(|_| driven == Some(push));
    let coefficient = limit.map_or_else(|| push.after(case, from, &reached), |limit| limit.factor);
    let displacement = motion.sliding(coefficient * case.gravity, dynamic.duration);
    displacement.is_finite().then(|| NewmarkSummary {
        yield_coefficient: coefficient,
        is_limit: limit.is_some(),
        from: summary.name.clone(),
        peak_acceleration: motion.peak(dynamic.duration),
        displacement,
    })
}

/// The longest step of a stage that its record allows from a load factor on \[-\].
fn longest_step(dynamic: &Dynamic) -> impl Fn(f64) -> f64 {
    let record = dynamic.ground_motion.as_ref();
    let usual = record.map_or(f64::INFINITY, GroundMotion::interval);
    move |at| {
        let longest = record.map_or(usual, |rec| rec.longest_step(at * dynamic.duration, usual));
        longest / dynamic.duration
    }
}

/// How steps of time are chosen.
fn pace<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
    dynamic: &Dynamic,
    parts: usize,
) -> Result<MarchSettings, CaseError> {
    let settings = model.march_settings(parts);
    let cell = model.smallest_side()?;
    let crossing = cell / fastest_wave(model, state);
    let share = |time: f64| time / dynamic.duration;
    let record = dynamic.ground_motion.as_ref();
    let longest = dynamic
        .longest_step
        .map_or(1.0, share)
        .min(record.map_or(1.0, |motion| share(motion.interval())))
        .min(1.0 / parts as f64);
    Ok(MarchSettings {
        cuts: model.case.solver.cuts.max(CUTS),
        pace: Some(Pace {
            first: share(FIRST_STEP * crossing).min(longest),
            longest,
        }),
        ..settings
    })
}

/// The speed of the fastest compression wave in the bodies \[m/s\].
fn fastest_wave<const D: usize>(model: &Model<'_, D>, state: &State<D>) -> f64 {
    let particles = &state.body.particles;
    let speeds = (0..particles.len()).map(|particle| {
        let bound = model.laws[particles.law[particle]].stiffness_bound();
        let modulus =
            (bound.bulk() + 4.0 / 3.0 * bound.shear()) * particles.ratios[particle].stiffness;
        (modulus * particles.volume0[particle] / particles.mass[particle]).sqrt()
    });
    speeds
        .filter(|speed| speed.is_finite())
        .fold(f64::MIN_POSITIVE, f64::max)
}
