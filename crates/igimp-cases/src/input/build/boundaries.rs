//! Supports.

use super::site::Site;
use crate::case::{Boundaries, FixedBox, Side};
use crate::input::diagnostic::Problems;
use crate::input::tree::Node;

/// The supports.
pub(super) fn boundaries(tree: &Node, site: &Site, problems: &mut Problems) -> Option<Boundaries> {
    let node = tree.get("boundaries")?;
    let boxes: Vec<_> = node
        .items_at("boxes")
        .iter()
        .map(|part| fixed_box(part, site, problems))
        .collect();
    Some(Boundaries {
        sides: [
            [side(node, "left")?, side(node, "right")?],
            [side(node, "bottom")?, side(node, "top")?],
        ],
        boxes: boxes.into_iter().collect::<Option<_>>()?,
    })
}

fn side(node: &Node, key: &str) -> Option<Side> {
    Some(match node.text_at(key)? {
        "roller" => Side::Roller,
        "fixed" => Side::Fixed,
        _ => Side::Free,
    })
}

fn fixed_box(node: &Node, site: &Site, problems: &mut Problems) -> Option<FixedBox> {
    let (from, to) = (node.pair_at("from")?, node.pair_at("to")?);
    let lower = [from[0].min(to[0]), from[1].min(to[1])];
    let upper = [from[0].max(to[0]), from[1].max(to[1])];
    if let Some(frame) = &site.frame {
        let has_nodes = (0..2).all(|axis| {
            let slack = 1e-6;
            let place = |x: f64| frame.axes[axis].place(x);
            let first = (place(lower[axis].max(frame.lower[axis])) - slack).ceil();
            first <= place(upper[axis].min(frame.upper[axis])) + slack
        });
        if !has_nodes {
            problems
                .warning(node.place, "there is no node in this box: it holds nothing")
                .help("let it reach over a line of the grid");
        }
    }
    let mut fix = [false; 2];
    for axis in node.items_at("fix") {
        fix[usize::from(axis.text()? == "y")] = true;
    }
    Some(FixedBox {
        name: node.text_at("name")?.to_owned(),
        lower,
        upper,
        fix,
    })
}
