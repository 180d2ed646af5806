//! Warnings about stages that change nothing, or that lift a body off the soil that it rests on: mostly a factor that is thought
//! to add up, or a sign.

use igimp_model::{BodyPart, LoadKind, RigidDrive, RigidPart, Stage, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number};

use crate::build::context::Context;

/// Checks the stages as they were built, with the rigid bodies that they move.
pub(crate) fn check<const D: usize>(
    context: &Context<'_, D>,
    rigid: &[Option<RigidPart<D>>],
    built: &[Option<Stage>],
    problems: &mut Problems,
) {
    if problems.errors() > 0 {
        return;
    }
    for (stated, stage) in std::iter::zip(context.stages, built) {
        let (Some(stated), Some(stage)) = (stated, stage) else {
            continue;
        };
        let does_more = stage.consolidation.is_some() || !stage.install.is_empty() || stage.drained;
        let remark = match &stage.kind {
            StageKind::Load { loads, factor } if !does_more && !stage.reset_displacements => {
                idle_load(context, built, stage, (loads, *factor))
            }
            StageKind::Gravity { .. } if !does_more => idle_gravity(built, stage),
            StageKind::Rigid(_) => {
                idle_motion(rigid, stage).or_else(|| lifted(context, rigid, (built, stage)))
            }
            _ => None,
        };
        if let Some((text, help)) = remark {
            let name = clip(&stage.name, 40);
            problems
                .warning(stated.form.place, format!("stage `{name}` {text}"))
                .help(help);
        }
    }
}

/// The stages that a stage follows, the latest first.
fn before<'a>(built: &'a [Option<Stage>], stage: &Stage) -> impl Iterator<Item = &'a Stage> {
    let of = |from: Option<usize>| built.get(from?)?.as_ref();
    std::iter::successors(of(stage.start_from), move |stage| of(stage.start_from))
}

/// A stage that applies loads as they act already.
fn idle_load<const D: usize>(
    context: &Context<'_, D>,
    built: &[Option<Stage>],
    stage: &Stage,
    (loads, factor): (&[usize], f64),
) -> Option<(String, String)> {
    let acts = |load: usize| {
        let found = before(built, stage).find_map(|past| match &past.kind {
            StageKind::Load { loads, factor } if loads.contains(&load) => Some(*factor),
            _ => None,
        });
        found.unwrap_or(0.0)
    };
    let is_same = |load: &usize| (acts(*load) - factor).abs() <= 1e-12 * factor.abs();
    if loads.is_empty() || !loads.iter().all(is_same) {
        return None;
    }
    let name = context.loads.get(loads[0])?.as_ref()?;
    if let LoadKind::RigidFooting { .. } = name.kind {
        return None;
    }
    let name = clip(&name.name, 40);
    let text = if factor == 0.0 {
        format!("applies nothing: load `{name}` has factor = 0, and did not act before")
    } else {
        let factor = number(factor);
        format!("changes nothing: load `{name}` acts with a factor of {factor} already")
    };
    let help = "a factor is that of the load as stated and adds to none before: factor = 2 makes it twice the load";
    Some((text, help.to_owned()))
}

