//! A case of a body of revolution: one in the plane whose section is axisymmetric, and its limits.

use std::sync::Arc;

use igimp_assembly::Section;
use igimp_model::{Case, LoadKind, PoreSource, RigidDrive, RigidMove, Side, StageKind, StageWalls};
use igimp_schema::diagnostic::Problems;
use igimp_schema::source::Place;
use igimp_schema::tree::Node;

/// Components of the motion of a rigid body in the plane, as their keys are called; the vertical one is free.
const COMPONENTS: [(usize, &str); 2] = [(0, "x"), (2, "rotation")];

/// The case with an axisymmetric section, held at its axis; reports parts that a body of revolution lacks.
pub(crate) fn section(tree: &Node, mut case: Case<2>, problems: &mut Problems) -> Option<Case<2>> {
    let before = problems.errors();
    case.method.section = Section::Axisymmetric;
    let start = case.grid.lower()[0];
    if start < 0.0 {
        problems
            .error(
                place_of(tree, "grid"),
                "the grid begins left of the axis of revolution, x = 0",
            )
            .help("let domain.x begin at 0 m, or further right for a body with a hole");
    }
    let inner = &mut case.boundaries.sides[0][0];
    if start <= 0.0 && *inner == Side::Free {
        *inner = Side::Roller;
    }
    let mut flows = case
        .stages
        .iter()
        .filter_map(|stage| stage.consolidation.as_ref());
    if start <= 0.0 && flows.any(|flow| flow.open_sides.contains(&(0, false))) {
        problems
            .error(
                place_of(tree, "stages"),
                "open_sides has the axis of revolution, which is no face: no water leaves there",
            )
            .help("draw a drain as a box in `drains`, or as a hole whose side the grid begins at");
    }
    for condition in &mut case.water {
        let of_bodies = condition.bodies.iter_mut().map(|entry| &mut entry.1);
        for source in of_bodies.chain([&mut condition.source]) {
            if let PoreSource::Seepage(flow) = source {
                Arc::make_mut(flow).conditions.axisymmetric = true;
            }
        }
    }
    // It lies on the axis, and nothing turns.
    for part in &mut case.rigid {
        part.centre_of_mass = part.reference;
    }
    refuse_parts(tree, &case, problems);
    for (index, stage) in case.stages.iter().enumerate() {
        let place = item(tree, "stages", index);
        refuse_stage(&stage.kind, place, problems);
    }
    (problems.errors() == before).then_some(case)
}

/// Refuses loads, water, soil and structures that a body of revolution has not.
fn refuse_parts(tree: &Node, case: &Case<2>, problems: &mut Problems) {
    let mut refuse = |place: Option<Place>, message: &str, help: &str| {
        problems.error(place, message).help(help);
    };
    if case.method.small_cuts.ghost_penalty > 0.0 {
        refuse(
            place_of(tree, "grid"),
            "the ghost penalty is one of plane strain and of space",
            "set small_cuts.ghost_penalty to 0",
        );
    }
    let whole = "forces are those of the whole circle already";
    for (index, load) in case.loads.iter().enumerate() {
        let place = item(tree, "loads", index);
        match load.kind {
            LoadKind::Point { .. } => refuse(
                place,
                "a force at a point would be one along a whole circle",
                "state a pressure over an area",
            ),
            LoadKind::RigidFooting {
                reaction_factor, ..
            } if reaction_factor.total_cmp(&1.0).is_ne() => {
                refuse(place, whole, "remove reaction_factor");
            }
            _ => {}
        }
    }
    for (index, part) in case.rigid.iter().enumerate() {
        let place = item(tree, "rigid", index);
        if part.force_factor.total_cmp(&1.0).is_ne() {
            refuse(place, whole, "remove force_factor");
        }
    }
    if !case.reinforcement.is_empty() {
        problems
            .error(
                item(tree, "reinforcement", 0),
                "a bar would be a cone here: reinforcement goes with plane strain and space",
            )
            .help("compute the body in space, analysis = \"3d\"");
    }
    for (index, material) in case.materials.iter().enumerate() {
        let over_length = (material.softening.as_ref()).is_some_and(|law| law.nonlocal.is_some());
        if over_length {
            let place = tree
                .get("materials")
                .and_then(|list| list.entries().get(index));
            problems
                .error(
                    place.map(|entry| entry.node.place),
                    "softening over a length goes with plane strain",
                )
                .help("scale it by the width of its bands: remove `length`");
        }
    }
}

/// Refuses a stage that would not keep a body one of revolution, at its place.
fn refuse_stage(kind: &StageKind, place: Option<Place>, problems: &mut Problems) {
    let mut refuse = |message: &str, help: &str| {
        problems.error(place, message).help(help);
    };
    match kind {
        StageKind::Gravity {
            horizontal: Some(share),
            ..
        } if *share != 0.0 => refuse(
            "a horizontal force leaves no body of revolution",
            "compute a slice in plane strain, or the body in space",
        ),
        StageKind::Rigid(moves) => moves.iter().for_each(|body| refuse_move(body, &mut refuse)),
        StageKind::Dynamic(run) => {
            run.bodies
                .iter()
                .for_each(|body| refuse_move(body, &mut refuse));
            if run.ground_motion.is_some() || is_walled(&run.walls) {
                refuse(
                    "sides and ground move in time in plane strain and in space alone",
                    "remove the motion of the ground and of its sides, or compute the body in space",
                );
            }
        }
        _ => {}
    }
}

/// Refuses a rigid body that does not go straight up or down.
fn refuse_move(body: &RigidMove, refuse: &mut impl FnMut(&str, &str)) {
    for (component, name) in COMPONENTS {
        match body.drives[component] {
            None | Some(RigidDrive::By(0.0)) => {}
            Some(_) => refuse(
                &format!("a body of revolution keeps its axis: {name} is held"),
                "move or load it along y alone",
            ),
        }
    }
}

/// Where a table is stated.
fn place_of(tree: &Node, key: &str) -> Option<Place> {
    tree.get(key).map(|table| table.place)
}

/// Where an item of a list is stated.
fn item(tree: &Node, list: &str, index: usize) -> Option<Place> {
    tree.items_at(list).get(index).map(|entry| entry.place)
}

/// Whether anything lies beyond the sides of a grid in motion.
fn is_walled(walls: &StageWalls) -> bool {
    walls.tied || !walls.absorbing.is_empty() || !walls.free_field.is_empty()
}
