//! Heads to begin with from the flow on a grid of cells twice as long, and of that from one twice as long again.
//!
//! They change how many corrections a flow takes, not what is found: heads on the grid that is asked for balance as ever.

use igimp_shape::{Axis, Grid};

use crate::conditions::{Conditions, FreeWater};
use crate::curve::Relative;
use crate::field::{by_node, interpolated};
use crate::ground::SeepageBody;
use crate::solve::{ON_THE_WAY, Search, relative_of};
use crate::system::System;

/// Heads to begin with, and how permeability falls in the flow that they are from.
pub(crate) type Start = (Vec<f64>, Relative);

/// Heads on a coarser grid at the nodes of a system; none where it cannot carry the conditions, or no flow is found on it.
pub(crate) fn start<const D: usize>(
    system: &System<'_, D>,
    bodies: &[SeepageBody<'_, D>],
    free: FreeWater<'_, D>,
    few: usize,
) -> Option<Start> {
    let fine = system.grid;
    let axes: Option<Vec<Axis>> = fine.axes.iter().map(halved).collect();
    let grid = Grid::new(axes?.try_into().ok()?);
    let stated = system.conditions;
    let tallest = relative_of(&grid, &Conditions::of(Vec::new())).width;
    let conditions = Conditions {
        width: stated.width.map(|width| width.max(tallest)),
        sections: Vec::new(),
        ..stated.clone()
    };
    let mut search = Search::of(&grid, bodies, &conditions, free).ok()?;
    search
        .find((bodies, free), ON_THE_WAY * ON_THE_WAY, few)
        .ok()?;
    let heads = by_node(&search.system, &search.heads);
    let at = |&node: &usize| interpolated(&grid, &heads, &fine.node_position(node));
    let own = system.nodes.iter().map(at).collect();
    Some((own, relative_of(&grid, &conditions)))
}

/// Every second node of an axis, and its last.
fn halved(axis: &Axis) -> Option<Axis> {
    let mut nodes: Vec<f64> = axis.nodes().iter().copied().step_by(2).collect();
    if axis.cell_count() % 2 == 1 {
        nodes.push(axis.end());
    }
    Axis::from_nodes(nodes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditions::{Extent, InGround, Named, OnFaces, Soil};
    use crate::curve::Curve;
    use crate::solve::TOLERANCE;

    fn named<T>(name: &str, [lower, upper]: [[f64; 2]; 2], what: T) -> Named<2, T> {
        Named {
            name: name.to_owned(),
            within: Extent { lower, upper },
            what,
        }
    }

    /// Heads from a coarser grid and from a constant, and the corrections that they took.
    fn both(conditions: &Conditions<2>) -> [(Vec<f64>, usize); 2] {
        let axis = |from: f64, count| Axis::uniform(from, 0.5, count).unwrap();
        let grid = Grid::new([axis(-0.15, 33), axis(0.0, 21)]);
        let region = vec![[0.0, 0.0], [16.0, 0.0], [13.0, 10.0], [5.0, 10.0]];
        let bodies = [SeepageBody {
            region: &region,
            soil: 0,
            scale: None,
        }];
        [100, usize::MAX].map(|few| {
            let mut search = Search::of(&grid, &bodies, conditions, &|_| None).unwrap();
            search.find((&bodies, &|_| None), TOLERANCE, few).unwrap();
            (search.heads, search.corrections)
        })
    }

    /// GOAL: a start from a coarser grid spares corrections and changes nothing that is found, with faces off the lines of the grid,
    /// a sharp surface or a curve, and a well that the coarser grid cannot see. ORACLE: the search from a constant head.
    #[test]
    fn a_start_from_a_coarser_grid_changes_corrections_alone() {
        let mut conditions = Conditions::of(vec![Soil {
            across: 0.3,
            ..Soil::isotropic(1.0)
        }]);
        conditions.faces = vec![
            named("pool", [[0.0, 0.0], [5.0, 9.0]], OnFaces::Head(9.0)),
            named("base", [[0.0, 0.0], [16.0, 0.0]], OnFaces::Closed),
        ];
        let well = named("well", [[8.1, 2.15], [8.2, 2.25]], InGround::Inflow(-0.5));
        let gardner = Curve::Gardner { alpha: 2.0 };
        for (curve, regions, spares) in [
            (Curve::Ramp, Vec::new(), true),
            (gardner, Vec::new(), true),
            (Curve::Ramp, vec![well], false),
        ] {
            conditions.soils[0].curve = curve;
            conditions.regions = regions;
            let [(found, few), (expected, many)] = both(&conditions);
            let pairs = std::iter::zip(&found, &expected);
            let apart = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            println!("{curve:?}: {apart:.1e} m apart, {few} and {many} corrections");
            assert!(apart < 1e-9 * 10.0);
            assert!(if spares { 2 * few < many } else { few == many });
        }
    }
}
