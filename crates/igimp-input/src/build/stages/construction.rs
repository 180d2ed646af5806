//! Construction stages: what they may do to what is there.

use igimp_model::{Construction, Drainage, LoadKind, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::grid::MixedCells;
use igimp_schema::text::{clip, row};
use igimp_schema::tree::Node;

use crate::build::context::Context;

/// A construction stage.
pub(crate) fn stage<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<StageKind> {
    let errors = problems.errors();
    let place = bodies(context, node, "place", name, problems);
    let remove = bodies(context, node, "remove", name, problems);
    let materials = materials(context, node, name, problems);
    let water = node.get("water").map(|value| {
        let who = format!("stage `{name}` calls for");
        context.names.water.find(value, &who, problems)
    });
    let own = Construction {
        place: place?,
        remove: remove?,
        materials: materials?,
        water: match water {
            None => None,
            Some(found) => Some(found?),
        },
        dissipate: node.flag_at("dissipate")?,
    };
    if own == Construction::default() && node.get("place").is_some_and(|place| !place.is_invalid())
    {
        problems
            .error(
                node.place_at("type"),
                format!("stage `{name}` changes nothing"),
            )
            .help("write place, remove, materials, water or dissipate");
    }
    if problems.errors() == errors {
        comes_and_goes(context, index, node, &own, problems);
        loads_stay_held(context, index, node, &own, problems);
    }
    Some(StageKind::Construction(own))
}

/// The bodies that a list names.
fn bodies<const D: usize>(
    context: &Context<'_, D>,
    node: &Node,
    key: &str,
    name: &str,
    problems: &mut Problems,
) -> Option<Vec<usize>> {
    let who = format!("stage `{name}` {key}s");
    let mut found = Vec::new();
    let mut is_right = true;
    for value in node.items_at(key) {
        let Some(body) = context.names.bodies.find(value, &who, problems) else {
            is_right = false;
            continue;
        };
        if found.contains(&body) {
            problems.error(value.place, "this body is named twice");
        }
        found.push(body);
    }
    is_right.then_some(found)
}

/// Bodies and what they become.
fn materials<const D: usize>(
    context: &Context<'_, D>,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<Vec<(usize, usize)>> {
    let mut found: Vec<(usize, usize)> = Vec::new();
    let mut is_right = true;
    for change in node.items_at("materials") {
        let who = format!("stage `{name}` changes");
        let body = change.get("body");
        let body = body.and_then(|value| context.names.bodies.find(value, &who, problems));
        let who = format!("stage `{name}` uses");
        let material = change.get("material");
        let material =
            material.and_then(|value| context.names.materials.find(value, &who, problems));
        let (Some(body), Some(material)) = (body, material) else {
            is_right = false;
            continue;
        };
        if found.iter().any(|(other, _)| *other == body) {
            problems.error(change.place_at("body"), "this body is named twice");
        }
        found.push((body, material));
    }
    is_right.then_some(found)
}

/// Refuses to place what is there, and to take away or change what is not.
fn comes_and_goes<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    own: &Construction,
    problems: &mut Problems,
) {
    let before = context.sequence.before(index);
    let shown = |body: usize| clip(context.names.bodies.name(body), 40);
    let there = || {
        let names = (0..before.present.len()).filter(|&body| before.present[body]);
        row(names.map(|body| context.names.bodies.name(body)))
    };
    let is_placed = |body: usize| {
        let mut stages = context.stage_nodes().iter();
        let name = context.names.bodies.name(body);
        stages.any(|stage| {
            let named = stage.items_at("place").iter();
            named.filter_map(Node::text).any(|other| other == name)
        })
    };
    for (value, &body) in std::iter::zip(node.items_at("place"), &own.place) {
        if own.remove.contains(&body) {
            problems
                .error(
                    value.place,
                    format!(
                        "the body `{}` is placed and taken away in one stage",
                        shown(body)
                    ),
                )
                .help("write two stages, or draw two bodies");
        } else if before.present[body] {
            problems
                .error(
                    value.place,
                    format!("the body `{}` is there already", shown(body)),
                )
                .help("a body is placed once; for another layer in its place draw another body");
        }
    }
    let missing = |value: &Node, body: usize, problems: &mut Problems| {
        let problem = problems.error(
            value.place,
            format!("the body `{}` is not there in this stage", shown(body)),
        );
        problem.help(format!("bodies there: {}", there()));
        if is_placed(body) {
            problem.help("a body that some stage places is not there before that stage");
        }
    };
    for (value, &body) in std::iter::zip(node.items_at("remove"), &own.remove) {
        if !before.present[body] && !own.place.contains(&body) {
            missing(value, body, problems);
        }
    }
    for (change, &(body, material)) in std::iter::zip(node.items_at("materials"), &own.materials) {
        let Some(value) = change.get("body") else {
            continue;
        };
        if own.remove.contains(&body) {
            problems.error(
                value.place,
                format!(
                    "the body `{}` is changed and taken away in one stage",
                    shown(body)
                ),
            );
        } else if !before.present[body] && !own.place.contains(&body) {
            missing(value, body, problems);
        } else if before.material[body] == Some(material) {
            problems.warning(
                change.place_at("material"),
                format!("the body `{}` consists of that already", shown(body)),
            );
        }
    }
    if !own.remove.is_empty() && !context.sequence.ends[index].present.contains(&true) {
        problems
            .error(
                node.place_at("remove"),
                "no body is left: there is nothing to compute",
            )
            .help("leave one body");
    }
}