/// A stage that leaves gravity as it is.
fn idle_gravity(built: &[Option<Stage>], stage: &Stage) -> Option<(String, String)> {
    let StageKind::Gravity {
        factor,
        horizontal,
        across,
        vertical,
    } = stage.kind
    else {
        return None;
    };
    let earlier = before(built, stage).find(|past| {
        matches!(
            past.kind,
            StageKind::Gravity { .. } | StageKind::K0 | StageKind::Construction(_)
        )
    });
    let Some(earlier) = earlier else {
        let shares = [horizontal, across, vertical].into_iter().flatten();
        let text = "raises no weight: factor = 0, and none acted before".to_owned();
        let help = "factor = 1, the default, is the whole weight".to_owned();
        return (factor == 0.0 && shares.sum::<f64>() == 0.0).then_some((text, help));
    };
    let StageKind::Gravity {
        factor: acts,
        horizontal: along,
        across: behind,
        vertical: up,
    } = earlier.kind
    else {
        return None;
    };
    let keeps = |share: Option<f64>, before: Option<f64>| {
        share.is_none_or(|share| (share - before.unwrap_or(0.0)).abs() <= 1e-12)
    };
    let is_same = (factor - acts).abs() <= 1e-12
        && keeps(horizontal, along)
        && keeps(across, behind)
        && keeps(vertical, up);
    let may_be_meant = stage.reset_displacements || stage.geometry != earlier.geometry;
    (is_same && !may_be_meant).then(|| {
        let text = format!(
            "changes nothing: gravity acts as in stage `{}` already",
            clip(&earlier.name, 40)
        );
        let help = "a factor is that of the whole weight and adds to none before".to_owned();
        (text, help)
    })
}

/// A stage that moves rigid bodies by nothing.
fn idle_motion<const D: usize>(
    rigid: &[Option<RigidPart<D>>],
    stage: &Stage,
) -> Option<(String, String)> {
    let StageKind::Rigid(moves) = &stage.kind else {
        return None;
    };
    let mut drives = moves.iter().flat_map(|m| m.drives).flatten().peekable();
    let stands = |drive: RigidDrive| matches!(drive, RigidDrive::By(by) if by == 0.0);
    if drives.peek().is_none() || !drives.all(stands) {
        return None;
    }
    let name = clip(&rigid.get(moves[0].body)?.as_ref()?.name, 40);
    let text = format!("moves the rigid body `{name}` by nothing");
    let help = "its resistance is that of a body at rest; displacements are those of the stage, not of the end";
    Some((text, help.to_owned()))
}

/// A stage that lifts a body which only rests on soil and was never pushed before.
fn lifted<const D: usize>(
    context: &Context<'_, D>,
    rigid: &[Option<RigidPart<D>>],
    (built, stage): (&[Option<Stage>], &Stage),
) -> Option<(String, String)> {
    let StageKind::Rigid(moves) = &stage.kind else {
        return None;
    };
    let is_moved = |body: usize| {
        before(built, stage).any(|past| match &past.kind {
            StageKind::Rigid(moves) => moves.iter().any(|motion| motion.body == body),
            _ => false,
        })
    };
    let parts = || context.bodies.iter().flatten();
    let motion = moves.iter().find(|motion| {
        let rises = matches!(motion.drives[D - 1], Some(RigidDrive::By(by)) if by > 0.0);
        let part = rigid.get(motion.body).and_then(Option::as_ref);
        rises && !is_moved(motion.body) && part.is_some_and(|part| rests_on(part, parts(), context))
    })?;
    let name = clip(&rigid[motion.body].as_ref()?.name, 40);
    let key = ["y", "z"][D - 2];
    let text = format!("lifts the rigid body `{name}` off the soil that it rests on");
    let help = format!("{key} points up: {key} = \"-0.1 m\" pushes it down");
    Some((text, help))
}

/// Whether no soil lies beside or above the lowest level of a body.
fn rests_on<'a, const D: usize>(
    part: &RigidPart<D>,
    mut bodies: impl Iterator<Item = &'a BodyPart<D>>,
    context: &Context<'_, D>,
) -> bool {
    let (lower, upper) = part.bounds();
    let near = 1e-3 * context.soil.cell();
    let places: Vec<[f64; D]> = [0.1, 0.5, 0.9]
        .map(|share| std::array::from_fn(|k| lower[k] + share * (upper[k] - lower[k])))
        .to_vec();
    context.soil.is_known()
        && bodies.all(|body| {
            let mut tops = places.iter().filter_map(|place| body.region.top(place));
            tops.all(|top| top <= lower[D - 1] + near)
        })
}
