//! Stages: what each needs from loads, materials and the stages before it.

pub(crate) mod construction;
pub(crate) mod safety;

use igimp_assembly::Geometry;
use igimp_model::{LoadKind, Stage, StageKind, StopWhen, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::text::{clip, number, row};
use igimp_schema::tree::{Node, Wrong};

use super::ground::level::uneven;
use crate::build::context::Context;
use crate::build::things;
use safety::{run_out, strength_reduction};

/// The stages.
pub(super) fn stages<const D: usize>(
    context: &Context<'_, D>,
    problems: &mut Problems,
) -> Vec<Option<Stage>> {
    (context.stage_nodes().iter().enumerate())
        .map(|(index, node)| stage(context, index, node, problems))
        .collect()
}

fn stage<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    problems: &mut Problems,
) -> Option<Stage> {
    let name = clip(node.text_at("name").unwrap_or("?"), 40);
    let kind = match node.text_at("type")? {
        "gravity" => gravity(node),
        "k0" => {
            k0(context, index, node, problems);
            Some(StageKind::K0)
        }
        "load" => load(context, index, node, &name, problems),
        "displacement" => displacement(context, index, node, &name, problems),
        "rigid" => super::rigid::stage::stage(context, node, &name, problems),
        "construction" => construction::stage(context, index, node, &name, problems),
        "strength-reduction" => strength_reduction(context, index, node, &name, problems)
            .map(StageKind::StrengthReduction),
        _ => run_out(context, index, node, &name, problems).map(StageKind::RunOut),
    };
    let start_from = start_from(context, index, node, &name, problems);
    let stop_when = stop_when(context, node, &name, problems);
    let install = super::reinforcement::installs(context, index, node, &name, problems);
    Some(Stage {
        drained: node.flag_at("drained")?,
        name: node.text_at("name")?.to_owned(),
        kind: kind?,
        steps: node.count_at("steps")?,
        geometry: geometry(node),
        start_from: start_from.ok()?,
        reset_displacements: node.flag_at("reset_displacements")?,
        install: install?,
        stop_when: stop_when?,
    })
}

fn gravity(node: &Node) -> Option<StageKind> {
    let horizontal = node.optional_number("horizontal");
    let across = node.optional_number("across");
    let vertical = node.optional_number("vertical");
    Some(StageKind::Gravity {
        factor: node.number_at("factor")?,
        horizontal: horizontal.ok()?,
        across: across.ok()?,
        vertical: vertical.ok()?,
    })
}

/// The geometry that the steps of a stage are computed on; types without the key move the particles.
fn geometry(node: &Node) -> Geometry {
    match node.text_at("geometry") {
        Some("given") => Geometry::Given,
        _ => Geometry::Moving,
    }
}

fn start_from<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Result<Option<usize>, Wrong> {
    let place = node.place_at("start_from");
    if index == 0 && node.get("start_from").is_some() {
        problems
            .error(
                place,
                "the first stage starts from undeformed bodies, not from a stage",
            )
            .help("remove start_from");
        return Err(Wrong);
    }
    let who = format!("stage `{name}` starts from");
    let stages = &context.names.stages;
    let from = stages.find_optional(node.get("start_from"), &who, problems)?;
    if from.is_some_and(|from| from >= index) {
        problems
            .error(place, "start_from has to name an earlier stage")
            .help(format!(
                "earlier stages: {}",
                row(stages.known().take(index))
            ));
        return Err(Wrong);
    }
    Ok(from)
}

fn stop_when<const D: usize>(
    context: &Context<'_, D>,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<StopWhen> {
    let table = node.get("stop_when")?;
    let kind = node.text_at("type")?;
    let monitor = context.monitor(table.get("monitor"), name, problems).ok()?;
    let displacement = table.optional_number("displacement").ok()?;
    let load_grows_less_than = table.optional_number("load_grows_less_than").ok()?;
    let ends = table.entries().iter();
    let mut ends = ends.filter(|end| end.node.written && end.node.flag() != Some(false));
    if kind == "construction"
        && let Some(end) = ends.next()
    {
        problems
            .error(end.key_place, "a construction stage has no early end")
            .help("what holds the ground as the stage begins must all be let go: remove stop_when")
            .help("a stage that finds no equilibrium says how far it came");
    }
    if monitor.is_some() && displacement.is_none() {
        problems
            .error(
                table.place_at("monitor"),
                "there is no displacement for this monitor",
            )
            .help("add displacement = \"0.5 m\"");
    }
    if load_grows_less_than.is_some() && kind != "displacement" {
        problems
            .error(
                table.place_at("load_grows_less_than"),
                format!("a stage of type {kind} has no footing whose load grows"),
            )
            .help(if kind == "rigid" {
                "end the stage by displacement = \"0.1 m\", and read the resistance from a curve of `rigid.NAME.resistance`"
            } else {
                "it is for stages of type displacement"
            });
    }
    if kind == "strength-reduction" && displacement.is_some() {
        problems
            .error(
                table.place_at("displacement"),
                "a strength reduction ends by its failure criterion",
            )
            .help("write failure = { also = { displacement = \"0.5 m\" } }");
    }
    Some(StopWhen {
        displacement,
        monitor,
        no_equilibrium: table.flag_at("no_equilibrium")?,
        load_grows_less_than,
    })
}

