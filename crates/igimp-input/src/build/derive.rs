//! Values that follow from the rest of the file: the stage before, the materials with strength,
//! the results folder, labels.

use std::path::Path;

use igimp_schema::schema::{SPACE, is_whole};
use igimp_schema::tree::{Node, Value};

use super::outputs::quantities::unit_of;

/// Share of a cell's volume below which a node is a small cut, in the plane and in space \[-\].
const BELOW: [f64; 2] = [1e-4, 1e-3];

/// The same beside rigid bodies, which leave slivers of soil in the cells that they cut
/// (docs/src/contact-measured.md, places of the grid) \[-\].
const BELOW_AT_BODIES: f64 = 0.05;

/// Puts them into the tree.
pub(super) fn derive(tree: &mut Node, file: &Path) {
    let strong = strong_materials(tree);
    let place = tree.place;
    if let Some(stages) = tree.get_mut("stages") {
        let names: Vec<_> = stages
            .items()
            .iter()
            .map(|stage| stage.text_at("name").map(str::to_owned))
            .collect();
        for (number, stage) in stages.items_mut().iter_mut().enumerate() {
            if stage.get("start_from").is_none()
                && number > 0
                && let Some(name) = &names[number - 1]
            {
                stage.add_derived("start_from", Value::Text(name.clone()));
            }
            let reduces = match stage.text_at("type") {
                Some("strength-reduction" | "run-out") => true,
                Some("dynamic") => stage.get("reduction").is_some(),
                _ => false,
            };
            if reduces && stage.get("materials").is_none() && !strong.is_empty() {
                let names = strong.iter().map(|name| {
                    let mut node = Node::written(Value::Text(name.clone()), place);
                    node.written = false;
                    node
                });
                let names = names.collect();
                stage.add_derived("materials", Value::List(names));
            }
            derive_search(stage);
        }
        derive_geometry(stages.items_mut());
    }
    if let Some(members) = tree.get_mut("reinforcement") {
        for member in members.items_mut() {
            let is_anchor = member.text_at("type") == Some("anchor");
            if is_anchor
                && member.get("head_capacity").is_none()
                && let Some(Value::Quantity(value, text)) =
                    member.get("capacity").map(|node| &node.value)
            {
                let value = Value::Quantity(*value, text.clone());
                member.add_derived("head_capacity", value);
            }
        }
    }
    if let Some(water) = tree.get_mut("water") {
        for condition in water.items_mut() {
            if condition.get("pond").is_none() {
                let is_meant = ["level", "outside"]
                    .iter()
                    .any(|key| condition.get(key).is_some());
                condition.add_derived("pond", Value::Flag(is_meant));
            }
        }
    }
    derive_drainage(tree);
    derive_output(tree, file);
    let analysis = tree.get("case").and_then(|case| case.text_at("analysis"));
    let dimensions = if analysis == Some(SPACE) { 3 } else { 2 };
    let is_whole = is_whole(tree);
    derive_grid(tree, dimensions);
    if let Some(curves) = tree.get_mut("curves") {
        for curve in curves.items_mut() {
            for axis in ["x", "y"] {
                if let Some(axis) = curve.get_mut(axis)
                    && axis.get("label").is_none()
                    && let Some(label) = label((dimensions, is_whole), axis)
                {
                    axis.add_derived("label", Value::Text(label));
                }
            }
        }
    }
}

/// The drainage of materials that state none.
pub(super) fn derive_drainage(tree: &mut Node) {
    let materials = tree.get_mut("materials").and_then(Node::entries_mut);
    for material in materials.into_iter().flatten() {
        let node = &mut material.node;
        if node.get("drainage").is_none()
            && let Some(model) = node.text_at("model")
        {
            let drainage = match model {
                "tresca" | "von-mises" => "total",
                _ => "drained",
            };
            node.add_derived("drainage", Value::Text(drainage.to_owned()));
        }
    }
}

/// The results folder, and when frames are written.
fn derive_output(tree: &mut Node, file: &Path) {
    let meshes = tree
        .get("mesh_study")
        .and_then(|study| study.count_at("meshes"));
    if let Some(frames) = tree
        .get_mut("output")
        .and_then(|output| output.get_mut("paraview"))
        && frames.get("every").is_none()
    {
        let is_study = meshes.is_some_and(|meshes| meshes > 1);
        let every = if is_study { "stage" } else { "film" };
        frames.add_derived("every", Value::Text(every.to_owned()));
    }
    if let Some(output) = tree.get_mut("output")
        && output.get("folder").is_none()
    {
        let stem = file.file_stem().map(|stem| stem.to_string_lossy());
        let stem = stem.filter(|stem| !stem.is_empty());
        let folder = format!("results/{}", stem.as_deref().unwrap_or("case"));
        output.add_derived("folder", Value::Text(folder));
    }
}

