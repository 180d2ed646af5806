//! Prescribed displacements of grid nodes over one step.

use igimp_shape::Grid;

use crate::error::AssemblyError;

/// Prescribed step displacements, by node and axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraints<const D: usize> {
    prescribed: Vec<[Option<f64>; D]>,
}

impl<const D: usize> Constraints<D> {
    /// No constraint on any node of a grid.
    pub fn free(grid: &Grid<D>) -> Self {
        Self {
            prescribed: vec![[None; D]; grid.node_count()],
        }
    }

    /// Prescribes the displacement of a node along one axis over the step \[length\]; a later
    /// call replaces an earlier one.
    ///
    /// # Errors
    /// [`AssemblyError::UnknownNode`] or [`AssemblyError::NonFinite`].
    pub fn prescribe(&mut self, node: usize, axis: usize, value: f64) -> Result<(), AssemblyError> {
        let nodes = self.prescribed.len();
        let entry = self
            .prescribed
            .get_mut(node)
            .ok_or(AssemblyError::UnknownNode { node, nodes })?;
        if !value.is_finite() {
            return Err(AssemblyError::NonFinite {
                what: "prescribed displacement",
                index: node,
            });
        }
        entry[axis] = Some(value);
        Ok(())
    }

    /// Holds one component of displacement on all nodes of a wall: axis `normal`, its lower or
    /// upper end, component `axis`.
    ///
    /// # Panics
    /// Never: the nodes come from the grid that the constraints were made for.
    pub fn fix_wall(&mut self, grid: &Grid<D>, normal: usize, upper: bool, axis: usize) {
        let wall = if upper {
            grid.axes[normal].node_count() - 1
        } else {
            0
        };
        for node in 0..grid.node_count() {
            if grid.node_place(node)[normal] == wall {
                self.prescribed[node][axis] = Some(0.0);
            }
        }
    }

    /// The prescribed step displacement of a node along an axis \[length\], if any.
    pub fn of(&self, node: usize, axis: usize) -> Option<f64> {
        self.prescribed[node][axis]
    }

    /// Whether any node is made to move.
    pub fn prescribe_motion(&self) -> bool {
        self.prescribed
            .iter()
            .flatten()
            .flatten()
            .any(|&value| value != 0.0)
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.prescribed.len()
    }
}