fn k0<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    problems: &mut Problems,
) {
    let place = node.place_at("type");
    if index > 0 {
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
    for (index, material) in context.materials.iter().enumerate() {
        let Some(material) = material else { continue };
        let needs = material.strength != Strength::Elastic && material.k0.is_none();
        let start = &context.sequence.start;
        let bodies = std::iter::zip(&start.present, &start.material);
        let is_there = |(present, own): (&bool, &Option<usize>)| *present && *own == Some(index);
        if needs && bodies.clone().any(is_there) {
            let entries = context.tree.get("materials").map_or(&[][..], Node::entries);
            let at = entries.get(index).map_or(place, |entry| entry.node.place);
            problems
                .error(
                    at,
                    format!(
                        "the k0 stage needs k0 of the material `{}`",
                        clip(&material.name, 40)
                    ),
                )
                .help(match material.strength {
                    Strength::MohrCoulomb { .. } => "add k0 = \"jaky\", or a number",
                    _ => "add k0 = 0.5, or what it is",
                });
        }
    }
}

fn load<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<StageKind> {
    let names: Vec<&Node> = match (node.get("load"), node.get("loads")) {
        (Some(one), None) => vec![one],
        (None, Some(several)) => several.items().iter().collect(),
        (None, None) => {
            problems
                .error(node.place, format!("stage `{name}` names no load"))
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
    let mut loads = Vec::new();
    let mut is_right = true;
    for value in names {
        let who = format!("stage `{name}` applies");
        let Some(load) = context.names.loads.find(value, &who, problems) else {
            is_right = false;
            continue;
        };
        if loads.contains(&load) {
            problems.error(value.place, "this load is named twice");
        }
        loads.push(load);
        if node.number_at("factor") != Some(0.0) {
            construction::load_is_held(context, index, load, value, problems);
        }
        let kind = context.loads.get(load).and_then(Option::as_ref);
        if let Some(LoadKind::RigidFooting { .. }) = kind.map(|load| &load.kind) {
            problems
                .error(value.place, "a rigid footing is pushed, not loaded")
                .help("use a stage of type displacement");
        }
    }
    let factor = node.number_at("factor")?;
    is_right.then_some(StageKind::Load { loads, factor })
}

fn displacement<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<StageKind> {
    let who = format!("stage `{name}` pushes");
    let value = node.get("load")?;
    let load = context.names.loads.find(value, &who, problems)?;
    let settlement = node.number_at("settlement")?;
    construction::load_is_held(context, index, load, value, problems);
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
        && settlement >= from[1] - frame.lower[1]
    {
        let depth = number(from[1] - frame.lower[1]);
        problems
            .error(
                node.place_at("settlement"),
                "the footing would reach the bottom of the grid",
            )
            .help(format!("its base is {depth} m above it"));
    }
    Some(StageKind::Displacement { load, settlement })
}

/// Warns of materials and loads that nothing uses.
pub(super) fn check_use<const D: usize>(context: &Context<'_, D>, problems: &mut Problems) {
    let materials = context.tree.get("materials").map_or(&[][..], Node::entries);
    for (index, entry) in materials.iter().enumerate() {
        if !context.is_used(index) && !context.bodies.is_empty() {
            let message = format!("no body uses the material `{}`", clip(&entry.key, 40));
            problems.warning(entry.key_place, message);
        }
    }
    let used: Vec<&str> = (context.stage_nodes().iter())
        .flat_map(|stage| stage.get("load").into_iter().chain(stage.items_at("loads")))
        .filter_map(Node::text)
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
