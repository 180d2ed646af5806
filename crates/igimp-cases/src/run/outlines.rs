//! What is rigid where it stands, for pictures and tables: rigid bodies, and a rigid footing.

use igimp_assembly::RigidBody;
use igimp_figures::{Outline, OutlineStyle};

use super::model::Model;
use super::rigid;
use super::state::{Controls, State};
use crate::case::{Case, LoadKind};
use crate::results::pictures::rigid::{POINTS_OF_CIRCLE, block};
use crate::results::rigid::Standing;

/// The outlines of everything rigid in a state, as far as it lies within the grid.
pub(crate) fn of_state(model: &Model<'_>, state: &State) -> Vec<Outline> {
    let case = model.case;
    let bodies = rigid::outlines(case, state, POINTS_OF_CIRCLE);
    let bodies = bodies.filter_map(|(_, outline)| block(case, &outline));
    let footing = footing(case, state.controls.settlement);
    footing.into_iter().chain(bodies).collect()
}

/// The rigid bodies that are there under controls.
pub(crate) fn standing<'a>(
    case: &'a Case,
    controls: &Controls,
    bodies: &'a [RigidBody<2>],
) -> Vec<Standing<'a>> {
    std::iter::zip(controls.placed(), bodies)
        .map(|(index, body)| Standing {
            index,
            part: &case.rigid[index],
            body,
        })
        .collect()
}

/// A rigid footing that was pushed, as a block two cells high.
fn footing(case: &Case, settlement: f64) -> Option<Outline> {
    case.loads.iter().find_map(|load| match load.kind {
        LoadKind::RigidFooting { from, to, .. } if settlement > 0.0 => {
            let base = from[1] - settlement;
            let top = from[1].max(base + 2.0 * case.grid.axes[1].cell_at(from[1]));
            let corners = [[from[0], base], [to[0], base], [to[0], top], [from[0], top]];
            Some(Outline {
                points: corners.to_vec(),
                style: OutlineStyle::Block,
            })
        }
        _ => None,
    })
}
