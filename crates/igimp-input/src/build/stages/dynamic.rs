//! Stages that take time.

use igimp_assembly::{MassMatrix, TimeScheme};
use igimp_model::{Dynamic, StageKind};
use igimp_schema::diagnostic::Problems;
use igimp_schema::tree::Node;

use super::safety::{materials, reduction};
use crate::build::context::Context;
use crate::build::rigid::stage::moves;

/// Motion in time.
pub(crate) fn stage<const D: usize>(
    context: &Context<'_, D>,
    index: usize,
    node: &Node,
    name: &str,
    problems: &mut Problems,
) -> Option<StageKind> {
    let bodies = moves(context, node, name, problems);
    let lost = match node.get("reduction") {
        None => None,
        Some(table) => Some((
            materials(context, node, name, problems)?,
            reduction(context, index, table, problems)?,
        )),
    };
    Some(StageKind::Dynamic(Dynamic {
        duration: node.number_at("duration")?,
        scheme: match node.text_at("scheme")? {
            "backward-euler" => TimeScheme::BackwardEuler,
            _ => TimeScheme::Newmark,
        },
        mass: match node.text_at("mass")? {
            "lumped" => MassMatrix::Lumped,
            _ => MassMatrix::Consistent,
        },
        tied_below: node.number_at("tied_below")?,
        longest_step: node.optional_number("longest_step").ok()?,
        reduction: lost,
        bodies: bodies?,
        at_rest: node.optional_number("at_rest").ok()?,
    }))
}
