//! Stages that take time.

use igimp_assembly::TimeScheme;
use igimp_model::{Dynamic, RigidDrive, RigidMove, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::stages as keys;
use igimp_schema::text::clip;

use super::ground_motion::{begins_at_rest, motion, newmark_from, rayleigh, walls};
use super::safety::{materials, reduction_of};
use crate::build::context::About;
use crate::build::gravity;
use crate::build::rigid::stage::moves;

/// Motion in time.
pub(crate) fn stage<const D: usize>(
    about: &About<'_, D>,
    table: &keys::Dynamic,
    problems: &mut Problems,
) -> Option<StageKind> {
    let bodies = moves(about, problems);
    has_mass(about, bodies.as_deref().unwrap_or_default(), problems);
    let reduction = match table.reduction.as_ref().ok()? {
        None => {
            keeps_strength(table, problems)?;
            None
        }
        Some(stated) => Some((
            materials(about, &table.materials, problems)?,
            reduction_of(about, stated, problems)?,
        )),
    };
    let walls = walls(about, table, problems);
    let ground_motion = match &table.ground_motion {
        None => None,
        Some(stated) => {
            let motion = motion(about, stated, problems)?;
            if motion
                .times
                .first()
                .is_some_and(|begins| *begins >= *table.duration)
            {
                problems
                    .warning(
                        stated.place,
                        "the record begins when the stage is over: the ground does not move",
                    )
                    .help("let duration be longer, or the record begin earlier");
            }
            begins_at_rest(stated, &motion, problems);
            Some(motion)
        }
    };
    has_inertia(about, table, problems);
    let rayleigh = match &table.rayleigh {
        None => None,
        Some(stated) => Some(rayleigh(stated, problems)?),
    };
    let newmark_from = newmark_from(about, table, problems).ok()?;
    Some(StageKind::Dynamic(Dynamic {
        walls: walls?,
        ground_motion,
        rayleigh,
        newmark_from,
        duration: *table.duration,
        scheme: match *table.scheme {
            keys::Scheme::BackwardEuler => TimeScheme::BackwardEuler,
            keys::Scheme::Newmark => TimeScheme::Newmark,
            keys::Scheme::GeneralisedAlpha => TimeScheme::GeneralisedAlpha,
        },
        lumped_share: *table.lumped_share,
        tied_below: *table.tied_below,
        longest_step: table.longest_step.as_ref().map(|step| **step),
        reduction,
        bodies: bodies?,
        at_rest: table.at_rest.as_ref().map(|value| **value),
    }))
}

/// Remarks on soil without weight, which moves without inertia.
fn has_inertia<const D: usize>(about: &About<'_, D>, run: &keys::Dynamic, problems: &mut Problems) {
    for (index, material) in about.context.materials.iter().enumerate() {
        if let Some(material) = material
            && material.unit_weight <= 0.0
            && about.context.is_used(index)
        {
            let name = clip(&material.name, 40);
            problems
                .warning(
                    run.duration.place,
                    format!("the material `{name}` has no weight, and so no mass: it moves without inertia"),
                )
                .help("state its unit_weight: its density is that over gravity");
        }
    }
}

/// Refuses materials whose strength is to be reduced where nothing says by how much.
fn keeps_strength(table: &keys::Dynamic, problems: &mut Problems) -> Option<()> {
    match table.materials.as_ref().ok()? {
        Some(named) if named.written => {
            problems
                .error(
                    named.place,
                    "the strength of these materials is not reduced",
                )
                .help("add reduction = { times_fos = 1.05 }, or remove materials");
            None
        }
        _ => Some(()),
    }
}

/// Refuses forces on rigid bodies without mass.
fn has_mass<const D: usize>(about: &About<'_, D>, moved: &[RigidMove], problems: &mut Problems) {
    let Ok(bodies) = Root::<D>::rigid(about.context.tree) else {
        return;
    };
    let loaded = moved.iter().filter(|motion| {
        let mut drives = motion.drives.iter().flatten();
        drives.any(|drive| matches!(drive, RigidDrive::Force(_)))
    });
    for motion in loaded {
        let Some(Ok(body)) = bodies.get(motion.body) else {
            continue;
        };
        let Ok(common) = &body.common else {
            continue;
        };
        if *common.weight == 0.0 || gravity(about.context.tree) == Some(0.0) {
            let name = clip(&body.name, 40);
            problems
                .error(
                    body.name.place,
                    format!(
                        "the rigid body `{name}` is loaded or free in stage `{}`, which takes time, and has no mass",
                        about.name
                    ),
                )
                .help("state its weight, and gravity in [case]: its mass is the one over the other");
        }
    }
}
