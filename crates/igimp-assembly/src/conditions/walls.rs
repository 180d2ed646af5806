//! Walls of the grid behind which the ground goes on: dashpots and soft springs, or two walls that move together.

use std::sync::Arc;

/// How walls of the grid carry soil in a step that takes time (theory, eqs. 69 to 71).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls<const D: usize> {
    /// Walls with dashpots and springs.
    pub absorbing: Vec<AbsorbingWall<D>>,
    /// The axis whose two walls move together, if any.
    pub tied: Option<usize>,
    /// What the nodes of these walls stand at as the step begins; those that are not listed carry nothing and have not moved.
    pub nodes: Arc<Vec<WallNode<D>>>,
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
        }) && self.tied.is_none_or(known)
            && (self.nodes.iter()).all(|own| finite(&own.force) && finite(&own.displacement))
    }
}
