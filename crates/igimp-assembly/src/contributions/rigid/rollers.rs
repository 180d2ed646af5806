//! Rollers behind the tips of rigid bodies: no soil touches a side of the grid that a body covers, and where the body is narrow
//! the nodes on that side belong to soil beside it (theory, eq. 45g).

use std::borrow::Cow;
use std::ops::Range;

use igimp_shape::Grid;

use crate::conditions::StepConditions;
use crate::error::AssemblyError;
use igimp_rigid::RigidBody;

/// A body that reaches so many cells inwards is no tip: it is blunt below, or its soil has no share in nodes on the side.
const WIDE: usize = 2;

/// A body covers a node that has it so much of a cell inwards: bodies of half models may end on their axis, and soil touches that below
/// the point of a tip \[-\].
const INWARDS: f64 = 1e-6;

impl<const D: usize> StepConditions<D> {
    /// These without the rollers at nodes that narrow parts of bodies cover on a side of the grid.
    ///
    /// # Errors
    /// None, as the nodes are those of the grid.
    pub fn without_rollers_at_tips(
        &self,
        bodies: &[RigidBody<D>],
    ) -> Result<Cow<'_, Self>, AssemblyError> {
        let mut covered = Vec::new();
        for body in bodies {
            for normal in 0..D {
                let last = self.grid.axes[normal].node_count() - 1;
                for end in [0, last] {
                    covered.extend(self.rollers_behind(body, (normal, end)));
                }
            }
        }
        let mut cleared = Cow::Borrowed(self);
        for (node, axis) in covered {
            cleared.to_mut().constraints.release(node, axis)?;
        }
        Ok(cleared)
    }

    /// Nodes of a side, at a place on its normal, with a roller that a body covers; each with the normal.
    fn rollers_behind(
        &self,
        body: &RigidBody<D>,
        (normal, end): (usize, usize),
    ) -> Vec<(usize, usize)> {
        let (grid, origin) = (&self.grid, body.pose.origin);
        let (lower, upper) = body.surface.extent();
        let arm = (0..D).map(|a| lower[a].abs().max(upper[a].abs()).powi(2));
        let reach = arm.sum::<f64>().sqrt();
        let near: [Range<usize>; D] = std::array::from_fn(|a| {
            let nodes = grid.axes[a].nodes();
            let from = nodes.partition_point(|x| *x < origin[a] - reach);
            let to = nodes.partition_point(|x| *x <= origin[a] + reach);
            let of_side = from.max(end)..to.min(end + 1);
            if a == normal { of_side } else { from..to }
        });
        let is_roller = |node: usize| {
            let held = |a| self.constraints.of(node, a);
            (0..D).all(|a| held(a) == (a == normal).then_some(0.0))
        };
        let inwards = if end == 0 { INWARDS } else { -INWARDS };
        let is_within = |place: [usize; D], shift: f64| {
            let cell = grid.cell_size(place.map(|k| k.saturating_sub(1)))[normal];
            let mut x = grid.node_position(grid.node_index(place));
            x[normal] += shift * cell;
            body.distance(&x) < 0.0
        };
        let covers = |place| is_within(place, inwards);
        let is_wide = |mut place: [usize; D]| {
            let last = grid.axes[normal].cell_count();
            place[normal] = end.abs_diff(WIDE.min(last));
            is_within(place, -inwards)
        };
        let is_narrow = |place| {
            let mut beside = beside(grid, place, normal);
            beside.all(|other| !covers(other) || !is_wide(other))
        };
        places(near)
            .map(|place| (place, grid.node_index(place)))
            .filter(|&(place, node)| is_roller(node) && covers(place) && is_narrow(place))
            .map(|(_, node)| (node, normal))
            .collect()
    }
}

/// The places in a box.
fn places<const D: usize>(ranges: [Range<usize>; D]) -> impl Iterator<Item = [usize; D]> {
    let count = ranges.iter().map(Range::len).product();
    (0..count).map(move |number| {
        let mut rest = number;
        std::array::from_fn(|a| {
            let offset = rest % ranges[a].len();
            rest /= ranges[a].len();
            ranges[a].start + offset
        })
    })
}

