//! Stages: the needs of each from loads, materials and the stages before it.

mod at_rest;
mod consolidation;
pub(crate) mod construction;
pub(crate) mod dynamic;
pub(crate) mod ground_motion;
pub(crate) mod idle;
pub(crate) mod memory;
pub(crate) mod safety;

use igimp_model::{LoadKind, Stage, StageKind, StopWhen, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::stages::{self as keys, StageForm};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number, row};
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::At;

use super::ground::level::uneven;
use crate::build::context::{About, Context};
use crate::build::grid::geometry_of;
use crate::build::things;
use safety::{run_out, strength_reduction};

/// The stages.
pub(super) fn stages<const D: usize>(
    context: &Context<'_, D>,
    problems: &mut Problems,
) -> Vec<Option<Stage>> {
    (context.stages.iter().enumerate())
        .map(|(index, table)| stage(context, index, table.as_ref()?, problems))
        .collect()
}

fn stage<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    table: &At<keys::Stage>,
    problems: &mut Problems,
) -> Option<Stage> {
    let name = clip(&table.name, 40);
    let about = About {
        context,
        index,
        stage: table,
        name: &name,
    };
    let kind = kind(&about, problems);
    let common = table.common.as_ref().ok()?;
    let start_from = start_from(&about, common, problems);
    let stop_when = common.stop_when.as_ref().ok();
    let stop_when = stop_when.and_then(|stop| stop_when_of(&about, stop, problems));
    let install = super::reinforcement::installs(&about, problems);
    if let (Some(members), Ok(stop)) = (&install, &common.stop_when) {
        super::reinforcement::check_stressed(&about, members, stop, problems);
    }
    let consolidation = consolidation::consolidation(&about, common, problems);
    Some(Stage {
        drained: **common.drained.as_ref().ok()?,
        name: table.name.known()?,
        kind: kind?,
        steps: **common.steps.as_ref().ok()?,
        geometry: geometry_of(&table.form),
        start_from: start_from.ok()?,
        reset_displacements: **common.reset_displacements.as_ref().ok()?,
        install: install?,
        stop_when: stop_when?,
        consolidation: consolidation.ok()?,
    })
}

fn kind<const D: usize>(about: &About<'_, D>, problems: &mut Problems) -> Option<StageKind> {
    if about.index == 0 {
        at_rest::check(about, problems);
    }
    match &*about.stage.form {
        StageForm::Gravity(form) => Some(gravity(form.as_ref().ok()?)),
        StageForm::K0(_) => {
            k0(about, problems);
            Some(StageKind::K0)
        }
        StageForm::Load(form) => load(about, form.as_ref().ok()?, problems),
        StageForm::Displacement(form) => displacement(about, form.as_ref().ok()?, problems),
        StageForm::Rigid(_) => super::rigid::stage::stage(about, problems),
        StageForm::Construction(form) => construction::stage(about, form.as_ref().ok()?, problems),
        StageForm::Wait(_) => Some(StageKind::Wait),
        StageForm::StrengthReduction(form) => {
            strength_reduction(about, form.as_ref().ok()?, problems)
                .map(StageKind::StrengthReduction)
        }
        StageForm::RunOut(form) => {
            run_out(about, form.as_ref().ok()?, problems).map(StageKind::RunOut)
        }
        StageForm::Dynamic(form) => dynamic::stage(about, form.as_ref().ok()?, problems),
    }
}

fn gravity(table: &keys::Gravity) -> StageKind {
    let share = |key: &Option<At<f64>>| key.as_ref().map(|value| **value);
    StageKind::Gravity {
        factor: *table.factor,
        horizontal: share(&table.horizontal),
        across: share(&table.across),
        vertical: share(&table.vertical),
    }
}

fn start_from<const D: usize>(
    about: &About<'_, D>,
    common: &keys::StageCommon,
    problems: &mut Problems,
) -> Result<Option<usize>, Wrong> {
    let index = about.index;
    let Some(stated) = common.start_from.as_ref().map_err(|_| Wrong)? else {
        return Ok(None);
    };
    if index == 0 {
        problems
            .error(
                stated.place,
                "the first stage starts from undeformed bodies, not from a stage",
            )
            .help("remove start_from");
        return Err(Wrong);
    }
    let subject = format!("stage `{}` starts from", about.name);
    let stages = &about.context.names.stages;
    let from = stages.find(stated, &subject, problems).ok_or(Wrong)?;
    if from >= index {
        problems
            .error(stated.place, "start_from has to name an earlier stage")
            .help(format!(
                "earlier stages: {}",
                row(stages.known().take(index))
            ));
        return Err(Wrong);
    }
    Ok(Some(from))
}

