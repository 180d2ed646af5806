//! What pictures show beside the soil: rigid bodies and a rigid footing where they stand, and water tables. For tables the
//! rigid bodies that are there.

use std::collections::HashSet;

use igimp_assembly::RigidBody;
use igimp_figures::{Outline, OutlineStyle};

use super::model::Model;
use super::rigid;
use super::state::{Controls, State};
use crate::case::{Case, LoadKind};
use crate::results::pictures::rigid::{POINTS_OF_CIRCLE, block};
use crate::results::pictures::water;
use crate::results::rigid::Standing;

/// The outlines of everything rigid in a state, as far as it lies within the grid, and of the water tables that act.
pub(crate) fn of_state(model: &Model<'_>, state: &State) -> Vec<Outline> {
    let case = model.case;
    let water = water_tables(model, state);
    let bodies = rigid::outlines(case, state, POINTS_OF_CIRCLE);
    let bodies = bodies.filter_map(|(_, outline)| block(case, &outline));
    let footing = footing(case, state.controls.settlement);
    footing.into_iter().chain(bodies).chain(water).collect()
}

/// The water tables that act, as far as there is soil.
fn water_tables(model: &Model<'_>, state: &State) -> Vec<Outline> {
    let (case, particles) = (model.case, &state.body.particles);
    let Some(condition) = state.controls.water.and_then(|k| case.water.get(k)) else {
        return Vec::new();
    };
    let bodies: HashSet<usize> = particles
        .number
        .iter()
        .map(|&own| model.seeded.body[own])
        .collect();
    let ends = std::iter::zip(&particles.x, &particles.half_length);
    let ends = ends.fold(
        [f64::INFINITY, f64::NEG_INFINITY],
        |[left, right], (x, half)| [left.min(x[0] - half[0]), right.max(x[0] + half[0])],
    );
    water::tables(case, condition, |body| bodies.contains(&body), ends)
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
