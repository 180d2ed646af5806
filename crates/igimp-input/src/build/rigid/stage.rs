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
    for row in about.stage.moves() {
        let lead = format!("stage `{}` moves", about.name);
        let Ok(row) = row else {
            is_right = false;
            continue;
        };
        let Some(body) = about.context.names.rigid.find(&row.body, &lead, problems) else {
            is_right = false;
            continue;
        };
        if found.iter().any(|other| other.body == body) {
            problems.error(row.body.place, "this rigid body is named twice");
        }
        match drives::<D>(row, problems) {
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
    row: &Move,
    problems: &mut Problems,
) -> Result<[Option<RigidDrive>; COMPONENTS], Wrong> {
    let mut drives = [None; COMPONENTS];
    let components: &[ComponentKeys<'_>] = if D == 2 {
        &[
            (Component::X, &row.x, "force_x", &row.force_x),
            (Component::Y, &row.y, "force_y", &row.force_y),
            (Component::Rotation, &row.rotation, "moment", &row.moment),
        ]
    } else {
        &[
            (Component::X, &row.x, "force_x", &row.force_x),
            (Component::Y, &row.y, "force_y", &row.force_y),
            (Component::Z, &row.z, "force_z", &row.force_z),
            (
                Component::RotationX,
                &row.rotation_x,
                "moment_x",
                &row.moment_x,
            ),
            (
                Component::RotationY,
                &row.rotation_y,
                "moment_y",
                &row.moment_y,
            ),
            (
                Component::RotationZ,
                &row.rotation_z,
                "moment_z",
                &row.moment_z,
            ),
        ]
    };
    for (drive, &(component, moved, force, loaded)) in drives.iter_mut().zip(components) {
        let is_free = row.free.iter().any(|free| **free == component);
        let count = usize::from(moved.is_some()) + usize::from(loaded.is_some());
        if count + usize::from(is_free) > 1 {
            let (second, place) = match loaded {
                Some(loaded) => (force, loaded.place),
                None => ("free", row.free.place),
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
        .flat_map(|stage| stage.moves())
        .collect();
    // A name that was found wrong, or is not defined, may be a slip for one that is not used.
    let is_slip = |row: &&Result<At<Move>, Wrong>| match row {
        Ok(row) => names.rigid.position(&row.body).is_none(),
        Err(Wrong) => true,
    };
    if moved.iter().any(is_slip) {
        return;
    }
    for body in bodies.iter().flatten() {
        let is_there = (body.common.as_ref()).map_or(true, |common| *common.from_start);
        let mut named = moved.iter().filter_map(|moved| moved.as_ref().ok());
        if !is_there && !named.any(|moved| moved.body.value == body.name.value) {
            problems.warning(
                body.name.place,
                format!(
                    "no stage names the rigid body `{}`, which is never there",
                    clip(&body.name, 40)
                ),
            );
        }
        warn_of_edges(
            body,
            moved.iter().filter_map(|moved| moved.as_ref().ok()),
            problems,
        );
    }
}

/// Warns of sharp edges of a body that goes down and slides.
fn warn_of_edges<'a, const D: usize>(
    body: &RigidBody<D>,
    moved: impl Iterator<Item = &'a At<Move>>,
    problems: &mut Problems,
) {
    let Some(rounding) = (body.common.as_ref().ok())
        .map(|common| &common.rounding)
        .filter(|rounding| ***rounding == 0.0)
    else {
        return;
    };
    let goes = |key: &Option<At<f64>>| key.as_ref().is_some_and(|value| **value != 0.0);
    let [mut sinks, mut slides] = [false; 2];
    for row in moved.filter(|moved| moved.body.value == body.name.value) {
        let across = [
            goes(&row.x) || goes(&row.force_x),
            goes(&row.y) || goes(&row.force_y),
        ];
        let down = goes(&row.z) || goes(&row.force_z);
        sinks |= if D == 2 { across[1] } else { down };
        slides |= across[0] || D == 3 && across[1];
    }
    if sinks && slides {
        let name = clip(&body.name, 40);
        problems
            .warning(
                rounding.place,
                format!("the rigid body `{name}` has sharp edges, sinks and slides: they plough the soil beside it"),
            )
            .help("rounding = 0.3, the default: a smooth box of 1 m that had settled by 1 mm met 30 kN/m in place of none");
    }
}
