//! Construction stages: the changes that they may make.

use igimp_model::{Construction, Drainage, LoadKind, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::grid::MixedCells;
use igimp_schema::schema::stages::{self as keys, StageForm};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, row};
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::At;

use crate::build::bodies::sequence::placed;
use crate::build::context::{About, Context};

/// A construction stage.
pub(crate) fn stage<const D: usize>(
    about: &About<'_, D>,
    stated: &keys::Construction,
    problems: &mut Problems,
) -> Option<StageKind> {
    let errors = problems.errors();
    let name = about.name;
    let place = bodies(about, stated.placed(), "places", problems);
    let remove = bodies(about, stated.removed(), "removes", problems);
    let materials = materials(about, stated.changes(), problems);
    let subject = format!("stage `{name}` calls for");
    let water = stated.water.as_ref().map_err(|_| Wrong);
    let waters = &about.context.names.water;
    let water = water.and_then(|key| waters.find_optional(key.as_ref(), &subject, problems));
    let built = Construction {
        place: place?,
        remove: remove?,
        materials: materials?,
        water: water.ok()?,
        dissipate: **stated.dissipate.as_ref().ok()?,
    };
    if built == Construction::default() && stated.place.is_ok() {
        problems
            .error(
                about.stage.form.place,
                format!("stage `{name}` changes nothing"),
            )
            .help("write place, remove, materials, water or dissipate");
    }
    if problems.errors() == errors {
        comes_and_goes(about, stated, &built, problems);
        loads_stay_held(about, stated, &built, problems);
    }
    Some(StageKind::Construction(built))
}