/// Refuses to take away soil under a load that acts, or a footing that was pushed.
fn loads_stay_held<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    own: &Construction,
    problems: &mut Problems,
) {
    for (load, kind) in context.loads.iter().enumerate() {
        let Some(kind) = kind.as_ref().filter(|_| acts(context, index, load)) else {
            continue;
        };
        let lost = own.remove.iter().position(|&body| {
            context.soil.bears(body, &kind.kind) && !stays_held(context, index, &kind.kind)
        });
        if let Some(lost) = lost {
            let body = clip(context.names.bodies.name(own.remove[lost]), 40);
            let is_footing = matches!(kind.kind, LoadKind::RigidFooting { .. });
            problems
                .error(
                    node.items_at("remove")[lost].place,
                    format!(
                        "the body `{body}` is taken away while `{}` acts on it",
                        clip(&kind.name, 40)
                    ),
                )
                .help(if is_footing {
                    "a rigid footing stays once it was pushed: dig beside it, or before"
                } else {
                    "take the load off before, in a stage of type load with factor = 0"
                });
        }
    }
}

/// Whether some body that is there after a stage bears a load.
fn stays_held<const D: usize>(context: &Context<'_, D>, index: usize, load: &LoadKind<D>) -> bool {
    let present = &context.sequence.ends[index].present;
    (0..present.len()).any(|body| present[body] && context.soil.bears(body, load))
}

/// Whether a load acts as a stage begins.
fn acts<const D: usize>(context: &Context<'_, D>, index: usize, load: usize) -> bool {
    let nodes = context.stage_nodes();
    let mut at = context.sequence.from(index);
    while let Some(stage) = at {
        let node = &nodes[stage];
        let named = node.get("load").into_iter().chain(node.items_at("loads"));
        let mut named = named.filter_map(Node::text);
        if named.any(|name| context.names.loads.position(name) == Some(load)) {
            return node.text_at("type") == Some("displacement")
                || node.number_at("factor") != Some(0.0);
        }
        at = context.sequence.from(stage);
    }
    false
}

/// Refuses a load on soil that is not there yet, or not any more.
pub(crate) fn load_is_held<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    load: usize,
    value: &Node,
    problems: &mut Problems,
) {
    let Some(own) = context.loads.get(load).and_then(Option::as_ref) else {
        return;
    };
    let bodies = context.sequence.start.present.len();
    let is_somewhere = (0..bodies).any(|body| context.soil.bears(body, &own.kind));
    if context.soil.is_known() && is_somewhere && !stays_held(context, index, &own.kind) {
        problems
            .error(
                value.place,
                format!(
                    "`{}` acts on soil that is not there in this stage",
                    clip(&own.name, 40)
                ),
            )
            .help("place the body before, in a stage of type construction");
    }
}

/// Refuses cases that begin without soil; warns of undrained soil whose own weight comes on, and of stiffness that is shared
/// between soils that come and go.
pub(crate) fn check<const D: usize>(context: &Context<'_, D>, problems: &mut Problems) {
    let start = &context.sequence.start;
    if !start.present.is_empty() && !start.present.contains(&true) {
        problems
            .error(
                context.tree.place_at("bodies"),
                "no body is there from the start: stages place them all",
            )
            .help("leave one body, the ground, out of `place`");
    }
    let bodies = std::iter::zip(&start.present, &start.material);
    let mut there = bodies.filter_map(|(present, material)| material.filter(|_| *present));
    let is_undrained = |material: usize| {
        let own = context.materials.get(material).and_then(Option::as_ref);
        own.is_some_and(|own| matches!(own.drainage, Drainage::Undrained { .. }))
    };
    if let Some(first) = context.stage_nodes().first()
        && first.text_at("type") == Some("gravity")
        && first.flag_at("drained") == Some(false)
        && there.any(is_undrained)
    {
        problems
            .warning(
                first.place_at("type"),
                "the weight of undrained soil comes on while no water leaves: its water carries most of it",
            )
            .help("for ground that has stood for long write drained = true in this stage");
    }
    let changes = |stage: &&Node| {
        let mut keys = ["place", "remove", "materials"].into_iter();
        stage.text_at("type") == Some("construction")
            && keys.any(|key| !stage.items_at(key).is_empty())
    };
    if let Ok(grid) = Root::<D>::grid(context.tree)
        && *grid.mixed_cells == Ok(MixedCells::Mean)
        && context.stage_nodes().iter().any(|stage| changes(&stage))
    {
        problems
            .warning(
                grid.mixed_cells.place,
                "cells that several soils share keep the mean stiffness of all of them, whichever are there",
            )
            .help("let grid lines follow the bodies that come and go, and write mixed_cells = \"own\"");
    }
}
