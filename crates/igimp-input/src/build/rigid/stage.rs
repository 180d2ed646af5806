//! Stages that move rigid bodies.

use igimp_model::{COMPONENTS, RigidDrive, RigidMove, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::rigid::{Component, Move, RigidBody};
use igimp_schema::schema::stages::Stage;
use igimp_schema::text::clip;
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::At;

use crate::build::AllNames;
use crate::build::Thing;
use crate::build::context::About;

/// A stage that moves rigid bodies.
pub(crate) fn stage<const D: usize>(
    about: &About<'_, D>,
    problems: &mut Problems,
) -> Option<StageKind> {
    moves(about, problems).map(StageKind::Rigid)
}

/// The rigid bodies that a stage moves, loads or lets free.
pub(crate) fn moves<const D: usize>(
    about: &About<'_, D>,
    problems: &mut Problems,
) -> Option<Vec<RigidMove>> {
    let mut found: Vec<RigidMove> = Vec::new();
    let mut is_right = true;
    for own in about.stage.moves() {
        let who = format!("stage `{}` moves", about.name);
        let Ok(own) = own else {
            is_right = false;
            continue;
        };
        let Some(body) = about.context.names.rigid.find(&own.body, &who, problems) else {
            is_right = false;
            continue;
        };
        if found.iter().any(|other| other.body == body) {
            problems.error(own.body.place, "this rigid body is named twice");
        }
        match drives::<D>(own, problems) {
            Ok(drives) => found.push(RigidMove { body, drives }),
            Err(Wrong) => is_right = false,
        }
    }
    is_right.then_some(found)
}

/// A component of the motion as it is stated: its name, by how much it goes on, the key of its load, and that.
type ComponentKeys<'a> = (
    Component,
    &'a Option<At<f64>>,
    &'static str,
    &'a Option<At<f64>>,
);

fn drives<const D: usize>(
    own: &Move,
    problems: &mut Problems,
) -> Result<[Option<RigidDrive>; COMPONENTS], Wrong> {
    let mut drives = [None; COMPONENTS];
    let components: &[ComponentKeys<'_>] = if D == 2 {
        &[
            (Component::X, &own.x, "force_x", &own.force_x),
            (Component::Y, &own.y, "force_y", &own.force_y),
            (Component::Rotation, &own.rotation, "moment", &own.moment),
        ]
    } else {
        &[
            (Component::X, &own.x, "force_x", &own.force_x),
            (Component::Y, &own.y, "force_y", &own.force_y),
            (Component::Z, &own.z, "force_z", &own.force_z),
            (
                Component::RotationX,
                &own.rotation_x,
                "moment_x",
                &own.moment_x,
            ),
            (
                Component::RotationY,
                &own.rotation_y,
                "moment_y",
                &own.moment_y,
            ),
            (
                Component::RotationZ,
                &own.rotation_z,
                "moment_z",
                &own.moment_z,
            ),
        ]
    };
    for (drive, &(component, moved, force, loaded)) in drives.iter_mut().zip(components) {
        let is_free = own.free.iter().any(|free| **free == component);
        let told = usize::from(moved.is_some()) + usize::from(loaded.is_some());
        if told + usize::from(is_free) > 1 {
            let (second, place) = match loaded {
                Some(loaded) => (force, loaded.place),
                None => ("free", own.free.place),
            };
            let first = if moved.is_some() {
                component.name()
            } else {
                "free"
            };
            problems
                .error(
                    place,
                    format!("both `{first}` and `{second}` are said of one component"),
                )
                .help("a component is moved, or loaded, or free: keep one of them");
            return Err(Wrong);
        }
        *drive = match (moved, loaded) {
            (Some(by), _) => Some(RigidDrive::By(**by)),
            (_, Some(force)) => Some(RigidDrive::Force(**force)),
            _ if is_free => Some(RigidDrive::Force(0.0)),
            _ => None,
        };
    }
    Ok(drives)
}

/// Warns of rigid bodies that never come in, and of sharp edges that plough.
pub(crate) fn check_use<const D: usize>(
    bodies: &[Thing<RigidBody<D>>],
    stages: &[Thing<Stage>],
    names: &AllNames,
    problems: &mut Problems,
) {
    let moved: Vec<_> = stages
        .iter()
        .flatten()
        .flat_map(|own| own.moves())
        .collect();
    // A name that was found wrong, or is not defined, may be a slip for one that is not used.
    let is_slip = |own: &&Result<At<Move>, Wrong>| match own {
        Ok(own) => names.rigid.position(&own.body).is_none(),
        Err(Wrong) => true,
    };
    if moved.iter().any(is_slip) {
        return;
    }
    for own in bodies.iter().flatten() {
        let is_there = (own.common.as_ref()).map_or(true, |common| *common.from_start);
        let mut named = moved.iter().filter_map(|moved| moved.as_ref().ok());
        if !is_there && !named.any(|moved| moved.body.value == own.name.value) {
            problems.warning(
                own.name.place,
                format!(
                    "no stage names the rigid body `{}`, which is never there",
                    clip(&own.name, 40)
                ),
            );
        }
        warn_of_edges(
            own,
            moved.iter().filter_map(|moved| moved.as_ref().ok()),
            problems,
        );
    }
}

/// Warns of sharp edges of a body that goes down and slides.
fn warn_of_edges<'a, const D: usize>(
    own: &RigidBody<D>,
    moved: impl Iterator<Item = &'a At<Move>>,
    problems: &mut Problems,
) {
    let Some(rounding) = (own.common.as_ref().ok())
        .map(|common| &common.rounding)
        .filter(|rounding| ***rounding == 0.0)
    else {
        return;
    };
    let goes = |key: &Option<At<f64>>| key.as_ref().is_some_and(|own| **own != 0.0);
    let [mut sinks, mut slides] = [false; 2];
    for own in moved.filter(|moved| moved.body.value == own.name.value) {
        let across = [
            goes(&own.x) || goes(&own.force_x),
            goes(&own.y) || goes(&own.force_y),
        ];
        let down = goes(&own.z) || goes(&own.force_z);
        sinks |= if D == 2 { across[1] } else { down };
        slides |= across[0] || D == 3 && across[1];
    }
    if sinks && slides {
        let name = clip(&own.name, 40);
        problems
            .warning(
                rounding.place,
                format!("the rigid body `{name}` has sharp edges, sinks and slides: they plough the soil beside it"),
            )
            .help("rounding = 0.3, the default: a smooth box of 1 m that had settled by 1 mm met 30 kN/m in place of none");
    }
}