/// The bodies that a list names.
fn bodies<const D: usize>(
    about: &About<'_, D>,
    list: &[At<String>],
    does: &str,
    problems: &mut Problems,
) -> Option<Vec<usize>> {
    let subject = format!("stage `{}` {does}", about.name);
    let mut found = Vec::new();
    let mut is_right = true;
    for value in list {
        let Some(body) = about.context.names.bodies.find(value, &subject, problems) else {
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

/// Bodies and their new materials.
fn materials<const D: usize>(
    about: &About<'_, D>,
    changes: &[Result<At<keys::MaterialChange>, Wrong>],
    problems: &mut Problems,
) -> Option<Vec<(usize, usize)>> {
    let (names, name) = (about.context.names, about.name);
    let mut found: Vec<(usize, usize)> = Vec::new();
    let mut is_right = true;
    for change in changes {
        let Ok(change) = change else {
            is_right = false;
            continue;
        };
        let subject = format!("stage `{name}` changes");
        let body = names.bodies.find(&change.body, &subject, problems);
        let subject = format!("stage `{name}` uses");
        let material = names.materials.find(&change.material, &subject, problems);
        let (Some(body), Some(material)) = (body, material) else {
            is_right = false;
            continue;
        };
        if found.iter().any(|(other, _)| *other == body) {
            problems.error(change.body.place, "this body is named twice");
        }
        found.push((body, material));
    }
    is_right.then_some(found)
}

/// Refuses to place bodies that are there, and to take away or change others.
fn comes_and_goes<const D: usize>(
    about: &About<'_, D>,
    stated: &keys::Construction,
    built: &Construction,
    problems: &mut Problems,
) {
    let (context, index) = (about.context, about.index);
    let before = context.sequence.before(index);
    let shown = |body: usize| clip(context.names.bodies.name(body), 40);
    let there = || {
        let names = (0..before.present.len()).filter(|&body| before.present[body]);
        row(names.map(|body| context.names.bodies.name(body)))
    };
    let is_placed = |body: usize| {
        let mut placed = placed(context.stages).into_iter();
        placed.any(|name| name == context.names.bodies.name(body))
    };
    for (value, &body) in std::iter::zip(stated.placed(), &built.place) {
        if built.remove.contains(&body) {
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
    let missing = |value: &At<String>, body: usize, problems: &mut Problems| {
        let problem = problems.error(
            value.place,
            format!("the body `{}` is not there in this stage", shown(body)),
        );
        problem.help(format!("bodies there: {}", there()));
        if is_placed(body) {
            problem.help("a body that some stage places is not there before that stage");
        }
    };
    for (value, &body) in std::iter::zip(stated.removed(), &built.remove) {
        if !before.present[body] && !built.place.contains(&body) {
            missing(value, body, problems);
        }
    }
    let changes = stated.changes().iter().flatten();
    for (change, &(body, material)) in std::iter::zip(changes, &built.materials) {
        let value = &change.body;
        if built.remove.contains(&body) {
            problems.error(
                value.place,
                format!(
                    "the body `{}` is changed and taken away in one stage",
                    shown(body)
                ),
            );
        } else if !before.present[body] && !built.place.contains(&body) {
            missing(value, body, problems);
        } else if before.material[body] == Some(material) {
            problems.warning(
                change.material.place,
                format!("the body `{}` consists of that already", shown(body)),
            );
        }
    }
    if !built.remove.is_empty() && !context.sequence.ends[index].present.contains(&true) {
        problems
            .error(
                stated.remove.as_ref().ok().map(|list| list.place),
                "no body is left: there is nothing to compute",
            )
            .help("leave one body");
    }
}

/// Refuses to take away soil under a load that acts, or a footing that was pushed.
fn loads_stay_held<const D: usize>(
    about: &About<'_, D>,
    stated: &keys::Construction,
    built: &Construction,
    problems: &mut Problems,
) {
    let (context, index) = (about.context, about.index);
    for (load, kind) in context.loads.iter().enumerate() {
        let Some(kind) = kind.as_ref().filter(|_| acts(context, index, load)) else {
            continue;
        };
        let lost = built.remove.iter().position(|&body| {
            context.soil.bears(body, &kind.kind) && !stays_held(context, index, &kind.kind)
        });
        if let Some(lost) = lost {
            let body = clip(context.names.bodies.name(built.remove[lost]), 40);
            let is_footing = matches!(kind.kind, LoadKind::RigidFooting { .. });
            problems
                .error(
                    stated.removed()[lost].place,
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
    let mut at = context.sequence.from(index);
    while let Some(stage) = at {
        if let Some(table) = &context.stages[stage] {
            let mut named = table.loads().into_iter();
            if named.any(|name| context.names.loads.position(name) == Some(load)) {
                let StageForm::Load(Ok(loading)) = &*table.form else {
                    return true;
                };
                return loading.factor.as_ref().map(|factor| **factor) != Ok(0.0);
            }
        }
        at = context.sequence.from(stage);
    }
    false
}

/// Refuses a load on soil that is not there yet, or not any more.
pub(crate) fn load_is_held<const D: usize>(
    about: &About<'_, D>,
    load: usize,
    place: Place,
    problems: &mut Problems,
) {
    let (context, index) = (about.context, about.index);
    let Some(loading) = context.loads.get(load).and_then(Option::as_ref) else {
        return;
    };
    let bodies = context.sequence.start.present.len();
    let is_somewhere = (0..bodies).any(|body| context.soil.bears(body, &loading.kind));
    if context.soil.is_known() && is_somewhere && !stays_held(context, index, &loading.kind) {
        problems
            .error(
                place,
                format!(
                    "`{}` acts on soil that is not there in this stage",
                    clip(&loading.name, 40)
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
                Root::<D>::bodies(context.tree)
                    .ok()
                    .map(|bodies| bodies.place),
                "no body is there from the start: stages place them all",
            )
            .help("leave one body, the ground, out of `place`");
    }
    let bodies = std::iter::zip(&start.present, &start.material);
    let mut there = bodies.filter_map(|(present, material)| material.filter(|_| *present));
    let is_undrained = |material: usize| {
        let soil = context.materials.get(material).and_then(Option::as_ref);
        soil.is_some_and(|soil| matches!(soil.drainage, Drainage::Undrained { .. }))
    };
    if let Some(Some(first)) = context.stages.first()
        && let StageForm::Gravity(_) = *first.form
        && let Ok(common) = &first.common
        && common.drained.as_ref().is_ok_and(|drained| !drained.value)
        && there.any(is_undrained)
    {
        problems
            .warning(
                first.form.place,
                "the weight of undrained soil comes on while no water leaves: its water carries most of it",
            )
            .help("for ground that has stood for long write drained = true in this stage");
    }
    let changes = |table: &keys::Construction| {
        let lists = [table.placed(), table.removed()];
        !table.changes().is_empty() || lists.iter().any(|list| !list.is_empty())
    };
    let mut built = context
        .stages
        .iter()
        .flatten()
        .filter_map(|stage| stage.construction());
    if let Ok(grid) = Root::<D>::grid(context.tree)
        && let Ok(mixed) = &grid.mixed_cells
        && **mixed == MixedCells::Mean
        && built.any(changes)
    {
        problems
            .warning(
                mixed.place,
                "cells that several soils share keep the mean stiffness of all of them, whichever are there",
            )
            .help("let grid lines follow the bodies that come and go, and write mixed_cells = \"own\"");
    }
}
