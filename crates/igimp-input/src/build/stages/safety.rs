//! Stages that reduce strength: the search for the factor of safety, and the run-out.

use igimp_model::{Reduction, ReductionPath, RunOut, SearchMethod, Strength, StrengthReduction};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::clip;
use igimp_schema::tree::Node;

use crate::build::context::Context;

/// Indices of the materials whose strength is reduced.
fn materials<const D: usize>(
    context: &Context<'_, D>,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<Vec<usize>> {
    let Some(list) = node.get("materials") else {
        if context.materials.iter().any(Option::is_none)
            || context.bodies.iter().any(Option::is_none)
        {
            return None;
        }
        problems
            .error(
                node.place_at("type"),
                format!("stage `{name}` has no strength to reduce: all materials are elastic"),
            )
            .help("give a material a strength, like model = \"mohr-coulomb\"");
        return None;
    };
    let mut indices = Vec::new();
    let mut is_right = true;
    for value in list.items() {
        let who = format!("stage `{name}` reduces");
        let Some(index) = context.names.materials.find(value, &who, problems) else {
            is_right = false;
            continue;
        };
        if indices.contains(&index) {
            problems.error(value.place, "this material is named twice");
        }
        indices.push(index);
        let Some(material) = context.materials.get(index).and_then(Option::as_ref) else {
            continue;
        };
        let shown = clip(&material.name, 40);
        if material.strength == Strength::Elastic {
            problems
                .error(
                    value.place,
                    format!("the material `{shown}` is elastic: it has no strength to reduce"),
                )
                .help("leave it out; it keeps its stiffness");
        } else if !context.is_used(index) {
            problems.warning(value.place, format!("no body uses the material `{shown}`"));
        }
    }
    is_right.then_some(indices)
}

/// A search for the factor of safety.
pub(crate) fn strength_reduction<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<StrengthReduction> {
    let materials = materials(context, node, name, problems);
    let path = match node.text_at("path")? {
        "gravity" => ReductionPath::Gravity,
        _ => ReductionPath::Reduce,
    };
    if index == 0 && path == ReductionPath::Reduce {
        problems
            .error(
                node.place_at("type"),
                "a strength reduction needs a loaded body to start from",
            )
            .help("put a stage of type gravity before it, or write path = \"gravity\"");
    }
    if path == ReductionPath::Gravity && !context.tree.items_at("rigid").is_empty() {
        problems
            .error(
                node.place_at("path"),
                "gravity is raised on undeformed bodies, where rigid bodies stand elsewhere",
            )
            .help("write path = \"reduce\"");
    }
    let bracket = node.pair_at("bracket")?;
    if bracket[0] >= bracket[1] {
        problems
            .error(
                node.place_at("bracket"),
                "the bracket is not in ascending order",
            )
            .help("a factor thought stable first, like [1.0, 2.0]");
    }
    let factors: Option<Vec<_>> = node.items_at("factors").iter().map(Node::number).collect();
    let failure = node.get("failure")?;
    let (failure_displacement, monitor) = match failure.get("also") {
        None => (None, None),
        Some(also) => (
            Some(also.number_at("displacement")?),
            context.monitor(also.get("monitor"), name, problems).ok()?,
        ),
    };
    let search = match node.text_at("search")? {
        "continuation" => SearchMethod::Continuation,
        _ => SearchMethod::Trials,
    };
    if search == SearchMethod::Continuation {
        on_given_geometry(node, problems);
    }
    Some(StrengthReduction {
        search,
        materials: materials?,
        factors: factors?,
        bracket,
        tolerance: node.number_at("tolerance")?,
        path,
        failure_displacement,
        monitor,
    })
}

/// Refuses what a path of equilibria has no place for.
fn on_given_geometry(node: &Node, problems: &mut Problems) {
    if node.text_at("geometry") == Some("moving") {
        problems
            .error(
                node.place_at("geometry"),
                "a path of equilibria is followed on the given geometry",
            )
            .help("write geometry = \"given\", or search = \"trials\"");
    }
    if !node.items_at("factors").is_empty() {
        problems
            .error(
                node.place_at("factors"),
                "a path of equilibria has factors of its own",
            )
            .help("leave `factors` out, or write search = \"trials\"");
    }
}

/// A run-out.
pub(crate) fn run_out<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<RunOut> {
    let materials = materials(context, node, name, problems);
    if index == 0 {
        problems
            .error(
                node.place_at("type"),
                "a run-out needs a loaded body to start from",
            )
            .help("put a stage of type gravity before it");
    }
    let table = node.get("reduction")?;
    let reduction = match (table.get("times_fos"), table.get("factor")) {
        (Some(times), None) => {
            let has_search = (0..index).any(|k| context.type_of(k) == Some("strength-reduction"));
            if !has_search {
                problems
                    .error(
                        times.place,
                        "there is no earlier stage that finds a factor of safety",
                    )
                    .help(
                        "put a stage of type strength-reduction before it, or write factor = 1.5",
                    );
            }
            times.number().map(Reduction::TimesFos)
        }
        (None, Some(factor)) => factor.number().map(Reduction::Factor),
        (both, _) => {
            let message = if both.is_some() {
                "both `times_fos` and `factor` are given"
            } else {
                "the reduction has no value"
            };
            problems
                .error(table.place, message)
                .help("write { times_fos = 1.05 } or { factor = 1.5 }");
            None
        }
    };
    Some(RunOut {
        materials: materials?,
        reduction: reduction?,
        move_per_step: node.number_at("move_per_step")?,
        at_rest: node.number_at("at_rest")?,
    })
}