/// A node and its neighbours on a side across an axis.
fn beside<const D: usize>(
    grid: &Grid<D>,
    place: [usize; D],
    normal: usize,
) -> impl Iterator<Item = [usize; D]> {
    places(std::array::from_fn(|a| {
        let last = grid.axes[a].node_count() - 1;
        if a == normal {
            place[a]..place[a] + 1
        } else {
            place[a].saturating_sub(1)..(place[a] + 1).min(last) + 1
        }
    }))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use igimp_material::{Elasticity, HenckyElastic};
    use igimp_shape::Axis;

    use super::*;
    use crate::{Constraints, Interface, StepLoads, Surface};

    /// A square of 10 unit cells that rolls on its left side, or is fixed there, and rolls on its bottom.
    fn conditions(is_fixed: bool) -> StepConditions<2> {
        let axis = Axis::uniform(0.0, 1.0, 10).unwrap();
        let grid = Grid::new([axis.clone(), axis]);
        let mut constraints = Constraints::free(&grid);
        constraints.fix_wall(&grid, 0, false, 0).unwrap();
        if is_fixed {
            constraints.fix_wall(&grid, 0, false, 1).unwrap();
        }
        constraints.fix_wall(&grid, 1, false, 1).unwrap();
        let law = Arc::new(HenckyElastic::new(Elasticity::new(1.0, 0.3).unwrap()));
        StepConditions::new(grid, constraints, StepLoads::gravity([0.0; 2]), vec![law]).unwrap()
    }

    /// Heights of the nodes on the left side that a body makes free.
    fn freed(surface: Surface<2>, origin: [f64; 2], is_fixed: bool) -> Vec<usize> {
        let interfaces = vec![Interface::smooth(); surface.side_count()];
        let body = RigidBody::new(surface, interfaces, origin);
        let given = conditions(is_fixed);
        let cleared = given.without_rollers_at_tips(&[body]).unwrap();
        let grid = &given.grid;
        let is_freed = |node: usize, axis| {
            given.constraints.of(node, axis).is_some()
                && cleared.constraints.of(node, axis).is_none()
        };
        let nodes = 0..grid.node_count();
        assert!(nodes.clone().all(|node| !is_freed(node, 1)));
        let freed = nodes.filter(|&node| is_freed(node, 0));
        freed.map(|node| grid.node_place(node)[1]).collect()
    }

    /// A wedge with its tip at the origin, 6 high, with this half of its width at the top; drawn whole, or half of it.
    fn wedge(half_width: f64, is_whole: bool) -> Surface<2> {
        let left = if is_whole { -half_width } else { 0.0 };
        let corners = [[0.0, 0.0], [half_width, 6.0], [left, 6.0]];
        Surface::polygon(&corners, 0.0, 0.5).unwrap()
    }

    // GOAL: a roller on a plane of symmetry ends at the tip of a wedge.
    // CASE: wedges with their tips at 2.5 or on a node, drawn whole or half, on a roller and on a side that is fixed.
    // ORACLE: the sketch: nodes above the tip at which the wedge is narrower than two cells, as it is at their neighbours.
    #[test]
    fn the_roller_ends_at_the_tip() {
        for is_whole in [true, false] {
            let all = [3, 4, 5, 6, 7, 8];
            assert_eq!(freed(wedge(1.5, is_whole), [0.0, 2.5], false), all);
            assert_eq!(freed(wedge(1.5, is_whole), [0.0, 2.0], false), all[..5]);
            assert_eq!(freed(wedge(6.0, is_whole), [0.0, 2.5], false), [3]);
            assert!(freed(wedge(1.5, is_whole), [0.0, 2.5], true).is_empty());
            assert!(freed(wedge(12.0, is_whole), [0.0, 2.5], false).is_empty());
        }
    }

    // GOAL: soil below blunt bodies stays on its side of the plane of symmetry.
    // CASE: half of a pipe whose lowest point stands a tenth of a cell below a node, half of a footing, and a wedge far off the side.
    // ORACLE: soil below them touches the side, so that no node may be free.
    #[test]
    fn soil_below_blunt_bodies_is_held() {
        let pipe = Surface::circle(4.0, 0.5).unwrap();
        assert!(freed(pipe, [0.0, 7.9], false).is_empty());
        let corners = [[-2.0, 0.0], [2.0, 0.0], [2.0, 3.0], [-2.0, 3.0]];
        let footing = Surface::polygon(&corners, 0.0, 0.5).unwrap();
        assert!(freed(footing, [0.0, 4.5], false).is_empty());
        assert!(freed(wedge(1.5, true), [5.0, 2.5], false).is_empty());
    }
}
