//! Stages that take time.

use igimp_assembly::TimeScheme;
use igimp_model::{Dynamic, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::stages as keys;

use super::ground_motion::{motion, newmark_from, rayleigh, walls};
use super::safety::{materials, reduction_of};
use crate::build::context::About;
use crate::build::rigid::stage::moves;

/// Motion in time.
pub(crate) fn stage<const D: usize>(
    about: &About<'_, D>,
    own: &keys::Dynamic,
    problems: &mut Problems,
) -> Option<StageKind> {
    let bodies = moves(about, problems);
    let reduction = match own.reduction.as_ref().ok()? {
        None => None,
        Some(stated) => Some((
            materials(about, &own.materials, problems)?,
            reduction_of(about, stated, problems)?,
        )),
    };
    let walls = walls(about, own, problems);
    let ground_motion = match &own.ground_motion {
        None => None,
        Some(stated) => Some(motion(about, stated, problems)?),
    };
    let rayleigh = match &own.rayleigh {
        None => None,
        Some(stated) => Some(rayleigh(stated, problems)?),
    };
    let newmark_from = newmark_from(about, own, problems).ok()?;
    Some(StageKind::Dynamic(Dynamic {
        walls: walls?,
        ground_motion,
        rayleigh,
        newmark_from,
        duration: *own.duration,
        scheme: match *own.scheme {
            keys::Scheme::BackwardEuler => TimeScheme::BackwardEuler,
            keys::Scheme::Newmark => TimeScheme::Newmark,
            keys::Scheme::GeneralisedAlpha => TimeScheme::GeneralisedAlpha,
        },
        lumped_share: *own.lumped_share,
        tied_below: *own.tied_below,
        longest_step: own.longest_step.as_ref().map(|own| **own),
        reduction,
        bodies: bodies?,
        at_rest: own.at_rest.as_ref().map(|own| **own),
    }))
}
