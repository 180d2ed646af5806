//! How far nodes are coupled: one distance for nearly all of them, and the few that go beyond. One wide
//! particle, or one tie, must not make the window of all nodes wide.

use igimp_shape::{Grid, Support};

use crate::step::domain::bounds;
use crate::step::stencils::Stencils;

/// A reach up to this is that of all nodes: its window is small.
pub(crate) const SMALL_REACH: usize = 3;

/// One node in so many may reach further than the window of all others.
const NODES_PER_WIDE: usize = 20;

/// How far the couplings of each node reach at most, in nodes along one axis.
pub(crate) fn furthest<const D: usize>(
    grid: &Grid<D>,
    stencils: &Stencils<D>,
    extra: impl Iterator<Item = ((usize, usize), usize)>,
) -> Vec<usize> {
    let mut furthest = vec![0; grid.node_count()];
    let mut last: &[Support<D>] = &[];
    for &particle in stencils.order() {
        let supports = stencils.of(particle as usize);
        if same_nodes(supports, last) {
            continue;
        }
        last = supports;
        let reach = bounds(grid, supports).1.into_iter().max().unwrap_or(0);
        for support in supports {
            furthest[support.node] = reach.max(furthest[support.node]);
        }
    }
    for ((a, b), reach) in extra {
        for node in [a, b] {
            furthest[node] = reach.max(furthest[node]);
        }
    }
    furthest
}

/// The reach that nearly all nodes keep to, and which nodes do not.
pub(crate) fn common_reach(furthest: &[usize], most: usize) -> (usize, Vec<bool>) {
    let beyond = |reach: usize| furthest.iter().filter(|&&far| far > reach).count();
    let carrying = furthest.iter().filter(|&&far| far > 0).count();
    let near = (SMALL_REACH..most)
        .find(|&reach| beyond(reach) * NODES_PER_WIDE <= carrying)
        .unwrap_or(most);
    (near, furthest.iter().map(|&far| far > near).collect())
}

/// Whether two lists of supports have the same nodes.
#[inline]
pub(crate) fn same_nodes<const D: usize>(a: &[Support<D>], b: &[Support<D>]) -> bool {
    a.len() == b.len() && std::iter::zip(a, b).all(|(a, b)| a.node == b.node)
}

#[cfg(test)]
mod tests {
    use igimp_shape::Axis;

    use crate::{
        Constraints, Method, ParticleSeed, Particles, SharedLaw, StepConditions, StepLoads, System,
    };

    use super::*;

    /// Cells of size 1 from `before` on, after one cell that large along each axis, with a particle
    /// in each; the one in the large cell reaches as far on as that cell is long.
    fn places<const D: usize>(before: f64, cells: usize) -> (usize, usize) {
        let nodes = std::iter::once(0.0).chain((0..cells).map(|k| before + k as f64));
        let axis = Axis::from_nodes(nodes.collect()).unwrap();
        let grid = Grid::<D>::new(std::array::from_fn(|_| axis.clone()));
        let seeds: Vec<_> = (0..grid.cell_count())
            .filter(|&cell| cell == 0 || grid.cell_place(cell).iter().all(|&k| k > 0))
            .map(|cell| {
                let place = grid.cell_place(cell);
                let (size, node) = (grid.cell_size(place), grid.node_index(place));
                let lower = grid.node_position(node);
                ParticleSeed {
                    x: std::array::from_fn(|axis| lower[axis] + 0.9 * size[axis]),
                    half_length: size.map(|size| 0.5 * size),
                    volume: size.iter().product(),
                    density: 1.0,
                    law: 0,
                    centroid: [0.0; _],
                }
            })
            .collect();
        let body = Particles::new(&seeds).unwrap();
        let law = igimp_material::Elasticity::new(1.0, 0.2).map(igimp_material::HenckyElastic::new);
        let law: SharedLaw = std::sync::Arc::new(law.unwrap());
        let conditions = StepConditions::new(
            grid.clone(),
            Constraints::free(&grid),
            StepLoads::gravity([0.0; D]),
            vec![law],
        )
        .unwrap();
        let method = Method::igimp_bbar();
        let stencils = Stencils::build(&body, &method, &conditions).unwrap();
        let system = System::new(&body, &stencils, &conditions, &method).unwrap();
        assert!(system.pattern().reach > SMALL_REACH);
        (system.table.places(), system.pattern().coupled.len())
    }

    #[test]
    fn one_wide_particle_does_not_widen_all_windows() {
        let (places, coupled) = places::<2>(10.0, 40);
        assert!(places < 6 * coupled, "{places} for {coupled} couplings");
        let (places, coupled) = self::places::<3>(8.0, 20);
        assert!(places < 6 * coupled, "{places} for {coupled} couplings");
    }

    #[test]
    fn a_reach_that_many_nodes_have_is_common() {
        let furthest = |wide: usize| -> Vec<usize> {
            let reach = |k| if k < wide { 7 } else { 2 };
            (0..100).map(reach).collect()
        };
        assert_eq!(common_reach(&furthest(5), 7).0, 3);
        assert_eq!(common_reach(&furthest(6), 7).0, 7);
        let (_, is_wide) = common_reach(&furthest(5), 7);
        assert_eq!(is_wide.iter().filter(|&&is_wide| is_wide).count(), 5);
    }
}