fn stop_when_of<const D: usize>(
    about: &About<'_, D>,
    stop: &keys::StopWhen,
    problems: &mut Problems,
) -> Option<StopWhen> {
    let form = &about.stage.form;
    let monitor = about
        .context
        .monitor(stop.monitor.as_ref(), about.name, problems);
    let monitor = monitor.ok()?;
    if let StageForm::Construction(_) = **form
        && let Some(end) = first_end(stop)
    {
        problems
            .error(end, "a construction stage has no early end")
            .help("what holds the ground as the stage begins must all be let go: remove stop_when")
            .help("a stage that finds no equilibrium says how far it came");
    }
    if let (Some(monitor), None) = (&stop.monitor, &stop.displacement) {
        problems
            .error(monitor.place, "there is no displacement for this monitor")
            .help("add displacement = \"0.5 m\"");
    }
    if let Some(growth) = &stop.load_grows_less_than
        && !matches!(**form, StageForm::Displacement(_))
    {
        let kind = form.name();
        problems
            .error(
                growth.place,
                format!("a stage of type {kind} has no footing whose load grows"),
            )
            .help(if let StageForm::Rigid(_) = **form {
                "end the stage by displacement = \"0.1 m\", and read the resistance from a curve of `rigid.NAME.resistance`"
            } else {
                "it is for stages of type displacement"
            });
    }
    if let StageForm::RunOut(_) | StageForm::Dynamic(_) = **form
        && let equilibrium = &stop.no_equilibrium
        && **equilibrium
    {
        let kind = form.name();
        problems
            .error(
                equilibrium.key_place,
                format!("a stage of type {kind} has no load that could be the greatest"),
            )
            .help("it is for stages of type gravity, load, displacement and rigid");
    }
    if let (StageForm::StrengthReduction(_), Some(displacement)) = (&**form, &stop.displacement) {
        problems
            .error(
                displacement.place,
                "a strength reduction ends by its failure criterion",
            )
            .help("write failure = { also = { displacement = \"0.5 m\" } }");
    }
    Some(StopWhen {
        displacement: stop.displacement.as_ref().map(|value| **value),
        monitor,
        no_equilibrium: *stop.no_equilibrium,
        load_grows_less_than: stop.load_grows_less_than.as_ref().map(|value| **value),
    })
}

/// Where the first condition that ends a stage is written.
fn first_end(stop: &keys::StopWhen) -> Option<Place> {
    let displacement = stop.displacement.as_ref().map(|key| key.key_place);
    let monitor = stop.monitor.as_ref().map(|key| key.key_place);
    let growth = stop.load_grows_less_than.as_ref().map(|key| key.key_place);
    let equilibrium = &stop.no_equilibrium;
    let equilibrium = (equilibrium.written && **equilibrium).then_some(equilibrium.key_place);
    displacement.or(monitor).or(growth).or(equilibrium)
}

fn k0<const D: usize>(about: &About<'_, D>, problems: &mut Problems) {
    let (context, place) = (about.context, about.stage.form.place);
    if about.index > 0 {
        problems
            .error(place, "a k0 stage sets the stresses of undeformed ground")
            .help("make it the first stage");
        return;
    }
    if let Some(site) = context.site.filter(|site| site.is_complete)
        && let Some(reason) = uneven(&site.at_start())
    {
        problems
            .error(place, "a k0 stage needs level ground")
            .help(reason)
            .help("for a slope use a stage of type gravity");
    }
    let stated = Root::<D>::materials(context.tree);
    for (index, material) in context.materials.iter().enumerate() {
        let Some(material) = material else { continue };
        let needs = material.strength != Strength::Elastic && material.k0.is_none();
        let start = &context.sequence.start;
        let bodies = std::iter::zip(&start.present, &start.material);
        let is_there = |(present, soil): (&bool, &Option<usize>)| *present && *soil == Some(index);
        if needs && bodies.clone().any(is_there) {
            let at = stated.as_ref().ok().and_then(|stated| stated.0.get(index));
            problems
                .error(
                    at.map_or(place, |entry| entry.place),
                    format!(
                        "the k0 stage needs k0 of the material `{}`",
                        clip(&material.name, 40)
                    ),
                )
                .help(match material.strength {
                    Strength::MohrCoulomb { .. } | Strength::DruckerPrager { .. } => {
                        "add k0 = \"jaky\", or a number"
                    }
                    _ => "add k0 = 0.5, or what it is",
                });
        }
    }
}

