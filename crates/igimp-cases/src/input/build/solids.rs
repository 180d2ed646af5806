//! Bodies in space.

use std::sync::Arc;

use super::AllNames;
use super::sequence::placed;
use crate::case::BodyPart;
use crate::input::diagnostic::Problems;
use crate::input::text::clip;
use crate::input::tree::Node;
use crate::solid::Solid;

/// The bodies, as far as each is right by itself.
pub(super) fn solids(
    tree: &Node,
    names: &AllNames,
    problems: &mut Problems,
) -> Vec<Option<BodyPart<3>>> {
    let later = placed(tree);
    let items = tree.items_at("bodies").iter();
    items
        .map(|body| part(body, names, &later, problems))
        .collect()
}

fn part(
    node: &Node,
    names: &AllNames,
    later: &[&str],
    problems: &mut Problems,
) -> Option<BodyPart<3>> {
    let name = node.text_at("name").unwrap_or("?");
    let material = node.get("material").and_then(|material| {
        let who = format!("body `{}` uses", clip(name, 40));
        names.materials.find(material, &who, problems)
    });
    let solid = solid(node, name, problems);
    let points = node.count_at("points_per_cell")?;
    Some(BodyPart {
        from_start: !later.contains(&name),
        name: node.text_at("name")?.to_owned(),
        material: material?,
        per_direction: (1..=4).find(|count| count * count * count >= points)?,
        region: Arc::new(solid?),
    })
}

fn solid(node: &Node, name: &str, problems: &mut Problems) -> Option<Solid> {
    if let Some(cuboid) = node.get("box") {
        let (from, to) = (cuboid.point_at::<3>("from")?, cuboid.point_at::<3>("to")?);
        let lower = std::array::from_fn(|axis| from[axis].min(to[axis]));
        let upper = std::array::from_fn(|axis| from[axis].max(to[axis]));
        return Some(Solid::Cuboid(lower, upper));
    }
    let polygon = node.items_at("polygon").iter().map(Node::pair);
    let polygon: Vec<[f64; 2]> = polygon.collect::<Option<_>>()?;
    let Some([from, to]) = node.pair_at("across") else {
        problems
            .error(
                node.place,
                format!("the body `{}` has no extent along y", clip(name, 40)),
            )
            .help("add across = [\"0 m\", \"10 m\"]");
        return None;
    };
    Some(Solid::slice(&polygon, [from.min(to), from.max(to)]))
}
