//! Structures that pictures show beside the soil: rigid bodies, a rigid footing and reinforcement where they stand, and water
//! tables. For tables and frames the structures that are there.

use std::collections::HashSet;

use igimp_figures::{Outline, OutlineStyle};
use igimp_model::{Case, LoadKind, in_plane};
use igimp_report::pictures::rigid::{POINTS_OF_CIRCLE, block};
use igimp_report::pictures::{Over, water};
use igimp_results::paraview::frames::Structures;
use igimp_results::reinforcement;
use igimp_results::rigid::Standing;
use igimp_seepage::Seepage;
use igimp_solver::Body;

use crate::run::model::Model;
use crate::run::rigid;
use crate::run::state::{Controls, State};

/// The lines over a state: everything rigid in it, as far as it lies within the grid, the water tables that act, and
/// reinforcement.
pub(crate) fn of_state<const D: usize>(
    case: &Case<2>,
    model: &Model<'_, D>,
    state: &State<2>,
) -> Over {
    let water = water_tables(case, &model.seeded.body, state);
    let computed = (state.controls.water.and_then(|k| model.ground_water(k)))
        .and_then(|ground| in_plane::<_, Seepage<2>>(&**ground.flow()?));
    let surface = computed.map_or_else(Vec::new, Seepage::free_surface_lines);
    let surface = surface.into_iter().map(|points| Outline {
        points,
        style: OutlineStyle::Water,
    });
    let bodies = rigid::outlines(case, state, POINTS_OF_CIRCLE);
    let bodies = bodies.filter_map(|(_, outline)| block(case, &outline));
    let footing = footing(case, state.controls.settlement);
    let members = structures(case, &state.controls, &state.body).reinforcement;
    let (lower, upper) = (case.grid.lower(), case.grid.upper());
    let size = (upper[0] - lower[0]).max(upper[1] - lower[1]);
    let members_drawn = reinforcement::outlines(&members, size);
    Over {
        outlines: footing
            .into_iter()
            .chain(bodies)
            .chain(water)
            .chain(surface)
            .chain(members_drawn)
            .collect(),
        labels: reinforcement::labels(&members),
    }
}

/// The water tables that act, as far as there is soil.
fn water_tables(case: &Case<2>, body_of: &[usize], state: &State<2>) -> Vec<Outline> {
    let particles = &state.body.particles;
    let Some(condition) = state.controls.water.and_then(|k| case.water.get(k)) else {
        return Vec::new();
    };
    let bodies: HashSet<usize> = particles.number.iter().map(|&k| body_of[k]).collect();
    let ends = std::iter::zip(&particles.x, &particles.half_length);
    let ends = ends.fold(
        [f64::INFINITY, f64::NEG_INFINITY],
        |[left, right], (x, half)| [left.min(x[0] - half[0]), right.max(x[0] + half[0])],
    );
    water::tables(case, condition, |body| bodies.contains(&body), ends)
}

/// The structures that are there under controls.
pub(crate) fn structures<'a, const D: usize>(
    case: &'a Case<D>,
    controls: &Controls,
    body: &'a Body<D>,
) -> Structures<'a, D> {
    let rigid = std::iter::zip(controls.placed(), &body.rigid);
    Structures {
        rigid: rigid
            .map(|(index, body)| Standing {
                index,
                part: &case.rigid[index],
                body,
            })
            .collect(),
        reinforcement: crate::run::reinforcement::present(case, controls, &body.reinforcement),
    }
}

/// A rigid footing that was pushed, as a block two cells high.
fn footing(case: &Case<2>, settlement: f64) -> Option<Outline> {
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