/// How a stage looks for the factor of safety.
fn derive_search(stage: &mut Node) {
    if stage.text_at("type") != Some("strength-reduction") || stage.get("search").is_some() {
        return;
    }
    let is_path = is_given(stage) && stage.items_at("factors").is_empty();
    let search = if is_path { "continuation" } else { "trials" };
    stage.add_derived("search", Value::Text(search.to_owned()));
}

/// Whether the steps of a stage leave the geometry as it is given.
fn is_given(stage: &Node) -> bool {
    stage.text_at("geometry") == Some("given")
}

/// The geometry on which gravity is raised: that of a search which goes back to it.
fn derive_geometry(stages: &mut [Node]) {
    let earlier = |number: usize, stage: &Node| {
        let from = stage.text_at("start_from")?;
        stages[..number]
            .iter()
            .position(|stage| stage.text_at("name") == Some(from))
    };
    let mut leads = vec![false; stages.len()];
    for number in (0..stages.len()).rev() {
        let stage = &stages[number];
        let searches = stage.text_at("type") == Some("strength-reduction") && is_given(stage);
        if (searches || leads[number])
            && let Some(from) = earlier(number, stage)
        {
            leads[from] = true;
        }
    }
    for (stage, leads) in stages.iter_mut().zip(leads) {
        if stage.text_at("type") == Some("gravity") && stage.get("geometry").is_none() {
            let geometry = if leads { "given" } else { "moving" };
            stage.add_derived("geometry", Value::Text(geometry.to_owned()));
        }
    }
}

/// Names of the materials of bodies that have a strength.
fn strong_materials(tree: &Node) -> Vec<String> {
    let changes = tree.items_at("stages").iter();
    let changes = changes
        .filter(|stage| stage.text_at("type") == Some("construction"))
        .flat_map(|stage| stage.items_at("materials"));
    let used: Vec<_> = (tree.items_at("bodies").iter().chain(changes))
        .filter_map(|body| body.text_at("material"))
        .collect();
    let materials = tree.get("materials").map_or(&[][..], Node::entries);
    materials
        .iter()
        .filter(|material| used.contains(&material.key.as_str()))
        .filter(|material| material.node.text_at("model") != Some("elastic"))
        .map(|material| material.key.clone())
        .collect()
}

/// The quantity and its unit, as in `footing.settlement [m]`.
fn label((dimensions, is_whole): (usize, bool), axis: &Node) -> Option<String> {
    let of = axis.text_at("of")?;
    let divisors = axis.items_at("divide_by");
    if divisors.is_empty() {
        return Some(format!("{of} [{}]", unit_of(dimensions, is_whole, of)));
    }
    let mut label = of.to_owned();
    for divisor in divisors {
        let text = match &divisor.value {
            Value::Quantity(_, text) => text.clone(),
            _ => igimp_schema::text::number(divisor.number()?),
        };
        label.push_str(" / ");
        label.push_str(&text);
    }
    Some(label)
}

/// Lines, domains and small cuts of a grid that rigid bodies cut, and of others.
fn derive_grid(tree: &mut Node, dimensions: usize) {
    let bodies = tree.items_at("rigid");
    let has_bodies = !bodies.is_empty();
    let are_round = bodies.iter().all(|body| {
        body.text_at("type") == Some("circle") && body.text_at("tension") != Some("bonded")
    });
    let (below, remedy) = if has_bodies {
        (BELOW_AT_BODIES, "extrapolate")
    } else {
        (BELOW[dimensions - 2], "tie")
    };
    let Some(grid) = tree.get_mut("grid") else {
        return;
    };
    if grid.get("fit").is_none() {
        let is_fitted = has_bodies && dimensions == 2;
        let fit = if is_fitted { "bodies" } else { "none" };
        grid.add_derived("fit", Value::Text(fit.to_owned()));
    }
    if grid.get("domain_update").is_none() {
        let update = if has_bodies && are_round {
            "scaled-moments"
        } else {
            "stretch"
        };
        grid.add_derived("domain_update", Value::Text(update.to_owned()));
    }
    let Some(cuts) = grid.get_mut("small_cuts") else {
        return;
    };
    if cuts.get("below").is_none() {
        cuts.add_derived("below", Value::Number(below));
    }
    if cuts.get("remedy").is_none() {
        cuts.add_derived("remedy", Value::Text(remedy.to_owned()));
    }
}
