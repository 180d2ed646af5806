//! Stages that move rigid bodies.

use igimp_model::{COMPONENTS, RigidDrive, RigidMove, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::clip;
use igimp_schema::tree::{Node, Wrong};

use crate::build::AllNames;
use crate::build::context::Context;

/// A stage that moves rigid bodies.
pub(crate) fn stage<const D: usize>(
    context: &Context<'_, D>,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<StageKind> {
    moves(context, node, name, problems).map(StageKind::Rigid)
}

/// The rigid bodies that a stage moves, loads or lets free.
pub(crate) fn moves<const D: usize>(
    context: &Context<'_, D>,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<Vec<RigidMove>> {
    let mut moves: Vec<RigidMove> = Vec::new();
    let mut is_right = true;
    for own in node.items_at("bodies") {
        let who = format!("stage `{name}` moves");
        let Some(body) =
            (own.get("body")).and_then(|value| context.names.rigid.find(value, &who, problems))
        else {
            is_right = false;
            continue;
        };
        if moves.iter().any(|other| other.body == body) {
            problems.error(own.place_at("body"), "this rigid body is named twice");
        }
        match drives::<D>(own, problems) {
            Ok(drives) => moves.push(RigidMove { body, drives }),
            Err(Wrong) => is_right = false,
        }
    }
    is_right.then_some(moves)
}

fn drives<const D: usize>(
    own: &Node,
    problems: &mut Problems,
) -> Result<[Option<RigidDrive>; COMPONENTS], Wrong> {
    let free: Vec<&str> = own.items_at("free").iter().filter_map(Node::text).collect();
    let mut drives = [None; COMPONENTS];
    let components: &[(&str, &str)] = if D == 2 {
        &[("x", "force_x"), ("y", "force_y"), ("rotation", "moment")]
    } else {
        &[
            ("x", "force_x"),
            ("y", "force_y"),
            ("z", "force_z"),
            ("rotation_x", "moment_x"),
            ("rotation_y", "moment_y"),
            ("rotation_z", "moment_z"),
        ]
    };
    for (drive, &(by, force)) in drives.iter_mut().zip(components) {
        let (moved, loaded) = (own.optional_number(by)?, own.optional_number(force)?);
        let is_free = free.contains(&by);
        let told = usize::from(moved.is_some()) + usize::from(loaded.is_some());
        if told + usize::from(is_free) > 1 {
            let second = if loaded.is_some() { force } else { "free" };
            let first = if moved.is_some() { by } else { "free" };
            problems
                .error(
                    own.place_at(second),
                    format!("both `{first}` and `{second}` are said of one component"),
                )
                .help("a component is moved, or loaded, or free: keep one of them");
            return Err(Wrong);
        }
        *drive = match (moved, loaded) {
            (Some(by), _) => Some(RigidDrive::By(by)),
            (_, Some(force)) => Some(RigidDrive::Force(force)),
            _ if is_free => Some(RigidDrive::Force(0.0)),
            _ => None,
        };
    }
    Ok(drives)
}

/// Warns of rigid bodies that never come in.
pub(crate) fn check_use(tree: &Node, names: &AllNames, problems: &mut Problems) {
    let moved: Vec<&str> = (tree.items_at("stages").iter())
        .filter(|stage| matches!(stage.text_at("type"), Some("rigid" | "dynamic")))
        .flat_map(|stage| stage.items_at("bodies"))
        .filter_map(|own| own.text_at("body"))
        .collect();
    if moved
        .iter()
        .any(|name| names.rigid.position(name).is_none())
    {
        return;
    }
    for node in tree.items_at("rigid") {
        let is_there = node.flag_at("from_start") != Some(false);
        if let Some(name) = node.text_at("name")
            && !is_there
            && !moved.contains(&name)
        {
            problems.warning(
                node.place_at("name"),
                format!(
                    "no stage names the rigid body `{}`, which is never there",
                    clip(name, 40)
                ),
            );
        }
    }
}
