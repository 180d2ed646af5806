//! Walls of the grid behind which the ground goes on: dashpots and soft springs, or two walls that move together.

use std::sync::Arc;

use igimp_shape::Grid;

/// How walls of the grid carry soil in a step that takes time (theory, eqs. 69 to 71).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls<const D: usize> {
    /// Walls with dashpots and springs.
    pub absorbing: Vec<AbsorbingWall<D>>,
    /// Two walls that move together, if any do.
    pub tied: Option<TiedWalls>,
    /// Forces and displacements of nodes at these walls as the step begins; those that are not listed carry nothing and have not moved.
    pub nodes: Arc<Vec<WallNode<D>>>,
    /// Motion of the free field beside nodes of walls with dashpots; beside those that are not listed the ground rests.
    pub beside: Arc<Vec<FreeMotion<D>>>,
}

/// The two walls at the ends of an axis, whose nodes move together pair by pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TiedWalls {
    /// The axis.
    pub axis: usize,
    /// Stiffness of the springs that tie them over that of the soil around them \[-\].
    pub stiffness: f64,
}

impl TiedWalls {
    /// The walls of a laminar box.
    pub fn across(axis: usize) -> Self {
        Self {
            axis,
            stiffness: 1e3,
        }
    }
}

/// Motion of the free field beside a node of a wall over a step, at its start and at its end (theory, eq. 77a).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeMotion<const D: usize> {
    /// The node of the grid.
    pub node: usize,
    /// The axis across the wall: other walls that meet it in the node stand on still ground.
    pub normal: usize,
    /// Displacement since the wall replaced its supports \[length\].
    pub displacement: [[f64; D]; 2],
    /// Velocity \[length/time\].
    pub velocity: [[f64; D]; 2],
    /// Force of the free field on the ground beside it, beyond that of the supports \[force\].
    pub force: [[f64; D]; 2],
}

impl<const D: usize> FreeMotion<D> {
    /// The same of another node.
    #[must_use]
    pub fn at(self, node: usize) -> Self {
        Self { node, ..self }
    }

    /// Still ground beside a node.
    pub(crate) fn still(node: usize) -> Self {
        Self {
            node,
            normal: 0,
            displacement: [[0.0; D]; 2],
            velocity: [[0.0; D]; 2],
            force: [[0.0; D]; 2],
        }
    }

    /// Whether all numbers are finite.
    fn is_finite(&self) -> bool {
        let all = [&self.displacement, &self.velocity, &self.force];
        all.iter()
            .all(|values| values.as_flattened().iter().all(|value| value.is_finite()))
    }
}

/// A wall of the grid with dashpots and springs, by component of the displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AbsorbingWall<const D: usize> {
    /// The axis across the wall.
    pub normal: usize,
    /// Whether it is the upper end of that axis.
    pub upper: bool,
    /// Stiffness of the springs over the modulus of the soil \[1/length\].
    pub spring: [f64; D],
}

impl<const D: usize> AbsorbingWall<D> {
    /// Whether a node of the grid lies on it.
    pub(crate) fn holds(&self, grid: &Grid<D>, node: usize) -> bool {
        let last = grid.axes[self.normal].cell_count();
        let place = if self.upper { last } else { 0 };
        grid.node_place(node)[self.normal] == place
    }
}

/// A node of a wall as a step begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallNode<const D: usize> {
    /// The node of the grid.
    pub node: usize,
    /// The force of the supports that the wall replaces, which goes on \[force\].
    pub force: [f64; D],
    /// Displacement since the wall replaced them \[length\].
    pub displacement: [f64; D],
}

impl<const D: usize> Walls<D> {
    /// Whether all numbers are finite, springs do not push, and axes are there.
    pub(crate) fn are_sound(&self) -> bool {
        let finite = |values: &[f64; D]| values.iter().all(|value| value.is_finite());
        let known = |axis: usize| axis < D;
        self.absorbing.iter().all(|wall| {
            known(wall.normal)
                && finite(&wall.spring)
                && wall.spring.iter().all(|&spring| spring >= 0.0)
        }) && (self.tied).is_none_or(|tied| known(tied.axis) && tied.stiffness > 0.0)
            && self.beside.iter().all(FreeMotion::is_finite)
            && (self.nodes.iter()).all(|node| finite(&node.force) && finite(&node.displacement))
    }
}