fn load<const D: usize>(
    about: &About<'_, D>,
    loading: &keys::Loading,
    problems: &mut Problems,
) -> Option<StageKind> {
    let (context, name) = (about.context, about.name);
    let (one, several) = (loading.load.as_ref().ok()?, loading.loads.as_ref().ok()?);
    let named: Vec<&At<String>> = match (one, several) {
        (Some(one), None) => vec![one],
        (None, Some(several)) => several.iter().collect(),
        (None, None) => {
            problems
                .error(about.stage.place, format!("stage `{name}` names no load"))
                .help("add load = \"NAME\", or loads = [\"NAME\", \"NAME\"]");
            return None;
        }
        (Some(_), Some(several)) => {
            problems
                .error(several.place, "both `load` and `loads` are given")
                .help("keep one of them");
            return None;
        }
    };
    let factor = loading.factor.as_ref().map(|factor| **factor);
    let mut loads = Vec::new();
    let mut is_right = true;
    for value in named {
        let subject = format!("stage `{name}` applies");
        let Some(load) = context.names.loads.find(value, &subject, problems) else {
            is_right = false;
            continue;
        };
        if loads.contains(&load) {
            problems.error(value.place, "this load is named twice");
        }
        loads.push(load);
        if factor != Ok(0.0) {
            construction::load_is_held(about, load, value.place, problems);
        }
        let kind = context.loads.get(load).and_then(Option::as_ref);
        if let Some(LoadKind::RigidFooting { .. }) = kind.map(|load| &load.kind) {
            problems
                .error(value.place, "a rigid footing is pushed, not loaded")
                .help("use a stage of type displacement");
        }
    }
    let factor = factor.ok()?;
    is_right.then_some(StageKind::Load { loads, factor })
}

fn displacement<const D: usize>(
    about: &About<'_, D>,
    table: &keys::Displacement,
    problems: &mut Problems,
) -> Option<StageKind> {
    let context = about.context;
    let subject = format!("stage `{}` pushes", about.name);
    let value = table.load.as_ref().ok()?;
    let load = context.names.loads.find(value, &subject, problems)?;
    let settlement = table.settlement.as_ref().ok()?;
    construction::load_is_held(about, load, value.place, problems);
    let LoadKind::RigidFooting { from, .. } = context.loads.get(load)?.as_ref()?.kind else {
        let footings = context.loads.iter().flatten();
        let footings = footings
            .filter(|load| matches!(load.kind, LoadKind::RigidFooting { .. }))
            .map(|load| load.name.as_str());
        problems
            .error(value.place, "only a rigid footing can be pushed")
            .help(format!("rigid footings: {}", row(footings)))
            .help("pressures and point loads are for stages of type load");
        return None;
    };
    if let Some(frame) = context.site.and_then(|site| site.frame.as_ref())
        && **settlement >= from[1] - frame.lower[1]
    {
        let depth = number(from[1] - frame.lower[1]);
        problems
            .error(
                settlement.place,
                "the footing would reach the bottom of the grid",
            )
            .help(format!("its base is {depth} m above it"));
    }
    Some(StageKind::Displacement {
        load,
        settlement: **settlement,
    })
}

/// Warns of materials and loads that nothing uses.
pub(super) fn check_use<const D: usize>(context: &Context<'_, D>, problems: &mut Problems) {
    let materials =
        Root::<D>::materials(context.tree).map_or_else(|_| Vec::new(), |list| list.value.0);
    for (index, material) in materials.iter().enumerate() {
        if !context.is_used(index) && !context.bodies.is_empty() {
            let message = format!("no body uses the material `{}`", clip(&material.name, 40));
            problems.warning(material.name_place, message);
        }
    }
    let stages = context.stages.iter().flatten();
    let used: Vec<&str> = stages
        .flat_map(|stage| stage.loads())
        .map(|name| name.as_str())
        .collect();
    // A name that is not defined may be a slip for one that is not used.
    if used
        .iter()
        .any(|name| context.names.loads.position(name).is_none())
    {
        return;
    }
    for load in things(Root::<D>::loads(context.tree)).into_iter().flatten() {
        if !used.contains(&load.name.as_str()) {
            let message = format!("no stage applies the load `{}`", clip(&load.name, 40));
            problems.warning(load.name.place, message);
        }
    }
}
