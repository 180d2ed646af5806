//! Supports.

use igimp_model::{Boundaries, FixedBox, Side};
use igimp_schema::diagnostic::Problems;
use igimp_schema::tree::Node;

use super::Frame;

/// The supports.
pub(crate) fn boundaries<const D: usize>(
    tree: &Node,
    frame: Option<&Frame<D>>,
    problems: &mut Problems,
) -> Option<Boundaries<D>> {
    let node = tree.get("boundaries")?;
    let boxes: Vec<_> = node
        .items_at("boxes")
        .iter()
        .map(|part| fixed_box(part, frame, problems))
        .collect();
    let mut sides = [[Side::Free; 2]; D];
    let [across, up] = [["front", "back"], ["bottom", "top"]];
    for (axis, own) in sides.iter_mut().enumerate() {
        let keys = match axis {
            0 => ["left", "right"],
            _ if axis == D - 1 => up,
            _ => across,
        };
        *own = [side(node, keys[0])?, side(node, keys[1])?];
    }
    Some(Boundaries {
        sides,
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

fn fixed_box<const D: usize>(
    node: &Node,
    frame: Option<&Frame<D>>,
    problems: &mut Problems,
) -> Option<FixedBox<D>> {
    let (from, to): ([f64; D], [f64; D]) = (node.point_at("from")?, node.point_at("to")?);
    let lower: [f64; D] = std::array::from_fn(|axis| from[axis].min(to[axis]));
    let upper: [f64; D] = std::array::from_fn(|axis| from[axis].max(to[axis]));
    if let Some(frame) = frame {
        let has_nodes = (0..D).all(|axis| {
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
    let mut fix = [false; D];
    for axis in node.items_at("fix") {
        let name = axis.text()?;
        let Some(own) = ["x", "y", "z"].iter().take(D).position(|key| *key == name) else {
            problems
                .error(
                    axis.place,
                    format!("there is no axis {name} in plane strain"),
                )
                .help("write x or y");
            return None;
        };
        fix[own] = true;
    }
    Some(FixedBox {
        name: node.text_at("name")?.to_owned(),
        lower,
        upper,
        fix,
    })
}
