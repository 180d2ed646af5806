//! Prescribed displacements of grid nodes over one step.

use igimp_shape::Grid;

use crate::error::AssemblyError;

/// Prescribed step displacements, by node and axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraints<const D: usize> {
    /// Nodes along each axis of the grid.
    extent: [usize; D],
    prescribed: Vec<[Option<f64>; D]>,
}

impl<const D: usize> Constraints<D> {
    /// No constraint on any node of a grid.
    pub fn free(grid: &Grid<D>) -> Self {
        Self {
            extent: extent(grid),
            prescribed: vec![[None; D]; grid.node_count()],
        }
    }

    /// Prescribes the displacement of a node along one axis over the step \[length\]; a later
    /// call replaces an earlier one.
    ///
    /// # Errors
    /// [`AssemblyError::UnknownNode`], [`AssemblyError::UnknownAxis`] or
    /// [`AssemblyError::NonFinite`].
    pub fn prescribe(&mut self, node: usize, axis: usize, value: f64) -> Result<(), AssemblyError> {
        let entry = self.entry(node, axis)?;
        if !value.is_finite() {
            return Err(AssemblyError::NonFinite {
                quantity: "prescribed displacement",
                index: node,
            });
        }
        *entry = Some(value);
        Ok(())
    }

    /// Lets the displacement of a node along one axis go.
    ///
    /// # Errors
    /// [`AssemblyError::UnknownNode`] or [`AssemblyError::UnknownAxis`].
    pub fn release(&mut self, node: usize, axis: usize) -> Result<(), AssemblyError> {
        *self.entry(node, axis)? = None;
        Ok(())
    }

    fn entry(&mut self, node: usize, axis: usize) -> Result<&mut Option<f64>, AssemblyError> {
        let nodes = self.prescribed.len();
        known_axis::<D>(axis)?;
        let entry = self.prescribed.get_mut(node);
        Ok(&mut entry.ok_or(AssemblyError::UnknownNode { node, nodes })?[axis])
    }

    /// Holds one component of displacement on all nodes of a wall: axis `normal`, its lower or
    /// upper end, component `axis`.
    ///
    /// # Errors
    /// [`AssemblyError::UnknownAxis`], or [`AssemblyError::OtherGrid`] if the constraints were made
    /// for a grid with other numbers of nodes.
    pub fn fix_wall(
        &mut self,
        grid: &Grid<D>,
        normal: usize,
        upper: bool,
        axis: usize,
    ) -> Result<(), AssemblyError> {
        known_axis::<D>(normal)?;
        known_axis::<D>(axis)?;
        self.belong_to(grid)?;
        let wall = if upper { self.extent[normal] - 1 } else { 0 };
        for (node, prescribed) in self.prescribed.iter_mut().enumerate() {
            if grid.node_place(node)[normal] == wall {
                prescribed[axis] = Some(0.0);
            }
        }
        Ok(())
    }

    /// The prescribed step displacement of a node along an axis \[length\], if any: none for a node
    /// or an axis that the grid does not have.
    #[inline]
    pub fn of(&self, node: usize, axis: usize) -> Option<f64> {
        *self.prescribed.get(node)?.get(axis)?
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

    /// Refuses a grid with other numbers of nodes than that the constraints were made for.
    pub(crate) fn belong_to(&self, grid: &Grid<D>) -> Result<(), AssemblyError> {
        let other = extent(grid);
        if self.extent == other {
            Ok(())
        } else {
            Err(AssemblyError::OtherGrid {
                made_for: self.extent.to_vec(),
                grid: other.to_vec(),
            })
        }
    }
}

/// Nodes along each axis.
fn extent<const D: usize>(grid: &Grid<D>) -> [usize; D] {
    std::array::from_fn(|axis| grid.axes[axis].node_count())
}

fn known_axis<const D: usize>(axis: usize) -> Result<(), AssemblyError> {
    if axis < D {
        Ok(())
    } else {
        Err(AssemblyError::UnknownAxis { axis, axes: D })
    }
}
